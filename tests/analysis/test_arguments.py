"""Does every argument that acts beside another count, or is it rejected without that one?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

BORED = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
I4 = cp.Engine.preset("i4", cylinder=BORED)
CYCLE = cp.Cycle.example()
FIRED = I4.with_cycle(CYCLE, crankcase=5e4)
V6 = cp.Engine.preset("v6-60")
DESIGN: dict[str, Any] = {
    "cylinder": BORED, "spacing": 0.1, "rpm": 3000, "by": "total.moment.peak", "count": 1,
}  # fmt: skip
VEE = DESIGN | {"layout": "vee", "bank_angle_deg": 60}

ALONE: dict[str, tuple[Callable[[], object], str]] = {
    "sweep, unfired": (lambda: cp.sweep(I4, 3000, crankcase=9e4), "crankcase = 90000.0"),
    "sweep, fired": (lambda: cp.sweep(FIRED, 3000, crankcase=9e4), "crankcase = 90000.0"),
    "load": (lambda: cp.sweep(FIRED, 3000, load=[1]), "load"),
    "hold": (lambda: cp.sweep(V6, 3000, hold="firing"), "hold"),
    "hold of rank": (lambda: cp.rank([V6], 3000, by="total.moment.peak", hold="pins"), "hold"),
    "refine": (lambda: cp.rank([V6], 3000, by="total.moment.peak", refine=True), "refine"),
    "rtol": (lambda: I4.balance(3000, orders=[1], rtol=0.1), "rtol"),
    "replace": (lambda: I4.replace(crankcase=9e4), "crankcase = 90000.0"),
    "replace, cycle=None": (lambda: FIRED.replace(cycle=None, crankcase=9e4), "crankcase"),
    "with_cycle(None)": (lambda: FIRED.with_cycle(None, crankcase=9e4), "crankcase"),
    "with_cycle([None, …])": (lambda: FIRED.with_cycle([None] * 4, crankcase=9e4), "crankcase"),
    "odd_bank": (
        lambda: cp.Engine.from_firing_order(BORED, "1-3-4-2", spacing=0.1, odd_bank="left"),
        "odd_bank = 'left'",
    ),
    "numbering": (
        lambda: cp.Engine.from_firing_order(BORED, "1-3-4-2", spacing=0.1, numbering="by-bank"),
        "numbering = 'by-bank'",
    ),
    "bank_stagger": (
        lambda: cp.Engine.from_firing_order(BORED, "1-3-4-2", spacing=0.1, bank_stagger=0.02),
        "bank_stagger = 0.02",
    ),
    "throws, odd_bank": (lambda: cp.throws("1-3-4-2", odd_bank="left"), "odd_bank = 'left'"),
    "throws, numbering": (lambda: cp.throws("1-3-4-2", numbering="by-bank"), "numbering"),
    "design, stagger": (
        lambda: cp.design(3, layout="inline", **DESIGN, bank_stagger=0.02), "bank_stagger"
    ),
    "design, shared pins": (
        lambda: cp.design(3, layout="inline", **DESIGN, shared_pins=False), "shared_pins"
    ),
    "design, split": (
        lambda: cp.design(3, layout="inline", **DESIGN, pin_split_deg=3), "pin_split_deg"
    ),
    "design, same split": (lambda: cp.design(4, **VEE, same_split=False), "same_split"),
    "relative": (lambda: cp.balancer_options(I4, 3000, relative=True), "relative"),
    "planes of no weights": (
        lambda: cp.balancer_options(I4, 3000, counterweights=False, planes="webs"), "planes"
    ),
    "orders of a spread": (
        lambda: cp.match_parts(I4, [0.5, 0.51, 0.52, 0.53], by="spread", orders=[1]), "orders"
    ),
    "wall without speed": (
        lambda: cp.Cycle.wiebe(BORED, compression_ratio=10, heat=1e3, wall_temperature=400), "wall"
    ),
    "heating value": (
        lambda: cp.Cycle.wiebe(BORED, compression_ratio=10, heat=1e3, heating_value=4e7),
        "heating_value",
    ),
    "stoichiometric ratio": (
        lambda: cp.Cycle.wiebe(BORED, compression_ratio=10, heat=1e3, stoichiometric_ratio=15),
        "stoichiometric_ratio",
    ),
    "period": (lambda: cp.flywheel(FIRED, 3000, inertia=0.1, period_deg=720), "period_deg"),
}  # fmt: skip


@in_turn("call", ALONE)
def test_an_argument_without_its_partner_is_rejected(call: str) -> None:
    ask, named = ALONE[call]
    with pytest.raises(cp.InputError, match=named):
        ask()


MAP = cp.CycleMap([1000, 3000], [0.5, 1.0], [[CYCLE, cp.Cycle.example("diesel")]] * 2)


def test_a_sweep_over_a_map_has_the_crankcase_of_the_engine() -> None:
    at: dict[str, Any] = {"orders": [0.5, 1, 2], "load": [0.5, 0.8]}
    own = cp.sweep(FIRED, 2000, cycle=MAP, **at)
    for engine, crankcase in ((FIRED, 5e4), (I4, 101_325.0)):
        typed = cp.sweep(I4, 2000, cycle=MAP, crankcase=crankcase, **at)
        default = cp.sweep(engine, 2000, cycle=MAP, **at)
        np.testing.assert_array_equal(typed.torque, default.torque)
        point = default.sel(load=0.8)
        assert point.engine.crankcase == crankcase
    assert not np.array_equal(own.torque, cp.sweep(I4, 2000, cycle=MAP, **at).torque)
    both = cp.sweep([FIRED, I4], 2000, cycle=MAP, **at).torque
    np.testing.assert_array_equal(np.asarray(both)[0], np.asarray(own.torque))


def test_another_cycle_or_strokes_keep_the_crankcase() -> None:
    assert FIRED.with_cycle(cp.Cycle.example("diesel")).crankcase == 5e4
    assert FIRED.replace(cycle=cp.Cycle.example("diesel")).crankcase == 5e4
    assert FIRED.replace(crankcase=6e4).crankcase == 6e4
    assert FIRED.replace(crankcase=6e4).firing_deg.tolist() == FIRED.firing_deg.tolist()
    assert I4.with_cycle(CYCLE).crankcase == 101_325.0
    assert FIRED.replace(cycle=[None] * 4).crankcase is None


def test_strokes_of_a_design_are_those_of_its_engines() -> None:
    assert cp.design(3, layout="inline", **DESIGN, strokes=2)[0].engine.strokes == 2


def test_bore_and_crankcase_count_in_commands_or_are_rejected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = str(tmp_path / "fired.toml")
    FIRED.save(file)
    shown = []
    for options in ([], ["--crankcase", "9e4"], ["--bore", "90mm"]):
        for command in ("torque", "bearings"):
            assert main([command, file, *options]) == 0
        shown.append(capsys.readouterr().out)
    assert len(set(shown)) == 3
    for options in (["--crankcase", "9e4"], ["--bore", "90mm"]):
        assert main(["bearings", "i4", "--cycle", "none", *options]) != 0
        assert f"{options[0]} = {options[1]}: needs" in capsys.readouterr().err
