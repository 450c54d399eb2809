"""Parts of an engine that turn with a shaft, and weights in planes that exert such parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from crankpin import _core
from crankpin.analysis.request import engine_core
from crankpin.model.shafts import unbalance_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Unbalance


class Turning(NamedTuple):
    """Force and moment that turn with a shaft, as vectors x + iy at θ = 0, over ω²."""

    force: complex
    """Force, kg·m."""
    moment: complex
    """Moment about the reference plane, kg·m²."""


def turning(engine: Engine, ratio: int) -> Turning:
    """Return the part of an engine's force and moment that turns with a shaft of this ratio."""
    return Turning(*_core.turning(engine_core(engine), ratio))


def weights_in(engine: Engine, wanted: Turning, z: Sequence[float]) -> tuple[Unbalance, ...]:
    """Return the weights in planes that exert a force and a moment, or come closest to them.

    From two different planes on both are exerted; of more planes the weights are those with the
    smallest sum of squares. In a single plane the sum of the squares of what is missed is least,
    moments counted over half the engine's length.

    Parameters
    ----------
    engine
        The engine.
    wanted
        Force, kg·m, and moment about the reference plane, kg·m².
    z
        Places of the planes, m.
    """
    length = _core.half_length(engine.core)
    found = _core.unbounded_weights(wanted, list(z), engine.reference_z, length)
    return tuple(map(unbalance_of, found))


def ends(engine: Engine) -> tuple[float, ...]:
    """Return the places of the first and the last cylinder, m; one if they agree."""
    first, last = float(engine.z.min()), float(engine.z.max())
    return (first, last) if first < last else (first,)
