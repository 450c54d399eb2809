"""Numbers of a page: terms of each order, as polynomials in the rod ratio."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.polynomial import chebyshev

from crankpin import _core
from crankpin._core import HIGHEST_LISTED
from crankpin._support import inputs
from crankpin.analysis.request import engine_core
from crankpin.model.cylinder import rod_length

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.engine import Engine

LEAST_ROD_RATIO, LARGEST_ROD_RATIO = 0.05, 0.7
"""Rod ratios that a page reaches, besides the engine's own: of 20 crank radii to 1.4."""
TURNING = 0.9
"""Part of the largest rod ratio at which the crank turns that a page reaches at most."""
ROUNDING = 1e-13
"""Sums and coefficients below this part of what they are added to are rounding, and left out."""
FEWEST_POINTS, MOST_POINTS = 16, 512
"""Rod ratios at which terms are computed: twice as many until their polynomials have converged."""
DIGITS = 13
"""Decimals of values of parts that stand still."""
SIZES = ("force", "moment", "torque", "gas")
"""Contributions of single cylinders: inertia over the square of speed, and gas."""

Complex: TypeAlias = "NDArray[np.complex128]"
Real: TypeAlias = "NDArray[np.float64]"
Row: TypeAlias = "list[Any]"
"""Order, power, polynomial, values of groups, and the factor at the engine's own rod ratios.

A term of a group is its values times a factor, q to the power times a sum of Chebyshev's
polynomials."""


@dataclasses.dataclass(frozen=True)
class RodRatios:
    """Rod ratios that a page reaches, and the variable of its polynomials.

    The variable q is the tangent of half the rod's largest swing: harmonic n of a piston is qⁿ⁻¹
    times a series in q² that converges wherever the crank turns.
    """

    least: float
    most: float
    turning: float
    """Rod ratio below which the crank turns."""
    common: float | None
    """The engine's own, of all cylinders; None while they differ."""

    @classmethod
    def of(cls, engine: Engine) -> RodRatios:
        """Return those of an engine, whose own is among them."""
        own = {cylinder.rod_ratio for cylinder in engine.cylinders}
        offset = max(abs(each.pin_offset) / each.crank_radius for each in engine.cylinders)
        turning = 1.0 / (1.0 + offset)
        common = own.pop() if len(own) == 1 else None
        most = math.floor(1e3 * min(LARGEST_ROD_RATIO, TURNING * turning)) / 1e3
        if common is None:
            return cls(min(LEAST_ROD_RATIO, 0.9 * most), most, turning, common)
        most = max(most, common)
        return cls(min(LEAST_ROD_RATIO, 0.9 * most, common), most, turning, common)

    def check(self, ratio: float) -> None:
        """Raise an InputError if a page does not reach a rod ratio."""
        if not self.least <= ratio <= self.most:
            hint = f"a page reaches {self.least:.6g} to {self.most:.6g}"
            raise inputs.rejected("rod_ratio", ratio, hint)

    def points(self, count: int) -> tuple[Real, Real]:
        """Return Chebyshev's points in q, ascending, and the rod ratios there."""
        low, high = np.tan(0.5 * np.arcsin(np.array([self.least, self.most]) / self.turning))
        q = low + 0.5 * (high - low) * (1.0 + chebyshev.chebpts1(count))
        ratios = self.turning * np.sin(2.0 * np.arctan(q))
        return q, np.clip(ratios, self.least, self.most)


def at_rod_ratio(engine: Engine, ratio: float | None) -> Engine:
    """Return the engine with a rod ratio of all cylinders; None leaves it as it is."""
    if ratio is None:
        return engine
    changed = {
        cylinder: cylinder
        if cylinder.rod_ratio == ratio
        else cylinder.replace(rod_length=rod_length(cylinder.crank_radius, ratio))
        for cylinder in set(engine.cylinders)
    }
    return engine.replace(cylinder=[changed[cylinder] for cylinder in engine.cylinders])


def listed_orders(engine: Engine, spectrum: Iterable[int] | None) -> list[Order]:
    """Return the orders whose phasors a page has: of pistons, of a spectrum, and of shafts."""
    given = {order * speed for order in spectrum or () for speed in _speeds(engine)}
    return sorted({*_core.listed_orders(engine_core(engine)), *given})


