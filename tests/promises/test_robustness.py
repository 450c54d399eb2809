"""Does input that makes no engine give an error that helps, and no input anything worse?

The first part holds each argument to its promise: an ``InputError`` that names the argument, its
value and a cure. The second part calls every public function, method and constructor with hostile
values in place of one to three arguments: each call must return finite figures or raise TypeError,
ValueError (InputError is one), OSError or ImportError, within seconds. A panic of the compiled core
is none of these, nor is MemoryError.

By default that takes a few seconds, the same calls each time. With ``CRANKPIN_FUZZ_SECONDS=600`` in
the environment, ``pytest tests/promises/test_robustness.py -k fuzz_for_a_while`` goes on with other
calls, a seed after the other, for as long with each of engine files, builders, harmonics and
everything; ``-k "fuzz_for_a_while and builders"`` is one of them. A failure prints the call, which
fails by itself.
"""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import faulthandler
import inspect
import itertools
import json
import math
import os
import re
import reprlib
import subprocess
import sys
import time
import warnings
from fractions import Fraction
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

import crankpin as cp
import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, seed, settings
from hypothesis import strategies as st

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

os.environ.setdefault("MPLBACKEND", "Agg")

NAN, INF = math.nan, math.inf
CYLINDER = cp.Cylinder(0.05, 0.15, 0.5)
V6 = cp.Engine.vee(CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.1)
I4 = cp.Engine.inline(CYLINDER, throws_deg=[0, 180, 180, 0], spacing=0.1, name="four")


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


def fires(**changes: Any) -> cp.types.Firing:
    return V6.firing(**{"firing_order": "1-2-5-6-3-4"} | changes)


def two_stroke() -> cp.types.Firing:
    return I4.firing("1+4-2+3", strokes=2)


def crank(**changes: Any) -> cp.types.Throws:
    given_: dict[str, Any] = {"firing_order": "1-2-3-4", "bank_angle_deg": 90}
    return cp.throws(**given_ | changes)


def firing(**changes: Any) -> cp.Engine:
    given_: dict[str, Any] = {"firing_order": "1-2-3-4", "bank_angle_deg": 90, "spacing": 0.1}
    return cp.Engine.from_firing_order(CYLINDER, **given_ | changes)


def inline(**changes: Any) -> cp.Engine:
    given_: dict[str, Any] = {"throws_deg": [0, 180], "spacing": 0.1}
    return cp.Engine.inline(CYLINDER, **given_ | changes)


def balance(**changes: Any) -> cp.types.Balance:
    given_: dict[str, Any] = {"rpm": 1000}
    return V6.balance(**given_ | changes)


def waveform(**changes: Any) -> cp.types.Waveform:
    given_: dict[str, Any] = {"rpm": 1000, "theta_deg": [0.0, 1.0]}
    return V6.waveform(**given_ | changes)


def swept(**changes: Any) -> cp.types.Sweep:
    given_: dict[str, Any] = {"rpm": 1000, "bank_angle_deg": [60, 90], "hold": "pins"}
    return cp.sweep(V6, **given_ | changes)


def ranked(**changes: Any) -> cp.types.Ranking:
    given_: dict[str, Any] = {"rpm": 1000, "bank_angle_deg": [60, 90], "hold": "pins"}
    given_ |= {"by": "total.moment.peak"}
    return cp.rank(V6, **given_ | changes)


def ranked_search(**changes: Any) -> cp.types.Ranking:
    given_: dict[str, Any] = {"cylinder": CYLINDER, "spacing": 0.1, "by": "total.moment.peak"}
    return cp.rank(cp.search_arrangements(6), rpm=1000, **given_ | changes)


def proportions(**changes: Any) -> cp.types.Sweep:
    return swept(bank_angle_deg=None, hold=None, **changes)


def closed_form(**changes: Any) -> cp.types.ClosedForm:
    given_: dict[str, Any] = {"order": 1}
    return V6.closed_form(**given_ | changes)


def harmonics(**changes: Any) -> Any:
    given_: dict[str, Any] = {"rod_ratio": 0.3, "orders": [1, 2]}
    return cp.slider_crank_harmonics(**given_ | changes)


# --- errors that help ---------------------------------------------------------------------------

