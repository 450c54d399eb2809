"""What does the peak moment over bank angle cost, for how many right digits?

``python benchmarks/peaks.py`` takes the V6 of the IJESC paper (2017), its four firing orders at 171
bank angles, and asks for the longest moment of orders 1 and 2 together: by samples of the crank
angle, a pass for each bank angle as in the paper or all in one product of matrices; by samples that
are polished; and by crankpin's true extrema. The same for one engine at one angle. It writes
``peaks.csv`` and ``peaks.png`` to ``--out``, by default ``benchmarks/out``; ``--quick`` takes fewer
bank angles and settings.

The error is the worst over engines and angles against 50 digits, relative to each one's peak.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import crankpin as cp
import mpmath
import numpy as np
from _diagram import OURS, Point, draw, few, outcome
from _references import harmonics_mp, ijesc
from _timing import interleaved, machine, print_table, write_csv
from matplotlib.figure import Figure
from numpy.typing import NDArray

Array = NDArray[np.float64]

SAMPLES = (36, 72, 180, 360, 720, 1800, 3600)
COARSE = (6, 8, 10, 12, 16, 24, 36, 72)
STEPS = 5
"""Of Newton's method: from a good start more change nothing."""
A2 = float(harmonics_mp.even_harmonic_closed_form(ijesc.ROD_RATIO, 2))
BLOCK = 32768
"""Samples at a time that stay in the cache."""
HEADER = (
    *("sweep", "peaks", "method", "knob", "setting", "outcome", "worst_relative_error"),
    *("seconds", "seconds_per_peak", "least_of"),
)


class Sweep(NamedTuple):
    """Which engines at which bank angles."""

    name: str
    firing_orders: tuple[tuple[int, ...], ...]
    bank_angles_deg: tuple[float, ...]

    @property
    def peaks(self) -> int:
        """How many are asked for."""
        return len(self.firing_orders) * len(self.bank_angles_deg)


FULL = Sweep(
    "4 firing orders × 171 bank angles", ijesc.FIRING_ORDERS, tuple(np.arange(10.0, 181.0).tolist())
)
COARSER = Sweep(
    "4 firing orders × 18 bank angles",
    ijesc.FIRING_ORDERS,
    tuple(np.arange(10.0, 181.0, 10.0).tolist()),
)
ONE = Sweep("one engine at one bank angle", ijesc.FIRING_ORDERS[:1], (60.0,))


# --- methods: (n_firing_orders, n_bank_angles), N m -----------------------------------------------


def as_the_paper(sweep: Sweep, samples: int) -> Array:
    """Sample the crank angle for one engine at one bank angle after the other."""
    return ijesc.longest_moment(sweep.bank_angles_deg, sweep.firing_orders, A2, samples)


def phasors(sweep: Sweep) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Moments about the bisector and the lateral axis, (n_firing_orders · n_bank_angles, 2)."""
    half = np.deg2rad(np.array(sweep.bank_angles_deg)) / 2
    scale = ijesc.force_scale() * np.array([1.0, A2])
    turn = np.exp(1j * half[:, None] * np.array([1, 2]))
    z = ijesc.bank_phasors(sweep.firing_orders)[:, None] * scale[:, None]
    right, left = z[..., 0] * turn, z[..., 1] * turn.conj()
    along = (left + right) * np.cos(half)[:, None]
    across = (left - right) * np.sin(half)[:, None]
    return along.reshape(-1, 2), across.reshape(-1, 2)


def parts(values: NDArray[np.complex128]) -> Array:
    """Real and imaginary parts side by side: (n, 4)."""
    return np.concatenate([values.real, values.imag], axis=1)


@lru_cache
def waves(samples: int) -> Array:
    """Turn orders 1 and 2, so that parts(P) @ waves is Re Σ P e^{inθ}: (4, samples)."""
    theta = 2 * np.pi * np.arange(samples) / samples
    return np.array([np.cos(theta), np.cos(2 * theta), -np.sin(theta), -np.sin(2 * theta)])


def squares(sweep: Sweep, samples: int, take: Callable[[Array], Array]) -> Array:
    """Take something of the squared lengths at all crank angles, as many peaks at once as fit."""
    x, y = map(parts, phasors(sweep))
    turns = waves(samples)
    rows = max(1, BLOCK // samples)
    found = []
    for start in range(0, len(x), rows):
        along, across = x[start : start + rows] @ turns, y[start : start + rows] @ turns
        along *= along
        across *= across
        along += across
        found.append(take(along))
    return np.concatenate(found)


def sampled(sweep: Sweep, samples: int) -> Array:
    """Sample the crank angle for all at once."""
    longest = np.sqrt(squares(sweep, samples, lambda square: square.max(axis=1)))
    return longest.reshape(len(sweep.firing_orders), -1)


def polished(sweep: Sweep, samples: int) -> Array:
    """Polish the longest sample of each by Newton's method, all at once."""
    theta = squares(sweep, samples, lambda square: square.argmax(axis=1)) * (2 * np.pi / samples)
    both = np.stack(phasors(sweep))
    n = 1j * np.array([1, 2])
    for step in range(STEPS + 1):
        terms = both * np.exp(theta[:, None] * n)
        value = terms.sum(axis=2).real
        if step == STEPS:
            break
        slope, bend = (terms @ n).real, (terms @ n**2).real
        # half the derivatives of the squared length
        first = (value * slope).sum(axis=0)
        second = (slope**2 + value * bend).sum(axis=0)
        theta = theta - first / second
    return np.asarray(np.hypot(*value).reshape(len(sweep.firing_orders), -1))


