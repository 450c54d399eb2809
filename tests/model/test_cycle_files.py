"""Are tables of pressure read as they say, whatever program wrote them?"""

# ruff: noqa: ANN401 - options of any type

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest

if TYPE_CHECKING:
    from pathlib import Path

THETA = np.arange(0.0, 720.0, 2.0)
PRESSURE = 1e5 + 3.9e6 * np.exp(20 * (np.cos(np.radians((THETA - 12) / 2)) - 1))
ABSOLUTE: dict[str, Any] = {"pressure_unit": "Pa", "gauge": False}


def written(
    folder: Path, header: str, separator: str = ",", scale: float = 1.0, **options: Any
) -> Path:
    angles = options.get("angles", THETA)
    pressures = options.get("pressures", PRESSURE) / scale
    lines = [
        f"{angle:.10g}{separator}{pressure:.12g}"
        for angle, pressure in zip(angles, pressures, strict=True)
    ]
    if options.get("comma"):
        lines = [line.replace(".", ",") for line in lines]
    path = folder / str(options.get("name", "bench.csv"))
    path.write_text("\n".join([header, *lines]), options.get("encoding", "utf-8"))
    return path


@pytest.mark.parametrize(
    ("header", "scale", "above"),
    [
        ("crank angle [deg],pressure [Pa abs]", 1.0, 0.0),
        ("angle,p_cyl (kPa absolute)", 1e3, 0.0),
        ("angle,p_cyl / MPa (abs.)", 1e6, 0.0),
        ("CA,cylinder pressure bara", 1e5, 0.0),
        ("CA,cylinder pressure [barg]", 1e5, 101325.0),
        ("CA,psig", 6894.757293168361, 101325.0),
        ("CA,gauge pressure mbar", 100.0, 101325.0),
        ("°KW,Druck hPa (relative)", 100.0, 101325.0),
    ],
)
def test_units_and_gauge_pressure_are_read_from_the_header(
    tmp_path: Path, header: str, scale: float, above: float
) -> None:
    path = written(tmp_path, header, scale=scale, pressures=PRESSURE - above)
    cycle = cp.Cycle.load(path)
    # Twelve digits are written.
    np.testing.assert_allclose(cycle.pressure, PRESSURE, rtol=1e-10)
    np.testing.assert_array_equal(cycle.theta_deg, THETA)
    assert cycle.name == "bench"


@pytest.mark.parametrize("separator", [";", "\t", " ", "   "])
def test_decimal_commas_are_recognised(tmp_path: Path, separator: str) -> None:
    angles = THETA + 0.5
    path = written(tmp_path, f"angle{separator}p", separator, 1e5, comma=True, angles=angles)
    cycle = cp.Cycle.load(path, pressure_unit="bar", gauge=False)
    np.testing.assert_array_equal(cycle.theta_deg, angles)
    np.testing.assert_allclose(cycle.pressure, PRESSURE, rtol=1e-10)


def test_angles_from_any_event_in_radians_and_columns_by_name(tmp_path: Path) -> None:
    path = tmp_path / "run 7.txt"
    lines = [
        f"{k}\t{np.radians(angle + 114):.15g}\t{pressure / 1e5:.12g}"
        for k, (angle, pressure) in enumerate(zip(THETA, PRESSURE, strict=True))
    ]
    head = ["% bench of today", "", "row\tphi rad\tp bar abs"]
    path.write_bytes("\ufeff".encode() + "\r\n".join([*head, *lines]).encode())
    cycle = cp.Cycle.load(path, columns=("phi rad", "p bar abs"), tdc_deg=114)
    np.testing.assert_allclose(cycle.theta_deg, THETA, atol=1e-9)
    assert cycle == cp.Cycle.load(path, columns=(1, 2), tdc_deg=114)
    again = cp.Cycle.load(
        path, columns=(1, 2), tdc_deg=114, angle_unit="rad", pressure_unit="bar", gauge=False
    )
    assert cycle == again


