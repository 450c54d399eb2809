"""``python -m crankpin``."""

import io
import os
import sys

from crankpin.cli import main

if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "agg"  # pictures go to files; no window, no display needed
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # for terminals that lack "·"
    sys.exit(main())
