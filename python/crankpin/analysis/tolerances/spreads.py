"""Spreads of an engine's figures, checked, and deviations drawn by NumPy."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin._support import inputs, labels, lazy, units
from crankpin.analysis.request import engine_core
from crankpin.model.crankpins import crankpins
from crankpin.model.shafts import Unbalance

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Engine

Distribution: TypeAlias = Literal["normal", "uniform"]
FIGURES = tuple(labels.TOLERANCES)
"""Figures that may spread, in the order of the core."""
OF_PINS = ("crank_radius", "pin_deg")
"""Figures of a crankpin; the others are of a cylinder."""
SPREADS = {"normal": "standard deviations", "uniform": "half widths"}
"""Distribution → what its spreads are."""


@dataclasses.dataclass(frozen=True)
class Spreads:
    """Spread of each figure of an engine, checked."""

    values: tuple[tuple[float, ...], ...]
    """For each of :data:`FIGURES` one of each cylinder or crankpin; empty where none was given."""
    distribution: Distribution
    """``"normal"`` or ``"uniform"``."""
    pins: tuple[tuple[int, ...], ...]
    """Numbers of the cylinders on each crankpin."""

    @classmethod
    def checked(
        cls,
        engine: Engine,
        amounts: Mapping[str, ArrayLike],
        distribution: str,
        pins: Iterable[Iterable[int]] | None,
    ) -> Spreads:
        """Return spreads, or raise an InputError that names the argument at fault."""
        word = inputs.one_of("distribution", distribution, SPREADS)
        engine_core(engine)
        shared = (pin.cylinders for pin in crankpins(engine))
        groups = tuple(shared) if pins is None else _pins(engine, pins)
        values = []
        for name in FIGURES:
            items, count = (
                ("crankpin", len(groups)) if name in OF_PINS else ("cylinder", len(engine))
            )
            spreads = inputs.per_item(name, amounts[name], count)
            if len(spreads) != count:
                raise inputs.faulty(
                    name,
                    f"has {len(spreads)} entries, the engine has {count} {items}s",
                    f"give one number, or one for each {items}",
                )
            for spread in spreads:
                if not (math.isfinite(spread) and spread >= 0.0):
                    raise inputs.rejected(name, spread, "give a spread that is zero or more")
            values.append(tuple(spreads) if any(spreads) else ())
        return cls(tuple(values), word, groups)  # type: ignore[arg-type] # one of the two words

    def only(self, name: str) -> Spreads:
        """Return the spreads of one figure, the others zero."""
        pairs = zip(FIGURES, self.values, strict=True)
        return dataclasses.replace(
            self, values=tuple(values if figure == name else () for figure, values in pairs)
        )

    @property
    def given(self) -> tuple[str, ...]:
        """Names of the figures that spread."""
        return tuple(name for name, widths in zip(FIGURES, self.values, strict=True) if widths)

    @property
    def pin_of(self) -> list[int]:
        """Place of each cylinder's crankpin in ``pins``."""
        places = {number: k for k, pin in enumerate(self.pins) for number in pin}
        return [places[number] for number in sorted(places)]

    @property
    def text(self) -> units.Text:
        """The spreads in words."""
        parts = list[str]()
        for name in self.given:
            spreads = self.values[FIGURES.index(name)]
            title, unit = labels.TOLERANCES[name]
            ends = min(spreads), max(spreads)
            if unit == "°":
                parts.append(f"{title} {' to '.join(f'{end:.4g}' for end in dict.fromkeys(ends))}°")
            else:
                parts.append(units.Text(f"{title} ", units.figure(ends[0], unit, 4, ends[1])))
        return units.Text(f"{SPREADS[self.distribution]}: ", units.joined(", ", parts))


def deviating(
    engine: Engine,
    cylinders: Sequence[Cylinder],
    rotating: NDArray[np.float64],
    **changes: Any,  # noqa: ANN401 - of Engine.replace
) -> Engine:
    """Return an engine with other cylinders, rotating masses and figures.

    A throw that is balanced may be too light: its rotating mass below zero is an unbalance opposite
    its pin.
    """
    places = changes.get("z", engine.z)
    opposite = [
        Unbalance(-mass * cylinders[k].crank_radius, float(places[k]), 180, pin=k + 1)
        for k, mass in enumerate(rotating.tolist())
        if mass < 0.0
    ]
    return engine.replace(
        cylinder=cylinders,
        rotating_mass=np.maximum(rotating, 0.0),
        counterweights=[*engine.counterweights, *opposite],
        **changes,
    )


def _pins(engine: Engine, groups: Iterable[Iterable[int]]) -> tuple[tuple[int, ...], ...]:
    hint = "give the numbers of the cylinders on each crankpin, such as [[1, 2], [3, 4]]"
    pins = tuple(
        tuple(inputs.whole("pins", number) for number in inputs.items("pins", pin, hint))
        for pin in inputs.items("pins", groups, hint)
    )
    if sorted(number for pin in pins for number in pin) != [*range(1, len(engine) + 1)]:
        raise inputs.rejected("pins", pins, f"name each cylinder once; {hint}")
    for pin in pins:
        if not engine_core(engine).pins_agree(pin):
            raise inputs.rejected(
                "pins",
                pins,
                f"the crankpins of cylinders {inputs.shorten(pin)} do not point the same way; give "
                "them pins of their own",
            )
    return pins


PIECE_DRAWS = 2**20
"""Random numbers drawn between checks for Ctrl-C."""


def deviations(spreads: Spreads, samples: int, seed: int) -> dict[str, NDArray[np.float64]]:
    """Return the deviations of each figure: (n_samples, n_items), empty where it does not spread.

    Each figure has a generator of its own, spawned from the seed, that draws sample after sample:
    a sample does not depend on how many follow, nor on what else spreads.
    """
    deviations, numbers = {}, lazy.imported("numpy.random")
    for stream, (name, widths) in enumerate(zip(FIGURES, spreads.values, strict=True)):
        random = numbers.default_rng(numbers.SeedSequence(seed, spawn_key=(stream,)))
        values = np.empty((samples if widths else 0, len(widths)))
        rows = PIECE_DRAWS // max(len(widths), 1)
        for start in range(0, len(values), rows):
            piece = values[start : start + rows]
            if spreads.distribution == "normal":
                random.standard_normal(out=piece)
            else:
                random.random(out=piece)
                piece *= 2.0
                piece -= 1.0
            piece *= widths
        values.setflags(write=False)
        deviations[name] = values
    return deviations
