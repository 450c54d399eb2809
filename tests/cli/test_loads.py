"""Do the commands for torque and bearing loads print the library's numbers?"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Literal

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]
LOADS = ("crankpin: without gas pressure", "crankpin: gas: ", "crankpin: spectrum given")


def printed(capsys: CAPTURE, typed: str) -> str:
    """What a run that succeeds prints."""
    assert main(typed.split()) == 0
    out, err = capsys.readouterr()
    # Beside CSV, which has no place for it, the loads counted.
    assert err == "" or ("--csv" in typed and err.startswith(LOADS) and err.count("\n") == 1)
    return out


@pytest.fixture(autouse=True)
def _agg() -> None:
    mpl.use("agg")


def fired(
    name: str, kind: Literal["petrol", "diesel"] = "petrol", bore: float | None = None
) -> cp.Engine:
    """A preset with an example's pressure; bores as wide as the strokes unless given."""
    engine = cp.Engine.preset(name)
    cylinders = [each.replace(bore=bore or each.stroke) for each in engine.cylinders]
    return engine.replace(cylinder=cylinders).with_cycle(
        cp.Cycle.example(kind, strokes=engine.strokes)
    )


def test_two_strokes_take_the_example_of_a_two_stroke(capsys: CAPTURE) -> None:
    balance = fired("i3-two-stroke").balance(3000)
    assert balance.crank_torque.table.to_csv() == printed(capsys, "torque i3-two-stroke --csv")
    assert not balance.crank_torque[0.5].gas.peak  # a cycle a turn


def test_bearings_are_those_of_the_library(capsys: CAPTURE) -> None:
    loads = cp.bearing_loads(cp.Engine.preset("v6-60"), rpm=4000)
    typed = "bearings v6-60 --rpm 4000 --cycle none"
    assert printed(capsys, typed) == f"{loads.frames.text()}\n"
    for load, frame in (("main", "mains"), ("crankpin", "table")):
        framed = f"{typed} --frame {frame} --csv"
        head, *rows = csv.reader(io.StringIO(printed(capsys, framed)))
        column = head.index("largest N" if load == "main" else "crankpin N")
        assert [float(row[column]) for row in rows] == loads.read(load, "peak").tolist()


def test_bearings_count_gas_where_a_cycle_is_given(capsys: CAPTURE, tmp_path: Path) -> None:
    table = cp.bearing_loads(fired("i4", "diesel", 0.1), rpm=1500).frames.text()
    out = printed(capsys, "bearings i4 --rpm 1500 --cycle diesel --bore 100mm")
    assert out.startswith(table)
    assert table not in printed(capsys, "bearings i4 --rpm 1500")
    assert "taken to equal the stroke" not in out
    without = tmp_path / "without-bores.toml"
    cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.45)).save(without)
    out = printed(capsys, f"bearings {without} --cycle petrol")
    assert "taken to equal the stroke" in out


def test_torque_and_bearings_have_one_default_and_say_it(capsys: CAPTURE, tmp_path: Path) -> None:
    says = "Gas: example petrol, full load."
    for command in ("torque", "bearings"):
        for strokes in ("i4", "i3-two-stroke"):
            out = printed(capsys, f"{command} {strokes}")
            assert says in out
            assert out == printed(capsys, f"{command} {strokes} --cycle petrol")
            assert says not in printed(capsys, f"{command} {strokes} --cycle none")
        assert "Gas: example diesel, idling." in printed(capsys, f"{command} i4 --cycle diesel:0")
        part = printed(capsys, f"{command} i4 --cycle petrol:30%")
        assert part == printed(capsys, f"{command} i4 --cycle petrol:0.3")
        assert "Gas: example petrol, 30 % load." in part
    bare = tmp_path / "bare.toml"
    cp.Engine.preset("i4").replace(firing_order="").save(bare)
    out = printed(capsys, f"bearings {bare}")
    assert "Without gas pressure." in out
    assert "It is not counted, since firing_order = None: " in out


