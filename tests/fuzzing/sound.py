"""Engines, and calls that work: a test changes an argument of one."""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import math
from typing import Any

import crankpin as cp

NAN, INF = math.nan, math.inf
PARTS = ("crank_radius", "rod_length", "reciprocating_mass", "pin_offset", "rod_inertia_excess")
CURE = 12  # letters at least, after the last thing that is wrong
CYLINDER = cp.Cylinder(0.05, 0.15, 0.5)
V6 = cp.Engine.vee(CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.1)
I4 = cp.Engine.inline(CYLINDER, throws_deg=[0, 180, 180, 0], spacing=0.1, name="four")
CYCLE = cp.Cycle.example()
FIRED = cp.Engine.preset("i4", cylinder=CYLINDER.replace(bore=0.08)).with_cycle(CYCLE)


def cylinder(**changes: Any) -> cp.Cylinder:
    given_: dict[str, Any] = {"crank_radius": 0.05, "rod_length": 0.15, "reciprocating_mass": 0.5}
    return cp.Cylinder(**given_ | changes)


def lists(**changes: Any) -> cp.Engine:
    given_: dict[str, Any] = {
        "cylinder": CYLINDER,
        "tdc_deg": [0, 90],
        "bank_deg": [90, 90],
        "z": [0, 0.1],
    }
    return cp.Engine.from_lists(**given_ | changes)


def vee(**changes: Any) -> cp.Engine:
    given_: dict[str, Any] = {"bank_angle_deg": 60, "throws_deg": [0, 120], "spacing": 0.1}
    return cp.Engine.vee(CYLINDER, **given_ | changes)


def fires(**changes: Any) -> cp.results.Firing:
    return V6.firing(**{"firing_order": "1-2-5-6-3-4"} | changes)


def two_stroke() -> cp.results.Firing:
    return I4.firing("1+4-2+3", strokes=2)


def crank(**changes: Any) -> tuple[Any, ...]:
    given_: dict[str, Any] = {"firing_order": "1-2-3-4", "bank_angle_deg": 90}
    return cp.throws(**given_ | changes)


def firing(**changes: Any) -> cp.Engine:
    given_: dict[str, Any] = {"firing_order": "1-2-3-4", "bank_angle_deg": 90, "spacing": 0.1}
    return cp.Engine.from_firing_order(CYLINDER, **given_ | changes)


def inline(**changes: Any) -> cp.Engine:
    given_: dict[str, Any] = {"throws_deg": [0, 180], "spacing": 0.1}
    return cp.Engine.inline(CYLINDER, **given_ | changes)


def balance(**changes: Any) -> cp.results.Balance:
    given_: dict[str, Any] = {"rpm": 1000}
    return V6.balance(**given_ | changes)


def waveform(**changes: Any) -> cp.results.Waveform:
    given_: dict[str, Any] = {"rpm": 1000, "theta_deg": [0.0, 1.0]}
    return V6.waveform(**given_ | changes)


def swept(**changes: Any) -> cp.results.Sweep:
    given_: dict[str, Any] = {"rpm": 1000, "bank_angle_deg": [60, 90], "hold": "pins"}
    return cp.sweep(V6, **given_ | changes)


def ranked(**changes: Any) -> cp.results.Ranking:
    given_: dict[str, Any] = {"rpm": 1000, "bank_angle_deg": [60, 90], "hold": "pins"}
    given_ |= {"by": "total.moment.peak"}
    return cp.rank(V6, **given_ | changes)


def ranked_search(**changes: Any) -> cp.results.Ranking:
    given_: dict[str, Any] = {"cylinder": CYLINDER, "spacing": 0.1, "by": "total.moment.peak"}
    return cp.rank(cp.search_arrangements(6), rpm=1000, **given_ | changes)


def proportions(**changes: Any) -> cp.results.Sweep:
    return swept(bank_angle_deg=None, hold=None, **changes)


def closed_form(**changes: Any) -> cp.results.ClosedForm:
    given_: dict[str, Any] = {"order": 1}
    return V6.closed_form(**given_ | changes)


def harmonics(**changes: Any) -> Any:
    given_: dict[str, Any] = {"rod_ratio": 0.3, "orders": [1, 2]}
    return cp.slider_crank_harmonics(**given_ | changes)


TOML, JSON = I4.to_toml(), I4.to_json()
