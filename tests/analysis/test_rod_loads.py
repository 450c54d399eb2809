"""Rod loads and double-acting torque against free bodies, and laws of both faces of pistons."""

from __future__ import annotations

from typing import Any, Literal

import crankpin as cp
import numpy as np
import pytest
from rederivation import faces
from support import in_turn

SUCTION, DISCHARGE, N, ATMOSPHERE = 1e5, 4e5, 1.3, 101_325.0
THETA = np.linspace(0.0, 360.0, 14_401)


def compressor(
    offset: float = 0.0,
    clearance: float = 0.1,
    rod_diameter: float = 0.06,
    unloaded: str = "",
    **parts: float,
) -> cp.Engine:
    """Return a double-acting cylinder, an end of it unloaded or none."""
    figures: dict[str, Any] = {
        "crank_radius": 0.125,
        "rod_length": 0.625,
        "reciprocating_mass": 180.0,
    } | parts
    cylinder = cp.Cylinder(**figures, pin_offset=offset, bore=0.3)
    bare = cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.3, strokes=2)
    ends: dict[str, Any] = {
        end: cp.Cycle.compressor(
            cylinder, suction=SUCTION, discharge=None if end == unloaded else DISCHARGE,
            clearance=clearance, n=N, end=end,
        )
        for end in ("head", "crank")
    }  # fmt: skip
    return bare.with_cycle(ends["head"], crank_end=ends["crank"], rod_diameter=rod_diameter)


CASES = [
    {},
    {"offset": 0.02},
    {"clearance": 0.3, "rod_diameter": 0.0},
    {"unloaded": "crank"},
    {"unloaded": "head", "offset": -0.02},
    {"clearance": 0.0},
]


def derived(case: dict[str, Any], degrees: np.ndarray[Any, Any]) -> dict[str, Any]:
    """Pressures and forces by the equations again."""
    theta, lengths = np.radians(degrees), (0.125, 0.625, case.get("offset", 0.0))
    found: dict[str, Any] = {}
    for end in ("head", "crank"):
        part, grows = faces.swept(theta, end, *lengths)
        found[f"{end} volume"] = part
        found[end] = np.full(theta.shape, SUCTION)
        if case.get("unloaded") != end:
            clearance = case.get("clearance", 0.1)
            with np.errstate(divide="ignore", invalid="ignore"):
                found[end] = faces.compressed(part, grows, SUCTION, DISCHARGE, clearance, N)
    rod = case.get("rod_diameter", 0.06)
    found["gas"] = faces.gas_force(found["head"], found["crank"], ATMOSPHERE, 0.3, rod)
    found["bend"], found["slope"] = faces.bend(theta, *lengths), faces.slope(theta, *lengths)
    return found


@in_turn("case", CASES)
def test_loads_are_those_of_the_free_piston(case: dict[str, Any]) -> None:
    rpm, degrees = 600.0, THETA[1:-1:7]
    engine, again = compressor(**case), derived(case, degrees)
    loads = cp.rod_loads(engine, rpm, degrees)
    inertia = 180.0 * again["bend"] * (2.0 * np.pi * rpm / 60.0) ** 2
    # Where the piston turns a volume is the difference of two places: 1e-16 of 1e-1 or of 1e-4.
    size = np.abs(inertia).max()
    away = np.abs(degrees % 180.0 - 90.0) < 85.0
    np.testing.assert_allclose(loads.inertia_load[0], inertia, atol=1e-11 * size)
    np.testing.assert_allclose(loads.gas_load[0][away], again["gas"][away], atol=1e-9 * size)
    together = loads.gas_load[0] + loads.inertia_load[0]
    np.testing.assert_allclose(loads.rod_load[0], together, atol=1e-12 * size)


