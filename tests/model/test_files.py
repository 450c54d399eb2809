"""Engine files and copies keep everything an engine was given, whatever its size."""

from __future__ import annotations

import copy
import os
import pickle
import threading
from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from conftest import CYLINDER, I4

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
