"""Do torques know the rod's own moment of inertia, and nothing else of an engine?

The other side is ``rederivation.rigid_rod``, where the rod is one body with a centre of mass, and
``rederivation.swing_mp``, harmonics to fifty digits.
"""

from __future__ import annotations

import copy
import pickle
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray
from rederivation import rigid_rod, swing_mp

Array = NDArray[np.float64]

RPM = 3000.0
SQUARE = (2.0 * np.pi * RPM / 60.0) ** 2
THETA_DEG = np.arange(0.0, 360.0, 3.0)
RODS = [
    cp.Rod(mass=0.6, inertia=0.0022, length=0.15, to_crankpin=0.045),
    cp.Rod(mass=0.5, inertia=0.0042, length=0.1, to_crankpin=0.02),
    cp.Rod(mass=0.9, inertia=0.001, length=0.12, to_crankpin=0.12),
    cp.Rod(mass=0.4, inertia=0.0061, length=0.2, to_crankpin=-0.03),  # with a counterweight
]
RADII, OFFSETS = (0.045, 0.05, 0.06, 0.03), (0.0, 0.012, -0.02, -0.001)
PISTONS = (0.5, 0.3, 0.0, 0.7)
TDC_DEG, BANK_DEG, Z = [0.0, 77.3, 240.0, 301.0], [60.0, 120.0, 60.0, 133.0], [0.0, 0.1, 0.2, 0.35]

CYLINDERS = [
    cp.Cylinder.from_rod(rod, radius, piston, offset)
    for rod, radius, piston, offset in zip(RODS, RADII, PISTONS, OFFSETS, strict=True)
]
V4 = cp.Engine.from_lists(
    CYLINDERS,
    tdc_deg=TDC_DEG,
    bank_deg=BANK_DEG,
    z=Z,
    rotating_mass=[rod.rotating_mass for rod in RODS],
)
# Angles are rounded by 1e-14 rad, values change by at most some twenty times their peak a radian.
ROUNDING = 1e-12


def bodies(index: int) -> rigid_rod.SliderCrank:
    rod = RODS[index]
    return rigid_rod.SliderCrank(
        crank_radius=RADII[index],
        rod_length=rod.length,
        pin_offset=OFFSETS[index],
        piston_mass=PISTONS[index],
        rod_mass=rod.mass,
        rod_inertia=rod.inertia,
        to_crankpin=rod.to_crankpin,
    )


def without(engine: cp.Engine) -> cp.Engine:
    """The same with rods of two masses."""
    return engine.replace(cylinder=[c.replace(rod_inertia_excess=0.0) for c in engine.cylinders])


def close(found: ArrayLike, expected: Array, tolerance: float = ROUNDING) -> None:
    atol = tolerance * np.abs(expected).max()
    np.testing.assert_allclose(np.asarray(found), expected, rtol=0, atol=atol)


# --- against rigid bodies -----------------------------------------------------------------------


@pytest.mark.parametrize("index", range(4))
def test_the_bodies_agree_among_themselves(index: int) -> None:
    """Free bodies, angular momentum, work and energy: three laws, one motion."""
    parts, theta = bodies(index), np.deg2rad(THETA_DEG)
    roll, crank = rigid_rod.roll_torque(parts, theta), rigid_rod.crank_torque(parts, theta)
    scale = np.abs(roll).max()
    # Two sums of a few terms of this size.
    np.testing.assert_allclose(
        roll + crank, rigid_rod.inertia_moment(parts, theta), rtol=0, atol=1e-13 * scale
    )
    step = 1e-4
    slope = (
        rigid_rod.kinetic_energy(parts, theta + step)
        - rigid_rod.kinetic_energy(parts, theta - step)
    ) / (2 * step)
    # A central difference: step^2/6 of the third derivative, some hundred times the torque.
    np.testing.assert_allclose(crank, -slope, rtol=0, atol=2e-6 * scale)


def test_waveforms_are_those_of_rigid_rods() -> None:
    waveform = V4.waveform(rpm=RPM, theta_deg=THETA_DEG)
    roll, crank, force = np.zeros(3)[:, np.newaxis]
    for index in range(4):
        theta = np.deg2rad(THETA_DEG - TDC_DEG[index])
        parts = bodies(index)
        roll = roll + rigid_rod.roll_torque(parts, theta) * SQUARE
        crank = crank + rigid_rod.crank_torque(parts, theta) * SQUARE
        u, v = rigid_rod.inertia_force(parts, theta) * SQUARE
        bank = np.deg2rad(BANK_DEG[index])
        force = force + np.array(
            [u * np.cos(bank) - v * np.sin(bank), u * np.sin(bank) + v * np.cos(bank)]
        )
    assert waveform.torque is not None
    assert waveform.crank_torque is not None
    close(waveform.torque, np.asarray(roll))
    close(waveform.crank_torque, np.asarray(crank))
    close(waveform.force, np.asarray(force).T)
    # Two masses alone would be far off.
    plain = without(V4).waveform(rpm=RPM, theta_deg=THETA_DEG)
    assert plain.torque is not None
    assert np.abs(plain.torque - waveform.torque).max() > 0.05 * np.abs(roll).max()


