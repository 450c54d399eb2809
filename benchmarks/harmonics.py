"""What do the harmonics of a slider-crank cost, for how many right digits? Chart of all methods.

``python benchmarks/harmonics.py`` computes orders 1-8 of 1000 rod ratios λ at once, and of a single
one, for small and for large λ, by every method of ``methods.py`` and every setting of its knob. It
writes ``harmonics.csv``, ``harmonics.png`` and the README's part of it, ``harmonics_readme.png``,
to ``--out``, by default ``benchmarks/out``; ``--quick`` tries few settings.

The error is the worst over orders and λ against 50 digits, each order relative to itself; the CSV
has it relative to a₁ too, and of each order. Set-up (coefficients that serve any λ) is timed apart.
What a call costs by itself is seen where there is a single λ.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import methods
import mpmath
import numpy as np
from _diagram import Point, draw, few, outcome
from _references import harmonics_mp
from _timing import interleaved, machine, print_table, write_csv
from matplotlib.figure import Figure
from numpy.typing import NDArray

Array = NDArray[np.float64]

ORDERS = tuple(range(1, 9))
EVEN = (2, 4, 6, 8)
RODS = {"λ = 0.15 … 0.45": (0.15, 0.45), "λ = 0.6 … 0.99": (0.6, 0.99)}
SINGLE = {"λ = 0.15 … 0.45": 0.3, "λ = 0.6 … 0.99": 0.9}
MANY = 1000
CHECKED = 40
"""Rod ratios of the many that are compared with 50 digits."""
TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12, 1e-15, None)
PLAIN = methods.Method(
    "series in λ, plain Python", "terms", tuple(range(1, 13)), methods.series_in_python
)
METHODS = (
    *methods.HARMONICS[:1],
    PLAIN,
    *methods.HARMONICS[1:-1],
    methods.HARMONICS[-1]._replace(knob="tolerance", knobs=TOLERANCES),
)
HEADER = (
    *("rod_ratios", "how_many", "method", "knob", "setting", "outcome"),
    *("worst_relative_error", "worst_error_over_a1", *(f"error_{n}" for n in EVEN)),
    *("seconds", "seconds_per_value", "set_up_seconds", "first_call_seconds", "least_of"),
)


class Effort(NamedTuple):
    """How much is measured."""

    settings: int | None = None
    """of each knob, from end to end; all by default"""
    rounds: int = 5
    runs: int = 5
    seconds: float = 0.05
    """for each method and setting, in all rounds together, if that allows more runs"""

    def of(self, knobs: tuple[Any, ...]) -> tuple[Any, ...]:
        """Choose settings from cheap to dear."""
        return knobs if self.settings is None else few(knobs, self.settings)


QUICK = Effort(settings=3, rounds=2, runs=10, seconds=0.0)


class Run(NamedTuple):
    """A method at a setting, over some rod ratios."""

    region: str
    how_many: int
    method: methods.Method
    setting: Any

    def __call__(self) -> NDArray[Any]:
        """Compute orders 1-8."""
        return np.asarray(self.method.function(rod_ratios(*self[:2]), ORDERS, self.setting))

    def set_up(self) -> None:
        """Compute again what serves any rod ratio."""
        if self.method.function in (methods.series, methods.series_in_python):
            for n in EVEN:
                methods.series_coefficients.__wrapped__(n, self.setting)


@lru_cache
def rod_ratios(region: str, how_many: int) -> Array:
    """Evenly spaced over the region, or one of its middle."""
    found = np.linspace(*RODS[region], how_many) if how_many > 1 else np.array([SINGLE[region]])
    found.flags.writeable = False
    return found


@lru_cache
def checked(region: str, how_many: int) -> tuple[NDArray[np.int64], NDArray[Any]]:
    """Which rod ratios are compared, ends included, and orders 2, 4, 6, 8 there to 50 digits."""
    ratios = rod_ratios(region, how_many)
    chosen = np.unique(np.linspace(0, len(ratios) - 1, CHECKED).round().astype(int))
    exact = [
        [harmonics_mp.even_harmonic_closed_form(float(ratio), n) for n in EVEN]
        for ratio in ratios[chosen]
    ]
    return chosen, np.array(exact, dtype=object)


def errors(run: Run) -> tuple[Array, Array]:
    """Errors of orders 2, 4, 6, 8, (rod ratios, orders): relative to themselves, and to a₁.

    Odd orders are 1 and 0 with every method.
    """
    chosen, exact = checked(run.region, run.how_many)
    with np.errstate(all="ignore"):
        found = run()[chosen][:, [n - 1 for n in EVEN]]
    with mpmath.workdps(harmonics_mp.DIGITS):
        off = np.array(
            [
                [abs(mpmath.mpf(float(a)) - b) for a, b in zip(*rows, strict=True)]
                for rows in zip(found, exact, strict=True)
            ]
        )
        return (off / abs(exact)).astype(float), off.astype(float)


def timed(run: Callable[[], object]) -> float:
    """Time one call."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def measure(
    effort: Effort = Effort(),  # noqa: B008 - immutable
    sizes: tuple[int, ...] = (MANY, 1),
) -> list[dict[str, Any]]:
    """Run all methods at all settings: a row of the CSV for each."""
    rows = []
    for how_many in sizes:
        for region in RODS:
            runs = {
                f"{method.name} {setting}": Run(region, how_many, method, setting)
                for method in METHODS
                # a loop in Python is for a single rod ratio
                if how_many == 1 or method is not PLAIN
                for setting in effort.of(method.knobs)
            }
            with np.errstate(all="ignore"):
                first = {name: timed(run.__call__) for name, run in runs.items()}
                calls = {name: run.__call__ for name, run in runs.items()}
                seconds = interleaved(calls, effort.rounds, effort.seconds, effort.runs)
                set_up = interleaved({name: run.set_up for name, run in runs.items()}, 2, 0.0, 10)
            for name, run in runs.items():
                relative, absolute = errors(run)
                each = relative.max(axis=0)
                worst = float(each.max())
                rows.append(
                    {
                        "rod_ratios": region if how_many > 1 else f"λ = {SINGLE[region]}",
                        "how_many": how_many,
                        "method": run.method.name,
                        "knob": run.method.knob,
                        "setting": label(run.setting),
                        "outcome": outcome(worst),
                        "worst_relative_error": worst,
                        "worst_error_over_a1": float(absolute.max()),
                        **{f"error_{n}": e for n, e in zip(EVEN, each.tolist(), strict=True)},
                        "seconds": seconds[name],
                        "seconds_per_value": seconds[name] / how_many / len(ORDERS),
                        "set_up_seconds": set_up[name] if run.method.knob == "terms" else 0.0,
                        "first_call_seconds": first[name],
                        "least_of": effort.rounds * effort.runs,
                    }
                )
    return rows


