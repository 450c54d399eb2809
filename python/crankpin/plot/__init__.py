"""Pictures of results: :func:`draw`, and one module for each kind of picture.

Pictures are drawn on given axes, or on a new pyplot figure, which notebooks show. This package is
imported when a picture is drawn, and matplotlib with it.
"""

from crankpin.plot import (
    balance,
    balancing,
    bearings,
    compare,
    counterweights,
    cycle,
    engine,
    firing,
    phasors,
    ranking,
    sweep,
    tolerances,
    waveform,
)
from crankpin.plot.dispatch import draw
from crankpin.plot.engine import inline_svg

__all__ = [
    "balance",
    "balancing",
    "bearings",
    "compare",
    "counterweights",
    "cycle",
    "draw",
    "engine",
    "firing",
    "inline_svg",
    "phasors",
    "ranking",
    "sweep",
    "tolerances",
    "waveform",
]
