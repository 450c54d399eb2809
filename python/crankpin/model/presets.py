"""Engines by name: the layouts that come ready-made, and where each is from.

The catalogue is one table, :data:`CATALOGUE`; an engine is built when it is asked for. Angles and
sides are the package's: seen from the flywheel, the crank turning counter-clockwise, throws in the
direction of rotation. What the source leaves open (which side has cylinder 1, how long the rods
are) is chosen here and called nominal.
"""

from __future__ import annotations

import cmath
import difflib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from crankpin._support.inputs import Angle

Build: TypeAlias = Callable[[float], Engine]
"""Makes the engine of a given spacing between neighbouring throws, the front one at z = 0."""


@dataclass(frozen=True, slots=True)
class Preset:
    """An engine of the catalogue."""

    name: str
    """By which it is asked for: lower case, hyphens."""
    title: str
    """Its ``Engine.name``."""
    description: str
    """One line."""
    source: str
    """Its ``Engine.source``: where the layout is from."""
    build: Build
    spacing: float = 0.1
    """Between neighbouring throws, m."""


def presets() -> dict[str, str]:
    """Return the engines that :meth:`Engine.preset` knows: name → one line about it.

    Names that end in ``-ebook`` have the moving parts of the e-book (1 m crank radius, at 10 rpm),
    ``ijesc-v6-…`` those of the IJESC paper; all others have nominal ones of a half-litre cylinder.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.presets()["i4"]
    'throws 0-180-180-0, even firing 1-3-4-2'
    """
    return {entry.name: entry.description for entry in CATALOGUE}


def preset(name: str, *, cylinder: Cylinder | None = None, spacing: float | None = None) -> Engine:
    """Return the engine of this name; see :meth:`Engine.preset`.

    Another cylinder replaces what :class:`Cylinder` describes and no more: the crank stays as it
    is, and so does mass that turns with it. Where the layout offsets its bores (VR and W engines)
    each keeps its offset in metres, and the given pin offset is added to it.
    """
    entry = _find(name)
    if cylinder is not None and not isinstance(cylinder, Cylinder):
        raise InputError(f"cylinder = {inputs.shorten(cylinder)}: give a crankpin.Cylinder")
    distance = entry.spacing if spacing is None else inputs.number("spacing", spacing)
    if not math.isfinite(distance):
        raise InputError(f"spacing = {distance}: give a finite distance in metres")
    engine = entry.build(distance)
    parts = engine.cylinders
    if cylinder is not None:
        parts = tuple(
            cylinder.replace(pin_offset=cylinder.pin_offset + p.pin_offset) for p in parts
        )
    return engine.replace(cylinder=parts, name=entry.title, source=entry.source)


def family(name: str) -> list[str]:
    """Return [name] if that is a preset, or all presets whose names go on from it after a hyphen.

    A name that is neither comes back alone, for :func:`preset` to refuse.

    Examples
    --------
    >>> family("ijesc-v6")[0]
    'ijesc-v6-1-3-5-2-4-6'
    >>> family("v8-60")
    ['v8-60']
    """
    names = [entry.name for entry in CATALOGUE]
    if name in names:
        return [name]
    return [each for each in names if each.startswith(f"{name}-")] or [name]


def _find(name: str) -> Preset:
    if not isinstance(name, str):
        raise InputError(f"name = {inputs.shorten(name)}: give the name of a preset, as a string")
    by_name = {entry.name: entry for entry in CATALOGUE}
    if name in by_name:
        return by_name[name]
    near = family(name.lower())
    if near[0] not in by_name:
        near = difflib.get_close_matches(name.lower(), by_name, n=1, cutoff=0.0)
    meant = " or ".join(f'"{each}"' for each in near)
    cure = f"no such preset; did you mean {meant}? crankpin.presets() lists all"
    shown = name if len(name) <= 80 else f"{name[:79]}…"
    raise InputError(f'name = "{shown}": {cure}')


# --- moving parts ---------------------------------------------------------------------------------

NOMINAL = Cylinder(crank_radius=0.043, rod_length=0.145, reciprocating_mass=0.45)
"""A half-litre cylinder; stands in wherever a source gives the layout alone."""

IJESC = Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=1.487)

