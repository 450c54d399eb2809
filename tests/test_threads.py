"""Do results depend on the number of threads, or on what other threads do?"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import long_calls


def hashes(threads: str) -> str:
    return subprocess.run(  # noqa: S603 - this interpreter
        [sys.executable, str(Path(long_calls.__file__))],
        env=os.environ | {"RAYON_NUM_THREADS": threads},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def test_any_number_of_threads_finds_the_same_bits() -> None:
    alone = hashes("1")
    assert alone.count("\n") == len(long_calls.CALLS)
    for threads in ("2", "3", "7"):
        assert hashes(threads) == alone


def test_several_python_threads_at_once_find_the_same_bits() -> None:
    names = list(long_calls.CALLS)
    alone = {name: long_calls.digest(long_calls.CALLS[name]()) for name in names}
    found: list[tuple[str, str]] = []
    together = threading.Barrier(8)

    def work(first: int) -> None:
        together.wait()
        # each thread begins with another call, so that all kinds meet
        order = names[first:] + names[:first]
        found.extend((name, long_calls.digest(long_calls.CALLS[name]())) for name in order)

    threads = [threading.Thread(target=work, args=(2 * k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8 * len(names)
    assert all(alone[name] == hashed for name, hashed in found)
