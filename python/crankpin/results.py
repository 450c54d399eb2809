"""Classes of results, for annotations and ``isinstance``; functions and engines make them."""

from typing import TYPE_CHECKING

from crankpin._support import lazy

if TYPE_CHECKING:
    from crankpin._support.tables import Table
    from crankpin.analysis.arrangements.search import Arrangement, ArrangementSearch
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.balancing.balancers import BalancerOption, BalancerOptions
    from crankpin.analysis.balancing.bob_weight import BobWeight
    from crankpin.analysis.balancing.card import Card
    from crankpin.analysis.balancing.counterweights import Counterweights
    from crankpin.analysis.balancing.fitted_shafts import BalanceShafts
    from crankpin.analysis.balancing.two_plane import TwoPlaneCorrection
    from crankpin.analysis.bearings import BearingLoads
    from crankpin.analysis.by_order import OrderBalance
    from crankpin.analysis.closed_form import ClosedForm
    from crankpin.analysis.comparison import Comparison
    from crankpin.analysis.design.designs import Design, Designs
    from crankpin.analysis.exercises import Exercise
    from crankpin.analysis.explain import Explanation
    from crankpin.analysis.firing import Firing
    from crankpin.analysis.flywheel import Flywheel
    from crankpin.analysis.mounts.active import Cancellation, DrivenResponse
    from crankpin.analysis.mounts.adaptive import AdaptiveLaw
    from crankpin.analysis.mounts.design_mounts import MountDesign
    from crankpin.analysis.mounts.design_responses import DesignResponses
    from crankpin.analysis.mounts.feedback import VelocityFeedback
    from crankpin.analysis.mounts.modes import MountModes, RollAxes
    from crankpin.analysis.mounts.response import (
        MountResponse,
        OrderResponse,
        PointMotion,
        WorstForce,
    )
    from crankpin.analysis.mounts.robustness import MountRobustness
    from crankpin.analysis.mounts.static_state import StaticState
    from crankpin.analysis.operating_map import OperatingMap
    from crankpin.analysis.prepared_trace import PreparedTrace
    from crankpin.analysis.quantity import Quantity
    from crankpin.analysis.ranking.ranking import Choice, Ranking
    from crankpin.analysis.star import StarDiagram
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.analysis.sweeps.waveform import SweepWaveform
    from crankpin.analysis.tolerances.match_parts import Match
    from crankpin.analysis.tolerances.samples import Tolerances
    from crankpin.analysis.torsional_excitation import TorsionalExcitation
    from crankpin.analysis.vanishing import VanishingOrders, Verdicts
    from crankpin.analysis.waveform import Waveform

__all__ = [
    "AdaptiveLaw",
    "Arrangement",
    "ArrangementSearch",
    "Balance",
    "BalanceShafts",
    "BalancerOption",
    "BalancerOptions",
    "BearingLoads",
    "BobWeight",
    "Cancellation",
    "Card",
    "Choice",
    "ClosedForm",
    "Comparison",
    "Counterweights",
    "Design",
    "DesignResponses",
    "Designs",
    "DrivenResponse",
    "Exercise",
    "Explanation",
    "Firing",
    "Flywheel",
    "Match",
    "MountDesign",
    "MountModes",
    "MountResponse",
    "MountRobustness",
    "OperatingMap",
    "OrderBalance",
    "OrderResponse",
    "PointMotion",
    "PreparedTrace",
    "Quantity",
    "Ranking",
    "RollAxes",
    "StarDiagram",
    "StaticState",
    "Sweep",
    "SweepWaveform",
    "Table",
    "Tolerances",
    "TorsionalExcitation",
    "TwoPlaneCorrection",
    "VanishingOrders",
    "VelocityFeedback",
    "Verdicts",
    "Waveform",
    "WorstForce",
]

_HOMES = {
    "crankpin._support.tables": ("Table",),
    "crankpin.analysis.arrangements.search": ("Arrangement", "ArrangementSearch"),
    "crankpin.analysis.balance": ("Balance",),
    "crankpin.analysis.balancing.balancers": ("BalancerOption", "BalancerOptions"),
    "crankpin.analysis.balancing.bob_weight": ("BobWeight",),
    "crankpin.analysis.balancing.card": ("Card",),
    "crankpin.analysis.balancing.counterweights": ("Counterweights",),
    "crankpin.analysis.balancing.fitted_shafts": ("BalanceShafts",),
    "crankpin.analysis.balancing.two_plane": ("TwoPlaneCorrection",),
    "crankpin.analysis.bearings": ("BearingLoads",),
    "crankpin.analysis.closed_form": ("ClosedForm",),
    "crankpin.analysis.comparison": ("Comparison",),
    "crankpin.analysis.design.designs": ("Design", "Designs"),
    "crankpin.analysis.exercises": ("Exercise",),
    "crankpin.analysis.explain": ("Explanation",),
    "crankpin.analysis.firing": ("Firing",),
    "crankpin.analysis.flywheel": ("Flywheel",),
    "crankpin.analysis.mounts.active": ("Cancellation", "DrivenResponse"),
    "crankpin.analysis.mounts.adaptive": ("AdaptiveLaw",),
    "crankpin.analysis.mounts.design_mounts": ("MountDesign",),
    "crankpin.analysis.mounts.design_responses": ("DesignResponses",),
    "crankpin.analysis.mounts.feedback": ("VelocityFeedback",),
    "crankpin.analysis.mounts.modes": ("MountModes", "RollAxes"),
    "crankpin.analysis.mounts.response": (
        "MountResponse",
        "OrderResponse",
        "PointMotion",
        "WorstForce",
    ),
    "crankpin.analysis.mounts.robustness": ("MountRobustness",),
    "crankpin.analysis.mounts.static_state": ("StaticState",),
    "crankpin.analysis.operating_map": ("OperatingMap",),
    "crankpin.analysis.prepared_trace": ("PreparedTrace",),
    "crankpin.analysis.by_order": ("OrderBalance",),
    "crankpin.analysis.quantity": ("Quantity",),
    "crankpin.analysis.ranking.ranking": ("Choice", "Ranking"),
    "crankpin.analysis.star": ("StarDiagram",),
    "crankpin.analysis.sweeps.sweep": ("Sweep",),
    "crankpin.analysis.sweeps.waveform": ("SweepWaveform",),
    "crankpin.analysis.tolerances.match_parts": ("Match",),
    "crankpin.analysis.tolerances.samples": ("Tolerances",),
    "crankpin.analysis.torsional_excitation": ("TorsionalExcitation",),
    "crankpin.analysis.vanishing": ("VanishingOrders", "Verdicts"),
    "crankpin.analysis.waveform": ("Waveform",),
}
"""Module → the public names that it has; it is imported once one of them is read."""

if not TYPE_CHECKING:  # where every name would be one of the module's
    __getattr__ = lazy.attributes(__name__, _HOMES)


def __dir__() -> list[str]:
    """Return the public names, so that completion offers no modules."""
    return __all__
