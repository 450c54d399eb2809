"""Modules, and names in them, imported at first use."""

from __future__ import annotations

import inspect
import re
import sys
from importlib import import_module
from typing import TYPE_CHECKING

from crankpin._support import calls

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from types import ModuleType

NO_MEMORY = re.compile("failed to map segment|cannot allocate|paging file", re.IGNORECASE)
"""Messages of loaders of compiled modules where memory is lacking."""


def imported(name: str) -> ModuleType:
    """Import a module; where there is no memory for it that is a MemoryError, no ImportError."""
    try:
        return import_module(name)
    except ImportError as error:
        if NO_MEMORY.search(str(error)):
            raise MemoryError(str(error)) from error
        raise


def attributes(module: str, homes: Mapping[str, Iterable[str]]) -> Callable[[str], object]:
    """Return the ``__getattr__`` of a module (PEP 562), which keeps what was read.

    Parameters
    ----------
    module
        Name of the module.
    homes
        Name of another module → the attributes that are that module's, or its own name.
    """
    home_of = {name: home for home, names in homes.items() for name in names}

    def attribute(name: str) -> object:
        if name not in home_of:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        home = imported(home_of[name])
        value = home if home.__name__ == f"{module}.{name}" else getattr(home, name)
        if inspect.isfunction(value):
            value = calls.guided(value)
            setattr(home, name, value)  # where pickles look
        elif isinstance(value, type):
            for kind in value.__mro__:
                if kind.__module__.startswith("crankpin."):
                    calls.guide(kind, value, with_constructor=module == "crankpin")
        setattr(sys.modules[module], name, value)
        return value

    return attribute
