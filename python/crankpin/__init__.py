"""How a reciprocating engine shakes, and which engine does not.

From one cylinder's moving parts and the places of the cylinders on the crankshaft: shaking forces,
rocking moments and torque per engine order and as waveforms, swept over bank angle, firing order,
rod ratio, pin offset and speed.

SI units; angles in degrees in arguments whose names end in ``_deg``, speeds in rpm. Seen from the
flywheel x points right, y up, z from the front to the flywheel, and the crank turns
counter-clockwise.
"""

from crankpin._balance import Balance, Ellipse, ErrorBound, OrderBalance
from crankpin._core import InputError, __version__
from crankpin._cylinder import Cylinder, slider_crank_harmonics
from crankpin._engine import Engine
from crankpin._exact import ClosedForm, VanishingOrders
from crankpin._firing import (
    Firing,
    Gap,
    Overlap,
    Ports,
    PortTiming,
    Throws,
    Valves,
    ValveTiming,
    throws,
)
from crankpin._presets import presets
from crankpin._rank import Choice, Ranking, rank
from crankpin._search import Arrangement, ArrangementSearch, search_arrangements
from crankpin._sweep import Sweep, sweep
from crankpin._sweep_waveform import SweepWaveform
from crankpin._waveform import Waveform

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
