"""Are bodies, mounts and powertrains that cannot be right rejected or warned of by name?"""

from __future__ import annotations

import copy
import pickle
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

I4 = cp.Engine.preset("i4")
BODY = cp.RigidBody(
    150.0, (0, 0.06, 0.1), [[6, 0.4, -0.9], [0.4, 8.5, 0.3], [-0.9, 0.3, 3.2]], "tensor"
)
TABLE = ([5.0, 50.0], np.full((2, 3), 1e5 + 1e4j))
MOUNTS = [
    cp.Mount("right", (0.3, 0, 0), (2e5, 8e4, 8e4), tilt_deg=130, loss_factor=0.1),
    cp.Mount("left", (-0.3, 0, 0), 1e5, axes=[[0, 1, 0], [-1, 0, 0], [0, 0, 1]], damping=100),
    cp.Mount("rear", (0, 0, 0.6), 1e5, table=TABLE),
]
P = cp.Powertrain(I4, BODY, MOUNTS)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"loss_factor": -0.1}, r"loss_factor\[0\] = -0\.1: give zero or more; .*conjugate"),
        ({"damping": (1, -2, 1)}, r"damping\[1\] = -2"),
        ({"stiffness": -1e5}, r"stiffness\[0\] = -100000"),
        ({"stiffness": (1e5, 1e5)}, "stiffness = .*three numbers"),
        ({"at": (0, 0)}, "at = .*three numbers"),
        ({"at": (0, 0, np.nan)}, r"at\[2\] = nan"),
        ({"axes": np.ones((3, 3))}, "axes = .*right angles"),
        ({"axes": np.eye(2)}, r"axes has shape \(2, 2\)"),
        ({"axes": np.eye(3), "tilt_deg": 10}, "tilt_deg = 10"),
        ({"track": 3}, "track = 3: give a crankpin.InertiaTrack"),
        ({"table": ([5, 50], np.full((2, 3), 1e5 - 1e4j))}, "table: .*loss is below zero"),
        ({"table": ([50, 5], TABLE[1])}, r"table: frequency\[1\] = 5\.0: .*ascending"),
        ({"table": ([5.0], TABLE[1][:1])}, "give two or more frequencies"),
        ({"table": ([5.0, np.nan], TABLE[1])}, r"frequency\[1\] = NaN"),
        ({"table": TABLE, "loss_factor": 0.1}, "loss_factor = given beside a table"),
        ({"table": 7}, "table = 7: give a pair"),
        ({"rigidity": 1}, "replace = 'rigidity'.*stiffness"),
    ],
)
def test_impossible_mounts_are_rejected(change: dict[str, Any], said: str) -> None:
    with pytest.raises(cp.InputError, match=said):
        cp.Mount("plain", (0, 0, 0), 1e5).replace(**change)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"mass": 0}, "mass = 0"),
        ({"inertia": (1, 2)}, r"inertia has shape \(2,\)"),
        ({"inertia": (1, 2, -1)}, "inertia = -1"),
        (
            {"inertia": [[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]], "products": "tensor"},
            r"inertia\[0\]\[1\]",
        ),
        (
            {"inertia": [[1, 0.1, 0], [0.1, 1, 0], [0, 0, 1]], "products": None},
            "products = None: give",
        ),
        ({"products": "cad"}, "products = 'cad'"),
    ],
)
def test_impossible_bodies_are_rejected(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(cp.InputError, match=said):
        cp.RigidBody(**{"mass": 100, "cg": (0, 0, 0), "inertia": (7, 8, 5), **fields})


def test_impossible_tensors_are_warned_of_with_their_figures() -> None:
    with pytest.warns(
        UserWarning, match=r"principal moments of 1, 2, 3\.19149 .* lacks 6 %"
    ) as caught:
        cp.RigidBody(100, (0, 0, 0), (1, 2, 3 / 0.94))
    assert len(caught) == 1
    cp.RigidBody(100, (0, 0, 0), (1, 2, 3 * (1 + 1e-12)))  # by rounding: not warned of


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: cp.Mount("a", (0, 0, 0), 200), "stiffness of mount 'a' = 200 N/m: .*N/mm"),
        (
            lambda: cp.Mount("a", (0, 0, 0), 2e5, dynamic_stiffness=240),
            "dynamic_stiffness of mount 'a' = 240 N/m: .*N/mm",
        ),
        (
            lambda: cp.Mount("a", (0, 0, 0), 2e5, table=([5, 50], np.full((2, 3), 240 + 7j))),
            "table of mount 'a' = 240.* N/m: .*N/mm",
        ),
        (lambda: cp.Mount("a", (280, 0, 0), 2e5), "at of mount 'a' .*millimetres"),
        (lambda: cp.Actuator("a", (280, 0, 0), (0, 1, 0)), "at = .*millimetres"),
        (lambda: P.response(800, orders=[2]).at((0, 300, 0)), "point = .*millimetres"),
        (
            lambda: P.designs([800], {"left": {"at": [(280, 0, 0), (-300, 0, 0)]}}, orders=[2]),
            r"vary\['left'\]\['at'\] = \(300.*millimetres",
        ),
        (lambda: cp.RigidBody(100, (0, 60, 0), (7, 8, 5)), "cg = .*millimetres"),
        (lambda: cp.RigidBody(100, (0, 0, 0), (7e6, 8e6, 5e6)), "radii of gyration"),
        (lambda: cp.RigidBody(1e5, (0, 0, 0), (7e-3, 8e-3, 5e-3)), "radii of gyration"),
        (lambda: cp.RigidBody(150e3, (0, 0, 0), (7, 8, 4.5)), "mass = 150000 kg .*grams"),
        (lambda: cp.Mount("a", (0, 0, 0), 2e5, damping=0.2), "damping of mount 'a' .*N·s/mm"),
        (lambda: cp.Mount("a", (0, 0, 0), 2e5, loss_factor=8), "loss_factor of mount .*per cent"),
    ],
)
def test_other_units_are_warned_of(make: Callable[[], object], said: str) -> None:
    with pytest.warns(UserWarning, match=said) as caught:
        make()
    assert len(caught) == 1
    assert caught[0].filename == __file__


