"""Where do methods fail, and what is promised there? Each case measures a method and crankpin.

A :class:`Case` has a condition, the error that crankpin promises not to pass, and two measurements:
the error of a method that one would take (``plain``) and crankpin's own. The tests hold
``ours() ≤ promise < plain()`` for each; ``stability.py`` draws the map. Harmonics have many methods
and a table of references of their own: :data:`HARMONICS`.

An error is relative to the right value unless the case says otherwise; 1 is wholly wrong.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import crankpin as cp
import methods
import mpmath
import numpy as np
from _references import faces, harmonics_mp, ito, kinematics, pressure, relative_errors

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORTY_DIGITS = 40

# --- harmonics ------------------------------------------------------------------------------------

HARMONICS_PROMISE = 1e-14
"""Of every order up to 200 without offset and up to 8 with one, real and imaginary part each
relative to itself: 45 units in the last place."""
HIGH_WITH_OFFSET = 5e-14
"""Of higher ones with an offset: the recurrence multiplies rounding by the order."""


class HarmonicCase(NamedTuple):
    """Orders of one slider-crank with their 50 digits."""

    row: harmonics_mp.ReferenceRow
    high: bool
    """orders 20 to 200, or 1 to 8"""

    @property
    def share(self) -> float:
        """Offset over the largest with which the crank turns, to ten digits."""
        ratio, offset = self.row.rod_ratio, self.row.offset_over_radius
        return float(f"{offset * ratio / (1 - ratio):.9g}")

    @property
    def name(self) -> str:
        """Which orders, where."""
        orders = "orders 20-200" if self.high else "orders 1-8"
        gap = 1 - self.row.rod_ratio
        ratio = f"{self.row.rod_ratio:.3g}" if gap > 1e-4 else f"1 − {gap:.0e}"
        if not self.share:
            return f"{orders}, λ = {ratio}"
        limit = f"{self.share:.1g}" if self.share < 0.9 else f"1 − {1 - self.share:.0e}"
        return f"{orders}, λ = {ratio}, offset {limit} of its limit"

    def error(self, method: methods.Method, knob: Any = None) -> float:  # noqa: ANN401
        """Worst error of an order relative to itself; NaN where the method refuses one of them.

        Orders that vanish, and parts of orders that do, are not looked at.
        """
        offset = [self.row.offset_over_radius] if self.share else None
        chosen = [
            (n, exact)
            for n, exact in zip(self.row.orders, self.row.coefficients(), strict=True)
            if (n >= 20) == self.high and (offset or n % 2 == 0)
        ]
        orders = [n for n, _ in chosen]
        (found,) = method([self.row.rod_ratio], orders, knob, offset)
        even = np.array(orders) % 2 == 0
        exact = np.array([value for _, value in chosen])
        parts = [np.where(even, values.real, values.imag) for values in (found, exact)]
        return float(relative_errors(*parts).max())

    @property
    def promise(self) -> float:
        """What crankpin's error does not pass."""
        return HIGH_WITH_OFFSET if self.high and self.share else HARMONICS_PROMISE

    def best(self, method: methods.Method) -> float:
        """Least error over the settings of the method's knob; NaN if it refuses at all of them."""
        errors = [self.error(method, knob) for knob in method.knobs]
        return min((error for error in errors if not math.isnan(error)), default=math.nan)


HARMONICS = [
    HarmonicCase(row, high)
    for row in harmonics_mp.reference_table(harmonics_mp.HARD_TABLE)
    for high in (False, True)
]

# --- everything else ------------------------------------------------------------------------------


class Case(NamedTuple):
    """A condition, what is promised there, and two measurements."""

    group: str
    condition: str
    promise: float
    reason: str
    """why this figure, and what it is relative to"""
    method: str
    plain: Callable[[], float]
    ours: Callable[[], float]


CYLINDER = cp.Cylinder(0.045, 0.158, 0.5)
RPM = 20_000.0
BALANCED = ("i6", "boxer-6", "v8-crossplane", "v12-60", "v14-49.54", "v16-45")
TWELVE = list(range(1, 13))


def first_order(engine: cp.Engine, rpm: float) -> float:
    """m·r·ω² of the first cylinder, N."""
    cylinder = engine.cylinders[0]
    omega = 2 * np.pi * rpm / 60
    return cylinder.reciprocating_mass * cylinder.crank_radius * omega**2


