"""Pictures of results: one module per kind, which registers its drawing function.

Pictures are drawn on given axes, or on a new pyplot figure, which notebooks show. This package is
imported when a picture is drawn, and matplotlib with it.
"""

from crankpin.plot import (  # noqa: F401 - they register their pictures
    active,
    balance,
    balancing,
    bearings,
    compare,
    counterweights,
    cycle,
    engine,
    firing,
    makers_tables,
    mount_designs,
    mounts,
    operating_map,
    phasors,
    ranking,
    rod_loads,
    sweep,
    table,
    tolerances,
    torsional_excitation,
    waveform,
)
