"""The ``crankpin`` command, also run by ``python -m crankpin``."""

import io
import os
import signal
import sys

from crankpin._support import interrupted
from crankpin.cli import main


def run() -> None:
    """Run the command line as a program and exit."""
    os.environ["MPLBACKEND"] = "agg"  # pictures are written to files: no window, no display
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # for terminals that lack "·"
    try:
        if signal.getsignal(signal.SIGINT) is interrupted.leave:
            # From here on files are written, which are cleaned up on the way out.
            signal.signal(signal.SIGINT, signal.default_int_handler)
        status = main()
        interrupted.leave_quietly()
    except KeyboardInterrupt:
        status = interrupted.STATUS
    sys.exit(status)


if __name__ == "__main__":
    run()