def test_orders_add_up_to_the_waveform() -> None:
    orders = np.arange(1, 120)
    balance = V4.balance(rpm=RPM, orders=orders)
    waves = np.exp(1j * np.outer(np.deg2rad(THETA_DEG), orders))
    waveform = V4.waveform(rpm=RPM, theta_deg=THETA_DEG)
    assert balance.torque is not None
    assert balance.crank_torque is not None
    # Rod ratio and offset of the third cylinder leave 0.83^120 of the first order.
    close((waves @ balance.torque).real, np.asarray(waveform.torque), 1e-8)
    close((waves @ balance.crank_torque).real, np.asarray(waveform.crank_torque), 1e-8)


# --- laws ---------------------------------------------------------------------------------------


def figures(result: object, names: tuple[str, ...]) -> list[bytes]:
    return [np.asarray(getattr(result, name)).tobytes() for name in names]


def test_forces_and_moments_do_not_know_it() -> None:
    plain, shakes = without(V4), ("force", "moment")
    for orders in (range(1, 9), "auto"):
        found = [e.balance(rpm=RPM, orders=orders, torque=False) for e in (V4, plain)]
        assert figures(found[0], shakes) == figures(found[1], shakes)
        assert found[0].error_bound == found[1].error_bound
    found = [e.balance(rpm=RPM, orders=range(1, 9)) for e in (V4, plain)]
    assert figures(found[0], shakes) == figures(found[1], shakes)
    waves = [e.waveform(rpm=RPM, theta_deg=THETA_DEG) for e in (V4, plain)]
    assert figures(waves[0], shakes) == figures(waves[1], shakes)
    swept = [cp.sweep(e, rpm=RPM, rod_ratio=[0.2, 0.3], orders=range(1, 9)) for e in (V4, plain)]
    assert figures(swept[0], shakes) == figures(swept[1], shakes)


def test_torque_is_linear_in_it() -> None:
    """Also where one cylinder has it and its like has not."""
    i4 = cp.Engine.inline(CYLINDERS[0], throws_deg=[0, 180, 180, 0], spacing=0.1)
    one = i4.replace(cylinder=[CYLINDERS[0].replace(rod_inertia_excess=0.0)] * 3 + CYLINDERS[:1])
    two = one.replace(
        cylinder=[c.replace(rod_inertia_excess=2 * c.rod_inertia_excess) for c in one.cylinders]
    )
    for name in ("torque", "crank_torque"):
        none, single, double = (
            np.asarray(getattr(e.balance(rpm=RPM, orders=range(1, 9)), name))
            for e in (without(one), one, two)
        )
        # Differences of torques some ten times as large, each with a few roundings.
        close(np.abs(double - none), np.abs(2 * (single - none)), 1e-13)


def test_mean_torque_is_zero_and_so_is_the_work_of_a_turn() -> None:
    waveform = V4.waveform(rpm=RPM, theta_deg=np.arange(0.0, 360.0, 0.5))
    for torque in (waveform.torque, waveform.crank_torque):
        assert torque is not None
        # 720 samples leave no order below 600; the sum has that many roundings.
        assert abs(torque.mean()) < 1e-13 * np.abs(torque).max()


def test_roll_and_crank_add_up_to_offset_and_swing() -> None:
    cylinder = CYLINDERS[1]
    # Without the big end, the force is the piston's, which alone has a moment about the axis.
    engine = cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.1, rotating_mass=0)
    waveform = engine.waveform(rpm=RPM, theta_deg=THETA_DEG)
    theta, rod, e = np.deg2rad(THETA_DEG), cylinder.rod_length, cylinder.pin_offset
    sine = (cylinder.crank_radius * np.sin(theta) - e) / rod
    slope = cylinder.crank_radius * np.cos(theta) / rod
    cosine = np.sqrt(1 - sine**2)
    bend = -cylinder.crank_radius * np.sin(theta) / rod / cosine + slope**2 * sine / cosine**3
    along = np.asarray(waveform.force)[:, 1]
    expected = -e * along + cylinder.rod_inertia_excess * SQUARE * bend
    close(np.asarray(waveform.torque) + np.asarray(waveform.crank_torque), expected)


