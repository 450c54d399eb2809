"""An object of every public class, and of every kind of results."""

# ruff: noqa: ANN401 - options of any call, results of any class

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cache, partial
from typing import Any

import crankpin as cp
import numpy as np

from support.engines import OFFSET
from support.scope import scope

V6 = cp.Engine.vee(
    OFFSET,
    bank_angle_deg=60,
    throws_deg=[0, 120, 240],
    spacing=0.13,
    rotating_mass=0.8,
    name="V6",
    source="a test",
)
ODD = cp.Engine.from_lists(
    [OFFSET, OFFSET.replace(reciprocating_mass=1.5), OFFSET],
    tdc_deg=["360/7", Fraction(1, 3), 51.4],
    bank_deg=[Fraction(-720, 11), "-1/1000000", 0.1],
    z=[0.0, 0.1, 1.0 / 3.0],
    rotating_mass=[0.0, 0.1, 1e-30],
    name='quotes " and \\ and\nlines, Ω',
)
I4 = cp.Engine.preset("i4", cylinder=OFFSET.replace(bore=0.09))
LINKED = cp.Engine.radial(
    cp.Cylinder(0.06, 0.23, 1.0, bore=0.12), 5,
    rods=cp.LinkRods(0.052, 0.178, big_end_mass=0.3),
)  # fmt: skip
FIRED = I4.with_cycle([cp.Cycle.example(), cp.Cycle.example(), None, cp.Cycle.example()])
SPECTRUM = {1: 0.5, 2: 0.1 + 0.05j}
THETA = np.arange(0.0, 720.0, 10.0)


def balance(**options: Any) -> cp.results.Balance:
    given: dict[str, Any] = {"rpm": 5000, "orders": [1, 2, 6]}
    return V6.balance(**given | options)


def waveform(**options: Any) -> cp.results.Waveform:
    given: dict[str, Any] = {"rpm": 5000, "theta_deg": THETA}
    return V6.waveform(**given | options)


def sweep(**options: Any) -> cp.results.Sweep:
    given: dict[str, Any] = {"rpm": [3000, 5000], "bank_angle_deg": [60, 75, 90], "hold": "pins"}
    return cp.sweep({"even": V6, "again": V6}, **given | {"orders": [1, 2]} | options)


def ranking(**options: Any) -> cp.results.Ranking:
    given: dict[str, Any] = {"rpm": 5000, "bank_angle_deg": [60, 75, 90], "hold": "pins"}
    given |= {"by": "total.moment.peak"}
    return cp.rank({"even": V6, "again": V6}, **given | {"orders": [1, 2]} | options)


def designs(**options: Any) -> cp.results.Designs:
    given: dict[str, Any] = {"layout": "vee", "bank_angle_deg": 72, "by": "total.moment.peak"}
    given |= {"cylinder": OFFSET, "spacing": 0.1, "rpm": 5000, "counterweights": True}
    return cp.design(6, **given | options)


MOUNTED = cp.Powertrain(
    I4,
    cp.RigidBody(150.0, (0.0, 0.06, 0.1), (7.0, 8.0, 4.5)),
    [
        cp.Mount("front", (0.0, -0.1, -0.3), 1e5, track=cp.InertiaTrack(1e5, 9.0, 0.2)),
        cp.Mount("right", (0.3, -0.1, 0.4), (2e5, 1e5, 1e5), tilt_deg=130, loss_factor=0.1),
        cp.Mount("left", (-0.3, -0.1, 0.4), (2e5, 1e5, 1e5), tilt_deg=50, damping=200.0),
    ],
)
SHAKEN = MOUNTED.replace(
    engine=None, forces=cp.ForceTable(900, {1: (0, 50, 0, 3j, 0, 0)}, name="table")
)
FLOOR = cp.BaseMotion({8.0: (0, 1e-4, 0), 20.0: (1e-5j, 2e-5, 0)})
STIFFER = MOUNTED.replace(
    mounts=[mount.replace(stiffness=1.5 * np.array(mount.stiffness)) for mount in MOUNTED.mounts]
)

