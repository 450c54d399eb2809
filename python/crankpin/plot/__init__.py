"""Pictures of results: :func:`draw`, and one module for each kind of picture.

Pictures are drawn on given axes, or on a new pyplot figure, which notebooks show. This package is
imported when a picture is drawn, and matplotlib with it.
"""

from crankpin.plot import (
    balance,
    firing,
    ranking,
    search,
    sweep,
    sweep_waveform,
    tolerances,
    waveform,
)
from crankpin.plot.dispatch import draw

__all__ = [
    "balance",
    "draw",
    "firing",
    "ranking",
    "search",
    "sweep",
    "sweep_waveform",
    "tolerances",
    "waveform",
]