# For each: function, argument, its bad value, how the message writes that value.
NOT_NUMBERS = [(NAN, "NaN"), (-INF, "-inf"), (None, "None"), ("wide", "wide"), (1j, "1j")]
PARTS = ("crank_radius", "rod_length", "reciprocating_mass", "pin_offset", "rod_inertia_excess")
BAD: list[tuple[Callable[..., Any], str, Any, str]] = [
    *((cylinder, name, *bad) for name in PARTS for bad in NOT_NUMBERS),
    (cylinder, "crank_radius", 0.0, "0"),
    (cylinder, "crank_radius", -0.05, "-0.05"),
    (cylinder, "crank_radius", 5e-324, "5e-324"),
    (cylinder, "crank_radius", 0.15, "0.15"),  # r = l
    (cylinder, "crank_radius", 0.2, "0.2"),  # r > l
    (cylinder, "rod_length", -0.15, "-0.15"),
    (cylinder, "pin_offset", 0.1, "0.1"),  # r = l - e
    (cylinder, "pin_offset", -0.2, "-0.2"),
    (cylinder, "reciprocating_mass", -0.5, "-0.5"),
    (cylinder, "reciprocating_mass", 10**400, "1000000000…"),
    (lists, "z", [0.0], "has 1 entries"),
    (lists, "z", [0.0, NAN], "NaN"),
    (lists, "z", [0.0, INF], "inf"),
    (lists, "z", [[0.0, 0.1]], "has shape (1, 2)"),
    (lists, "z", [[0.0], [0.0, 0.1]], "[[0.0], [0.0, 0.1]]"),
    (lists, "z", np.array([0.0, 1j]), "array([0.+0.j, 0.+1.j])"),
    (lists, "z", "ab", "ab"),
    (lists, "z", None, "None"),
    (lists, "tdc_deg", [0.0], "has 1 entries"),
    (lists, "tdc_deg", [0.0, NAN], "NaN"),
    (lists, "tdc_deg", [0.0, "1/0"], "1/0"),
    (lists, "tdc_deg", [0.0, "north"], "north"),
    (lists, "tdc_deg", [0.0, None], "None"),
    (lists, "tdc_deg", [0.0, 10**400], "1000000000…"),
    (lists, "tdc_deg", 90, "90"),
    (lists, "tdc_deg", None, "neither given"),
    (lists, "pin_deg", [0, 0], "both given"),
    (lists, "bank_deg", [90.0, INF], "inf"),
    (lists, "bank_deg", "90", "90"),
    (lists, "bank_deg", [90] * 3, "has 3"),
    (lists, "bank_deg", None, "None"),
    (lists, "rotating_mass", -1.0, "-1"),
    (lists, "rotating_mass", [1.0], "has 1 entries"),
    (lists, "rotating_mass", [1.0, NAN], "NaN"),
    (lists, "rotating_mass", [Fraction(1, 3), np.complex128(1j)], "[Fraction(1, 3), …"),
    (lists, "cylinder", [CYLINDER] * 3, "has 3 entries"),
    (lists, "cylinder", 0.05, "0.05"),
    (lists, "cylinder", [None, CYLINDER], "None"),
    (vee, "bank_angle_deg", -60, "-60"),
    (vee, "bank_angle_deg", 200, "200"),
    (vee, "bank_angle_deg", NAN, "NaN"),
    (vee, "bank_angle_deg", None, "None"),
    (vee, "pin_split_deg", NAN, "NaN"),
    (vee, "first_tdc_deg", INF, "inf"),
    (vee, "throws_deg", 120, "120"),
    (vee, "throws_deg", [0.0, NAN], "NaN"),
    (vee, "spacing", NAN, "NaN"),
    (vee, "spacing", None, "None"),
    (vee, "bank_stagger", INF, "inf"),
    (vee, "rotating_mass", [1.0, 1.0, 1.0], "has 3 entries"),
    (vee, "rotating_mass", -1.0, "-1"),
    (vee, "numbering", "by bank", "by bank"),
    (vee, "numbering", None, "None"),
    (vee, "odd_bank", "Left", "Left"),
    (vee, "odd_bank", 1, "1"),
    (inline, "throws_deg", "0-180", "0-180"),
    (inline, "first_tdc_deg", "late", "late"),
    (inline, "spacing", INF, "inf"),
    (firing, "firing_order", "1-2-2-4", "1-2-2-4"),
    (firing, "firing_order", "1-2-3", "of 3 cylinders"),
    (firing, "firing_order", [1, 2, 3, 5], "1-2-3-5"),
    (firing, "firing_order", "1;2", "1;2"),
    (firing, "firing_order", 1342, "1342"),
    (firing, "firing_order", None, "None"),
    (firing, "rule", "uneven", "uneven"),
    (firing, "rule", None, "None"),
    (firing, "bank_angle_deg", "wide", "wide"),
    (firing, "intervals_deg", [180, 180], "has 2 entries"),
    (firing, "intervals_deg", [180, 180, 180, 90], "630"),
    (firing, "intervals_deg", [0, 180, 180, 360], "0"),
    (firing, "intervals_deg", [NAN] * 4, "NaN"),
    (firing, "intervals_deg", 180, "180"),
    (firing, "strokes", 3, "3"),
    (firing, "strokes", None, "None"),
    (crank, "firing_order", "1-2-3", "of 3 cylinders"),
    (crank, "intervals_deg", [180, 180, 180, 90], "630"),
    (crank, "bank_angle_deg", 200, "200"),
    (crank, "odd_bank", "Left", "Left"),
    (crank, "numbering", None, "None"),
    (crank, "strokes", 2.5, "2.5"),
    (fires, "firing_order", "6-5-4-3-2-1", "1-6-5-4-3-2"),
    (fires, "firing_order", "1-2-3", "1-2-3"),
    (fires, "firing_order", "1+2-3+4-5+6", "1+2-3+4-5+6"),
    (fires, "firing_order", None, "None"),
    (fires, "strokes", 6, "6"),
    (fires().gaps, "groups", [[1, 7]], "7"),
    (fires().gaps, "groups", [[1], [1]], "1"),
    (fires().gaps, "groups", 3, "3"),
    (fires().exhaust_overlaps, "groups", [[]], "[]"),
    (fires().exhaust_overlaps, "timing", 50, "50"),
    (fires().valves, "timing", (10, 50), "(10, 50)"),
    (cp.types.ValveTiming, "intake_opens_deg", 181, "181"),
    (cp.types.ValveTiming, "intake_closes_deg", NAN, "NaN"),
    (cp.types.ValveTiming, "exhaust_opens_deg", "early", "early"),
    (cp.types.ValveTiming, "exhaust_closes_deg", -90, "-90"),
    (cp.types.PortTiming, "transfer_opens_deg", 0, "0"),
    (cp.types.PortTiming, "exhaust_opens_deg", 180, "180"),
    (two_stroke().ports, "timing", cp.types.ValveTiming(), "ValveTiming"),
    (two_stroke().exhaust_overlaps, "timing", 50, "50"),
    (V6.with_bank_angle, "hold", "crank", "crank"),
    (V6.with_bank_angle, "hold", None, "None"),
    (balance, "rpm", NAN, "NaN"),
    (balance, "rpm", -1.0, "-1"),
    (balance, "rpm", INF, "inf"),
    (balance, "rpm", None, "None"),
    (balance, "rpm", [1.0, 2.0], "[1.0, 2.0]"),
    (balance, "orders", 0, "0"),
    (balance, "orders", [], "[]"),
    (balance, "orders", [1, 1], "1"),
    (balance, "orders", [1.5], "[1.5]"),
    (balance, "orders", -2, "-2"),
    (balance, "orders", 10**30, "1000000000…"),
    (balance, "orders", 20_000, "20000"),
    (balance, "orders", "all", "all"),
    (balance, "orders", None, "None"),
    (balance, "reference_z", NAN, "NaN"),
    (balance, "reference_z", INF, "inf"),
    (balance, "reference_z", "middle", "middle"),
    (balance, "spectrum", {}, "{}"),
    (balance, "spectrum", {1: NAN}, "NaN"),
    (balance, "spectrum", {1: None}, "{1: None}"),
    (balance, "spectrum", {1: 10**400}, "{1: 1000000000…"),
    (balance, "spectrum", {0: 1.0}, "0"),
    (balance, "spectrum", {"one": 1.0}, "{'one': 1.0}"),
    (balance, "spectrum", [9.0], "[9.0]"),
    (waveform, "rpm", NAN, "NaN"),
    (waveform, "theta_deg", [0.0, NAN], "NaN"),
    (waveform, "theta_deg", [-INF], "-inf"),
    (waveform, "theta_deg", [[0.0, 1.0]], "has shape (1, 2)"),
    (waveform, "theta_deg", "all", "all"),
    (waveform, "theta_deg", [0.0, 1j], "[0.0, 1j]"),
    (waveform, "theta_deg", np.array([0.0, 1j]), "array([0.+0.j, 0.+1.j])"),
    (waveform, "orders", [0], "0"),
    (waveform, "orders", "some", "some"),
    (swept, "rpm", None, "None"),
    (swept, "rpm", [], "[]"),
    (swept, "rpm", NAN, "NaN"),
    (swept, "rpm", [[1.0]], "has shape (1, 1)"),
    (swept, "bank_angle_deg", [60, NAN], "NaN"),
    (swept, "bank_angle_deg", [60, 190], "190"),
    (swept, "hold", None, "None"),
    (swept, "hold", "banks", "banks"),
    (swept, "hold", 3, "3"),
    (swept, "orders", "all", "all"),
    (swept, "rtol", "low", "low"),
    (swept, "torque", 1, "1"),
    (swept, "orders", [2, 2], "2"),
    (swept, "reference_z", NAN, "NaN"),
    (swept, "reference_z", "middle", "middle"),
    (ranked, "by", "moment", "moment"),
    (ranked, "by", "[0].moment.peak", "[0].moment.peak"),
    (ranked, "by", 3, "3"),
    (ranked, "by", [], "[]"),
    (ranked, "by", ["total.torque.peak", None], "None"),
    (ranked, "by", ["total.torque.peak"] * 2, "['total.torque.peak', …"),
    (ranked, "by", lambda _: "much", "much"),
    (ranked, "by", lambda _: [1.0, 2.0], "[1.0, 2.0]"),
    (ranked, "by", lambda _: -INF, "-inf"),
    (ranked, "orders", [1, 4], "[1, 4]"),
    (ranked, "rpm", [1000.0, 2000.0], "[1000.0, 2000.0]"),
    (ranked, "rpm", NAN, "NaN"),
    (ranked, "bank_angle_deg", [60, 190], "190"),
    (ranked, "bank_angle_deg", [], "[]"),
    (ranked, "bank_angle_deg", [[60]], "has shape (1, 1)"),
    (ranked, "hold", None, "None"),
    (ranked, "hold", "banks", "banks"),
    (ranked, "cylinder", CYLINDER, "Cylinder"),
    (ranked, "spacing", 0.1, "0.1"),
    (ranked, "refine", "yes", "yes"),
    (ranked, "tie_rtol", -1e-9, "-1e-09"),
    (ranked, "tie_rtol", NAN, "nan"),
    (ranked_search, "cylinder", None, "None"),
    (ranked_search, "cylinder", 0.05, "0.05"),
    (ranked_search, "spacing", None, "None"),
    (ranked_search, "spacing", NAN, "NaN"),
    (ranked_search, "refine", True, "True"),
    (ranked().best, "count", 2, "2"),
    (ranked().best, "count", 0.5, "0.5"),
    (proportions, "rod_ratio", [0.3, 1.0], "1"),
    (proportions, "rod_ratio", [0.0], "0"),
    (proportions, "rod_ratio", NAN, "NaN"),
    (proportions, "pin_offset", [0.0, 0.1], "0.1"),
    (proportions, "pin_offset", NAN, "NaN"),
    (harmonics, "rod_ratio", 1.0, "1"),
    (harmonics, "rod_ratio", -0.3, "-0.3"),
    (harmonics, "rod_ratio", NAN, "NaN"),
    (harmonics, "rod_ratio", "short", "short"),
    (harmonics, "rod_ratio", [[0.1], [0.1, 0.2]], "[[0.1], [0.1, 0.2]]"),
    (harmonics, "orders", "auto", "auto"),
    (harmonics, "orders", [0], "0"),
    *((harmonics, "rtol", *bad) for bad in NOT_NUMBERS if bad[0] is not None),
    (harmonics, "rtol", 1e-16, "1e-16"),
    (harmonics, "rtol", 1.0, "1"),
    (harmonics, "pin_offset_ratio", 2.5, "2.5"),
    (harmonics, "pin_offset_ratio", INF, "inf"),
    (harmonics, "pin_offset_ratio", "left", "left"),
    (V6.vanishing_orders, "orders", "auto", "auto"),
    (V6.vanishing_orders, "orders", [], "[]"),
    (V6.vanishing_orders, "orders", [2, 2], "2"),
    (V6.vanishing_orders, "orders", 20_000, "20000"),
    (V6.vanishing_orders, "reference_z", NAN, "NaN"),
    (V6.vanishing_orders, "reference_z", "middle", "middle"),
    (V6.vanishing_orders().__getitem__, "order", 13, "13"),
    (closed_form, "order", 1.5, "1.5"),
    (closed_form, "order", [1, 2], "[1, 2]"),
    (closed_form, "order", 0, "0"),
    (closed_form, "order", 20_000, "20000"),
    (closed_form, "quantity", "torque", "torque"),
    (closed_form, "quantity", None, "None"),
    (closed_form, "reference_z", INF, "inf"),
    (CYLINDER.position, "theta_deg", NAN, "NaN"),
    (CYLINDER.position, "theta_deg", "top", "top"),
    (CYLINDER.position, "theta_deg", [[0], [0, 1]], "[[0], [0, 1]]"),
    (CYLINDER.harmonics, "orders", "auto", "auto"),
    (CYLINDER.torque_harmonics, "orders", [0], "0"),
    (CYLINDER.replace, "rod_length", 0.01, "0.01"),
    (cp.Engine.preset, "name", "v8-crosplane", "v8-crosplane"),
    (cp.Engine.preset, "name", None, "None"),
    (cp.Engine.load, "path", "engine.yaml", "engine.yaml"),
    (I4.save, "path", "engine", "engine"),
    (balance().__getitem__, "order", 3, "3"),
    (balance().__getitem__, "order", None, "None"),
    (swept().plot, "quantity", "power", "power"),
]
CURE = 12  # letters at least, after the last thing that is wrong