def test_a_rod_of_two_masses_changes_no_bit() -> None:
    """A thin dumb-bell; its inertia and that of its two masses differ by a rounding."""
    rod = cp.Rod(mass=0.3, inertia=0.3 * (0.05 * (0.15 - 0.05)), length=0.15, to_crankpin=0.05)
    assert rod.inertia_excess == 0.0
    made = cp.Cylinder.from_rod(rod, 0.04, 0.4)
    assert made.rod_inertia_excess == 0.0
    plain = cp.Cylinder(0.04, 0.15, 0.4 + rod.reciprocating_mass)
    assert made.replace(rod_length=made.rod_length) == plain  # which forgets the rod


def test_no_mass_reciprocates_but_the_rod_swings() -> None:
    cylinder = cp.Cylinder(0.05, 0.15, 0.0, rod_inertia_excess=-1e-3)
    engine = cp.Engine.inline(cylinder, throws_deg=[0, 120, 240], spacing=0.1)
    balance = engine.balance(rpm=RPM, orders="auto", rtol=1e-6)
    assert balance.torque is not None
    waveform = engine.waveform(rpm=RPM, theta_deg=THETA_DEG)
    waves = np.exp(1j * np.outer(np.deg2rad(THETA_DEG), balance.orders))
    close((waves @ balance.torque).real, np.asarray(waveform.torque), 1e-5)
    with pytest.raises(cp.InputError, match="reciprocating_mass"):
        cylinder.torque_harmonics([1])


# --- harmonics ----------------------------------------------------------------------------------

HARMONIC_ORDERS = (1, 2, 3, 4, 5, 6, 9, 16, 31)
# Worst over the cases 5.8e-15: what the offset's share of the reach loses to rounding.
HARMONIC_ERROR = 1e-14
# Next to the crank that cannot turn, relative to order 1 and n; worst 4.4e-16.
PANEL_ERROR = 1e-15


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rod_ratio", "share"),
    [
        *[(0.1, 0.0), (0.3, 0.0), (0.3, 1e-8), (0.3, 0.4), (0.3, -0.4), (0.6, 0.9), (0.6, -0.9)],
        *[(0.9, 0.0), (0.9, -0.5), (0.99, 1e-6), (0.99, -0.7), (0.999, 0.0), (0.999, 0.5)],
        *[(1 - 1e-5, 1e-4), (1 - 1e-5, -0.5), (1 - 1e-9, 0.0)],
    ],
)
def test_harmonics_to_fifty_digits(rod_ratio: float, share: float) -> None:
    """Real and imaginary parts each, relative to themselves; offsets over what the crank allows."""
    rod, mass = 1.0, 0.5
    offset = share * (rod - rod_ratio)
    # The two masses are 1e-20 of it.
    inertia = 1e20 * mass * rod_ratio**2
    cylinder = cp.Cylinder(rod_ratio, rod, mass, offset, inertia)
    roll, crank = cylinder.torque_harmonics(HARMONIC_ORDERS)
    series = rod_ratio < 0.9995
    method = swing_mp.by_samples if series else swing_mp.by_panels
    expected = method(rod, rod_ratio, offset, HARMONIC_ORDERS)
    for k, (order, pair) in enumerate(zip(HARMONIC_ORDERS, expected, strict=True)):
        for found, exact in zip((roll[k], crank[k]), pair, strict=True):
            for part, whole in ((found.real, exact.real), (found.imag, exact.imag)):
                scaled = part / 1e20
                allowed = HARMONIC_ERROR * abs(whole) if series else PANEL_ERROR * order
                assert abs(scaled - whole) <= allowed + 1e-19, order


# --- orders by tolerance ------------------------------------------------------------------------

AUTO = [
    V4,
    cp.Engine.preset("v6-60", cylinder=CYLINDERS[0]),
    cp.Engine.preset("i4", cylinder=CYLINDERS[1]),
    cp.Engine.preset("i3", cylinder=CYLINDERS[0].replace(rod_inertia_excess=0.02)),
]


