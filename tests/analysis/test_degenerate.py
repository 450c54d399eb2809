"""Do choices of engines and parts work where nothing, or next to nothing, shakes?"""

from __future__ import annotations

import inspect
import sys
import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from crankpin.results import OrderBalance, Quantity, Table
from fuzzing.calls import finite
from fuzzing.surface import plain_call
from matplotlib import pyplot as plt
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

I4 = cp.Engine.preset("i4")
PARTS = I4.cylinders[0]
MASSLESS = I4.replace(cylinder=PARTS.replace(reciprocating_mass=0.0), rotating_mass=0.0)
with warnings.catch_warnings():
    warnings.simplefilter("ignore", UserWarning)
    ENGINES = {
        "single": cp.Engine.preset("single"),
        "massless": MASSLESS,
        "rotating only": MASSLESS.replace(rotating_mass=0.5),
        "radial in one plane": cp.Engine.from_lists(
            PARTS, bank_deg=[90, 162, 234, 306, 18], pin_deg=[0] * 5, z=[0] * 5
        ),
        "far away": I4.replace(z=I4.z + 1e6),
        "tiny": cp.Engine.inline(cp.Cylinder(1e-6, 3e-6, 1e-12), throws_deg=[0, 180], spacing=1e-6),
        "huge": cp.Engine.inline(cp.Cylinder(1e3, 3e3, 1e9), throws_deg=[0, 180], spacing=1e4),
    }


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("engine", ENGINES.values(), ids=ENGINES)
def test_every_choice_is_made(engine: cp.Engine) -> None:
    parts = engine.cylinders[0]
    spread = 1e-3 * parts.reciprocating_mass
    masses = np.linspace(0.39, 0.41, 2 * len(engine))
    layout = {"layout": "vee", "bank_angle_deg": (30, 120), "cylinder": parts, "spacing": 0.1}
    results = [
        cp.rank(engine, rpm=3000, by="total.moment.peak, [1].moment.backward"),
        cp.design(4, **layout, rpm=3000, by="total.moment.peak, total.torque.peak"),  # type: ignore[arg-type]
        cp.tolerances(engine, rpm=3000, reciprocating_mass=spread, pin_deg=0.1, samples=20),
        cp.match_parts(engine, masses),
        cp.match_parts(engine, masses, np.full((len(masses), 2), 0.2), sets=1),
        cp.match_parts(engine, masses, by="spread"),
    ]
    for result in results:
        assert repr(result)
        assert result.table.to_csv()
        values = [each for column in result.table.columns for each in column.values]
        assert np.isfinite([each for each in values if isinstance(each, float)]).all()


@pytest.mark.filterwarnings("ignore::UserWarning")
@in_turn("name", cp.presets())
def test_what_cancels_in_every_order_cancels_at_every_crank_angle(name: str) -> None:
    engine = cp.Engine.preset(name)
    # Orders above 30 are below rounding: of λ = 0.3 they have 1e-18.
    balance = engine.balance(rpm=3000, orders=range(1, 31))
    exact = engine.waveform(rpm=3000)
    swept = cp.sweep(engine, rpm=[3000, 6000], orders=[1]).waveform(exact.theta_deg, exact=True)
    for quantity in ("force", "moment"):
        values = getattr(balance, quantity)
        # The v10-90 has some 1e-13 of order 20: less than the rounding of what cancels in order 1.
        remains = (np.array(values["all"].peak_xy) > values[1].zero_bound).tolist()
        assert exact.read(quantity).any(axis=0).tolist() == remains
        assert swept.read(quantity).any(axis=(0, 1)).tolist() == remains