def label(setting: float | None) -> str:
    """Write a setting as a reader wants it."""
    return "" if setting is None else f"{setting:g}"


def points(rows: list[dict[str, Any]], error: str = "worst_relative_error") -> list[Point]:
    """Return what the diagram takes."""
    return [
        Point(row["method"], row["setting"], row[error], row["seconds_per_value"]) for row in rows
    ]


ERRORS = {
    "worst_relative_error": "worst error, each order relative to itself",
    "worst_error_over_a1": "worst error, relative to a₁",
}


def panels(rows: list[dict[str, Any]]) -> list[tuple[str, list[dict[str, Any]]]]:
    """Group the rows by what was computed."""
    groups: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        many = f"{row['how_many']} of {row['rod_ratios']}"
        title = many if row["how_many"] > 1 else f"a single {row['rod_ratios']}"
        groups.setdefault(f"Harmonics 1-8, {title}", []).append(row)
    return list(groups.items())


def picture(rows: list[dict[str, Any]]) -> Figure:
    """Draw many rod ratios above, a single one below; and the many relative to a₁ between."""
    groups = panels(rows)
    drawn = [(title, group, "worst_relative_error") for title, group in groups]
    relative_to_first = [(*group, "worst_error_over_a1") for group in groups[:2]]
    drawn[2:2] = relative_to_first if len(groups) > 2 else []
    figure = Figure(figsize=(12, 4.6 * (len(drawn) // 2) + 0.5), layout="constrained")
    axes = figure.subplots(len(drawn) // 2, 2, sharey="row", squeeze=False)
    for ax, (title, group, error) in zip(axes.flat, drawn, strict=True):
        names = [method.name for method in METHODS]
        draw(ax, points(group, error), names, title, ERRORS[error], "seconds per value")
    handles, labels = axes[-1, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def main() -> None:
    """Measure, print, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="few settings of each knob")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    ran_on = machine("scipy", "mpmath", "matplotlib")
    print(ran_on)
    rows = measure(QUICK if given.quick else Effort())
    write_csv(given.out / "harmonics.csv", ran_on, HEADER, ([r[k] for k in HEADER] for r in rows))
    for title, group in panels(rows):
        print_table(
            title,
            ["method", "setting", "error", "over a₁", "ns a value"],
            [
                [
                    row["method"],
                    row["setting"],
                    f"{row['worst_relative_error']:.1e}",
                    f"{row['worst_error_over_a1']:.1e}",
                    f"{1e9 * row['seconds_per_value']:.1f}",
                ]
                for row in group
            ],
        )
    picture(rows).savefig(given.out / "harmonics.png", dpi=110)
    many = [row for row in rows if row["how_many"] > 1]
    picture(many).savefig(given.out / "harmonics_readme.png", dpi=90)
    print(f"\nRaw figures and picture: {given.out}")


if __name__ == "__main__":
    main()