EBOOK = Cylinder(crank_radius=1.0, rod_length=2.0, reciprocating_mass=7.0)
EBOOK_ROTATING = 2.0
"""Of the 9 kg that the e-book's cylinder has at order 1, 2 kg turn with the pin, kg.

Above order 1 it has 7 kg: those move with the piston. Its tables push the 2 kg along the bore too,
which is right along one axis only. To get its figures leave them out and give its amplitudes:
``engine.replace(rotating_mass=0).balance(10, orders=[1, 2], spectrum={1: 9.0, 2: 7.0 * a2})``.
"""

VR6 = Cylinder(crank_radius=0.04515, rod_length=0.164, reciprocating_mass=0.45)
W16 = Cylinder(crank_radius=0.043, rod_length=0.148, reciprocating_mass=0.45)
BORE_OFFSET = 0.0125
"""How far the bores of VR and W engines pass the crank's axis, m; nominal."""

# --- how they are built ---------------------------------------------------------------------------


def _inline(throws_deg: Sequence[Angle], parts: Cylinder = NOMINAL, **options: Any) -> Build:  # noqa: ANN401 - of Engine.inline
    return lambda spacing: Engine.inline(parts, throws_deg=throws_deg, spacing=spacing, **options)


def _vee(
    bank_angle_deg: Angle,
    throws_deg: Sequence[Angle],
    parts: Cylinder = NOMINAL,
    **options: Any,  # noqa: ANN401 - of Engine.vee
) -> Build:
    return lambda spacing: Engine.vee(
        parts, bank_angle_deg=bank_angle_deg, throws_deg=throws_deg, spacing=spacing, **options
    )


def _firing(order: str, parts: Cylinder = NOMINAL, **options: Any) -> Build:  # noqa: ANN401 - of Engine.from_firing_order
    return lambda spacing: Engine.from_firing_order(parts, order, spacing=spacing, **options)


def _staggered(
    order: Sequence[int],
    *,
    groups_deg: Sequence[int],
    rows_apart_deg: Angle,
    bore_offset: float,
    parts: Cylinder,
) -> Build:
    """Even-firing four-stroke whose banks are staggered pairs of rows, as in VR and W engines.

    Each group (cylinders are numbered group by group) stands about its own bisector, its odd places
    in the left row, its even places in the right one, each place on a throw that groups share.

    The planes of the two rows meet below the crank's axis, so that at the axis each row has passed
    to its own side, the left row to the left. After top dead centre the crankpin swings to the
    left, and on that side an offset is positive: e > 0 for left rows, e < 0 for right ones. A
    piston is highest when crank and rod are in line, asin(e/(l + r)) past TDC, so the rows' highest
    points are rows_apart + 2 asin(|e|/(l + r)) apart: 21.9° for the VR6, whose pins are published
    as split by 22°. If the planes met above the axis it would be 8.1°.
    """

    def build(spacing: float) -> Engine:
        half = Fraction(rows_apart_deg) / 2
        past = math.degrees(math.asin(bore_offset / (parts.rod_length + parts.crank_radius)))
        places = len(order) // len(groups_deg)
        tdc: list[Angle] = []
        banks: list[Angle] = []
        cylinders = []
        for i in range(len(order)):
            group, place = divmod(i, places)
            left = place % 2 == 0
            # θ = 0 is the TDC of cylinder 1, in a left row, which is highest `past` later; a right
            # row is highest `past` before its TDC.
            fires = Fraction(720 * order.index(i + 1), len(order))
            tdc.append(fires if left or bore_offset == 0.0 else float(fires) + 2.0 * past)
            banks.append(groups_deg[group] + (half if left else -half))
            cylinders.append(parts.replace(pin_offset=bore_offset if left else -bore_offset))
        z = [spacing * (i % places) for i in range(len(order))]
        return Engine.from_lists(cylinders, tdc_deg=tdc, bank_deg=banks, z=z)

    return build


def _ito(first: Sequence[int], second: Sequence[int]) -> Build:
    """V-14 of these phase numbers, front to rear, at the bank angle that they ask for.

    Phase number k is (k − 1)/7 of a turn ahead, F(θ + (k − 1)2π/7). With Z = Σ s e^{2πi(k−1)/7},
    s = 3 … −3, first-order moment has no backward part if the second bank stands arg(−Z₂/Z₁)
    counter-clockwise of the first; where that is negative, the first bank is the left one.
    """

    def build(spacing: float) -> Engine:
        z1, z2 = (
            sum((3 - i) * cmath.rect(1.0, math.tau * (k - 1) / 7) for i, k in enumerate(bank))
            for bank in (first, second)
        )
        half = math.degrees(cmath.phase(-z2 / z1)) / 2.0
        return Engine.from_lists(
            NOMINAL,
            tdc_deg=[Fraction(-360 * (k - 1), 7) for k in (*first, *second)],
            bank_deg=[90.0 - half] * 7 + [90.0 + half] * 7,
            z=[spacing * place for place in range(7)] * 2,
        )

    return build