def test_what_was_read_of_a_file_is_printed(capsys: CAPTURE, tmp_path: Path) -> None:
    theta = np.arange(0.0, 720.0, 2.0)
    pressure = cp.Cycle.example().pressure_at(theta)
    file = tmp_path / "bench.csv"
    rows = np.c_[np.tile(theta / 9000.0, 1), pressure / 1e5 - 0.98]
    np.savetxt(file, rows, delimiter=",", header="t [s],gauge bar")
    out = printed(capsys, f"torque i4 --cycle {file} --atmosphere 0.98bar --recorded-rpm 1500")
    assert "Read: 1 cycle, bar (header), gauge (header), 98000 Pa added, over time (header)" in out
    engine = fired("i4", bore=0.086)
    assert f"{engine.balance(3000).crank_torque.cycle_mean:.1f}" in out


def test_orders_of_noise_are_counted_below_the_table(capsys: CAPTURE, tmp_path: Path) -> None:
    """A noisy trace has all orders there are: those that matter are printed, and all as CSV."""
    theta = np.arange(720.0)
    noise = np.random.default_rng(5).normal(0.0, 2e3, theta.size)
    file = tmp_path / "noisy.csv"
    rows = np.c_[theta, (cp.Cycle.example().pressure_at(theta) + noise) / 1e5]
    np.savetxt(file, rows, delimiter=",", header="angle [deg],absolute pressure [bar]")
    typed = f"torque i4 --bore 86mm --cycle {file}"
    whole = list(csv.reader(io.StringIO(printed(capsys, f"{typed} --csv"))))[1:]
    peaks = {row[0]: max(map(float, row[1:2])) for row in whole if row[0] not in ("mean", "all")}
    small = [order for order, peak in peaks.items() if peak <= 1e-3 * max(peaks.values())]
    assert len(peaks) > 80
    out = printed(capsys, typed)
    lines = [line.split()[0] for line in out.splitlines()[2:]]
    assert lines[: lines.index("all")] == [
        "mean",
        *(order for order in peaks if order not in small),
    ]
    assert f"Not shown: {len(small)} orders" in out
    assert "--csv prints them" in out
    cylinders = [each.replace(bore=0.086) for each in cp.Engine.preset("i4").cylinders]
    engine = cp.Engine.preset("i4").replace(cylinder=cylinders)
    engine.with_cycle(cp.Cycle.load(file)).save(tmp_path / "noisy.toml")
    balance = printed(capsys, f"balance {tmp_path / 'noisy.toml'} --rpm 6000")
    assert len(balance.splitlines()) < 30
    assert "--csv prints them" in balance
    named = printed(capsys, f"{typed} --orders {','.join(peaks)}")
    assert len(named.splitlines()) > 80


@pytest.mark.parametrize("on", ["crank", "block"])
def test_torque_is_that_of_the_library(capsys: CAPTURE, on: str) -> None:
    balance = fired("v6-90-odd-fire").balance(2000, orders=[0.5, 1, 1.5, 3])
    quantity = balance.crank_torque if on == "crank" else balance.torque
    typed = f"torque v6-90-odd-fire --rpm 2000 --orders 0.5,1,1.5,3 --on {on}"
    out = printed(capsys, typed)
    assert quantity.table.text().split("\n", 1)[1] in out
    assert out.splitlines()[0].startswith("V6 90°")
    head, *rows = csv.reader(io.StringIO(printed(capsys, f"{typed} --csv")))
    assert head[:4] == ["order", f"{quantity.kind.symbols[0]} N·m", "phase °", "gas N·m"]
    assert [row[0] for row in rows] == ["mean", "0.5", "1", "1.5", "3", "all"]
    assert float(rows[3][1]) == quantity[1.5].peak
    assert float(rows[3][2]) == np.angle(quantity[1.5].phasor, deg=True)


def test_a_fired_engine_keeps_its_own_cycle(capsys: CAPTURE, tmp_path: Path) -> None:
    engine = cp.Engine.preset("i4")
    cycle = cp.Cycle.otto(engine.cylinders[0], compression_ratio=9, pressure_ratio=3)
    fired = engine.with_cycle(cycle)
    fired.save(tmp_path / "i4.toml")
    out = printed(capsys, f"torque {tmp_path / 'i4.toml'} --orders 2")
    assert f"{fired.balance(3000).crank_torque.cycle_mean:.2f}" in out
    assert "petrol" not in out
    assert "petrol" in printed(capsys, f"torque {tmp_path / 'i4.toml'} --cycle petrol")


