"""Are variables of MATLAB and HDF5 files read like columns of text?"""

from __future__ import annotations

import contextlib
import sys
import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from support import in_turn
from support import scope as scopes

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

THETA = np.arange(-360.0, 360.0)
CYCLES = cp.Cycle.example().pressure_at(THETA) / 1e5 * np.linspace(0.98, 1.02, 5)[:, np.newaxis]
OPTIONS: dict[str, Any] = {"pressure_unit": "bar", "gauge": False}


def matlab(path: Path, variables: dict[str, Any]) -> Path:
    pytest.importorskip("scipy.io").savemat(path, variables)
    return path


def hdf5(path: Path, variables: dict[str, Any], units: dict[str, str] | None = None) -> Path:
    with pytest.importorskip("h5py").File(path, "w") as file:
        _write(file, variables, units or {})
    return path


def _write(file: Any, variables: dict[str, Any], units: dict[str, str]) -> None:  # noqa: ANN401
    for name, values in variables.items():
        if isinstance(values, dict):
            _write(file.create_group(name), values, units)
        else:
            file[name] = values
            if name in units:
                file[name].attrs["units"] = units[name]


def matlab_73(path: Path, variables: dict[str, Any]) -> Path:
    """A file of MATLAB 7.3: HDF5 behind 512 bytes of a header, tables transposed."""
    turned = {name: np.atleast_2d(values).T for name, values in variables.items()}
    with pytest.importorskip("h5py").File(path, "w", userblock_size=512) as file:
        _write(file, turned, {})
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
    with path.open("r+b") as opened:
        opened.write(head)
    return path


def written(tmp_path: Path, kind: str, variables: dict[str, Any]) -> Path:
    if kind == "hdf5":
        return hdf5(tmp_path / "run.h5", variables)
    return {"matlab": matlab, "matlab 7.3": matlab_73}[kind](tmp_path / "run.mat", variables)


KINDS = ["matlab", "matlab 7.3", "hdf5"]


def text(tmp_path: Path, pressure: NDArray[np.float64]) -> cp.Traces:
    path = tmp_path / "run.csv"
    np.savetxt(path, np.c_[THETA, pressure.T], fmt="%.17g", header="angle [deg] p abs [bar]")
    return cp.Traces.load(path, **OPTIONS, name="run")


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_and_its_angles_are_those_of_a_text_file(tmp_path: Path, kind: str) -> None:
    path = written(tmp_path, kind, {"theta": THETA, "p": CYCLES, "speed": np.float64(1500.0)})
    expected = text(tmp_path, CYCLES).pressure
    found = cp.Traces.load(path, columns=["theta", "p"], **OPTIONS)
    np.testing.assert_array_equal(found.pressure, expected)
    assert found.name == "run"
    np.testing.assert_array_equal(
        cp.Traces.load(path, columns=["theta", "p 0", "p 3"], **OPTIONS).pressure, expected[[0, 3]]
    )
    turned = written(tmp_path, kind, {"theta": THETA[np.newaxis], "p": CYCLES.T})
    found = cp.Traces.load(turned, columns=["theta", "p"], **OPTIONS)
    np.testing.assert_array_equal(found.pressure, expected)


@pytest.mark.parametrize("kind", KINDS)
def test_cylinders_by_name_and_by_number(tmp_path: Path, kind: str) -> None:
    # MATLAB keeps the sequence in which variables were saved; HDF5 sorts names.
    variables = {"angle": THETA, "p1": CYCLES[0], "p2": np.roll(CYCLES[1], 180)}
    path = written(tmp_path, kind, variables)
    one, other = cp.Traces.load_cylinders(
        path, columns=["angle", "p1", "p2"], tdc_deg=[0.0, 180.0], **OPTIONS
    )
    again = cp.Traces.load_cylinders(path, columns=[0, 1, 2], tdc_deg=[0.0, 180.0], **OPTIONS)
    assert again == (one, other)
    np.testing.assert_allclose(one.pressure[0], CYCLES[0] * 1e5, rtol=1e-14)
    turned = other.mean_cycle.pressure_at(THETA)
    np.testing.assert_allclose(turned, CYCLES[1] * 1e5, rtol=1e-12)
    assert one.name == "run, p1"


def test_units_of_attributes_and_groups(tmp_path: Path) -> None:
    variables = {"run": {"angle": np.radians(THETA), "p": CYCLES[0].astype("f4")}, "note": b"text"}
    path = hdf5(tmp_path / "run.hdf5", variables, {"angle": "rad", "p": "bar abs"})
    found = cp.Traces.load(path, columns=["run.angle", "run.p"])
    assert found.origin.startswith("1 cycle, bar (header), absolute (header), angles in rad")
    # Single precision has seven digits.
    np.testing.assert_allclose(found.pressure[0], CYCLES[0] * 1e5, rtol=1e-6)


def test_structures_of_matlab_are_dotted_names(tmp_path: Path) -> None:
    path = matlab(tmp_path / "run.mat", {"run": {"angle": THETA, "p": CYCLES[0]}, "cell": "text"})
    found = cp.Traces.load(path, columns=["run.angle", "run.p"], **OPTIONS)
    np.testing.assert_allclose(found.pressure[0], CYCLES[0] * 1e5, rtol=1e-14)
    # Of two variables alone no names are needed.
    assert cp.Traces.load(path, **OPTIONS) == found


