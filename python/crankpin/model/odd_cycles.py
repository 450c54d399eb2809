"""Detection of spikes and odd cycles by comparison with the median over cycles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin._support import inputs, units
from crankpin._support.messages import Hint, warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

FEWEST_CYCLES = 8
"""Cycles from which their median, and the spread about it, are those of sound ones."""
FEWEST_POINTS = 90
"""Points of a cycle, every 8° of four strokes, from which a sample is distinguished from a peak."""
BESIDE_DEG = 2.0
"""Degrees beside a sample at which its neighbours are: spikes are narrower, combustion is wider."""
FARTHEST = 4
"""Samples beside it at most."""
SMALLEST, SMALLEST_ALONE = 0.005, 0.04
"""Smallest spikes, over the range of pressure, among many cycles and of a single one: below them a
sample changes imep by less than 0.01 %, and peaks of combustion of one cycle are as sharp."""
DEVIATIONS = 8.0
"""Standard deviations from which a sample or a cycle is odd: noise of 10⁸ samples has 6."""
SHADOW = 0.4
"""Height over that of a spike beside it up to which a sample of a single cycle is sound."""
MOST_SPIKES = 5
"""Spikes of a cycle above which it oscillates: it knocks, or the sensor is loose."""
OF_A_NORMAL = 1.482602
"""Standard deviation over median magnitude of normally distributed numbers."""
INTAKE, COMPRESSION, LATE, EXPANSION = (
    (-190.0, -120.0),
    (-100.0, -35.0),
    (-45.0, -20.0),
    (10.0, 90.0),
)
"""Crank angles after the median's peak of: the lowest pressure; compression, that is the same in
all cycles, and its end; and the expansion, which a misfire lacks."""
LEAST_COMPRESSION = 0.7
"""Compression over the usual one below which a valve is open or the signal is lost."""
MISFIRE, STRONG = 0.6, 1.6
"""Expansion over the usual one below and above which a cycle is odd: combustion of one load varies
by 0.2 at most, and a motored cycle has 0.4."""
SHIFTED, SHIFT_DEVIATIONS = 1.0, 5.0
"""Degrees by which a cycle is odd, and standard deviations: an encoder jitters by 0.1°, and a
charge that varies by 1 % looks like 0.3°."""
NEARLY = 5.0
"""Degrees up to which a cycle without combustion seems to be shifted, since it is cooler."""
FARTHEST_SHIFT = 40.0
"""Degrees up to which compressions are compared; larger shifts are whole degrees of the peak."""
STEP_OF_SHIFTS = 0.5
"""Degrees between samples of that comparison, at least."""
LEAST_MATCH = 0.5
"""Part of the squares of a compression that the best shift must explain."""
UNLIKE = 0.05
"""Deviation from the median, over its range, from which a cycle is odd."""
ABOUT = "measured pressure:"
"""Beginning of the warning of spikes and odd cycles."""
MOST_CYCLES_NAMED = 3
"""Number of cycles that a warning names; of more it gives the count."""


class Odd(NamedTuple):
    """A spike in a cycle, or a cycle that is unlike the others."""

    cycle: int
    """Index of the cycle, from 0."""
    kind: str
    """``"spike"``, ``"oscillation"``, ``"misfire"``, ``"shifted"`` or ``"unlike"``."""
    at_deg: float
    """Crank angle, degrees; NaN of a whole cycle."""
    size: float
    """Height of a spike or oscillation, bar; shift, degrees; of others part of the usual."""
    unit: str

    def __str__(self) -> str:
        """Return it in words."""
        name = f"traces[{self.cycle}]"
        if self.kind in {"spike", "oscillation"}:
            height = units.shown(units.figure(self.size, "bar", 3))
            has = "a spike of" if self.kind == "spike" else "oscillations of"
            return f"{name} has {has} {height} at {self.at_deg:.4g}°"
        if self.kind == "shifted":
            return f"{name} is shifted by {self.size:.3g}°"
        share = f"{100.0 * self.size:.3g} % of the usual"
        return (
            f"{name} misfires ({share})"
            if self.kind == "misfire"
            else f"{name} is unlike ({share})"
        )


class Oddities(NamedTuple):
    """Odd cycles and spikes, and the pressure without spikes."""

    listed: tuple[Odd, ...]
    """Odd cycles and spikes, by cycle."""
    spikes: NDArray[np.intp]
    """Index of cycle and angle of each sample of a spike: (n_samples, 2)."""
    replaced: NDArray[np.float64]
    """Replacement of these samples, Pa: (n_samples,)."""

    @property
    def cycles(self) -> tuple[int, ...]:
        """Indices of odd cycles."""
        return tuple(sorted({oddity.cycle for oddity in self.listed if oddity.kind != "spike"}))

    def repaired(self, pressure: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return pressure without the spikes, interpolated beside the median."""
        if not len(self.spikes):
            return pressure
        rows = pressure.copy()
        rows[tuple(self.spikes.T)] = self.replaced
        return rows


