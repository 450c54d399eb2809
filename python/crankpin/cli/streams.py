"""Standard output and standard error, which may be closed, full, or pipes that break."""

from __future__ import annotations

import os
import sys
from typing import TextIO


def write(text: str) -> None:
    """Write to standard output."""
    if sys.stdout is None:
        raise OSError("standard output is closed")
    try:
        # Line by line: a pipe that breaks within a single long write can go unnoticed.
        sys.stdout.writelines(text.splitlines(keepends=True))
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        abandon(sys.stdout)
        raise OSError(f"standard output: {error.strerror}") from None


def abandon(stream: TextIO) -> None:
    """Discard what is buffered: Python would fail once more while it closes the stream."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)


def say(message: str) -> None:
    """Write a line to standard error, if there is one; print(file=None) would write to stdout."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(f"crankpin: {message}\n")
        sys.stderr.flush()
    except OSError:
        abandon(sys.stderr)


def warn(message: Warning | str, *_: object, **__: object) -> None:
    """Write a warning to standard error, in place of ``warnings.showwarning``."""
    say(f"warning: {message}")