def written(argument: str, shown: str) -> str:
    """Pattern of an argument with its value: ``z[1] = NaN``, ``z has 1 entries``.

    The whole value and nothing but it, in quotes or not; one that is cut goes on.
    """
    if shown.startswith("has "):
        return rf"(^|\W){re.escape(f'{argument} {shown}')}(?!\w)"
    place = rf"(^|\W){re.escape(argument)}(\[\d+\])*( and pin_deg)?"
    end = "" if shown.endswith(("…", "0" * 9)) else "(\\W|$)"
    return rf"{place} = ['\"]?{re.escape(shown.removesuffix('…'))}{end}"


def bad_name(case: tuple[Callable[..., Any], str, Any, str]) -> str:
    return f"{case[0].__qualname__}, {case[1]} = {case[3] or case[2]}"


@pytest.mark.parametrize("case", BAD, ids=bad_name)
def test_a_bad_argument_is_named_with_its_value_and_a_cure(
    case: tuple[Callable[..., Any], str, Any, str],
) -> None:
    call, argument, value, shown = case
    arguments = {argument: value}
    if call == V6.with_bank_angle:
        arguments["bank_angle_deg"] = 90
    if (call, argument) == (ranked, "orders"):
        arguments["by"] = "[2].moment.peak"
    with pytest.raises(cp.InputError) as caught:
        call(**arguments)
    message = str(caught.value)
    assert re.search(written(argument, shown), message), message
    assert len(message) < 500  # a huge value is cut
    cure = max(message.rsplit(":", maxsplit=1)[-1], message.rsplit(";", maxsplit=1)[-1], key=len)
    assert sum(letter.isalpha() for letter in cure) >= CURE


@pytest.mark.parametrize("rpm", [NAN, INF, -1.0, None, 1e300])
@pytest.mark.parametrize("motion", ["velocity", "acceleration"])
def test_speed_of_a_piston_needs_a_crank_speed(motion: str, rpm: Any) -> None:
    with pytest.raises(cp.InputError, match="rpm"):
        getattr(CYLINDER, motion)([0.0, 30.0], rpm)