def find(
    theta_deg: NDArray[np.float64], pressure: NDArray[np.float64], period_deg: float
) -> Oddities:
    """Return the spikes and odd cycles of pressure by cycle and angle, Pa."""
    nothing = Oddities((), np.empty((0, 2), dtype=np.intp), np.empty(0))
    middle = _median(pressure)
    spread = float(np.ptp(middle)) if middle.size else 0.0
    if len(theta_deg) < FEWEST_POINTS or not spread > 0.0:
        return nothing
    step = period_deg / len(theta_deg)
    several = len(pressure) >= FEWEST_CYCLES
    middle = middle if several else np.zeros(len(theta_deg))
    apart = pressure - middle
    heights = _heights(apart, step, spread, alone=not several)
    oddities, samples, values = list[Odd](), list[tuple[int, int]](), list[float]()
    clean = apart.copy()
    by_cycle: dict[int, list[Odd]] = {}
    for cycle in np.flatnonzero(heights.any(axis=1)).tolist():
        groups = _groups(np.flatnonzero(heights[cycle]), len(theta_deg))
        sizes = np.abs(heights[cycle])
        tops = [group[int(sizes[group].argmax())] for group in groups]
        figures = [
            Odd(cycle, "spike", float(theta_deg[k]), float(heights[cycle, k]) / 1e5, "bar")
            for k in tops
        ]
        if len(groups) > MOST_SPIKES:
            largest = max(figures, key=lambda oddity: abs(oddity.size))
            by_cycle[cycle] = [largest._replace(kind="oscillation")]
            continue
        by_cycle[cycle] = figures
        for group in groups:
            inside, line = _bridged(apart[cycle], group)
            clean[cycle, inside] = line
            samples += [(cycle, k) for k in inside.tolist()]
            values += (middle[inside] + line).tolist()
    odd: dict[int, Odd] = {}
    if several:
        odd = _unlike(theta_deg, clean + middle, middle, period_deg)
    for cycle in sorted({*by_cycle, *odd}):
        oddities += [odd[cycle]] if cycle in odd else by_cycle[cycle]
    sound = [k for k, (cycle, _) in enumerate(samples) if cycle not in odd]
    return Oddities(
        tuple(oddities),
        np.array([samples[k] for k in sound], dtype=np.intp).reshape(-1, 2),
        np.array([values[k] for k in sound]),
    )


