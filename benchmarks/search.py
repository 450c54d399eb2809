"""What does an exact arrangement search cost, and what does comparing floating point find instead?

``python benchmarks/search.py`` prints three tables: times of the search beside NumPy and numba with
the same exact method; pairs found against the tolerance of a comparison of computed magnitudes; the
least distance between different magnitudes beside rounding. Raw figures and a picture go to
``--out``. ``--v26`` adds the gap of a V-26 (minutes, 8 GB), ``--quick`` leaves out V-18 and V-22.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import crankpin as cp
import matplotlib.pyplot as plt
import numpy as np
from _timing import interleaved, least, machine, milliseconds, print_table, write_csv
from numpy.typing import NDArray

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests"))

import _search_numba as compiled  # noqa: E402 - needs the tests beside us
from rederivation import ito, search  # noqa: E402 - from the tests beside us

Array = NDArray[np.float64]
RAN_ON = machine("numba", "matplotlib")


class Case(NamedTuple):
    """An engine, with the arrangements that stand for all."""

    name: str
    throws: int
    alternating: bool
    banks: search.Banks
    set_up: float
    """Seconds that NumPy took to list them."""

    def crankpin(self) -> cp.results.ArrangementSearch:
        """Ask crankpin."""
        return cp.search_arrangements(2 * self.throws, alternating=self.alternating)


def alternating_banks() -> search.Banks:
    """Return the 504 arrangements of the V-14 paper, turned until the central throw has phase 0."""
    rows = ito.LEVERS[np.argsort(ito.arrangements(), axis=1)]
    rows = rows[rows[:, 0] == 0]
    return search.Banks(rows.T.astype(search.WHOLE), np.full(len(rows), 7))


ENGINES = ((5, False), (7, True), (7, False), (9, False), (11, False))
"""Throws, and whether the cylinders of a bank alternate: V-10 to V-22."""


def cases(engines: Iterable[tuple[int, bool]] = ENGINES) -> list[Case]:
    """List the arrangements of each."""
    made = []
    for throws, alternating in engines:
        name = f"V-{2 * throws}{' alternating' * alternating}"
        start = time.perf_counter()
        banks = alternating_banks() if alternating else search.banks(throws)
        made.append(Case(name, throws, alternating, banks, time.perf_counter() - start))
    return made


# --- time -----------------------------------------------------------------------------------------


def methods(case: Case) -> tuple[dict[str, Callable[[], int]], dict[str, Callable[[], Array]]]:
    """Return ways to the count and ways to all bank angles, radians.

    They begin with nothing but the number of throws, NumPy with its list of arrangements.
    """
    levers, multiplicity = case.banks
    rows = np.ascontiguousarray(levers.T.astype(np.int8)) if case.alternating else None

    def numpy_count() -> int:
        return search.qualifying(search.magnitude_keys(levers), multiplicity)

    def numba_count() -> int:
        if rows is not None:
            return compiled.count_given(case.throws, rows, case.throws)
        return compiled.count(case.throws)

    counts = {
        "crankpin": lambda: case.crankpin().qualifying,
        "NumPy": numpy_count,
        "numba": numba_count,
    }
    angles = {
        "crankpin": lambda: np.radians(case.crankpin().bank_angles_deg),
        "NumPy": lambda: search.bank_angles(levers, search.magnitude_keys(levers)),
        "numba": lambda: compiled.angles(case.throws, rows),
    }
    return counts, angles


def speed(engines: list[Case], out: Path) -> None:
    """Print and write times; all methods must agree."""
    rows, raw = [], []
    start = time.perf_counter()
    for case in engines[:2]:
        for ways in methods(case):
            ways["numba"]()
    print(f"numba compiled in {time.perf_counter() - start:.1f} s; not counted below")
    for case in engines:
        counts, angles = methods(case)
        found = {name: run() for name, run in counts.items()}
        if len(set(found.values())) > 1:
            raise RuntimeError(f"{case.name}: {found}")
        ours = angles["crankpin"]()
        for name, run in angles.items():
            np.testing.assert_allclose(run(), ours, rtol=0, atol=1e-12, err_msg=name)
        large = case.throws > 9
        rounds, seconds = (2, 0) if large else (10, 1)
        for what, ways in (("count", counts), ("angles", angles)):
            times = interleaved(ways, rounds=rounds, seconds=seconds, runs=1 if large else 4)
            for name, value in times.items():
                ratio = f"{value / times['crankpin']:.2f} ×"
                rows.append([case.name, what, name, milliseconds(value), ratio])
                raw.append([case.name, what, name, value, case.set_up if name == "NumPy" else 0])
    header = ["engine", "result", "method", "time", "of ours"]
    print_table("Exact search: pairs that qualify; all bank angles (pairs included)", header, rows)
    listing = ", ".join(f"{case.name} {milliseconds(case.set_up)}" for case in engines)
    print(f"  NumPy's list of arrangements, not counted: {listing}")
    columns = ["engine", "result", "method", "seconds", "set_up_seconds"]
    write_csv(out / "search_speed.csv", RAN_ON, columns, raw)


# --- tolerance ------------------------------------------------------------------------------------

TOLERANCES = np.concatenate([[0.0], np.logspace(-17, 1, 73)])
PRECISIONS: dict[str, type[np.floating[Any]]] = {"double": np.float64, "single": np.float32}


def squares(case: Case, precision: type[np.floating[Any]]) -> tuple[Array, NDArray[np.int64]]:
    """|Z|² in floating point, ascending, and the pairs' weights; as a² + b², added up by phase.

    Once for all arrangements that are turned, mirrored or exchanged, so that they at least agree:
    it makes the comparison look better than the paper's, which has all arrangements.
    """
    angles = 2 * np.pi * np.arange(case.throws) / case.throws
    cos, sin = np.cos(angles).astype(precision), np.sin(angles).astype(precision)
    a: NDArray[np.floating[Any]] = np.zeros(len(case.banks.multiplicity), dtype=precision)
    b = np.zeros_like(a)
    for k, lever in enumerate(case.banks.levers.astype(precision)):
        a += cos[k] * lever
        b += sin[k] * lever
    size = a * a + b * b
    order = np.argsort(size)
    return size[order].astype(np.float64), case.banks.multiplicity[order].astype(np.int64)


def pairs(size: Array, multiplicity: NDArray[np.int64], tolerance: float) -> int:
    """Ordered pairs of arrangements whose |Z|² differ by the tolerance at most."""
    total = np.concatenate([[0], np.cumsum(multiplicity)])
    high = np.searchsorted(size, size + tolerance, side="right")
    low = np.searchsorted(size, size - tolerance, side="left")
    return int(multiplicity @ (total[high] - total[low]))


def qualifying(case: Case) -> int:
    """Count the pairs exactly."""
    return case.crankpin().qualifying


def compared(case: Case, precision: type[np.floating[Any]]) -> int:
    """Count the pairs from the start."""
    return pairs(*squares(case, precision), 1e-9)


def tolerance(engines: list[Case], out: Path) -> None:
    """Print, write and draw the pairs found against the tolerance."""
    raw: list[list[Any]] = []
    exact_times: dict[str, float] = {}
    for case in engines:
        exact = qualifying(case)
        runs = 3 if case.throws > 9 else 20
        exact_times[case.name] = least(partial(qualifying, case), seconds=0, runs=runs)
        raw.append([case.name, "exact", "", exact, exact, exact_times[case.name]])
        for name, precision in PRECISIONS.items():
            size, multiplicity = squares(case, precision)
            taken = least(partial(compared, case, precision), seconds=0, runs=runs)
            for value in TOLERANCES.tolist():
                found = pairs(size, multiplicity, value)
                raw.append([case.name, name, value, found, exact, taken])
    columns = ["engine", "method", "tolerance_of_squares", "pairs", "exact_pairs", "seconds"]
    write_csv(out / "search_tolerance.csv", RAN_ON, columns, raw)
    rows = []
    for case in engines:
        for name in PRECISIONS:
            mine = [row for row in raw if row[:2] == [case.name, name]]
            right = [row[2] for row in mine if row[3] == row[4]]
            plateau = f"{min(right):.0e} … {max(right):.0e}" if right else "none"
            at_zero, seconds = mine[0][3], mine[0][5]
            rows.append([case.name, name, f"{at_zero:,}", plateau, milliseconds(seconds)])
        time = milliseconds(exact_times[case.name])
        rows.append([case.name, "exact: all", f"{mine[0][4]:,}", "none needed", time])
    header = ["engine", "|Z|² in", "pairs with ==", "right with a tolerance of", "time"]
    print_table("Comparing magnitudes", header, rows)
    picture(raw, [case.name for case in engines], out / "search_tolerance.png")


COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9")


NONE = 1e-10  # where the picture puts an error of 0


def picture(raw: list[list[object]], names: list[str], path: Path) -> None:
    """Error of the count against tolerance, and time against error."""
    plt.rcParams |= {"axes.grid": True, "axes.axisbelow": True, "grid.color": "#dddddd"}
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    for name, color in zip(names, COLORS, strict=False):
        for method, line in (("double", "-"), ("single", ":")):
            rows = [row for row in raw if row[:2] == [name, method]]
            error = np.array([abs(row[3] / row[4] - 1) for row in rows])  # type: ignore[operator]
            at = np.array([row[2] for row in rows], dtype=float)
            at[0] = 1e-18  # ==
            shown = np.maximum(error, NONE)
            left.loglog(at, shown, line, color=color, lw=1.6, label=f"{name}, {method}")
            right.loglog(shown, [row[5] for row in rows], ".", color=color, ms=4)
        (exact,) = (row for row in raw if row[:2] == [name, "exact"])
        right.loglog(NONE, exact[5], "*", color=color, ms=13, mec="black", mew=0.6, label=name)
    left.axhline(NONE, color="black", lw=4, alpha=0.3, label="crankpin: no tolerance")
    left.set(
        xlabel="tolerance of |Z₁|² − |Z₂|²   (leftmost: ==)",
        ylabel="relative error of the count   (bottom: none)",
        ylim=(NONE / 3, 1e8),
        title="Pairs found by comparing computed magnitudes",
    )
    left.legend(fontsize=7, ncols=3, loc="upper left")
    right.set(
        xlabel="relative error of the count   (leftmost: none)",
        ylabel="seconds",
        title="Time: comparing (dots), crankpin (stars)",
    )
    figure.savefig(path, dpi=110)
    plt.close(figure)


# --- gaps -----------------------------------------------------------------------------------------


def gaps(engines: list[Case], out: Path, v26: bool) -> None:
    """Print and write the least distance of different |2Z| beside rounding."""
    raw: list[list[object]] = []
    for case in engines:
        keys = search.magnitude_keys(case.banks.levers)
        classes = np.unique(keys)
        apart = search.smallest_gap(classes, case.throws)
        spread = [search.rounding(case.banks, keys, p) for p in PRECISIONS.values()]
        raw.append([case.name, len(classes), *apart, *spread])
    if v26:
        raw.append(gap_of_v26())
    rows = [[str(row[0]), f"{row[1]:,}", *(f"{row[k]:.1e}" for k in (2, 4, 5))] for row in raw]
    header = ["engine", "magnitudes", "least gap of |2Z|", "rounding, double", "rounding, single"]
    print_table(
        "How close different magnitudes come, how far rounding parts equal ones", header, rows
    )
    columns = ["engine", "magnitudes", "gap_of_2z", "gap_of_squares"]
    columns += [f"rounding_{name}" for name in PRECISIONS]
    write_csv(out / "search_gaps.csv", RAN_ON, columns, raw)


def gap_of_v26() -> list[object]:
    """13 throws: 120 million arrangements up to symmetry; rounding on a million of them."""
    start = time.perf_counter()
    keys = compiled.keys_of(13)[0]
    keys.sort()
    print(f"  V-26: {len(keys):,} keys in {time.perf_counter() - start:.1f} s, ", end="")
    classes = keys[np.flatnonzero(np.diff(keys, prepend=-1))]
    del keys
    apart = search.smallest_gap(classes, 13)
    rng = np.random.default_rng(26)
    rows = rng.permuted(np.tile(np.arange(-6, 7), (1_000_000, 1)), axis=1).T.astype(search.WHOLE)
    sample = search.Banks(rows, np.ones(rows.shape[1], dtype=np.int64))
    own = search.magnitude_keys(rows)
    spread = [search.rounding(sample, own, p) for p in PRECISIONS.values()]
    print(f"gap in {time.perf_counter() - start:.1f} s")
    return ["V-26", len(classes), *apart, *spread]


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=HERE / "out", help="folder to write to")
    parser.add_argument("--v26", action="store_true", help="the gap of a V-26 too")
    parser.add_argument("--quick", action="store_true", help="V-10 and V-14 only")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    print(RAN_ON)
    engines = cases(ENGINES[:3] if given.quick else ENGINES)
    speed(engines, given.out)
    tolerance(engines, given.out)
    gaps(engines, given.out, given.v26)
    print(f"\nRaw figures and picture: {given.out}")


if __name__ == "__main__":
    main()
