"""The card of a balancing shop: weighed parts, bob weights of several factors, and residuals."""

from __future__ import annotations

import html
from collections.abc import Mapping
from functools import cached_property
from string import Template
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import files, inputs, labels, units
from crankpin._support.frames import Frames, Tabled
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.tables import Column, Table
from crankpin.analysis.request import engine_core

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from crankpin.analysis.balancing.bob_weight import BobWeight
    from crankpin.model.engine import Engine

PARTS = {
    "piston": "reciprocating",
    "pin": "reciprocating",
    "locks": "reciprocating",
    "rings": "reciprocating",
    "small end": "reciprocating",
    "big end": "rotating",
    "bearings": "rotating",
}
"""Part of a cylinder that is weighed → what it counts as."""
RECIPROCATING, ROTATING = "reciprocating", "rotating"
RODS = {"small end": RECIPROCATING, "big end": ROTATING}
"""End of a rod → what it counts as."""
G_MM_PER_KG_M = 1e6
"""Gram millimetres to a kg·m."""
EQUAL_FACTORS = 1e-12
"""Differences of factors, and parts of the longest vector, that are rounding."""
PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>$title</title>
<style>
body { font: 10pt/1.3 system-ui, sans-serif; max-width: 19cm; margin: 1cm auto; }
h1 { font-size: 14pt; margin: 0 0 4mm; }
table { border-collapse: collapse; width: 100%; margin: 0 0 4mm; break-inside: avoid; }
caption { text-align: left; font-weight: bold; padding: 1mm 0; }
th, td { border-bottom: 0.2mm solid #999; padding: 0.7mm 1.2mm; text-align: right; }
th:first-child, td:first-child { text-align: left; }
th { border-bottom: 0.4mm solid #000; }
th { vertical-align: bottom; hyphens: auto; }
table:has(th:nth-child(10)) { font-size: 8.5pt; }
table:has(th:nth-child(10)) :is(th, td) { padding: 0.7mm; }
table:has(th:nth-child(13)) { font-size: 7pt; }
table:has(th:nth-child(17)) { font-size: 6pt; }
table:has(th:nth-child(13)) :is(th, td) { padding: 0.4mm; }
table:has(th:nth-child(13)) th:nth-child(n + 4) { font-size: .8em; }
p { margin: 0 0 4mm; }
@page { size: auto; margin: 12mm; }
@media print { body { margin: 0; max-width: none; } }
@media screen and (max-width: 20cm) {
  body { margin: 4mm; }
  table { display: block; overflow-x: auto; }
}
</style>
</head>
<body>
<h1>$title</h1>
$tables
</body>
</html>
""")


def weighed(engine: Engine, parts: object) -> dict[str, NDArray[np.float64]]:
    """Return the mass of each part of each cylinder, kg: part → (n_cylinders,).

    Of an engine whose parts are not given, its reciprocating and rotating masses.
    """
    if not isinstance(parts, Mapping):
        hint = f"give a mapping of parts to kilograms: {', '.join(PARTS)}"
        raise inputs.rejected("parts", parts, hint)
    by_kind = {}
    for name, mass in parts.items():
        part = inputs.one_of("parts", str(name).replace("_", " "), PARTS)
        masses = np.array(inputs.per_item(f"parts[{name!r}]", mass, len(engine)))
        if len(masses) != len(engine):
            hint = f"give one, or {len(engine)}"
            raise inputs.faulty(f"parts[{name!r}]", f"has {len(masses)} masses", hint)
        if not ((masses >= 0.0) & (masses <= 1e6)).all():
            raise inputs.rejected(f"parts[{name!r}]", mass, "give kilograms, 0 or more")
        by_kind[part] = masses
    return {part: by_kind[part] for part in PARTS if part in by_kind}


def from_rods(
    engine: Engine, parts: Mapping[str, NDArray[np.float64]]
) -> dict[str, NDArray[np.float64]]:
    """Return the ends of the engine's rods that were not weighed though other such parts were."""
    rods = [cylinder.rod for cylinder in engine.cylinders]
    if any(rod is None for rod in rods):
        return {}
    return {
        end: np.array([getattr(rod, f"{kind}_mass") for rod in rods])
        for end, kind in RODS.items()
        if end not in parts and any(PARTS[part] == kind for part in parts)
    }


def remarks(bob: BobWeight) -> str:
    """Return what of the masses of a bob weight is not known, and what is the engine's."""
    kinds = {PARTS[part] for part in bob.parts}
    left_out = [part for part, kind in PARTS.items() if kind in kinds and part not in bob.parts]
    texts = []
    if bob.of_rods:
        texts.append(f"Not weighed, but of the engine's rods: {', '.join(bob.of_rods)}.")
    if left_out:
        texts.append(f"Not weighed, and not counted: {', '.join(left_out)}.")
    big_ends = bob.engine.rotating_mass
    if not all(any(big_ends[i - 1] for i in pin.cylinders) for pin in bob.crankpins):
        texts.append(
            "Rotating masses are not known: bob weights lack the big ends and bearings, which are "
            "balanced wholly."
        )
    if bob._masses_at(0.0)[:, 3].any():
        texts.append(
            "Across: what acts a quarter of a turn ahead of the crankpin, at its radius, of big "
            "ends of link rods; no weight clamped to the crankpin has it."
        )
    return " ".join(texts)


def with_parts(engine: Engine, parts: Mapping[str, NDArray[np.float64]]) -> Engine:
    """Return an engine of these parts; a kind of which none is given stays as it is."""
    sums = {
        kind: np.sum([parts[part] for part in parts if PARTS[part] == kind], axis=0)
        for kind in {PARTS[part] for part in parts}
    }
    # To the nanogram, which leaves 0.65 + 0.18 its decimals.
    rounded = {kind: masses.round(12).tolist() for kind, masses in sums.items()}
    if RECIPROCATING in rounded:
        pairs = zip(engine.cylinders, rounded[RECIPROCATING], strict=True)
        moving = [one.replace(reciprocating_mass=mass) for one, mass in pairs]
        rotating = rounded.get(ROTATING, engine.rotating_mass.tolist())
        return engine.replace(cylinder=moving, rotating_mass=rotating)
    return engine.replace(rotating_mass=rounded[ROTATING]) if rounded else engine


def remarks_by_factor(
    factors: Iterable[float], remarks: Iterable[tuple[float, str]]
) -> dict[float, str]:
    """Return factors and their remarks, and those of others; factors rounding apart are one."""
    words: dict[float, list[str]] = {factor: [] for factor in factors}
    for factor, text in remarks:
        # 0.5 comes out as 0.49999999999999994 at times.
        near = next((marked for marked in words if abs(marked - factor) < EQUAL_FACTORS), factor)
        words.setdefault(near, []).append(text)
    return {factor: ", ".join(filter(None, texts)) for factor, texts in words.items()}


class Card(Tabled):
    """Card of a balancing shop, made by :meth:`crankpin.results.BobWeight.card`.

    Frames: ``table``, the weighed parts; ``bob weights`` of every crankpin; ``residual`` at a speed
    by balance factor; and, where planes are given, ``correction``.
    """

    bob: BobWeight
    """The bob weights."""
    factors: tuple[float, ...]
    """Balance factors compared."""
    rpm: float
    """Crank speed of the residuals."""
    sides: tuple[str, str]
    """Words for right and left of the engine, seen from the flywheel."""
    planes: tuple[tuple[str, float, float | None, int], ...]
    """Planes of the correction: name, place along the crank, m, radius, m, or None, and crank."""
    balanced_to: tuple[float, ...] | None
    """Bob weight to which the crankshaft is balanced now, of each crankpin, kg; None if unknown."""

    @property
    def table(self) -> Table:
        """Table of the weighed parts."""
        bob, engine = self.bob, self.bob.engine
        shares = f"{', '.join(f'{100.0 * factor:.6g}' for factor in self.factors)} %"
        rows: list[tuple[str, str, str, NDArray[np.float64]]] = [
            (part, PARTS[part], shares if PARTS[part] == RECIPROCATING else "100 %", masses)
            for part, masses in bob.parts.items()
        ]
        moving = np.array([cylinder.reciprocating_mass for cylinder in engine.cylinders])
        for kind, share, masses in (
            (RECIPROCATING, shares, moving),
            (ROTATING, "100 %", engine.rotating_mass),
        ):
            rows.append((f"all {kind}", kind, share, masses))
        alike = all(not np.ptp(masses) for *_, masses in rows)
        numbers = np.array([1e3 * masses for *_, masses in rows])
        heads = ["each cylinder"] if alike else [f"cylinder {k + 1}" for k in range(len(engine))]
        return Table.from_rows(
            f"{labels.name_of(engine)}: weighed parts",
            ["part", "counts as", "share", *((head, "g") for head in heads)],
            [row[:3] for row in rows],
            numbers[:, :1] if alike else numbers,
            decimals=1,
            note=remarks(bob),
        )

    @property
    def frames(self) -> Frames:
        """``table``, ``bob weights``, ``residual``; ``correction`` where planes are given."""
        further: dict[str, Any] = {"bob weights": self._bob_weights, "residual": self._residual}
        if self.planes:
            further["correction"] = self._correction
        return self._frames(**further)

    def _bob_weights(self) -> Table:
        bob = self.bob
        oil = np.full(len(bob.crankpins), bob.oil)
        masses = [bob.rotating, bob.reciprocating, oil]
        heads = ["rotating", "reciprocating", "oil"]
        for factor in self.factors:
            *_, bob_weight, across = bob._masses_at(factor).T
            heads.append(f"at {100.0 * factor:.6g} %")
            masses.append(bob_weight)
            if across.any():
                heads.append("across")
                masses.append(across)
        return Table.from_rows(
            "Bob weight of each crankpin",
            ["cylinders", ("crankpin", "°"), *((head, "g") for head in heads)],
            [(", ".join(map(str, pin.cylinders)), pin.pin_deg) for pin in bob.crankpins],
            1e3 * np.stack(masses, axis=1),
            decimals=1,
            note=remarks(bob),
        )

    @cached_property
    def _by_factor(self) -> dict[float, str]:
        """Factors of the card, and those that leave a straight line, with a remark."""
        straight = (
            (factor, f"straight line of the {name}")
            for name in PLANE_VECTORS
            for factor, _ in self.bob.straight_line_factors(name)
        )
        return remarks_by_factor(self.factors, straight)

    def _residual(self) -> Table:
        bob, factors = self.bob, sorted(self._by_factor)
        columns = [
            Column("factor", tuple(100.0 * factor for factor in factors), "%"),
            Column("", tuple(self._by_factor[factor] for factor in factors)),
        ]
        omega_squared = _core.angular_speed(self.rpm) ** 2
        for name in PLANE_VECTORS:
            if not bob._first_order.exists(name):
                continue
            longest, shortest = (omega_squared * axis for axis in bob.half_axes(name, factors))
            shortest[abs(shortest) < EQUAL_FACTORS * longest.max()] = 0.0
            unit = QUANTITIES[name].unit
            words = tuple(self._direction(name, factor) for factor in factors)
            columns += [
                Column(f"{name}, longest", longest, unit, digits=4),
                Column("shortest", abs(shortest), unit, digits=4),
                Column("direction of the longest" if name == "force" else "ends move", words),
            ]
        nothing = "Nothing of order 1 is left at any factor"
        if bob._first_order.has_roll():
            about = labels.about_axis(engine_core(bob.engine).cranks[0])
            torques = (omega_squared * bob._first_order.roll(factors)).tolist()
            if about:
                columns.append(Column(f"roll torque{about}", tuple(torques), "N·m", digits=4))
            torque = units.figure(torques[0], "N·m", 4)
            nothing = units.Text(nothing, " but a roll torque of ", torque)
            nothing = units.Text(nothing, ", which no weight changes")
        title = f"What order 1 leaves {labels.at_speed(self.rpm)}, half axes"
        note = "" if len(columns) > 2 else units.Text(nothing, ".")
        return Table(title, tuple(columns), note)

    def _direction(self, quantity: str, factor: float) -> str:
        """Return in words which way the longest half axis points, of a moment which way ends go."""
        return self.bob._first_order.direction(quantity, factor, self.sides)

    def _correction(self) -> Table:
        names, places, at, cranks = zip(*self.planes, strict=True)
        radii = None if None in at else at
        core = engine_core(self.bob.engine)
        heads: list[tuple[str, str, int | None]] = [
            ("factor", "", None),
            ("plane", "", None),
            ("z", "m", None),
            ("unbalance", "g·mm", 0),
            ("add at", "°", 1),
            ("or drill at", "°", 1),
        ]
        if radii is not None:
            heads += [("radius", "mm", None), ("weight", "g", 1), ("as heavy metal", "g", 1)]
        rows: list[tuple[Any, ...]] = []
        for factor in self.factors:
            share = f"{100.0 * factor:.6g} %"
            for weight in _core.corrections(
                core,
                factor,
                list(zip(places, cranks, strict=True)),
                radii,
                self.bob.oil,
                self.balanced_to,
            ):
                plane, mass, slug = weight["plane"], weight["mass"], weight["heavy_metal"]
                amount = G_MM_PER_KG_M * weight["amount"]
                row: tuple[Any, ...] = (share, names[plane], places[plane], amount)
                row += (weight["add_at_deg"], weight["drill_at_deg"])
                if radii is not None and mass is not None and slug is not None:
                    row += (1e3 * radii[plane], 1e3 * mass, 1e3 * slug)
                rows.append(row)
        cells = zip(*rows, strict=True) if rows else [()] * len(heads)
        columns = [
            Column(name, values, unit, decimals=decimals)
            for (name, unit, decimals), values in zip(heads, cells, strict=True)
        ]
        has = "from nothing"
        if self.balanced_to is not None:
            has = "from the bob weight it has"
        elif self.bob.engine.counterweights:
            has = "from the counterweights it has"
        note = "" if rows else "Nothing is to be added or drilled away."
        return Table(f"Correction of the crankshaft, {has}", tuple(columns), note)

    def save_html(self, path: str | Path) -> None:
        """Write the card as one page for any browser, whose print is one page, or a PDF.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.html``.

        Raises
        ------
        InputError
            If the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        file = inputs.file_path(path, (".html", ".htm"), "a page ends in .html")
        title = f"{labels.name_of(self.bob.engine)}: bob weights"
        files.write(
            file, PAGE.substitute(title=html.escape(title), tables=self.frames._repr_html_())
        )