def _median(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the median of each column, some at a time: Ctrl-C is answered in between."""
    width = max(1, inputs.PIECE_NUMBERS // max(1, len(rows)))
    pieces = [rows[:, k : k + width] for k in range(0, rows.shape[1], width)]
    return np.concatenate([np.median(piece, axis=0) for piece in pieces] or [np.empty(0)])


def _heights(
    apart: NDArray[np.float64], step: float, spread: float, *, alone: bool
) -> NDArray[np.float64]:
    """Return the height of each sample above both of its neighbours, or below; 0 where no spike."""
    beside = min(FARTHEST, max(1, round(BESIDE_DEG / step)))
    before, after = (apart - np.roll(apart, k, axis=1) for k in (beside, -beside))
    both = np.sign(before) * np.minimum(np.abs(before), np.abs(after)) * (before * after > 0.0)
    size = np.abs(both)
    least = spread * (SMALLEST_ALONE if alone else SMALLEST)
    if alone:
        # A sharp peak is above its neighbours too; a cubic through them has nearly its height.
        far = np.roll(apart, 2 * beside, axis=1) + np.roll(apart, -2 * beside, axis=1)
        near = np.roll(apart, beside, axis=1) + np.roll(apart, -beside, axis=1)
        beyond = np.abs(apart - (4.0 * near - far) / 6.0)
        usual = DEVIATIONS * OF_A_NORMAL * float(np.median(beyond))
        # Nor is one that a spike beside it makes of its neighbours.
        around = [np.roll(size, k, axis=1) for k in range(-2 * beside, 2 * beside + 1)]
        beyond[size < SHADOW * np.max(around, axis=0)] = 0.0
        size = np.minimum(size, beyond)
    else:
        of_angle = _median(np.abs(apart - np.roll(apart, beside, axis=1)))
        around = [np.roll(of_angle, k) for k in range(-beside, beside + 1)]
        usual = DEVIATIONS * OF_A_NORMAL * np.max(around, axis=0)
    heights: NDArray[np.float64] = np.where(size > np.maximum(least, usual), both, 0.0)
    return heights


def _groups(places: NDArray[np.intp], count: int) -> list[list[int]]:
    """Return runs of neighbouring places; the last and the first of a cycle are neighbours."""
    groups = [group.tolist() for group in np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)]
    if len(groups) > 1 and groups[0][0] == 0 and groups[-1][-1] == count - 1:
        groups[0] = groups.pop() + groups[0]
    return groups


def _bridged(
    apart: NDArray[np.float64], group: list[int]
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Return the samples of a spike with those at its feet, and the line across them."""
    count, width = len(apart), len(group) + 2
    inside = (group[0] - 1 + np.arange(width)) % count
    first, last = apart[(inside[0] - 1) % count], apart[(inside[-1] + 1) % count]
    return inside, first + (last - first) * np.arange(1, width + 1) / (width + 1)


def _unlike(
    theta_deg: NDArray[np.float64],
    pressure: NDArray[np.float64],
    middle: NDArray[np.float64],
    period_deg: float,
) -> dict[int, Odd]:
    """Return the odd cycles by their index: each by its likely cause."""
    top = int(middle.argmax())
    away = (theta_deg - theta_deg[top] + period_deg / 2.0) % period_deg - period_deg / 2.0
    windows = [(away >= low) & (away <= high) for low, high in (INTAKE, LATE, EXPANSION)]
    if not all(window.any() for window in windows):
        return {}
    low, late, expansion = (pressure[:, window].mean(axis=1) for window in windows)
    compressed, burnt = _relative(late - low), _relative(expansion - low)
    shifts = _shifts(pressure, middle, away, period_deg)
    if np.isnan(shifts).all():
        return {}
    level = pressure - middle
    level = level - np.median(level, axis=1)[:, None]
    deviation = np.sqrt((level**2).mean(axis=1)) / float(np.ptp(middle))
    usual = float(np.nanmedian(shifts))
    weak = [burnt[k] < MISFIRE and _is_far(burnt, k, 0.0) for k in range(len(pressure))]
    by_cycle: dict[int, Odd] = {}
    for cycle in range(len(pressure)):
        if math.isnan(shifts[cycle]):
            by_cycle[cycle] = Odd(cycle, "unlike", math.nan, float(compressed[cycle]), "")
        elif abs(shifts[cycle] - usual) < NEARLY and weak[cycle]:
            by_cycle[cycle] = Odd(cycle, "misfire", math.nan, float(burnt[cycle]), "")
        elif _is_far(shifts, cycle, SHIFTED, SHIFT_DEVIATIONS):
            by_cycle[cycle] = Odd(cycle, "shifted", math.nan, float(shifts[cycle]), "°")
        elif compressed[cycle] < LEAST_COMPRESSION and _is_far(compressed, cycle, 0.0):
            by_cycle[cycle] = Odd(cycle, "unlike", math.nan, float(compressed[cycle]), "")
        elif weak[cycle]:
            by_cycle[cycle] = Odd(cycle, "misfire", math.nan, float(burnt[cycle]), "")
        elif (burnt[cycle] > STRONG and _is_far(burnt, cycle, 0.0)) or (
            deviation[cycle] > UNLIKE and _is_far(deviation, cycle, UNLIKE)
        ):
            by_cycle[cycle] = Odd(cycle, "unlike", math.nan, float(burnt[cycle]), "")
    return by_cycle


def _relative(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values over their median; 1 where that is nothing."""
    usual = float(np.median(values))
    shares: NDArray[np.float64] = values / usual if usual > 0.0 else np.ones(len(values))
    return shares


def _is_far(
    values: NDArray[np.float64], k: int, least: float, deviations: float = DEVIATIONS
) -> bool:
    """Return whether a value is farther from the median than others are by chance."""
    away = np.abs(values - np.nanmedian(values))
    return bool(away[k] > max(least, deviations * OF_A_NORMAL * float(np.nanmedian(away))))


def _shifts(
    pressure: NDArray[np.float64],
    middle: NDArray[np.float64],
    away: NDArray[np.float64],
    period_deg: float,
) -> NDArray[np.float64]:
    """Return by how many degrees each cycle is late, of its compression; NaN if it has none."""
    every = max(1, round(STEP_OF_SHIFTS * len(away) / period_deg))
    rows, usual, at = pressure[:, ::every], middle[::every], away[::every]
    count = len(usual)
    step = period_deg / count
    spectrum = np.conj(np.fft.rfft(usual - usual.mean()))
    coarse = np.fft.irfft(np.fft.rfft(rows, axis=1) * spectrum, count, axis=1).argmax(axis=1)
    coarse = (coarse + count // 2) % count - count // 2
    window = np.flatnonzero((at >= COMPRESSION[0]) & (at <= COMPRESSION[1]))
    most = round(FARTHEST_SHIFT / step)
    if len(window) < 8:
        return np.zeros(len(rows))
    model = usual[window] - usual[window].mean()
    lags = np.arange(-most, most + 1)
    index = np.arange(len(rows))

    def cost(lag: NDArray[np.intp]) -> NDArray[np.float64]:
        part = rows[index[:, None], (window + lag[:, None]) % count]
        return np.asarray(((part - part.mean(axis=1)[:, None] - model) ** 2).sum(axis=1))

    costs = np.column_stack([cost(np.full(len(rows), lag)) for lag in lags])
    best = costs.argmin(axis=1).clip(1, len(lags) - 2)
    left, mid, right = (costs[index, best + k] for k in (-1, 0, 1))
    bend = left - 2.0 * mid + right
    fine = np.divide(left - right, 2.0 * bend, out=np.zeros(len(rows)), where=bend > 0.0)
    shifts = (lags[best] + fine.clip(-1.0, 1.0)) * step
    far, left_over = np.abs(coarse * step) > FARTHEST_SHIFT, costs.min(axis=1)
    shifts, left_over = np.where(far, coarse * step, shifts), np.where(far, cost(coarse), left_over)
    shifts[left_over > (1.0 - LEAST_MATCH) * float(model @ model)] = np.nan
    return np.asarray(shifts, dtype=np.float64)


def report(oddities: Oddities) -> None:
    """Warn of spikes and odd cycles, the gravest of each first."""
    if ordered := sorted(
        oddities.listed, key=lambda oddity: (oddity.kind == "spike", oddity.cycle)
    ):
        rest = len(ordered) - MOST_CYCLES_NAMED
        names = ", ".join(map(str, ordered[:MOST_CYCLES_NAMED]))
        hint = Hint.of(
            'crankpin.prepare_trace replaces spikes, `spikes="replace"`, and leaves odd cycles '
            'out, `leave_out="odd"`'
        )
        warn(ABOUT, f"{names}{f' and {rest} more' if rest > 0 else ''}", hint)