@pytest.mark.parametrize("mounts", [MOUNTS[:2], [MOUNTS[0], MOUNTS[2].replace(at=(0, 0, 0))]])
def test_two_mounts_are_warned_of_where_they_are_asked_to_resist(mounts: list[cp.Mount]) -> None:
    """A hydraulic mount or a table has modes at a frequency alone: that of the lowest order."""
    p = P.replace(mounts=mounts)
    said = f"mounts = {mounts[0].name}, {mounts[1].name}: rotation about the line .* is free"
    with pytest.warns(UserWarning, match=f"{said}, .*add a mount") as caught:
        p.response([500.0, 800.0], orders=[1])
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_impossible_questions_are_rejected() -> None:
    with pytest.raises(
        cp.InputError, match=r"mount \"rear\" = 100\.000000 Hz: order 2 at 3000 rpm"
    ):
        P.response(3000, orders=[2])
    with pytest.raises(cp.InputError, match='frequency = None: the stiffness of mount "rear"'):
        P.modes()
    with pytest.raises(cp.InputError, match="cylinder = 2: no cylinder fires"):
        P.with_misfire(2)
    bored = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    fired = P.replace(engine=cp.Engine.preset("single", cylinder=bored).replace(firing_order="1"))
    assert fired.engine is not None
    fired = fired.replace(engine=fired.engine.with_cycle(cp.Cycle.example(), crankcase=9e4))
    with pytest.raises(cp.InputError, match="cylinder = 1: it is the last that fires"):
        fired.with_misfire(1)
    with pytest.raises(cp.InputError, match="torque = 'engine'"):
        P.static("engine")
    with pytest.raises(cp.InputError, match="gear_ratio = 0"):
        P.static(100, gear_ratio=0)
    with pytest.raises(cp.InputError, match="mounts = 0 mounts"):
        P.replace(mounts=[])
    with pytest.raises(cp.InputError, match="is the name of another mount"):
        P.replace(mounts=[MOUNTS[0], MOUNTS[0]])
    with pytest.raises(cp.InputError, match="mounts = right, left: rotation about the line"):
        P.replace(mounts=MOUNTS[:2]).static()
    with pytest.raises(cp.InputError, match="rpm = 700: is not among"):
        P.response([800.0, 900.0], orders=[2]).sel(rpm=700)
    bare = P.replace(mounts=[cp.Mount(f"{k}", at, 1e5) for k, at in enumerate(np.eye(3).tolist())])
    frequency = bare.modes().frequency[0]
    with pytest.raises(cp.InputError, match=r"order 2 is at .* mode without damping"):
        bare.response(30.0 * frequency, orders=[2])