@lru_cache
def engines(firing_orders: tuple[tuple[int, ...], ...]) -> tuple[cp.Engine, ...]:
    """Build them once: what changes is the bank angle."""
    cylinder = cp.Cylinder(ijesc.CRANK_RADIUS, ijesc.ROD_LENGTH, ijesc.MASS)
    return tuple(
        cp.Engine.from_firing_order(
            cylinder, order, bank_angle_deg=60, rule="ijesc", spacing=ijesc.SPACING
        )
        for order in firing_orders
    )


def ours(sweep: Sweep, _setting: None = None) -> Array:
    """Ask crankpin for true extrema, about the paper's plane, that of crank 1."""
    built = engines(sweep.firing_orders)
    if sweep.peaks == 1:
        one = built[0].replace(reference_z=0.0).balance(ijesc.RPM, orders=(1, 2), torque=False)
        return np.array([[one.total.moment.peak]])
    found = cp.sweep(
        [engine.replace(reference_z=0.0) for engine in built],
        rpm=ijesc.RPM,
        bank_angle_deg=sweep.bank_angles_deg,
        hold="pins",
        orders=(1, 2),
        torque=False,
    )
    return np.asarray(found.total.moment.peak)


class Method(NamedTuple):
    """A way to the peaks."""

    name: str
    knob: str
    settings: tuple[int | None, ...]
    function: Callable[..., Array]


METHODS = (
    Method("as the paper", "crank angles", SAMPLES, as_the_paper),
    Method("NumPy, samples", "crank angles", SAMPLES, sampled),
    Method("NumPy, samples polished", "crank angles", COARSE, polished),
    Method(OURS, "", (None,), ours),
)


# --- reference ------------------------------------------------------------------------------------


@lru_cache
def exact(sweep: Sweep) -> list[Any]:
    """Peaks to 50 digits, one engine after the other.

    Every local maximum among 1440 samples that may be the peak is polished by Newton's method.
    """
    square = squares(sweep, 1440, lambda square: square)
    # a sample next to the peak is short of it by (2·2π/1440)²/2 at most
    high = square >= square.max(axis=1, keepdims=True) * (1 - 1e-3)
    for side in (1, -1):
        high &= square >= np.roll(square, side, axis=1)
    found = []
    with mpmath.workdps(harmonics_mp.DIGITS + 10):
        scale = mpmath.mpf(ijesc.MASS) * mpmath.mpf(ijesc.CRANK_RADIUS)
        scale *= (2 * mpmath.pi * mpmath.mpf(ijesc.RPM) / 60) ** 2 * mpmath.mpf(ijesc.SPACING)
        a2 = harmonics_mp.even_harmonic_closed_form(ijesc.ROD_RATIO, 2)
        for index, candidates in enumerate(high):
            firing, angle = divmod(index, len(sweep.bank_angles_deg))
            lags = ijesc.lags_deg(sweep.firing_orders[firing])
            curve = exact_phasors(lags, sweep.bank_angles_deg[angle], a2)
            starts = 2 * mpmath.pi / 1440 * np.flatnonzero(candidates)
            peaks = [polish(curve, start) for start in starts]
            found.append(scale * mpmath.sqrt(max(peaks)))
    return found


def exact_phasors(lags_deg: Array, bank_angle_deg: float, a2: Any) -> list[tuple[Any, Any]]:  # noqa: ANN401
    """Phasors of the moment along both axes, of each order, over m·r·ω² times the spacing."""
    degree = mpmath.pi / 180
    half = mpmath.mpf(bank_angle_deg) / 2 * degree
    found = []
    for n, amplitude in ((1, mpmath.mpf(1)), (2, a2)):
        right, left = (
            amplitude
            * sum(
                place * mpmath.expj(n * (sign * half - mpmath.mpf(float(lag)) * degree))
                for place, lag in enumerate(lags_deg[first::2])
            )
            for first, sign in ((0, 1), (1, -1))
        )
        found.append(((left + right) * mpmath.cos(half), (left - right) * mpmath.sin(half)))
    return found


