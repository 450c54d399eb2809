"""Do random engines shake as their geometry says, instant by instant and order by order?

The other side, ``rederivation.time_domain``, adds up slider-cranks at each crank angle and
Fourier-transforms the sums; it knows no formula of the library.

Tolerances are worked out for each engine: both sides round crank angles (to a few 1e-15 rad of
angles up to 4 pi, and of top dead centres as large), which costs the slope of each cylinder's
waveform, and round each cylinder's value (by a few 1e-16, more where the rod stands at a slant and
the square root loses digits).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import crankpin as cp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray
from rederivation import kinematics, time_domain

if TYPE_CHECKING:
    from collections.abc import Callable

# Engines of any size on purpose.
pytestmark = pytest.mark.filterwarnings("ignore:.*(Lengths are|They are) metres here:UserWarning")

Array = NDArray[np.float64]

FINE = time_domain.crank_angles(512)  # harmonics fall 0.4-fold a step at worst: none is left at 256
ORDERS = tuple(range(1, 13))
# Radians: theta and tdc of up to 4 pi are rounded to 1.8e-15, their difference as well; twice that.
ANGLE_ROUNDING = 1e-14
# Twenty roundings of 1.1e-16 to a value.
VALUE_ROUNDING = 2.2e-15

examples = settings(max_examples=60, deadline=None, derandomize=True)


class Parts(NamedTuple):
    """One cylinder at its place, as plain numbers."""

    crank_radius: float
    rod_length: float
    reciprocating_mass: float
    pin_offset: float
    tdc_deg: float
    bank_deg: float
    z: float
    rotating_mass: float


class Case(NamedTuple):
    """One engine in both programs."""

    engine: cp.Engine
    lists: time_domain.EngineLists
    rpm: float
    theta_deg: Array


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Floats of a range, zero and subnormal ones only where they are its ends."""
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


ANGLES = st.one_of(
    numbers(-720.0, 720.0),
    st.sampled_from([0.0, 30.0, 45.0, 60.0, 72.0, 90.0, 120.0, 180.0, 240.0, 270.0, 360.0 / 7.0]),
)


@st.composite
def cylinders(draw: st.DrawFn) -> tuple[float, float, float, float]:
    """Radius, length, mass, offset; the crank up to 0.9 of what can turn."""
    rod = draw(numbers(0.01, 3.0))
    offset = rod * draw(st.one_of(st.just(0.0), numbers(-0.5, 0.5)))
    radius = (rod - abs(offset)) * draw(numbers(1e-3, 0.9))
    return radius, rod, draw(st.just(0.0) | numbers(1e-30, 20.0)), offset


@st.composite
def parts(draw: st.DrawFn) -> list[Parts]:
    """One to eight cylinders, each its own or all alike."""
    count = draw(st.integers(1, 8))
    shared = draw(st.one_of(st.none(), cylinders()))
    masses = st.one_of(st.just(0.0), numbers(1e-30, 5.0))
    return [
        Parts(
            *(shared or draw(cylinders())),
            draw(ANGLES),
            draw(ANGLES),
            draw(numbers(-2.0, 2.0)),
            draw(masses),
        )
        for _ in range(count)
    ]


def column(each: list[Parts], name: str) -> list[float]:
    """One list of the engine."""
    return [getattr(part, name) for part in each]


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """An engine, a speed at which no piston is too fast, and crank angles."""
    each = draw(parts())
    engine = cp.Engine.from_lists(
        [cp.Cylinder(*part[:4]) for part in each],
        tdc_deg=column(each, "tdc_deg"),
        bank_deg=column(each, "bank_deg"),
        z=column(each, "z"),
        rotating_mass=column(each, "rotating_mass"),
    )
    lists = time_domain.EngineLists(**{name: column(each, name) for name in Parts._fields})
    fastest = 60.0 * 15.0 / max(column(each, "crank_radius"))
    rpm = draw(numbers(1.0, 0.99 * fastest))
    theta = draw(st.lists(numbers(-720.0, 720.0), min_size=1, max_size=20))
    return Case(engine, lists, rpm, np.array(theta))


# --- how far two programs may be apart ----------------------------------------------------------


def slant(lists: time_domain.EngineLists) -> Array:
    """(l/s)^2 at the rod's greatest slant, per cylinder: what the square root loses, (n, 1)."""
    rod, sideways = lists.column("rod_length"), lists.column("crank_radius")
    sideways = sideways + np.abs(lists.column("pin_offset"))
    return np.asarray(rod**2 / ((rod - sideways) * (rod + sideways)))


