"""Errors besides the compiled core's ``InputError``, and warnings."""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path

from crankpin._core import InputError

_PACKAGE = os.fspath(Path(__file__).parents[1]) + os.sep


class UndefinedError(InputError, AttributeError):
    """A property is undefined for this object.

    Both an InputError and an AttributeError, so that ``hasattr`` returns False.
    """


def warn(message: str) -> None:
    """Warn whoever called crankpin, at the line of that call."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, UserWarning, stacklevel=level)
