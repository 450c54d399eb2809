"""Do the commands on makers' tables and locomotives print the library's numbers?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]
TEXTBOOK = (
    "locomotive --stroke 600mm --reciprocating-mass 300kg --z=-350mm,350mm --throws 0,90 "
    "--wheels=-0.8,0.8 --wheel-diameter 1.7"
)
TWO = cp.Locomotive(
    cp.Cylinder(crank_radius=0.3, rod_length=math.inf, reciprocating_mass=300),
    z=[-0.35, 0.35],
    throws_deg=[0, 90],
    wheel_z=[-0.8, 0.8],
    wheel_diameter=1.7,
)


def printed(capsys: CAPTURE, line: str) -> str:
    """What a run that succeeds prints."""
    assert main(line.split()) == 0
    return capsys.readouterr().out


def refused(capsys: CAPTURE, line: str) -> str:
    """What a run that fails says."""
    assert main(line.split()) == 2
    return capsys.readouterr().err.removeprefix("crankpin: error: ")


def test_foundation(capsys: CAPTURE, tmp_path: Path) -> None:
    five = cp.Engine.preset("marine-5")
    table = cp.foundation_table(five, 210, orders=[1, 2, 4])
    picture = tmp_path / "table.png"
    line = f"foundation marine-5 --rpm 210 --orders 1,2,4 --plot {picture}"
    assert printed(capsys, line) == f"{table}\n"
    assert picture.stat().st_size > 10_000
    lies = cp.foundation_table(five, [100, 200], vertical_deg=180, reference_z=0.0)
    line = "foundation marine-5 --rpm 100:200:100 --vertical 180 --reference-z 0 --csv"
    assert printed(capsys, line) == lies.to_csv()
    assert refused(capsys, "foundation i4 --orders auto").startswith("--orders = auto")
    assert refused(capsys, "foundation i4 --vertical up").startswith("--vertical")


def test_makers_tables_and_blocks_on_soil(capsys: CAPTURE, tmp_path: Path) -> None:
    six = cp.Engine.preset("marine-6").with_cycle(cp.Cycle.example("diesel", strokes=2))
    table = cp.force_table(six, 105.0, orders=[1, 2, 6])
    line = "foundation marine-6 --rpm 105 --cycle diesel --maker --orders 1,2,6"
    assert printed(capsys, line).startswith(f"{table}\n")
    file, saved = tmp_path / "maker.csv", tmp_path / "block.toml"
    assert "Written to" in printed(capsys, f"{line} -o {file}")
    assert file.read_text(encoding="utf-8") == printed(capsys, f"{line} --csv")
    again = cp.ForceTable.from_csv(file, name="maker")
    assert printed(capsys, f"foundation {file}") == f"{again}\n"
    universal = tmp_path / "maker.unv"
    printed(capsys, f"foundation {file} -o {universal}")
    read = cp.ForceTable.from_unv(universal, name="maker")
    assert printed(capsys, f"foundation {universal}") == f"{read}\n"
    assert refused(capsys, f"foundation {universal} --lag").startswith("--lag = True: is of a ta")
    block = cp.RigidBody.block(4, 2.5, 9, density=2350, top=(0, -1.2, 1.5))
    machine = cp.RigidBody(45e3, (0, 0.4, 1.5), (2e5, 1.8e5, 4e4))
    body = cp.RigidBody.combined(block, machine)
    soil = cp.Soil(6e7, 0.33, 1750, damping_ratio=0.03)
    ground = soil.mount(body, width=4, length=9, at=(0, -3.7, 1.5), embedment=1.0)
    p = cp.Powertrain(again, body, [ground])
    moved = p.response([80.0, 100.0, 120.0]).at((0.0, 0.4, 3.0))
    line = (
        f"foundation {file} --rpm 80:120:20 --block 4,2.5,9 --density 2350 --top 0,-1.2,1.5 "
        "--machine 45000,0,0.4,1.5,2e5,1.8e5,4e4 --soil 60MPa,0.33,1750 --soil-damping 0.03 "
        f"--embedment 1m --at 0,0.4,3 --save {saved}"
    )
    text = printed(capsys, line)
    assert text.startswith(f"{moved.table}\n\n{p.modes().table}\n\n")
    loaded = cp.Powertrain.load(saved)
    assert loaded == p
    assert refused(capsys, f"foundation {file} --maker").startswith("--maker = True: is of an")
    assert refused(capsys, "foundation i4 --lag").startswith("--lag = True: is of a table")
    assert refused(capsys, "foundation i4 --soil 1e7").startswith("--soil = 1e7: needs --block")
    assert refused(capsys, "foundation i4 --block 1,2,3").startswith("--block = 1,2,3: needs --s")
    for option, value in (("--block", "1,2"), ("--soil", "1,2,3,4"), ("--machine", "1,2")):
        typed = f"foundation i4 --block=1,2,3 --soil=6e7 {option}={value}"
        assert refused(capsys, typed).startswith(f"{option} = {value}: give ")
    assert refused(capsys, "foundation i4 -o a.txt").startswith("--out = 'a.txt'")
    line = "foundation i4 --block=1,2,3 --soil=6e7 -o a.csv"
    assert refused(capsys, line).startswith("--out = a.csv: is of a table")
    line = "foundation i4 --rpm 900:1000:100 --maker"
    assert refused(capsys, line).startswith("--rpm = 900:1000:100: --maker takes one")


def test_guide_moments(capsys: CAPTURE) -> None:
    six = cp.Engine.preset("marine-6")
    plain = cp.guide_moments(six, 210, length=3.0)
    assert printed(capsys, "guide-moments marine-6 --rpm 210 --length 3m") == f"{plain}\n"
    fired = six.with_cycle(cp.Cycle.example("diesel", strokes=2))
    moments = cp.guide_moments(fired, 210, orders=[3, 6])
    line = "guide-moments marine-6 --rpm 210 --cycle diesel --orders 3,6"
    assert printed(capsys, line) == f"{moments}\n"
    assert printed(capsys, f"{line} --csv") == moments.to_csv()
    assert refused(capsys, "guide-moments marine-6 --length 0").startswith("--length")


def test_locomotive(capsys: CAPTURE, tmp_path: Path) -> None:
    forces = TWO.replace(share=0.66, wheel_load=70e3).forces(speed_kmh=90)
    file = tmp_path / "two.toml"
    line = f"{TEXTBOOK} --share 66% --wheel-load 70kN --speed 90"
    assert printed(capsys, f"{line} --save {file}") == f"{forces}\n"
    saved = cp.Engine.load(file)
    assert saved == forces.engine
    assert saved.balance(280).total.force.peak_xy[0] == pytest.approx(
        forces.locomotive.forces(280).tractive_variation.peak
    )
    wheels = printed(capsys, f"{line} --frame wheels")
    assert wheels == f"{forces.locomotive.table}\n"


def test_the_share_of_a_hammer_blow(capsys: CAPTURE) -> None:
    share = TWO.share_for(40e3, speed_kmh=90)
    text = printed(capsys, f"{TEXTBOOK} --hammer-blow 40kN --speed 90")
    assert text.endswith(f"Share of the reciprocating masses that is balanced: {share:.6g}.\n")
    assert str(TWO.replace(share=share).forces(speed_kmh=90)) in text
    for words, option in [
        ("--hammer-blow 40kN --share 60%", "--share = 60%"),
        ("--hammer-blow 400kN", "--hammer-blow = 400kN"),
        ("--rpm 100", "--speed"),
    ]:
        assert refused(capsys, f"{TEXTBOOK} --speed 90 {words}").startswith(option)


def test_coupled_axles(capsys: CAPTURE) -> None:
    coupled = TWO.replace(
        cylinder=[cp.Cylinder(0.3, 2.0, 300.0)] * 2,
        share=[0.2, 0.3],
        rotating_mass=[120, 120],
        inclination_deg=[5, 5],
        axle_x=[0, 1.9],
        driving=[2, 2],
        coupling=[cp.Unbalance(20, -0.9, 180, pin=1), cp.Unbalance(20, 0.9, 90)],
        name="Two axles",
    )
    line = (
        f"{TEXTBOOK} --rod-length 2m --share 20%,30% --rotating-mass 120kg --inclination 5 "
        "--axles 0,1.9 --driving 2 --coupling 20:-0.9:180:1,20:0.9:90 --rpm 250 --csv "
        "--frame wheels"
    )
    assert printed(capsys, line) == coupled.table.to_csv()
    assert refused(capsys, f"{TEXTBOOK} --rpm 9 --coupling 20:1").startswith("--coupling = 20:1")
    assert refused(capsys, f"{TEXTBOOK} --rpm 9 --rod-length 0").startswith("--rod-length = 0")