def test_powertrains_read_back_from_files(tmp_path: Path) -> None:
    for name in ("p.toml", "p.json"):
        P.save(tmp_path / name)
        assert cp.Powertrain.load(tmp_path / name) == P
        assert cp.Engine.load(tmp_path / name) == I4
    text = (tmp_path / "p.toml").read_text("utf-8")
    assert "inertia = [[6.0, 0.4, -0.9]" in text
    assert "# kg·m², tensor about the centre" in text
    I4.save(tmp_path / "engine.toml")
    with pytest.raises(cp.InputError, match=r"has no \[powertrain\]"):
        cp.Powertrain.load(tmp_path / "engine.toml")


@pytest.mark.parametrize("ending", ["toml", "json"])
def test_an_engine_alone_replaces_no_mounts(tmp_path: Path, ending: str) -> None:
    P.save(path := tmp_path / f"car.{ending}")
    written = path.read_text(encoding="utf-8")
    engine = cp.Engine.load(path)
    with pytest.raises(cp.InputError, match=r"its \[powertrain\] would be lost"):
        engine.save(path)
    assert path.read_text(encoding="utf-8") == written
    engine.save(other := tmp_path / f"engine.{ending}")
    engine.save(other)  # which has none
    other.write_text("no engine", encoding="utf-8")
    engine.save(other)
    assert cp.Engine.load(other) == engine


def test_inputs_and_results_are_frozen_records() -> None:
    r = P.response([800.0, 900.0], orders=[2])
    results: list[Any] = [P.static(10), P.modes(20.0), P.axes(20.0), r, r[2], r.at((0, 0, 0))]
    for each in [P, BODY, *MOUNTS, *results]:
        assert pickle.loads(pickle.dumps(each)) == each  # noqa: S301 - our own
        assert copy.copy(each) is each
        assert hash(each) == hash(copy.deepcopy(each))
        with pytest.raises(AttributeError):
            each.anything = 1
    assert BODY.replace(mass=160.0).inertia == BODY.inertia
    assert not r.wrench.flags.writeable
    assert not r.body_force.xyz.flags.writeable
    for each in results[:4]:
        assert len(each.table) > 1
        assert "\n" in repr(each)
    assert len(P.modes(20.0).frames["strain"]) == 6
    assert "T F_y" in r.sel(rpm=800.0).frames["loads"]


def test_datasets_have_dimensions_and_units() -> None:
    pytest.importorskip("xarray")
    data = P.response([800.0, 900.0], orders=[2]).to_xarray()
    assert data.mount_force.dims == ("rpm", "order", "mount", "axis")
    assert data.mount_force.attrs["units"] == "N"


def test_bodies_as_dense_as_any_metal_are_not_warned_of() -> None:
    """Balls and plates of osmium, 22 590 kg/m³; a car's engine has a fifteenth of that."""
    for radius in (0.01, 0.3, 2.0):
        mass = 22590 * 4 / 3 * np.pi * radius**3
        cp.RigidBody(mass, (0, 0, 0), (0.4 * mass * radius**2,) * 3)
    for a, b, c in [(0.5, 0.5, 0.01), (1.0, 0.05, 0.05), (0.3, 0.2, 0.1)]:
        mass = 22590 * a * b * c
        cp.RigidBody(mass, (0, 0, 0), mass / 12 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2]))
    cp.Mount("a", (0, 0, 0), 2e5, damping=5, loss_factor=1.2)
    cp.Mount("a", (0, 0, 0), (2e5, 0, 0), damping=(50, 0, 0))
