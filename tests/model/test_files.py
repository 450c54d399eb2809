"""Engine files and copies keep everything an engine was given, whatever its size."""

from __future__ import annotations

import copy
import dataclasses
import os
import pickle
import threading
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.balancing import planes
from crankpin.model.crankpins import bays
from support.engines import CYLINDER, I4

if TYPE_CHECKING:
    from pathlib import Path


def copies(engine: cp.Engine) -> list[cp.Engine]:
    """The engine by every way there is back to it."""
    return [
        cp.Engine.from_toml(engine.to_toml()),
        cp.Engine.from_json(engine.to_json()),
        pickle.loads(pickle.dumps(engine)),  # noqa: S301 - its own
        copy.deepcopy(engine),
        engine.replace(),
        engine.replace(name=engine.name),
    ]


def test_a_vee_at_0_degrees_has_two_banks_everywhere() -> None:
    v6 = cp.Engine.vee(
        CYLINDER, bank_angle_deg=0, throws_deg=[0, 120, 240], pin_split_deg=-120, spacing=0.1
    )
    assert v6.banks == {"right": (1, 3, 5), "left": (2, 4, 6)}
    assert v6.firing("1-2-3-4-5-6").banks == ((1, 3, 5), (2, 4, 6))
    for each in copies(v6):
        assert each == v6
        assert each.banks == v6.banks


@pytest.mark.parametrize("bank_deg", [(10, 70), (70, 10), (60, 120), (200, 260)])
@pytest.mark.parametrize("opened", [0, 180])
def test_a_bank_keeps_its_side_where_directions_do_not_tell_it(
    bank_deg: tuple[float, float], opened: float
) -> None:
    engine = cp.Engine.from_lists(CYLINDER, tdc_deg=[0, 0], bank_deg=bank_deg, z=[0, 0.1])
    flat = engine.with_bank_angle(opened, hold="pins")
    closed = flat.with_bank_angle(60, hold="pins")
    assert closed == engine
    for each in copies(flat):
        assert each == flat
        assert each.banks == flat.banks
        assert each.with_bank_angle(60, hold="pins") == closed


def test_flat_engines_need_no_number_of_their_banks() -> None:
    flat = cp.Engine.flat(CYLINDER, throws_deg=[0, 180], spacing=0.1)
    assert "bank = " not in flat.to_toml()
    assert flat.banks == {"right": (1, 3), "left": (2, 4)}


def test_engines_of_many_unbalances_are_copied_and_read_back() -> None:
    weights = [cp.Unbalance(1e-6 / 3, z=k / 7000, angle_deg=k * 0.1) for k in range(1000)]
    engine = I4.with_shafts([cp.Shaft(2, weights, x=0.1) for _ in range(20)])
    assert len(engine.to_toml()) > 1 << 20  # the former limit
    for each in copies(engine):
        assert each == engine


def test_a_file_without_end_is_not_read_to_its_end(tmp_path: Path) -> None:
    pipe = tmp_path / "endless.toml"
    os.mkfifo(pipe)
    written = 0

    def write() -> None:
        nonlocal written
        try:
            with pipe.open("wb") as file:
                while written < 1 << 30:
                    written += file.write(b"# more\n" * 10_000)
        except BrokenPipeError:
            pass

    thread = threading.Thread(target=write)
    thread.start()
    with pytest.raises(cp.InputError, match="an engine file has at most 16777216"):
        cp.Engine.load(pipe)
    thread.join()
    assert written < 1 << 25  # the limit, and what the pipe held


@pytest.mark.parametrize("path", ["a\0.toml", b"engine.toml", 3, None])
def test_paths_that_are_none_are_rejected_by_name(path: object) -> None:
    with pytest.raises(cp.InputError, match="path = "):
        cp.Engine.load(path)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match="path = "):
        I4.save(path)  # type: ignore[arg-type]


def test_moments_are_about_the_engine_s_own_plane() -> None:
    cylinder = cp.Cylinder(0.045, 0.15, 0.5)
    twin = cp.Engine.inline(cylinder, throws_deg=[0, 0], spacing=0.1)
    about = twin.replace(reference_z=0.3)
    assert (twin.reference_z, about.reference_z) == (0.05, 0.3)
    assert twin.balance(3000).moment.peak.tolist() == [0.0] * len(twin.balance(3000).orders)
    force, moment = (getattr(about.balance(3000)[1], name).peak for name in ("force", "moment"))
    np.testing.assert_allclose(moment, 0.25 * force, rtol=1e-12)  # ε times a handful of products
    for each in copies(about):
        assert each == about
        assert each.reference_z == 0.3
    assert about.replace(reference_z=None) == twin