@pytest.mark.parametrize(
    ("command", "pictures"),
    [("torque", ["curves", "spectrum"]), ("bearings", ["polar", "curves", "bending"])],
)
def test_pictures_are_written(
    capsys: CAPTURE, tmp_path: Path, command: str, pictures: list[str]
) -> None:
    sizes = set()
    for picture in pictures:
        file = tmp_path / f"{picture}.png"
        printed(capsys, f"{command} i4 --picture {picture} --plot {file}")
        sizes.add(file.read_bytes())
    assert len(sizes) == len(pictures)


@pytest.mark.filterwarnings("default:pressure varies")
def test_files_of_cycles_are_read_as_options_say(capsys: CAPTURE, tmp_path: Path) -> None:
    theta = np.arange(0, 720, 2)
    pressure = cp.Cycle.example().pressure_at(theta)
    file = tmp_path / "bench.csv"
    columns = [np.radians(theta + 90.0), theta, pressure / 1e5 - 1.01325]
    np.savetxt(file, np.transpose(columns), delimiter=",", header="a,b,p")
    read = f"--cycle {file} --angle-unit rad --tdc 90deg --columns 0,2"
    out = printed(capsys, f"torque i4 {read} --pressure-unit bar --gauge --bore 86mm --orders 2")
    engine = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.5, bore=0.086))
    mean = (
        engine.with_cycle(cp.Cycle(theta, pressure))
        .balance(3000, orders=[2])
        .crank_torque.cycle_mean
    )
    assert f"{mean:.2f}" in out
    for typed, hints in (
        (f"bearings i4 {read}", ["--pressure-unit is left out: ", "give one of Pa"]),
        (
            f"torque i4 {read} --pressure-unit bar",
            ["--gauge is left out: ", "give --gauge, or --abso"],
        ),
        ("torque i4 --tdc 3", ["--tdc needs a file of --cycle"]),
        ("torque i4 --cycle petrol --gauge", ["--gauge needs a file of --cycle"]),
        (f"torque i4 {read} --gauge --absolute", ["--gauge cannot be combined with --absolute"]),
    ):
        assert main(typed.split()) == 2
        err = capsys.readouterr().err
        assert all(hint in err for hint in hints), err
    assert main(f"torque i4 --cycle {file} --columns 1,2 --gauge --pressure-unit Pa".split()) == 0
    assert "was gauge pressure given in bar" in capsys.readouterr().err


def test_hints_can_be_followed(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "fired.toml"
    fired("i4", bore=0.086).save(file)
    assert "Gas pressure is not counted" in printed(
        capsys, f"tolerances {file} --pin 0.1 --samples 50"
    )
    assert main(f"shafts {file} --ratios 2,-2".split()) == 2
    assert "--rpm is left out: " in capsys.readouterr().err
    assert "at 2000 rpm" in printed(capsys, f"shafts {file} --ratios 2,-2 --rpm 2000")
    bare = tmp_path / "bare.toml"
    cp.Engine.preset("i4").replace(firing_order="").save(bare)
    assert main(f"torque {bare}".split()) == 2
    assert "--firing-order is left out: " in capsys.readouterr().err
    table = printed(capsys, "torque i4 --firing-order 1-3-4-2").splitlines()[1:]
    assert printed(capsys, f"torque {bare} --firing-order 1-3-4-2").splitlines()[1:] == table


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        ("torque i4 --cycle nowhere.csv", "nowhere.csv"),
        ("torque i4 --cycle gasoline", "--cycle = gasoline: give petrol or diesel for an example"),
        ("torque i4 --cycle petrol:2", "--cycle = petrol:2: give a part of full load, 0"),
        ("torque i4 --crankcase 1.2bars", "--crankcase = 1.2bars: give a number"),
        ("torque i4 --orders 0.25", "--orders = 0.25: give multiples of crank speed"),
        ("bearings i4 --load piston", "--load"),
        ("bearings i4 --cycle petrol --bore 0", "--bore = 0: give metres above zero"),
    ],
)
def test_errors_name_the_option(capsys: CAPTURE, typed: str, message: str) -> None:
    assert main(typed.split()) == 2
    assert message in capsys.readouterr().err