def polish(curve: list[tuple[Any, Any]], theta: Any) -> Any:  # noqa: ANN401
    """Squared length at the extremum next to θ, by Newton's method."""
    for _ in range(60):
        value, slope, bend = (
            [
                sum((p[axis] * (1j * n) ** k * mpmath.expj(n * theta)).real for n, p in orders)
                for axis in (0, 1)
            ]
            for k in (0, 1, 2)
            for orders in [list(enumerate(curve, start=1))]
        )
        first = sum(v * s for v, s in zip(value, slope, strict=True))
        second = sum(s * s + v * b for v, s, b in zip(value, slope, bend, strict=True))
        step = first / second
        theta -= step
        # the peak is off by the square of what the angle is
        if abs(step) < mpmath.mpf(10) ** (-harmonics_mp.DIGITS // 2 - 3):
            return sum(v * v for v in value)
    raise RuntimeError(f"no extremum next to {theta}")


def worst_error(sweep: Sweep, found: Array) -> float:
    """Worst error of a peak relative to itself."""
    with mpmath.workdps(harmonics_mp.DIGITS):
        pairs = zip(found.ravel().tolist(), exact(sweep), strict=True)
        return float(max(abs(mpmath.mpf(a) / b - 1) for a, b in pairs))


# --- the chart ------------------------------------------------------------------------------------


def measure(sweeps: tuple[Sweep, ...] = (FULL, ONE), quick: bool = False) -> list[dict[str, Any]]:
    """Run all methods at all settings: a row of the CSV for each."""
    rows = []
    rounds, each = (2, 10) if quick else (4, 5)
    for sweep in sweeps:
        runs = {
            (method, setting): partial(method.function, sweep, setting)
            for method in METHODS
            for setting in (few(method.settings, 3) if quick else method.settings)
        }
        seconds = interleaved(
            {str(key): run for key, run in runs.items()}, rounds, 0.0 if quick else 0.2, each
        )
        for key, run in runs.items():
            method, setting = key
            error = worst_error(sweep, run())
            rows.append(
                {
                    "sweep": sweep.name,
                    "peaks": sweep.peaks,
                    "method": method.name,
                    "knob": method.knob,
                    "setting": "" if setting is None else setting,
                    "outcome": outcome(error),
                    "worst_relative_error": error,
                    "seconds": seconds[str(key)],
                    "seconds_per_peak": seconds[str(key)] / sweep.peaks,
                    "least_of": rounds * each,
                }
            )
    return rows


def panels(rows: list[dict[str, Any]]) -> list[tuple[str, list[dict[str, Any]]]]:
    """Group the rows by sweep."""
    names = dict.fromkeys(row["sweep"] for row in rows)
    return [(name, [row for row in rows if row["sweep"] == name]) for name in names]


def picture(rows: list[dict[str, Any]]) -> Figure:
    """Draw time over error, a panel for each sweep."""
    groups = panels(rows)
    figure = Figure(figsize=(12, 5), layout="constrained")
    axes = figure.subplots(1, len(groups), squeeze=False)
    for ax, (name, group) in zip(axes.flat, groups, strict=True):
        found = [
            Point(r["method"], str(r["setting"]), r["worst_relative_error"], r["seconds_per_peak"])
            for r in group
        ]
        names = [method.name for method in METHODS]
        title = f"Peak moment, {name}"
        draw(ax, found, names, title, "worst error of a peak", "seconds per peak")
    axes[0, 0].legend(fontsize=8)
    return figure


def main() -> None:
    """Measure, print, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="fewer bank angles and settings")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    ran_on = machine("mpmath", "matplotlib")
    print(ran_on)
    rows = measure((COARSER, ONE), quick=True) if given.quick else measure()
    write_csv(given.out / "peaks.csv", ran_on, HEADER, ([row[k] for k in HEADER] for row in rows))
    for name, group in panels(rows):
        print_table(
            f"Longest moment of orders 1 and 2: {name}",
            ["method", "crank angles", "worst error", "µs a peak", "of ours"],
            [
                [
                    row["method"],
                    str(row["setting"]),
                    f"{row['worst_relative_error']:.1e}",
                    f"{1e6 * row['seconds_per_peak']:.2f}",
                    f"{row['seconds'] / group[-1]['seconds']:.2f} ×",
                ]
                for row in group
            ],
        )
    picture(rows).savefig(given.out / "peaks.png", dpi=110)
    print(f"\nRaw figures and picture: {given.out}")


if __name__ == "__main__":
    main()
