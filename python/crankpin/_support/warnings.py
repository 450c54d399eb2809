"""Warnings that point at the caller of crankpin."""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path

_PACKAGE = os.fspath(Path(__file__).parents[1]) + os.sep


def warn(message: str) -> None:
    """Warn whoever called crankpin, at the line of that call."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, UserWarning, stacklevel=level)
