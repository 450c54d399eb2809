"""Torque of gas pressure per half order, from a table: how long, for how many right digits?

``python benchmarks/gas_orders.py`` takes pressure at so many even angles of a cycle and asks for
the phasors of orders ½ to 12 of the torque on the crank: by a transform of the samples, with the
first sample at the end once more as in a closed table, by Simpson's rule for each order, by
straight lines and by splines between the samples, and by crankpin. A smooth peak, a burning cycle
that bends at valve events, and an Otto cycle that jumps at the dead centres. It writes
``gas_orders.csv`` and ``gas_orders.png`` to ``--out``, by default ``benchmarks/out``; ``--quick``
takes fewer settings.

The error is the largest of the 24 phasors over the largest of them, against Gauss quadrature
between the angles at which the pressure bends or jumps.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import crankpin as cp
import numpy as np
from _diagram import OURS, Point, draw, few, outcome
from _references import pressure
from _timing import interleaved, machine, print_table, write_csv
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.integrate import quad_vec, simpson
from scipy.interpolate import CubicSpline
from stability_cases import (
    ATMOSPHERE,
    CRANK,
    FIRED,
    HALF_ORDERS,
    STROKES,
    Pressure,
    otto_pressure,
    peak_of_pressure,
)

Array = NDArray[np.float64]
Phasors = NDArray[np.complex128]

COUNTS = (60, 90, 180, 360, 720, 1440, 2880)
"""Samples of a cycle: from 12° to a quarter of a degree."""
QUICK = 2
BORE = FIRED.bore or np.nan
AREA = np.pi / 4.0 * BORE**2
TURN = 4.0 * np.pi
DENSE = np.linspace(0.0, TURN, 7200, endpoint=False)
HEADER = ("cycle", "method", "samples", "outcome", "error", "seconds")
EXAMPLE = cp.Cycle.example("diesel")


ITSELF = f"{OURS}, the cycle itself"
"""The polynomials of a computed cycle, and no table."""


class Given(NamedTuple):
    """A cycle, as a function of the angle and by the angles between which it is smooth."""

    name: str
    of: Pressure
    edges: tuple[float, ...]
    cycle: Callable[[], cp.Cycle] | None = None
    """What computes it, if crankpin does."""


def example(theta: Array) -> Array:
    """Return the pressure of the bundled diesel cycle, θ in radians."""
    return EXAMPLE.pressure_at(np.degrees(theta))


def _edges() -> tuple[float, ...]:
    """Return where the polynomials of the bundled cycle meet, radians, over one cycle."""
    theta = EXAMPLE.theta_deg
    knots = np.append(theta[0], theta[1:][np.diff(theta) == 0.0]) % 720.0
    return tuple(np.radians(np.unique(np.concatenate([[0.0, 720.0], knots]))).tolist())


CYCLES = (
    Given("a smooth peak", peak_of_pressure, tuple(STROKES.tolist())),
    Given("a diesel cycle: bends at valve events", example, _edges(), lambda: EXAMPLE),
    Given(
        "an Otto cycle: jumps at dead centres",
        otto_pressure,
        tuple(STROKES.tolist()),
        lambda: cp.Cycle.otto(FIRED, compression_ratio=10.0, pressure_ratio=3.5),
    ),
)


@lru_cache
def exact(of: Given) -> Phasors:
    """Return the phasors by Gauss quadrature."""
    return pressure.torque_phasors(of.of, np.array(of.edges), HALF_ORDERS, BORE, CRANK, ATMOSPHERE)[
        1
    ]


def error(of: Given, found: Phasors) -> float:
    """Return the largest error over the largest phasor."""
    return float(np.abs(found - exact(of)).max() / np.abs(exact(of)).max())


# --- methods: angles in radians from the firing TDC, absolute pressures → phasors -----------------


def torque(theta: Array, values: Array) -> Array:
    """Return the torque of gauge pressure on the crank."""
    return -(values - ATMOSPHERE) * AREA * pressure.slope(theta, *CRANK)


def transform(theta: Array, values: Array) -> Phasors:
    """Transform the samples of one cycle."""
    found: Phasors = np.fft.rfft(torque(theta, values))[1:25] * (2.0 / len(theta))
    return found


def closed(theta: Array, values: Array) -> Phasors:
    """Transform a table whose last sample is the first of the next cycle."""
    return transform(np.append(theta, TURN), np.append(values, values[0]))


def by_simpson(theta: Array, values: Array) -> Phasors:
    """Integrate over the table, for each order by Simpson's rule."""
    angles, ends = np.append(theta, TURN), np.append(values, values[0])
    curve = torque(angles, ends) * np.exp(-1j * np.outer(HALF_ORDERS, angles))
    found: Phasors = simpson(curve, x=angles) * (2.0 / TURN)
    return found


