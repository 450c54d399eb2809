"""Data of the page of a powertrain on its mounts: coefficients of the library's results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.messages import suppressed
from crankpin.analysis.balance import mean_piston_speed
from crankpin.model.loads import of_speed_squared
from crankpin.view.figures import in_units, named_controls, places

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.model.engine import Engine
    from crankpin.model.mounts import Mount
    from crankpin.view.figures import Controls

CONTROLS = ("crank_angle", "rpm", "order", "mode", "rocking", "mounts", "view")
UNITS = {"force": "N", "motion": "m", "length": "m", "stiffness": "N/m"}
"""Unit of a page's numbers by quantity."""
TRACK_POINTS = (0.4, 0.8, 1.25, 2.5)
"""Frequencies over that of the fluid at which a hydraulic mount is read: as many as it has
coefficients."""


def figures(
    powertrain: Powertrain, rpm: float, *, frequency: float | None = None, controls: Controls = None
) -> dict[str, Any]:
    """Return a powertrain as plain lists and numbers, from which its page evaluates its own.

    Raises
    ------
    InputError
        If an argument is out of range, stiffness depends on frequency and none is given, or the
        powertrain has a flexible support.
    """
    at = speed(rpm)
    powertrain._require_engine_axes("page")
    powertrain._core.require_ground()
    engine = powertrain._require_engine("powertrain")
    if powertrain.forces:
        hint = "a page has the loads of an engine: leave tables of forces out"
        raise inputs.rejected("forces", powertrain.forces[0].title, hint)
    for mount in powertrain.mounts:
        if any((*mount.rotational_stiffness, *mount.rotational_damping)):
            hint = "a page has mounts that resist no rotation by themselves"
            raise inputs.faulty(f"rotational_stiffness of mount {mount.name!r}", "is given", hint)
        if mount._is_snubbed:
            hint = "a page has mounts without snubbers: leave it out"
            raise inputs.faulty(f"snubber_stiffness of mount {mount.name!r}", "is given", hint)
    inputs.warn_of_units(mean_piston_speed(engine, at))
    modes = powertrain.modes(frequency)
    return {
        **places(engine, at),
        "name": f"{labels.name_of(engine)} on its mounts",
        "loads": labels.in_words(engine.loads_counted),
        "controls": named_controls(CONTROLS if controls is None else controls, CONTROLS, CONTROLS),
        "units": in_units(UNITS),
        "mounted": {
            "cg": list(powertrain.body.cg),
            "box": _box(powertrain),
            "frequency": modes.at_frequency,
            "equal_frequencies": _core.EQUAL_FREQUENCIES,
            **_mass(powertrain),
            **_engine_loads(powertrain),
            "order": largest_order(powertrain, at),
            "mounts": _mounts(powertrain),
        },
    }


def speed(rpm: float) -> float:
    """Return a speed of a page, rpm.

    Raises
    ------
    InputError
        If it is not above zero.
    """
    checked = inputs.number("rpm", rpm)
    inputs.angular_speed(checked)
    if checked == 0.0:
        raise inputs.rejected("rpm", rpm, "give a speed above zero")
    return checked


def largest_order(powertrain: Powertrain, rpm: float) -> Order | str:
    """Return the order of the largest force on the body, or ``"all"`` where there is no answer."""
    largest: Order | str = "all"
    most = 0.0
    for order in powertrain._require_engine("powertrain").balance(labels.UNIT_RPM).orders:
        try:
            with suppressed():  # The page says which motions are free.
                force = powertrain.response(rpm, orders=[order])[order].body_force.rms
        except InputError:  # A table ends, or damping lacks in resonance.
            continue
        if force > most:
            largest, most = order, force
    return largest