def terms(
    engine: Engine, pairs: Sequence[tuple[int, complex]] | None, rpm: float
) -> dict[str, Any]:
    """Return the terms of an engine as a page has them, over the square of the crank's speed.

    ``planar`` has forward and backward parts of force and moment; ``torque`` the roll torque and,
    of an engine with gas pressure or loads, the moment of inertia of pistons and rods as seen from
    the crank; ``swept``, of each kind of cylinder with pressure, the volume that its piston adds
    per radian past its top dead centre; ``sizes`` what the cylinders make one by one; ``loads`` the
    terms of periodic loads, which other factors of the speed multiply. Complex values are pairs.

    Parameters
    ----------
    engine
        Engine at its own settings.
    pairs
        Spectrum in place of the pistons' own amplitudes; no torque follows from it.
    rpm
        Crank speed, which tables of loads must have.
    """
    ratios = RodRatios.of(engine)
    sampler = _Sampler(engine, pairs, _orders(engine, ratios, pairs))
    own = sampler.moving(None) if ratios.common is None else None
    count = FEWEST_POINTS if pairs is None else 1
    while True:
        q, points = ratios.points(count)
        sampled = [sampler.moving(ratio) for ratio in points.tolist()]
        fitted = {
            name: _factored(
                table,
                np.stack([each[name].values for each in sampled]),
                q,
                None if own is None else own[name].values,
            )
            for name, table in sampled[0].items()
        }
        if count in (1, MOST_POINTS) or all(enough for _, enough in fitted.values()):
            break
        count *= 2
    standing = sampler.standing()
    tables = {name: rows + standing.get(name, []) for name, (rows, _) in fitted.items()}
    return {
        "rod_ratios": [ratios.least, ratios.most, ratios.turning],
        "planar": tables.pop("planar"),
        "torque": tables.pop("torque", None),
        "swept": list(tables.values()),
        "sizes": dict(zip(SIZES, _core.sizes(engine_core(engine)), strict=True)),
        "loads": load_rows(engine, rpm, torque=pairs is None),
        "orders": listed_orders(engine, None if pairs is None else [n for n, _ in pairs]),
    }


def load_rows(engine: Engine, rpm: float, *, torque: bool) -> dict[str, Any]:
    """Return the rows of periodic loads: as others, and how each changes with the speed."""
    rows: dict[str, Any] = json.loads(_core.load_rows(engine_core(engine), rpm, torque))
    return rows


def has_halves(rows: Iterable[Row]) -> bool:
    """Return whether rows have a half order, which repeats after two turns."""
    return any(order % 1 for order, *_ in rows)


@dataclasses.dataclass(frozen=True)
class _Table:
    """Values by order, group and component at one rod ratio."""

    orders: Sequence[Order]
    powers: Sequence[int]
    """Powers of q with which orders begin."""
    values: Real
    relative: bool = False
    """Whether every order is precise in itself, and not only in the sum of all."""