def by_lines(theta: Array, values: Array) -> Phasors:
    """Transform 7200 samples of straight lines between the table's."""
    return transform(DENSE, np.interp(DENSE, theta, values, period=TURN))


def by_spline(theta: Array, values: Array) -> Phasors:
    """Integrate a periodic cubic spline adaptively, to 1e-10 of its largest phasor."""
    spline = CubicSpline(np.append(theta, TURN), np.append(values, values[0]), bc_type="periodic")

    def curve(angle: float) -> Phasors:
        at = np.array([angle])
        found: Phasors = torque(at, spline(at)) * np.exp(-1j * HALF_ORDERS * angle)
        return found

    found: Phasors = quad_vec(curve, 0.0, TURN, epsrel=1e-10, norm="max")[0] * (2.0 / TURN)
    return found


def ours(theta: Array, values: Array) -> Phasors:
    """Ask crankpin, which finds that the table is closed."""
    angles, ends = np.append(np.degrees(theta), 720.0), np.append(values, values[0])
    return cp.Cycle(angles, ends).torque_harmonics(FIRED, HALF_ORDERS)


METHODS: dict[str, Callable[[Array, Array], Phasors]] = {
    "FFT of the samples": transform,
    "FFT, first sample once more": closed,
    "Simpson's rule": by_simpson,
    "straight lines, FFT": by_lines,
    "spline, adaptive quadrature": by_spline,
    OURS: ours,
}


# --- the chart ------------------------------------------------------------------------------------


def itself(cycle: Callable[[], cp.Cycle]) -> Phasors:
    """Make the cycle of its equations, and integrate it."""
    return cycle().torque_harmonics(FIRED, HALF_ORDERS)


def measure(quick: bool = False) -> list[dict[str, Any]]:
    """Run all methods on all tables: a row of the CSV for each."""
    rows = []
    counts = few(COUNTS, QUICK) if quick else COUNTS
    for of in CYCLES:
        runs: dict[tuple[str, int | str], Callable[[], Phasors]] = {}
        for count in counts:
            theta = np.linspace(0.0, TURN, count, endpoint=False)
            values = of.of(theta)
            for name, method in METHODS.items():
                runs[name, count] = partial(method, theta, values)
        if of.cycle is not None:
            runs[ITSELF, ""] = partial(itself, of.cycle)
        rounds, each = (1, 1) if quick else (2, 3)
        times = interleaved({str(key): run for key, run in runs.items()}, rounds, 0.0, each)
        for (name, count), run in runs.items():
            off = error(of, run())
            row = (of.name, name, count, outcome(off), off, times[str((name, count))])
            rows.append(dict(zip(HEADER, row, strict=True)))
    return rows


def picture(rows: list[dict[str, Any]]) -> Figure:
    """Draw time over error, a panel for each cycle."""
    figure = Figure(figsize=(14, 5), layout="constrained")
    for ax, of in zip(figure.subplots(1, len(CYCLES)), CYCLES, strict=True):
        found = [
            Point(row["method"], str(row["samples"]), row["error"], row["seconds"])
            for row in rows
            if row["cycle"] == of.name
        ]
        names = [*METHODS, ITSELF]
        draw(ax, found, names, of.name, "largest error over the largest phasor", "seconds")
    handles, labels = figure.axes[1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def main() -> None:
    """Measure, print, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="fewer numbers of samples")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    ran_on = machine("scipy", "matplotlib")
    print(ran_on)
    rows = measure(given.quick)
    write_csv(given.out / "gas_orders.csv", ran_on, HEADER, ([*row.values()] for row in rows))
    for of in CYCLES:
        print_table(
            f"Torque of 24 half orders: {of.name}",
            ["method", "samples", "error", "µs"],
            [
                [
                    row["method"],
                    str(row["samples"]),
                    f"{row['error']:.1e}",
                    f"{1e6 * row['seconds']:.1f}",
                ]
                for row in rows
                if row["cycle"] == of.name
            ],
        )
    picture(rows).savefig(given.out / "gas_orders.png", dpi=110)
    print(f"\nRaw figures and picture: {given.out}")


if __name__ == "__main__":
    main()