def allowance(samples: Array, lists: time_domain.EngineLists) -> float:
    """Bound of the deviation of a sum over cylinders, from their own waveforms (n, 512)."""
    slope = np.abs(np.roll(samples, -1, axis=1) - samples).max(axis=1, keepdims=True) * 512 / 6.28
    value = np.abs(samples).max(axis=1, keepdims=True) * slant(lists)
    return float(np.sum(ANGLE_ROUNDING * slope + VALUE_ROUNDING * value)) + 1e-300


def force_size(case: Case) -> Array:
    """Force of each cylinder along its bore and along its pin, in length, (n, 512).

    Peaks hide in a length that never changes: the slope is taken of the parts.
    """
    forces = time_domain.cylinder_forces(case.lists, case.rpm, FINE)
    return np.concatenate([forces[..., 0], forces[..., 1]], axis=1)


def force_allowance(case: Case) -> float:
    return allowance(force_size(case), case.lists)


def moment_allowance(case: Case) -> float:
    """As of force; levers are differences of places, rounded once each."""
    lever = np.abs(case.lists.column("z") - time_domain.middle_plane(case.lists))
    reach = np.abs(case.lists.column("z")).max()
    forces = force_size(case)
    return allowance(forces * lever, case.lists) + float(
        VALUE_ROUNDING * reach * np.abs(forces).max(axis=1).sum()
    )


def torque_allowance(case: Case) -> float:
    """Of roll torque, which is the product of the two waveforms; crank torque is no larger."""
    omega = time_domain.angular_speed(case.rpm)
    lists = case.lists
    geometry = [lists.column(name) for name in ("crank_radius", "rod_length", "pin_offset")]
    mass = lists.column("reciprocating_mass")
    roll = kinematics.roll_torque(FINE, mass, omega, *geometry)
    # Roll torque is a sum of acceleration times crank velocity and times offset: where these
    # cancel, the parts count.
    force = np.abs(kinematics.inertia_force(FINE, mass, omega, *geometry))
    arm = np.abs(kinematics.velocity(FINE, *geometry)) + np.abs(geometry[2])
    rounding = VALUE_ROUNDING * (force.max(axis=1) * arm.max(axis=1) * slant(lists)[:, 0]).sum()
    return allowance(roll, lists) + float(rounding)


# --- instant by instant -------------------------------------------------------------------------


@examples
@given(cases())
def test_exact_waveform(case: Case) -> None:
    w = case.engine.waveform(case.rpm, theta_deg=case.theta_deg)
    theta = np.deg2rad(case.theta_deg)
    pairs: list[tuple[ArrayLike, Callable[..., Array], float]] = [
        (w.force, time_domain.force, force_allowance(case)),
        (w.moment, time_domain.moment, moment_allowance(case)),
        (w.torque, time_domain.roll_torque, torque_allowance(case)),
        (w.crank_torque, time_domain.crank_torque, torque_allowance(case)),
    ]
    for found, expected, atol in pairs:
        np.testing.assert_allclose(
            np.asarray(found),
            expected(case.lists, case.rpm, theta),
            rtol=0,
            atol=atol,
            err_msg=str(expected),
        )


@examples
@given(cases(), numbers(-3.0, 3.0))
def test_moment_about_another_plane(case: Case, reference_z: float) -> None:
    w = case.engine.replace(reference_z=reference_z).waveform(case.rpm, theta_deg=case.theta_deg)
    expected = time_domain.moment(case.lists, case.rpm, np.deg2rad(case.theta_deg), reference_z)
    # Levers of up to 5 m in place of those about the middle.
    atol = moment_allowance(case) + 5.0 * force_allowance(case)
    np.testing.assert_allclose(w.moment, expected, rtol=0, atol=atol)


@examples
@given(cylinders(), st.lists(numbers(-720.0, 720.0), max_size=20), numbers(0.1, 1e4))
def test_motion_of_one_piston(
    geometry: tuple[float, float, float, float], theta_deg: list[float], rpm: float
) -> None:
    cylinder = cp.Cylinder(*geometry)
    radius, rod, _, offset = geometry
    theta, omega = np.deg2rad(theta_deg), time_domain.angular_speed(rpm)
    motions = [
        (cylinder.position(theta_deg), kinematics.position, 1.0),
        (cylinder.velocity(theta_deg, rpm), kinematics.velocity, omega),
        (cylinder.acceleration(theta_deg, rpm), kinematics.acceleration, omega**2),
    ]
    place = time_domain.EngineLists(radius, rod, 1.0, [0.0], [0.0], [0.0], offset)
    for found, motion, factor in motions:
        samples = factor * motion(FINE, radius, rod, offset)[np.newaxis]
        expected = factor * motion(theta, radius, rod, offset)
        np.testing.assert_allclose(found, expected, rtol=0, atol=allowance(samples, place))


