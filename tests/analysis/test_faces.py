"""Laws of pistons with pressure on both faces, and of side rods, of random engines."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._core import ATMOSPHERE
from rederivation import faces
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable

SMOOTH = {
    strokes: [
        cp.Cycle(
            np.arange(0.0, 180.0 * strokes, 0.5),
            [1.2e5 + peak * np.exp(8.0 * (np.cos(np.radians(t) * 2 / strokes) - 1.0))
             for t in np.arange(0.0, 180.0 * strokes, 0.5)],
            strokes=strokes,
        )
        for peak in (4e6, 1.5e6)
    ]
    for strokes in (2, 4)
}  # fmt: skip
"""Two cycles of each period, of which few orders matter."""


def cylinder(draw: np.random.Generator, radius: float = 0.05) -> cp.Cylinder:
    offset = draw.choice([0.0, 0.0, 0.006, -0.006])
    return cp.Cylinder(radius, draw.choice([0.16, 0.2]), 1.0, pin_offset=offset, bore=0.1)


def engine(seed: int) -> cp.Engine:
    """Return an engine of few values: coinciding throws, dead ends, two cranks, side rods."""
    draw = np.random.default_rng(seed)
    kind = draw.choice(["inline", "u", "opposed", "side rods"])
    strokes = int(draw.choice([2, 4]))
    count = int(draw.integers(1, 4))
    throws = draw.choice([0.0, 90.0, 180.0], count).tolist()
    parts = [cylinder(draw) for _ in range(count)]
    layout: dict[str, Any] = {"throws_deg": throws, "spacing": 0.12, "strokes": strokes}
    if kind == "side rods":
        plain = [one.replace(pin_offset=0.0) for one in parts]
        upper = [cp.Cylinder(draw.choice([0.05, 0.035]), 0.25, 1.4, bore=0.1) for _ in plain]
        lead = draw.choice([0.0, 9.0, -20.0])
        bare = cp.Engine.opposed_pistons(
            plain, upper=upper, lead_deg=lead, one_crankshaft=True, **layout
        )
    elif kind == "opposed":
        upper = [one.replace(crank_radius=draw.choice([0.05, 0.035])) for one in parts]
        lead = draw.choice([0.0, 9.0, -20.0])
        bare = cp.Engine.opposed_pistons(parts, upper=upper, lead_deg=lead, distance=0.6, **layout)
    elif kind == "u":
        ratio = int(draw.choice([1, -1]))
        bare = cp.Engine.u(
            parts, distance=0.3, ratio=ratio, phase_deg=draw.choice([0, 90]), **layout
        )
    else:
        bare = cp.Engine.inline(parts, **layout)
    bare = bare.replace(firing_order=bare.firing_orders()[0].firing_order) if strokes == 4 else bare
    cycles: list[Any] = [*SMOOTH[strokes], None]
    heads: list[Any] = [None] * len(bare)
    ends: list[Any] = [None] * len(bare)
    for chamber in bare.chambers:
        pressure = cycles[draw.integers(3)]
        for number in chamber:
            heads[number - 1] = pressure
    for k in range(len(bare)):
        ends[k] = cycles[draw.integers(3)]
    if all(one is None for one in ends):
        ends[0] = cycles[0]
    rods = draw.choice([0.0, 0.03, 0.1], len(bare))
    return bare.with_cycle(heads, crank_end=ends, rod_diameter=rods)


def position(one: cp.Cylinder, theta: Any) -> Any:  # noqa: ANN401
    """Return the distance of a piston from the crank, and its derivative, m."""
    r, rod, e = one.crank_radius, one.rod_length, one.pin_offset
    aside = r * np.sin(theta) - e
    along = np.sqrt(rod**2 - aside**2)
    return r * np.cos(theta) + along, -r * np.sin(theta) - aside * r * np.cos(theta) / along


def swept(pistons: Any, tops: Any, areas: Any, at: Any, part: int) -> Any:  # noqa: ANN401
    """Return the volume that pistons leave a chamber, but for a constant, m³, or its derivative."""
    each = zip(pistons, tops, areas, strict=True)
    return sum(area * position(one, at - top)[part] for one, top, area in each)


def least_at(volume: Callable[[Any], Any]) -> float:
    """Return the angle at which a volume is least, by ever finer steps; a turn has one."""
    middle, reach = np.pi, np.pi
    for _ in range(6):
        angles = middle + np.linspace(-reach, reach, 201)
        middle, reach = float(angles[np.argmin(volume(angles))]), reach / 50.0
    return middle


def work(fired: cp.Engine) -> float:
    """Return the work of all chambers in a cycle, J; each begins where its volume is least."""
    turns = fired.strokes // 2
    theta = np.linspace(0.0, 2.0 * np.pi * turns, 7200 * turns, endpoint=False)
    area, step, total = np.pi / 4 * 0.1**2, theta[1], 0.0

    def beside(least: Any, fires: float) -> Any:  # noqa: ANN401
        """The angle of a least volume in that turn of the cycle that is next to another angle."""
        return least + 2.0 * np.pi * np.round((fires - least) / (2.0 * np.pi))

    fires = np.radians(fired.firing_deg)
    for chamber in fired.chambers:
        head = fired.cycles[chamber[0] - 1] if fired.cycles else None
        signs = [1.0 if fired.cylinders[n - 1].side_rods else -1.0 for n in chamber]
        tops = np.radians([fired.tdc_deg[n - 1] for n in chamber])
        if head is not None:
            pistons = [fired.cylinders[n - 1] for n in chamber]
            volume = partial(swept, pistons, tops, [sign * area for sign in signs])
            # That of one piston begins at its top dead centre.
            least = tops[0] if len(chamber) == 1 else least_at(partial(volume, part=0))
            begins = beside(least, fires[chamber[0] - 1])
            pressure = head.pressure_at(np.degrees(theta - begins))
            total += float((pressure * volume(theta, 1)).sum() * step)
    for k, end in enumerate(fired.crank_ends or ()):
        if end is not None:
            one, top = fired.cylinders[k], np.radians(fired.tdc_deg[k])
            lowest = least_at(partial(swept, [one], [0.0], [1.0], part=0))
            # Beyond a piston on side rods is its head end.
            least, sign = (0.0, -1.0) if one.side_rods else (lowest, 1.0)
            # Half a turn after the head end; that of side rods half a turn before its chamber.
            begins = beside(top + least, fires[k] + sign * np.pi)
            free = sign * (area - np.pi / 4 * fired.rod_diameter[k] ** 2)
            pressure = end.pressure_at(np.degrees(theta - begins))
            total += float((pressure * free * position(one, theta - top)[1]).sum() * step)
    return total


def two_chambers(seed: int) -> tuple[cp.Engine, dict[str, Any]]:
    """Return opposed pistons on one crankshaft that pump on their outer sides, and figures."""
    draw = np.random.default_rng(seed)
    figures = {
        "lower": (0.05, float(draw.choice([0.16, 0.2])), float(draw.choice([0.0, 0.006]))),
        "upper": (float(draw.choice([0.05, 0.035])), 0.25, 0.0),
        "lead": float(draw.choice([0.0, 9.0, -20.0])),
        "rods": draw.choice([0.0, 0.03, 0.1], 2).tolist(),
        "masses": (1.0, float(draw.choice([1.0, 1.4]))),
        "crankcase": float(draw.choice([ATMOSPHERE, 1.3e5])),
        "pumps": draw.permutation([0, 1]).tolist(),
    }
    lower, upper = (
        cp.Cylinder(r, rod, mass, pin_offset=e, bore=0.1)
        for (r, rod, e), mass in zip(
            (figures["lower"], figures["upper"]), figures["masses"], strict=True
        )
    )
    bare = cp.Engine.opposed_pistons(
        lower, upper=upper, throws_deg=[0], spacing=0.12, strokes=2,
        lead_deg=figures["lead"], one_crankshaft=True,
    )  # fmt: skip
    pumps = [(*SMOOTH[2], None)[k] for k in figures["pumps"]]
    return bare.with_cycle(
        SMOOTH[2][0], crankcase=figures["crankcase"], crank_end=pumps, rod_diameter=figures["rods"]
    ), figures


@in_turn("seed", list(range(24)))
def test_a_piston_between_two_chambers_is_a_free_body(seed: int) -> None:
    """Side rods and a crankcase that is a pump: forces, torque and loads by rods in balance."""
    engine, figures = two_chambers(seed)
    degrees = np.linspace(0.0, 360.0, 721)
    theta, rpm = np.radians(degrees), 900.0
    square = (2.0 * np.pi * rpm / 60.0) ** 2
    tops, kinds = np.radians(engine.tdc_deg), ("lower", "upper")
    signs = (-1.0, 1.0)  # the chamber shrinks as the lower piston rises, and as the upper one falls

    def volume(at: Any) -> Any:  # noqa: ANN401
        each = zip(signs, tops, kinds, strict=True)
        return sum(sign * faces.place(at - top, *figures[kind]) for sign, top, kind in each)

    shared = SMOOTH[2][0].pressure_at(np.degrees(theta - least_at(volume)))
    area, total = np.pi / 4 * 0.1**2, np.zeros(theta.shape)
    loads, rods = cp.bearing_loads(engine, rpm, degrees), cp.rod_loads(engine, rpm, degrees)
    largest = float(np.abs(loads.crankpin).max())
    # Where a volume is least to 1e-8, and pressure linear over half a degree.
    within = 1e-6 * largest
    for k, (kind, mass) in enumerate(zip(kinds, figures["masses"], strict=True)):
        own, lengths = theta - tops[k], figures[kind]
        # A crank end begins where the piston is lowest, the head end of side rods at TDC.
        begins = least_at(partial(faces.place, r=lengths[0], rod=lengths[1], e=lengths[2]))
        pump = SMOOTH[2][figures["pumps"][k]].pressure_at(
            np.degrees(own - (begins if kind == "lower" else 0.0))
        )
        through = np.pi / 4 * figures["rods"][k] ** 2
        beyond = pump * (area - through) + figures["crankcase"] * through
        gas = shared * area - beyond if kind == "lower" else beyond - shared * area
        towards = gas + mass * square * faces.bend(own, *lengths)
        pin = faces.on_crankpin(own, towards, *lengths)
        # Along an upright bore is y, a quarter turn ahead of it −x.
        expected = np.stack([-pin[:, 1], pin[:, 0]], axis=-1)
        np.testing.assert_allclose(loads.crankpin[k], expected, atol=within)
        np.testing.assert_allclose(rods.gas_load[k], gas, atol=within)
        np.testing.assert_allclose(rods.rod_load[k], towards, atol=within)
        total += faces.turning(own, faces.on_crankpin(own, gas, *lengths), lengths[0])
    wave = engine.waveform(rpm, theta_deg=degrees).read("crank_torque.gas")
    np.testing.assert_allclose(wave, total, atol=0.05 * within)
    mean = float(np.trapezoid(total, theta) / (2.0 * np.pi))
    assert engine.balance(rpm, orders=[1]).crank_torque.cycle_mean == pytest.approx(
        mean, abs=0.05 * within
    )
    torque = engine.balance(rpm, orders=[1, 2]).crank_torque
    for order in (1, 2):
        phasor = np.trapezoid(total * np.exp(-1j * order * theta), theta) / np.pi
        assert torque[order].gas.peak == pytest.approx(abs(phasor), abs=0.05 * within)


SEEDS = list(range(40))
ORDERS = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0]


@in_turn("seed", SEEDS)
def test_mean_torque_is_the_work_of_all_chambers(seed: int) -> None:
    fired = engine(seed)
    mean = fired.balance(100.0, orders=[1]).crank_torque.cycle_mean
    expected = work(fired) / (np.pi * fired.strokes)
    size = np.abs(fired.waveform(0.0).read("crank_torque.gas")).max()
    # Pressure is linear between samples of half a degree; where a volume is least, to 1e-8.
    assert mean == pytest.approx(expected, abs=1e-6 * size)
    parts = cp.torsional_excitation(fired, 100.0, orders=[1]).mean_torque
    assert np.sum(parts) == pytest.approx(mean, abs=1e-11 * size)


@in_turn("seed", SEEDS)
def test_waveforms_have_the_orders_of_the_balance(seed: int) -> None:
    fired = engine(seed)
    theta = np.arange(0.0, 720.0, 0.25)
    for name in ("crank_torque", "torque"):
        wave = fired.waveform(300.0, theta_deg=theta).read(f"{name}.gas")
        balance = fired.balance(300.0, orders=ORDERS)
        found = np.fft.rfft(wave) / len(theta) * 2.0
        for order in ORDERS:
            expected = balance.read(f"{name}.gas")[ORDERS.index(order)]
            assert abs(found[int(2 * order)] - expected) <= 1e-6 * np.abs(wave).max(), (name, order)


@in_turn("seed", SEEDS)
def test_a_balance_is_a_row_of_a_sweep(seed: int) -> None:
    fired = engine(seed)
    speeds = [200.0, 350.0]
    swept = cp.sweep(fired, rpm=speeds, orders=ORDERS)
    for name in ("crank_torque", "torque", "force", "moment"):
        for k, rpm in enumerate(speeds):
            alone = np.asarray(fired.balance(rpm, orders=ORDERS).read(name))
            row = np.asarray(swept.read(name))[k]
            np.testing.assert_allclose(row, alone, atol=1e-11 * max(np.abs(alone).max(), 1e-9))


def test_crank_ends_have_no_place_in_firing_orders_and_count_in_torque() -> None:
    """Two like ends of a yoke fire half a turn apart: torque has no odd orders."""
    yoke = cp.Cylinder(0.05, np.inf, 1.0, bore=0.1)
    bare = cp.Engine.inline(yoke, throws_deg=[0], spacing=0.1, strokes=2, firing_order="1")
    cycle = SMOOTH[2][0]
    single, double = bare.with_cycle(cycle), bare.with_cycle(cycle, double_acting=True)
    assert str(double.firing()) == str(single.firing())
    assert double.firing_intervals_deg.tolist() == [360.0]
    torques = [one.balance(100.0, orders=[1, 2, 3, 4]).crank_torque for one in (single, double)]
    one, both = (np.abs([torque[n].gas.peak for n in (1, 2, 3, 4)]) for torque in torques)
    assert (both[[0, 2]] < 1e-12 * one.max()).all()
    np.testing.assert_allclose(both[[1, 3]], 2.0 * one[[1, 3]], rtol=1e-12)
    assert torques[1].cycle_mean == pytest.approx(2.0 * torques[0].cycle_mean, abs=1e-9)