def test_quoted_numbers_utf_16_and_names_above_units_are_read(tmp_path: Path) -> None:
    lines = [f'"{angle:g}","{p / 1e5:.12g}"' for angle, p in zip(THETA, PRESSURE, strict=True)]
    text = "\n".join(['"angle","absolute pressure"', '"deg","bar"', *lines])
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "latin-1"):
        path = tmp_path / f"{encoding}.csv"
        path.write_bytes(text.encode(encoding))
        cycle = cp.Cycle.load(path, name="bench")
        np.testing.assert_allclose(cycle.pressure, PRESSURE, rtol=1e-10)
        assert cycle == cp.Cycle.load(path, columns=("angle", "bar"), name="bench")
    path.write_bytes(bytes(range(256)) * 8)
    with pytest.raises(cp.InputError, match="NUL bytes and is no text"):
        cp.Cycle.load(path)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("header", ["Winkel [°]", "угол поворота коленчатого вала [deg]", ""])
def test_utf_16_needs_no_byte_order_mark(tmp_path: Path, encoding: str, header: str) -> None:
    lines = [f"{angle:g};{p / 1e5:.8g}" for angle, p in zip(THETA, PRESSURE, strict=True)]
    above = [f"{header};absolute pressure [bar]"] if header else []
    text = "\r\n".join([*above, *lines]).replace(".", ",")
    path = tmp_path / "bench.txt"
    path.write_bytes(text.encode(encoding))
    cycle = cp.Cycle.load(path, angle_unit="deg", pressure_unit="bar", gauge=False)
    np.testing.assert_allclose(cycle.pressure, PRESSURE, rtol=1e-6)


RANDOM = np.random.default_rng(4)
CYCLES = PRESSURE * (1.0 + 0.05 * RANDOM.standard_normal((5, 1)))
VOLUME = 5e-4 * (1.05 - np.cos(np.radians(THETA)))


def test_cycles_in_columns_are_all_that_are_alike(tmp_path: Path) -> None:
    path = tmp_path / "five.csv"
    columns = [THETA, *CYCLES, VOLUME]
    np.savetxt(path, np.transpose(columns), delimiter=",", header="angle,abs Pa,Pa,Pa,Pa,Pa,m3")
    traces = cp.Traces.load(path)
    np.testing.assert_allclose(traces.pressure, CYCLES)
    assert traces.origin.startswith(
        "5 cycles in columns, 5 of 6 columns beside the first, Pa (header)"
    )
    cycle = cp.Cycle.load(path)
    np.testing.assert_allclose(cycle.pressure, CYCLES.mean(axis=0))
    assert cycle.origin == traces.origin
    assert cycle.origin in repr(cycle)
    third = cp.Cycle.load(path, columns=(0, 3), **ABSOLUTE)
    np.testing.assert_allclose(third.pressure, CYCLES[2])
    two = cp.Traces.load(path, columns=(0, 3, 5), **ABSOLUTE)
    np.testing.assert_allclose(two.pressure, CYCLES[[2, 4]])
    np.savetxt(path, np.transpose([THETA, CYCLES[0], VOLUME]), header="angle,abs Pa,m3")
    assert cp.Cycle.load(path, **ABSOLUTE).pressure.size == 360


@pytest.mark.parametrize("title", ["", "Cycle {}", "angle;abs Pa"])
@pytest.mark.parametrize("origin", [0.0, -360.0, 117.0])
def test_cycles_in_blocks_of_rows_are_read(tmp_path: Path, title: str, origin: float) -> None:
    path = tmp_path / "blocks.csv"
    lines = ["angle deg;abs Pa"]
    for k, cycle in enumerate(CYCLES):
        lines += [title.format(k)] if k else []
        lines += [f"{a + origin:.10g};{p:.12g}" for a, p in zip(THETA, cycle, strict=True)]
    for cut in (1, 151):  # with the last block broken off
        path.write_text("\n".join(lines[: len(lines) - cut + 1]), "utf-8")
        traces = cp.Traces.load(path, tdc_deg=origin)
        np.testing.assert_allclose(traces.theta_deg, THETA, atol=1e-9)
        np.testing.assert_allclose(traces.pressure, CYCLES[: 5 - (cut > 1)], rtol=1e-10)
        assert ("an incomplete one left out" in traces.origin) == (cut > 1)


def test_blocks_on_other_grids_are_read_at_the_angles_of_the_first(tmp_path: Path) -> None:
    path = tmp_path / "blocks.txt"
    shifted = THETA + 0.7
    values = 1e5 + 3.9e6 * np.exp(20 * (np.cos(np.radians((shifted - 12) / 2)) - 1))
    rows = np.concatenate([np.c_[THETA, PRESSURE], np.c_[shifted, values]])
    np.savetxt(path, rows, header="angle deg, absolute pressure Pa")
    traces = cp.Traces.load(path)
    # Cubics through four points 2° apart of a peak 26° wide; straight lines miss by 1e-3.
    np.testing.assert_allclose(traces.pressure[1], PRESSURE, atol=2e-5 * PRESSURE.max())