# --- order by order -----------------------------------------------------------------------------


@examples
@given(cases())
def test_phasors_agree_with_a_fourier_transform(case: Case) -> None:
    b = case.engine.balance(case.rpm, orders=ORDERS)
    expected = time_domain.phasors(case.lists, case.rpm, ORDERS, n_samples=512)
    pairs = [
        (b.force, expected.force, force_allowance(case)),
        (b.moment, expected.moment, moment_allowance(case)),
        (b.torque, expected.roll_torque, torque_allowance(case)),
        (b.crank_torque, expected.crank_torque, torque_allowance(case)),
    ]
    for found, transformed, atol in pairs:
        # A phasor is a mean over samples, doubled.
        np.testing.assert_allclose(found, transformed, rtol=0, atol=2 * atol)


@examples
@given(cases())
def test_parts_that_turn_with_and_against_the_crank(case: Case) -> None:
    b = case.engine.balance(case.rpm, orders=ORDERS)
    samples = (
        time_domain.force(case.lists, case.rpm, FINE),
        time_domain.moment(case.lists, case.rpm, FINE),
    )
    parts_of = ((b.force.forward, b.force.backward), (b.moment.forward, b.moment.backward))
    bounds = (force_allowance(case), moment_allowance(case))
    for waveform, found, atol in zip(samples, parts_of, bounds, strict=True):
        expected = time_domain.forward_backward(waveform, ORDERS)
        np.testing.assert_allclose(found, expected, rtol=0, atol=2 * atol)


@examples
@given(cases())
def test_peaks_are_those_of_the_sum_of_orders(case: Case) -> None:
    """A true extremum is never below a sample, nor above it by more than between two samples."""
    b = case.engine.balance(case.rpm, orders=ORDERS[:4])
    w = case.engine.waveform(case.rpm, theta_deg=np.rad2deg(FINE), orders=ORDERS[:4])
    # Between samples 2 pi/512 apart a sum of orders up to 4 falls by (4 * 2 pi/1024)^2/2 at most
    # of the sum of amplitudes.
    for found, samples, phasors in (
        (b.total.force.peak_xy, w.force, b.force),
        (b.total.moment.peak_xy, w.moment, b.moment),
    ):
        top, total = np.abs(samples).max(axis=0), np.abs(phasors).sum(axis=0)
        assert (found >= top - 1e-14 * total).all()
        assert (found <= top + 3.1e-4 * total).all()
    longest = np.hypot(*w.force.T).max()
    total = np.abs(b.force).sum()
    assert longest - 1e-14 * total <= b.total.force.peak <= longest + 3.1e-4 * total


@examples
@given(cases(), st.sampled_from([1e-3, 1e-6, 1e-9]))
def test_orders_left_out_stay_within_their_bound(case: Case, rtol: float) -> None:
    exact = case.engine.waveform(case.rpm, theta_deg=case.theta_deg)
    summed = case.engine.waveform(case.rpm, theta_deg=case.theta_deg, orders="auto", rtol=rtol)
    off_force = np.hypot(*(exact.force - summed.force).T).max()
    off_moment = np.hypot(*(exact.moment - summed.moment).T).max()
    # Summing up to a hundred orders of an angle costs as many roundings again.
    assert off_force <= summed.error_bound["force"] + 100 * force_allowance(case)
    assert off_moment <= summed.error_bound["moment"] + 100 * moment_allowance(case)
    omega = time_domain.angular_speed(case.rpm)
    turning = zip(case.engine.cylinders, case.engine.rotating_mass, strict=True)
    largest = omega**2 * max(
        part.crank_radius * max(part.reciprocating_mass, mass) for part, mass in turning
    )
    z = case.engine.z
    lever = np.abs(z - case.engine.reference_z).max()
    # The allowance itself is rounded, in both programs.
    assert summed.error_bound["force"] <= rtol * largest * (1.0 + 1e-14)
    assert summed.error_bound["moment"] <= rtol * largest * lever * (1.0 + 1e-14)


# --- sweeps are loops of balances ---------------------------------------------------------------

# Both add the same terms, in another order and with trigonometric sums expanded.
LOOP = 1e-13


def assert_alike(found: ArrayLike, expected: ArrayLike, scale: float) -> None:
    found, expected = np.asarray(found), np.asarray(expected)
    np.testing.assert_allclose(found, expected, rtol=0, atol=LOOP * scale + 1e-300)


