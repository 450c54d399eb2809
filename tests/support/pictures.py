"""Every picture of results, by name, as tests draw it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
from matplotlib import pyplot as plt

from support.engines import CYLINDER, I4, V6
from support.scope import scope

if TYPE_CHECKING:
    from collections.abc import Callable

UNNAMED = cp.Engine.inline(CYLINDER, throws_deg=[0, 120, 240], spacing=0.1)
V8 = cp.Engine.preset("v8-crossplane")
V6_90 = cp.Engine.preset("v6-90")
ORDERS = ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
FAMILY = [cp.Engine.preset(f"ijesc-v6-{order}") for order in ORDERS]
"""The engines of the IJESC paper."""
BANK_ANGLES = np.arange(10.0, 171.0, 10.0)
SUMMARY = [
    cp.Engine.preset(name)
    for name in ("single-ebook", "i3-ebook", "i4-ebook", "boxer-4", "flat-4", "i6")
]
"""The engines of the e-book's summary."""


FITTED = I4.replace(
    rotating_mass=0.4,
    counterweights=[cp.Unbalance(0.012, 0.1 * k, 180, pin=k + 1) for k in range(4)],
    shafts=[
        cp.Shaft(ratio, [cp.Unbalance(0.003, 0.15, -90)], x=x, y=y)
        for ratio, x, y in [(2, 0.08, -0.02), (-2, -0.08, 0.05)]
    ],
)

LOADED = cp.bearing_loads(
    cp.Engine.inline(
        cp.Cylinder.from_rod(cp.Rod(0.55, 0.0022, 0.145, 0.045), 0.043, piston_mass=0.42),
        throws_deg=[0, 180, 180, 0],
        spacing=0.095,
        rotating_mass=0.8,
        name="Inline-4",
    ),
    rpm=6000,
)

COMPRESSED = cp.Cylinder(0.125, 0.625, 180.0, bore=0.3)
RODS = cp.rod_loads(
    cp.Engine.opposed_throws(COMPRESSED, throws_deg=[0, 180], spacing=0.32).with_cycle(
        cp.Cycle.compressor(COMPRESSED, suction=1e5, discharge=9e5),
        crank_end=cp.Cycle.compressor(COMPRESSED, suction=1e5, discharge=9e5, end="crank"),
        rod_diameter=0.06,
    ),
    rpm=450,
)

FIRED = cp.Engine.preset("v6-90-odd-fire", cylinder=CYLINDER.replace(bore=0.09)).with_cycle(
    cp.Cycle.example()
)

MOUNTED = cp.Powertrain(
    cp.Engine.preset("i4", cylinder=CYLINDER.replace(bore=0.09)).with_cycle(cp.Cycle.example()),
    cp.RigidBody(mass=148, cg=(0.02, 0.07, 0.09), inertia=(8.1, 7.6, 4.9)),
    [
        cp.Mount(name, at=at, stiffness=stiffness, tilt_deg=tilt, loss_factor=0.1)
        for name, at, stiffness, tilt in [
            ("right", (0.28, 0.0, -0.09), (220e3, 80e3, 80e3), 45),
            ("left", (-0.28, 0.0, -0.09), (220e3, 80e3, 80e3), 135),
            ("rear", (0.0, -0.12, 0.55), (100e3, 180e3, 100e3), 0),
        ]
    ],
)

THETA = np.arange(-360.0, 360.0, 0.5)
TRACES = cp.Traces(
    THETA,
    cp.Cycle.example().pressure_at(THETA - 0.5) * np.linspace(0.9, 1.1, 20)[:, np.newaxis] + 4e4,
    name="run 7",
)
V10S = cp.design(
    10,
    layout="vee",
    cylinder=CYLINDER,
    spacing=0.1,
    rpm=5000,
    bank_angle_deg=(40, 140),
    throws_deg=[0, 72, 144, 216, 288],
    by="[1].moment.backward,[2].moment.peak",
    shared_pins=True,
    counterweights=True,
)
SPREAD = cp.tolerances(
    I4, rpm=5000, reciprocating_mass=0.002, rotating_mass=0.003, pin_deg=0.1, samples=2000
)


def over_bank_angle(**options: Any) -> cp.results.Sweep:  # noqa: ANN401 - of a sweep
    """The four engines of the IJESC paper over bank angle."""
    return cp.sweep(FAMILY, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="pins", **options)


def over_two(**options: Any) -> cp.results.Sweep:  # noqa: ANN401 - of a sweep
    """One engine over bank angle and rod ratio."""
    angles, ratios = np.arange(0.0, 181.0, 10.0), np.linspace(0.2, 0.4, 12)
    return cp.sweep(V6, rpm=5000, bank_angle_deg=angles, hold="pins", rod_ratio=ratios, **options)