@pytest.mark.parametrize("engine", AUTO)
@pytest.mark.parametrize("rtol", [1e-2, 1e-5, 1e-9])
def test_the_bound_holds_and_is_tight(engine: cp.Engine, rtol: float) -> None:
    balance = engine.balance(rpm=RPM, orders="auto", rtol=rtol)
    theta = np.arange(0.0, 360.0, 0.5)
    waveform = engine.waveform(rpm=RPM, theta_deg=theta)
    waves = np.exp(1j * np.outer(np.deg2rad(theta), balance.orders))
    missing = 0.0
    for name in ("torque", "crank_torque"):
        exact = np.asarray(getattr(waveform, name))
        left = np.abs(exact - (waves @ np.asarray(getattr(balance, name))).real).max()
        missing = max(missing, left)
        # What rounding leaves of a sum of some hundred phasors.
        assert left <= balance.error_bound["torque"] + 1e-13 * np.abs(exact).max()
    largest = max(
        max(
            max(c.reciprocating_mass, mass) * c.crank_radius**2,
            abs(c.rod_inertia_excess) * c.rod_ratio,
        )
        for c, mass in zip(engine.cylinders, engine.rotating_mass, strict=True)
    )
    assert balance.error_bound["torque"] <= rtol * largest * SQUARE
    if missing > 1e-11 * largest * SQUARE:
        assert balance.error_bound["torque"] <= 10 * missing


# --- sweeps, proofs -----------------------------------------------------------------------------


def test_a_sweep_is_its_engines() -> None:
    """Rod ratio and offset change the rod's proportions; its inertia stays."""
    ratios, offsets, orders = [0.2, 0.31], [-0.004, 0.0, 0.006], list(range(1, 7))
    engine = cp.Engine.preset("v6-60", cylinder=CYLINDERS[0])
    mixed = [CYLINDERS[0], CYLINDERS[0].replace(rod_inertia_excess=0.0)] * 3
    for base in (engine, engine.replace(cylinder=mixed)):
        sweep = cp.sweep(base, rpm=[RPM], rod_ratio=ratios, pin_offset=offsets, orders=orders)
        torque = np.asarray(sweep.torque).reshape(2, 3, 6)
        for i, ratio in enumerate(ratios):
            for k, offset in enumerate(offsets):
                cylinders = [
                    c.replace(rod_length=c.crank_radius / ratio, pin_offset=offset)
                    for c in base.cylinders
                ]
                each = base.replace(cylinder=cylinders).balance(rpm=RPM, orders=orders)
                close(torque[i, k], np.asarray(each.torque), 1e-13)


@pytest.mark.parametrize("exact", [True, False])
def test_waveforms_of_a_sweep_are_those_of_its_engines(exact: bool) -> None:
    ratios, orders = [0.2, 0.3], range(1, 60)
    waves = cp.sweep(V4, rpm=[RPM], rod_ratio=ratios, orders=orders).waveform(
        THETA_DEG, exact=exact
    )
    for ratio, torque in zip(ratios, np.asarray(waves.torque)[:, 0], strict=True):
        cylinders = [c.replace(rod_length=c.crank_radius / ratio) for c in V4.cylinders]
        each = V4.replace(cylinder=cylinders).waveform(rpm=RPM, theta_deg=THETA_DEG)
        # Sixty orders leave 0.3^60 and round some hundred times.
        close(torque, np.asarray(each.torque), 1e-12)


def test_a_sweep_by_tolerance_bounds_every_point() -> None:
    engine = cp.Engine.preset("i3", cylinder=CYLINDERS[0].replace(rod_inertia_excess=-0.004))
    ratios = [0.15, 0.3, 0.45]
    sweep = cp.sweep(engine, rpm=RPM, rod_ratio=ratios, orders="auto", rtol=1e-6)
    waves = np.exp(1j * np.outer(np.deg2rad(THETA_DEG), sweep.orders))
    worst = 0.0
    for ratio, torque in zip(ratios, np.asarray(sweep.torque), strict=True):
        cylinder = engine.cylinders[0]
        each = engine.replace(cylinder=cylinder.replace(rod_length=cylinder.crank_radius / ratio))
        exact = np.asarray(each.waveform(rpm=RPM, theta_deg=THETA_DEG).torque)
        worst = max(worst, np.abs(exact - (waves @ torque).real).max())
    # The bound takes the largest harmonic of the axis and adds orders as if they peaked together.
    assert 0.1 * sweep.error_bound["torque"] <= worst <= sweep.error_bound["torque"]


def test_what_vanishes_is_proved() -> None:
    i4 = cp.Engine.inline(CYLINDERS[0], throws_deg=[0, 180, 180, 0], spacing=0.1)
    proof = i4.vanishing_orders(range(1, 7))
    found = [proof.torque[n] for n in range(1, 7)]
    assert found == ["vanishes", "remains"] * 3
    unlike = i4.replace(
        cylinder=[
            c.replace(rod_inertia_excess=-1e-3 * (k + 1) ** 2) for k, c in enumerate(i4.cylinders)
        ]
    )
    assert (np.asarray(unlike.balance(rpm=RPM, orders=range(1, 7)).torque) != 0).all()
    assert unlike.vanishing_orders(range(1, 7)).torque.vanishing == ()


