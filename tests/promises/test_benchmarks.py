"""Does every chart command run, with all its methods, and write what it should?

Each runs at few settings, once; how long that takes is not looked at.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import all as charts
import numpy as np
import pytest

pytest.importorskip("matplotlib")

from typing import TYPE_CHECKING

import bearings
import gas_orders
import harmonics
import ledger
import mounts
import orders
import peaks
import tolerances
from rederivation import ijesc

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from types import ModuleType

    import methods

pytestmark = pytest.mark.slow

FOLDER = Path(charts.__file__).parent


def once(methods: Mapping[str, Callable[[], object]], *_: object, **__: object) -> dict[str, float]:
    """Run each method and invent its time."""
    for run in methods.values():
        run()
    return dict.fromkeys(methods, 1e-6)


def run(
    command: ModuleType, out: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> list[dict[str, str]]:
    """Run a command and read what it wrote."""
    monkeypatch.setattr(command, "interleaved", once)
    monkeypatch.setattr("sys.argv", [command.__name__, "--quick", "--out", str(out)])
    command.main()
    assert (out / f"{name}.png").stat().st_size > 10_000
    return read(out / f"{name}.csv")


def read(path: Path) -> list[dict[str, str]]:
    """Rows of a CSV that says first what ran it."""
    with path.open(newline="", encoding="utf-8") as file:
        assert file.readline().startswith("# ")
        return list(csv.DictReader(file))


def test_harmonics(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(harmonics, "QUICK", harmonics.Effort(settings=1))
    rows = run(harmonics, tmp_path, monkeypatch, "harmonics")
    assert tuple(rows[0]) == harmonics.HEADER
    for how_many, left_out in (("1000", {"series in λ, plain Python"}), ("1", set())):
        expected = {method.name for method in harmonics.METHODS} - left_out
        assert {row["method"] for row in rows if row["how_many"] == how_many} == expected
    for row in rows:
        error = float(row["worst_relative_error"])
        each = [float(row[f"error_{n}"]) for n in (2, 4, 6, 8)]
        if row["method"] == "crankpin":
            # at the coarsest tolerance
            assert max(each) == error <= 1e-3
            assert row["outcome"] == "ok"
        elif row["method"].startswith("FFT"):
            # eight samples hold no order 4
            assert math.isnan(error)
            assert row["outcome"] == "refuses"


# Worst error of orders 2, 4, 6, 8 at λ = 0.3 with the best setting, to a power of ten.
BEST = {
    # λ²ᵏ after twelve terms, times coefficients that grow
    "series in λ": 1e-12,
    "series in λ, plain Python": 1e-12,
    # rounding of the first orders, 64 times and 1 times, over a₈ = 1e-5
    "FFT of positions": 1e-9,
    "FFT of accelerations": 1e-12,
    # rounding over p⁻¹⁶
    "elliptic integrals, recurrence up": 1e-3,
    # rounding
    "recurrence down": 1e-14,
    "hyp2f1": 1e-14,
    "crankpin": 1e-15,
}


@pytest.mark.parametrize("method", harmonics.METHODS, ids=lambda method: method.name)
def test_every_setting_of_the_harmonics(method: methods.Method) -> None:
    region = "λ = 0.15 … 0.45"
    found = []
    for setting in method.knobs:
        relative, absolute = harmonics.errors(harmonics.Run(region, 1, method, setting))
        assert relative.shape == absolute.shape == (1, 4)
        found.append(float(relative.max()))
    assert np.nanmin(found) <= BEST[method.name]
    if method.name == "crankpin":
        asked = [1e-14 if rtol is None else rtol for rtol in method.knobs]
        # rounding of the powers
        assert all(error <= rtol + 1e-14 for error, rtol in zip(found, asked, strict=True))


def test_peaks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = peaks.Sweep("few", ijesc.FIRING_ORDERS[:2], (10.0, 60.0, 90.0, 180.0))
    monkeypatch.setattr(peaks, "COARSER", few)
    rows = run(peaks, tmp_path, monkeypatch, "peaks")
    assert tuple(rows[0]) == peaks.HEADER
    for sweep in ("few", peaks.ONE.name):
        found = {row["method"] for row in rows if row["sweep"] == sweep}
        assert found == {method.name for method in peaks.METHODS}
    for row in rows:
        error = float(row["worst_relative_error"])
        if row["method"] == "crankpin":
            # sums of twelve terms, a square root
            assert error < 1e-14
        elif "polished" not in row["method"]:
            # half a step from the peak: of degree four in the square, hence two in the length
            assert error <= (2 * math.pi / float(row["setting"])) ** 2 / 2 * 2


def test_the_reference_of_peaks_is_no_less_than_fine_samples() -> None:
    few = peaks.Sweep("few", ijesc.FIRING_ORDERS, (10.0, 60.0, 90.0, 120.0, 180.0))
    exact = [float(value) for value in peaks.exact(few)]
    fine = peaks.sampled(few, 20_000).ravel().tolist()
    for true, sample in zip(exact, fine, strict=True):
        # (2·π/20 000)² = 1e-7
        assert sample * (1 - 1e-14) <= true <= sample * (1 + 1e-7)


def test_orders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orders, "NAMES", {"single": "single", "v12-60": "V12"})
    monkeypatch.setattr(orders, "interleaved", once)
    monkeypatch.setattr("sys.argv", ["orders", "--quick", "--out", str(tmp_path)])
    orders.main()
    with (tmp_path / "orders.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {"kind", "engine", "rod_ratio", "rtol", "orders", "without_layout"} <= set(rows[0])
    timed = [row for row in rows if row["kind"] == "time"]
    # rounding of twelve forces of some 1e4 N
    assert all(float(row["error"]) <= float(row["bound"]) + 1e-10 for row in timed)


def test_bearings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = run(bearings, tmp_path, monkeypatch, "bearings")
    assert tuple(rows[0]) == bearings.HEADER
    assert {row["method"] for row in rows} == {"NumPy", "crankpin"}
    # rounding of some ten operations, of numbers of the size of the largest
    assert all(float(row["error"]) < 1e-14 for row in rows)


def test_mounts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mounts, "COUNTS", [1, 3, 10])
    rows = run(mounts, tmp_path, monkeypatch, "mounts")
    assert tuple(rows[0]) == mounts.HEADER
    for damping in ("hysteretic", "viscous"):
        found = {row["method"] for row in rows if row["damping"] == damping}
        assert found == {*mounts.methods(damping == "viscous")}
    # Roundings of some hundred operations, over what cancels beside a resonance.
    assert all(float(row["error"]) < 1e-10 for row in rows)


def test_gas_orders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gas_orders, "COUNTS", (90, 360))
    rows = run(gas_orders, tmp_path, monkeypatch, "gas_orders")
    assert tuple(rows[0]) == gas_orders.HEADER
    for cycle in gas_orders.CYCLES:
        found = {row["method"]: row for row in rows if row["cycle"] == cycle.name}
        methods = {*gas_orders.METHODS, *([gas_orders.ITSELF] if cycle.cycle else [])}
        assert set(found) == methods
        errors = {name: float(row["error"]) for name, row in found.items()}
        # The mean torque, of the size of the largest phasor, goes into all orders at one part in
        # the number of samples; the closed table is crankpin's too.
        assert errors["FFT, first sample once more"] > 1e-2
        # Cubics through points 2° apart; lines beside jumps.
        assert errors["crankpin"] < (1e-3 if "jumps" in cycle.name else 1e-5)
        # Quadrature between the jumps: roundings of some thousand terms.
        assert errors.get(gas_orders.ITSELF, 0.0) < 1e-14


def test_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    import search

    monkeypatch.setattr(search, "least", lambda run, **_: run() and 1e-6)
    search.tolerance(search.cases(search.ENGINES[:2]), tmp_path)
    rows = read(tmp_path / "search_tolerance.csv")
    assert tuple(rows[0]) == (
        *("engine", "method", "tolerance_of_squares", "pairs", "exact_pairs", "seconds"),
    )
    exact = {row["engine"]: row["pairs"] for row in rows if row["method"] == "exact"}
    # Ito and Hattori's arrangements
    assert exact["V-14 alternating"] == "12936"
    assert (tmp_path / "search_tolerance.png").exists()


def test_one_command_runs_them_all() -> None:
    drawing = {
        path.stem
        for path in FOLDER.glob("*.py")
        if '.png"' in path.read_text(encoding="utf-8") and not path.stem.startswith("_")
    }
    assert drawing == set(charts.present())
    for name in charts.present():
        text = (FOLDER / f"{name}.py").read_text(encoding="utf-8")
        assert all(f'"{option}"' in text for option in ("--out", *charts.COMMANDS[name]))


def test_tolerances(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(tolerances, "interleaved", once)
    monkeypatch.setattr("sys.argv", ["tolerances", "--quick", "--out", str(tmp_path)])
    tolerances.main()
    assert [row["engine"] for row in read(tmp_path / "tolerances.csv")] == [*tolerances.ENGINES]
    assert "NumPy / crankpin" in capsys.readouterr().out


def test_the_ledger_has_every_call_and_fails_where_one_grows() -> None:
    of, known = ledger.read()
    assert of.startswith("rustc ")
    assert list(known) == list(ledger.calls())
    assert not ledger.grown(known, known)
    first, *_, last = known
    faster = known | {first: known[first] // 2, last: round(1.02 * known[last])}
    assert not ledger.grown(faster, known)
    slower = known | {last: round(1.04 * known[last])}
    assert ledger.grown(slower, known) == [last]
    assert ledger.grown({"new": 1}, {"old": 1}) == ["new", "old"]