@in_turn("case", CASES)
def test_torque_is_the_work_of_both_volumes(case: dict[str, Any]) -> None:
    engine, again = compressor(**case), derived(case, THETA[:-1])
    torque = engine.waveform(0.0, theta_deg=THETA[:-1]).read("crank_torque.gas")
    away = np.abs(THETA[:-1] % 180.0 - 90.0) < 85.0
    expected = -again["gas"] * again["slope"]
    np.testing.assert_allclose(torque[away], expected[away], atol=1e-8 * np.abs(expected).max())
    area, rod = np.pi / 4 * 0.3**2, np.pi / 4 * case.get("rod_diameter", 0.06) ** 2
    stroke = engine.cylinders[0].travel
    work = stroke * (
        area * faces.loop(again["head"], again["head volume"])
        + (area - rod) * faces.loop(again["crank"], again["crank volume"])
    )
    mean = engine.balance(100.0, orders=[1]).crank_torque.cycle_mean
    # Chords over 0.025°, of kinks too.
    assert mean == pytest.approx(work / (2 * np.pi), rel=1e-5)
    (by_cylinder,) = cp.torsional_excitation(engine, 100.0, orders=[1]).mean_torque
    assert by_cylinder == pytest.approx(mean, rel=1e-12)


@in_turn("rpm", [150.0, 300.0, 450.0, 600.0])
@in_turn("case", CASES)
def test_maxima_and_reversals_are_those_of_any_angle(case: dict[str, Any], rpm: float) -> None:
    loads = cp.rod_loads(compressor(**case), rpm, THETA)
    (load,) = loads.rod_load
    # A maximum may stand at a kink: between angles 0.025° apart it may be 1e-3 of the load higher.
    size = 1e-3 * np.abs(load).max()
    for found, sampled in ((loads.compression[0], load.max()), (loads.tension[0], -load.min())):
        assert max(sampled, 0.0) - 1e-9 * size <= found <= max(sampled, 0.0) + size
    for found, angle in (
        (loads.compression[0], loads.compression_deg[0]),
        (-loads.tension[0], loads.tension_deg[0]),
    ):
        beside = cp.rod_loads(loads.engine, rpm, [angle - 1e-9, angle, angle + 1e-9]).rod_load[0]
        assert found == 0.0 or np.abs(beside - found).min() < 1e-4 * size
    in_tension = np.zeros(THETA.shape, dtype=bool)
    for begin, to in loads.tension_ranges_deg[0]:
        for turn in (-360.0, 0.0, 360.0):
            in_tension |= (begin + turn + 1e-9 < THETA) & (to + turn - 1e-9 > THETA)
    # But where gas jumps as the piston turns.
    inside = slice(1, -1)
    np.testing.assert_array_equal(in_tension[inside], (load < -1e-9 * size)[inside])
    # Exactly zero where the sign changes, but for jumps.
    ends = np.array(loads.tension_ranges_deg[0]).ravel()
    at_ends = np.abs(cp.rod_loads(loads.engine, rpm, ends).rod_load[0])
    if case.get("clearance") != 0.0:
        assert (at_ends < 1e-7 * np.abs(load).max()).all()
    shares = in_tension[:-1].mean()
    assert loads.reversal_deg[0] <= 360.0 * min(shares, 1.0 - shares) + 0.1


def test_slow_unloaded_rods_never_reverse() -> None:
    engine = compressor(unloaded="crank")
    assert engine.cycles is not None
    loads = cp.rod_loads(engine.with_cycle(engine.cycles[0], crankcase=9e4), rpm=10)
    assert loads.tension[0] == 0.0
    assert loads.reversal_deg[0] == 0.0
    assert loads.tension_ranges_deg == ((),)
    # With inertia alone half the turn and more.
    idle = cp.rod_loads(engine.with_cycle(None), rpm=600)
    assert idle.reversal_deg[0] > 150.0
    assert not idle.gas_load.any()


def test_piston_mass_is_outboard_where_it_is_known() -> None:
    whole, part = (compressor(piston_mass=mass) for mass in (180.0, 120.0))
    inertia = [cp.rod_loads(one, 600).inertia_load[0] for one in (whole, part)]
    np.testing.assert_allclose(inertia[1], 120 / 180 * inertia[0], atol=1e-7)
    outboard = [c for c in cp.rod_loads(part, 600).table.columns if c.name == "outboard"]
    assert outboard[0].values[0] == 120.0
    wrist = cp.bearing_loads(part, 600, THETA).wrist_pin[0]
    np.testing.assert_allclose(cp.rod_loads(part, 600, THETA).rod_load[0], wrist[:, 1], atol=1e-7)


