"""How a reciprocating engine shakes, and which engine does not.

From one cylinder's moving parts and the places of the cylinders on the crankshaft: shaking forces,
rocking moments and torque per engine order and as waveforms, swept over bank angle, firing order,
rod ratio, pin offset and speed.

SI units; angles in degrees in arguments whose names end in ``_deg``, speeds in rpm. Seen from the
flywheel x points right, y up, z from the front to the flywheel, and the crank turns
counter-clockwise.
"""

from crankpin._core import InputError, __version__
from crankpin.analysis.balance import Balance, Ellipse, ErrorBound, OrderBalance
from crankpin.analysis.exact import ClosedForm, VanishingOrders
from crankpin.analysis.firing import Firing, Gap
from crankpin.analysis.gas_exchange import Overlap, Ports, PortTiming, Valves, ValveTiming
from crankpin.analysis.rank import Choice, Ranking, rank
from crankpin.analysis.search import Arrangement, ArrangementSearch, search_arrangements
from crankpin.analysis.sweep import Sweep, sweep
from crankpin.analysis.sweep_waveform import SweepWaveform
from crankpin.analysis.throws import Throws, throws
from crankpin.analysis.waveform import Waveform
from crankpin.model.cylinder import Cylinder, Rod, slider_crank_harmonics
from crankpin.model.engine import Engine
from crankpin.model.presets import presets

__all__ = [
    "Arrangement",
    "ArrangementSearch",
    "Balance",
    "Choice",
    "ClosedForm",
    "Cylinder",
    "Ellipse",
    "Engine",
    "ErrorBound",
    "Firing",
    "Gap",
    "InputError",
    "OrderBalance",
    "Overlap",
    "PortTiming",
    "Ports",
    "Ranking",
    "Rod",
    "Sweep",
    "SweepWaveform",
    "Throws",
    "ValveTiming",
    "Valves",
    "VanishingOrders",
    "Waveform",
    "__version__",
    "presets",
    "rank",
    "search_arrangements",
    "slider_crank_harmonics",
    "sweep",
    "throws",
]