@pytest.mark.parametrize("heavier", [1e-12, 1e-9])
def test_a_waveform_keeps_what_is_more_than_rounding(heavier: float) -> None:
    i6 = cp.Engine.preset("i6")
    assert not i6.waveform(rpm=3000).moment.any()
    first, *others = i6.cylinders
    larger = first.replace(reciprocating_mass=first.reciprocating_mass * (1 + heavier))
    moment = i6.replace(cylinder=[larger, *others]).waveform(rpm=3000).moment[:, 0]
    alone = cp.Engine.inline(first, throws_deg=[0], spacing=0.1).waveform(rpm=3000).force[:, 1]
    lever = i6.z[0] - i6.reference_z
    # The bound of what counts as zero: (6 + 24)ε times Σ(|z| + |z₀|), twelve times the lever.
    bound = 30 * 12 * 2.3e-16
    assert moment == pytest.approx(-lever * heavier * alone, abs=bound * abs(lever * alone).max())


def signs_of_zeros(values: np.ndarray) -> np.ndarray:
    """Signs of the parts that are zero."""
    parts = np.ascontiguousarray(values).view(np.float64)
    return np.asarray(np.signbit(parts[parts == 0.0]))


@pytest.mark.parametrize("name", ["i4", "v6-60", "single"])
@pytest.mark.parametrize("fired", [False, True])
def test_zeros_are_above_zero(name: str, fired: bool) -> None:
    engine = cp.Engine.preset(name)
    engine = engine.with_cycle(cp.Cycle.example()) if fired else engine
    zeros = list[np.ndarray]()
    for result in (engine.balance(0), engine.balance(1000), cp.sweep(engine, [0, 1000])):
        for quantity in ("force", "moment"):
            arrays = (result.read(quantity, what) for what in ("values", "forward", "backward"))
            zeros += map(signs_of_zeros, arrays)
        parts = ("torque", "crank_torque", "torque.inertia", "torque.gas")
        zeros += (signs_of_zeros(result.read(part, "values")) for part in parts)
    loads = cp.bearing_loads(engine, 0)
    for load in ("main", "crankpin", "wrist_pin", "side_thrust", "rod_force", "gas_force"):
        zeros.append(signs_of_zeros(loads.read(load)))
    zeros += (signs_of_zeros(loads.turned(load)) for load in ("main", "crankpin", "wrist_pin"))
    piston = engine.cylinders[0]
    zeros += (signs_of_zeros(of([0, 90, 180], 0)) for of in (piston.velocity, piston.acceleration))
    assert not np.concatenate(zeros).any()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_result_without_orders_is_a_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    generator = np.random.default_rng(47)
    for name in generator.permutation(list(cp.presets()))[:6]:
        preset = cp.Engine.preset(str(name)).with_cycle(None)
        preset = preset.with_link_rods([None] * len(preset))  # whose big ends have mass
        parts = [each.replace(reciprocating_mass=0.0) for each in preset.cylinders]
        parts = [each.replace(rod_inertia_excess=0.0) for each in parts]
        engine = preset.replace(cylinder=parts, rotating_mass=0.0, counterweights=(), shafts=())
        point = generator.uniform(-0.5, 0.5, 3)
        speeds = generator.uniform(500, 6000, 3)
        balance = engine.balance(rpm=speeds[0])
        sweeps = [cp.sweep(engine, rpm=speeds), cp.sweep([engine, engine], rpm=speeds)]
        for result in (balance, *sweeps):
            assert result.orders == ()
            moved: Any = result.about(point)
            shape = np.shape(result.total.torque.peak)
            assert np.array_equal(moved.total.torque.peak, np.zeros(shape))
            assert moved.torque.peak.shape[-1] == 0
            for made in (moved.table.to_csv, moved.table.text, moved.table.to_pandas):
                assert made() is not None
            assert moved.to_xarray() is not None
            moved.plot(quantity="torque")
        plt.close("all")
        file = tmp_path / "engine.toml"
        engine.save(file)
        for options in ([], ["--csv"]):
            assert main(["sweep", str(file), "--rpm", "1000:2000:500", *options]) == 0
            assert "1500" in capsys.readouterr().out


