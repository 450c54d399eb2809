"""Bob weights, and counterweights fitted to what turns with the crankshaft, of engines and bays.

Forces and moments of order 1 over ω², in kg·m and kg·m²: one fit serves every speed.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.quantities import PLANE_VECTORS
from crankpin._support.record import read_only
from crankpin.analysis.balancing.planes import turning
from crankpin.analysis.request import engine_core
from crankpin.model.crankpins import bays
from crankpin.model.engine import Engine
from crankpin.model.shafts import unbalance_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.crankpins import Bay
    from crankpin.model.shafts import Unbalance

LARGEST_FACTOR = 10.0
Target: TypeAlias = Literal["external", "internal"]
Minimise: TypeAlias = Literal["squares", "largest"]


@dataclasses.dataclass(frozen=True)
class Fit:
    """What counterweights are to do, checked."""

    target: Target
    """Whether the whole engine's force and moment are to go, or those of each bay."""
    parts: tuple[tuple[str, float | None], ...]
    """Quantities that matter, with the share of the reciprocating mass to balance; None for all."""
    minimise: Minimise
    """What is least of weights that do the same."""
    length: float | None
    """Length by which moments compare with forces, m; None for the longest lever."""

    @classmethod
    def checked(cls, target: object, factor: object, minimise: object, length: object) -> Fit:
        """Return the options, or raise an InputError that names the argument at fault."""
        wanted = inputs.one_of("target", target, ["external", "internal"])
        comparing = inputs.optional_number("length", length)
        if comparing is not None and not 1e-6 <= comparing <= 1e6:
            raise inputs.rejected("length", comparing, "give a length in metres, 1e-6 to 1e6")
        return cls(
            wanted,  # type: ignore[arg-type]
            tuple(_parts(factor).items()),
            inputs.one_of("minimise", minimise, ["squares", "largest"]),  # type: ignore[arg-type]
            comparing,
        )


def _parts(given: object) -> dict[str, float | None]:
    if given is None or not isinstance(given, Mapping):
        by_name = dict.fromkeys(PLANE_VECTORS, given)
    else:
        by_name = dict(given)
        for name in by_name:
            inputs.one_of("factor", name, PLANE_VECTORS)
        if not by_name:
            hint = 'give a number, or {"force": 0.5, "moment": 0.5}'
            raise inputs.rejected("factor", given, hint)
    parts = {name: inputs.optional_number("factor", part) for name, part in by_name.items()}
    for part in parts.values():
        if part is not None:
            check_factor("factor", part)
    return parts


class Fitted(NamedTuple):
    """Unbalances with the names of their planes."""

    unbalances: tuple[tuple[str, Unbalance], ...]
    exact: bool
    """True if they are proved to do all that was wanted."""
    missing: float
    """Part of what was wanted that they do not do, but for rounding."""


# --- bob weights ----------------------------------------------------------------------------------


def check_factor(name: str, factor: ArrayLike) -> None:
    """Raise an InputError unless factors are shares of the reciprocating mass."""
    listed = np.asarray(factor)
    if not ((listed >= 0.0) & (listed <= LARGEST_FACTOR)).all():
        hint = f"give a share of the reciprocating mass, 0 to {LARGEST_FACTOR:g}, such as 0.5"
        if not listed.ndim and LARGEST_FACTOR < listed <= 100.0:
            hint += f"; {listed:g} % is {listed / 100.0:g}"
        raise inputs.rejected(name, factor, hint)


def with_bob_weights(engine: Engine, factor: float) -> Engine:
    """Return the engine with counterweights that balance a bob weight at each crankpin.

    They are opposite the crankpins, in place of the counterweights that it has: all of the rotating
    and ``factor`` of the reciprocating mass.
    """
    return Engine(_core.with_bob_weights(engine_core(engine), factor))


# --- the whole engine ---------------------------------------------------------------------------