def plain_force(engine: cp.Engine, rpm: float, orders: list[int]) -> NDArray[np.complex128]:
    """Sum the forces of an engine without rotating masses in plain doubles: (n_orders, 2)."""
    weights = [c.reciprocating_mass * c.crank_radius for c in engine.cylinders]
    harmonics = engine.cylinders[0].harmonics(orders)
    omega = 2 * np.pi * rpm / 60
    sums = [methods.phasor_sum(weights, engine.bank_deg, engine.tdc_deg, n) for n in orders]
    return np.array(sums) * harmonics[:, None] * omega**2


def largest_of_zeros(plain: bool) -> float:
    """Largest force that vanishes by a proof in integers, over m·r·ω²."""
    worst = 0.0
    for name in BALANCED:
        engine = cp.Engine.preset(name).replace(rotating_mass=0.0)
        proof = engine.vanishing_orders(TWELVE)
        force = engine.balance(RPM, orders=TWELVE).force
        found = plain_force(engine, RPM, TWELVE) if plain else force.xy
        for axis, verdicts in enumerate((proof.force.x, proof.force.y)):
            zero = [n in verdicts.vanishing for n in TWELVE]
            worst = max(worst, float(np.abs(found[zero, axis]).max()) / first_order(engine, RPM))
    return worst