NOTHING: dict[str, Callable[[], Any]] = {
    "balance": lambda: MASSLESS.balance(1000),
    "waveform": lambda: MASSLESS.waveform(1000, [0.0, 1.0], orders="auto"),
    "waveform of no angles": lambda: I4.waveform(1000, []),
    "waveform of a sweep": lambda: cp.sweep(MASSLESS, rpm=[1e3, 2e3]).waveform([0.0, 1.0]),
    "bearing loads": lambda: cp.bearing_loads(MASSLESS, 1000, [0.0, 1.0]),
    "bearing loads of no angles": lambda: cp.bearing_loads(I4, 1000, []),
    "sweep": lambda: cp.sweep(MASSLESS, rpm=[1e3, 2e3]),
    "sweep of nothing": lambda: cp.sweep(MASSLESS, rpm=1e3),
    "sweep of engines": lambda: cp.sweep([MASSLESS, MASSLESS], rpm=[1e3, 2e3]),
    "counterweights": lambda: cp.counterweights(MASSLESS, planes="ends"),
    "balance shafts": lambda: cp.balance_shafts(MASSLESS, (-2, 2)),
    "balancer options": lambda: cp.balancer_options(MASSLESS, rpm=1000, most_shafts=1),
    "bob weight": lambda: cp.bob_weight(MASSLESS),
    "comparison": lambda: cp.compare(MASSLESS, MASSLESS, 1000),
    "ranking": lambda: cp.rank([MASSLESS, MASSLESS], rpm=1000, by="total.moment.peak"),
    "search": lambda: cp.search_arrangements(4).within(1, 2),
    "vanishing orders": MASSLESS.vanishing_orders,
    "explanation": lambda: MASSLESS.explain(1000),
}
"""Results without rows, or whose rows are all zero."""


def members(label: str, result: Any, depth: int = 0) -> Iterator[tuple[str, Callable[[], Any]]]:  # noqa: ANN401
    """Yield everything public of a result that can be read or called, and of its parts."""
    for name in dir(result):
        if name.startswith("_") and name not in ("__repr__", "_repr_html_", "__len__", "__hash__"):
            continue
        try:
            member = getattr(result, name)
        except cp.InputError:
            continue
        of_class = inspect.getattr_static(type(result), name, None)
        if isinstance(of_class, classmethod | staticmethod):
            continue
        if callable(of_class):
            yield f"{label}.{name}", plain_call(result, name).make
        elif depth < 2 and isinstance(member, Quantity | OrderBalance | Table):
            yield from members(f"{label}.{name}", member, depth + 1)


@pytest.mark.slow
@pytest.mark.parametrize("what", NOTHING)
def test_results_of_nothing_do_what_others_do(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    results = [NOTHING[what]()]
    if hasattr(results[0], "about"):
        results.append(results[0].about((0, 0.1, 0.2)))
    for result in results:
        for label, call in members(what, result):
            try:
                found = call()
            except (cp.InputError, ImportError):
                continue  # says why, or which package is not there
            assert finite(found), label
            repr(found)
            if "matplotlib.pyplot" in sys.modules:
                sys.modules["matplotlib.pyplot"].close("all")


@in_turn("seed", range(20))
def test_nothing_shakes_about_any_point_at_any_speed(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 9))
    engine = cp.Engine.from_lists(
        cp.Cylinder(0.05, rng.uniform(0.1, 0.3), 0.0, pin_offset=rng.uniform(0, 0.01)),
        bank_deg=rng.uniform(0, 360, count).round(3),
        pin_deg=rng.uniform(0, 360, count).round(3),
        z=np.sort(rng.uniform(0, 1, count)),
    )
    point = tuple(rng.uniform(-1, 1, 3))
    swept = cp.sweep(engine, rpm=rng.uniform(100, 9000, 4)).about(point)
    balance = engine.balance(3000).about(point)
    for result in (balance, swept):
        for name in ("force", "moment", "torque", "crank_torque"):
            total, peaks = getattr(result.total, name).peak, getattr(result, name).peak
            assert np.shape(total) == peaks.shape[:-1]
            assert peaks.shape[-1] == len(result.orders)
            assert not np.any(total)