@pytest.mark.parametrize("rtol", [0.0, -1e-6, 1.0, NAN, INF, "low"])
def test_auto_needs_a_tolerance(rtol: Any) -> None:
    for call in (balance, waveform):
        with pytest.raises(cp.InputError, match="rtol"):
            call(orders="auto", rtol=rtol)


@pytest.mark.parametrize(
    ("call", "arguments", "words"),
    [
        (firing, {"bank_angle_deg": None, "rule": "x"}, ["rule", "x"]),
        (swept, {"bank_angle_deg": None}, ["hold", "bank_angle_deg"]),
        (swept, {"rod_ratio": [0.3], "spectrum": {1: 1.0}}, ["rod_ratio", "spectrum"]),
        (waveform, {"spectrum": {1: 1.0}}, ["orders", "spectrum"]),
        (
            I4.with_bank_angle,
            {"bank_angle_deg": 90, "hold": "pins"},
            ["bank_angle_deg", "one bank"],
        ),
        (I4.balance, {"rpm": 1e31}, ["rpm", "1e31"]),
        (harmonics, {"rod_ratio": [0.1] * 2, "pin_offset_ratio": [0] * 3}, ["rod_ratio", "(3,)"]),
        (cp.Engine, {"core": None}, ["Engine", "from_lists"]),
        (CYLINDER.replace, {"bore": 0.08}, ["bore"]),
        (cp.Engine.preset, {"name": "v8-crosplane"}, ["v8-crossplane"]),
    ],
)
def test_arguments_that_do_not_go_together(
    call: Callable[..., Any], arguments: dict[str, Any], words: list[str]
) -> None:
    with pytest.raises(cp.InputError) as caught:
        call(**arguments)
    for word in words:
        assert word in str(caught.value)


def test_torque_of_a_spectrum_is_not_known() -> None:
    spectrum = {1: 1.0}
    for result in (
        balance(orders=[1], spectrum=spectrum),
        waveform(orders=[1], spectrum=spectrum),
        swept(orders=[1], spectrum=spectrum),
    ):
        with pytest.raises(cp.InputError, match="spectrum"):
            _ = result.torque


def test_engines_of_a_sweep() -> None:
    for engines in (None, [], [None], {"a": None}, "v6", 3):
        with pytest.raises(cp.InputError, match="engines"):
            cp.sweep(engines, rpm=1000)  # type: ignore[arg-type]
        with pytest.raises(cp.InputError, match="engines"):
            cp.rank(engines, rpm=1000, by="total.moment.peak")  # type: ignore[arg-type]


def test_an_input_error_is_a_value_error() -> None:
    assert issubclass(cp.InputError, ValueError)


# --- too large for any memory -------------------------------------------------------------------


def endless(value: float, *shape: int) -> Any:
    """An array that takes eight bytes, whatever its shape."""
    return np.broadcast_to(np.float64(value), shape)


def grid(**axes: float) -> cp.types.Sweep:
    """1e5 points along each of two axes."""
    fixed: dict[str, Any] = {"rpm": 1000.0} | {name: endless(v, 10**5) for name, v in axes.items()}
    hold: Any = "pins" if "bank_angle_deg" in axes else None
    return cp.sweep(V6, hold=hold, orders=[1, 2, 4, 6], **fixed)