# --- the catalogue --------------------------------------------------------------------------------

PARTS_NOMINAL = "; moving parts and spacing nominal"
FIRING_ORDERS = 'Wikipedia, "Firing order"'
V_CHAPTER = 'e-book, "V-Engines: Flat-Plane vs Cross-Plane, in One Framework"'
SUMMARY = 'e-book, "Multi-Cylinder Series: Summary and Master Comparison"'
IJESC_PAPER = 'IJESC, April 2017, "selecting the V-angle for six cylinders V-engine"'
ITO_PAPER = 'Ito and Hattori, "Exciting Moment Analysis of V-Type Engine (14-Cylinder)", JSME'
RECOMPUTED = "the paper shows curves only; arrangement found by recomputing its Table 1"

# Cranks that several engines share. Each bank of the V10s fires 1-5-2-3-4, the order that leaves
# little second-order moment; a first-order one at 90° turns with the crank, whose counterweights
# cancel it.
CROSS_PLANE = (0, 90, 270, 180)
V10_CRANK = (0, 72, 288, 144, 216)

CATALOGUE: tuple[Preset, ...] = (
    # inline
    Preset(
        "single",
        "Single",
        "one upright cylinder",
        "by definition" + PARTS_NOMINAL,
        _inline([0]),
    ),
    Preset(
        "i2-360",
        "Inline-2, 360°",
        "throws 0-0, even firing; British parallel twins",
        'Wikipedia, "Big-bang firing order"' + PARTS_NOMINAL,
        _inline([0, 0]),
    ),
    Preset(
        "i2-180",
        "Inline-2, 180°",
        "throws 0-180, firing intervals 180-540; Honda CB450",
        'Wikipedia, "Big-bang firing order"' + PARTS_NOMINAL,
        _inline([0, 180]),
    ),
    Preset(
        "i3",
        "Inline-3",
        "throws 0-120-240, even firing 1-2-3",
        FIRING_ORDERS + PARTS_NOMINAL,
        _inline([0, 120, 240]),
    ),
    Preset(
        "i4",
        "Inline-4",
        "throws 0-180-180-0, even firing 1-3-4-2",
        FIRING_ORDERS + PARTS_NOMINAL,
        _inline([0, 180, 180, 0]),
    ),
    Preset(
        "i5",
        "Inline-5",
        "throws 0-216-144-72-288, even firing 1-2-4-5-3; Audi, Volvo",
        FIRING_ORDERS + PARTS_NOMINAL,
        _inline([0, 216, 144, 72, 288]),
    ),
    Preset(
        "i6",
        "Inline-6",
        "throws 0-240-120-120-240-0, even firing 1-5-3-6-2-4",
        FIRING_ORDERS + PARTS_NOMINAL,
        _inline([0, 240, 120, 120, 240, 0]),
    ),
    # flat
    Preset(
        "boxer-4",
        "Boxer-4",
        "opposed pistons mirror each other in one plane (no stagger), even firing",
        SUMMARY + PARTS_NOMINAL,
        _vee(180, [0, 180], pin_split_deg=180),
    ),
    Preset(
        "flat-4",
        "Flat-4, shared pins",
        "180° V4, not a boxer: opposed pistons share a pin",
        SUMMARY + PARTS_NOMINAL,
        _vee(180, [0, 180]),
    ),
    Preset(
        "boxer-6",
        "Boxer-6",
        "three mirrored pairs 120° apart, each in one plane (no stagger), even firing; Porsche",
        'Wikipedia, "Flat-six engine"; order of throws nominal' + PARTS_NOMINAL,
        _vee(180, [0, 120, 240], pin_split_deg=180),
    ),
    # V2 and V4
    Preset(
        "v-twin-90",
        "V-twin 90°",
        "two cylinders on one pin; Ducati, Moto Guzzi",
        V_CHAPTER + PARTS_NOMINAL,
        _vee(90, [0]),
    ),
    Preset(
        "v4-90-180",
        "V4 90°, 180° crank",
        "90° V4, shared pins 0-180; Honda VFR750F and most V4s of the road",
        "F1technical forum on the cranks of 90° V4s; side of cylinder 1 nominal" + PARTS_NOMINAL,
        _vee(90, [0, 180]),
    ),
    Preset(
        "v4-90-360",
        "V4 90°, 360° crank",
        "90° V4, shared pins 0-0, firing intervals 90-270; Honda VF750S, RC30",
        "Cycle News 57/29, 2020, p. 77 (VF750S); F1technical forum on the cranks of 90° V4s "
        "(RC30); side of cylinder 1 nominal" + PARTS_NOMINAL,
        _vee(90, [0, 0]),
    ),
    Preset(
        "v4-narrow",
        "V4 12°53'45\"",
        "staggered V4 under one head, fires evenly as an inline-4, 1-3-4-2; Lancia Fulvia",
        'Curbside Classic on the Fulvia (angle); Wikipedia, "V4 engine" (pins split by the bank '
        "angle); bores nominally through the crank's axis, sides nominal" + PARTS_NOMINAL,
        _staggered(
            [1, 3, 4, 2],
            groups_deg=[90],
            rows_apart_deg=12 + Fraction(53, 60) + Fraction(45, 3600),
            bore_offset=0.0,
            parts=NOMINAL,
        ),
        spacing=0.05,
    ),
    # V6
    Preset(
        "v6-60",
        "V6 60°, split pins",
        "60° V6, pins split by -60°, even firing 1-2-3-4-5-6; GM, Nissan",
        'Wikipedia, "V6 engine"; GM 3.2 V6 data sheet (firing order)' + PARTS_NOMINAL,
        _vee(60, [0, 120, 240], pin_split_deg=-60),
    ),
    Preset(
        "v6-90",
        "V6 90°, split pins",
        "90° V6, pins split by -30°, even firing 1-6-5-4-3-2; Buick from 1977",
        "Buick 3.8 manual, 1997 (30° offset, firing order, odd cylinders left)" + PARTS_NOMINAL,
        _vee(90, [0, 240, 120], pin_split_deg=-30, odd_bank="left"),
    ),
    Preset(
        "v6-90-odd-fire",
        "V6 90°, shared pins",
        "90° V6, three shared pins, firing intervals 150-90, 1-6-5-4-3-2; Buick from 1961",
        'Wikipedia, "Buick V6 engine"; firing order of the later engine' + PARTS_NOMINAL,
        _vee(90, [0, 240, 120], odd_bank="left"),
    ),
    Preset(
        "v6-120",
        "V6 120°",
        "120° V6, three shared pins, even firing; McLaren Artura",
        "Car Throttle on the McLaren Artura (angle, pins); order of throws nominal" + PARTS_NOMINAL,
        _vee(120, [0, 120, 240]),
    ),
    *(
        Preset(
            f"ijesc-v6-{order}",
            f"IJESC V6 60°, firing order {order}",
            f"60° V6 of the IJESC paper, lags by its rule for {order}; not even-firing",
            f"{IJESC_PAPER}, Table {table}; the rule for lags follows from the tables",
            _firing(order, IJESC, rule="ijesc", bank_angle_deg=60, odd_bank="right"),
            spacing=0.13,
        )
        for order, table in (
            ("1-3-5-2-4-6", "I"),
            ("1-4-5-2-3-6", "II"),
            ("1-6-5-4-3-2", "III"),
            ("1-5-3-6-2-4", "IV"),
        )
    ),
    Preset(
        "vr6",
        "VR6 15°",
        "staggered 15° V6 under one head, even firing 1-5-3-6-2-4; Volkswagen",
        'Engine Labs on the VR6 (15°, pins split by 22°); Wikipedia, "VR6 engine" (1-3-5 left); '
        "bore offset 12.5 mm, moving parts and spacing nominal",
        _staggered(
            [1, 5, 3, 6, 2, 4],
            groups_deg=[90],
            rows_apart_deg=15,
            bore_offset=BORE_OFFSET,
            parts=VR6,
        ),
        spacing=0.065,
    ),
    # V8
    Preset(
        "v8-flatplane",
        "V8 90°, flat-plane",
        "90° V8, shared pins 0-180-180-0, even firing",
        V_CHAPTER + PARTS_NOMINAL,
        _vee(90, [0, 180, 180, 0]),
    ),
    Preset(
        "v8-crossplane",
        "V8 90°, cross-plane",
        "90° V8 as built, shared pins 0-90-270-180, even firing 1-8-4-3-6-5-7-2, odd left",
        '"V型8気筒エンジンの慣性力・偶力(クロスプレーン)", inertia forces and couples of a V8'
        + PARTS_NOMINAL,
        _vee(90, CROSS_PLANE, odd_bank="left"),
    ),
    Preset(
        "v8-60",
        "V8 60°, split pins",
        "60° V8, cross-plane, pins split by -30°, even firing; Volvo B8444S",
        'Wikipedia, "V8 engine" (60°, split pins); order of throws nominal' + PARTS_NOMINAL,
        _vee(60, CROSS_PLANE, pin_split_deg=-30),
    ),
    # V10
    Preset(
        "v10-72",
        "V10 72°",
        "72° V10, five shared pins, even firing 1-6-5-10-2-7-3-8-4-9; Lexus LFA",
        'Wikipedia, "V10 engine" (72°, five throws); firing order as commonly listed'
        + PARTS_NOMINAL,
        _vee(72, V10_CRANK, numbering="by-bank"),
    ),
    Preset(
        "v10-90",
        "V10 90°, shared pins",
        "90° V10, five shared pins, firing intervals 54-90, 1-10-9-4-3-6-5-8-7-2; Dodge Viper",
        f"{FIRING_ORDERS}; drjlt.com on V10 engines (intervals)" + PARTS_NOMINAL,
        _vee(90, V10_CRANK, odd_bank="left"),
    ),
    Preset(
        "v10-90-even",
        "V10 90°, split pins",
        "90° V10, pins split by 18°, even firing 1-6-5-10-2-7-3-8-4-9; Lamborghini, Audi",
        'Wikipedia, "V10 engine" (18°); firing order as commonly listed' + PARTS_NOMINAL,
        _vee(90, V10_CRANK, pin_split_deg=18, numbering="by-bank"),
    ),
    # V12 and more
    Preset(
        "v12-60",
        "V12 60°",
        "60° V12, six shared pins, even firing 1-7-5-11-3-9-6-12-2-8-4-10; Ferrari 456M",
        FIRING_ORDERS + PARTS_NOMINAL,
        _vee(60, [0, 240, 120, 120, 240, 0], numbering="by-bank"),
    ),
    *(
        Preset(
            f"v14-{angle}",
            f"V14 {angle}°",
            "V14, banks "
            + " and ".join("-".join(map(str, bank)) for bank in banks)
            + ", first-order moment wholly forward",
            f"{ITO_PAPER}, {where}" + PARTS_NOMINAL,
            _ito(*banks),
        )
        for angle, banks, where in (
            ("9.13", ((3, 4, 7, 1, 6, 5, 2), (5, 2, 1, 6, 7, 3, 4)), RECOMPUTED),
            ("49.54", ((1, 4, 5, 2, 6, 3, 7), (3, 7, 6, 2, 5, 1, 4)), "section 4.1"),
            ("63.03", ((1, 2, 5, 6, 7, 4, 3), (4, 3, 7, 1, 2, 5, 6)), "section 4.2"),
            ("170.87", ((3, 4, 7, 1, 6, 5, 2), (4, 3, 7, 6, 1, 2, 5)), RECOMPUTED),
        )
    ),
    Preset(
        "v16-45",
        "V16 45°",
        "45° V16, eight shared pins, even firing 1-8-9-14-3-6-11-2-15-10-7-4-13-12-5-16; Cadillac",
        'Wikipedia, "Cadillac V16 engine"; Dyke\'s Automotive Encyclopedia, 1943 (throws 90°); '
        "firing order of 1935-37 as commonly listed, odd cylinders left" + PARTS_NOMINAL,
        _vee(45, [0, 180, 90, 270, 270, 90, 180, 0], odd_bank="left"),
    ),
    # W: two staggered groups on one crank
    Preset(
        "w12",
        "W12 72°",
        "two VR6 at 72°, pins split by 12°, even firing 1-12-5-8-3-10-6-7-2-11-4-9; Volkswagen",
        "Audi Technology Portal, W12 (15°, 72°, 12°, 60° intervals); firing order as commonly "
        "listed; bore offset 12.5 mm, sides, moving parts and spacing nominal",
        _staggered(
            [1, 12, 5, 8, 3, 10, 6, 7, 2, 11, 4, 9],
            groups_deg=[54, 126],
            rows_apart_deg=15,
            bore_offset=BORE_OFFSET,
            parts=VR6,
        ),
        spacing=0.065,
    ),
    Preset(
        "w16",
        "W16 90°",
        "two VR8 at 90°, eight shared pins, even firing; Bugatti Veyron",
        'Wikipedia, "Bugatti W16 engine" (15°, 90°, stroke 86 mm); firing order as commonly '
        "listed, 1-14-9-4-7-12-15-6-13-8-3-16-11-2-5-10; bore offset 12.5 mm, rods, sides, "
        "mass and spacing nominal",
        _staggered(
            [1, 14, 9, 4, 7, 12, 15, 6, 13, 8, 3, 16, 11, 2, 5, 10],
            groups_deg=[45, 135],
            rows_apart_deg=15,
            bore_offset=BORE_OFFSET,
            parts=W16,
        ),
        spacing=0.074,
    ),
    # as the e-book has them: its parts, its distances (a = 0.1 m is half the pitch where the number
    # of throws is 2 or 4 in line), pins as its phases give them
    Preset(
        "single-ebook",
        "Single (e-book)",
        "one upright cylinder, the e-book's parts",
        SUMMARY,
        _inline([0], EBOOK, rotating_mass=EBOOK_ROTATING),
    ),
    Preset(
        "i3-ebook",
        "Inline-3 (e-book)",
        "throws 0-240-120, the e-book's parts",
        SUMMARY,
        _inline([0, 240, 120], EBOOK, rotating_mass=EBOOK_ROTATING),
    ),
    Preset(
        "i4-ebook",
        "Inline-4 (e-book)",
        "throws 0-180-180-0, the e-book's parts",
        SUMMARY,
        _inline([0, 180, 180, 0], EBOOK, rotating_mass=EBOOK_ROTATING),
        spacing=0.2,
    ),
    Preset(
        "i6-ebook",
        "Inline-6 (e-book)",
        "throws 0-240-120-120-240-0, the e-book's parts",
        SUMMARY,
        _inline([0, 240, 120, 120, 240, 0], EBOOK, rotating_mass=EBOOK_ROTATING),
    ),
    Preset(
        "boxer-4-ebook",
        "Boxer-4 (e-book)",
        "opposed pistons mirror each other in one plane, the e-book's parts",
        SUMMARY,
        _vee(180, [0, 180], EBOOK, pin_split_deg=180, rotating_mass=2 * EBOOK_ROTATING),
        spacing=0.2,
    ),
    Preset(
        "flat-4-ebook",
        "Flat-4, shared pins (e-book)",
        "180° V4, not a boxer, the e-book's parts",
        SUMMARY,
        _vee(180, [0, 180], EBOOK, rotating_mass=2 * EBOOK_ROTATING),
        spacing=0.2,
    ),
    Preset(
        "v-twin-90-ebook",
        "V-twin 90° (e-book)",
        "two cylinders on one pin, the e-book's parts",
        V_CHAPTER,
        _vee(90, [0], EBOOK, rotating_mass=2 * EBOOK_ROTATING),
    ),
    Preset(
        "v6-60-ebook",
        "V6 60°, shared pins (e-book)",
        "60° V6, three shared pins 0-120-240, the e-book's parts",
        V_CHAPTER,
        _vee(60, [0, 120, 240], EBOOK, rotating_mass=2 * EBOOK_ROTATING),
    ),
    Preset(
        "v8-flatplane-ebook",
        "V8 90°, flat-plane (e-book)",
        "90° V8, shared pins 0-180-180-0, the e-book's parts",
        V_CHAPTER,
        _vee(90, [0, 180, 180, 0], EBOOK, rotating_mass=2 * EBOOK_ROTATING),
    ),
    Preset(
        "v8-crossplane-ebook",
        "V8 90°, pins 0-90-180-270 (e-book)",
        "90° V8, shared pins 0-90-180-270 (not the cross-plane that is built), the e-book's parts",
        V_CHAPTER,
        _vee(90, [0, 90, 180, 270], EBOOK, rotating_mass=2 * EBOOK_ROTATING),
    ),
)