def test_a_trace_is_read_prepared_and_saved(capsys: CAPTURE, tmp_path: Path) -> None:
    theta, random = np.arange(-360.0, 360.0, 1.0), np.random.default_rng(3)
    cycle = cp.Cycle.example()
    pressure = cycle.pressure_at(theta) + 5e4 + random.normal(0.0, 5e3, (8, len(theta)))
    with_bore = cp.Engine.preset("i4").cylinders[0]
    motored = cp.Cycle.motored(with_bore, compression_ratio=10.5).pressure_at(theta + 1.0)
    header = "crank angle [deg];" + ";".join(["p abs [bar]"] * 8)
    table = np.c_[theta, pressure.T / 1e5]
    file, other, out = tmp_path / "run.csv", tmp_path / "motored.csv", tmp_path / "run.toml"
    np.savetxt(file, table, fmt="%.4f", delimiter=";", header=header)
    np.savetxt(other, np.c_[theta, motored / 1e5], delimiter=";", header=header[:30])
    cylinder = cp.Engine.preset("i4").cylinders[0].replace(bore=0.09)
    prepared = cp.prepare_trace(
        cp.Traces.load(file, strokes=4), cylinder, intake_pressure=0.95e5, lowpass_order=60
    )
    typed = f"trace i4 {file} --bore 90mm --intake-pressure 0.95bar --lowpass-order 60 --save {out}"
    text = printed(capsys, typed)
    assert prepared.table.text() in text
    assert prepared.traces.spread(cylinder).text() in text
    assert "Read: 8 cycles in columns" in text
    saved = cp.Engine.load(out)
    assert saved.cycles is not None
    assert saved.cycles[0] == prepared.cycle
    assert saved.cylinders[0].bore == 0.09
    with_motored = printed(capsys, f"trace i4 {file} --motored {other} --loss-angle 1")
    assert "loss angle 1°, given" in with_motored
    assert "Bores that are not known" not in with_motored  # the preset has one
    assert main(["trace", "i4", str(file), "--bore", "0"]) == 2
    assert capsys.readouterr().err.startswith("crankpin: error: --bore = 0: ")
    assert main(["trace", "i4", str(file), "--exponent", "1.3"]) == 2
    assert "--compression-ratio" in capsys.readouterr().err


FAN = "fan: on=shaft force=2:8@90,4:1-2j z=-100mm direction=30"
CAM = "cam: on=both torque=0:-3,1.5:4 ratio=1/2 y=0.25"
ADDED = [
    cp.PeriodicLoad("fan", on="shaft", force={2: 8j, 4: 1 - 2j}, z=-0.1, direction_deg=30),
    cp.PeriodicLoad("cam", on="both", torque={0: -3, 1.5: 4}, ratio="1/2", y=0.25),
]


def test_loads_are_added(capsys: CAPTURE) -> None:
    """Parts of loads are columns under their names."""
    typed = ["--rpm", "2000", "--add-load", FAN, "--add-load", CAM]
    engine = cp.Engine.preset("i4").with_loads(ADDED)
    assert main(["torque", "i4", "--cycle", "none", *typed, "--csv"]) == 0
    expected = engine.balance(2000).crank_torque.table.to_csv()
    assert capsys.readouterr().out == expected
    assert "cam" in expected.partition("\n")[0]
    assert main(["balance", "i4", *typed]) == 0
    out = capsys.readouterr().out
    assert out.startswith(repr(engine.balance(2000)).partition("\n")[0])
    assert "loads: fan, cam" in out
    assert main(["explain", "i4", *typed]) == 0
    assert 'The load "cam" adds' in capsys.readouterr().out


