"""Pictures of results: :func:`draw`, and one module for each kind of picture.

Pictures are drawn on given axes, or on a new pyplot figure, which notebooks show. This package is
imported when a picture is drawn, and matplotlib with it.
"""

from crankpin.plot import (
    balance,
    balance_shafts,
    balancers,
    bob_weight,
    compare,
    counterweights,
    designs,
    engine,
    firing,
    ranking,
    search,
    sweep,
    sweep_waveform,
    tolerances,
    waveform,
)
from crankpin.plot.dispatch import draw
from crankpin.plot.svg import inline_svg

__all__ = [
    "balance",
    "balance_shafts",
    "balancers",
    "bob_weight",
    "compare",
    "counterweights",
    "designs",
    "draw",
    "engine",
    "firing",
    "inline_svg",
    "ranking",
    "search",
    "sweep",
    "sweep_waveform",
    "tolerances",
    "waveform",
]