def changed(powertrain: Powertrain, mounts: Sequence[dict[str, Any]]) -> Powertrain:
    """Return a powertrain whose mounts have the places and stiffnesses of a page's state.

    Raises
    ------
    InputError
        If there is no such mount.
    """
    if len(mounts) != len(powertrain.mounts):
        hint = f"give one for each of the {len(powertrain.mounts)} mounts"
        raise inputs.faulty("mounts", f"has {len(mounts)} entries", hint)
    with suppressed():  # Warned of where they were given.
        return powertrain.replace(
            mounts=[
                own if state == placed(own) else _moved(own, state)
                for own, state in zip(powertrain.mounts, mounts, strict=True)
            ]
        )


def placed(mount: Mount) -> dict[str, Any]:
    """Return place and stiffness of a mount as the page's state has them; None of a table."""
    stiffness = None if mount.table is not None else list(_dynamic_stiffness(mount))
    return {"at": list(mount.at), "stiffness": stiffness}


def core_numbers(
    powertrain: Powertrain, rpm: float, order: Order | str, frequency: float | None
) -> dict[str, Any]:
    """Return the library's modes and response of a powertrain, in the form of the page's own."""
    modes = powertrain.modes(frequency)
    with suppressed():
        response = powertrain.response(rpm, orders="auto" if order == "all" else [float(order)])
    return {
        "settings": {
            "rpm": rpm,
            "order": order,
            "mounts": [placed(mount) for mount in powertrain.mounts],
        },
        "modes": [
            {"frequency": frequency, "shape": shape, "energy": energy, "purity": purity}
            for frequency, shape, energy, purity in zip(
                modes.frequency.tolist(),
                modes.shapes.T.tolist(),
                modes.energy.T.tolist(),
                modes.purity.tolist(),
                strict=True,
            )
        ],
        "parts": [
            {
                "order": response.orders[k],
                "motion": _pairs(response.motion[k, :]),
                "force": _pairs(response.support_wrench[k, :3]),
            }
            for k in range(len(response.orders))
        ],
    }


def _moved(mount: Mount, state: dict[str, Any]) -> Mount:
    if set(state) != {"at", "stiffness"}:
        hint = 'give {"at": (x, y, z), "stiffness": (…), or None of a table}'
        raise inputs.rejected("mounts", state, hint)
    stiffness = {} if mount.table is not None else {"dynamic_stiffness": state["stiffness"]}
    return mount.replace(at=state["at"], **stiffness)


def _dynamic_stiffness(mount: Mount) -> Sequence[float]:
    """Return the stiffness in motion of a mount without a table, of its rubber alone."""
    return mount.stiffness if mount.dynamic_stiffness is None else mount.dynamic_stiffness


def _mass(powertrain: Powertrain) -> dict[str, Any]:
    """Return coordinates of unit mass, columns of U, and M·U."""
    unit = powertrain._core.unit_mass()
    return {"unit": unit.tolist(), "momentum": np.linalg.inv(unit).T.tolist()}


def _engine_loads(powertrain: Powertrain) -> dict[str, Any]:
    """Return the load of each order about the CG: over the square of speed, and at any speed."""
    engine = powertrain._require_engine("powertrain")
    tables = [each.name for each in engine.loads if isinstance(each.rpm, tuple)]
    if tables:
        hint = "a page has loads at any speed: give it amplitudes of one, or leave it out"
        raise inputs.rejected("loads", tables[0], hint)
    scaling = of_speed_squared(engine)
    still = engine.with_loads(each for each in engine.loads if each not in scaling.loads)
    orders_of = [each.balance(labels.UNIT_RPM).orders for each in (scaling, still)]
    orders = sorted({*orders_of[0], *orders_of[1]})

    def load(of: Engine, without: str) -> list[Any]:
        wrench = of.balance(labels.UNIT_RPM, orders=orders).about(powertrain.body.cg)
        load = np.zeros((len(orders), 6), complex)
        for at, quantity in ((0, wrench.force), (3, wrench.moment)):
            for part in _parts(quantity, without):
                load[:, at : at + 2] += np.stack([part.x, part.y], axis=1)
        for part in _parts(wrench.torque, without):
            load[:, 5] += part.phasor
        return [_pairs(each) for each in load]

    return {"orders": orders, "inertia": load(scaling, "gas"), "gas": load(still, "inertia")}