def test_loads_are_written_into_files(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "i4.toml"
    grows = "mill: on=shaft force=0:5 turning=yes rpm=2500 crank=0 phase=400"
    table = "shaker: on=block force=2:8/9 rpm=1000/2000 cylinder=1"
    words = [word for load in (FAN, grows, table) for word in ("--add-load", load)]
    assert main(["new", "i4", *words, "-o", str(file)]) == 0
    capsys.readouterr()
    fan, mill, shaker = cp.Engine.load(file).loads
    assert fan == ADDED[0]
    assert (mill.scaling, mill.rpm, mill.turning) == ("speed squared", 2500.0, True)
    assert (shaker.rpm, shaker.force, shaker.cylinder) == ((1000.0, 2000.0), {2: (8, 9)}, 1)
    # Beside those that a file has, in units of the shell's.
    more = ["--units", "lbf,in", "--add-load", "belt: on=shaft force=1:2 z=3"]
    assert main(["balance", str(file), "--rpm", "1500", *more]) == 0
    assert "loads: fan, mill, shaker, belt" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ("fan", "on=shaft"),
        ("fan: force=2:8", "say what it acts on"),
        ("fan: on=ship force=2:8", "shaft"),
        ("fan: on=shaft force=2", "ORDER:SIZE"),
        ("fan: on=shaft force=2:x", "an amplitude"),
        ("fan: on=shaft force=2.3:8", "half the crank speed"),
        ("fan: on=shaft force=2:8 mass=3", "cylinder"),
        ("fan: on=shaft", "amplitudes"),
        ("fan: on=shaft force=2:8 ratio=0.3", "1/2"),
        ("fan: on=shaft force=2:8 z=1kg", "mm"),
        ("fan: on=shaft force=2:8 cylinder=9", "cylinder"),
    ],
)
def test_slips_in_loads_are_said(capsys: CAPTURE, load: str, said: str) -> None:
    assert main(["balance", "i4", "--add-load", load]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_traces_of_several_cylinders_in_one_file(capsys: CAPTURE, tmp_path: Path) -> None:
    """As of Python, cylinder by cylinder; the engine saved has the cycle of each."""
    theta, random = np.arange(-360.0, 360.0, 1.0), np.random.default_rng(4)
    centres, sizes = [0.0, 540.0, 180.0, 360.0], [1.0, 0.9, 0.8, 0.7]
    cycle = cp.Cycle.example()
    pressure = [
        size * cycle.pressure_at(theta - tdc) + random.normal(0.0, 1e3, len(theta))
        for tdc, size in zip(centres, sizes, strict=True)
    ]
    file, out, picture = (tmp_path / name for name in ("run8.csv", "run8.toml", "run8.png"))
    header = "angle [deg];" + ";".join(f"p{k} abs [bar]" for k in range(1, 5))
    np.savetxt(
        file, np.c_[theta, np.transpose(pressure) / 1e5], delimiter=";", header=header, comments=""
    )
    columns = ["angle", "p1 abs", "p2 abs", "p3 abs", "p4 abs"]
    typed = [
        *("trace", "i4", str(file), "--columns", ",".join(columns), "--tdc", "0,540,180,360"),
        *("--lowpass-order", "60", "--save", str(out), "--plot", str(picture)),
    ]
    assert main(typed) == 0
    text = capsys.readouterr().out
    traces = cp.Traces.load_cylinders(file, columns=columns, tdc_deg=centres, strokes=4)
    cylinder = cp.Engine.preset("i4").cylinders[0]
    prepared = [cp.prepare_trace(each, cylinder, lowpass_order=60) for each in traces]
    saved = cp.Engine.load(out)
    assert saved.cycles == tuple(each.cycle for each in prepared)
    assert "Prepared traces of run8, 4 cylinders: change by step" in text
    assert picture.stat().st_size > 1000
    assert main([*typed[:7], "--lowpass-order", "60", "--csv"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert [row["cylinder"] for row in rows] == ["1", "1", "2", "2", "3", "3", "4", "4"]
    for one, of in zip(rows[1::2], prepared, strict=True):
        imep = next(text for head, text in one.items() if head.startswith("imep"))
        assert float(imep) == of.table["imep"].values[-1]
    for tdc, columns_typed, word in [
        ("0,540", "angle,p1 abs,p2 abs", "--tdc = 0,540: the engine has 4 cylinders"),
        ("0,540,180,360", "angle,p1 abs", "--tdc has 4 angles for 1 cylinders"),
    ]:
        short = ["trace", "i4", str(file), "--columns", columns_typed, "--tdc", tdc]
        assert main(short) == 2
        assert word in capsys.readouterr().err


def test_a_record_of_an_oscilloscope_is_read_by_roles(
    capsys: CAPTURE, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = cp.Engine.preset("i4")
    seconds = np.arange(0.0, 0.6, 2e-5)
    theta = 9000.0 * seconds - 500.0
    volts = [cp.Cycle.example().pressure_at(theta - at) / 20e5 + 0.05 for at in (0, 540, 180, 360)]
    local = (theta + 114.0) % 360.0
    wheel, mark = 5.0 * ((local % 6 < 3) & (local < 348)), 5.0 * (local < 3)
    columns = np.c_[seconds, np.transpose(volts), wheel, mark]
    head = "Time,CH1,CH2,CH3,CH4,CH5,CH6\ns,V,V,V,V,V,V"
    np.savetxt(tmp_path / "scope.csv", columns, "%.6f", ",", header=head, comments="")
    monkeypatch.chdir(tmp_path)
    clock = "--encoder CH5 --pulses 60-2 --tdc 114"
    one = f"trace i4 scope.csv --bore 86mm --pressure CH1:20bar/V,-1bar {clock} --index CH6"
    text = printed(capsys, f"{one} --intake-pressure 0.95bar --save run.toml")
    scope = cp.oscillogram(
        "scope.csv", pressure="CH1:20bar/V,-1bar", encoder="CH5", pulses="60-2", index="CH6",
        tdc_deg=114,
    )  # fmt: skip
    assert scope.table.text() in text
    assert f"Read: {scope.traces[0].origin}." in text
    assert "firing by pressure" in text
    cylinder = engine.cylinders[0].replace(bore=0.086)
    prepared = cp.prepare_trace(scope.traces[0], cylinder, intake_pressure=0.95e5)
    assert prepared.traces.spread(cylinder).text() in text
    saved = cp.Engine.load("run.toml")
    assert saved.cycles is not None
    assert saved.cycles[0] == prepared.cycle
    assert saved.cylinders[0].bore == 0.086
    released = printed(capsys, f"{one} --compression-ratio 10 --gamma 1.3")
    assert (
        scope.traces[0].heat_spread(cylinder, compression_ratio=10.0, gamma=1.3).text() in released
    )
    each = " ".join(f"--pressure CH{k}:20bar/V,-1bar" for k in (1, 2, 3, 4))
    of_all = printed(capsys, f"trace i4 scope.csv --bore 86mm {each} {clock}")
    assert "scope, 4 cylinders, spread" in of_all
    rate = "--sampling-rate 50000"
    by_rate = printed(capsys, f"{one} {rate}")
    assert "irregularity" in by_rate
    assert printed(capsys, f"{one} --sampling-rate 50kHz") == by_rate
    for line, message in (
        (f"trace i4 scope.csv --pressure CH1:20bar/V {clock} --columns 0,1", "--columns = 0,1: an"),
        ("trace i4 scope.csv --pressure CH1:20bar/V --encoder CH5", "--encoder needs --pulses"),
        ("trace i4 scope.csv --pulses 60-2", "--pulses = 60-2: needs --encoder"),
        (f"trace v6-60 scope.csv {each} {clock}", "the engine has 6 cylinders; give one channel"),
        (f"{one.replace('CH5', 'CH9')}", "--encoder = CH9: there is none; the file has"),
        (f"{one} --gamma 1.3", "--gamma = 1.3: needs --compression-ratio"),
        (f"{one} --time 0:h", "--time = '0:h': give a unit of time"),
        (f"{one} --sampling-rate 50mHz", "--sampling-rate = 50mHz"),
        (f"{one} --time 7", "--time = 7: give numbers from 0 to 6"),
    ):
        assert main(line.split()) == 2, line
        assert message in capsys.readouterr().err