def test_cycles_in_a_row_are_read_over_angle_and_over_time(tmp_path: Path) -> None:
    path = tmp_path / "row.csv"
    angles = np.arange(0.0, 5 * 720.0, 2.0)
    np.savetxt(path, np.c_[angles - 360.0, CYCLES.ravel()], header="angle deg, abs pressure Pa")
    traces = cp.Traces.load(path, tdc_deg=-360)
    np.testing.assert_allclose(traces.pressure, CYCLES, rtol=1e-12)
    np.testing.assert_array_equal(traces.theta_deg, THETA)
    assert traces.origin.startswith("5 cycles in a row")
    # Sampled by a clock that knows nothing of the crank, at a speed that nobody states.
    rpm, start = 1234.5, 0.013
    times = np.arange(0.0, 5 * 120.0 / rpm, 2e-4)
    at = np.radians(6.0 * rpm * times - 12.0) / 2.0
    pressure = 1e5 + 3.9e6 * np.exp(20 * (np.cos(at) - 1))
    for unit, scale in (("s", 1.0), ("ms", 1e3)):
        rows = np.c_[(times + start) * scale, pressure / 1e5]
        np.savetxt(path, rows, delimiter="\t", header=f"time [{unit}]\tp abs [bar]")
        traces = cp.Traces.load(path, tdc_deg=6 * rpm * start)
        assert f"over time (header) at {rpm:g} rpm" in traces.origin
        at = np.radians(traces.theta_deg - 12.0) / 2.0
        expected = 1e5 + 3.9e6 * np.exp(20 * (np.cos(at) - 1))
        # The speed is that of compressions, whose times are interpolated linearly: 1e-6 of it.
        assert abs(traces.pressure - expected).max() < 1e-3 * expected.max()


def test_the_speed_of_a_short_record_over_time_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "one.csv"
    seconds = THETA / (6.0 * 1500.0)
    np.savetxt(path, np.c_[seconds, PRESSURE], delimiter=",", header="t [s],abs Pa")
    with pytest.raises(cp.InputError, match=r"fewer than three cycles over time: .*recorded_rpm="):
        cp.Cycle.load(path)
    cycle = cp.Cycle.load(path, recorded_rpm=1500)
    np.testing.assert_allclose(cycle.theta_deg, THETA, atol=1e-9)
    with pytest.raises(cp.InputError, match=r"recorded_rpm = 0\.0: give the crank speed"):
        cp.Cycle.load(path, recorded_rpm=0)
    many = np.c_[np.arange(5 * 360) * 2 / 9000, np.tile(PRESSURE, 5)]
    np.savetxt(path, many, delimiter=",", header="t [s],abs Pa")
    with pytest.warns(UserWarning, match="recorded_rpm = 3000: compressions .* 1500 rpm"):
        cp.Cycle.load(path, recorded_rpm=3000)
    with pytest.raises(cp.InputError, match="recorded_rpm = 3000: needs a record"):
        cp.Cycle.load(written(tmp_path, "angle,abs Pa"), recorded_rpm=3000)


def test_long_files_are_read_in_pieces(tmp_path: Path) -> None:
    """More than the 16 MiB that other files are bounded by, in either of the ways of reading."""
    theta = np.arange(-360.0, 360.0, 0.1)
    pressure = cp.Cycle.example().pressure_at(theta) / 1e5
    block = "".join(f"{a:.1f};{p:.4f};\n" for a, p in zip(theta, pressure, strict=True))
    plain = block.replace(";\n", "\n")
    path = tmp_path / "long.csv"
    for text, count in ((block, 20), (plain, 180)):
        path.write_text("deg;bar abs\n" + text * count, "utf-8")
        traces = cp.Traces.load(path)
        assert traces.pressure.shape == (count, 7200)
        # Four decimals of a bar are written.
        assert abs(traces.pressure / 1e5 - pressure).max() < 1e-4
    assert path.stat().st_size > 2**24


