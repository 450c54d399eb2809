"""Is a result of nothing a result: of engines without mass, far away, tiny or huge?"""

# ruff: noqa: ANN401 - lists and options of any kind

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from conftest import OFFSET
from matplotlib import pyplot as plt

if TYPE_CHECKING:
    from collections.abc import Callable

ONE = OFFSET.replace(pin_offset=0.0)
MASSLESS = ONE.replace(reciprocating_mass=0.0)
NAMES = ("force", "moment", "torque", "crank_torque")


def engine(cylinder: cp.Cylinder, tdc: Any, bore: Any, z: Any, **more: Any) -> cp.Engine:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # lengths that can only be in other units
        return cp.Engine.from_lists(cylinder, tdc_deg=tdc, bank_deg=bore, z=z, **more)


ENGINES = {
    "single": cp.Engine.preset("single"),
    "boxer": cp.Engine.preset("boxer-4"),
    "twelve": cp.Engine.preset("v12-60"),
    "massless": engine(MASSLESS, [0, 180], [90, 90], [0, 0.1]),
    "rotating only": engine(MASSLESS, [0, 180], [90, 90], [0, 0.1], rotating_mass=0.5),
    "radial in one plane": engine(ONE, [0, 120, 240], [90, 210, 330], [0, 0, 0]),
    "far away": engine(ONE, [0, 90], [90, 90], [1e5, 1e5 + 0.1]),
    "tiny": engine(cp.Cylinder(1e-6, 4e-6, 1e-12), [0, 90], [90, 90], [0, 1e-6]),
    "huge": engine(cp.Cylinder(10.0, 40.0, 1e6), [0, 90], [90, 90], [0, 30.0]),
    "same places": engine(ONE, [0, 180], [90, 90], [0, 0]),
}
OPTIONS: dict[str, dict[str, Any]] = {
    "": {},
    "without torque": {"torque": False},
    "given orders": {"orders": [1, 2, 7]},
    "a spectrum that cancels": {"spectrum": {1: 1.0}},
}

DRAWN = ("massless", "same places")
"""Engines whose pictures are drawn: those with nothing in them, which take seconds for all."""


def made(name: str, option: str) -> list[Any]:
    here, given = ENGINES[name], OPTIONS[option]
    b = here.balance(1.0, **given)
    quantities = [getattr(b, each) for each in NAMES if hasattr(b, each)]
    s = cp.sweep(here, rpm=[1.0, 2.0], **given)
    vector = [b, b[1], b[3], b.total, *quantities, *(each[2] for each in quantities)]
    swept = [s, s[1], s.total, s.moment, s.sel(rpm=2.0), cp.compare(here, here, 1.0, **given)]
    if "spectrum" not in given:
        swept += [here.waveform(1.0, torque="torque" not in given), s.waveform([0.0, 90.0])]
    return [*vector, *swept, here.vanishing_orders()]


SHOWN: dict[str, Callable[[Any], Any]] = {
    "repr": repr,
    "html": lambda result: result._repr_html_(),
    "to_pandas": lambda result: result.to_pandas(),
    "to_xarray": lambda result: result.to_xarray(),
    "plot": lambda result: (result.plot(), plt.close("all")),
    "csv": lambda result: result.table.csv(),
}


@pytest.mark.parametrize("option", OPTIONS)
@pytest.mark.parametrize("name", ENGINES)
def test_results_of_little_or_nothing_are_shown(name: str, option: str) -> None:
    for result in made(name, option):
        for how, show in SHOWN.items():
            needs = {"html": "_repr_html_", "csv": "table"}.get(how, how)
            if how == "plot" and name not in DRAWN:
                continue
            if how == "repr" or hasattr(result, needs):
                assert show(result) is not None or how == "html"


@pytest.mark.parametrize("name", ENGINES)
def test_no_zero_is_negative(name: str) -> None:
    """The peaks of an inline-4's moment were −0."""
    for given in OPTIONS.values():
        b = ENGINES[name].balance(60.0, **given)
        s = cp.sweep(ENGINES[name], rpm=[60.0], **given)
        for result in (b, s):
            for each in b.request.quantities:
                one, total = getattr(result, each), getattr(result.total, each)
                found = [one.peak, total.peak, one.zero_bound]
                found += [one.peak_xy, total.peak_xy] if hasattr(total, "peak_xy") else []
                assert not any(np.signbit(values).any() for values in found)
