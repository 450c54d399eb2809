"""Sound values of parameters, by what a parameter is called.

One table for all callables: a name means one thing throughout the package, and where it means
several (``load`` is a part of full load, a bearing, a curve) the first value that a call takes is
taken. Parameters that are not in it follow from their annotation and docstring: choices that are
listed, a truth value, an instance of a class.
"""

from __future__ import annotations

import atexit
import importlib
import importlib.util
import shutil
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import crankpin as cp
import numpy as np
from support import scope

from fuzzing.sound import CYCLE, JSON, TOML, two_stroke

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
ENGINE = cp.Engine.preset("v6-60", cylinder=CYLINDER).with_cycle(CYCLE)
"""The engine of all calls: fired and of two banks, so that every analysis is defined for it."""
DOUBLE_ACTING = ENGINE.with_cycle(CYCLE, double_acting=True)
MOUNTS = (
    cp.Mount("front", (0.0, -0.1, -0.3), 1e5, damping=100.0),
    cp.Mount("right", (0.3, -0.1, 0.4), (2e5, 1e5, 1e5), tilt_deg=130, loss_factor=0.1),
    cp.Mount("left", (-0.3, -0.1, 0.4), (2e5, 1e5, 1e5), tilt_deg=50, damping=200.0),
)
LOAD = cp.PeriodicLoad("pump", on="both", force={2: 8.0}, torque={0: 3.0})
POWERTRAIN = cp.Powertrain(ENGINE, cp.RigidBody(150, (0, 0.06, 0.1), (7, 8, 4.5)), MOUNTS)
VEHICLE = cp.VehicleAxes(flywheel="left", origin=(1.4, 0.2, 0.4))
THETA = np.arange(0.0, 720.0, 10.0)
SHAKER = cp.Actuator(
    "shaker", (0.1, 0.2, 0.1), (0, 1, 0), force=50, mass=2, stroke=0.002, resonance=4,
    damping_ratio=0.2,
)  # fmt: skip
WITH_ROD = cp.Cylinder.from_rod(
    cp.Rod(mass=0.6, inertia=0.0025, length=0.145, to_crankpin=0.05), 0.043, 0.4
)
ARRANGEMENTS = cp.search_arrangements(6)
PANEL = ([5.0, 200.0], [[[1e-6 - 1e-7j]], [[1e-8 - 1e-9j]]])
MAP = cp.CycleMap([1000, 3000], [0, 1], [[CYCLE, CYCLE]] * 2)
CURVE = ([0.0, 180.0, 360.0], [1.0, 3.0, 1.0])
FOLDER = Path(tempfile.mkdtemp(prefix="crankpin-"))
"""Files that are read."""
atexit.register(shutil.rmtree, FOLDER, ignore_errors=True)


class Beside(NamedTuple):
    """A value that is sound beside others alone; ``...`` leaves an argument out."""

    value: Any
    others: dict[str, Any]


def files() -> list[str]:
    """Write the files that are read; return their paths."""
    paths = [str(FOLDER / name) for name in ("mounts.toml", "cycle.csv")]
    POWERTRAIN.save(paths[0])
    CYCLE.save(paths[1])
    times = "".join(
        f"{t / 12.0},{p}\n" for t, p in zip(THETA, CYCLE.pressure_at(THETA), strict=True)
    )
    (FOLDER / "time.csv").write_text(f"time [ms],pressure [Pa]\n{times}")
    if importlib.util.find_spec("openpyxl"):
        book = importlib.import_module("openpyxl").Workbook()
        book.active.title = "cycles"
        book.active.append(("angle [deg]", "absolute pressure [Pa]"))
        for row in zip(THETA.tolist(), CYCLE.pressure_at(THETA).tolist(), strict=True):
            book.active.append(row)
        book.save(FOLDER / "cycle.xlsx")
        sampled = scope.channels()
        book = importlib.import_module("openpyxl").Workbook()
        book.active.title = "scope"
        book.active.append(tuple(sampled))
        for row in zip(*(values.tolist() for values in sampled.values()), strict=True):
            book.active.append(row)
        book.save(FOLDER / "scope.xlsx")
    return paths