def inline_six(change: float = 0.0, count: int = 6) -> cp.Engine:
    """Build an inline engine on mirrored throws, one piston heavier by a part."""
    half = [360 * k / (count // 2) for k in range(count // 2)]
    heavier = CYLINDER.replace(reciprocating_mass=CYLINDER.reciprocating_mass * (1 + change))
    return cp.Engine.from_lists(
        [CYLINDER] * (count - 1) + [heavier],
        tdc_deg=half + half[::-1],
        bank_deg=[90] * count,
        z=(0.1 * np.arange(count)).tolist(),
    )


def imbalance(find: Callable[[cp.Engine], complex]) -> float:
    """Error of the first-order force that a 1e-9 heavier piston leaves, relative to that force."""
    engine = inline_six(1e-9)
    masses = [Fraction(c.reciprocating_mass) for c in engine.cylinders]
    share = float((masses[-1] - masses[0]) / masses[0])
    exact = share * first_order(engine, RPM)
    return abs(abs(find(engine)) / exact - 1)


def plain_with_threshold(engine: cp.Engine) -> complex:
    """First-order force along y, zero where it is below 1e-8 of one cylinder's."""
    force = plain_force(engine, RPM, [1])
    return complex(methods.thresholded(force, 1e-8 * first_order(engine, RPM))[0, 1])


def vee_reference(bank_angle_deg: float, order: int) -> complex:
    """Backward moment of a cross-plane V8 over m·r·ω²·a·aₙ, to forty digits."""
    with mpmath.workdps(FORTY_DIGITS):
        degree = mpmath.pi / 180
        half = mpmath.mpf(bank_angle_deg) / 2
        total = mpmath.mpc(0)
        for k, throw in enumerate(CROSS_PLANE):
            for bank in (90 - half, 90 + half):
                lever = mpmath.mpf(2 * k - 3) / 2
                tdc = bank - (90 - half) - throw
                # i·lever times conj(½ e^{−i(bank + n·tdc)})
                turned = mpmath.expj((bank + order * tdc) * degree)
                total += mpmath.mpc(0, 1) * lever * turned / 2
        return complex(total)


CROSS_PLANE = (0, 90, 270, 180)
LEVERS = np.repeat([-1.5, -0.5, 0.5, 1.5], 2)
ANGLES = (0.0, 1e-9, 1e-6, 90 - 1e-9, 90.0, 90 + 1e-9, 90 + 1e-6, 180 - 1e-6, 180 - 1e-9, 180.0)


def vee_eight(bank_angle_deg: float) -> cp.Engine:
    """Build a V8 on a cross-plane crank."""
    return cp.Engine.vee(
        CYLINDER, bank_angle_deg=bank_angle_deg, throws_deg=CROSS_PLANE, spacing=1.0
    )


def plain_backward(engine: cp.Engine, order: int) -> complex:
    """Backward moment over m·r·ω²·aₙ in plain doubles."""
    x, y = methods.phasor_sum(LEVERS, engine.bank_deg, engine.tdc_deg, order)
    moment_x, moment_y = -y, x
    return complex(np.conj(moment_x - 1j * moment_y) / 2)


def beside_right_angles(plain: bool) -> float:
    """Worst error of backward moments over m·r·ω²·a; what is zero must be zero."""
    worst = 0.0
    for angle in ANGLES:
        engine = vee_eight(angle)
        for order in (1, 2, 4):
            exact = vee_reference(angle, order)
            if plain:
                found = plain_backward(engine, order)
            else:
                balance = engine.balance(RPM, orders=[order])
                size = first_order(engine, RPM) * CYLINDER.harmonics([order])[0].real
                found = complex(balance.moment.backward[0]) / size
            if abs(exact) < 1e-30 and found != 0:
                return math.inf
            worst = max(worst, abs(found - exact))
    return worst


def far_crank_angle(turn: Callable[[float], float]) -> float:
    """Error of the piston's position a million turns on, over the crank radius."""
    far = 360e6 + 77.0
    with mpmath.workdps(FORTY_DIGITS):
        theta = mpmath.mpf(far) * mpmath.pi / 180
        radius, rod = mpmath.mpf(CYLINDER.crank_radius), mpmath.mpf(CYLINDER.rod_length)
        exact = radius * mpmath.cos(theta) + mpmath.sqrt(rod**2 - (radius * mpmath.sin(theta)) ** 2)
        return float(abs(mpmath.mpf(turn(far)) - exact)) / CYLINDER.crank_radius


SHARP = cp.Cylinder(1 - 1e-12, 1.0, 1.0)
AROUND_THE_SPIKE = 90 + np.array([-1e-3, -1e-4, -3e-5, 0.0, 3e-5, 1e-4, 1e-3])


def near_the_spike(find: Callable[[], NDArray[np.float64]]) -> float:
    """Worst error of the acceleration about θ = 90° at λ = 1 − 1e-12, over the largest."""
    found = find()
    with mpmath.workdps(FORTY_DIGITS):
        radius = mpmath.mpf(SHARP.crank_radius)
        exact = []
        for degrees in AROUND_THE_SPIKE:
            theta = mpmath.mpf(float(degrees)) * mpmath.pi / 180
            sine, cosine = mpmath.sin(theta), mpmath.cos(theta)
            height = mpmath.sqrt(1 - (radius * sine) ** 2)
            slope = -(radius**2) * sine * cosine / height
            bend = -(radius**2 * (cosine**2 - sine**2) + slope**2) / height
            exact.append(float(bend - radius * cosine))
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def sampled_torque(samples: int) -> float:
    """Error of the first orders of torque in so many samples of a single's turn."""
    engine = cp.Engine.preset("single")
    theta = 360 * np.arange(samples) / samples
    torque = engine.waveform(6000, theta_deg=theta).torque
    exact = engine.balance(6000, orders=[1, 2, 3, 4]).torque
    found = [methods.order_of_samples(torque, n) for n in (1, 2, 3, 4)]
    return float(np.abs((np.array(found) - exact) / exact).max())


def few_angles_or_many() -> float:
    """Error of orders by number against 4096 samples, and of few angles against many."""
    engine = cp.Engine.preset("single")
    few, many = (
        engine.waveform(6000, theta_deg=np.arange(0, 360, step)).torque for step in (60.0, 1.0)
    )
    if not np.array_equal(few, many[::60]):
        return math.inf
    return sampled_torque(4096)


# Peaks: orders, phasors, the true peak of |Re Σ|.
TURN = np.exp(1j * np.arange(1, 21) * math.sqrt(0.5))
"""Phases that put no peak on a grid of samples."""


def peak_case(phasors: dict[int, float], true: float) -> tuple[list[int], list[complex], float]:
    """Turn a sum of cosines by an angle that is no part of a turn."""
    return list(phasors), [a * complex(TURN[n - 1]) for n, a in phasors.items()], true


FLAT = peak_case({1: 9.0, 3: -1.0}, 8.0)
"""9 cos θ − cos 3θ, with the slope −12 sin³θ: T'' = T''' = 0 at both of its equal peaks, ±8."""
NEARLY_EQUAL = peak_case({1: 1e-3, 20: 1.0}, 1.001)
"""Twenty peaks that differ by less than samples miss them by; highest where both terms are."""
SHARP_PEAK = peak_case(dict.fromkeys(range(1, 21), 1.0), 20.0)
"""Twenty orders in phase."""


def peak_error(case: tuple[list[int], list[complex], float], samples: int | None) -> float:
    """Error of a peak by samples, or ours."""
    orders, phasors, true = case
    if samples is not None:
        return abs(methods.sampled_peak(orders, phasors, samples) / true - 1)
    return abs(our_peak(orders, phasors) / true - 1)


def our_peak(orders: list[int], phasors: list[complex]) -> float:
    """Find the peak of the force of one upright cylinder with that spectrum, over ω²."""
    engine = cp.Engine.preset("single").replace(rotating_mass=0.0)
    rpm = 60 / (2 * np.pi)
    found = engine.balance(rpm, orders=orders, spectrum=dict(zip(orders, phasors, strict=True)))
    return float(found.total.force.peak_xy[1])


def polished_error(case: tuple[list[int], list[complex], float], samples: int) -> float:
    """Error of the peak by polishing the highest sample."""
    orders, phasors, true = case
    return abs(methods.polished_peak(orders, phasors, samples) / true - 1)


def search_error(tolerance: float | None, throws: int = 7) -> float:
    """Error of the count of pairs of arrangements with a balanced bank angle: a V-14, or a V-18."""
    found = cp.search_arrangements(2 * throws, alternating=throws == 7).qualifying
    if tolerance is None:
        # counted by integer keys in NumPy, as the tests of the search do again
        return abs(found / {7: 12_936, 9: 20_983_536}[throws] - 1)
    if throws == 7:
        moments = ito.bank_sum(ito.arrangements())
    else:
        rest = np.array(list(itertools.permutations(range(1, throws))))
        phases = np.concatenate([np.zeros((len(rest), 1), int), rest], axis=1)
        turned = np.exp(2j * np.pi * phases / throws)
        moments = ((np.arange(throws) - (throws - 1) / 2) * turned).sum(axis=1)
    # with the first phase in front, the others by turning each bank
    turns = 1 if throws == 7 else throws**2
    return abs(methods.equal_magnitude_pairs(moments, tolerance) * turns / found - 1)


TINY, HUGE = 2.0**-66, 2.0**66


def scaled_force(length: float, mass: float, *, plain: bool) -> float:
    """Error of zeros and of force in units of this length and mass, against those in m and kg."""
    cylinder = cp.Cylinder(0.045 * length, 0.158 * length, 0.5 * mass)
    layout: dict[str, Any] = {"bank_angle_deg": 60, "throws_deg": [0, 120, 240]}
    engine = cp.Engine.vee(cylinder, spacing=0.1 * length, **layout)
    reference = cp.Engine.vee(cp.Cylinder(0.045, 0.158, 0.5), spacing=0.1, **layout)
    # the same piston speed: forces as mass over length
    rpm, force = 6000 / length, mass / length
    exact = reference.balance(6000, orders=TWELVE)
    if plain:
        found = methods.thresholded(plain_force(engine, rpm, TWELVE), 1e-9) / force
        return worst_of_phasors(found, exact.force.xy)
    ours = engine.balance(rpm, orders=TWELVE)
    forces = worst_of_phasors(ours.force.xy / force, exact.force.xy)
    return max(forces, worst_of_phasors(ours.moment.xy / mass, exact.moment.xy))


def worst_of_phasors(found: NDArray[np.complex128], exact: NDArray[np.complex128]) -> float:
    """Worst error of a phasor relative to its size; what is zero must be zero."""
    if np.any(found[exact == 0] != 0):
        return math.inf
    there = exact != 0
    return float((np.abs(found - exact)[there] / np.abs(exact)[there]).max())


def many_cylinders(count: int, *, plain: bool) -> float:
    """Largest force and moment of order 1 that an even inline engine of so many leaves."""
    engine = inline_six(count=count)
    if plain:
        return float(np.abs(plain_force(engine, RPM, [1])).max() / first_order(engine, RPM))
    balance = engine.balance(RPM, orders=[1])
    return float(max(np.abs(balance.force).max(), np.abs(balance.moment).max()))


def single(plain: bool) -> float:
    """Error of an upright single's force; across the bore it is zero."""
    engine = cp.Engine.from_lists(CYLINDER, tdc_deg=[0], bank_deg=[90], z=[0])
    size = first_order(engine, RPM)
    exact = np.stack([np.zeros(3), size * CYLINDER.harmonics([1, 2, 4]).real], axis=1)
    found = (
        plain_force(engine, RPM, [1, 2, 4])
        if plain
        else engine.balance(RPM, orders=[1, 2, 4]).force
    )
    return float(relative_errors(found, exact).max())


# --- opposed pistons and compressors --------------------------------------------------------------

LEADS = (0, 1e-12, 1e-9, 1e-6, 1e-3, 30, 180 - 1e-3, 180 - 1e-9, 180)
COMPRESSOR = cp.Cylinder(0.125, 0.625, 180.0, bore=0.3)
POLYTROPIC = 1.3
PRESSURES = (1e5, 4e5)


def lead_error(leads: Iterable[float], *, plain: bool, relative: bool = False) -> float:
    """Worst error of orders 1 and 2 of opposed pistons over m·r·ω²; what is zero must be zero.

    Or relative to themselves.
    """
    amplitudes = {1: 1.0, 2: abs(complex(CYLINDER.harmonics([2])[0]))}
    worst = 0.0
    for lead in leads:
        engine = cp.Engine.opposed_pistons(
            CYLINDER, throws_deg=[0], spacing=0.1, distance=0.9, lead_deg=lead
        )
        size = first_order(engine, RPM)
        for order, amplitude in amplitudes.items():
            with mpmath.workdps(FORTY_DIGITS):
                turned = mpmath.mpf(lead) * order / 2
                turned -= 180 * mpmath.nint(turned / 180)
                exact = 2.0 * amplitude * float(abs(mpmath.sin(mpmath.radians(turned))))
            if plain:
                parts = np.abs(
                    methods.phasor_sum([1.0] * 2, engine.bank_deg, engine.tdc_deg, order)
                )
                found = amplitude * float(np.hypot(*parts))
            else:
                found = float(engine.balance(RPM, orders=[order]).force.peak[0]) / size
            error = abs(found - exact) / (exact if relative else 1.0)
            worst = max(worst, error if exact or not found else math.inf)
    return worst


def unlike_masses(*, plain: bool) -> float:
    """Error of the force of two opposed throws whose masses are apart by 1e-12, of that force."""
    masses = (180.0, 180.0 * (1.0 + 1e-12))
    parts = [COMPRESSOR.replace(reciprocating_mass=mass) for mass in masses]
    engine = cp.Engine.opposed_throws(parts, throws_deg=[0, 180], spacing=0.32)
    exact = (masses[1] - masses[0]) * 0.125 * (2 * np.pi * 10) ** 2
    if plain:
        weights = [mass * 0.125 for mass in masses]
        sums = methods.phasor_sum(weights, engine.bank_deg, engine.tdc_deg, 1)
        found = float(np.hypot(*np.abs(sums))) * (2 * np.pi * 10) ** 2
    else:
        found = float(engine.balance(600.0, orders=[1]).force.peak[0])
    return abs(found / exact - 1.0)


def clearance_error(*, plain: bool) -> float:
    """Worst error of the work of a compressor whose clearance tends to none, of that work."""
    suction, discharge = PRESSURES
    ratio, n = discharge / suction, POLYTROPIC
    theta = np.radians(np.arange(0.0, 360.5, 0.5))
    part, grows = faces.swept(theta, "head", 0.125, 0.625)
    worst = 0.0
    for clearance in (0.1, 1e-6, 1e-12, 0.0):
        drawn_in = 1.0 - clearance * (ratio ** (1.0 / n) - 1.0)
        exact = suction * drawn_in * n / (n - 1.0) * (ratio ** ((n - 1.0) / n) - 1.0)
        if plain:
            with np.errstate(divide="ignore", invalid="ignore"):
                pressure = faces.compressed(part, grows, suction, discharge, clearance, n)
            work = -faces.loop(pressure, part)
        else:
            cycle = cp.Cycle.compressor(
                COMPRESSOR, suction=suction, discharge=discharge, clearance=clearance, n=n
            )
            work = -cycle.imep(COMPRESSOR)
        worst = max(worst, abs(work / exact - 1.0)) if not math.isnan(work) else math.nan
    return worst


def thick_rod(*, plain: bool) -> float:
    """Worst error of a crank end's mean torque, of that torque, as its rod fills the bore."""
    bore = 0.3
    cycle = cp.Cycle.compressor(COMPRESSOR, suction=1e5, discharge=4e5, end="crank")
    bare = cp.Engine.inline(COMPRESSOR, throws_deg=[0], spacing=0.3, strokes=2)
    worst = 0.0
    for rod in (0.06, bore * (1 - 1e-9), bore * (1 - 1e-12), math.nextafter(bore, 0.0), bore):
        with mpmath.workdps(FORTY_DIGITS):
            area = float(mpmath.pi / 4 * (mpmath.mpf(bore) ** 2 - mpmath.mpf(rod) ** 2))
        unit = 0.25 * cycle.imep(COMPRESSOR, end="crank") / (2 * np.pi)
        if plain:
            found = (np.pi / 4 * bore**2 - np.pi / 4 * rod**2) * unit
        else:
            engine = bare.with_cycle(None, crank_end=cycle, rod_diameter=rod)
            found = float(engine.balance(100.0, orders=[1]).crank_torque.cycle_mean)
        error = abs(found / (area * unit) - 1.0) if area else abs(found)
        worst = max(worst, error)
    return worst


# --- gas torque -----------------------------------------------------------------------------------

FIRED = CYLINDER.replace(bore=0.086)
CRANK = (0.045, 0.158, 0.0)
HALF_ORDERS = np.arange(1, 25) / 2.0
STROKES = np.radians([0.0, 180.0, 360.0, 540.0, 720.0])
ATMOSPHERE = 101_325.0

Pressure = Callable[["NDArray[np.float64]"], "NDArray[np.float64]"]


def peak_of_pressure(theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a smooth pressure with a peak of 61 bar at 12°, 40° wide, θ in radians."""
    wave: NDArray[np.float64] = np.cos((theta - np.radians(12.0)) / 2.0)
    return 1e5 + 6e6 * np.exp(60.0 * (wave - 1.0))


def otto_pressure(theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the pressure of an Otto cycle of compression ratio 10, n = 1.3, p₃/p₂ = 3.5."""
    volume = pressure.chamber(theta, 10.0, CRANK)
    expansion = 3.5 * ATMOSPHERE * (10.0 / volume) ** 1.3
    before = np.where(theta < STROKES[3], ATMOSPHERE, ATMOSPHERE * (10.0 / volume) ** 1.3)
    return np.where(theta < STROKES[1], expansion, before)


def exact_gas(of: Pressure, orders: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return phasors by Gauss quadrature between the dead centres."""
    return pressure.torque_phasors(of, STROKES, orders, 0.086, CRANK, ATMOSPHERE)[1]


def sampled_gas(of: Pressure, theta_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the first 24 phasors of a transform of samples, as if they filled a period evenly."""
    theta = np.radians(theta_deg)
    area = math.pi / 4.0 * 0.086**2
    torque = -(of(theta) - ATMOSPHERE) * area * pressure.slope(theta, *CRANK)
    found: NDArray[np.complex128] = np.fft.rfft(torque)[1:25] * (2.0 / len(theta))
    return found


def tabled(of: Pressure, theta_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return crankpin's phasors of a table."""
    cycle = cp.Cycle(theta_deg, of(np.radians(theta_deg)))
    return cycle.torque_harmonics(FIRED, HALF_ORDERS)


def closed_grid(found: NDArray[np.complex128]) -> float:
    """Error of order 12 of the smooth peak, relative to itself."""
    exact = exact_gas(peak_of_pressure, HALF_ORDERS)
    return float(abs(found[-1] - exact[-1]) / abs(exact[-1]))


def uneven_grid(*, plain: bool) -> float:
    """Largest error over the largest phasor of the peak on a grid of 3°, of 0.5° about it."""
    theta = np.unique(np.concatenate([np.arange(0.0, 720.0, 3.0), np.arange(0.0, 60.0, 0.5)]))
    exact = exact_gas(peak_of_pressure, HALF_ORDERS)
    found = tabled(peak_of_pressure, theta)
    if plain:
        angles = np.radians(np.append(theta, 720.0))
        area = math.pi / 4.0 * 0.086**2
        gauge = peak_of_pressure(angles) - ATMOSPHERE
        torque = -gauge * area * pressure.slope(angles, *CRANK)
        waves = np.exp(-1j * np.outer(HALF_ORDERS, angles))
        found = np.trapezoid(torque * waves, angles) / (2.0 * np.pi)
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def example_table(*, plain: bool) -> float:
    """Largest error of a Wiebe cycle sampled every degree, straight lines or cubics between."""
    cycle = cp.Cycle.example("diesel")
    theta = np.arange(720.0)
    values = cycle.pressure_at(theta)
    exact = cycle.torque_harmonics(FIRED, HALF_ORDERS)
    found = cp.Cycle(theta, values).torque_harmonics(FIRED, HALF_ORDERS)
    if plain:
        ends = np.append(np.radians(theta), 4.0 * np.pi), np.append(values, values[0])
        found = sampled_gas(lambda at: np.interp(at, *ends), np.arange(0.0, 720.0, 0.05))
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def otto_error(found: NDArray[np.complex128]) -> float:
    """Largest error of the Otto cycle's phasors over the largest."""
    exact = exact_gas(otto_pressure, HALF_ORDERS)
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def motored_work(*, plain: bool) -> float:
    """Work of a motored cycle without losses over that of its compression; zero is right."""
    exponents: dict[str, Any] = {"compression_exponent": 1.4, "expansion_exponent": 1.4}
    cycle = cp.Cycle.motored(FIRED, compression_ratio=17.0, **exponents)
    area = math.pi / 4.0 * 0.086**2
    compression: float = ATMOSPHERE * area * 0.09 * 17.0 / 16.0 * (17.0**0.4 - 1.0) / 0.4
    if not plain:
        return abs(cycle.work(FIRED)) / compression
    theta = np.arange(721.0)
    volume = -area * pressure.height(np.radians(theta), *CRANK)
    return abs(float((cycle.pressure_at(theta)[:-1] * np.diff(volume)).sum())) / compression


EPS = float(np.finfo(float).eps)

CASES = [
    Case(
        "sums that cancel",
        "six balanced engines at 20 000 rpm, orders 1-12: what vanishes, over m·r·ω²",
        0.0,
        "zero is zero",
        "phasors summed in doubles",
        lambda: largest_of_zeros(plain=True),
        lambda: largest_of_zeros(plain=False),
    ),
    Case(
        "sums that cancel",
        "one of six pistons heavier by 1e-9: the force it leaves",
        2e-6,
        "6 roundings of 1.1e-16 of the whole, of which 1e-9 is left, and as much from the angles",
        "zero below 1e-8 of m·r·ω²",
        lambda: imbalance(plain_with_threshold),
        lambda: imbalance(lambda engine: complex(engine.balance(RPM, orders=[1]).force.xy[0, 1])),
    ),
    Case(
        "bank angles",
        "cross-plane V8 at and beside 0°, 90°, 180°: backward moment over m·r·ω²·a, zeros exact",
        20 * EPS,
        "8 terms of at most 1.5, two roundings of half a unit each",
        "phasors summed in doubles",
        lambda: beside_right_angles(plain=True),
        lambda: beside_right_angles(plain=False),
    ),
    Case(
        "crank angles",
        "a million turns on: position over r",
        20 * EPS,
        "height and cosine of a reduced angle: roundings of l + r = 4.5 r",
        "θ·π/180",
        lambda: far_crank_angle(
            lambda far: float(
                kinematics.position(np.radians(far), CYLINDER.crank_radius, CYLINDER.rod_length)
            )
        ),
        lambda: far_crank_angle(lambda far: float(CYLINDER.position(far))),
    ),
    Case(
        "crank angles",
        "acceleration about θ = 90° at λ = 1 − 1e-12, over the largest",
        1e-14,
        "height keeps its digits; cosine next to 90° is that of exact degrees",
        "l² − r² sin²θ in doubles",
        lambda: near_the_spike(
            lambda: kinematics.acceleration(np.radians(AROUND_THE_SPIKE), SHARP.crank_radius, 1.0)
        ),
        lambda: near_the_spike(
            lambda: SHARP.acceleration(AROUND_THE_SPIKE, 60 / (2 * np.pi)).ravel()
        ),
    ),
    Case(
        "undersampled waveforms",
        "orders 1-4 of a single's torque",
        1e-12,
        "the samples' own rounding: 4096 of them against the orders in closed form",
        "transform of 8 samples",
        lambda: sampled_torque(8),
        few_angles_or_many,
    ),
    Case(
        "peaks",
        "flat (T'' = T''' = 0), twice equal: 9 cos θ − cos 3θ",
        10 * EPS,
        "sums of terms 1.25 times the peak",
        "highest of 36 samples",
        lambda: peak_error(FLAT, 36),
        lambda: peak_error(FLAT, None),
    ),
    Case(
        "peaks",
        "twenty, apart by 5e-5 and less: cos 20θ + 0.001 cos θ",
        20 * EPS,
        "powers up to 20 of a unit phasor",
        "highest of 72 samples, polished",
        lambda: polished_error(NEARLY_EQUAL, 72),
        lambda: peak_error(NEARLY_EQUAL, None),
    ),
    Case(
        "peaks",
        "twenty orders in phase",
        20 * EPS,
        "powers up to 20 of a unit phasor",
        "highest of 3600 samples",
        lambda: peak_error(SHARP_PEAK, 3600),
        lambda: peak_error(SHARP_PEAK, None),
    ),
    Case(
        "arrangements",
        "V-14s with a balanced bank angle, counted",
        0.0,
        "equality of magnitudes is decided in integers",
        "|Z|² compared with ==",
        lambda: search_error(0.0),
        lambda: search_error(None),
    ),
    Case(
        "arrangements",
        "V-18s with a balanced bank angle, counted",
        0.0,
        "equality of magnitudes is decided in integers",
        "|Z|² equal within 1e-13",
        lambda: search_error(1e-13, 9),
        lambda: search_error(None, 9),
    ),
    Case(
        "units",
        "lengths times 2⁶⁶, masses times 2⁻⁶⁶, same piston speed: force and moment",
        0.0,
        "powers of two scale every step exactly",
        "zero below 1e-9 N",
        lambda: scaled_force(HUGE, TINY, plain=True),
        lambda: scaled_force(HUGE, TINY, plain=False),
    ),
    Case(
        "units",
        "lengths times 2⁻⁶⁶, masses times 2⁶⁶, same piston speed: force and moment",
        0.0,
        "powers of two scale every step exactly",
        "zero below 1e-9 N",
        lambda: scaled_force(TINY, HUGE, plain=True),
        lambda: scaled_force(TINY, HUGE, plain=False),
    ),
    Case(
        "number of cylinders",
        "one, upright: force along and across the bore",
        10 * EPS,
        "roundings of m·r·ω²; across it zero",
        "phasors summed in doubles",
        lambda: single(plain=True),
        lambda: single(plain=False),
    ),
    Case(
        "number of cylinders",
        "inline-48 on mirrored throws: first-order force and moment",
        0.0,
        "zero is zero",
        "phasors summed in doubles",
        lambda: many_cylinders(48, plain=True),
        lambda: many_cylinders(48, plain=False),
    ),
    Case(
        "gas torque",
        "closed grid of 500 points, order 12 of a smooth peak",
        1e-4,
        "cubics through points 1.44° apart of a peak 40° wide",
        "transform of the samples",
        lambda: closed_grid(sampled_gas(peak_of_pressure, np.linspace(0.0, 720.0, 500))),
        lambda: closed_grid(tabled(peak_of_pressure, np.linspace(0.0, 720.0, 500))),
    ),
    Case(
        "gas torque",
        "uneven grid, 3° and 0.5° about the peak, over the largest",
        1e-5,
        "cubics through points 3° apart beside the peak",
        "trapezia between the samples",
        lambda: uneven_grid(plain=True),
        lambda: uneven_grid(plain=False),
    ),
    Case(
        "gas torque",
        "diesel cycle with bends at valve events, every degree, over the largest",
        1e-5,
        "bends between points: second order there, fourth elsewhere",
        "straight lines between the samples",
        lambda: example_table(plain=True),
        lambda: example_table(plain=False),
    ),
    Case(
        "gas torque",
        "Otto cycle, which jumps in the dead centres, over the largest",
        1e-13,
        "quadrature between the jumps: roundings of some thousand terms",
        "transform of 7200 samples",
        lambda: otto_error(sampled_gas(otto_pressure, np.arange(0.0, 720.0, 0.1))),
        lambda: otto_error(
            cp.Cycle.otto(FIRED, compression_ratio=10.0, pressure_ratio=3.5).torque_harmonics(
                FIRED, HALF_ORDERS
            )
        ),
    ),
    Case(
        "gas torque",
        "motored cycle without losses: work over that of compression",
        1e-14,
        "polynomials to 2e-14, symmetric about the dead centre",
        "Σ p·ΔV of 720 samples",
        lambda: motored_work(plain=True),
        lambda: motored_work(plain=False),
    ),
    Case(
        "opposed pistons",
        "lead to 0° and to 180°: force of orders 1 and 2 over m·r·ω², zeros exact",
        2e-14,
        "what is below the bound of the sum's rounding, of a lead of 1e-12°, is zero",
        "phasors summed in doubles",
        lambda: lead_error(LEADS, plain=True),
        lambda: lead_error(LEADS, plain=False),
    ),
    Case(
        "opposed pistons",
        "a lead of 1e-9°: force of orders 1 and 2",
        1e-15,
        "an angle and its sine are good to a unit in the last place each, and the sum to one more",
        "phasors summed in doubles",
        lambda: lead_error([1e-9], plain=True, relative=True),
        lambda: lead_error([1e-9], plain=False, relative=True),
    ),
    Case(
        "opposed throws",
        "masses apart by 1e-12: the force they leave",
        1e-15,
        "throws a half turn apart have phasors 1 and −1, so that masses are subtracted exactly",
        "phasors summed in doubles",
        lambda: unlike_masses(plain=True),
        lambda: unlike_masses(plain=False),
    ),
    Case(
        "compressors",
        "clearance from 10 % to 1e-12 and none: work",
        1e-13,
        "polynomials to 2e-14, and quadrature between the valves' angles",
        "Σ p·ΔV of 720 samples",
        lambda: clearance_error(plain=True),
        lambda: clearance_error(plain=False),
    ),
    Case(
        "compressors",
        "piston rod to the bore, an ulp less, and as thick: torque of the crank end",
        1e-13,
        "the area of a ring is the product of sum and difference of its diameters",
        "π/4·D² − π/4·d²",
        lambda: thick_rod(plain=True),
        lambda: thick_rod(plain=False),
    ),
]