def _spectra(**place: Any) -> Any:  # noqa: ANN401
    ax = V6.balance(5000).plot(label="60°", **place)
    return V6.with_bank_angle(90, hold="pins").balance(5000).plot(ax, label="90°")


def _waveforms(**place: Any) -> Any:  # noqa: ANN401
    ax = V6.waveform(5000).plot(label="60°", **place)
    return V6.with_bank_angle(90, hold="pins").waveform(5000).plot(ax, label="90°")


def _bob_weights(**place: Any) -> Any:  # noqa: ANN401
    twins = [
        cp.Engine.vee(CYLINDER, bank_angle_deg=angle, throws_deg=[0], spacing=0.1, name=f"{angle}°")
        for angle in (45, 60)
    ]
    ax = cp.bob_weight(twins[0]).plot(label="45°", **place)
    return cp.bob_weight(twins[1], 0.6).plot(ax, label="60°")


def _of_one_panel(plot: Callable[..., Any]) -> Callable[..., Any]:
    return lambda ax=None: plot(plt.subplots(layout="constrained")[1] if ax is None else ax)


ON_MOUNTS = cp.Powertrain(
    I4,
    cp.RigidBody(150.0, (0.0, 0.06, 0.15), (7.0, 8.0, 4.5)),
    [
        cp.Mount(name, (x, -0.12, z), (1.5e5, 3e5, 1.2e5), tilt_deg=20, loss_factor=0.1)
        for name, x, z in [("right", 0.22, -0.1), ("left", -0.22, -0.1), ("rear", 0.0, 0.4)]
    ],
)
SHAKER = cp.Actuator("head", (0, 0.3, 0.1), (0, 1, 0), force=150, mass=2, stroke=0.004)
SEAT = {"seat": ((0.22, -0.12, 0.4), (0, 1, 0))}


def _cancelled(rpm: Any, **place: Any) -> Any:  # noqa: ANN401
    response = ON_MOUNTS.response(rpm, orders=[2, 4])
    return response.cancel(SHAKER, SEAT, orders=2, watch={"head": (0, 0.4, 0)}).plot(**place)


def _scattered() -> Any:  # noqa: ANN401
    draw = np.random.default_rng(4)
    vary = {
        m.name: {"stiffness": draw.uniform(0.5, 1.6, (40, 1)) * m.stiffness}
        for m in ON_MOUNTS.mounts
    }
    return ON_MOUNTS.designs(np.arange(600, 4001, 100.0), vary, orders=[2, 4])


TWIN_IN_FRAME = cp.Powertrain(
    cp.Engine.preset("i2-360"),
    cp.RigidBody(60.0, (0.0, 0.06, 0.05), (2.0, 2.2, 1.6)),
    [
        cp.Mount(name, at, (3e6, 6e5, 1e6), loss_factor=0.1)
        for name, at in [
            ("front", (0.0, 0.1, -0.25)),
            ("rear", (0.0, -0.15, 0.3)),
            ("head", (0.05, 0.3, 0.0)),
        ]
    ],
)


@cache
def designed() -> cp.results.MountDesign:
    """Mounts whose modes are between two frequencies."""
    return cp.design_mounts(
        MOUNTED,
        vary=["stiffness", "y"],
        bounds={"stiffness": (3e4, 6e5), "y": 0.05},
        modes_between=(5, 25),
        starts=1,
    )


ON_TILTED = MOUNTED.replace(
    body=MOUNTED.body.replace(
        inertia=[[8.1, 0.3, -0.6], [0.3, 7.6, -1.1], [-0.6, -1.1, 4.9]], products="tensor"
    )
)

PETROL = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.5, bore=0.086))
PART_LOAD = cp.CycleMap(
    [1000, 6000], [0, 1], [[cp.Cycle.example(load=each) for each in (0, 1)]] * 2
)

SHIP = cp.Engine.preset("marine-6").with_cycle(cp.Cycle.example("diesel", strokes=2))
LOCOMOTIVE = cp.Locomotive(
    cp.Cylinder(0.3, 2.0, 300.0), z=[-0.35, 0.35], throws_deg=[0, 90], wheel_z=[-0.8, 0.8],
    share=0.66, wheel_diameter=1.7, wheel_load=45e3, name="Two cylinders",
)  # fmt: skip

