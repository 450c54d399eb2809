"""Does input that makes no engine give an error that names the argument, its value and a hint?"""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from fuzzing.calls import unclear
from fuzzing.sound import (
    CURE,
    CYLINDER,
    I4,
    INF,
    JSON,
    NAN,
    PARTS,
    TOML,
    V6,
    balance,
    closed_form,
    crank,
    cylinder,
    fires,
    firing,
    harmonics,
    inline,
    lists,
    proportions,
    ranked,
    ranked_search,
    swept,
    two_stroke,
    vee,
    waveform,
)
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

os.environ.setdefault("MPLBACKEND", "Agg")

# --- errors that help ---------------------------------------------------------------------------

# For each: function, argument, its bad value, how the message writes that value.
NOT_NUMBERS = [(NAN, "NaN"), (-INF, "-inf"), (None, "None"), ("wide", "wide"), (1j, "1j")]
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
    (firing, "firing_order", "1-2-3", "1-2-3"),
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
    (crank, "firing_order", "1-2-3", "1-2-3"),
    (crank, "intervals_deg", [180, 180, 180, 90], "630"),
    (crank, "bank_angle_deg", 200, "200"),
    (crank, "odd_bank", "Left", "Left"),
    (crank, "numbering", None, "None"),
    (crank, "strokes", 2.5, "2.5"),
    (fires, "firing_order", "6-5-4-3-2-1", "6-5-4-3-2-1"),
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
    (cp.ValveTiming, "intake_opens_deg", 181, "181"),
    (cp.ValveTiming, "intake_closes_deg", NAN, "NaN"),
    (cp.ValveTiming, "exhaust_opens_deg", "early", "early"),
    (cp.ValveTiming, "exhaust_closes_deg", -90, "-90"),
    (cp.PortTiming, "transfer_opens_deg", 0, "0"),
    (cp.PortTiming, "exhaust_opens_deg", 180, "180"),
    (two_stroke().ports, "timing", cp.ValveTiming(), "ValveTiming"),
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
    (balance, "orders", [1.3], "[1.3]"),
    (balance, "orders", -2, "-2"),
    (balance, "orders", 10**30, "1000000000…"),
    (balance, "orders", 20_000, "20000"),
    (balance, "orders", "all", "all"),
    (balance, "orders", None, "None"),
    (balance().about, "point", NAN, "nan"),
    (balance().about, "point", INF, "inf"),
    (balance().about, "point", "middle", "middle"),
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
    (swept().about, "point", NAN, "nan"),
    (swept().about, "point", "middle", "middle"),
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
    (proportions, "rod_ratio", [0.3, 1.0], "1"),
    (proportions, "rod_ratio", [-0.1], "-0.1"),
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
    (V6.vanishing_orders().torque.__getitem__, "order", 13, "13"),
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
    (balance().__getitem__, "order", 0, "0"),
    (balance().__getitem__, "order", None, "None"),
    (swept().plot, "quantity", "power", "power"),
]


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


@in_turn("case", BAD)
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
    hint = max(message.rsplit(":", maxsplit=1)[-1], message.rsplit(";", maxsplit=1)[-1], key=len)
    assert sum(letter.isalpha() for letter in hint) >= CURE
    assert not unclear(caught.value)


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
        (CYLINDER.replace, {"diameter": 0.08}, ["diameter"]),
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


def test_an_input_error_is_a_value_error_with_fields() -> None:
    assert issubclass(cp.InputError, ValueError)
    with pytest.raises(cp.InputError) as caught:
        cp.Cylinder(-1.0, 0.15, 0.5)
    argument, value, hint = (
        getattr(caught.value, field) for field in ("argument", "value", "hint")
    )
    assert (argument, value) == ("crank_radius", "-1.0")
    assert str(caught.value) == f"{argument} = {value}: {hint}"
    plain = cp.InputError("a sentence")
    assert plain.argument is plain.value is plain.hint is None


# --- too large for any memory -------------------------------------------------------------------


def endless(value: float, *shape: int) -> Any:
    """An array that takes eight bytes, whatever its shape."""
    return np.broadcast_to(np.float64(value), shape)