def test_limits_of_rods_and_ends() -> None:
    def mean(engine: cp.Engine) -> float:
        return float(engine.balance(100.0, orders=[1]).crank_torque.cycle_mean)

    engine = compressor(rod_diameter=0.0)
    assert engine.cycles is not None
    assert engine.crank_ends is not None
    head = engine.with_cycle(engine.cycles[0])
    crank = engine.with_cycle(None, crank_end=engine.crank_ends)
    assert mean(engine) == pytest.approx(mean(head) + mean(crank), rel=1e-13)
    # A rod as thick as the bore leaves the crank end nothing.
    full = compressor(rod_diameter=0.3)
    assert mean(full) == mean(head)
    # Without clearance: the limit of little.
    means = [mean(compressor(clearance=c)) for c in (1e-12, 0.0)]
    assert means[0] == pytest.approx(means[1], rel=1e-9)
    little, none = (cp.rod_loads(compressor(clearance=c), 450.0) for c in (1e-9, 0.0))
    for name in ("compression", "tension", "reversal_deg"):
        # Pressure falls within 1e-3° of the dead centre instead of in it.
        assert getattr(little, name) == pytest.approx(getattr(none, name), rel=1e-5)


@in_turn("part", [0.5, 1e-3, 1e-9, 1e-12])
def test_what_a_thick_rod_leaves_the_crank_end_is_a_ring(part: float) -> None:
    engine = compressor(rod_diameter=0.3 * (1.0 - part))
    assert engine.crank_ends is not None
    whole, ring = (
        engine.with_cycle(None, crank_end=engine.crank_ends, rod_diameter=rod)
        .balance(100.0, orders=[1])
        .crank_torque.cycle_mean
        for rod in (0.0, engine.rod_diameter[0])
    )
    # What is left of the bore is good to an ulp of it.
    left = 0.3 - float(engine.rod_diameter[0])
    assert ring / whole == pytest.approx(left * (0.6 - left) / 0.09, rel=1e-14)


@in_turn("end", ["head", "crank"])
@in_turn("clearance", [0.0, 0.1, 2.0])
def test_an_unloaded_end_is_at_suction_pressure_throughout(
    end: Literal["head", "crank"], clearance: float
) -> None:
    cylinder = cp.Cylinder(0.125, 0.625, 180.0, pin_offset=0.02, bore=0.3)
    options: dict[str, Any] = {"discharge": None, "suction": SUCTION, "clearance": clearance}
    cycle = cp.Cycle.compressor(cylinder, end=end, **options)
    # Of polynomials of sixteen terms.
    np.testing.assert_allclose(cycle.pressure_at(THETA), SUCTION, rtol=1e-14)
    assert abs(cycle.imep(cylinder, end=end)) < 1e-12 * SUCTION


def test_double_acting_is_said_and_refused_by_name() -> None:
    engine = compressor()
    assert engine.loads_counted == "gas: Compressor; crank ends: Compressor, crank end"
    (cycle,) = engine.cycles or ()
    assert cycle is not None
    both = engine.with_cycle(cycle, double_acting=True, rod_diameter=0.06)
    assert both.loads_counted == "gas: Compressor; double acting"
    assert both.rod_diameter.tolist() == [0.06]
    assert engine.replace(name="again").crank_ends == engine.crank_ends
    refused: list[tuple[dict[str, Any], str]] = [
        ({"rod_diameter": 0.06}, "^rod_diameter"),
        ({"double_acting": True, "crank_end": cycle}, "^double_acting"),
        ({"crank_end": [cycle, cycle]}, "^crank_end"),
        ({"crank_end": cycle, "rod_diameter": 0.31}, "^rod_diameter"),
    ]
    for options, words in refused:
        with pytest.raises(cp.InputError, match=words):
            engine.with_cycle(cycle, **options)
    grid = cp.CycleMap([100, 200], [0, 1], [[cycle, cycle]] * 2)
    with pytest.raises(cp.InputError, match="crank_end"):
        cp.sweep(engine, rpm=[100.0], load=[0.5], cycle=grid)
    with pytest.raises(cp.InputError, match=r"^clearance.*valves never open"):
        compressor(clearance=0.6)
