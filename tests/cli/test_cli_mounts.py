"""Does the command on an engine on its mounts print the library's numbers?"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]
CYLINDER = cp.Cylinder(crank_radius=0.043, rod_length=0.145, reciprocating_mass=0.45, bore=0.086)
CAR = cp.Powertrain(
    cp.Engine.preset("i4", cylinder=CYLINDER).with_cycle(cp.Cycle.example()),
    cp.RigidBody(mass=148, cg=(0.02, 0.07, 0.09), inertia=(8, 7.5, 5)),
    [
        cp.Mount("right", at=(0.28, 0, -0.09), stiffness=(2.2e5, 8e4, 8e4), tilt_deg=45),
        cp.Mount("left", at=(-0.28, 0, -0.09), stiffness=(2.2e5, 8e4, 8e4), tilt_deg=135),
        cp.Mount("rear", at=(0, -0.12, 0.55), stiffness=1e5, damping=(150, 200, 150)),
    ],
)


@pytest.fixture
def car(tmp_path: Path) -> Path:
    CAR.save(path := tmp_path / "car.toml")
    return path


def printed(capsys: CAPTURE, *typed: object) -> str:
    """What a run that succeeds prints."""
    assert main(["mounts", *map(str, typed)]) == 0
    return capsys.readouterr().out


def failed(capsys: CAPTURE, *typed: object) -> str:
    """What a run that fails says."""
    assert main(["mounts", *map(str, typed)]) == 2
    return capsys.readouterr().err


def test_modes_axes_and_the_state_at_rest_are_printed_by_default(
    car: Path, capsys: CAPTURE
) -> None:
    text = printed(capsys, car, "--torque", 300)
    for table in (CAR.modes().table, CAR.axes().table, CAR.static(300.0).table):
        assert table.text() in text
    assert "elastic energy by mount" in text


def test_free_motions_have_no_axes(tmp_path: Path, capsys: CAPTURE) -> None:
    CAR.replace(mounts=CAR.mounts[:2]).save(path := tmp_path / "two.toml")
    text = printed(capsys, path)
    assert "No mount resists" in text
    assert "axes of roll" not in text


def test_a_run_up_is_the_response(car: Path, capsys: CAPTURE) -> None:
    text = printed(capsys, car, "--rpm", "600:3000:300", "--orders", "2,4", "--csv")
    head, *rows = csv.reader(io.StringIO(text))
    response = CAR.response(np.arange(600, 3001, 300), orders=[2, 4])
    force = [float(row[head.index("|F| N")]) for row in rows]
    assert force == response.body_force.total.peak.tolist()


def test_a_misfire_and_a_point(car: Path, capsys: CAPTURE) -> None:
    text = printed(capsys, car, "--rpm", 800, "--misfire", 3, "--at", "0,300mm,0")
    motion = CAR.with_misfire(cylinder=3).response(800).at((0, 0.3, 0))
    assert motion.table.text() in text
    assert "cylinder 3 does not fire" in text


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--rpm", "800"],
        ["--rpm", "800:900:20", "--picture", "map", "--mount", "rear"],
        ["--rpm", "800:900:20", "--picture", "waterfall"],
    ],
)
def test_pictures_are_written(
    car: Path, tmp_path: Path, capsys: CAPTURE, options: list[str]
) -> None:
    printed(capsys, car, *options, "--plot", picture := tmp_path / "picture.png")
    assert picture.stat().st_size > 5000


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        (["--at", "1,2,3"], "--at = 1,2,3: needs --rpm"),
        (["--rpm", "800", "--torque", "3"], "--torque = 3: acts without --rpm alone"),
        (["--rpm", "800:900:20", "--html", "x.html"], "begins at one speed: give --rpm one"),
        (["--html", "x.txt"], "a page ends in .html"),
        (["--controls", "rpm"], "--controls = rpm: needs --html"),
        (["--html", "x.html", "--controls", "rpm,mount"], 'did you mean "mounts"?'),
        (["--rpm", "800", "--misfire", "9"], "--misfire = 9: give a number from 1 to 4"),
        (["--rpm", "800", "--mount", "reer", "--plot", "x.png"], 'give "right", "left" or "rear"'),
        (["--rpm", "800", "--picture", "map", "--plot", "x.png"], "needs several speeds"),
    ],
)
def test_errors_name_the_option(car: Path, capsys: CAPTURE, typed: list[str], hint: str) -> None:
    assert hint in failed(capsys, car, *typed)


@pytest.mark.parametrize("rpm", [None, 1200.0])
def test_a_page_is_that_of_the_library(
    car: Path, tmp_path: Path, capsys: CAPTURE, rpm: float | None
) -> None:
    ours, theirs = tmp_path / "ours.html", tmp_path / "theirs.html"
    typed = [] if rpm is None else ["--rpm", rpm]
    text = printed(capsys, car, "--html", theirs, *typed)
    CAR.save_html(ours, 800.0 if rpm is None else rpm)
    assert theirs.read_bytes() == ours.read_bytes()
    table = CAR.modes().table if rpm is None else CAR.response(rpm).table
    assert table.text().splitlines()[2] in text


def test_a_page_has_the_controls_and_units_that_are_typed(
    car: Path, tmp_path: Path, capsys: CAPTURE
) -> None:
    ours, theirs = tmp_path / "ours.html", tmp_path / "theirs.html"
    typed = ["--controls", "order, rpm", "--units", "lb,in,lbf"]
    printed(capsys, car, "--html", theirs, *typed)
    with cp.units("lb, in, lbf"):
        CAR.save_html(ours, controls=["order", "rpm"])
    assert theirs.read_bytes() == ours.read_bytes()


def test_power_is_a_table(car: Path, capsys: CAPTURE) -> None:
    assert main(["mounts", str(car), "--rpm", "850", "--frame", "power"]) == 0
    assert CAR.response(850).frames["power"].text() in capsys.readouterr().out


def test_an_engine_without_mounts_says_so(tmp_path: Path, capsys: CAPTURE) -> None:
    cp.Engine.preset("i4").save(path := tmp_path / "bare.toml")
    assert "the file has no [powertrain]" in failed(capsys, path)


def fitted(capsys: CAPTURE, *typed: object) -> str:
    """What a run of the design prints."""
    assert main(["mounts-fit", *map(str, typed)]) == 0
    return capsys.readouterr().out


def test_mounts_are_fitted_and_written(car: Path, tmp_path: Path, capsys: CAPTURE) -> None:
    expected = cp.design_mounts(CAR, vary="stiffness", bounds={"stiffness": (3e4, 6e5)})
    typed = (car, "--stiffness", "30000,600000")
    text = fitted(capsys, *typed, "--save", tmp_path / "new.toml")
    assert expected.frames.text() in text
    assert cp.Powertrain.load(tmp_path / "new.toml") == expected.fitted
    assert main(["mounts", "fit", *map(str, typed)]) == 0
    assert capsys.readouterr().out == text


def test_windows_and_limits_are_those_of_the_library(car: Path, capsys: CAPTURE) -> None:
    expected = cp.design_mounts(
        CAR,
        ["decoupling", "mount_force[2]"],
        vary={"rear": ["stiffness", "y"], "left": ["tilt_deg"]},
        bounds={"stiffness": (3e4, 6e5), "y": 0.02, "tilt_deg": 10.0},
        ratio=(0.5, 4.0),
        roll_frequency=12.0,
        modes_between=(4.0, 40.0),
        rpm=[800.0, 1000.0],
        starts=2,
        seed=3,
    )
    options = ["--by", "decoupling,mount_force[2]", "--vary", "rear=stiffness+y,left=tilt_deg"]
    options += ["--stiffness", "30000,600000", "--y", "20mm", "--tilt", "10", "--ratio", "0.5,4"]
    options += ["--roll-frequency", "12", "--modes-between", "4,40", "--rpm", "800,1000"]
    text = fitted(capsys, car, *options, "--starts", "2", "--seed", "3", "--csv")
    assert text == expected.table.to_csv()


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        ([], "has no bounds: give bounds of what varies"),
        (["--stiffness", "3e4"], "give two numbers above zero"),
        (["--stiffness", "3e4,3e5", "--vary", "weight"], "--vary"),
        (["--stiffness", "3e4,3e5", "--vary", "reer=stiffness"], "right"),
        (["--y", "0.1", "--modes-between", "30,5"], "--modes-between = "),
        (["--y", "0.1", "--by", "noise"], "--by = "),
        (["--y", "0.1", "--by", "body_force[2]"], "--rpm is left out"),
    ],
)
def test_errors_of_a_fit_name_the_option(
    car: Path, capsys: CAPTURE, typed: list[str], hint: str
) -> None:
    assert main(["mounts-fit", str(car), *typed]) == 2
    assert hint in capsys.readouterr().err


# --- at rest, robustness, points, and files from the shell ----------------------------------------


def test_torque_of_the_engine_gear_gravity_and_robustness(car: Path, capsys: CAPTURE) -> None:
    gravity = (0.0, -9.7, 1.3)
    typed = ("--torque", "engine", "--gear", "12.5", "--gravity", "0,-9.7,1.3")
    text = printed(capsys, car, *typed, "--robustness", "0.1")
    expected = CAR.static("engine", gear_ratio=12.5, gravity=gravity)
    assert expected.table.text() in text
    assert CAR.robustness(0.1).table.text() in text
    assert printed(capsys, car, "--robustness", "0.1", "--frame", "robustness") == (
        f"{CAR.robustness(0.1).table.text()}\n"
    )


def test_points_of_the_support_are_printed_and_drawn(tmp_path: Path, capsys: CAPTURE) -> None:
    base = cp.Subframe(
        cp.RigidBody(100, (0, -0.1, 0.2), (9, 12, 6)),
        [mount.replace(stiffness=8e5, loss_factor=0.1) for mount in CAR.mounts],
    )
    CAR.with_support(base).save(path := tmp_path / "soft.toml")
    typed = (path, "--rpm", "800:900:50", "--at", "0,-0.1,0.2", "--on", "support")
    picture = tmp_path / "rail.png"
    text = printed(capsys, *typed, "--picture", "map", "--plot", picture)
    motion = CAR.with_support(base).response([800, 850, 900]).at((0, -0.1, 0.2), on="support")
    assert motion.table.text() in text
    assert picture.stat().st_size > 5000
    assert CAR.with_support(base).modes().frames["subframe"].text() in printed(capsys, path)
    zero = cp.Receptance(
        [("rear", "y")], ([1.0, 5000.0], [[[0.0]]] * 2), {"seat": [[[1e-7]] * 3] * 2}
    )
    CAR.with_support(zero).save(path)
    text = printed(capsys, path, "--rpm", "800", "--orders", "2", "--at", "seat")
    assert "motion of 'seat'" in text
    assert "support = a receptance" in failed(capsys, path)


def test_an_engine_on_mounts_is_made_in_the_shell(tmp_path: Path, capsys: CAPTURE) -> None:
    path = tmp_path / "made.toml"
    typed = ["new", "i4", "--body", "148:20mm,70mm,90mm:8,7.5,5"]
    typed += [
        "--mount",
        "right:0.28,0,-0.09:220000,80000,80000:0.1",
        "--mount",
        "left:-0.28,0,0:1e5",
    ]
    typed += ["--mount", "rear:0,-0.12,0.55:1e5"]
    assert main([*typed, "-o", str(path)]) == 0
    assert f"try crankpin mounts {path}" in capsys.readouterr().out
    made = cp.Powertrain.load(path)
    assert made.body == cp.RigidBody(148, (0.02, 0.07, 0.09), (8, 7.5, 5))
    assert made.names == ("right", "left", "rear")
    assert made.mounts[0].stiffness == (2.2e5, 8e4, 8e4)
    assert made.mounts[0].loss_factor == (0.1, 0.1, 0.1)
    assert made.modes().table.text() in printed(capsys, path)
    assert main(typed) == 0
    assert "[powertrain.body]" in capsys.readouterr().out
    for wrong, said in [
        (["--body", "148:0,0,0:8,7,5"], "--mount is left out"),
        (["--mount", "a:0,0,0:1e5"], "--body is left out"),
        (["--body", "148", "--mount", "a:0,0,0:1e5"], "give MASS:X,Y,Z:IX,IY,IZ"),
        (["--body", "148:0,0,0:8,7,5", "--mount", "a:0,0"], "give NAME:X,Y,Z:K"),
    ]:
        assert main(["new", "i4", *wrong]) == 2
        assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        (["--rpm", "800", "--gear", "3"], "--gear = 3: acts without --rpm alone"),
        (["--rpm", "800", "--robustness", "0.1"], "--robustness = 0.1: acts without --rpm alone"),
        (["--rpm", "800", "--on", "support"], "--on = support: needs --at"),
        (["--rpm", "800", "--at", "0,0,0", "--on", "support"], "no subframe carries the mounts"),
        (["--rpm", "800", "--at", "rail"], "no receptance with receivers carries the mounts"),
        (["--rpm", "800", "--at", "0,0,0", "--mount", "rear"], "cannot be combined with --at"),
    ],
)
def test_further_errors_name_the_option(
    car: Path, capsys: CAPTURE, typed: list[str], hint: str
) -> None:
    assert hint in failed(capsys, car, *typed)


def test_load_cases_are_those_of_the_library(car: Path, capsys: CAPTURE) -> None:
    cases = {
        "idle": {},
        "first gear": {"torque": "engine", "gear_ratio": 13.0, "rpm": 3000.0},
        "braking": {"acceleration": [0.0, 0.0, 8.0], "torque": -150.0},
    }
    typed = [
        *("--case", "idle"),
        *("--case", "first gear:torque=engine:gear=13:rpm=3000"),
        *("--case", "braking: acceleration=0,0,8 : torque=-150"),
    ]
    loaded = CAR.load_cases(cases)
    text = printed(capsys, car, *typed)
    for table in loaded.frames.values():
        assert table.text() in text
    text = printed(capsys, car, *typed, "--frame", "worst", "--csv")
    head, *rows = csv.reader(io.StringIO(text))
    worst = {column.name: column.values for column in loaded.frames["worst"].columns}
    assert tuple(row[head.index("case of travel")] for row in rows) == worst["case of travel"]


def test_modes_and_response_are_about_a_case(tmp_path: Path, capsys: CAPTURE) -> None:
    snubbed = [m.replace(gap=0.005, snubber_stiffness=8e5) for m in CAR.mounts]
    whole = CAR.replace(mounts=snubbed)
    whole.save(path := tmp_path / "snubbed.toml")
    drive = whole.replace(rest={"torque": 1500.0})
    typed = ("--case", "drive:torque=1500", "--rest", "drive")
    assert drive.modes().table.text() in printed(capsys, path, *typed)
    title = drive.response(3000).table.title
    assert str(title) in printed(capsys, path, "--rpm", 3000, *typed)
    text = printed(capsys, path, "--rpm", 3000, "--orders", 2, *typed, "--csv")
    head, row, *_ = csv.reader(io.StringIO(text))
    peak = drive.response(3000, orders=[2]).body_force[2].peak
    assert float(row[head.index("|F| N")]) == pytest.approx(peak, rel=1e-12)
    assert whole.modes().table.text() in printed(capsys, path)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--case", "a:torq=3"), "--case = a:torq=3: give NAME:FIELD=VALUE:…, of torque, gear"),
        (("--case", "a:torque="), "give NAME:FIELD=VALUE"),
        (("--case", ":torque=3"), "give each case a name of its own"),
        (("--case", "a", "--case", "a"), "give each case a name of its own"),
        (("--case", "a", "--torque", "3"), "--torque = 3: cannot be combined with --case"),
        (("--case", "a", "--rpm", "3000"), "--case = a: acts without --rpm alone"),
        (("--rest", "a"), "--rest = a: is no --case"),
    ],
)
def test_wrong_cases_are_named(
    car: Path, options: tuple[str, ...], words: str, capsys: CAPTURE
) -> None:
    assert words in failed(capsys, car, *options)


# --- a base that moves, and two files -------------------------------------------------------------


def test_a_base_is_that_of_the_library(car: Path, tmp_path: Path, capsys: CAPTURE) -> None:
    text = printed(capsys, car, "--base", "y=0.1mm,rz=1e-4rad", "--base-hz", "5:25:10",
                   "--base-about", "0,100mm,0")  # fmt: skip
    rows = dict.fromkeys((5.0, 15.0, 25.0), (0, 1e-4, 0, 0, 0, 1e-4))
    floor = cp.BaseMotion(rows, about=(0, 0.1, 0))
    assert CAR.response(base=floor).table.text() in text
    path = tmp_path / "hull.csv"
    path.write_text("order,x [g],phase x [deg]\n1,0.1,90\n2,0.2,0\n")
    hull = cp.BaseMotion.from_csv(path)
    text = printed(capsys, car, "--rpm", 900, "--base", path, "--orders", "1,2")
    table = CAR.response(900, orders=[1, 2], base=hull).table.text()
    assert "\n".join(table.splitlines()[:-1]) in text  # the loads stand at the end
    picture = tmp_path / "floor.png"
    text = printed(capsys, car, "--base", "y=1mm/s", "--base-hz", "5:40:1", "--at", "0,0.3,0",
                   "--plot", picture)  # fmt: skip
    floor = cp.BaseMotion(dict.fromkeys(range(5, 41), (0, 1e-3, 0)), "velocity")
    assert CAR.response(base=floor).at((0, 0.3, 0)).table.text() in text
    assert picture.stat().st_size > 5000


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        (["--base", "y=0.1mm"], "--base-hz is left out: give the frequencies of --base, Hz"),
        (["--base-hz", "5"], "--base-hz = 5: needs --base"),
        (["--base-about", "0,0,1"], "--base-about = 0,0,1: needs --base"),
        (["--base", "up=1mm", "--base-hz", "5"], "--base = up=1mm: give x, y, z, rx, ry, rz and"),
        (["--base", "y=1", "--base-hz", "5:6:1e-6"], "give"),
        (["--base", "y=1mm,z=1g", "--base-hz", "5"], "give amounts of one motion"),
        (["--base", "y=1furlong", "--base-hz", "5"], "--base = 'furlong': give a unit of m, cm"),
        (["--base", "none.csv"], "none.csv"),
        (["--base", "y=1mm", "--base-hz", "5", "--rpm", "900"], "leave it out: the base moves by"),
        (["--base", "y=1mm", "--base-hz", "5", "--factor", "0:1:0.5", "--rpm", "9"], "--factor"),
        (["OTHER", "--base", "y=1mm", "--base-hz", "5"], "cannot be combined with OTHER"),
        (["OTHER"], "--rpm is left out: two files are compared at crank speeds"),
        (["OTHER", "--rpm", "900", "--torque", "3"], "--torque = 3: cannot be combined with OTHER"),
    ],
)
def test_errors_of_bases_name_the_option(
    car: Path, capsys: CAPTURE, typed: list[str], hint: str
) -> None:
    assert hint in failed(capsys, car, *(str(car) if word == "OTHER" else word for word in typed))


def test_two_files_stand_beside_each_other(car: Path, tmp_path: Path, capsys: CAPTURE) -> None:
    soft = CAR.replace(mounts=[CAR.mounts[0].replace(stiffness=5e4), *CAR.mounts[1:]])
    soft.save(path := tmp_path / "soft.toml")
    text = printed(capsys, car, path, "--rpm", 850, "--at", "0,0.3,0", "--orders", "0.5,2")
    both = cp.compare_mounts(CAR, soft, 850, orders=[0.5, 2], point=(0, 0.3, 0))
    assert both.table.text() in text
    text = printed(capsys, car, path, "--rpm", "800:1000:100", "--misfire", 2)
    one, other = (each.with_misfire(cylinder=2) for each in (CAR, soft))
    assert cp.compare_mounts(one, other, [800, 900, 1000]).table.text() in text


def test_a_comparison_has_the_figures_of_both() -> None:
    soft = CAR.replace(
        mounts=[m.replace(stiffness=0.5 * np.array(m.stiffness)) for m in CAR.mounts]
    )
    both = cp.compare_mounts(CAR, soft, 900, point=(0, 0.3, 0))
    first, second = both.before, both.after
    assert first.orders == second.orders
    assert {*CAR.response(900).orders, *soft.response(900).orders} == {*both.orders}
    table = both.table
    assert table["before"].values[0] == first.body_force[both.orders[0]].peak
    force = [k for k, name in enumerate(table["quantity"].values) if name == "force on the body"]
    assert table["after"].values[force[-1]] == second.body_force.total.peak
    ratio = second.body_force.total.peak / first.body_force.total.peak
    assert table.columns[-2].values[force[-1]] == pytest.approx(100 * (ratio - 1), rel=1e-12)
    assert table.columns[-1].values[force[-1]] == pytest.approx(20 * np.log10(ratio), rel=1e-12)
    velocity = second.at((0, 0.3, 0)).velocity.total.peak
    assert table["after"].values[-1] == 1e3 * velocity
    expected = np.asarray(second.body_force.peak) / np.asarray(first.body_force.peak) - 1
    np.testing.assert_allclose(both.change(), expected, rtol=1e-9)
    assert both.change("velocity").shape == expected.shape
    assert (cp.compare_mounts(CAR, CAR, 900).change() == 0.0).all()
    with pytest.raises(cp.InputError, match=r"quantity = .velocity"):
        cp.compare_mounts(CAR, soft, 900).change("velocity")
    with pytest.raises(cp.InputError, match=r"after = 3: give a crankpin\.Powertrain"):
        cp.compare_mounts(CAR, 3, 900)  # type: ignore[arg-type]


# --- axes of a vehicle ---------------------------------------------------------------------------

AXES = "back,right,up:flywheel=left:origin=1450mm,210mm,360mm:incline=-12"
VEHICLE = cp.VehicleAxes("back, right, up", "left", (1.45, 0.21, 0.36), -12)


def test_axes_of_a_vehicle_are_those_of_the_library(car: Path, capsys: CAPTURE) -> None:
    turned = CAR.in_axes(VEHICLE)
    text = printed(capsys, car, "--axes", AXES)
    for table in (turned.modes().table, turned.axes().table, turned.static().table):
        assert table.text() in text
    text = printed(capsys, car, "--axes", AXES, "--case", "braking:acceleration=8,0,0")
    assert turned.load_cases({"braking": {"acceleration": (8, 0, 0)}}).table.text() in text
    motion = turned.response(800).at((1.4, 0.2, 0.7))
    text = printed(capsys, car, "--axes", AXES, "--rpm", 800, "--at", "1400mm,200mm,700mm")
    assert motion.table.text() in text


def test_a_file_is_written_from_figures_in_the_axes_of_a_vehicle(
    tmp_path: Path, capsys: CAPTURE
) -> None:
    mounts = {"a": (1.2, 0.3, 0.4), "b": (1.6, 0.2, 0.3), "c": (1.4, -0.4, 0.5)}
    typed = ["--body", "148:1432mm,120mm,402mm:8,7.5,5", "--axes", AXES]
    for name, at in mounts.items():
        typed += ["--mount", f"{name}:{','.join(map(str, at))}:100000,200000,300000"]
    path = tmp_path / "new.toml"
    assert main(["new", "i4", *typed, "-o", str(path)]) == 0
    capsys.readouterr()
    whole = cp.Powertrain(
        cp.Powertrain.load(path).engine,
        cp.RigidBody(148, (1.432, 0.12, 0.402), (8, 7.5, 5)),
        [cp.Mount(name, at, (1e5, 2e5, 3e5)) for name, at in mounts.items()],
        vehicle=VEHICLE,
    )
    loaded = cp.Powertrain.load(path)
    assert loaded.mounts == whole.in_axes(None).mounts
    assert loaded.body == whole.in_axes(None).body
    assert main(["new", "i4", "--axes", AXES]) == 2
    assert "is of --body and --mount" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ("back,right", "directions = 'back,right'"),
        ("back,right,up:flywheel=up", "flywheel = 'up'"),
        ("back,right,up:fly=left", "give X,Y,Z, and of flywheel, origin, incline"),
        ("back,right,up:origin=1,2", "origin = "),
    ],
)
def test_wrong_axes_are_named(car: Path, axes: str, words: str, capsys: CAPTURE) -> None:
    assert words in failed(capsys, car, "--axes", axes)
    assert "in the axes" in failed(capsys, car, "--axes", AXES, "--robustness", "0.1")