def size(case: Case) -> float:
    """Force of all cylinders together, N."""
    omega = time_domain.angular_speed(case.rpm)
    lists = case.lists
    mass = lists.column("reciprocating_mass") + lists.column("rotating_mass")
    return float(np.sum(mass * lists.column("crank_radius") * slant(lists))) * omega**2


@examples
@given(cases())
def test_sweep_over_speed_is_a_loop_of_balances(case: Case) -> None:
    speeds = [case.rpm, 0.5 * case.rpm]
    s = cp.sweep(case.engine, rpm=speeds, orders=ORDERS[:4])
    reach = float(np.ptp(case.engine.z)) + 1e-3
    for k, rpm in enumerate(speeds):
        b = case.engine.balance(rpm, orders=ORDERS[:4])
        assert_alike(s.force.xy[k], b.force, size(case))
        assert_alike(s.moment.xy[k], b.moment, size(case) * reach)
        longest = float(np.max(case.lists.column("crank_radius")))
        assert_alike(s.torque.phasor[k], b.torque, size(case) * longest)
        assert_alike(s.force.peak_xy[k], b.force.peak_xy, size(case))
        assert_alike(s.moment.peak[k], b.moment.peak, size(case) * reach)
        assert_alike(s.total.force.peak_xy[k], b.total.force.peak_xy, size(case))
        assert_alike(s.total.moment.peak[k], b.total.moment.peak, size(case) * reach)


@examples
@given(cases(), numbers(0.01, 0.6), numbers(-0.3, 0.3))
def test_sweep_over_proportions_is_a_loop_of_balances(
    case: Case, rod_ratio: float, offset: float
) -> None:
    engine = case.engine
    changed = engine.replace(
        cylinder=[
            part.replace(rod_length=part.crank_radius / rod_ratio, pin_offset=0.0)
            for part in engine.cylinders
        ]
    )
    pin_offset = offset * min(part.crank_radius for part in engine.cylinders)
    offset_too = changed.replace(
        cylinder=[part.replace(pin_offset=pin_offset) for part in changed.cylinders]
    )
    offsets = [0.0, pin_offset]
    s = cp.sweep(
        changed, rpm=case.rpm, rod_ratio=[rod_ratio], pin_offset=offsets, orders=ORDERS[:4]
    )
    for k, expected in enumerate((changed, offset_too)):
        b = expected.balance(case.rpm, orders=ORDERS[:4])
        assert_alike(s.force.xy[0, k], b.force, 3.0 * size(case))
        assert_alike(
            s.moment.xy[0, k], b.moment, 3.0 * size(case) * (float(np.ptp(engine.z)) + 1e-3)
        )


@pytest.mark.parametrize("hold", ["pins", "firing"])
@examples
@given(cases(), numbers(0.0, 180.0), st.integers(1, 7))
def test_sweep_over_bank_angle_is_a_loop_of_balances(
    hold: str, case: Case, angle: float, first_bank: int
) -> None:
    count = len(case.engine)
    assume(count > 1)
    right = 1 + first_bank % (count - 1)
    banks = [60.0] * right + [120.0] * (count - right)
    engine = case.engine.replace(bank_deg=banks)
    s = cp.sweep(
        engine,
        rpm=case.rpm,
        bank_angle_deg=[angle, 60.0],
        hold=hold,  # type: ignore[arg-type]
        orders=ORDERS[:4],
    )
    turned = engine.with_bank_angle(angle, hold=hold)  # type: ignore[arg-type]
    reach = float(np.ptp(engine.z)) + 1e-3
    for k, each in enumerate((turned, engine)):
        b = each.balance(case.rpm, orders=ORDERS[:4])
        assert_alike(s.force.xy[k], b.force, size(case))
        assert_alike(s.moment.xy[k], b.moment, size(case) * reach)
        assert_alike(s.moment.peak_xy[k], b.moment.peak_xy, size(case) * reach)
        assert_alike(s.total.force.peak[k], b.total.force.peak, size(case))


def test_sweep_of_one_bank_has_the_backward_part() -> None:
    """An upright single pushes up and down: half of that turns against the crank."""
    single = cp.Engine.inline(cp.Cylinder(0.05, 0.15, 0.5), throws_deg=[0], spacing=0.1)
    expected = single.balance(3000, orders=[1, 2]).force
    assert (expected.x == 0).all()
    for options in ({}, {"rod_ratio": 0.05 / 0.15}, {"pin_offset": 0.0}):
        found = cp.sweep(single, rpm=3000, orders=[1, 2], **options).force  # type: ignore[arg-type]
        np.testing.assert_allclose(found, expected, rtol=1e-14, atol=0)  # one term, a few roundings