def test_pressure_in_pa_under_another_heading_is_warned_of(tmp_path: Path) -> None:
    for heading in ("bar", "kPa", "psi", "MPa"):
        path = written(tmp_path, f"angle,absolute pressure {heading}")
        with pytest.warns(UserWarning, match="are its numbers in the unit that is named"):
            cp.Cycle.load(path)
    shifted = written(tmp_path, "angle,absolute pressure Pa", angles=THETA + 360)
    with pytest.warns(UserWarning, match=r"far from the firing top dead centre.*tdc_deg=…"):
        cp.Cycle.load(shifted)
    assert cp.Cycle.load(shifted, tdc_deg=360).theta_deg[0] == 0.0


def test_old_encodings_are_read(tmp_path: Path) -> None:
    path = written(tmp_path, "Kurbelwinkel °,Druck Pa abs", encoding="latin-1")
    assert len(cp.Cycle.load(path).theta_deg) == 360


@pytest.mark.parametrize(
    "cycle",
    [
        cp.Cycle(THETA, PRESSURE, name="a table, of θ"),
        cp.Cycle(THETA[:180], PRESSURE[:180] + PRESSURE[180:], strokes=2),
        cp.Cycle.example(),
    ],
    ids=["table", "two-stroke", "computed"],
)
@pytest.mark.parametrize("ending", [".csv", ".tsv"])
def test_what_is_saved_reads_back_as_an_equal_cycle(
    tmp_path: Path, cycle: cp.Cycle, ending: str
) -> None:
    path = tmp_path / f"cycle{ending}"
    cycle.save(path)
    assert cp.Cycle.load(path) == cycle


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("angle,p\n0,1e5\n", {}, "pressure_unit = None: the file does not name one"),
        ("angle,p Pa\n0,1e5\n", {}, "gauge = None: the file does not state"),
        ("angle,p\n0,1e5\n", {"pressure_unit": "atm"}, "pressure_unit = 'atm': give \"Pa\""),
        ("angle,p\n0,1e5\n", ABSOLUTE, "theta_deg = 1 points"),
        ("", ABSOLUTE, "no line of two numbers"),
        ("angle|p\n0|1e5\n", ABSOLUTE, r"no line of two numbers.* with digits is '0\|1e5'"),
        ("angle,p\n0,1e5\n1,high\n", ABSOLUTE, "no number in column 1 of line 3, '1 high'"),
        ("angle,p\n0,1e5\n1\n", ABSOLUTE, "no number in column 1 of line 3, '1'"),
        ("angle,p\n0,0,1,5\n", ABSOLUTE, "decimals written with commas"),
        (
            "angle,p\n0,1e5\n",
            {**ABSOLUTE, "columns": ("angle", "q")},
            "columns = 'q': there is none",
        ),
        ("angle,p\n0,1e5\n", {**ABSOLUTE, "columns": (0,)}, "give two"),
        (
            "angle,p\n0,1e5\n",
            {**ABSOLUTE, "columns": (0, 2)},
            "columns = 2: give numbers from 0 to 1, or names",
        ),
        ("angle,p\n0,1e5\n", {**ABSOLUTE, "gauge": "yes"}, "gauge = 'yes': give True or False"),
        ("angle,p\n0,1e5\n", {**ABSOLUTE, "tdc_deg": np.nan}, "tdc_deg = nan: give a finite"),
        ("# degree: x\nangle,p\n0,1e5\n", ABSOLUTE, "path has degree = 'x': give a whole number"),
        ("# strokes: 9\nangle,p\n0,1e5\n", ABSOLUTE, "strokes = 9: give 4"),
        ("# strokes: 0\nangle,p\n0,1e5\n", ABSOLUTE, "strokes = 0: give 4"),
    ],
)
def test_files_that_are_no_cycle_are_named(
    tmp_path: Path, text: str, options: dict[str, Any], message: str
) -> None:
    path = tmp_path / "wrong.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(cp.InputError, match=message):
        cp.Cycle.load(path, **options)


def test_paths_are_checked_and_files_bounded(tmp_path: Path) -> None:
    with pytest.raises(cp.InputError, match=r"path = 'cycle\.ods': name a text file"):
        cp.Cycle.load("cycle.ods")
    with pytest.raises(FileNotFoundError):
        cp.Cycle.load(tmp_path / "none.csv")
    endless = tmp_path / "endless.csv"
    endless.symlink_to("/dev/zero")
    with pytest.raises(cp.InputError, match="NUL bytes and is no text"):
        cp.Cycle.load(endless)
    endless = tmp_path / "line.csv"
    endless.write_text("1," * 2**20, "utf-8")
    with pytest.raises(cp.InputError, match="line of more than 1048576 characters"):
        cp.Cycle.load(endless)