# --- objects ------------------------------------------------------------------------------------


def test_it_goes_where_a_cylinder_goes() -> None:
    cylinder = CYLINDERS[0]
    assert cylinder != cylinder.replace(rod_inertia_excess=0.0)
    assert eval(repr(cylinder), vars(cp)) == cylinder  # noqa: S307
    for twin in (pickle.loads(pickle.dumps(cylinder)), copy.deepcopy(cylinder)):  # noqa: S301
        assert twin == cylinder
    for text, read in ((V4.to_toml(), cp.Engine.from_toml), (V4.to_json(), cp.Engine.from_json)):
        assert read(text).cylinders == tuple(CYLINDERS)
    assert pickle.loads(pickle.dumps(V4)) == V4  # noqa: S301
    assert "rod_inertia_excess" not in without(V4).to_toml()


def test_rods_share_their_mass_and_keep_its_centre() -> None:
    for rod in RODS:
        masses = rod.reciprocating_mass, rod.rotating_mass
        assert sum(masses) == pytest.approx(rod.mass, rel=1e-15)
        assert masses[0] * rod.length == pytest.approx(rod.mass * rod.to_crankpin, rel=1e-15)
        about_crankpin = masses[0] * rod.length**2 + rod.inertia_excess
        steiner = rod.inertia + rod.mass * rod.to_crankpin**2
        assert about_crankpin == pytest.approx(steiner, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *[("mass", -1.0), ("mass", np.nan), ("inertia", -1e-3), ("inertia", np.inf)],
        *[("length", 0.0), ("to_crankpin", -0.16), ("to_crankpin", 0.16), ("mass", "heavy")],
    ],
)
def test_a_rod_that_is_none_is_refused(name: str, value: float | str) -> None:
    given: dict[str, Any] = {"mass": 0.6, "inertia": 0.002, "length": 0.15, "to_crankpin": 0.05}
    with pytest.raises(cp.InputError, match=name):
        cp.Rod(**given | {name: value})


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e91, 1e-91, "much", None])
def test_an_inertia_that_is_none_is_refused(value: object) -> None:
    with pytest.raises(cp.InputError, match="rod_inertia_excess"):
        cp.Cylinder(0.05, 0.15, 0.5, rod_inertia_excess=value)  # type: ignore[arg-type]


def test_an_estimated_rod_has_the_mean_inertia_of_measured_ones() -> None:
    rod = cp.Rod.estimated(mass=0.6, length=0.15, to_crankpin=0.05)
    assert rod == cp.Rod(0.6, rod.inertia, 0.15, 0.05)
    assert rod.inertia * 1.0965 == pytest.approx(0.6 * 0.05 * 0.1, rel=1e-14)
    with pytest.raises(
        cp.InputError, match=r"^to_crankpin = 0\.2: give metres, 0 to length = 0\.15"
    ):
        cp.Rod.estimated(0.6, 0.15, 0.2)
    with pytest.raises(cp.InputError, match=r"^mass = 'heavy'"):
        cp.Rod.estimated("heavy", 0.15, 0.05)  # type: ignore[arg-type]


def test_from_bore_stroke_halves_the_stroke_and_checks_the_bore() -> None:
    given: dict[str, Any] = {"rod_length": 0.145, "reciprocating_mass": 0.66, "pin_offset": 0.001}
    cylinder = cp.Cylinder.from_bore_stroke(bore=0.086, stroke=0.09, **given)
    assert cylinder == cp.Cylinder(crank_radius=0.045, **given, bore=0.086)
    swinging = cp.Cylinder.from_bore_stroke(
        bore=0.086, stroke=0.09, rod_inertia_excess=-1e-4, **given
    )
    assert swinging == cylinder.replace(rod_inertia_excess=-1e-4)
    for name, value in [("bore", 0.0), ("stroke", -0.09), ("bore", float("nan")), ("stroke", "x")]:
        with pytest.raises(cp.InputError, match=f"^{name} = "):
            cp.Cylinder.from_bore_stroke(**{"bore": 0.086, "stroke": 0.09, **given, name: value})


def test_from_rod_takes_a_rod_and_a_piston() -> None:
    with pytest.raises(cp.InputError, match="give a Rod"):
        cp.Cylinder.from_rod(0.15, 0.05, 0.5)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match="piston_mass"):
        cp.Cylinder.from_rod(RODS[0], 0.05, -0.5)
