"""Shaking forces, rocking moments and torques of piston engines.

From the moving parts of one cylinder and the positions of the cylinders on the crankshaft: force,
moment and torque per engine order and over crank angle, swept over bank angle, firing order, rod
ratio, pin offset and speed.

SI units; angles in degrees in arguments whose names end in ``_deg``, speeds in rpm. Seen from the
flywheel x points right, y up, z from the front to the flywheel, and the crank turns
counter-clockwise. Classes of results are in :mod:`crankpin.results`.
"""

import crankpin._support.interrupted  # noqa: F401 - Ctrl-C, before anything takes time

# isort: split
from typing import TYPE_CHECKING

from crankpin._support import lazy

if TYPE_CHECKING:
    from crankpin import results
    from crankpin._core import InputError, __version__
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
    from crankpin.model.gas_torque import gas_torque_harmonics
    from crankpin.model.loads import PeriodicLoad
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
    "results",
    "search_arrangements",
    "slider_crank_harmonics",
    "star_diagram",
    "sweep",
    "throws",
    "tolerances",
    "torsional_excitation",
    "two_plane_correction",
    "units",
]

_HOMES = {
    "crankpin._core": ("InputError", "__version__"),
    "crankpin._support.units": ("units",),
    "crankpin.analysis.arrangements.search": ("search_arrangements",),
    "crankpin.analysis.balancing.balance_shafts": ("balance_shafts",),
    "crankpin.analysis.balancing.balancer_options": ("balancer_options",),
    "crankpin.analysis.balancing.bob_weight": ("bob_weight",),
    "crankpin.analysis.balancing.counterweights": ("counterweights",),
    "crankpin.analysis.balancing.two_plane": ("two_plane_correction",),
    "crankpin.analysis.bearings": ("bearing_loads",),
    "crankpin.analysis.comparison": ("compare",),
    "crankpin.analysis.design.design": ("design",),
    "crankpin.analysis.exercises": ("exercise",),
    "crankpin.analysis.firing": ("throws",),
    "crankpin.analysis.flywheel": ("flywheel",),
    "crankpin.analysis.gas_exchange": ("PortTiming", "ValveTiming"),
    "crankpin.analysis.mounts.design_mounts": ("design_mounts",),
    "crankpin.analysis.mounts.powertrain": ("Powertrain",),
    "crankpin.analysis.operating_map": ("operating_map",),
    "crankpin.analysis.prepared_trace": ("prepare_trace",),
    "crankpin.analysis.ranking.rank": ("rank",),
    "crankpin.analysis.star": ("star_diagram",),
    "crankpin.analysis.sweeps.sweep": ("sweep",),
    "crankpin.analysis.tolerances.match_parts": ("match_parts",),
    "crankpin.analysis.tolerances.tolerances": ("tolerances",),
    "crankpin.analysis.torsional_excitation": ("torsional_excitation",),
    "crankpin.model.actuators": ("Actuator",),
    "crankpin.model.cycle": ("Cycle",),
    "crankpin.model.cycle_map": ("CycleMap",),
    "crankpin.model.cylinder": ("Cylinder", "Rod", "slider_crank_harmonics"),
    "crankpin.model.engine": ("Engine",),
    "crankpin.model.gas_torque": ("gas_torque_harmonics",),
    "crankpin.model.loads": ("PeriodicLoad",),
    "crankpin.model.mounts": ("InertiaTrack", "Mount", "RigidBody"),
    "crankpin.model.presets": ("presets",),
    "crankpin.model.shafts": ("Shaft", "Unbalance"),
    "crankpin.model.supports": ("Receptance", "Subframe"),
    "crankpin.model.traces": ("Traces",),
    "crankpin.results": ("results",),
}
"""Module → the public names that it has; it is imported once one of them is read."""

if not TYPE_CHECKING:  # where every name would be one of the module's
    __getattr__ = lazy.attributes(__name__, _HOMES)


def __dir__() -> list[str]:
    """Return the public names, so that completion offers no modules."""
    return __all__