def _parts(quantity: Any, without: str) -> list[Any]:  # noqa: ANN401 - of any of three types
    """Return the parts of a quantity but one; what has no parts is all of inertia."""
    if not quantity.parts:
        return [] if without == "inertia" else [quantity]
    return [quantity.part(name) for name in quantity.parts if name != without]


def _mounts(powertrain: Powertrain) -> list[dict[str, Any]]:
    """Return what the deflection of each mount and its stiffness are sums of.

    Its deflection along its axes is linear in the motion and in its place: three matrices beside
    that at its own place say all of it.
    """
    own = powertrain._core.deflections()
    # At places one metre off along x, y and z.
    slopes = np.stack([_deflections(powertrain, step) - own for step in np.eye(3)], axis=1)
    return [
        {
            "name": mount.name,
            **placed(mount),
            "axes": matrix[:, :3].tolist(),
            "deflection": matrix.tolist(),
            "slopes": by_place.tolist(),
            **_stiffness(mount),
        }
        for mount, matrix, by_place in zip(powertrain.mounts, own, slopes, strict=True)
    ]


def _deflections(powertrain: Powertrain, step: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the deflections of mounts that stand a step away."""
    with suppressed():
        moved = [mount.replace(at=np.add(mount.at, step)) for mount in powertrain.mounts]
    figures = [mount._figures for mount in moved]
    return _core.Powertrain(powertrain.body._figures, figures, None).deflections()


def _stiffness(mount: Mount) -> dict[str, Any]:
    """Return the complex stiffness along the axes, of a table or as coefficients.

    ``unit`` is that of 1 N/m of rubber, ``viscous`` what an angular speed of 1 rad/s adds, and
    ``track`` a quotient of polynomials in the frequency, over that of the fluid.
    """
    if mount.table is not None:
        frequency, stiffness = mount.table
        rows = [_pairs(np.array(row)) for row in stiffness]
        return {"table": {"frequency": list(frequency), "stiffness": rows}}
    with suppressed():
        plain = mount.replace(stiffness=1.0, dynamic_stiffness=None, damping=0.0, track=None)
        damper = mount.replace(stiffness=0.0, dynamic_stiffness=None, track=None)
    once = labels.UNIT_RPM / 60.0
    return {
        "table": None,
        "unit": _pairs(plain.dynamic_at(once)),
        "viscous": _pairs(damper.dynamic_at(once)),
        "track": None if mount.track is None else _track(mount, mount.track.frequency),
    }


def _track(mount: Mount, frequency: float) -> dict[str, Any]:
    """Return the fluid's part of the stiffness: (ax + bx²)/(1 + cx + dx²), x = f over the fluid's.

    Four values determine the four coefficients.
    """
    with suppressed():
        fluid = mount.replace(stiffness=0.0, dynamic_stiffness=None, damping=0.0, loss_factor=0.0)
    x = np.array(TRACK_POINTS)
    values = np.array([fluid.dynamic_at(frequency * each)[0] for each in TRACK_POINTS])
    rows = np.stack([x, x**2, -values * x, -values * x**2], axis=1)
    coefficients = _pairs(np.linalg.solve(rows, values))
    return {"frequency": frequency, "above": coefficients[:2], "below": coefficients[2:]}


def _box(powertrain: Powertrain) -> list[list[float]]:
    """Return the corners of the even box with the body's mass and inertia, m, in binary order."""
    body = powertrain.body
    moments, directions = np.linalg.eigh(np.array(body.inertia))
    squares = 6.0 * (moments.sum() - 2.0 * moments) / body.mass
    halves = 0.5 * np.sqrt(np.maximum(squares, 0.0))
    signs = np.array([[1 - 2 * (k >> axis & 1) for axis in range(3)] for k in range(8)])
    corners: list[list[float]] = (body.cg + (signs * halves) @ directions.T).tolist()
    return corners


def _pairs(values: NDArray[np.complex128]) -> list[list[float]]:
    return [[float(value.real), float(value.imag)] for value in values]
