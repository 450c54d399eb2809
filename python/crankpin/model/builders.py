"""Engines of the compiled core from what people know of an engine: lists, throws, firing orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs
from crankpin.model import checks
from crankpin.model.cylinder import Cylinder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Angle, Angles

Numbering: TypeAlias = Literal["alternating", "by-bank"]
Side: TypeAlias = Literal["right", "left"]
FiringRule: TypeAlias = Literal["even", "ijesc"]
Parts: TypeAlias = tuple[float, float, float, float, float]


def from_lists(
    cylinder: Cylinder | Sequence[Cylinder],
    tdc_deg: Angles | None,
    pin_deg: Angles | None,
    bank_deg: Angles,
    z: ArrayLike,
    rotating_mass: ArrayLike,
    bank: list[int] | None = None,
) -> _core.Engine:
    """Return the engine of :meth:`Engine.from_lists`; cylinders of equal ``bank`` form one."""
    banks = inputs.angles("bank_deg", bank_deg)
    core = _core.Engine.from_lists(
        _each(cylinder, len(banks)),
        None if tdc_deg is None else inputs.angles("tdc_deg", tdc_deg),
        None if pin_deg is None else inputs.angles("pin_deg", pin_deg),
        banks,
        bank,
        inputs.vector("z", z).tolist(),
        inputs.per_item("rotating_mass", rotating_mass, len(banks)),
        "",
        "",
    )
    checks.units(core)
    checks.angles(tdc_deg=tdc_deg, pin_deg=pin_deg, bank_deg=bank_deg)
    return core


def inline(
    cylinder: Cylinder,
    throws_deg: Angles,
    spacing: float,
    rotating_mass: ArrayLike,
    first_tdc_deg: Angle,
) -> _core.Engine:
    """Return the engine of :meth:`Engine.inline`."""
    layout = _inline_layout(spacing, rotating_mass, first_tdc_deg, throws_deg)
    core = _core.Engine.inline(parts(cylinder), layout)
    checks.units(core)
    checks.angles(throws_deg=throws_deg, first_tdc_deg=first_tdc_deg)
    return core


def vee(
    cylinder: Cylinder,
    bank_angle_deg: Angle,
    throws_deg: Angles,
    spacing: float,
    pin_split_deg: Angle,
    bank_stagger: float,
    numbering: Numbering,
    odd_bank: Side,
    rotating_mass: ArrayLike,
    first_tdc_deg: Angle,
) -> _core.Engine:
    """Return the engine of :meth:`Engine.vee`, :meth:`Engine.flat` or :meth:`Engine.boxer`."""
    layout = _inline_layout(spacing, rotating_mass, first_tdc_deg, throws_deg) | _vee_layout(
        bank_angle_deg, pin_split_deg, bank_stagger, numbering, odd_bank
    )
    core = _core.Engine.vee(parts(cylinder), layout)
    checks.units(core)
    checks.angles(
        bank_angle_deg=bank_angle_deg,
        throws_deg=throws_deg,
        pin_split_deg=pin_split_deg,
        first_tdc_deg=first_tdc_deg,
    )
    checks.pin_split(core, layout["pin_split"])
    return core


def from_firing_order(
    cylinder: Cylinder,
    firing_order: str,
    spacing: float,
    bank_angle_deg: Angle | None,
    rule: FiringRule,
    intervals_deg: Angles | None,
    strokes: int,
    numbering: Numbering,
    odd_bank: Side,
    bank_stagger: float,
    rotating_mass: ArrayLike,
    first_tdc_deg: Angle,
) -> _core.Engine:
    """Return the engine of :meth:`Engine.from_firing_order`."""
    order = (
        firing_order,
        inputs.text("rule", rule, 'give "even" or "ijesc"'),
        None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg),
        inputs.strokes(strokes),
    )
    layout = _inline_layout(spacing, rotating_mass, first_tdc_deg)
    # What an inline engine ignores is checked all the same.
    banks = _vee_layout(
        0.0 if bank_angle_deg is None else bank_angle_deg, 0.0, bank_stagger, numbering, odd_bank
    )
    if bank_angle_deg is None:
        core = _core.Engine.inline_from_firing_order(parts(cylinder), *order, layout)
    else:
        core = _core.Engine.vee_from_firing_order(parts(cylinder), *order, layout | banks)
    checks.units(core)
    checks.angles(
        bank_angle_deg=bank_angle_deg, intervals_deg=intervals_deg, first_tdc_deg=first_tdc_deg
    )
    return core


def parts(cylinder: Cylinder) -> Parts:
    """Return the figures of a cylinder, as the core takes them."""
    if not isinstance(cylinder, Cylinder):
        raise InputError(f"cylinder = {inputs.shorten(cylinder)}: give a crankpin.Cylinder")
    return cylinder._parts


def _each(cylinder: Cylinder | Sequence[Cylinder], count: int) -> list[Parts]:
    if isinstance(cylinder, Cylinder):
        return [parts(cylinder)] * count
    cure = "give a crankpin.Cylinder, or one for each cylinder"
    return [parts(each) for each in inputs.items("cylinder", cylinder, cure)]


def _inline_layout(
    spacing: float, rotating_mass: ArrayLike, first_tdc_deg: Angle, throws_deg: Angles = ()
) -> dict[str, Any]:
    return {
        "throws": inputs.angles("throws_deg", throws_deg),
        "spacing": inputs.number("spacing", spacing),
        "rotating_mass": inputs.vector("rotating_mass", rotating_mass).tolist(),
        "first_tdc": inputs.angle("first_tdc_deg", first_tdc_deg),
    }


def _vee_layout(
    bank_angle_deg: Angle,
    pin_split_deg: Angle,
    bank_stagger: float,
    numbering: Numbering,
    odd_bank: Side,
) -> dict[str, Any]:
    return {
        "bank_angle": inputs.angle("bank_angle_deg", bank_angle_deg),
        "pin_split": inputs.angle("pin_split_deg", pin_split_deg),
        "bank_stagger": inputs.number("bank_stagger", bank_stagger),
        "numbering": inputs.text("numbering", numbering, 'give "alternating" or "by-bank"'),
        "odd_bank": inputs.text("odd_bank", odd_bank, 'give "right" or "left"'),
    }
