"""Data of a page: an engine's figures, the settings of its controls, and the core's results."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels, units
from crankpin._support.quantities import QUANTITIES
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.explain import Explanation
from crankpin.analysis.flywheel import flywheel
from crankpin.analysis.request import engine_core
from crankpin.model.cylinder import rod_length

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Spectrum
    from crankpin.analysis.quantity import Quantity
    from crankpin.analysis.waveform import Waveform
    from crankpin.model.engine import Engine, Hold

Controls: TypeAlias = "str | Sequence[str] | None"
"""Names of controls, or one; None for all."""
CONTROLS = ("crank_angle", "rpm", "rod_ratio", "bank_angle", "rocking", "sound", "view")
UNITS = {name: QUANTITIES[name].unit for name in ("force", "moment", "torque")} | {
    "orbit": "m", "length": "m", "pressure": "Pa", "inertia": "kg·m²",
}  # fmt: skip
"""Unit of a page's numbers by quantity."""
CURVE_STEP = 2.0
"""Degrees between the samples of a curve."""
IRREGULARITY = 0.01
"""Largest less smallest speed, over the mean, of a page whose moment of inertia is not given."""


@dataclasses.dataclass(frozen=True)
class Settings:
    """Settings of a page; their names are those in the page's state and in the widget's traits."""

    rpm: float
    """Crank speed."""
    bank_angle_deg: float | None
    """Angle between the two banks, degrees; None for an engine that has not two on one crank."""
    rod_ratio: float | None
    """Crank radius over rod length of all cylinders; None while they differ."""
    hold: Hold = "pins"
    """Quantity held as the bank angle changes: ``"pins"`` or ``"firing"``."""

    @classmethod
    def of(cls, engine: Engine, rpm: float) -> Settings:
        """Return the settings that leave an engine as it is."""
        return cls(
            rpm=inputs.number("rpm", rpm),
            bank_angle_deg=_bank_angle(engine),
            rod_ratio=_core.rod_ratios(engine_core(engine))[1],
        )

    def check(self, engine: Engine) -> None:
        """Raise an InputError if the engine does not allow these settings."""
        inputs.angular_speed(self.rpm)
        self.applied(engine)
        reached, own = _core.rod_ratios(engine_core(engine))
        if self.rod_ratio in (None, own):
            return
        if reached is None:
            hint = "other rods would move link rods or the firing of a shared chamber; leave it out"
            raise inputs.rejected("rod_ratio", self.rod_ratio, hint)
        least, most = reached
        if not least <= self.rod_ratio <= most:
            hint = f"a page reaches {least:.6g} to {most:.6g}"
            raise inputs.rejected("rod_ratio", self.rod_ratio, hint)

    def applied(self, engine: Engine) -> Engine:
        """Return the engine at these settings.

        Raises
        ------
        InputError
            If the engine has not two banks to set an angle between, the angle is out of range, or
            the crank could not turn.
        """
        changed = engine
        if self.bank_angle_deg is not None:
            changed = changed.with_bank_angle(self.bank_angle_deg, hold=self.hold)
        ratio = None if self.rod_ratio is None else inputs.number("rod_ratio", self.rod_ratio)
        return at_rod_ratio(changed, ratio)


def figures(
    engine: Engine,
    rpm: float,
    *,
    spectrum: Spectrum | None,
    inertia: float | None = None,
    compact: bool = False,
    controls: Controls = None,
) -> dict[str, Any]:
    """Return an engine as plain lists and numbers: metres, kilograms, degrees.

    Raises
    ------
    InputError
        If an argument is out of range.
    """
    Settings.of(engine, rpm).check(engine)
    inputs.warn_of_units(mean_piston_speed(engine, float(rpm)))
    pairs = inputs.spectrum(spectrum)
    core = engine_core(engine)
    return {
        **json.loads(_core.drawn_turning(core, pairs, float(rpm))),
        "rpm": float(rpm),
        "loads": labels.in_words(labels.SPECTRUM_GIVEN if pairs else core.loads_counted),
        "flywheel": None if pairs is not None else _inertia(engine, float(rpm), inertia),
        "compact": inputs.flag("compact", compact),
        "controls": _controls(engine, controls, compact=compact),
        "units": in_units(UNITS),
        "sentences": []
        if compact or pairs
        else [*Explanation(engine, float(rpm) or None).sentences],
    }


def places(engine: Engine, rpm: float) -> dict[str, Any]:
    """Return what an engine is drawn from, and its settings."""
    return {**json.loads(_core.drawn(engine_core(engine))), "rpm": inputs.number("rpm", rpm)}