PICTURES: dict[str, Callable[..., Any]] = {
    "cancelled": _of_one_panel(lambda ax: _cancelled(1200.0, ax=ax)),
    "cancelled-over-speed": _of_one_panel(lambda ax: _cancelled(np.arange(800, 5001, 50.0), ax=ax)),
    "spectrum": lambda **place: V6.balance(5000).plot(**place),
    "spectrum-log": lambda **place: V6.balance(5000, orders=range(1, 11)).plot(log=True, **place),
    "spectra": _spectra,
    "ellipses": lambda **place: V6.balance(5000).plot(kind="ellipses", **place),
    "ellipses-on-axes": _of_one_panel(lambda ax: V6.balance(5000).plot(ax, kind="ellipses")),
    "waveform": lambda **place: V6.waveform(5000, theta_deg=range(361)).plot(**place),
    "waveforms": _waveforms,
    "torque": lambda **place: FIRED.waveform(3000).plot(quantity="crank_torque", **place),
    "torque-spectrum": lambda **place: FIRED.balance(
        3000, orders=[0.5 * n for n in range(1, 17)]
    ).plot(quantity="crank_torque", **place),
    "orbit": lambda **place: V8.waveform(5000).plot(kind="orbit", **place),
    "sweep": lambda **place: over_bank_angle().plot(**place),
    "sweep-on-axes": _of_one_panel(lambda ax: over_bank_angle().plot(ax)),
    "sweep-parts": lambda **place: cp.sweep(
        FAMILY[1:3], rpm=5000, bank_angle_deg=range(181), hold="pins"
    ).plot(kind="parts", orders=[1, 2], **place),
    "sweep-scale": lambda **place: over_two(orders=[1, 2]).plot(kind="curves", **place),
    "map": lambda **place: over_two().plot(**place),
    "orders": lambda **place: cp.sweep(
        V6, rpm=np.arange(1000.0, 6001.0, 500.0), orders=range(1, 9)
    ).plot(kind="orders", **place),
    "bars": lambda **place: cp.sweep(SUMMARY, rpm=10).plot(**place),
    "sweep-waveform": lambda **place: cp.sweep(FAMILY, rpm=5000).waveform().plot(**place),
    "envelope": lambda **place: over_two(orders=[1, 2]).waveform(range(361)).plot(**place),
    "ranking": lambda **place: cp.rank(
        dict(zip(ORDERS, FAMILY, strict=True)),
        rpm=5000,
        bank_angle_deg=BANK_ANGLES,
        hold="pins",
        by="total.moment.peak",
        refine=True,
    ).plot(**place),
    "ranking-list": lambda **place: cp.rank(
        [I4, V6, V8, *map(cp.Engine.preset, ("i6", "i5", "boxer-4", "w12"))],
        rpm=5000,
        by="total.moment.peak",
    ).plot(**place),
    "counterweights": lambda **place: cp.counterweights(V6_90, planes="webs").plot(**place),
    "counterweights-drilled": lambda **place: cp.counterweights(
        V8, planes="webs", angles_deg=[0, 90, 180, 270]
    ).plot(kind="weights", **place),
    "counterweights-ellipses": lambda **place: cp.counterweights(V6_90, planes="ends").plot(
        kind="ellipses", **place
    ),
    "flywheel": lambda **place: cp.flywheel(
        lambda deg: 5000 + 600 * np.sin(np.radians(2 * deg)),
        load_torque=lambda deg: 5000 + 500 * np.sin(np.radians(deg)),
        rpm=150,
        inertia=80.0,
    ).plot(**place),
    "turning-moment-areas": lambda **place: cp.turning_moment_areas(
        [52, -124, 92, -140, 85, -72, 107], torque_scale=600, angle_scale_deg=3
    ).plot(**place),
    "foundation-table": lambda **place: cp.foundation_table(
        FITTED.replace(bank_deg=[75] * 4), 3000, orders=(1, 2, 4)
    ).plot(**place),
    "foundation-over-speed": lambda **place: cp.foundation_table(
        cp.Engine.preset("marine-5"), range(60, 211, 10), orders=(1, 2, 4)
    ).plot(**place),
    "guide-moments": lambda **place: cp.guide_moments(SHIP, 210).plot(**place),
    "guide-moments-map": lambda **place: cp.guide_moments(SHIP, range(60, 211, 10)).plot(**place),
    "hammer-blow": _of_one_panel(lambda ax: LOCOMOTIVE.forces(speed_kmh=90).plot(ax)),
    "bob-weight": lambda **place: cp.bob_weight(V6_90).plot(**place),
    "bob-weights": _bob_weights,
    "search": lambda **place: cp.search_arrangements(14).within(40, 70).plot(**place),
    "engine": lambda **place: FITTED.plot(theta_deg=30, **place),
    "engine-vee": lambda **place: V8.plot(theta_deg=30, **place),
    "section": lambda **place: cp.Engine.preset("w12").plot(kind="section", **place),
    "star": lambda **place: FITTED.plot(kind="star", **place),
    "side": lambda **place: FITTED.plot(kind="side", theta_deg=30, **place),
    "firing": lambda **place: V8.firing().plot(**place),
    "star-diagram": lambda **place: cp.star_diagram(cp.Engine.preset("i5")).plot(**place),
    "phasors": lambda **place: V8.balance(5000).plot(kind="phasors", **place),
    "balance-shafts": lambda **place: cp.balance_shafts(I4, [-2, 2]).plot(
        quantity="force", **place
    ),
    "balancer-options": lambda **place: cp.balancer_options(V6_90, rpm=5000).plot(**place),
    "cycle": cp.Cycle.example().plot,
    "cycle-volume": lambda **place: cp.Cycle.example().plot(
        cylinder=cp.Cylinder(0.043, 0.145, 0.5, bore=0.086), **place
    ),
    "traces": TRACES.plot,
    "oscillogram": scope().plot,
    "prepared-trace": lambda **place: cp.prepare_trace(
        TRACES, cp.Cylinder(0.043, 0.145, 0.5, bore=0.086), tdc_deg=0.5, intake_pressure=0.95e5
    ).plot(**place),
    "bearing-loads": LOADED.plot,
    "bearing-loads-curves": lambda **place: LOADED.plot(kind="curves", **place),
    "bearing-loads-crankpin": lambda ax=None: LOADED.plot(
        ax, load="crankpin", numbers=[1], axes="rod"
    ),
    "bending": lambda **place: LOADED.plot(kind="bending", **place),
    "rod-loads": RODS.plot,
    "powertrain": MOUNTED.plot,
    "table-bars": lambda **place: MOUNTED.static(120.0).plot(**place),
    "table-curves": cp.sweep(I4, rpm=range(1000, 6001, 500)).table.plot,
    "table-words": lambda **place: V8.vanishing_orders().plot(**place),
    "mount-modes": MOUNTED.modes().plot,
    "mount-cuts": lambda **place: (
        MOUNTED.with_misfire(cylinder=3).response(range(500, 6001, 20)).plot(**place)
    ),
    "mount-map": lambda **place: (
        MOUNTED.with_misfire(cylinder=3).response(range(500, 6001, 20)).plot(kind="map", **place)
    ),
    "mount-waterfall": lambda **place: (
        MOUNTED.with_misfire(cylinder=3)
        .response(range(500, 6001, 20))
        .plot(kind="waterfall", **place)
    ),
    "mount-point": lambda **place: (
        MOUNTED.response(np.arange(600, 3001, 100)).at((0, 0.3, 0)).plot(kind="map", **place)
    ),
    "mount-spectrum": lambda **place: MOUNTED.response(800).plot(mount="rear", **place),
    "mount-design": lambda **place: designed().plot(**place),
    "mount-designs": lambda **place: _scattered().plot(order=2, **place),
    "mount-factors": lambda **place: TWIN_IN_FRAME.sweep(
        np.arange(2000, 7001, 100),
        factor=np.linspace(0, 1, 41),
        receivers={"grip": (0.3, 0.6, -0.4), "peg": (0.25, -0.1, 0.2)},
    ).plot(**place),
    "mount-robustness": lambda **place: MOUNTED.robustness(0.15, mass=0.02, cg=0.01).plot(**place),
    "roll-axes": ON_TILTED.axes().plot,
    "designs": V10S.plot,
    "tolerances": SPREAD.plot,
    "tolerance-shares": lambda **place: SPREAD.plot(kind="shares", **place),
    "operating-map": lambda **place: cp.operating_map(
        PETROL, np.arange(1000, 6001, 500), cycle=PART_LOAD, load=[0, 0.25, 0.5, 0.75, 1]
    ).plot(**place),
    "operating-curves": lambda **place: cp.operating_map(PETROL, np.arange(1000, 7001, 500)).plot(
        quantity="crankpin", **place
    ),
    "torsional-excitation": lambda **place: cp.torsional_excitation(FIRED, 3000).plot(**place),
    "torsional-map": lambda **place: cp.torsional_excitation(FIRED, np.arange(600, 6001, 200)).plot(
        **place
    ),
    "comparison": lambda **place: cp.compare(I4, FITTED, rpm=5000).plot(quantity="force", **place),
}