AUTO = {"orders": "auto"}
LOCOMOTIVE = cp.Locomotive(
    CYLINDER, z=[-0.1, 0.0, 0.1], throws_deg=[0, 120, 240], wheel_z=[-0.3, 0.3], share=0.5,
    wheel_diameter=1.7, wheel_load=70e3,
)  # fmt: skip
SINGLE = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1)
SIX = [0.5, 0.51, 0.49, 0.5, 0.505, 0.495, 0.5]

KINDS: dict[str, list[Any]] = {
    # Moving parts.
    "areas": [[52.0, -124.0, 92.0, -20.0]],
    "bore": [0.086],
    "crank_radius": [0.04, 1e-5],
    "length": [0.15],
    "mass": [0.6, Beside(2.0, {"stroke": 0.002})],
    "oil": [0.004],
    "pin_offset": [0.001, [0.0, 0.001]],
    "pin_offset_ratio": [0.01],
    "piston_mass": [0.4],
    "reciprocating_mass": [0.5, 0.01],
    "rod_inertia_excess": [1e-4],
    "rod_length": [0.15, 1e-5],
    "rod_ratio": [0.3, [0.2, 0.3]],
    "rotating_mass": [0.3],
    "stroke": [0.086, Beside(0.002, {"mass": 2.0})],
    "density": [7200.0],
    "energy": [500.0],
    "hoop_stress": [Beside(4e6, {"mean_diameter": ..., "rpm": 240.0})],
    "mean_diameter": [1.0],
    "rim_speed": [Beside(25.0, {"mean_diameter": ..., "rpm": 240.0})],
    "share": [0.95],
    "thickness": [0.03, Beside(0.03, {"stroke": 0.1, "duration_deg": ...})],
    "to_crankpin": [0.05],
    "torque_scale": [600.0],
    "width_ratio": [2.0],
    "parts": [{"piston": 0.4, "pin": 0.1}],
    # Places and angles.
    "absent": [[1]],
    "angle_scale_deg": [3.0],
    "angle_deg": [30.0, [30, 200]],
    "angles_deg": [[0, 120, 240]],
    "bank_angle_deg": [60, Beside(60, {"hold": "pins"}), [60, 90], Beside(60, {"layout": "vee"})],
    "bank_deg": [[60, 120], [60, 120] * 3],
    "bank_stagger": [0.01, Beside(0.01, {"bank_angle_deg": 60}), Beside(0.01, {"layout": "vee"})],
    "bearings": [[0.0, 0.4]],
    "correction_z": [[0.05, 0.35]],
    "crank": [0, Beside([0, 0, 0, 1, 1, 1], {"cranks": [(0.0, 0.0, 1), (0.2, 0.0, -1)]})],
    "cranks": [Beside([(0.0, 0.0, 1), (0.2, 0.0, -1)], {"crank": [0, 0, 0, 1, 1, 1]})],
    "diameter": [0.05],
    "distance": [0.5],
    "first_tdc_deg": [30],
    "intervals_deg": [[120] * 6],
    "lead_deg": [12.0],
    "mains": [[-0.05, 0.05, 0.15, 0.25]],
    "measured_z": [[0.0, 0.4]],
    "phase_deg": [5.0],
    "phases_deg": [[0, 120, 240]],
    "pin": [1],
    "pin_deg": [0.1, Beside([0, 0, 120, 120, 240, 240], {"tdc_deg": ...})],
    "pin_split_deg": [0.0, -60],
    "pins": [[[1], [2], [3], [4], [5], [6]], [[1, 2], [3, 4], [5, 6]]],
    "places": [{-1: (0.1, 0.0)}],
    "planes": ["ends", [0.0, 0.2]],
    "point": [(0.0, 0.1, 0.2)],
    "radius": [0.07],
    "reference_z": [0.1],
    "spacing": [
        *(0.1, Beside(0.1, {"rows": 2})),
        Beside(0.1, {"engines": ARRANGEMENTS[0], "cylinder": CYLINDER}),
    ],
    "tdc_deg": [[0.0], [0, 120, 240, 360, 480, 600], 1.0],
    "theta_deg": [THETA, 30.0],
    "throws_deg": [[0, 120, 240], [0, 240, 120]],
    "tilt_deg": [30.0],
    "tolerance_deg": [0.01],
    "upper": [CYLINDER],
    "width": [0.02],
    "window_deg": [(-120.0, -40.0), (-60.0, 100.0)],
    "x": [0.1, "rpm"],
    "y": [0.1],
    "Locomotive.z": [[-0.1, 0.0, 0.1]],
    "z": [0.1, ENGINE.reference_z, [0.0, 0.0, 0.1, 0.1, 0.2, 0.2], 1e-4, [0.0, 0.4]],
    # Locomotives.
    "axle_x": [[0.0, 1.9]],
    "coupling": [[cp.Unbalance(20, -0.9, 180, pin=1)]],
    "driving": [1],
    "hammer_blow": [1000.0],
    "inclination_deg": [5.0],
    "speed_kmh": [60.0],
    "vertical_deg": [90.0],
    "weights: Iterable[Iterable[Unbalance]] | None": [[[cp.Unbalance(20, -0.3, 180, pin=1)]]],
    "wheel_diameter": [1.7],
    "wheel_load": [70e3],
    "wheel_z": [[-0.3, 0.3]],
    # Orders, speeds, amplitudes.
    "amount": [0.01],
    "amount_g_mm": [[120, 80]],
    "amplitude": [0.01],
    "answers": [{"force": 100.0}],
    "mode_shape": [[1, 0.9, 0.7, 0.5, 0.3, 0.1]],
    "order": [1, 2],
    "orders": [[1, 2], 1],
    "ratio": [-1, (1.2, 1.6)],
    "ratios": [-1, (-1, 1)],
    "rpm": [1000.0, [1000.0, 2000.0]],
    "rtol": [1e-3, Beside(1e-3, AUTO)],
    "shaft_orders": [1],
    "spectrum": [{1: 1.0, 2: 0.3}],
    "tie_rtol": [1e-9],
    # Counts and places in lists.
    "count": [1],
    "cylinder": [CYLINDER, 1, Beside(CYLINDER, {"engines": ARRANGEMENTS[0], "spacing": 0.1})],
    "cylinders": [6, 3],
    "masses": [
        Beside(
            [0.5, None, 0.5],
            {"cylinders": 3, "layout": "inline", "throws_deg": ..., "by": "[1].force.peak"},
        )
    ],
    "positions": [
        Beside(
            [0.0, None, 0.2],
            {"cylinders": 3, "layout": "inline", "throws_deg": ..., "by": "[1].force.peak"},
        )
    ],
    "decimals": [3],
    "degree": [Beside(CYCLE.degree, {"theta_deg": CYCLE.theta_deg, "pressure": CYCLE.pressure})],
    "design": [0],
    "mode": [0, 1],
    "most_shafts": [1],
    "poles": [4],
    "rows": [1, 2],
    "sample": [1],
    "samples": [200],
    "seed": [1],
    "sets": [1],
    "starts": [1],
    "strokes": [4],
    "update_delay": [1],
    "updates": [3],
    # Pressure and gas.
    "a": [6.0],
    "charge_temperature": [320.0],
    "chunks": [{"rpm": 1}],
    "compression_ratio": [10.0],
    "compression_exponent": [1.3],
    "clearance": [0.1],
    "crank_end": [
        CYCLE,
        *(
            Beside(MAP, {of: DOUBLE_ACTING, "cycle": MAP, "load": 1.0})
            for of in ("engine", "engines")
        ),
    ],
    "crankcase": [9e4, Beside(9e4, {"cycle": MAP, "load": 1.0})],
    "cutoff_ratio": [1.5],
    "crosshead_mass": [20.0],
    "discharge": [4e5],
    "cycle": [CYCLE, Beside(MAP, {"load": 1.0})],
    "cycles": [0, [[CYCLE, CYCLE], [CYCLE, CYCLE]]],
    "duration_deg": [40.0],
    "excess_air": [Beside(1.0, {"heat": ...})],
    "exhaust_closes_deg": [12],
    "exhaust_opens_deg": [60],
    "exhaust_pressure": [1.1e5],
    "expansion_exponent": [1.3],
    "exponent": [1.3],
    "gamma": [1.3],
    "heat": [1200.0],
    "heating_value": [Beside(43e6, {"heat": ..., "excess_air": 1.0})],
    "intake_closes_deg": [-130.0, 40.0],
    "intake_opens_deg": [12],
    "intake_pressure": [1e5],
    "load": [1.0, [0.0, 1.0], "main"],
    "load_torque": [CURVE],
    "cancel.receivers": [[(0.1, 0.0, 0.1)]],
    "designs.points": [[(0.1, 0.0, 0.1)]],
    "loss_angle_deg": [0.5],
    "lowpass_order": [10.0],
    "m": [2.0],
    "motored": [CYCLE],
    "pressure": [np.full(len(THETA), 1e5), np.full((2, len(THETA)), 1e5)],
    "pressure_ratio": [3.0],
    "start_deg": [-10.0],
    "stoichiometric_ratio": [Beside(14.6, {"heat": ..., "excess_air": 1.0})],
    "timing": [cp.ValveTiming(), cp.PortTiming()],
    "transfer_opens_deg": [60],
    "wall_temperature": [Beside(450.0, {"rpm": 2000.0})],
    "drive": [ENGINE, CURVE],
    "inertia": [(7.0, 8.0, 4.5), 0.2],
    "irregularity": [0.01],
    "period_deg": [Beside(360.0, {"drive": CURVE}), 720.0],
    # Both ends of cylinders.
    "double_acting": [True],
    "end": ["crank"],
    "expansion_n": [1.2],
    "n": [1.3],
    "one_crankshaft": [Beside(True, {"upper": CYLINDER})],
    "rod_diameter": [
        Beside(0.02, {"crank_end": CYCLE}),
        Beside(0.02, {"cycle": CYCLE, "double_acting": True}),
    ],
    "suction": [1e5],
    # Files of cycles.
    "angle_unit": ["deg", Beside("deg", {"path": "cycle.csv"})],
    "atmosphere": [1e5],
    "columns": [[0, 1]],
    "sheet": [
        Beside("cycles", {"path": str(FOLDER / "cycle.xlsx"), "columns": [0, 1]}),
        Beside("scope", {"source": str(FOLDER / "scope.xlsx")}),
    ],
    "gauge": [False],
    "pressure_unit": ["Pa"],
    "recorded_rpm": [Beside(2000.0, {"path": str(FOLDER / "time.csv")})],
    # Oscillograms.
    "oscillogram.pressure": ["p abs [Pa]"],
    "encoder": ["wheel"],
    "pulses": ["12-1"],
    "index": ["mark"],
    "oscillogram.source": [scope.channels()],
    "time": ["time [s]", Beside("time [s]", {"sampling_rate": ...})],
    "sampling_rate": [Beside(9000.0, {"time": ...})],
    # Mounts.
    "actuator": [SHAKER],
    "actuators": [SHAKER],
    "at": [(0.1, 0.0, 0.1), [(0.1, 0.0, 0.1)]],
    "axes": [np.eye(3), "crank"],
    "bounds": [{"stiffness": (5e4, 4e5)}],
    "cg": [(0.0, 0.06, 0.1), 1e-3],
    "coordinates": [[("left", "y")]],
    "damping": [100.0],
    "damping_ratio": [0.2],
    "delay": [1e-3],
    "direction": [(0, 1, 0)],
    "dynamic_stiffness": [2e5],
    "effort": [0.1],
    "force": [50.0],
    "frequency": [20.0],
    "gain": [10.0],
    "gear_ratio": [3.0],
    "gravity": [(0.0, -1.0, 0.0)],
    "loss_factor": [0.1],
    "modes_between": [(5.0, 30.0)],
    "mount": ["left"],
    "mounts": [MOUNTS],
    "phase_error_deg": [5.0],
    "receivers": [{"rail": np.full((2, 3, 1), 1e-8j)}],
    "resonance": [Beside(4.0, {"mass": 2.0, "stroke": 0.002})],
    "roll_frequency": [10.0],
    "step": [0.05],
    "stiffness": [1e5, 0.1],
    "table": [([5.0, 200.0], np.full((2, 3), 1e5 + 1e4j)), PANEL],
    "thrust": [(0.0, 0.0, 100.0)],
    "thrust_at": [(0.0, 0.0, 0.1)],
    "torque: float | Literal['engine']": [100.0],
    "vary": [{"left": {"stiffness": [1e5, 2e5]}}, "stiffness"],
    "watch": [[(0.0, 0.3, 0.0)]],
    "engines": [ENGINE, {"engine": ENGINE}],
    "receiver": ["head", "body"],
    "rod": [
        WITH_ROD.rod,
        Beside(
            WITH_ROD.rod,
            {
                name: getattr(WITH_ROD, name)
                for name in ("rod_length", "reciprocating_mass", "piston_mass", "crank_radius")
            }
            | {"rod_inertia_excess": WITH_ROD.rod_inertia_excess},
        ),
    ],
    "support": [cp.Subframe(cp.RigidBody(300, (0, -0.3, 0.1), (30, 35, 15)), MOUNTS)],
    # Words, objectives, files.
    "by": ["total.moment.peak", "second_order", "balance", "decoupling"],
    "controls": ["rpm"],
    "factor": [0.5],
    "factors": [[0.4, 0.5]],
    "balanced_to": [0.5],
    "bound": [0.01],
    "target": ["external", 1e5],
    "firing_order": ["1-2-3-4-5-6", "1-2-3", "1-3-5-7-2-4-6", "1-6-3-2-5-4", "1-3-2-4-6-5"],
    "frame": ["table"],
    "groups": [[[1, 3, 5], [2, 4, 6]]],
    "high": [90],
    "label": ["label"],
    "low": [10],
    "name": ["a name", "v6-60", "reciprocating_mass"],
    "note": ["note"],
    "loads": ["loads", [LOAD]],
    "forces": [cp.ForceTable(900, {1: (0, 50, 0, 3j, 0, 0)})],
    "speed_squared": [{1: (0, 50, 0, 3j, 0, 0)}],
    "independent": [{2: (0, 0, 0, 0, 0, 4j)}],
    "lag": [True],
    "shear_modulus": [6e7],
    "poisson": [0.3],
    "embedment": [0.5],
    "top": [(0.0, -0.5, 0.0)],
    "bodies": [POWERTRAIN.body],
    "height": [0.3],
    "ForceTable.about": [(0.0, 0.0, 0.1)],
    "motion": [{5.0: (0, 1e-4, 0), 10.0: (0, 1e-4, 0, 0, 0, 1e-4j)}],
    "of": ["acceleration"],
    "BaseMotion.by": ["frequency"],
    "BaseMotion.about": [(0.0, 0.0, 0.1)],
    "after: Powertrain": [POWERTRAIN],
    "base": [cp.BaseMotion({2: (0, 1e-4, 0)}, by="order")],
    "rotational_stiffness": [1e4],
    "rotational_loss_factor": [0.1],
    "rotational_damping": [10.0],
    "gap": [0.01, [0.01, (0.0, 0.02), 0.01]],
    "snubber_stiffness": [1e6],
    "rest": [{}, {"torque": 100.0}],
    "cases": [{"idle": {}, "drive": {"torque": 100.0, "acceleration": (0, 0, 3)}}],
    "case": ["drive"],
    "acceleration": [(0.0, 0.0, 8.0)],
    "vehicle": [VEHICLE],
    "directions": ["back, right, up"],
    "flywheel": ["left"],
    "VehicleAxes.origin": [(1.4, 0.2, 0.4)],
    "incline_deg": [12.0],
    "to.of": [(1.0, 0.2, 0.3)],
    "from.of": [(1.0, 0.2, 0.3)],
    "PeriodicLoad.on": ["both"],
    "PeriodicLoad.force": [{2: 8.0}],
    "PeriodicLoad.torque": [{0: 3.0}],
    "PeriodicLoad.scaling": ["independent"],
    "PeriodicLoad.rpm": [None],
    "PeriodicLoad.direction_deg": [30.0],
    "PeriodicLoad.phase_deg": [30.0],
    "PeriodicLoad.cylinder": [None],
    "from.on": ["both"],
    "from.force": [[1.0, 0.0, -1.0, 0.0]],
    "from.torque": [[1.0, 0.0, -1.0, 0.0]],
    "from.rpm": [None],
    "part.name": ["gas", "inertia", "pump"],
    "origin": ["origin"],
    "part": ["crankcase"],
    "path": ["written.toml", "engine.toml", "written.csv", "written.html", "written.tex"],
    "load.path": list(files()),
    "h.firing_order": ["1-4-5-2-3-6-7-10-11-8-9-12"],
    "square.firing_order": ["1-2-4-3"],
    "on.firing_order": ["1-2"],
    "on.engines": [[SINGLE, SINGLE]],
    "on.cranks": [[(0.2, 0.0, -1)]],
    "on.phase_deg": [[30]],
    "on.tilt_deg": [[10]],
    "on.z": [[0.1]],
    "q": [0.5],
    "tidy.columns": ["pressure", "y"],
    "sel.order": [1, 2],
    "sel.frequency": [5.0],
    "plot.numbers": [[1]],
    "plot.frame": ["table"],
    "plot.quantity": ["moment", "main", "velocity"],
    "objectives": ["total.moment.peak"],
    "quantities": ["force", "residual", "frequency", "sag", "torque_roll", "sums"],
    "quantity": [
        *("moment", "main", "velocity", "body_force", "crank_torque"),
        *("vertical_force", "h_moment", "hammer_blow", "rod_load"),
        *("residual", "frequency", "sag", "torque_roll", "sums", "force"),
    ],
    "row_units": [["", ""]],
    "header": [["a", "b"]],
    "labels": [["a", "b"]],
    "rows: NDArray[np.float64] | None": [np.ones((2, 1))],
    "title": ["title"],
    "sides": [("right", "left")],
    "source": ["source"],
    "text": [TOML, JSON, "mm"],
    "topic": ["v-twin"],
    "units_shown": ["mm"],
    "units": ["g, mm, lbf"],
    "values": [[1.0, 2.0]],
    "what": ["peak", "values"],
    "pistons": [SIX],
    "rods": [[[mass, mass] for mass in SIX], [None] * 6, cp.LinkRods(0.02, 0.12)],
    "equal": ["stroke"],
    "master": [1, Beside("right", {"rods": cp.LinkRods(0.02, 0.12)})],
    "big_end_mass": [0.3],
    "master_ratio": [0.26],
    "knuckle_ratio": [0.8],
    "bore_deg": [72.0],
    "knuckle_deg": [72.0],
    "shafts: Iterable[float | str | Fraction]": [[-1]],
    "after": [ENGINE, "lumped"],
    "first_deg": [[0, 120, 240]],
    "second_deg": [[0, 240, 120]],
    "out": [None],
    "ax": [None],
    "figure": [None],
    "progress": [False],
}

