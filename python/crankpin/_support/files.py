"""Writing of files: the old file stays until the new one is complete."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


def write(path: str | Path, content: str | bytes | Iterable[str]) -> None:
    """Write a file, text as UTF-8; an OSError names it, and leaves what was there as it was.

    A file is written beside its place and then renamed, with the permissions of the one that it
    replaces; a link still leads to it. Pipes and devices are written to as they are. Pieces of a
    text are written as they come.
    """
    file, pieces = Path(path), [content] if isinstance(content, (str, bytes)) else content
    data = (piece.encode() if isinstance(piece, str) else piece for piece in pieces)
    try:
        if file.exists() and not file.is_file():
            with file.open("wb") as opened:
                opened.writelines(data)
        else:
            _replace(Path(os.path.realpath(file)), data)
    except OSError as error:
        # Of a write it has no name, of the file beside it the wrong one.
        raise OSError(error.errno, error.strerror, str(file)) from None


def _replace(file: Path, data: Iterable[bytes]) -> None:
    """Write a file beside another, and rename it."""
    mode = stat.S_IMODE(file.stat().st_mode) if file.exists() else None
    if mode is not None and not os.access(file, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES))  # a rename would not ask
    beside = file.with_name(f".crankpin-{os.urandom(8).hex()}")
    try:
        with beside.open("xb") as opened:
            opened.writelines(data)
            opened.flush()
            os.fsync(opened.fileno())  # a disk may be found full only now
        if mode is not None:
            beside.chmod(mode)
        beside.replace(file)
    except BaseException:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise
