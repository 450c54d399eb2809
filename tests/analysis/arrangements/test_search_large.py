"""Large searches: a part of the answer, bounded memory, progress, any number of threads."""

from __future__ import annotations

import itertools
from fractions import Fraction

import crankpin as cp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import long_calls

V22 = cp.search_arrangements(22)
"""(11!)² pairs."""

SEARCHES = {
    (name, hold): cp.search_arrangements(cylinders, phases_deg=phases, hold=hold)
    for name, cylinders, phases in [
        ("V6", 6, None),
        ("V8", 8, [0, 90, 180, 270]),
        ("V12", 12, None),
        ("V14", 14, None),
        ("turned only by a whole turn", 8, [0, 60, 120, 300]),
        ("without a mirror", 8, [0, 30, 90, 120]),
    ]
    for hold in ("firing", "pins")
}


@pytest.mark.parametrize("name", SEARCHES)
@given(ends=st.tuples(*[st.integers(-20, 400).map(lambda n: Fraction(n, 2))] * 2))
def test_a_window_is_a_part_of_the_list(
    name: tuple[str, str], ends: tuple[Fraction, Fraction]
) -> None:
    """Windows that end between angles; on an angle that is no fraction, rounding would decide."""
    search = SEARCHES[name]
    low, high = (float(end) + 1e-6 for end in ends)
    angles = search.bank_angles_deg
    inside = np.flatnonzero((angles >= low) & (angles <= high))
    part = search.within(low, high)
    # A family may be found through another of its pairs, whose rounding differs.
    np.testing.assert_allclose(part.bank_angles_deg, angles[inside], rtol=0, atol=1e-9)
    assert part.qualifying == search.qualifying


def test_a_window_ends_on_its_angles() -> None:
    search = cp.search_arrangements(6)
    assert search.within(0, 180).bank_angles_deg.round(9).tolist() == [0, 60, 120, 180]
    angle = search.bank_angles_deg[2]
    assert len(search.within(angle, angle)) == 1
    assert len(search.within(61, 59)) == 0
    assert search.within(50, 170).within(0, 130).window_deg == (50, 130)
    assert "50 to 130" in repr(search.within(50, 130))


def test_a_window_has_its_own_arrangements() -> None:
    part = V22.within(60, 60.001)
    assert len(part) > 50
    for arrangement in itertools.islice(part, 0, None, 10):
        assert 60 <= arrangement.bank_angle_deg <= 60.001
    engine = part[7].engine(cp.Cylinder(0.045, 0.158, 0.5), spacing=0.1)
    balance = engine.balance(rpm=3000, orders=[1])
    assert balance.moment.backward[0] == 0
    best = V22.within(60, 60.001).best(count=3)
    assert best == part.best(count=3)
    assert len(best) == 3


def test_v22() -> None:
    """Pairs and angles are those of exact keys in NumPy (``benchmarks/search.py``, a minute)."""
    assert V22.candidates == 39_916_800**2
    assert V22.qualifying == 1_854_562_160
    assert V22.balanced == 0
    assert len(V22) == 19_996_384


def test_v24() -> None:
    """The largest: twelve throws a bank, phases two by two."""
    found = cp.search_arrangements(24)
    assert found.candidates == 7_484_400**2
    assert found.qualifying == 549_665_478_144
    assert found.balanced == 217_503_504
    assert len(found) == 682


PROGRAM = """
import hashlib
import crankpin as cp
found = hashlib.sha256()
two_stroke = cp.search_arrangements(16, phases_deg=range(0, 360, 45))
for search in (cp.search_arrangements(18), cp.search_arrangements(22).within(59, 61), two_stroke):
    found.update(search.bank_angles_deg.tobytes())
    found.update(repr([search[k] for k in range(0, len(search), 997)]).encode())
    found.update(repr(search.within(59.9, 60.1).best(count=50)).encode())
    found.update(repr(search).encode())
print(found.hexdigest())
"""


@pytest.mark.slow
def test_any_number_of_threads_finds_the_same_bits() -> None:
    found = {long_calls.printed(threads, "-c", PROGRAM) for threads in ("1", "2", "3", "7")}
    assert len(found) == 1


def test_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    search = cp.search_arrangements(22, progress=lambda done, total: told.append((done, total)))
    assert told == sorted(told)
    assert told[-1][0] == told[-1][1] > 0
    told.clear()
    search.within(60, 61).bank_angles_deg  # noqa: B018 - worked out when asked for
    assert told[-1][0] == told[-1][1] > 0


def test_what_progress_raises_stops_the_search() -> None:
    def stop(done: int, total: int) -> None:
        raise LookupError(f"{done} of {total}")

    with pytest.raises(LookupError):
        cp.search_arrangements(22, progress=stop)


def test_progress_bar(capsys: pytest.CaptureFixture[str]) -> None:
    cp.search_arrangements(22, progress=True)
    assert "V22" in capsys.readouterr().err


def test_what_is_out_of_range_is_refused_by_name() -> None:
    hint = "a bank has 2 to 12 throws: give 4 to 24 cylinders"
    for cylinders in (2, 26, 30, 1000):
        with pytest.raises(cp.InputError, match=f"cylinders = {cylinders}: {hint}"):
            cp.search_arrangements(cylinders)
    with pytest.raises(cp.InputError, match=f"cylinders = 26: {hint}"):
        cp.search_arrangements(26, phases_deg=range(13))
    with pytest.raises(cp.InputError, match="progress = 3: give True"):
        cp.search_arrangements(6, progress=3)  # type: ignore[arg-type]


def test_an_arrangement_hands_back_its_engine() -> None:
    cylinder = cp.Cylinder(0.045, 0.158, 0.5)
    for search in SEARCHES.values():
        for k in range(0, len(search), 1 + len(search) // 20):
            engine = search[k].engine(cylinder, spacing=0.1)
            assert engine == search[k - len(search)].engine(cylinder, spacing=0.1)
            balance = engine.balance(rpm=3000, orders=[1, 2])
            assert balance.moment.backward[0] == 0
            scale = 0.5 * 0.045 * (3000 * np.pi / 30) ** 2 * 0.1
            forward = abs(balance.moment.forward[0]) / scale
            # the angle is rounded once, sums of at most 7 terms of at most 3
            assert forward == pytest.approx(search[k].counterweight, abs=1e-13)
            second = abs(balance.moment.xy[1]) / (scale * cylinder.harmonics([2])[0].real)
            assert second == pytest.approx(search[k].second_order, abs=1e-12)


def test_arrangements_of_ones_own() -> None:
    cylinder = cp.Cylinder(0.045, 0.158, 0.5)
    own = cp.results.Arrangement(90, (0, 120, 240), (0, 120, 240), 0.0, (0.0, 0.0), "pins")
    engine = own.engine(cylinder, spacing=0.1)
    assert engine.balance(rpm=3000, orders=[1]).moment.backward[0] == 0
    uneven = cp.results.Arrangement(90, (0, 120, 240), (0, 120), 0.0, (0.0, 0.0))
    with pytest.raises(cp.InputError, match="second_deg has 2 entries, first_deg has 3"):
        uneven.engine(cylinder, spacing=0.1)


def test_an_arrangement_of_nonsense_is_refused() -> None:
    endless: list[object] = []
    endless.append(endless)
    given = (90, (0, 120), (0, 120), 0.0, (0.0, 0.0), "pins")
    names = ("bank_angle_deg", "first_deg", "second_deg", "counterweight", "second_order", "hold")
    for k, name in enumerate(names):
        with pytest.raises(cp.InputError, match=name):
            cp.results.Arrangement(*(*given[:k], endless, *given[k + 1 :]))  # type: ignore[arg-type]
