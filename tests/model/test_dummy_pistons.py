"""Dummy pistons, which balance and do not fire: firing orders, gas, files, and the shell."""

from __future__ import annotations

import pickle
import re
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from crankpin.view.figures import places
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

PISTON = cp.Cylinder(0.036, 0.124, 0.5, bore=0.1)
DUMMY = PISTON.replace(dummy=True, bore=None)
PETROL = cp.Cycle.example()


def single(**changes: object) -> cp.Engine:
    """Return a single with a dummy piston at a right angle, as the Ducati Supermono has one."""
    arguments: dict[str, object] = {"bank_angle_deg": 90, "throws_deg": [0], "spacing": 0.08}
    arguments["firing_order"] = "1"
    return cp.Engine.vee([PISTON, DUMMY], **arguments | changes)  # type: ignore[arg-type]


def test_a_dummy_piston_balances_and_has_no_gas() -> None:
    engine = single()
    assert engine.firing_order == "1"
    assert engine.firing_intervals_deg.tolist() == [720.0]
    twin = cp.Engine.vee(PISTON, bank_angle_deg=90, throws_deg=[0], spacing=0.08)
    for one, other in zip(
        engine.balance(6000).frames.values(), twin.balance(6000).frames.values(), strict=True
    ):
        assert one.to_csv() == other.to_csv()
    fired = engine.with_cycle(PETROL)
    assert fired.cycles == (PETROL, None)
    assert fired.loads_counted.endswith("cylinder 2 does not fire")
    alone = cp.Engine.inline(PISTON, throws_deg=[0], spacing=0.08, firing_order="1")
    mean = alone.with_cycle(PETROL).balance(6000).crank_torque.cycle_mean
    assert fired.balance(6000).crank_torque.cycle_mean == pytest.approx(mean, rel=1e-12)
    with pytest.raises(cp.InputError, match=r"cycle\[1\] .*a dummy piston has no gas"):
        engine.with_cycle([PETROL, PETROL])


