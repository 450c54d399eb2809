"""Bob weights, and counterweights fitted to the forward part of order 1 of engines and bays.

Forces and moments of order 1 over ω², in kg·m and kg·m²: one fit serves every speed.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.messages import Hint, warn
from crankpin._support.quantities import PLANE_VECTORS
from crankpin._support.record import read_only
from crankpin.analysis.request import engine_core
from crankpin.model.crankpins import bays
from crankpin.model.engine import Engine
from crankpin.model.shafts import unbalance_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.balancing.planes import Place
    from crankpin.model.shafts import Unbalance

LARGEST_FACTOR = 10.0
Target: TypeAlias = Literal["external", "internal", "half cranks"]
TARGETS = ["external", "internal", "half cranks"]
Keep: TypeAlias = Literal["vanishing"] | Sequence[Literal["force", "moment"]]
Minimise: TypeAlias = Literal["squares", "largest"]


@dataclasses.dataclass(frozen=True)
class Fit:
    """Checked request of a fit of counterweights."""

    target: Target
    """Whether the whole engine's force and moment are to go, or those of each bay."""
    parts: tuple[tuple[str, float | None], ...]
    """Quantities that matter, with the share of the reciprocating mass to balance; None for all."""
    minimise: Minimise
    """Quantity minimised among equivalent weights."""
    length: float | None
    """Length by which moments compare with forces, m; None for the longest lever."""
    keep: tuple[str, ...] | None = None
    """Sums of the engine that weights of bays must not change; None for those that vanish."""

    @classmethod
    def checked(
        cls, target: object, factor: object, minimise: object, length: object, keep: object
    ) -> Fit:
        """Return the options, or raise an InputError that names the argument at fault."""
        wanted = inputs.one_of("target", target, TARGETS)
        parts = _kept(keep)
        if wanted == "external" and parts is not None:
            hint = "leave it out: external weights remove these sums"
            raise inputs.rejected("keep", keep, hint)
        comparing = inputs.optional_number("length", length)
        if comparing is not None and not 1e-6 <= comparing <= 1e6:
            raise inputs.rejected("length", comparing, "give a length in metres, 1e-6 to 1e6")
        return cls(
            wanted,  # type: ignore[arg-type]
            tuple(_parts(factor).items()),
            inputs.one_of("minimise", minimise, ["squares", "largest"]),  # type: ignore[arg-type]
            comparing,
            parts,
        )


def _kept(value: object) -> tuple[str, ...] | None:
    if isinstance(value, str):
        inputs.one_of("keep", value, ["vanishing"])
        return None
    hint = 'give "vanishing", or a list of "force" and "moment", which may be empty'
    names = inputs.items("keep", value, hint)
    return tuple(inputs.one_of("keep", name, PLANE_VECTORS) for name in names)


def _parts(value: object) -> dict[str, float | None]:
    if value is None or not isinstance(value, Mapping):
        by_name = dict.fromkeys(PLANE_VECTORS, value)
    else:
        by_name = dict(value)
        for name in by_name:
            inputs.one_of("factor", name, PLANE_VECTORS)
        if not by_name:
            hint = 'give a number, or {"force": 0.5, "moment": 0.5}'
            raise inputs.rejected("factor", value, hint)
    parts = {name: inputs.optional_number("factor", part) for name, part in by_name.items()}
    for part in parts.values():
        if part is not None:
            check_factor("factor", part)
    return parts


class Fitted(NamedTuple):
    """Unbalances with the names of their planes."""

    unbalances: tuple[tuple[str, Unbalance], ...]
    exact: bool
    """True if they are proved to reach the whole target."""
    missing: float
    """Share of the target that they miss, apart from rounding."""


# --- bob weights ----------------------------------------------------------------------------------


def check_factor(name: str, factor: ArrayLike) -> None:
    """Raise an InputError unless factors are shares of the reciprocating mass."""
    factors = np.asarray(factor)
    if not factors.size or not ((factors >= 0.0) & (factors <= LARGEST_FACTOR)).all():
        hint = f"give a share of the reciprocating mass, 0 to {LARGEST_FACTOR:g}, such as 0.5"
        if not factors.ndim and LARGEST_FACTOR < factors <= 100.0:
            hint += f"; {factors:g} % is {factors / 100.0:g}"
        raise inputs.rejected(name, factor, hint)


def with_bob_weights(engine: Engine, factor: float) -> Engine:
    """Return the engine with counterweights that balance a bob weight at each crankpin.

    They are opposite the crankpins, in place of the counterweights that it has: all of the rotating
    and ``factor`` of the reciprocating mass.
    """
    return Engine(_core.with_bob_weights(engine_core(engine), factor))


# --- fits -----------------------------------------------------------------------------------------


def fitted(
    engine: Engine,
    planes: Mapping[str, Place],
    bounds: Mapping[str, float],
    angles: Mapping[str, tuple[str, ...]] | None,
    fit: Fit,
) -> Fitted:
    """Return the weights that remove the most of what turns with the cranks that have planes."""
    names = list(planes)
    if fit.target != "external":
        _check_between(engine, planes, fit.target)
    allowed = None
    if angles is not None:
        allowed = [
            np.deg2rad([inputs.degrees(angle) for angle in angles[name]]).tolist() for name in names
        ]
    weights, exact, missing = _core.fit_weights(
        engine_core(engine),
        list(planes.values()),
        [bounds[name] for name in names],
        allowed,
        fit.parts,
        fit.length,
        fit.minimise,
        fit.target,
        fit.keep,
    )
    unbalances = []
    for place, angle, unbalance in weights:
        weight = unbalance_of(unbalance)
        if angles is not None:
            weight = weight.replace(angle_deg=angles[names[place]][angle])
        unbalances.append((names[place], weight))
    return Fitted(tuple(unbalances), exact, missing)


def left_by(engine: Engine, factor: float) -> Engine:
    """Return the engine that bob weights leave, without shafts: its cranks' own part is to stay."""
    return with_bob_weights(engine, factor).with_shafts(())


def _check_between(engine: Engine, planes: Mapping[str, Place], target: Target) -> None:
    """Raise an InputError of a plane that is in no bay."""
    for name, (z, crank) in planes.items():
        of_crank = [bay for bay in bays(engine) if bay.crank == crank]
        if of_crank and not any(bay.holds(z, crank) for bay in of_crank):
            ends = f"{of_crank[0].bearings[0]:.6g} to {of_crank[-1].bearings[1]:.6g} m"
            between = f'for `target="{target}"` give places between those of a throw'
            hint = Hint.of(f"is beyond the main bearings ({ends}); {between}")
            raise inputs.faulty(f'planes["{name}"]', f"= {z:.6g}", hint)


def bay_loads(engine: Engine) -> NDArray[np.complex128]:
    """Return what each throw exerts on its main bearings: force and moment, (n_bays, 2)."""
    loads = np.array(_core.bay_loads(engine_core(engine)), dtype=np.complex128)
    return read_only(loads.reshape(-1, 2))


# --- what hardware must not bring about ---------------------------------------------------------

APPEARING = {"force": "shaking force", "moment": "rocking moment", "torque": "roll torque"}


def warn_of_appearing(engine: Engine, with_hardware: _core.Engine) -> None:
    """Warn of orders that vanish in an engine and not in the same with other hardware."""
    appearing = _core.appearing(engine_core(engine), with_hardware)
    if appearing:
        words = [f"{APPEARING[name]} of order {order}" for order, name in appearing]
        about = f"{labels.name_of(engine)}: the fitted engine"
        warn(about, f"has a {' and a '.join(words)}, which vanishes without this hardware")