RAFT = cp.Subframe(MOUNTED.body, MOUNTED.mounts)
PANEL = cp.Receptance(
    [("left", "y")],
    ([5.0, 200.0], [[[1e-6 - 1e-7j]], [[1e-8 - 1e-9j]]]),
    {"rail": np.full((2, 3, 1), 1e-8j)},
)
SHAKER = cp.Actuator(
    "shaker", (0.1, 0.2, 0.1), (0, 1, 0), force=50, mass=2, stroke=0.002, resonance=4,
    damping_ratio=0.2,
)  # fmt: skip


LOCOMOTIVE = cp.Locomotive(
    cp.Cylinder(0.3, 2.4, 300.0), z=[-0.35, 0.35], throws_deg=[0, 90], wheel_z=[-0.8, 0.8],
    share=0.6, rotating_mass=120, wheel_diameter=1.7, axle_x=[0.0, 1.9], driving=2,
    coupling=[cp.Unbalance(20, -0.9, 180, pin=1), cp.Unbalance(20, 0.9, 180, pin=2)],
    wheel_load=[70e3] * 4, name="Two cylinders",
)  # fmt: skip


@cache
def cancelled() -> cp.results.Cancellation:
    return MOUNTED.response([900.0, 3000.0], orders=[2, 4]).cancel(SHAKER, [(0, 0.3, 0)], orders=2)


class Made(Mapping[str, Any]):
    """Objects by name, of which each is made when it is first read."""

    def __init__(self, makers: Mapping[str, Callable[[], Any]]) -> None:
        self._makers = makers
        self._ready: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._ready:
            self._ready[name] = self._makers[name]()
        return self._ready[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)

    def __or__(self, others: Mapping[str, Callable[[], Any]]) -> Made:
        return Made({name: partial(self.__getitem__, name) for name in self} | dict(others))


