"""Modules, and names in them, imported at first use."""

from __future__ import annotations

import inspect
import re
import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from crankpin._support import calls

if TYPE_CHECKING:
    from collections.abc import Callable
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


def attach(
    module: str, file: str
) -> tuple[list[str], Callable[[str], object], Callable[[], list[str]]]:
    """Return ``__all__``, ``__getattr__`` (PEP 562) and ``__dir__`` of a module of others' names.

    They are those of the stub beside it, each line ``from home import name as name``: one list
    for type checkers, for completion and of what is imported at first use.

    Parameters
    ----------
    module
        Name of the module.
    file
        Its file.
    """
    stub = Path(file).with_suffix(".pyi").read_text(encoding="utf-8")
    lines = (line.split() for line in stub.splitlines() if line.startswith("from "))
    homes = {name: home for _, home, _, name, *_ in lines}
    names = list(homes)

    def attribute(name: str) -> object:
        if name not in homes:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        if homes[name] == module:
            return imported(f"{module}.{name}")
        home = imported(homes[name])
        value = getattr(home, name)
        if inspect.isfunction(value):
            value = calls.guided(value)
            setattr(home, name, value)  # where pickles look
        elif isinstance(value, type):
            for kind in value.__mro__:
                if kind.__module__.startswith("crankpin."):
                    calls.guide(kind, value, with_constructor=module == "crankpin")
        setattr(sys.modules[module], name, value)
        return value

    return names, attribute, lambda: names