@pytest.mark.parametrize("kind", KINDS)
def test_an_oscillogram(tmp_path: Path, kind: str) -> None:
    channels = scopes.channels()
    names = {"time [s]": "t", "p abs [Pa]": "p", "wheel": "wheel", "mark": "mark"}
    samples = {names[key]: values for key, values in channels.items()}
    samples["mark"] = samples["mark"] > 2.5  # bits of a logic analyser
    path = written(tmp_path, kind, samples)
    given: dict[str, Any] = {"encoder": "wheel", "pulses": "12-1", "index": "mark"}
    expected = cp.oscillogram(channels, pressure="p abs [Pa]", time="time [s]", **given)
    found = cp.oscillogram(
        path, pressure="p", time="t", **given, pressure_unit="Pa", gauge=False, name=""
    )
    np.testing.assert_allclose(found.traces[0].pressure, expected.traces[0].pressure, rtol=1e-12)
    np.testing.assert_allclose(found.rpm, expected.rpm, rtol=1e-12)


def test_a_cycle_of_a_file(tmp_path: Path) -> None:
    path = matlab(tmp_path / "run.mat", {"theta": THETA, "p": CYCLES})
    np.testing.assert_allclose(
        cp.Cycle.load(path, columns=["theta", "p"], **OPTIONS).pressure,
        CYCLES.mean(axis=0) * 1e5,
        rtol=1e-12,
    )


@pytest.mark.parametrize("kind", KINDS)
@in_turn(
    ("columns", "words"),
    [
        (["theta", "q"], "columns = 'q': there is none; the file has '.*theta.*'"),
        (
            ["theta", "long"],
            "path has variables of different lengths: 'theta' of 720, 'long' of 730",
        ),
        (None, "path has variables of different lengths"),
        (["theta", "hole"], r"path has nan in column \d \('hole'\) of line 4"),
        ([0, 99], "columns = 99: give numbers from 0 to"),
    ],
)
def test_errors_name_the_variables(
    tmp_path: Path, kind: str, columns: list[Any] | None, words: str
) -> None:
    hole = CYCLES[0].copy()
    hole[3] = np.nan
    variables = {"theta": THETA, "p": CYCLES[0], "long": np.arange(730.0), "hole": hole}
    path = written(tmp_path, kind, variables)
    with pytest.raises(cp.InputError, match=words):
        cp.Traces.load(path, columns=columns, **OPTIONS)


def test_the_shell_reads_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = matlab(tmp_path / "run.mat", {"theta": THETA, "p": CYCLES})
    line = f"trace i4 {path} --bore 86mm --columns theta,p --pressure-unit bar --absolute"
    assert main(line.split()) == 0
    assert "Read: 5 cycles in columns, bar (given), absolute (given)" in capsys.readouterr().out
    assert main(f"trace i4 {path} --columns theta,q --pressure-unit bar".split()) == 2
    assert "--columns = 'q': there is none; the file has 'theta', 'p 0'" in capsys.readouterr().err


def test_other_bad_input(tmp_path: Path) -> None:
    path = matlab(tmp_path / "run.mat", {"theta": THETA, "p": CYCLES})
    with pytest.raises(cp.InputError, match="sheet = 'a': files of arrays have none"):
        cp.Traces.load(path, sheet="a")
    with pytest.raises(cp.InputError, match="pressure_unit"):
        cp.Traces.load(path, columns=["theta", "p"])
    # A table is none of one channel.
    with pytest.raises(
        cp.InputError, match=r"pressure = 'p': there is none; the file has .*'p 0', "
    ):
        cp.oscillogram(path, pressure="p", encoder="theta", pulses=60, sampling_rate=1e4, **OPTIONS)
    one = matlab(tmp_path / "one.mat", {"theta": THETA, "z": THETA * 1j, "word": "text"})
    with pytest.raises(cp.InputError, match="path has no two variables of numbers; it has 'theta'"):
        cp.Traces.load(one)


@pytest.mark.parametrize("kind", KINDS)
def test_damaged_files_are_named(tmp_path: Path, kind: str) -> None:
    path = written(tmp_path, kind, {"theta": THETA, "p": CYCLES})
    whole = path.read_bytes()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for data in (b"", whole[:100], whole[:600], whole[: len(whole) // 2], b"PK\x03\x04 else"):
            path.write_bytes(data)
            with pytest.raises(cp.InputError, match=r"path (cannot be read as an? |has )"):
                cp.Traces.load(path, columns=["theta", "p"], **OPTIONS)
    with pytest.raises(OSError, match="nowhere"):
        cp.Traces.load(tmp_path / f"nowhere{path.suffix}")


@in_turn("seed", range(30))
def test_changed_bytes_raise_nothing_else(tmp_path: Path, seed: int) -> None:
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    path = written(tmp_path, kind, {"theta": THETA, "p": CYCLES[0]})
    data = bytearray(path.read_bytes())
    for at in random.integers(0, len(data), 20):
        data[at] = int(random.integers(256))
    path.write_bytes(bytes(data))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with contextlib.suppress(cp.InputError, OSError):
            cp.Traces.load(path, columns=["theta", "p"], **OPTIONS)


@pytest.mark.parametrize(
    ("module", "name", "extra"), [("scipy.io", "run.mat", "optimize"), ("h5py", "run.h5", "hdf5")]
)
def test_without_the_library_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, name: str, extra: str
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    (tmp_path / name).write_bytes(b"MATLAB")
    words = rf'{module} is not installed: pip install "crankpin\[{extra}\]"'
    with pytest.raises(ImportError, match=words):
        cp.Traces.load(tmp_path / name)
