"""Make every public call with little memory; print those that end the process or panic.

A fork of this process has so many MiB of address space more than it uses, a few more each time. Its
results stay alive, so that the later calls have less. With a hoard its memory is full before, but
for some small pieces that are given back, so that allocations of any size fail.
"""

from __future__ import annotations

import contextlib
import mmap
import os
import resource
import tempfile
import warnings
from pathlib import Path

from fuzzing.surface import CALLED, Call, instances, sound

MIB = range(0, 84, 4)
"""The core starts threads from 72 on, with two of them."""
HOARDS = (None, 0, 100)
"""Small pieces that are given back; None for no hoard."""
CALLS: list[Call] = []
"""A sound call of each target, pictures left out; the search for them imports what they need."""
DONE = mmap.mmap(-1, 8)
"""Calls of the fork that came back, shared with it."""


def limit(mib: int) -> None:
    """Allow so much address space more than is in use."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + mib * 2**20, -1))


def hoard(pieces: int) -> list[bytes]:
    """Take all memory, and give back some pieces of the smallest size."""
    taken = []
    for size in (2**20, 2**16, 2**12, 400, 40):
        with contextlib.suppress(MemoryError):
            while True:
                taken.append(bytes(size))
    del taken[len(taken) - pieces :]
    return taken


def make_calls(mib: int, pieces: int | None) -> None:
    """Make the calls; anything but an exception ends the process."""
    kept = []
    limit(mib)
    taken = [] if pieces is None else hoard(pieces)
    for k, call in enumerate(CALLS):
        DONE[:] = k.to_bytes(8, "little")
        # MemoryError, or errors of arguments that do not fit.
        with contextlib.suppress(Exception):
            kept.append(call.make())
    del taken


def main() -> None:
    """Make the calls with the limits."""
    warnings.simplefilter("ignore")
    instances()
    for target in CALLED:
        with contextlib.suppress(ImportError):  # of a package that is not there
            if call := sound(target):
                CALLS.append(call)
    for mib in MIB:
        for pieces in HOARDS:
            process = os.fork()
            if process == 0:
                try:
                    make_calls(mib, pieces)
                except BaseException as error:  # a panic is one
                    os.write(2, repr(error).encode())
                    os._exit(1)
                os._exit(0)
            status = os.waitpid(process, 0)[1]
            if status:
                last = CALLS[int.from_bytes(DONE[:], "little")].target.label
                print(f"{mib} MiB, hoard {pieces}: {last} ended with status {status}")
    print(f"{len(CALLS)} calls")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        main()
