"""Ctrl-C while the command is being loaded, which takes longer than most commands run."""

import itertools
import os
import signal
import sys

STATUS = 128 + 2
"""Exit status of a command that Ctrl-C ended, as a shell reports it."""


def is_command() -> bool:
    """Return whether this process is the ``crankpin`` command, not a program that imports it."""
    if sys.argv[:1] == ["-m"]:  # while runpy imports the package of ``python -m``
        return ("-m", "crankpin") in itertools.pairwise(sys.orig_argv)
    file = "".join(sys.argv[:1]).replace("\\", "/").rpartition("/")[2]
    return file.partition(".")[0] == "crankpin"  # without pathlib, which takes time to import


def leave(*_: object) -> None:
    """End the process at once: nothing has begun, or everything is written."""
    os._exit(STATUS)


def leave_quietly() -> None:
    """Let Ctrl-C end the process at once, where it would raise KeyboardInterrupt."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, leave)


if is_command():
    leave_quietly()