OBJECTS = Made(
    {
        "Cylinder": lambda: OFFSET,
        "Cycle": lambda: cp.Cycle(np.arange(0.0, 720.0, 20.0), np.linspace(1e5, 3e6, 36)),
        "CycleMap": lambda: cp.CycleMap(
            [1000], [0, 1], [[cp.Cycle.example(), cp.Cycle.example("diesel")]]
        ),
        "Traces": lambda: cp.Traces(
            THETA, cp.Cycle.example().pressure_at(THETA) * [[0.99], [1.0], [1.02]]
        ),
        "Engine": lambda: V6,
        "PeriodicLoad": lambda: cp.PeriodicLoad(
            "pump", on="both", torque={0: 3, 1.5: 2 - 1j}, force={2: 5}
        ),
        "Engine of odd angles": lambda: ODD,
        "Balance": balance,
        "Balance, auto": lambda: balance(orders="auto"),
        "Balance of a spectrum": lambda: balance(spectrum=SPECTRUM),
        "Comparison": lambda: cp.compare(V6, ODD, rpm=5000, orders=[1, 2]),
        "OrderBalance": lambda: balance()[1],
        "Exercise": lambda: cp.exercise("v-twin", seed=3),
        "Explanation": lambda: V6.explain(5000),
        "VanishingOrders": V6.vanishing_orders,
        "VanishingOrders of odd angles": lambda: ODD.vanishing_orders([1, 2], reference_z=0.3),
        "StarDiagram": lambda: cp.star_diagram(
            cp.Engine.preset("i6"), [0.5, 3], mode_shape=[1, 2, 3, 4, 5, 6]
        ),
        "ClosedForm": lambda: V6.replace(cylinder=OFFSET.replace(pin_offset=0.0)).closed_form(1),
        "ClosedForm of a force": lambda: V6.closed_form(2, "force", reference_z=0.0),
        "TorsionalExcitation": lambda: cp.torsional_excitation(V6, rpm=3000, orders=[1, 2]),
        "Waveform": waveform,
        "Waveform, auto": lambda: waveform(orders="auto"),
        "BearingLoads": lambda: cp.bearing_loads(V6, 5000, THETA),
        "RodLoads": lambda: cp.rod_loads(V6, 5000, THETA),
        "Sweep": sweep,
        "Sweep of one": lambda: cp.sweep(V6, rpm=5000),
        "SweepWaveform": lambda: sweep().waveform(THETA),
        "SweepWaveform, exact": lambda: sweep().waveform(THETA, exact=True),
        "Ranking": ranking,
        "Ranking, refined, by a function": lambda: ranking(
            by=lambda b: b.rpm / b.orders[0], refine=True
        ),
        "Ranking of what nobody wants": lambda: ranking(by=lambda _: np.nan),
        "Ranking of engines as they are": lambda: cp.rank(
            [V6, ODD], rpm=5000, by="total.moment.peak", spectrum=SPECTRUM
        ),
        "Choice": lambda: ranking()[0],
        "Counterweights": lambda: cp.counterweights(V6, planes="ends"),
        "Counterweights, bay by bay": lambda: cp.counterweights(
            V6, planes="webs", target="internal", factor=0.4, bound=0.1
        ),
        "Flywheel": lambda: cp.flywheel(([0, 120, 360], [300, 500, 300]), rpm=600, inertia=2.0),
        "TurningMomentAreas": lambda: cp.turning_moment_areas(
            [52, -124, 92, -20], torque_scale=600, angle_scale_deg=3, rpm=600, irregularity=0.03
        ),
        "FlywheelRim": lambda: cp.flywheel_rim(45.0, rim_speed=25, rpm=240, width_ratio=2),
        "FlywheelDisc": lambda: cp.flywheel_disc(0.12, diameter=0.28),
        "BobWeight": lambda: cp.bob_weight(V6, 0.52, oil=0.004),
        "Card": lambda: cp.bob_weight(V6, parts={"piston": 0.5, "pin": 0.1}).card(
            [0.52], rpm=5000, planes="ends", radius=0.07, balanced_to=1.0
        ),
        "TwoPlaneCorrection": lambda: cp.two_plane_correction(
            [120, 80], [30, 200], measured_z=[0.0, 0.4], correction_z=[0.05, 0.35]
        ),
        "Designs": designs,
        "Designs by a function": lambda: designs(by=lambda b: b.total.moment.peak, shafts=[-1, 2]),
        "Designs of unlike cylinders": lambda: cp.design(
            4,
            layout="inline",
            cylinder=OFFSET,
            spacing=0.1,
            rpm=600,
            masses=[0.5, None, None, 0.5],
            throws_deg=[0, None, None, 120],
            by="[1].force.peak,[1].moment.peak",
        ),
        "Design": lambda: designs()[0],
        "Rod": lambda: cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05),
        "LinkRod": lambda: cp.LinkRod(1, 0.052, "360/7", 0.3),
        "LinkRods": lambda: cp.LinkRods(0.052, 0.178, [72, "360/7"], 0.3),
        "DeadCentres": lambda: cp.dead_centres(LINKED, compression_ratio=6),
        "Engine with link rods": lambda: LINKED,
        "Shaft": lambda: cp.Shaft(-1, [cp.Unbalance(0.01, 0.1)], x=0.1),
        "Unbalance": lambda: cp.Unbalance(0.01, 0.1, "360/7"),
        "ValveTiming": cp.ValveTiming,
        "PortTiming": lambda: cp.PortTiming(exhaust_opens_deg=80),
        "Arrangement": lambda: cp.search_arrangements(6)[0],
        "ArrangementSearch": lambda: cp.search_arrangements(6),
        "BalanceShafts": lambda: cp.balance_shafts(I4, [2, -2]),
        "BalancerOptions": lambda: cp.balancer_options(V6, rpm=1000, most_shafts=1),
        "BalancerOption": lambda: cp.balancer_options(V6, rpm=1000, most_shafts=1)[0],
        "Firing": I4.firing,
        "Match": lambda: cp.match_parts(I4, [0.5, 0.51, 0.49, 0.5, 0.505]),
        "Quantity": lambda: balance()[1].moment,
        "Table": lambda: balance().table,
        "Tolerances": lambda: cp.tolerances(I4, rpm=1000, reciprocating_mass=0.01, samples=200),
        "Verdicts": lambda: V6.vanishing_orders().force,
        "Balance, fired": lambda: FIRED.balance(3000),
        "BearingLoads, fired": lambda: cp.bearing_loads(FIRED, 3000, THETA),
        "RodLoads, double acting": lambda: cp.rod_loads(
            I4.with_cycle(cp.Cycle.example(), double_acting=True, rod_diameter=0.02), 3000
        ),
        "Waveform, fired": lambda: FIRED.waveform(3000, theta_deg=THETA),
        "OperatingMap": lambda: cp.operating_map(
            I4,
            [1000, 3000],
            cycle=cp.CycleMap(
                [1000, 3000], [0, 1], [[cp.Cycle.example(load=k) for k in (0, 1)]] * 2
            ),
            load=[0, 0.5, 1],
            inertia=0.2,
        ),
        "Oscillogram": scope,
        "PreparedTrace": lambda: cp.prepare_trace(
            cp.Traces(THETA, cp.Cycle.example().pressure_at(THETA) * [[0.99], [1.0], [1.02]]),
            OFFSET.replace(bore=0.09),
            intake_pressure=1e5,
        ),
        "Flywheel, fired": lambda: cp.flywheel(FIRED, 3000, inertia=0.1),
        "TorsionalExcitation, fired": lambda: cp.torsional_excitation(FIRED, 3000),
        "InertiaTrack": lambda: MOUNTED.mounts[0].track,
        "Mount": lambda: MOUNTED.mounts[0],
        "RigidBody": lambda: MOUNTED.body,
        "Powertrain": lambda: MOUNTED,
        "StaticState": lambda: MOUNTED.static(100.0),
        "LoadCases": lambda: MOUNTED.load_cases({"rest": {}, "drive": {"torque": 100.0}}),
        "ForceTable": lambda: cp.force_table(ODD, 600.0, orders=[1, 2]),
        "Soil": lambda: cp.Soil(6e7, 0.3),
        "BaseMotion": lambda: FLOOR,
        "BaseResponse": lambda: MOUNTED.response(base=FLOOR),
        "BaseResponse by order": lambda: MOUNTED.response(
            3000.0, orders=[1, 2], base=cp.BaseMotion({1: (0, 1e-5, 0)}, by="order")
        ),
        "MountComparison": lambda: cp.compare_mounts(
            MOUNTED, STIFFER, [900.0, 3000.0], point=(0, 0.3, 0), orders=[1, 2]
        ),
        "MountComparison at one speed": lambda: cp.compare_mounts(
            MOUNTED, STIFFER, 3000.0, orders=[2, 4]
        ),
        "VehicleAxes": lambda: cp.VehicleAxes(flywheel="forward", origin=(1.4, 0.2, 0.4)),
        "Powertrain of forces": lambda: SHAKEN,
        "MountResponse of forces": lambda: SHAKEN.response(3000.0),
        "MountModes": lambda: MOUNTED.modes(20.0),
        "RollAxes": lambda: MOUNTED.axes(20.0),
        "MountResponse": lambda: MOUNTED.response([900.0, 3000.0], orders=[1, 2]),
        "MountResponse at one speed": lambda: MOUNTED.response(3000.0, orders=[2, 4]),
        "OrderResponse": lambda: MOUNTED.response(3000.0)[2],
        "Quantity of a response": lambda: MOUNTED.response(3000.0).body_force,
        "PointMotion": lambda: MOUNTED.response(3000.0).at((0.0, 0.3, 0.0)),
        "WorstForce": lambda: MOUNTED.response(3000.0).worst(),
        "Subframe": lambda: RAFT,
        "Receptance": lambda: PANEL,
        "Powertrain on a subframe": lambda: MOUNTED.with_support(RAFT),
        "Powertrain on a receptance": lambda: MOUNTED.with_support(PANEL),
        "MountResponse on a subframe": lambda: MOUNTED.with_support(RAFT).response(
            [900.0, 3000.0], orders=[1, 2]
        ),
        "PointMotion of a receiver": lambda: (
            MOUNTED.with_support(PANEL).response(3000.0, orders=[1, 2]).at("rail")
        ),
        "MountRobustness": lambda: MOUNTED.robustness(
            0.1, cg=1e-3, corners="mounts", frequency=20.0
        ),
        "DesignResponses": lambda: MOUNTED.designs(
            [900.0, 3000.0],
            {"left": {"stiffness": [1e5, 2e5]}},
            orders=[2],
            points=[(0.0, 0.3, 0.0)],
        ),
        "MountSweep": lambda: MOUNTED.sweep(
            [900.0, 3000.0],
            factor=[0.0, 0.5, 1.0],
            receivers={"head": (0.0, 0.3, 0.0)},
            orders=[1, 2],
        ),
        "MountSweep of engines": lambda: MOUNTED.sweep(
            3000.0,
            engines={"four": I4, "crossplane": cp.Engine.preset("i4-crossplane")},
            orders=[2],
        ),
        "Actuator": lambda: SHAKER,
        "Cancellation": cancelled,
        "Cancellation at one speed": lambda: MOUNTED.response(3000.0, orders=[2, 4]).cancel(
            SHAKER, "body_force", watch=[(0, 0.3, 0)]
        ),
        "DrivenResponse": lambda: cancelled().response,
        "AdaptiveLaw": lambda: cancelled().adaptive(delay=1e-3),
        "VelocityFeedback": lambda: MOUNTED.velocity_feedback(SHAKER),
        "FoundationTable": lambda: cp.foundation_table(
            V6.with_shafts([cp.Shaft(-1, [cp.Unbalance(0.01, 0.1)])]), [600, 900]
        ),
        "FoundationTable at one speed": lambda: cp.foundation_table(ODD, 600, orders=[1, 4]),
        "GuideMoments": lambda: cp.guide_moments(V6, [600, 900], orders=[1, 2], length=0.5),
        "GuideMoments, fired": lambda: cp.guide_moments(FIRED, 3000, orders=[0.5, 1, 2]),
        "Locomotive": lambda: LOCOMOTIVE,
        "LocomotiveForces": lambda: LOCOMOTIVE.forces(speed_kmh=60),
        "MountDesign": lambda: cp.design_mounts(
            MOUNTED, vary="stiffness", bounds={"stiffness": (5e4, 4e5)}
        ),
    }
)

UNTABLED = {
    "Cylinder", "LinkRod", "LinkRods", "PortTiming", "Rod", "Shaft", "Unbalance", "ValveTiming",
    "InertiaTrack", "Soil", "VehicleAxes",
    "Mount", "RigidBody", "Actuator", "Subframe", "Receptance",
    "PeriodicLoad",
}  # fmt: skip
"""Inputs, which are no frames."""
RESULTS = Made(
    {
        name: partial(OBJECTS.__getitem__, name)
        for name in OBJECTS
        if re.split(r"\W", name)[0] not in UNTABLED
    }
) | {
    "OrderBalance of a sweep": lambda: OBJECTS["Sweep"][2],
    "Quantity of a balance": lambda: OBJECTS["Balance, fired"].torque,
    "Quantity of a sweep": lambda: OBJECTS["Sweep"].moment,
    "Quantity of an order of a sweep": lambda: OBJECTS["Sweep"].force[2],
    "Quantity of all orders": lambda: OBJECTS["Balance"].total.force,
}
"""All that is frames; names begin with that of a class."""
CHARACTERS = "a0 \t\n\\{}$&#%_~^|<>\"'=+-°·²ω→–₂"
"""What names may have, LaTeX obeys, or fonts of text lack."""
