"""Arguments: strings and truth values are not numbers, and nothing endless is converted first."""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import copy
import threading
import tracemalloc
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import inputs
from crankpin._support.messages import suppressed, warn
from support.engines import CYLINDER, I4, V6

if TYPE_CHECKING:
    from collections.abc import Callable

NOT_NUMBERS: list[Any] = [
    "6000", b"6000", bytearray(b"6000"), True, np.True_, np.array(True), np.str_("6000"),
    np.array(1j), np.complex128(1), np.array([6000.0]), [6000.0], {6000.0}, np.timedelta64(3, "s"),
]  # fmt: skip
NUMBERS: list[Any] = [
    7, 7.0, np.float32(7), np.int8(7), np.array(7), np.array(7.0), Fraction(7), Decimal(7),
]  # fmt: skip


@pytest.mark.parametrize("value", NOT_NUMBERS, ids=repr)
def test_what_is_not_a_number_is_rejected_by_name(value: Any) -> None:
    calls: dict[str, Callable[..., Any]] = {
        "rpm": lambda: I4.balance(value),
        "crank_radius": lambda: CYLINDER.replace(crank_radius=value),
        "amount": lambda: cp.Unbalance(value, 0.0),
        "spacing": lambda: cp.Engine.preset("i4", spacing=value),
        "rtol": lambda: I4.balance(6000, rtol=value),
        "first_tdc_deg": lambda: cp.Engine.inline(
            CYLINDER, throws_deg=[0], spacing=0.1, first_tdc_deg=value
        ),
    }
    # Angles may be text, and one angle the only element of an array; "6000" is exact.
    if isinstance(value, str):
        del calls["first_tdc_deg"]
    for name, call in calls.items():
        with pytest.raises(cp.InputError, match=rf"{name} = .*: give "):
            call()


@pytest.mark.parametrize("value", NUMBERS, ids=repr)
def test_numbers_of_any_type_are_taken(value: Any) -> None:
    assert inputs.number("x", value) == 7.0
    assert inputs.angle("x", value) == "7"


@pytest.mark.parametrize(
    "values",
    [["1", "2"], [1.0, "2"], [True, False], [1.0, True], np.array([True]), [Fraction(1), True]],
    ids=repr,
)
def test_arrays_of_what_is_not_a_number_are_rejected(values: Any) -> None:
    with pytest.raises(cp.InputError, match=r"theta_deg = .*: give numbers"):
        CYLINDER.position(values)
    with pytest.raises(cp.InputError, match=r"z = .*: give numbers"):
        inputs.vector("z", values)


def test_true_is_no_order_nor_a_cylinder() -> None:
    for call in (
        lambda: I4.balance(6000, orders=True),
        lambda: I4.balance(6000, orders=[True, 2]),
        lambda: I4.balance(6000, orders=[1], spectrum={1: True}),
        lambda: I4.balance(6000, orders=[1], spectrum={1: "2"}),  # type: ignore[dict-item]
        lambda: cp.Unbalance(1.0, 0.0, pin=True),
        lambda: cp.Shaft(True, []),
    ):
        with pytest.raises(cp.InputError, match=r"= .*: "):
            call()


def test_a_huge_range_is_rejected_before_it_is_converted() -> None:
    tracemalloc.start()
    for call in (
        lambda: I4.balance(range(10**8)),  # type: ignore[arg-type]
        lambda: CYLINDER.replace(rod_length=range(10**8)),
        lambda: cp.Unbalance(0.1, z=range(10**8)),  # type: ignore[arg-type]
        lambda: V6.with_bank_angle(range(10**8), hold="pins"),  # type: ignore[arg-type]
        lambda: CYLINDER.position(theta_deg=0) and CYLINDER.velocity(0, rpm=range(10**8)),  # type: ignore[arg-type]
    ):
        with pytest.raises(cp.InputError, match=r"= range\(0, 100000000\): give a number"):
            call()
    # Converting one of them took 4.6 GB; modules that a first call loads take one megabyte.
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 1e8


