"""Values that no argument expects."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from hypothesis import strategies as st

from fuzzing.sound import CYLINDER, I4, INF, NAN, V6


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
    *([2**32], [10_000], [10_001], list(range(1, 5)), [CYLINDER], [V6, I4], [V6, None]),
    *({1: 1.0}, {1: NAN}, {1: None}, {10_000: 1.0}, {"a": 1}, {2: 1e300}, {-1: 1}, {1.5: 1}),
    *({"v6": V6}, {1: 10**400}, {None: None}, {1: 1e30, 2: 1e-320}),
    *(np.array([]), np.zeros((0, 3)), np.zeros((2, 2)), np.array(1.0), np.array(NAN)),
    *(np.array([None]), np.array(["a"]), np.array([b"1"]), np.array([1j]), np.array([Silent()])),
    *(np.array([1.0, NAN]), np.array([1e300, -1e300]), np.ones(3, dtype=np.float16)),
    *(np.array([True]), np.ones(3, dtype=">f8"), np.arange(6.0)[::-2], np.zeros((1,) * 40)),
    *(np.zeros(2, dtype=[("a", "f8")]), np.ma.MaskedArray([1.0, 2.0], mask=[True, False])),
    *(np.array(["2017-04-01"], dtype="M8[D]"), np.array([1], dtype="m8[s]")),
    *(np.arange(5), np.array([INF]), np.broadcast_to(1.0, (3,))),
]

DRAWN: list[Any] = [
    *(None, True, Silent(), 0, -1, 2**31, 10**400, 0.5, NAN, INF, 1e-320, 1e300, 1j),
    *(Fraction(1, 3), "", "\ud800", "x" * 10_000, b"\xff", [], [None], [[1.0], [1.0, 2.0]]),
    *(nested(70), [NAN], {1: None}, slice(0), np.zeros((2, 2)), np.array([1.0, NAN]), CYLINDER),
]
"""Some of them, for operators."""
FEW: list[Any] = [None, Silent(), NAN, 2**31, "x", [], [[1.0], [1.0, 2.0]]]
"""Fewer, for pictures, which take long where they are drawn."""

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