def test_figures_that_forces_do_not_depend_on_are_kept() -> None:
    rod = cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)
    cylinder = cp.Cylinder.from_rod(rod, crank_radius=0.045, piston_mass=0.4, bore=0.088)
    engine = cp.Engine.inline(
        cylinder, throws_deg=[0, 180], spacing=0.1, rotating_mass=rod.rotating_mass
    ).replace(mains=[-0.05, 0.15])
    for each in [engine, *copies(engine), engine.with_first_tdc(30), engine.with_shafts([])]:
        (found, _) = each.cylinders
        assert (found.bore, found.piston_mass, found.rod) == (0.088, 0.4, rod)
        assert found == cylinder
        assert each.mains.tolist() == [-0.05, 0.15]
    np.testing.assert_allclose(engine.replace(mains=None).mains, [-0.05, 0.05, 0.15], rtol=1e-15)


def test_what_was_made_of_a_rod_stays_consistent() -> None:
    rod = cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)
    cylinder = cp.Cylinder.from_rod(rod, crank_radius=0.045, piston_mass=0.4, bore=0.088)
    lighter = cylinder.replace(piston_mass=0.3)
    assert (lighter.rod, lighter.reciprocating_mass) == (rod, 0.3 + rod.reciprocating_mass)
    longer = cylinder.replace(rod=dataclasses.replace(rod, length=0.2))
    assert (longer.rod_length, longer.piston_mass, longer.bore) == (0.2, 0.4, 0.088)
    for name in ("rod_length", "reciprocating_mass", "rod_inertia_excess"):
        given = cylinder.replace(**{name: 0.3})
        assert (given.rod, given.piston_mass, given.bore) == (None, None, 0.088)
    with pytest.raises(cp.InputError, match=r"^rod_length = 0.16: rod and .* make it 0.15"):
        cp.Cylinder(0.045, 0.16, 0.6, rod=rod, piston_mass=0.4)
    with pytest.raises(cp.InputError, match="give piston_mass too"):
        cp.Cylinder(0.045, 0.16, 0.6).replace(rod=rod)
    text = cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.1).to_toml()
    with pytest.raises(cp.InputError, match=r"reciprocating_mass = 0.7.*: rod and piston"):
        cp.Engine.from_toml(text.replace("reciprocating_mass = 0.6", "reciprocating_mass = 0.7"))


@pytest.mark.parametrize(
    ("mains", "message"),
    [
        ([0.0, 0.2], "the throw of cylinder 1 is .* give places in front of, between and behind"),
        ([-0.05, 0.25], "the throw of cylinder 4 is outside"),
        ([-0.1, 0.1, 0.4], "the throw of cylinder 2 is outside or at a bearing"),
        ([0.1], "give two or more places"),
        ([0.4, -0.1], "give two or more places in m, ascending"),
        ("none", "give numbers"),
    ],
)
def test_mains_have_throws_between_them(mains: Any, message: str) -> None:  # noqa: ANN401
    with pytest.raises(cp.InputError, match=f"mains = .*{message}"):
        I4.replace(mains=mains)


def test_bays_are_between_the_main_bearings() -> None:
    """An old inline-4 with three main bearings has two throws in each bay."""
    three = I4.replace(mains=[-0.05, 0.15, 0.35])
    front, rear = bays(three)
    assert (front.cylinders, front.throws, front.bearings) == ((1, 2), (0.0, 0.1), (-0.05, 0.15))
    np.testing.assert_allclose(front.webs, [-0.025, 0.05, 0.125], rtol=1e-15)
    assert (rear.cylinders, rear.bearings) == ((3, 4), (0.15, 0.35))
    assert len(bays(I4)) == 4
    webs = planes.named(three, "webs")
    assert list(webs)[:3] == ["bay 1 web 1", "bay 1 web 2", "bay 1 web 3"]
    spaced = I4.replace(mains=[-0.05, 0.05, 0.06, 0.15, 0.35])  # two side by side
    assert [bay.cylinders for bay in bays(spaced)] == [(1,), (2,), (3, 4)]