class _Sampler:
    """Terms of an engine at different rod ratios, summed over groups of parts."""

    def __init__(
        self, engine: Engine, pairs: Sequence[tuple[int, complex]] | None, orders: list[Order]
    ) -> None:
        self.engine = engine
        self.pairs = pairs
        self.orders = orders
        self.driven = (engine.fired or bool(engine.loads)) and pairs is None
        # Orders of the fastest crank that has them, whose harmonics begin with the lowest power.
        self.multiples = [
            min((n // each for each in _speeds(engine) if n % each == 0), default=n) for n in orders
        ]

    def moving(self, ratio: float | None) -> dict[str, _Table]:
        """Return the terms of the cylinders at a rod ratio; None leaves each its own."""
        core = _core_at(self.engine, ratio)
        tables = self._tables(core, cylinders=True)
        if not self.driven:
            return tables
        orders = range(1, int(self.orders[-1]) + 1)
        powers = [min(n, HIGHEST_LISTED) - 1 for n in orders]
        for place in _core.fired_kinds(engine_core(self.engine)):
            swept = np.array(_core.swept(core, place, orders))
            tables[f"swept {place}"] = _Table(orders, powers, swept[:, None, None].view(float))
        torque, mean = tables["torque"], np.zeros((1, 3, 4))
        mean[0, 0, 2] = _core.mean_inertias(core).sum()
        values = np.concatenate([mean, torque.values])
        tables["torque"] = _Table([0, *torque.orders], [0, *torque.powers], values)
        return tables

    def standing(self) -> dict[str, list[Row]]:
        """Return the rows of counterweights and shafts, which no rod moves."""
        return {
            name: [
                [order, 0, [1], _parts(values, DIGITS), 1]
                for order, values in zip(table.orders, table.values, strict=True)
                if values.any()
            ]
            for name, table in self._tables(
                engine_core(self.engine).without_cycles(), cylinders=False
            ).items()
        }

    def _tables(self, core: _core.Engine, *, cylinders: bool) -> dict[str, _Table]:
        planar, torque = _core.group_terms(core, cylinders, self.orders, self.pairs)
        powers = [
            0 if self.pairs else max(0, int(min(n, HIGHEST_LISTED)) - 1) for n in self.multiples
        ]
        tables = {"planar": _Table(self.orders, powers, planar.view(float), relative=True)}
        if self.pairs is None:
            read = torque if self.driven else torque[:, :, :1].copy()
            powers = [max(0, power - 1) for power in powers]
            tables["torque"] = _Table(self.orders, powers, read.view(float))
        return tables


def _factored(table: _Table, values: Real, q: Real, own: Real | None) -> tuple[list[Row], bool]:
    """Return rows of values at Chebyshev's points q, and whether the points are enough.

    The values of an order change with the rod ratio in as few ways as there are kinds of cylinders:
    singular values separate them.
    """
    count, largest = len(q), abs(values).max()
    x = chebyshev.chebpts1(count)
    fit = chebyshev.chebvander(x, count - 1).T * (2.0 / count)
    fit[0] *= 0.5
    rows: list[Row] = []
    enough = True
    for k, (order, power) in enumerate(zip(table.orders, table.powers, strict=True)):
        scale = q[:, None] ** power
        matrix = values[:, k].reshape(count, -1) / scale
        if own is not None:
            middle = scale[count // 2]
            matrix = np.concatenate([matrix, own[k].reshape(1, -1) / middle])
        ways, weights, directions = np.linalg.svd(matrix, full_matrices=False)
        if not weights[0]:
            continue
        rank = int((weights > 10.0 * ROUNDING * weights[0]).sum())
        curves = ways[:, :rank] * weights[:rank]
        polynomials = fit @ curves[:count]
        allowed = ROUNDING * abs(polynomials).max()
        if not table.relative or order > HIGHEST_LISTED:
            allowed = max(allowed, ROUNDING * largest / float(scale[-1, 0]))
        enough = enough and bool((abs(polynomials[-count // 8 :]) <= 10.0 * allowed).all())
        polynomials[abs(polynomials) <= allowed] = 0.0
        decimals = -math.floor(math.log10(allowed))
        digits = math.ceil(math.log10(weights[0] / allowed))
        for way in range(rank):
            polynomial = np.trim_zeros(polynomials[:, way], "b").round(decimals).tolist()
            parts = _parts(directions[way].reshape(values.shape[2:]), digits)
            factor = [] if own is None else [float(curves[-1, way] * middle[0])]
            if parts and (polynomial or own is not None):
                rows.append([order, power, polynomial, parts, *factor])
    return rows, enough


def _parts(values: Real, digits: int) -> list[list[float]]:
    """Return group and values of the groups that have some."""
    rounded = values.round(digits)
    listed = [[group, *own.tolist()] for group, own in enumerate(rounded) if own.any()]
    return [[value or 0 for value in own] for own in listed]  # 0 is shorter than 0.0


def _orders(
    engine: Engine, ratios: RodRatios, pairs: Sequence[tuple[int, complex]] | None
) -> list[Order]:
    """Return the orders of cylinders or of a spectrum, of their cranks, and of shafts."""
    speeds = _speeds(engine)
    turning = {*speeds, *(abs(shaft.ratio) for shaft in engine.shafts)}
    if pairs is not None:
        return sorted({n * speed for n, _ in pairs for speed in speeds} | turning)
    return _core.orders_that_count(_core_at(engine, ratios.most))


def _speeds(engine: Engine) -> set[Order]:
    return {abs(ratio) for _, _, ratio in engine_core(engine).cranks[0]}


def _core_at(engine: Engine, ratio: float | None) -> _core.Engine:
    """Return the engine without gas at a rod ratio, or at its own."""
    return engine_core(at_rod_ratio(engine, ratio)).without_cycles()
