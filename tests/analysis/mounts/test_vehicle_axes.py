"""Are figures in the axes of a vehicle those of the engine's, turned?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from analysis.mounts.test_mount_supports import NEEDED, readings
from crankpin.analysis.labelled import Labelled
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

ENGINE = cp.Engine.preset("i4")
WORDS = ("back, right, up", "forward, left, up", "forward, right, down", "back, left, up")
FLYWHEELS = ("back", "forward", "left", "right")
"""The last of the axes are left-handed."""


def drawn(seed: int) -> tuple[cp.Powertrain, cp.VehicleAxes]:
    """Return a powertrain in the engine's axes, of decimals, and axes of a vehicle."""
    draw = np.random.default_rng(seed)
    decimals = np.arange(-0.5, 0.51, 0.013).round(3)
    products = draw.choice([0.0, 0.3, -0.2], 3)
    tensor = np.diag([7.0, 8.0, 4.5])
    tensor[np.triu_indices(3, 1)] = tensor.T[np.triu_indices(3, 1)] = products
    body = cp.RigidBody(160.0, draw.choice(decimals, 3), tensor + 0.0, products="tensor")
    mounts = [
        cp.Mount(
            f"{k}",
            np.add(draw.choice(decimals, 3), at).round(3),
            draw.choice([1e5, 2e5, 3e5], 3),
            loss_factor=0.1,
            gap=0.002,
            snubber_stiffness=draw.choice([0.0, 1e6], (3, 2)).tolist(),
        )
        for k, at in enumerate([(0.6, 0, 0), (-0.6, 0, 0), (0, 0, 0.9), (0, 0.5, -0.9)])
    ]
    rest = {"torque": 300.0, "gravity": (1.0, -9.0, 0.5), "acceleration": (0.0, 0.0, 3.0)}
    p = cp.Powertrain(ENGINE, body, mounts, rest=rest if draw.integers(2) else None)
    origin = draw.choice(decimals * 3, 3).round(3)
    return p, cp.VehicleAxes(str(draw.choice(WORDS)), str(draw.choice(FLYWHEELS)), origin)


@in_turn("seed", range(40))
def test_round_trips_are_exact(seed: int) -> None:
    p, vehicle = drawn(seed)
    seen = p.in_axes(vehicle)
    back = seen.in_axes(None)
    assert back.body == p.body
    assert back.mounts == p.mounts
    assert vehicle.from_engine(vehicle.to_engine((0.123, -1.7, 0.05))) == (0.123, -1.7, 0.05)
    assert seen.in_axes(vehicle) is seen
    subframe = cp.Subframe(p.body, p.mounts)
    assert vehicle.to_engine(vehicle.from_engine(subframe)) == subframe


def by_hand(vehicle: cp.VehicleAxes) -> np.ndarray:
    """Columns: the engine's axes in the vehicle's, of words alone."""
    opposite = {"forward": "back", "left": "right", "up": "down"}
    opposite |= {b: a for a, b in opposite.items()}
    # Seen from the flywheel, which side is the right one?
    right = {"back": "right", "forward": "left", "left": "back", "right": "forward"}
    columns = []
    for word in (right[vehicle.flywheel], "up", vehicle.flywheel):
        named = vehicle.directions.split(", ")
        columns.append([(d == word) - (opposite[d] == word) for d in named])
    return np.array(columns, dtype=float).T


