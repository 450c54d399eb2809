"""Shaking forces, rocking moments and torques of piston engines.

From the moving parts of one cylinder and the positions of the cylinders on the crankshaft: force,
moment and torque per engine order and over crank angle, swept over bank angle, firing order, rod
ratio, pin offset and speed.

SI units; angles in degrees in arguments whose names end in ``_deg``, speeds in rpm. Seen from the
flywheel x points right, y up, z from the front to the flywheel, and the crank turns
counter-clockwise. Classes of results are in :mod:`crankpin.types`.
"""

import crankpin._support.interrupted  # noqa: F401 - before the imports that take time
from crankpin import types
from crankpin._core import InputError, __version__
from crankpin._support import drawing
from crankpin._support.units import units
from crankpin.analysis.arrangements.search import search_arrangements
from crankpin.analysis.balancing.balance_shafts import balance_shafts
from crankpin.analysis.balancing.balancer_options import balancer_options
from crankpin.analysis.balancing.bob_weight import bob_weight
from crankpin.analysis.balancing.counterweights import counterweights
from crankpin.analysis.balancing.two_plane import two_plane_correction
from crankpin.analysis.bearings import bearing_loads
from crankpin.analysis.comparison import compare
from crankpin.analysis.design.design import design
from crankpin.analysis.exercises import exercise
from crankpin.analysis.firing import throws
from crankpin.analysis.flywheel import flywheel
from crankpin.analysis.gas_exchange import PortTiming, ValveTiming
from crankpin.analysis.mounts.design_mounts import design_mounts
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.analysis.operating_map import operating_map
from crankpin.analysis.prepared_trace import prepare_trace
from crankpin.analysis.ranking.rank import rank
from crankpin.analysis.star import star_diagram
from crankpin.analysis.sweeps.sweep import sweep
from crankpin.analysis.tolerances.match_parts import match_parts
from crankpin.analysis.tolerances.tolerances import tolerances
from crankpin.analysis.torsional_excitation import torsional_excitation
from crankpin.model.actuators import Actuator
from crankpin.model.cycle import Cycle
from crankpin.model.cycle_map import CycleMap
from crankpin.model.cylinder import Cylinder, Rod, slider_crank_harmonics
from crankpin.model.engine import Engine
from crankpin.model.loads import PeriodicLoad
from crankpin.model.gas_torque import gas_torque_harmonics
from crankpin.model.mounts import InertiaTrack, Mount, RigidBody
from crankpin.model.presets import presets
from crankpin.model.shafts import Shaft, Unbalance
from crankpin.model.supports import Receptance, Subframe
from crankpin.model.traces import Traces

__all__ = [
    "Actuator",
    "Cycle",
    "CycleMap",
    "Cylinder",
    "Engine",
    "InertiaTrack",
    "InputError",
    "Mount",
    "PeriodicLoad",
    "PortTiming",
    "Powertrain",
    "Receptance",
    "RigidBody",
    "Rod",
    "Shaft",
    "Subframe",
    "Traces",
    "Unbalance",
    "ValveTiming",
    "__version__",
    "balance_shafts",
    "balancer_options",
    "bearing_loads",
    "bob_weight",
    "compare",
    "counterweights",
    "design",
    "design_mounts",
    "exercise",
    "flywheel",
    "gas_torque_harmonics",
    "match_parts",
    "operating_map",
    "prepare_trace",
    "presets",
    "rank",
    "search_arrangements",
    "slider_crank_harmonics",
    "star_diagram",
    "sweep",
    "throws",
    "tolerances",
    "torsional_excitation",
    "two_plane_correction",
    "types",
    "units",
]


def _import_pictures() -> None:
    import crankpin.plot  # noqa: F401, PLC0415 - matplotlib is imported when used


drawing.importers.append(_import_pictures)


def __dir__() -> list[str]:
    """Return the public names, so that completion offers no modules."""
    return __all__
