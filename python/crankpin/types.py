"""Classes of results, for annotations and ``isinstance``; functions and engines make them."""

from crankpin.analysis.balance import Balance
from crankpin.analysis.by_order import OrderBalance, Total, TotalQuantity, TotalVector
from crankpin.analysis.choices import Choice
from crankpin.analysis.closed_form import ClosedForm
from crankpin.analysis.firing import Firing, Gap
from crankpin.analysis.gas_exchange import Overlap, Ports, PortTiming, Valves, ValveTiming
from crankpin.analysis.match_parts import Match
from crankpin.analysis.quantities import Ellipse, PlaneVector, Quantity, Scalar
from crankpin.analysis.ranking import Ranking
from crankpin.analysis.search import Arrangement, ArrangementSearch
from crankpin.analysis.shares import Shares
from crankpin.analysis.source import ErrorBound
from crankpin.analysis.sweep import Sweep
from crankpin.analysis.sweep_waveform import SweepWaveform
from crankpin.analysis.throws import Throws
from crankpin.analysis.tolerance_samples import Tolerances
from crankpin.analysis.vanishing import (
    OrderVerdicts,
    VanishingOrders,
    VectorVerdict,
    VectorVerdicts,
    Verdicts,
)
from crankpin.analysis.waveform import Waveform

__all__ = [
    "Arrangement",
    "ArrangementSearch",
    "Balance",
    "Choice",
    "ClosedForm",
    "Ellipse",
    "ErrorBound",
    "Firing",
    "Gap",
    "Match",
    "OrderBalance",
    "OrderVerdicts",
    "Overlap",
    "PlaneVector",
    "PortTiming",
    "Ports",
    "Quantity",
    "Ranking",
    "Scalar",
    "Shares",
    "Sweep",
    "SweepWaveform",
    "Throws",
    "Tolerances",
    "Total",
    "TotalQuantity",
    "TotalVector",
    "ValveTiming",
    "Valves",
    "VanishingOrders",
    "VectorVerdict",
    "VectorVerdicts",
    "Verdicts",
    "Waveform",
]