@in_turn("seed", range(30))
def test_every_figure_is_turned(seed: int) -> None:
    p, vehicle = drawn(seed)
    turn, origin = by_hand(vehicle), np.array(vehicle.origin)
    hand = np.linalg.det(turn)
    seen = p.in_axes(vehicle)
    assert seen.body.cg == pytest.approx(turn @ p.body.cg + origin, abs=1e-12)
    np.testing.assert_array_equal(seen.body.inertia, turn @ p.body.inertia @ turn.T)
    cases: dict[str, Any] = {"torque": 400.0, "acceleration": np.array([3.0, 0.0, -2.0])}
    turned = cases | {"acceleration": turn @ cases["acceleration"]}
    results = [
        (p.static(**cases), seen.static(**turned)),
        (p.load_cases({"a": cases}), seen.load_cases({"a": turned})),
        (p.axes(), seen.axes()),
        (p.modes(), seen.modes()),
    ]
    one, other = (each.response([900, 3000], orders=[1, 2]) for each in (p, seen))
    point = np.array([0.1, 0.3, -0.2])
    results += [(one, other), (one.at(point), other.at(turn @ point + origin))]
    results += [(one.about(point), other.about(turn @ point + origin))]
    assert list(results[-1][0].error_bound.values()) == pytest.approx(
        list(results[-1][1].error_bound.values()), rel=1e-9
    )
    assert (one.at(point).grade == other.at(turn @ point + origin).grade).all()
    for plain, found in results:
        for name, quantity in plain.quantities.items():
            expected, values = np.asarray(quantity), np.asarray(found.quantities[name])
            kind = quantity.kind
            if kind.axes:
                pseudo = hand if kind.components[0].startswith("about") else 1.0
                expected = pseudo * expected @ turn.T
                if name.endswith("_foot"):
                    expected = expected + origin
            elif "transmissibility" in name:
                order = np.abs(turn).argmax(axis=1)
                expected = expected[..., [*order, *(3 + order)]]
            elif kind.dims[-1:] == ("component",):
                halves = expected[..., :3] @ turn.T, hand * expected[..., 3:] @ turn.T
                expected = np.concatenate(halves, axis=-1)
            # Rounding of solutions from figures whose differences round otherwise.
            scale = np.nanmax(np.abs(expected), initial=0.0, where=np.isfinite(expected))
            np.testing.assert_allclose(values, expected, rtol=1e-9, atol=1e-11 * scale)


@pytest.mark.parametrize("name", readings())
def test_no_reading_forgets_the_axes(name: str, tmp_path: Path) -> None:
    """What is read is turned, or rejected: a reading that is neither has wrong numbers."""
    p, vehicle = drawn(3)
    p = p.replace(mounts=[m.replace(snubber_stiffness=0.0) for m in p.mounts], rest=None)
    assert p.in_axes(vehicle).in_axes(None) == p
    arguments = dict(NEEDED.get(name, {}))
    if "path" in arguments:
        arguments["path"] = tmp_path / "page.html"
    if name in ("modes", "axes", "static", "response", "load_cases"):
        assert isinstance(readings()[name](p.in_axes(vehicle), **arguments), Labelled)
        return  # test_every_figure_is_turned
    with pytest.raises(cp.InputError, match=r"is undefined in the axes x .*in_axes\(None\)"):
        readings()[name](p.in_axes(vehicle), **arguments)


def test_a_tilted_engine_of_a_car(tmp_path: Path) -> None:
    """A transverse engine of CAD: x back, y right, z up, mm, tilted by 12° towards the rear."""
    mm = 1e-3
    vehicle = cp.VehicleAxes(
        "back, right, up", "left", origin=np.multiply(mm, (1450, 210, 360)), incline_deg=-12
    )
    # Seen from the flywheel, on the left, back is to the right: tilted back is clockwise.
    assert vehicle._vectors((0, 1, 0)) == pytest.approx(
        (np.sin(np.radians(12)), 0, np.cos(np.radians(12)))
    )
    body = cp.RigidBody(
        mass=182,
        cg=np.multiply(mm, (1432, 120, 402)),
        inertia=[[5.2, 0.4, -0.3], [0.4, 11.8, 0.2], [-0.3, 0.2, 12.4]],
        products="positive-integrals",
    )
    mounts = [
        cp.Mount("right", np.multiply(mm, (1440, 480, 560)), stiffness=(1.2e5, 1e5, 2.4e5)),
        cp.Mount("left", np.multiply(mm, (1420, -420, 520)), stiffness=(1.2e5, 1e5, 2.2e5)),
        cp.Mount("roll rod", np.multiply(mm, (1650, 60, 180)), stiffness=(3e5, 0, 0)),
    ]
    car = cp.Powertrain(ENGINE, body, mounts, vehicle=vehicle)
    state = car.static()
    # Down is down, whatever the engine's tilt; the rod bears no weight up and down.
    assert state.weight_force[:, 2].sum() == pytest.approx(-182 * 9.80665)
    assert state.weight_force[:, :2].sum(axis=0) == pytest.approx([0, 0], abs=1e-9)
    assert state.weight_force[2, 1:] == pytest.approx([0, 0], abs=1e-12)
    # By hand: moments about x, across the vehicle, of two mounts alone.
    share = (0.120 + 0.420) / 0.900
    assert state.weight_force[0, 2] == pytest.approx(-share * 182 * 9.80665, rel=0.05)
    drive = car.static(1500.0)
    # Torque about the crank, towards the left: +1500 leaves, so the body turns the other way.
    moment = np.cross(np.subtract([m.at for m in mounts], body.cg), drive.torque_force).sum(axis=0)
    assert moment == pytest.approx([0, 1500, 0], abs=1e-6)
    assert "(x back, y right, z up)" in str(drive.table.title)
    plain = car.in_axes(None)
    assert plain.vehicle is None
    assert plain.modes().frequency == pytest.approx(np.asarray(car.modes().frequency), rel=1e-12)
    # Gravity stays down, in a file too.
    tilted = vehicle._vectors(plain.static().preload)
    np.testing.assert_allclose(tilted, state.preload, rtol=0, atol=1e-6)
    car.save(tmp_path / "car.toml")
    loaded = cp.Powertrain.load(tmp_path / "car.toml").static().preload
    np.testing.assert_allclose(vehicle._vectors(loaded), state.preload, rtol=0, atol=1e-6)
    back = plain.in_axes(vehicle)
    assert back.body.cg == pytest.approx(body.cg, abs=1e-15)
    np.testing.assert_allclose(back.body.inertia, body.inertia, rtol=0, atol=1e-14)
    assert body.inertia[0][1] == -0.4


