"""Do results depend on threads, and is it told how far they have come?"""

from __future__ import annotations

import pickle
import sys
import threading
from operator import attrgetter
from pathlib import Path

import crankpin as cp
import numpy as np
import pytest
from support import long_calls

pytestmark = pytest.mark.slow

THREADS = 4
PARTS = ("forward", "backward", "peak", "peak_xy", "xy", "zero_bound")


def hashes(threads: str) -> str:
    return long_calls.printed(threads, str(Path(long_calls.__file__)))


def test_any_number_of_threads_finds_the_same_bits() -> None:
    alone = hashes("1")
    assert alone.count("\n") == len(long_calls.CALLS)
    for threads in ("2", "3", "7"):
        assert hashes(threads) == alone


def test_several_python_threads_at_once_find_the_same_bits() -> None:
    names = list(long_calls.CALLS)
    alone = {name: long_calls.digest(long_calls.CALLS[name]()) for name in names}
    found: list[tuple[str, str]] = []
    together = threading.Barrier(THREADS)

    def work(first: int) -> None:
        together.wait()
        # each thread begins with another call, so that all kinds meet
        order = names[first:] + names[:first]
        found.extend((name, long_calls.digest(long_calls.CALLS[name]())) for name in order)

    threads = [threading.Thread(target=work, args=(4 * k,)) for k in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == THREADS * len(names)
    assert all(alone[name] == hashed for name, hashed in found)


def test_a_sweep_tells_its_progress() -> None:
    told: list[tuple[int, int]] = []
    sweep = cp.sweep(
        cp.Engine.preset("v6-60"),
        rpm=[1000, 2000],
        rod_ratio=np.linspace(0.2, 0.4, 20_000),
        progress=lambda done, total: told.append((done, total)),
    )
    assert told == []
    for name in ("moment", "total.torque.peak"):
        assert attrgetter(name)(sweep).any()
        assert told == sorted(told)
        assert told[-1][0] == told[-1][1] > 1
        told.clear()
    again = pickle.loads(pickle.dumps(sweep))  # noqa: S301 - its own
    assert np.array_equal(again.force, sweep.force)


def test_what_progress_raises_stops_a_sweep() -> None:
    def stop(done: int, total: int) -> None:
        raise LookupError(f"{done} of {total}")

    sweep = cp.sweep(cp.Engine.preset("v6-60"), rpm=range(1, 9000), progress=stop)
    with pytest.raises(LookupError):
        _ = sweep.force.xy


def test_results_are_read_from_many_threads() -> None:
    """A result computes what is read when it is first read: by many threads, at every moment."""
    v6 = cp.Engine.preset("v6-60")
    names = [f"{quantity}.{part}" for quantity in ("force", "moment") for part in PARTS]
    switching = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(150):
            result = v6.balance(5000, orders=range(1, 9))
            failures: list[BaseException] = []
            together = threading.Barrier(THREADS)

            def read(first: int) -> None:
                together.wait()  # noqa: B023 - joined below
                try:
                    for name in names[first:] + names[:first]:
                        attrgetter(name)(result)  # noqa: B023
                except BaseException as error:
                    failures.append(error)  # noqa: B023

            threads = [threading.Thread(target=read, args=(k,)) for k in range(8)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            assert not failures
    finally:
        sys.setswitchinterval(switching)