def test_angles_may_be_arrays_without_dimensions() -> None:
    given = cp.Engine.vee(
        CYLINDER,
        bank_angle_deg=np.array(60.0),  # type: ignore[arg-type]
        throws_deg=[np.array(0.0), np.array(120.0), np.array(240.0)],  # type: ignore[list-item]
        spacing=0.13,
        name=V6.name,
    )
    assert given == V6


def test_positions_beyond_what_a_double_tells_of_an_angle_are_rejected() -> None:
    """As by ``waveform``: at 1e25° neighbouring doubles are millions of turns apart."""
    for call in (
        lambda: CYLINDER.position(1e25),
        lambda: CYLINDER.velocity([0.0, -1e25], rpm=3000),
        lambda: CYLINDER.acceleration(1e25, rpm=3000),
        lambda: I4.waveform(3000, theta_deg=[1e25]),
    ):
        with pytest.raises(cp.InputError, match=r"theta_deg.* = -?1e25"):
            call()


def test_a_warning_kept_back_in_one_thread_is_heard_in_another() -> None:
    inside, done = threading.Event(), threading.Event()

    def silent() -> None:
        with suppressed():
            inside.set()
            done.wait(10)

    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        filters = list(warnings.filters)
        thread = threading.Thread(target=silent)
        thread.start()
        inside.wait(10)
        assert warnings.filters == filters  # what threads share stays as it is
        warn("heard", "")
        done.set()
        thread.join()
        with suppressed("mean piston speed"):
            warn("mean piston speed", "is high")
            warn("heard too", "")
    assert [str(each.message) for each in heard] == ["heard", "heard too"]


def test_warnings_are_the_same_by_what_they_are_about_and_hint_at() -> None:
    """In a loop each figure is another: Python shows one. Names with figures are others."""

    def warned(*arguments: str) -> None:
        for name in arguments:
            warn(f"at of mount '{name}'", f"= {len(name) * 10} m", "was it given in millimetres?")

    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("default")
        warned("rear 1", "rear 1", "rear 2")
        for size in (86.0, 87.0):
            warn("bore", f"= {size} m and stroke = 0.086 m", "are both in metres?")
    texts = [str(each.message) for each in heard]
    assert [text.partition(" = ")[0] for text in texts] == [
        "at of mount 'rear 1'",
        "at of mount 'rear 2'",
        "bore",
    ]
    assert copy.copy(heard[0].message.args[0]) == heard[0].message.args[0]  # type: ignore[union-attr]


def test_no_module_changes_the_warnings_of_the_process() -> None:
    """``catch_warnings`` swaps filters that all threads share: two of them may restore the wrong
    ones. Only the command line, which is a process of its own, may use it.
    """
    package = Path(cp.__file__).parent
    using = {
        file.relative_to(package).parts[0]
        for file in package.rglob("*.py")
        if "warnings.catch_warnings()" in file.read_text(encoding="utf-8")
    }
    assert using <= {"cli"}


def test_long_lists_are_read_in_pieces_as_a_whole() -> None:
    count = inputs.PIECE_NUMBERS + 3
    lists: tuple[Any, ...] = (
        list(range(count)),
        [*range(count - 1), 0.5],  # whole numbers, then another kind
        [[k, 0.1] for k in range(count)],
        tuple(Fraction(k, 3) for k in range(count)),
    )
    for values in lists:
        read = inputs.array("angles", values)
        assert read.tobytes() == np.array(values, dtype=np.float64).tobytes()
        assert read.shape == np.shape(values)
    for last in ([0.5, 0.5, 0.5], [0.5], 0.5):  # in a piece of its own
        with pytest.raises(cp.InputError, match=r"angles = .*give numbers"):
            inputs.array("angles", [[0.1, 0.2]] * inputs.PIECE_NUMBERS + [last])