def test_files_are_in_the_axes_of_the_engine(tmp_path: Path) -> None:
    p, vehicle = drawn(1)
    p.in_axes(vehicle).save(tmp_path / "p.toml")
    assert cp.Powertrain.load(tmp_path / "p.toml") == p


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("back, right",), r"^directions = 'back, right': give those of x, y and z"),
        (("back, forward, up",), r"^directions = "),
        (("back, right, aft",), r"^directions = "),
        (("back, right, up", "up"), r"^flywheel = 'up': give"),
        (("back, right, up", "back", (0, 0)), r"^origin = "),
        (("back, right, up", "back", (0, 0, 0), np.inf), r"^incline_deg = inf"),
        ((3,), r"^directions"),
    ],
)
def test_bad_axes_are_named(arguments: tuple[Any, ...], words: str) -> None:
    with pytest.raises(cp.InputError, match=words):
        cp.VehicleAxes(*arguments)


def test_what_cannot_be_turned_is_rejected() -> None:
    p, vehicle = drawn(0)
    with pytest.raises(cp.InputError, match=r"^vehicle = 'vehicle': give a crankpin.VehicleAxes"):
        cp.Powertrain(ENGINE, p.body, p.mounts, vehicle="vehicle")  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"^vehicle = 3: give a crankpin.VehicleAxes"):
        p.in_axes(3)  # type: ignore[arg-type]
    table = (np.array([1.0, 200.0]), np.full((2, 1, 1), 1e-7 - 1e-9j))
    floor = cp.Receptance([("0", "y")], table)
    with pytest.raises(cp.InputError, match="a receptance is measured along the engine's axes"):
        p.with_support(floor).in_axes(vehicle)
    with pytest.raises(cp.InputError, match="a receptance is measured along the engine's axes"):
        cp.Powertrain(ENGINE, p.body, p.mounts, floor, vehicle=vehicle)
    with pytest.raises(cp.InputError, match=r"^z is undefined in the axes"):
        p.in_axes(vehicle).response(3000, orders=[2]).about(z=0.1)
    with pytest.raises(cp.InputError, match=r"^base is undefined in the axes"):
        p.in_axes(vehicle).response(base=cp.BaseMotion({5.0: (0, 1e-3, 0)}))
    with pytest.raises(cp.InputError, match=r"^of = 'a': give three numbers"):
        vehicle.to_engine("a")


def test_an_elastic_centre_is_turned() -> None:
    mounts = [
        cp.Mount(f"{x} {z}", (x, -0.2, z), (1e5, 3e5, 2e5))
        for x in (0.3, -0.3)
        for z in (-0.3, 0.3)
    ]
    p = cp.Powertrain(ENGINE, cp.RigidBody(150.0, (0.0, 0.0, 0.0), (7, 8, 4.5)), mounts)
    vehicle = cp.VehicleAxes("back, right, up", "left", (1.45, 0.21, 0.36))
    centre = p.axes().elastic_centre
    assert centre is not None
    assert vehicle.from_engine(centre) == p.in_axes(vehicle).axes().elastic_centre
    assert p.in_axes(vehicle).axes().elastic_centre == pytest.approx((1.45, 0.21, 0.16))