KEYWORDS: dict[str, dict[str, Any]] = {
    "selection": {"rpm": 1000.0},
    "coordinates": {"order": 2},
    "answers": {"bob_weight": 1.0, "force": 100.0},
}
SEEDS: list[Any] = [
    *(LOAD, ENGINE.with_loads([LOAD]).balance(1000.0).force),
    LOCOMOTIVE,
    *(ENGINE, ENGINE.with_cycle(None), CYLINDER, CYCLE, MAP, POWERTRAIN, *MOUNTS, SHAKER),
    POWERTRAIN.response(base=cp.BaseMotion({5.0: (0, 1e-4, 0), 9.0: (0, 1e-4, 0)})),
    POWERTRAIN.response(
        [1000.0, 2000.0], orders=[2], base=cp.BaseMotion({2: (0, 1e-4, 0)}, by="order")
    ),
    cp.sweep(ENGINE, rpm=[1000.0, 2000.0], orders=[1, 2]),
    *(ENGINE.firing(), two_stroke(), ENGINE.closed_form(1)),
    cp.design(
        4,
        layout="vee",
        bank_angle_deg=90,
        cylinder=CYLINDER,
        spacing=0.1,
        rpm=1000.0,
        by="total.moment.peak",
        count=1,
    ),
]
"""Instances to begin with; of a class that has several, the first that a call takes."""
FEW: dict[str, Any] = {"samples": 200, "starts": 1, "count": 1}
"""Arguments that keep calls short, where they are optional."""