@in_turn("seed", range(8))
def test_dummies_have_no_place_in_firing_orders(seed: int) -> None:
    """An engine with dummies fires as those of its cylinders do that fire."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 7))
    tdc = rng.choice([0, 90, 180, 270], count)
    dummy = rng.random(count) < 0.4
    dummy[int(rng.integers(count))] = False
    each = [PISTON.replace(dummy=bool(one)) for one in dummy]
    bank, z = [90] * count, np.arange(count) * 0.1
    engine = cp.Engine.from_lists(each, tdc_deg=tdc, bank_deg=bank, z=z)
    numbers = np.flatnonzero(~dummy) + 1
    firing = cp.Engine.from_lists(
        PISTON, tdc_deg=tdc[~dummy], bank_deg=bank[: len(numbers)], z=z[~dummy]
    )
    known = [tuple(each.intervals_deg) for each in firing.firing_orders()]
    found = engine.firing_orders()
    assert sorted(tuple(each.intervals_deg) for each in found) == sorted(known)
    for order in found:
        named = sorted(map(int, re.findall(r"\d+", order.firing_order)))
        assert named == numbers.tolist()
        again = engine.replace(firing_order=order.firing_order)
        assert again.firing_order == order.firing_order
        assert again.with_cycle(PETROL).balance(3000).crank_torque.cycle_mean > 0.0
    complete = "-".join(map(str, range(1, count + 1)))
    if dummy.any():
        with pytest.raises(cp.InputError, match="is a dummy piston, which does not fire"):
            engine.firing(complete)
    with pytest.raises(cp.InputError, match=r"is missing; name each of the engine's \d cylinders"):
        engine.firing("-".join(map(str, numbers[:-1])) or str(count + 1))


def test_firing_orders_by_bank_leave_dummies_out() -> None:
    four = cp.Engine.vee(
        [PISTON, PISTON, PISTON, DUMMY], bank_angle_deg=90, throws_deg=[0, 180], spacing=0.1,
        firing_order="A1-B1-A2",
    )  # fmt: skip
    assert four.firing_order == "1-2-3"
    with pytest.raises(cp.InputError, match="name each of the engine's 3 cylinders once"):
        four.replace(firing_order="A1-B1-A2-B2")


def test_changes_of_an_engine_keep_or_drop_dummies() -> None:
    i3 = cp.Engine.preset("i3", cylinder=PISTON).replace(firing_order="1-2-3").with_cycle(PETROL)
    changed = i3.replace(cylinder=[PISTON, PISTON, DUMMY])
    assert (changed.firing_order, changed.cycles) == ("1-2", (PETROL, PETROL, None))
    assert changed.replace(name="other").cycles == changed.cycles
    back = changed.replace(cylinder=PISTON, cycle=None)
    assert back.firing_order == ""
    rod = cp.Rod(mass=0.3, inertia=0.001, length=0.12, to_crankpin=0.04)
    weighed = cp.Cylinder.from_rod(rod, 0.04, 0.3).replace(dummy=True)
    assert weighed.replace(piston_mass=0.35).dummy
    assert not weighed.replace(piston_mass=0.35, dummy=False).dummy
    with pytest.raises(cp.InputError, match="dummy"):
        PISTON.replace(dummy=1)


def test_files_keep_dummies(tmp_path: Path) -> None:
    for engine in (single(), single().with_cycle(PETROL)):
        for file in (tmp_path / "mono.toml", tmp_path / "mono.json"):
            engine.save(file)
            assert cp.Engine.load(file) == engine
        assert pickle.loads(pickle.dumps(engine)) == engine  # noqa: S301 - its own
    text = (tmp_path / "mono.toml").read_text()
    assert text.count("dummy = true") == 1
    with pytest.raises(cp.InputError, match="2 is a dummy piston"):
        cp.Engine.from_toml(text.replace('firing_order = "1"', 'firing_order = "1-2"'))


def test_pages_show_no_strokes_of_a_dummy() -> None:
    assert places(single(), 3000.0)["firing_deg"] == [0.0, None]


def test_dummies_in_sentences() -> None:
    """A dummy piston is not in the firing order, so that none of the order does not fire."""
    said = single().explain().sentences
    assert "Only cylinder 1 fires, every 720°; cylinder 2 is a dummy piston." in said
    three = cp.Engine.inline(
        [PISTON, DUMMY, PISTON], throws_deg=[0, 180, 0], spacing=0.1, firing_order="1-3"
    )
    even = "It fires evenly, every 360°: 1-3; cylinder 2 is a dummy piston."
    assert even in three.explain().sentences
    gas = three.with_cycle([PETROL, None, None]).explain().sentences
    assert "Only cylinder 1 fires, every 720°; cylinder 2 is a dummy piston." in gas
    two = cp.Engine.inline([PISTON, DUMMY, DUMMY], throws_deg=[0, 180, 180], spacing=0.1)
    two = two.replace(firing_order="1")
    assert any(
        each.endswith("; cylinders 2 and 3 are dummy pistons.") for each in two.explain().sentences
    )


def test_dummies_in_a_shell(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "supermono.toml"
    typed = "new v-twin --bank-angle 90 --bore 100mm --stroke 70mm --rod-length 124mm"
    typed += f" --reciprocating-mass 500g --dummy 2 -o {file}"
    assert main(typed.split()) == 0
    engine = cp.Engine.load(file)
    assert [one.dummy for one in engine.cylinders] == [False, True]
    assert engine.firing_order == "1"
    assert (
        main(["new", "inline", "--throws", "0,180,0", "--dummy", "2", "--firing-order", "1-3"]) == 0
    )
    assert 'firing_order = "1-3"' in capsys.readouterr().out
    for wrong, said in {
        "new v-twin --dummy 3": "--dummy = 3: the engine has cylinders 1 to 2",
        "new v-twin --dummy x": "--dummy = x: give numbers of cylinders",
        "new firing-order --firing-order 1-2 --dummy 2": "--dummy = 2: crankpins follow",
    }.items():
        assert main(wrong.split()) == 2
        assert said in capsys.readouterr().err