def grid(**axes: float) -> cp.results.Sweep:
    """1e5 points along each of two axes."""
    fixed: dict[str, Any] = {"rpm": 1000.0} | {name: endless(v, 10**5) for name, v in axes.items()}
    hold: Any = "pins" if "bank_angle_deg" in axes else None
    return cp.sweep(V6, hold=hold, orders=[1, 2, 4, 6], **fixed)


TOO_LARGE: dict[str, tuple[Callable[[], Any], str]] = {
    "waveforms of a sweep": (
        lambda: swept(rod_ratio=endless(0.3, 10**5)).waveform(np.arange(7200)).force.xy,
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
    "huge": JSON[:-2] + ' "' + "x" * 20_000_000 + '": 1}',
    "huge blanks": " " * 20_000_000 + JSON,
    "cut": JSON[: len(JSON) // 2],
    "rubbish behind": JSON + "}",
    "nan": JSON.replace("0.05", "NaN"),
    "infinite": JSON.replace("0.05", "1e999"),
    "nul": "\0" + JSON,
    "schema 2": changed("schema", value=2),
    "schema text": changed("schema", value="1"),
    "schema negative": changed("schema", value=-1),
    "unknown key": changed("bore", value=0.08),
    "unknown key of a cylinder": changed("cylinder", "borre", value=0.08),
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
    "huge": TOML + "# " + "x" * 20_000_000,
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


@in_turn("name", BAD_JSON)
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


FIRED = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.05, 0.15, 0.5, bore=0.08)).with_cycle(
    cp.Cycle.example()
)
SWEPT = cp.sweep(FIRED, rpm=[1000, 2000], orders=[1, 2])
BARE: dict[str, tuple[Callable[[], object], str]] = {
    "objective": (
        lambda: cp.rank([FIRED], rpm=3000, by="total.torque_gas.peak"),
        "by = 'total.torque_gas.peak'",
    ),
    "nothing swept": (
        lambda: cp.sweep(FIRED, rpm=3).sel(rpm=3),
        "dimension = 'rpm': there is none",
    ),
    "column": (lambda: FIRED.balance(1000).table["x"], "column = 'x': the columns are 'order'"),
    "torque along x": (lambda: FIRED.balance(1000).torque.x, "x is that of a vector; torque is"),
    "torque's axis": (lambda: FIRED.balance(1000).torque.minor, "minor is that of a vector"),
    "progress": (
        lambda: cp.tolerances(I4, rpm=1000, z=1e-4, samples=200).evaluate(progress=[1]),  # type: ignore[arg-type]
        r"progress = \[1\]: give True",
    ),
    "star": (lambda: cp.star_diagram(FIRED).plot(order="x"), "order = 'x': choose from orders"),
    "cycle": (lambda: cp.Cycle.example().plot(cylinder="x"), "cylinder = 'x': give a crankpin"),
    "timing": (lambda: cp.PortTiming("\ud800"), "transfer_opens_deg = .*: give degrees"),
    "sentences": (lambda: FIRED.explain(1000).html(count=-1), "count = -1: give a whole number"),
    "dimension": (lambda: SWEPT.plot(x=[1]), r"x = \[1\]: give \"rpm\""),
    "chunks": (lambda: SWEPT.to_dask(chunks=[float("nan")]), "chunks = .*: give a number"),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("name", BARE)
def test_errors_name_argument_value_and_hint(name: str) -> None:
    call, message = BARE[name]
    with pytest.raises(cp.InputError, match=message) as caught:
        call()
    assert not unclear(caught.value)


def test_bob_weights_of_throws_that_are_almost_one_place() -> None:
    """Squares of moments over 1e-160 m would underflow."""
    cylinder = cp.Cylinder(0.05, 0.15, 0.5)
    for spacing in 10.0 ** np.arange(-300, -20, 20):
        engine = cp.Engine.inline(cylinder, throws_deg=[0, 90], spacing=float(spacing))
        weight, usual = (
            cp.bob_weight(engine),
            cp.bob_weight(cp.Engine.inline(cylinder, throws_deg=[0, 90], spacing=0.1)),
        )
        assert repr(weight)
        assert weight.optimal_factor("moment") == pytest.approx(
            usual.optimal_factor("moment"), rel=1e-12
        )
        directions = [at for _, at in weight.straight_line_factors("moment")]
        assert directions == pytest.approx(
            [at for _, at in usual.straight_line_factors("moment")], abs=1e-6
        )