def external(
    engine: Engine,
    planes: Mapping[str, float],
    bounds: Mapping[str, float],
    angles: Mapping[str, tuple[str, ...]] | None,
    fit: Fit,
) -> Fitted:
    """Return the weights that remove the most of an engine's forward force and moment."""
    names, places = list(planes), list(planes.values())
    allowed = None
    if angles is not None:
        allowed = [
            np.deg2rad([inputs.degrees(angle) for angle in angles[name]]).tolist() for name in names
        ]
    found, reached, missing = _core.fit_weights(
        engine_core(engine),
        places,
        [bounds[name] for name in names],
        allowed,
        fit.parts,
        fit.length,
        fit.minimise,
    )
    unbalances = []
    for place, angle, each in found:
        weight = unbalance_of(each)
        if angles is not None:
            weight = dataclasses.replace(weight, angle_deg=angles[names[place]][angle])
        unbalances.append((names[place], weight))
    usable = [z for name, z in planes.items() if bounds[name] > 0.0]
    exact = reached and can_remove(engine, usable, fit)
    return Fitted(tuple(unbalances), exact, 0.0 if exact else missing)


def can_remove(engine: Engine, places: list[float], fit: Fit) -> bool:
    """Return whether weights of any size at these places can do all that is wanted.

    Decided without floating-point sums. A weight u at z makes the force u and the moment
    i(z − z₀)·u: two equations, whose rank is the number of different places, up to two. So two
    places serve any force and moment. One place z serves a force, or a moment if it is not z₀; it
    serves both if there is no forward moment about z itself, which is proved in integers.
    """
    different, plane = sorted(set(places)), engine.reference_z
    factors = dict(fit.parts)
    engines = {
        name: [engine] if factor is None else [engine, left_by(engine, factor)]
        for name, factor in factors.items()
    }
    wanted = [name for name in factors if not all(_vanishes(e, name, plane) for e in engines[name])]
    if not wanted or len(different) >= 2:
        return True
    if not different:
        return False
    (z,) = different
    if len(factors) == 1:
        return wanted == ["force"] or z != plane
    beside = all(_vanishes(each, "moment", z) for each in engines["moment"])
    return beside and (factors["force"] == factors["moment"] or z == plane)


def left_by(engine: Engine, factor: float) -> Engine:
    """Return the engine that bob weights leave, without shafts: its forward part is to stay."""
    return with_bob_weights(engine, factor).with_shafts(())


def _vanishes(engine: Engine, quantity: str, plane: float) -> bool:
    """Return whether the forward part of order 1 is proved to vanish."""
    found = engine.vanishing_orders([1], reference_z=plane)
    return bool(getattr(found, quantity).forward[1] == "vanishes")


# --- bay by bay -----------------------------------------------------------------------------------


def internal(
    engine: Engine,
    planes: Mapping[str, float],
    bounds: Mapping[str, float],
    angles: Mapping[str, tuple[str, ...]] | None,
    fit: Fit,
) -> Fitted:
    """Return the weights that remove the most of each bay's forward force and moment."""
    listed = bays(engine)
    inside = [_between(bay, planes) for bay in listed]
    for name, z in planes.items():
        if not any(name in each for each in inside):
            ends = f"{listed[0].bearings[0]:.6g} to {listed[-1].bearings[1]:.6g} m"
            hint = 'for target="internal" give places between those of a throw'
            hint = f"is beyond the main bearings ({ends}); {hint}"
            raise inputs.faulty(f'planes["{name}"]', f"= {z:.6g}", hint)
    found = [
        external(
            alone,
            within,
            bounds,
            angles,
            dataclasses.replace(
                fit,
                target="external",
                length=fit.length or (bay.bearings[1] - bay.bearings[0]) / 2.0,
            ),
        )
        if within
        else Fitted((), exact=False, missing=1.0)
        for bay, alone, within in zip(listed, _of_bays(engine), inside, strict=True)
    ]
    return Fitted(
        tuple(one for each in found for one in each.unbalances),
        all(each.exact for each in found),
        max(each.missing for each in found),
    )


def _between(bay: Bay, planes: Mapping[str, float]) -> dict[str, float]:
    return {name: z for name, z in planes.items() if bay.holds(z)}


def bay_loads(engine: Engine) -> NDArray[np.complex128]:
    """Return what each throw exerts on its main bearings: forward force and moment, (n_bays, 2)."""
    found = [turning(each, 1) for each in _of_bays(engine)]
    return read_only(np.array(found, dtype=np.complex128))


def _of_bays(engine: Engine) -> list[Engine]:
    """Return each bay with what rotates there: engines of their throws, about them."""
    return list(map(Engine, engine._core.of_bays()))
