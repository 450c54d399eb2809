"""Does Ctrl-C end the command quietly, at any moment from its first import on?"""

from __future__ import annotations

import signal
import subprocess
import sys

import numpy as np
import pytest

# Ctrl-C when a number of modules are imported: no clock, so that each moment comes again.
PROGRAM = """
import os, runpy, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # which a background job ignores
class Interrupting:
    left = int(sys.argv.pop(1))
    def find_spec(self, name, path=None, target=None):
        if name not in ("crankpin", "crankpin._support", "crankpin._support.interrupted"):
            self.left -= "crankpin" in sys.modules
            if self.left == 0:
                os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Interrupting())
sys.argv[0] = "crankpin"
runpy.run_module("crankpin", run_name="__main__")
"""
MODULES = 200
"""Fewer than are imported from the package's first line to the end of a command."""


def interrupted(after: int) -> subprocess.CompletedProcess[str]:
    """Run a command that gets Ctrl-C where it has imported some modules."""
    program = [sys.executable, "-c", PROGRAM, str(after), "balance", "i4", "--rpm", "6000"]
    return subprocess.run(program, capture_output=True, text=True, check=False)  # noqa: S603 - of this file


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_ctrl_c_while_modules_are_imported_is_quiet() -> None:
    moments = np.random.default_rng(9).integers(1, MODULES, 6).tolist()
    for moment in [1, *moments]:
        ended = interrupted(moment)
        assert (ended.returncode, ended.stderr) == (128 + signal.SIGINT, ""), moment


def test_a_program_that_imports_the_library_keeps_its_ctrl_c() -> None:
    program = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); import crankpin; "
        "assert signal.getsignal(signal.SIGINT) is signal.default_int_handler"
    )
    subprocess.run([sys.executable, "-c", program], check=True)  # noqa: S603 - of this file
