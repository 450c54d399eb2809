"""The ``crankpin`` command, also run by ``python -m crankpin``."""

import io
import os
import sys

from crankpin.cli import main


def run() -> None:
    """Run the command line as a program and exit."""
    os.environ["MPLBACKEND"] = "agg"  # pictures are written to files: no window, no display
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # for terminals that lack "·"
    sys.exit(main())


if __name__ == "__main__":
    run()