def core_numbers(
    engine: Engine, settings: Settings, *, spectrum: Spectrum | None, inertia: float | None = None
) -> dict[str, Any]:
    """Return the core's phasors by order and its curves over a turn, of an engine at settings.

    In the form in which the page computes its own: forces in N, moments and torques in N·m.
    """
    changed = settings.applied(engine)
    orders = _core.listed_orders(engine_core(engine), inputs.spectrum(spectrum))
    balance = changed.balance(settings.rpm, orders=orders, spectrum=spectrum, torque=False)
    rows = json.loads(_core.load_rows(engine_core(changed), settings.rpm, spectrum is None))
    repeats, of_torque = (
        720.0 if any(order % 1 for order, *_ in rows[name]) else 360.0
        for name in ("planar", "torque")
    )
    turns = max(repeats, of_torque, 180.0 * changed.strokes if changed.fired else 0.0)
    waveform = changed.waveform(
        settings.rpm,
        theta_deg=np.arange(0.0, turns + 1.0, CURVE_STEP),
        orders=None if spectrum is None else orders,
        spectrum=spectrum,
        torque=spectrum is None,
    )
    planar = {"force": balance.force, "moment": balance.moment}
    turn = waveform.theta_deg <= repeats
    torques = {"torque": "torque"}
    if changed.fired or changed.loads:
        torques |= {"gas": "torque.gas", "inertia": "torque.inertia"}
    return {
        "settings": dataclasses.asdict(settings),
        "orders": [
            {"order": order, **{name: _phasors(vector, k) for name, vector in planar.items()}}
            for k, order in enumerate(balance.orders)
        ],
        "curve": {
            "force": waveform.force[turn].tolist(),
            "moment": waveform.moment[turn].tolist(),
            **{
                name: [None] if spectrum is not None else waveform.read(quantity).tolist()
                for name, quantity in torques.items()
            },
            "loads": [None] if spectrum is not None else _of_loads(waveform),
            "speed": _speeds(changed, settings.rpm, inertia, waveform.theta_deg),
        },
    }


def _of_loads(waveform: Waveform) -> list[float]:
    """Return the torque of periodic loads on the block."""
    others = [waveform.read(f"torque.{name}") for name in ("inertia", "gas")]
    rest: list[float] = (waveform.torque - others[0] - others[1]).tolist()
    return rest


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


def _bank_angle(engine: Engine) -> float | None:
    """Return the bank angle that a page can set, degrees: of a vee on one crank, without links."""
    core = engine_core(engine)
    is_fixed = len(core.cranks[0]) > 1 or any(core.link_rods)
    return None if is_fixed else getattr(engine, "bank_angle_deg", None)


def _controls(engine: Engine, controls: Controls, *, compact: bool) -> list[str]:
    """Return the names of the controls that a page has, in their order.

    By default a compact page has three and its choice of a vector.
    """
    vee = _bank_angle(engine) is not None
    has = {
        "rod_ratio": _core.rod_ratios(engine_core(engine))[0] is not None,
        "bank_angle": vee, "rocking": not compact, "sound": not compact and engine.firing_order,
    }  # fmt: skip
    offered = [name for name in CONTROLS if has.get(name, True)]
    if controls is None:
        return [name for name in offered if not (compact and vee and name == "rod_ratio")]
    return named_controls(controls, CONTROLS, offered)


def named_controls(
    controls: str | Sequence[str], every: Sequence[str], known: Sequence[str]
) -> list[str]:
    """Return the names of controls as given, each once; of all that pages have, this one's.

    Raises
    ------
    InputError
        If there is no such control.
    """
    named = [controls] if isinstance(controls, str) else controls
    chosen = inputs.items("controls", named, f'give names, of {", ".join(known)}, or "none"')
    if chosen == ["none"]:
        return []
    for name in chosen:
        if inputs.one_of("controls", name, every) not in known:
            raise inputs.rejected("controls", name, f"this page has {', '.join(known)}")
    return list(dict.fromkeys(chosen))


def in_units(own: Mapping[str, str]) -> dict[str, units.Converted]:
    """Return the units of a page that are not its own, with their factors, by quantity."""
    shown = {name: units.convert(unit) for name, unit in own.items()}
    return {name: each for name, each in shown.items() if each.unit != own[name]}


def _inertia(engine: Engine, rpm: float, inertia: float | None) -> float | None:
    """Return the moment of inertia that turns with the crank, kg·m²: by default a stated one."""
    if inertia is not None:
        return flywheel(engine, rpm=rpm, inertia=inertia).inertia
    if not engine.fired or rpm == 0.0:
        return None
    return flywheel(engine, rpm=rpm, irregularity=IRREGULARITY).inertia


def _speeds(
    engine: Engine, rpm: float, inertia: float | None, theta_deg: NDArray[np.float64]
) -> list[float] | None:
    """Return the crank's speeds, rpm; None without a flywheel, or if the crank would stop."""
    if inertia is None:
        return None
    try:
        wheel = flywheel(engine, rpm=rpm, inertia=inertia)
    except InputError:
        return None
    speeds: list[float] = np.interp(theta_deg, wheel.theta_deg, wheel.speed_rpm).tolist()
    return speeds


def _phasors(vector: Quantity, k: int) -> dict[str, list[float]]:
    return {"forward": _pair(vector.forward[k]), "backward": _pair(vector.backward[k])}


def _pair(value: complex) -> list[float]:
    return [float(value.real), float(value.imag)]