TOO_LARGE: dict[str, tuple[Callable[[], Any], str]] = {
    "waveforms of a sweep": (
        lambda: swept(rod_ratio=endless(0.3, 10**5)).waveform(np.arange(7200)).force,
        "sweep",
    ),
    "angles of a sweep": (lambda: swept().waveform(endless(1.0, 10**12)), "theta_deg"),
    "waveform": (lambda: waveform(theta_deg=endless(1.0, 10**12)), "theta_deg"),
    "sum of orders": (lambda: waveform(theta_deg=endless(1.0, 10**12), orders=[1]), "theta_deg"),
    "position": (lambda: CYLINDER.position(endless(1.0, 10**6, 10**6)), "theta_deg"),
    "acceleration": (lambda: CYLINDER.acceleration(endless(1.0, 10**12), 1000), "theta_deg"),
    "harmonics": (lambda: harmonics(rod_ratio=endless(0.3, 10**12)), "rod_ratio"),
    "harmonics, offset": (
        lambda: harmonics(rod_ratio=endless(0.3, 10**12), pin_offset_ratio=0.0),
        "rod_ratio",
    ),
    "harmonics, broadcast": (
        lambda: harmonics(rod_ratio=endless(0.3, 10**6, 1), pin_offset_ratio=endless(0.1, 10**6)),
        "",
    ),
    "harmonics, many orders": (
        lambda: harmonics(orders=range(1, 10_001), rod_ratio=endless(0.3, 10**6)),
        "",
    ),
    "speeds": (lambda: swept(rpm=endless(1.0, 10**12)), "rpm"),
    "bank angle and speed": (lambda: grid(bank_angle_deg=1.0, rpm=1.0).moment.xy, ""),
    "peaks": (lambda: grid(rod_ratio=0.3, rpm=1.0).force.peak_xy, ""),
    "peaks of sums": (lambda: grid(rod_ratio=0.3, rpm=1.0).total.torque.peak, ""),
    "proportions": (lambda: grid(rod_ratio=0.3, pin_offset=0.0).moment.xy, ""),
    "places": (lambda: lists(z=endless(0.0, 10**12)), "z"),
    "masses": (lambda: lists(rotating_mass=endless(0.0, 10**12)), "rotating_mass"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", TOO_LARGE)
def test_what_no_memory_holds_is_refused(name: str) -> None:
    call, argument = TOO_LARGE[name]
    with pytest.raises(cp.InputError) as caught:
        call()
    assert argument in str(caught.value)


WITHOUT_END = {
    "orders": "I4.balance(1000, orders=itertools.count(1))",
    "orders that vanish": "I4.vanishing_orders(itertools.count(1))",
    "orders of a waveform": "I4.waveform(1000, theta_deg=[0.0], orders=itertools.count(1))",
    "orders of a sweep": "cp.sweep(I4, rpm=1000, orders=itertools.count(1))",
    "many orders": "I4.balance(1000, orders=range(1, 10**12))",
    "harmonics": "cp.slider_crank_harmonics(0.3, itertools.count(1))",
    "throws": "cp.Engine.inline(C, throws_deg=itertools.repeat(0.0), spacing=0.1)",
    "top dead centres": "I4.replace(tdc_deg=itertools.count(0))",
    "bores": "I4.replace(bank_deg=np.broadcast_to(90.0, 10**12))",
    "firing order": "cp.Engine.from_firing_order(C, itertools.count(1), spacing=0.1)",
    "order to fire in": "I4.firing(itertools.count(1))",
    "intervals": "cp.throws([1, 2], intervals_deg=itertools.repeat(1))",
    "groups": "I4.firing('1-3-4-2').gaps(itertools.repeat([1]))",
    "engines": "cp.sweep(itertools.repeat(I4), rpm=1000)",
    "engines to rank": "cp.rank(itertools.repeat(I4), rpm=1000, by='total.torque.peak')",
    "objectives": "cp.rank(I4, rpm=1000, by=itertools.repeat('total.torque.peak'))",
    "bank angles": (
        "cp.rank(cp.Engine.preset('v6-60'), rpm=1000, hold='pins', by='total.moment.peak', "
        "bank_angle_deg=np.broadcast_to(1.0, 10**12))"
    ),
}
LIMITED = """
import itertools, resource
import numpy as np
import crankpin as cp
resource.setrlimit(resource.RLIMIT_AS, (1 << 31, 1 << 31))
C = cp.Cylinder(0.05, 0.15, 0.5)
I4 = cp.Engine.inline(C, throws_deg=[0, 180, 180, 0], spacing=0.1)
try:
    {call}
except cp.InputError as error:
    print("refused:", error)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="limits memory by resource.setrlimit")
@pytest.mark.parametrize("name", WITHOUT_END)
def test_what_has_no_end_is_refused(name: str) -> None:
    """In a process of its own, with 2 GiB: one that goes on would take this one with it."""
    script = LIMITED.format(call=WITHOUT_END[name])
    command = [sys.executable, "-c", script]
    try:
        done = subprocess.run(  # noqa: S603 - its own interpreter
            command, capture_output=True, text=True, timeout=20, check=False
        )
    except subprocess.TimeoutExpired:
        pytest.fail(f"{WITHOUT_END[name]} goes on for ever")
    assert done.stdout.startswith("refused:"), done.stderr[-500:]


# --- files --------------------------------------------------------------------------------------

TOML, JSON = I4.to_toml(), I4.to_json()
DOCUMENT: dict[str, Any] = json.loads(JSON)


def changed(*path: str | int, value: Any) -> str:
    """The JSON text with one entry replaced."""
    document = json.loads(JSON)
    place = document
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return json.dumps(document)


BAD_JSON = {
    "nothing": "",
    "no object": "[]",
    "null": "null",
    "deep lists": "[" * 200_000,
    "deep objects": '{"a":' * 200_000,
    "deep inside": JSON.replace("0.0", "[" * 5000 + "]" * 5000, 1),
    "huge": JSON[:-2] + ' "' + "x" * 3_000_000 + '": 1}',
    "huge blanks": " " * 3_000_000 + JSON,
    "cut": JSON[: len(JSON) // 2],
    "rubbish behind": JSON + "}",
    "nan": JSON.replace("0.05", "NaN"),
    "infinite": JSON.replace("0.05", "1e999"),
    "nul": "\0" + JSON,
    "schema 2": changed("schema", value=2),
    "schema text": changed("schema", value="1"),
    "schema negative": changed("schema", value=-1),
    "unknown key": changed("bore", value=0.08),
    "unknown key of a cylinder": changed("cylinder", "bore", value=0.08),
    "unknown key of a place": changed("placements", 0, "pin", value=1),
    "radius text": changed("cylinder", "crank_radius", value="0.05"),
    "radius null": changed("cylinder", "crank_radius", value=None),
    "radius too long": changed("cylinder", "crank_radius", value=0.15),
    "mass negative": changed("cylinder", "reciprocating_mass", value=-1),
    "no cylinder": changed("cylinder", value=None),
    "no places": changed("placements", value=[]),
    "places of numbers": changed("placements", value=[1, 2]),
    "too many places": changed("placements", value=DOCUMENT["placements"] * 300),
    "angle a list": changed("placements", 0, "tdc_deg", value=[0]),
    "angle over zero": changed("placements", 0, "tdc_deg", value="1/0"),
    "angle huge": changed("placements", 0, "tdc_deg", value="9" * 100_000 + "/7"),
    "z huge": changed("placements", 0, "z", value=1e300),
    "name a number": changed("name", value=1),
}
BAD_TOML = {
    "nothing": "",
    "prose": "an inline four",
    "deep lists": "a = " + "[" * 200_000,
    "deep tables": "a = " + "{b=" * 200_000,
    "deep keys": "a" + ".a" * 200_000 + " = 1",
    "huge": TOML + "# " + "x" * 3_000_000,
    "cut": TOML[: TOML.index("rod_length")],
    "nan": TOML.replace("0.05", "nan"),
    "infinite": TOML.replace("0.05", "inf"),
    "schema 2": TOML.replace("schema = 1", "schema = 2"),
    "no schema": TOML.replace("schema = 1", ""),
    "unknown key": "bore = 0.08\n" + TOML,
    "twice": TOML.replace("rod_length", "crank_radius"),
    "date": TOML.replace("0.05", "2017-04-01"),
    "integer too long": TOML.replace("0.05", "9" * 1000),
    "radius text": TOML.replace("0.05", '"0.05"'),
    "angle of words": TOML.replace("tdc_deg = 180.0", 'tdc_deg = "half a turn"'),
    "nul": TOML + "\0",
}


@pytest.mark.parametrize("name", BAD_JSON)
def test_json_that_describes_no_engine(name: str) -> None:
    with pytest.raises(cp.InputError) as caught:
        cp.Engine.from_json(BAD_JSON[name])
    assert 10 < len(str(caught.value)) < 1000


@pytest.mark.parametrize("name", BAD_TOML)
def test_toml_that_describes_no_engine(name: str) -> None:
    with pytest.raises(cp.InputError) as caught:
        cp.Engine.from_toml(BAD_TOML[name])
    assert 10 < len(str(caught.value)) < 1000


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (BAD_JSON["schema 2"], ["schema", "2"]),
        (BAD_JSON["unknown key of a place"], ["pin"]),
        (BAD_JSON["mass negative"], ["cylinder.reciprocating_mass", "-1"]),
        (BAD_JSON["angle over zero"], ["placements[0].tdc_deg", "1/0"]),
        (BAD_JSON["z huge"], ["z", "1e300"]),
        (BAD_JSON["radius text"], ["JSON", "line 1", "0.05"]),
    ],
)
def test_an_error_in_a_file_says_where(text: str, words: list[str]) -> None:
    with pytest.raises(cp.InputError) as caught:
        cp.Engine.from_json(text)
    for word in words:
        assert word in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "latin.toml").write_bytes(b'name = "\xe9"')
    (tmp_path / "folder.json").mkdir()
    with pytest.raises(cp.InputError, match="UTF-8"):
        cp.Engine.load(tmp_path / "latin.toml")
    for name in ("absent.toml", "folder.json"):
        with pytest.raises(OSError, match=name.split(".")[0]):
            cp.Engine.load(tmp_path / name)
    with pytest.raises(OSError, match="absent"):
        I4.save(tmp_path / "absent" / "engine.toml")


# --- anything at all ----------------------------------------------------------------------------

SECONDS = float(os.environ.get("CRANKPIN_FUZZ_SECONDS", "0"))
PATIENCE = 5.0  # seconds to a call: the longest honest one takes a twentieth of one
ALLOWED = (TypeError, ValueError, OSError, ImportError)
SLOW = {"plot", "view", "save_html"}  # pictures: fewer calls


def nested(depth: int) -> list[Any]:
    value: list[Any] = [0.0]
    for _ in range(depth):
        value = [value]
    return value


class Silent:
    """An object of no use to anyone."""


HOSTILE: list[Any] = [
    *(None, True, False, ..., NotImplemented, Silent(), Silent, len, CYLINDER, V6),
    *(0, -1, 1, 2**31, 2**32, 2**63, 2**64, -(2**63), 10**30, 10**400, -(10**400), 10**5000),
    *(0.0, -0.0, 1e-320, 5e-324, 1e-300, 1e-30, 1e30, 1e31, 1e154, 1e300, NAN, INF, -INF),
    *(0.5, 1.0 - 1e-16, 360.0, 1e12, 179.99999999999997, np.float32(0.1), np.longdouble(0.1)),
    *(1j, complex(NAN, INF), Fraction(1, 3), Fraction(1, 10**400), Fraction(10**400, 7)),
    *(np.float64(NAN), np.int8(-1), np.uint64(2**64 - 1), np.complex128(1j), np.bool_(True)),
    *("", "auto", "pins", "1", "360/7", "1/0", "0/0", "-1/-3", "nan", "inf", "1e400"),
    *("\0", "\ud800", "💥", "9" * 10_000, "x" * 10_000, "1-2", "1-2-3-4", "-", "1--2"),
    *("engine.toml", "engine.json", b"", b"\xff", bytearray(b"ab"), memoryview(b"ab")),
    *(range(3), range(0), slice(0), [], (), {}, set(), [None], ["a"], [[]]),
    *([[1.0], [1.0, 2.0]], nested(3), nested(70), nested(3000), [NAN], [INF], [0.0], [-1.0]),
    *([1e30], [1e300], [10**400], [1j], [0.1, "0.2"], [Fraction(1, 3)], [1], [1, 2], [1, 1]),
    *([2**32], [10_000], [10_001], list(range(1, 200)), [CYLINDER], [V6, I4], [V6, None]),
    *({1: 1.0}, {1: NAN}, {1: None}, {10_000: 1.0}, {"a": 1}, {2: 1e300}, {-1: 1}, {1.5: 1}),
    *({"v6": V6}, {1: 10**400}, {None: None}, {1: 1e30, 2: 1e-320}),
    *(np.array([]), np.zeros((0, 3)), np.zeros((2, 2)), np.array(1.0), np.array(NAN)),
    *(np.array([None]), np.array(["a"]), np.array([b"1"]), np.array([1j]), np.array([Silent()])),
    *(np.array([1.0, NAN]), np.array([1e300, -1e300]), np.ones(3, dtype=np.float16)),
    *(np.array([True]), np.ones(3, dtype=">f8"), np.arange(6.0)[::-2], np.zeros((1,) * 40)),
    *(np.zeros(2, dtype=[("a", "f8")]), np.ma.MaskedArray([1.0, 2.0], mask=[True, False])),
    *(np.array(["2017-04-01"], dtype="M8[D]"), np.array([1], dtype="m8[s]")),
    *(np.arange(5), np.broadcast_to(1.0, (3,))),
]

LEAVES: st.SearchStrategy[Any] = st.one_of(
    st.sampled_from(HOSTILE),
    st.floats(),
    st.integers(),
    st.text(max_size=5),  # too short for a name of a file to be written
    st.binary(max_size=5),
    st.fractions(),
    st.complex_numbers(),
)
VALUES: st.SearchStrategy[Any] = st.one_of(
    LEAVES,
    st.lists(LEAVES, max_size=4),
    st.dictionaries(st.integers(-1, 5), LEAVES, max_size=3),
    st.lists(st.floats(), max_size=6).map(np.array),
)

SOUND: dict[str, list[Any]] = {
    "amount": [0.01],
    "counterweights": [[cp.Unbalance(0.01, 0.1, 180, pin=1)]],
    "pin": [1, None],
    "ratio": [-1, 2],
    "shafts": [[cp.Shaft(-1, [cp.Unbalance(0.01, 0.1)], x=0.1)]],
    "unbalances": [[cp.Unbalance(0.01, 0.1)]],
    "after": [V6, I4],
    "ax": [None],
    "backward_force": [1j],
    "before": [V6, I4],
    "bore": [0.086],
    "chunks": [{"rpm": 1}, 2],
    "core": [I4.core],
    "counterweight": [1.5],
    "cylinders": [6],
    "first_deg": [[0, 120, 240]],
    "high": [90],
    "inertia": [0.0025],
    "length": [0.15],
    "low": [10],
    "mass": [0.6],
    "piston_mass": [0.4],
    "rod": [cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)],
    "second_deg": [[0, 240, 120]],
    "second_order": [(1.0, 2.0)],
    "stroke": [0.086],
    "to_crankpin": [0.05],
    "bank_angle_deg": [60, 90.0, "360/7", [60, 90]],
    "bank_deg": [[60, 120], [90, 90, 90]],
    "by": ["total.moment.peak", ["[1].force.backward"], lambda b: b.rpm],
    "count": [1, 0],
    "cylinder": [CYLINDER],
    "crank_radius": [0.05],
    "engine": [V6],
    "engines": [V6, I4, [V6, I4], {"a": V6}],
    "firing_order": ["1-3-4-2", [1, 2, 3, 4], "1-2-5-6-3-4", "1+4-2+3"],
    "groups": [[[1, 4], [2, 3]], [[2]]],
    "hold": ["pins", "firing"],
    "intervals_deg": [[180] * 4, [90, 270, "90", 270]],
    "name": ["v6-60", "i4", "a name"],
    "order": [1, 2],
    "orders": [1, [1, 2], [1, 2, 4, 6]],
    "path": ["engine.toml"],
    "pin_deg": [[0, 180]],
    "quantity": ["force", "moment", "torque"],
    "reciprocating_mass": [0.5],
    "rod_length": [0.15],
    "rod_ratio": [0.3, [0.2, 0.3]],
    "rpm": [1000, [1000.0, 2000.0]],
    "spacing": [0.1],
    "spectrum": [{1: 1.0, 2: 0.3}],
    "strokes": [4, 2],
    "tdc_deg": [[0, 90], ["360/7", Fraction(1, 3)]],
    "text": [TOML, JSON],
    "theta_deg": [[0.0, 90.0], 30.0],
    "throws_deg": [[0, 120, 240], [0]],
    "timing": [cp.types.ValveTiming(exhaust_opens_deg="360/7"), cp.types.PortTiming()],
    "x": ["rpm"],
    "z": [[0.0, 0.1]],
}

SUBJECTS: dict[str, Any] = {
    "Cylinder": cp.Cylinder,
    "Engine": cp.Engine,
    "Balance": cp.types.Balance,
    "Waveform": cp.types.Waveform,
    "Sweep": cp.types.Sweep,
    "cylinder": CYLINDER,
    "v6": V6,
    "i4": I4,
    "balance": V6.balance(1000),
    "balance of a spectrum": V6.balance(1000, orders=[1], spectrum={1: 1.0}),
    "balance, auto": V6.balance(1000, orders="auto"),
    "vanishing orders": V6.vanishing_orders(),
    "comparison": cp.compare(V6, I4, 1000),
    "closed form": V6.closed_form(1),
    "waveform": V6.waveform(1000, theta_deg=[0.0, 1.0]),
    "waveform, auto": V6.waveform(1000, theta_deg=[0.0, 1.0], orders="auto"),
    "waveform of a spectrum": V6.waveform(1000, theta_deg=[0.0], orders=[1], spectrum={1: 1.0}),
    "firing": V6.firing("1-2-5-6-3-4"),
    "firing, two-stroke": two_stroke(),
    "throws": cp.throws("1-3-4-2", bank_angle_deg=60),
    "sweep": cp.sweep([V6, V6], rpm=[1e3, 2e3], bank_angle_deg=[60, 90], hold="pins"),
    "ranking": ranked(by=["total.force.peak_xy", lambda b: b.rpm], refine=True),
    "ranking, as they are": cp.rank(
        [V6, vee()], rpm=1e3, by="total.moment.peak", spectrum={1: 1.0, 2: 0.2}
    ),
    "sweep of a spectrum": cp.sweep(I4, rpm=1e3, spectrum={1: 1.0}),
    "waveforms of a sweep": swept().waveform([0.0, 1.0]),
    "waveforms of a sweep, exact": swept().waveform([0.0, 1.0], exact=True),
}
PLAIN = {
    "Choice",
    "Ellipse",
    "ErrorBound",
    "Gap",
    "InputError",
    "OrderBalance",
    "Overlap",
    "Ports",
    "Valves",
}  # take anything, and hold it
RESULTS_MADE_ELSEWHERE = {
    "Balance",
    "Comparison",
    "Firing",
    "Ranking",
    "Waveform",
    "Sweep",
    "SweepWaveform",
}  # by methods of Engine and of Sweep, by sweep and by rank


class Target(NamedTuple):
    """Something public that can be called."""

    label: str
    function: Callable[..., Any]
    parameters: tuple[inspect.Parameter, ...]


def target(label: str, function: Callable[..., Any]) -> Target:
    return Target(label, function, tuple(inspect.signature(function).parameters.values()))


def targets() -> Iterator[Target]:
    """Every public function, constructor and method."""
    for name in cp.__all__:
        value = getattr(cp, name)
        if callable(value) and name not in PLAIN:
            yield target(name, value)
    for name in ("PortTiming", "ValveTiming"):
        yield target(f"types.{name}", getattr(cp.types, name))
    for label, subject in SUBJECTS.items():
        for name in dir(type(subject) if not isinstance(subject, type) else subject):
            of_class = isinstance(subject, type)
            static = inspect.getattr_static(subject if of_class else type(subject), name)
            if name.startswith("_") or of_class != isinstance(static, classmethod | staticmethod):
                continue
            if callable(static) or of_class:
                yield target(f"{label}.{name}", getattr(subject, name))


TARGETS = [each for each in targets() if each.label.rpartition(".")[2] not in SLOW]
PICTURES = [each for each in targets() if each.label.rpartition(".")[2] in SLOW]
MAP = dict[str, Any]


def shown(value: Any) -> str:
    """Text of a value, however deep or long."""
    try:
        return reprlib.repr(value)[:200]
    except ValueError:  # an integer too long for Python to write
        return f"<{type(value).__name__}>"


class Call(NamedTuple):
    """A target and what it is called with."""

    target: Target
    arguments: MAP

    def __repr__(self) -> str:
        listed = ", ".join(f"{name}={shown(value)}" for name, value in self.arguments.items())
        return f"{self.target.label}({listed})"


@st.composite
def calls(draw: st.DrawFn, among: list[Target]) -> Call:
    """A call with up to three arguments bad and the others good or left out."""
    chosen = draw(st.sampled_from(among))
    parameters = [p for p in chosen.parameters if p.kind is not p.VAR_KEYWORD]
    count = draw(st.integers(1, 3))
    bad = {draw(st.integers(0, max(len(parameters) - 1, 0))) for _ in range(count)}
    arguments = {}
    for k, parameter in enumerate(parameters):
        if k in bad:
            arguments[parameter.name] = draw(VALUES)
        elif parameter.default is parameter.empty or draw(st.booleans()):
            if parameter.name in SOUND:
                arguments[parameter.name] = draw(st.sampled_from(SOUND[parameter.name]))
            elif parameter.default is parameter.empty:
                arguments[parameter.name] = draw(VALUES)
    return Call(chosen, arguments)


def invoke(call: Call) -> Any:
    """Call, the var-positional argument unpacked."""
    positional: list[Any] = []
    named = dict(call.arguments)
    for parameter in call.target.parameters:
        if parameter.kind is parameter.VAR_POSITIONAL:
            values = named.pop(parameter.name, ())
            positional += values if isinstance(values, list | tuple) else [values]
        elif parameter.kind is parameter.POSITIONAL_ONLY and parameter.name in named:
            positional.append(named.pop(parameter.name))
    return call.target.function(*positional, **named)


def finite(value: Any) -> bool:
    """Whether all figures in it are, down through tuples."""
    if isinstance(value, float | complex | np.ndarray | np.generic):
        array = np.asarray(value)
        return array.dtype.kind not in "fc" or bool(np.isfinite(array).all())
    return not isinstance(value, tuple) or all(finite(each) for each in value)


BY_ORDER = [
    "force.xy",
    "moment.xy",
    "torque.phasor",
    "crank_torque.phasor",
    "force.peak",
    "moment.forward",
    "total.force.peak_xy",
    "total.moment.peak",
    "total.torque.peak",
    "force.zero_bound",
    "error_bound",
]
RESULTS = {
    cp.Cylinder: [*PARTS, "rod_ratio"],
    cp.Engine: ["tdc_deg", "bank_deg", "pin_deg", "z", "rotating_mass", "reference_z"],
    cp.types.Balance: BY_ORDER,
    cp.types.Sweep: BY_ORDER,
    cp.types.Waveform: ["force", "moment", "torque", "crank_torque", "error_bound"],
    cp.types.VanishingOrders: ["orders", "reference_z"],
    cp.types.Comparison: ["rpm"],
    cp.types.ClosedForm: ["spacing", "reference_z"],
    cp.types.Firing: ["angles_deg", "intervals_deg", "unevenness_deg"],
    cp.types.Throws: ["throws_deg", "pin_split_deg"],
    cp.types.Ranking: ["values"],
}


def unsound(value: Any) -> str:
    """What is wrong with a result: figures not finite, an engine that does not read back."""
    if not finite(value):
        return f"returned {shown(value)}"
    for name in RESULTS.get(type(value), []):
        try:
            figure = attrgetter(name)(value)
        except cp.InputError:
            continue  # torque, where a spectrum is given
        if not finite(figure):
            return f"returned one whose {name} is {shown(figure)}"
    if isinstance(value, cp.Engine) and cp.Engine.from_json(value.to_json()) != value:
        return "returned an engine that does not read back"
    repr(value)
    return ""


def problem(call: Call) -> str:
    """What comes of a call but a sound result or an allowed error; nothing if all is well."""
    start = time.monotonic()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of units and pin splits
        try:
            found = unsound(invoke(call))
        except ALLOWED:
            found = ""
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:
            found = f"raised {type(error).__name__}: {shown(error)}"
    took = time.monotonic() - start
    if took > PATIENCE:
        found += f" after {took:.1f} s"
    return found and f"{call!r} {found}"


def call_hostile(call: Call) -> None:
    assert not problem(call)


def close_pictures() -> None:
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


def hostile(examples: int) -> settings:
    return settings(
        max_examples=examples,
        deadline=None,
        derandomize=SECONDS == 0,
        database=None,
        report_multiple_bugs=True,
        suppress_health_check=list(HealthCheck),
    )


@pytest.fixture(autouse=True)
def somewhere_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Files are written where it does no harm; a call that hangs says where."""
    monkeypatch.chdir(tmp_path)
    faulthandler.dump_traceback_later(SECONDS + 300.0, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


def test_fuzz_reaches_the_whole_public_surface() -> None:
    labels = {each.label for each in TARGETS + PICTURES}
    for name in cp.__all__:
        assert name in labels | PLAIN | {"__version__", "types"}
    for label in ("firing.gaps", "firing.valves", "i4.firings", "throws", "types.ValveTiming"):
        assert label in labels
    for label in ("Engine.from_lists", "v6.balance", "sweep.to_pandas", "balance.plot", "i4.save"):
        assert label in labels
    for label in ("rank", "ranking.best", "ranking.plot"):
        assert label in labels


@pytest.mark.parametrize("name", sorted(RESULTS_MADE_ELSEWHERE))
@pytest.mark.parametrize("value", [None, "text", 0, [], V6])
def test_results_cannot_be_made_of_anything(name: str, value: Any) -> None:
    kind = getattr(cp.types, name)
    count = len(inspect.signature(kind).parameters)
    with pytest.raises((TypeError, ValueError)):
        kind(*[value] * count)


@pytest.mark.slow
@hostile(1200)
@given(calls(TARGETS))
def test_fuzz_calls(call: Call) -> None:
    call_hostile(call)


@pytest.mark.slow
@hostile(40)
@given(calls(PICTURES or TARGETS))
def test_fuzz_pictures(call: Call) -> None:
    found = problem(call)
    close_pictures()
    assert not found


@pytest.mark.slow
@pytest.mark.parametrize("each", TARGETS, ids=lambda each: each.label)
def test_fuzz_one_argument_at_a_time(each: Target) -> None:
    """Each argument in turn is each of the hostile values, the others being good."""
    found = []
    for parameter in each.parameters:
        needed = [p for p in each.parameters if p.default is p.empty and p is not parameter]
        # A call that stops at a missing argument would try nothing.
        given_ = [p for p in needed if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)]
        others = {p.name: SOUND[p.name][0] for p in given_}
        if parameter.kind is not parameter.VAR_KEYWORD:
            calls_ = (Call(each, others | {parameter.name: value}) for value in HOSTILE)
            found += [text for call in calls_ if (text := problem(call))]
    assert not found, f"{len(found)} calls\n" + "\n".join(found[:20])


@pytest.mark.parametrize(
    "label", [name for name, each in SUBJECTS.items() if not isinstance(each, type)]
)
def test_properties_give_figures_or_say_why_not(label: str) -> None:
    subject = SUBJECTS[label]
    for name in dir(subject):
        if not name.startswith("_") and not callable(getattr(type(subject), name, None)):
            try:
                assert finite(getattr(subject, name))
            except cp.InputError as error:
                assert len(str(error)) > CURE  # noqa: PT017 - either is right


@st.composite
def damaged(draw: st.DrawFn, text: str) -> str:
    """An engine file with a piece of it replaced."""
    start = draw(st.integers(0, len(text)))
    end = draw(st.integers(start, min(len(text), start + 40)))
    piece = draw(
        st.one_of(
            st.text(max_size=20),
            st.sampled_from(["", "nan", "1e999", "-", "[[", "}}", '"', "9" * 500, "null", "\n"]),
            st.integers(0, len(text) - 10).map(lambda k: text[k : k + 10]),
        )
    )
    return text[:start] + piece + text[end:]


DAMAGED = st.tuples(damaged(TOML), damaged(JSON))


def read_damaged(texts: tuple[str, str]) -> None:
    """Each text is refused, or gives a sound engine that reads back."""
    for read, text in zip((cp.Engine.from_toml, cp.Engine.from_json), texts, strict=True):
        try:
            engine = read(text)
        except ValueError:
            continue
        assert not unsound(engine)
        assert read(engine.to_toml() if read == cp.Engine.from_toml else engine.to_json()) == engine


@pytest.mark.slow
@hostile(400)
@given(DAMAGED)
@example(("\ufeff" + TOML, "\ufeff" + JSON))
def test_fuzz_files(texts: tuple[str, str]) -> None:
    read_damaged(texts)


def named(*names: str) -> st.SearchStrategy[Call]:
    """Calls of the targets whose label ends in one of the names."""
    chosen = [each for each in TARGETS if each.label.rpartition(".")[2] in names]
    assert len({each.label.rpartition(".")[2] for each in chosen}) == len(names)
    return calls(chosen)


BUILDERS = (
    *("Cylinder", "from_lists", "inline", "vee", "flat", "boxer", "from_firing_order", "preset"),
    *("throws", "replace", "with_bank_angle", "with_first_tdc"),
)
HARMONICS = ("slider_crank_harmonics", "harmonics", "torque_harmonics")
FUZZED: dict[str, tuple[st.SearchStrategy[Any], Callable[[Any], None]]] = {
    "engine files": (DAMAGED, read_damaged),
    "builders": (named(*BUILDERS), call_hostile),
    "harmonics": (named(*HARMONICS), call_hostile),
    "everything": (calls(TARGETS), call_hostile),
}


@pytest.mark.skipif(SECONDS == 0, reason="CRANKPIN_FUZZ_SECONDS is not set")
@pytest.mark.parametrize("what", FUZZED)
def test_fuzz_for_a_while(what: str) -> None:
    """Other examples, a seed after the other, until the time is up."""
    examples, check = FUZZED[what]
    end = time.monotonic() + SECONDS
    for number in itertools.count():
        if time.monotonic() > end:
            return

        @seed(number)
        @settings(hostile(1000), derandomize=False)
        @given(examples)
        def more(example_: Any) -> None:
            if time.monotonic() < end:
                check(example_)

        more()
