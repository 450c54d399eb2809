"""Are units read and shown by exact factors, and is everything shown in those of the setting?"""

from __future__ import annotations

import asyncio
import re
import threading
from collections.abc import Generator, Iterator
from decimal import Decimal
from typing import Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin._support import units
from crankpin._support.frames import Framed
from crankpin._support.tables import Column, Table
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import pyplot as plt
from support import in_turn
from support.objects import OBJECTS
from support.shown_units import IMPERIAL, si_units

MEASURED = {
    "kg": ["kg", "g", "lb", "oz"],
    "m": ["m", "mm", "in", "ft", "cm"],
    "kg·m": ["g·mm", "oz·in", "kg·m", "lb·ft"],
    "kg·m²": ["g·mm²", "lb·in²", "kg·m²"],
    "N": ["N", "kN", "lbf", "kgf"],
    "N·m": ["N·m", "lbf·ft", "lbf·in", "kN·m"],
    "Pa": ["bar", "psi", "kPa"],
    "N/m": ["N/m", "N/mm", "lbf/in"],
}


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    mpl.use("agg")
    yield
    plt.close("all")
    cp.units()


@pytest.mark.parametrize(
    ("unit", "si"),
    [
        ("lb", "0.45359237"),  # exact: international yard and pound agreement, 1959
        ("oz", "0.028349523125"),
        ("in", "0.0254"),
        ("ft", "0.3048"),
        ("lbf", "4.4482216152605"),  # lb × 9.80665 m/s²
        ("oz·in", "0.000720077887375"),
        ("lbf·ft", "1.3558179483314004"),
        ("g·mm", "0.000001"),
        ("kN", "1000"),
    ],
)
def test_factors_are_exact(unit: str, si: str) -> None:
    assert units.exact(unit) == Decimal(si)
    assert units.exact("psi") == pytest.approx(Decimal("6894.757293168361"), abs=Decimal("1e-11"))


@given(
    st.sampled_from([(si, unit) for si, listed in MEASURED.items() for unit in listed]),
    st.floats(1e-12, 1e12),
)
def test_what_is_shown_reads_back(kinds: tuple[str, str], value: float) -> None:
    """To two roundings."""
    si, unit = kinds
    shown = units.convert(si, units.read(unit))
    assert shown.unit == unit
    factor = units.exact(unit)
    assert factor is not None
    back = float(Decimal(value * shown.factor) * factor)
    np.testing.assert_allclose(back, value, rtol=4.5e-16)
    table = Table("a table", (Column("x", (value, None, "text"), si),))
    there = table.to(unit)
    assert there.columns[0].unit == unit
    np.testing.assert_allclose(there.to(si)["x"].values[0], value, rtol=4.5e-16)
    assert there["x"].values[1:] == (None, "text")


@pytest.mark.parametrize(
    ("typed", "unit"),
    [
        ("g·mm", "g·mm"), ("gmm", "g·mm"), ("g*mm", "g·mm"), ("g-mm", "g·mm"), ("ozin", "oz·in"),
        ("oz in", "oz·in"), ("mgm", "mg·m"), ("gm", "g·m"), ("kgm", "kg·m"), ("OZ·IN", "oz·in"),
    ],
)  # fmt: skip
def test_unbalances_are_read_as_people_write_them(typed: str, unit: str) -> None:
    assert units.exact(typed, (1, 1, 0, 0)) == units.exact(unit)


@pytest.mark.parametrize(
    ("typed", "unit"),
    [("MM", "mm"), ("lbs", "lb"), ("gm", "g"), ('"', "in"), ("inches", "in"), ("Oz", "oz"),
     ("KG", "kg"), ("µm", "µm"), ("″", "in"), ("LBF", "lbf")],
)  # fmt: skip
def test_units_are_read_as_people_write_them(typed: str, unit: str) -> None:
    assert units.symbol(typed) == unit


@pytest.mark.parametrize("text", ["cubit", "g, cubit", "g, kg", "oz·cubit", 3, "s/"])
def test_units_that_are_none(text: object) -> None:
    with pytest.raises(cp.InputError, match="units"):
        cp.units(text)  # type: ignore[arg-type]


def test_a_kind_that_is_not_named_stays() -> None:
    setting = units.read("lb, in")
    assert units.convert("N", setting) == ("N", 1.0)
    assert units.convert("N·m", setting) == ("N·m", 1.0)
    assert units.convert("kg·m²", setting).unit == "lb·in²"
    assert units.convert("N·m", units.read("lbf")).unit == "lbf·ft"
    assert units.convert("N·m", units.read("lbf, mm")).unit == "lbf·ft"
    assert units.convert("N·m", units.read("lbf, lbf·in")).unit == "lbf·in"
    assert units.convert("m/s²", units.read("in")).unit == "in/s²"
    assert units.convert("Hz", units.read(IMPERIAL)) == ("Hz", 1.0)


def test_ranges_and_echoes_are_in_the_units_set() -> None:
    strokes = units.Text("strokes ", units.figure(0.0508, "m", 4, 0.0762))
    assert strokes == "strokes 0.0508 to 0.0762 m"
    assert units.shown(strokes, units.read("in")) == "strokes 2 to 3 in"
    inertia = units.Text(units.figure(1.0, "kg·m²", 4, 2.0), " at 3 to 4 °")
    assert units.shown(inertia, units.read("g, mm")) == "1000000000 to 2000000000 g·mm² at 3 to 4 °"
    cylinder = cp.Cylinder(0.0254 * 1.9375, 0.0254 * 7.4375, 0.5)
    longer = cylinder.replace(crank_radius=0.0508)
    engine = cp.Engine.inline([cylinder, longer], throws_deg=[0, 180], spacing=0.1)
    with cp.units("in, oz"):
        assert "stroke 3.875 to 4 in, rod 7.4375 in, reciprocating mass 17.637 oz" in repr(engine)
        spread = cp.tolerances(engine, 3000, reciprocating_mass=0.05 * 0.028349523125, samples=10)
        assert "standard deviations: reciprocating mass 0.05 oz" in repr(spread)


@pytest.mark.parametrize(
    ("setting", "unit", "joules"),
    [
        ("g, mm", "J", 1.0), ("N·m", "J", 1.0), ("kN", "kJ", 1e3), ("MN, mm", "MJ", 1e6),
        ("lbf", "ft·lbf", 1.3558179483314004), ("oz, in, lbf", "ft·lbf", 1.3558179483314004),
        ("lbf·in", "in·lbf", 0.1129848290276167), ("kgf", "kgf·m", 9.80665),
    ],
)  # fmt: skip
def test_energy_goes_with_torque(setting: str, unit: str, joules: float) -> None:
    shown = units.convert("J", units.read(setting))
    assert shown.unit == unit
    np.testing.assert_allclose(1.0 / shown.factor, joules, rtol=4e-16)
    single = cp.Engine.preset("single", cylinder=cp.Cylinder(0.04, 0.14, 0.4, bore=0.08))
    flywheel = cp.flywheel(
        single.replace(firing_order="1").with_cycle(cp.Cycle.example()), 3000, inertia=0.2
    )
    with cp.units(setting):
        (line,) = (each for each in flywheel.table.text().splitlines() if "energy" in each)
    assert re.search(rf"\b{unit}\b", line), line
    swing = units.Text("it swings by ", units.figure(120.0, "J", 2))
    assert units.shown(swing, units.read("lbf")) == "it swings by 88.5 ft·lbf"


def test_the_setting_ends_with_its_block_and_changes_no_result() -> None:
    balance = OBJECTS["Balance"]
    before, text = balance.force.peak.copy(), repr(balance)
    with cp.units("lbf"):
        assert repr(balance) != text
        with cp.units("kN"):
            assert "kN" in repr(balance)
        assert "lbf·ft" in repr(balance)
        np.testing.assert_array_equal(balance.force.peak, before)
    assert repr(balance) == text
    cp.units("lbf")
    assert "lbf" in repr(balance)


@in_turn("name", OBJECTS)
def test_no_text_has_other_units_than_those_set(name: str) -> None:
    if name == "Exercise":  # a sheet asks in units of its own, in which it checks answers
        return
    value = OBJECTS[name]
    with cp.units(IMPERIAL):
        texts = [repr(value)] if isinstance(value, (cp.Engine, cp.results.Explanation)) else []
        if isinstance(value, Framed):
            for key, frame in value.frames.items():
                texts += [frame.text(), frame.html(), value.to_csv(frame=key, units=IMPERIAL)]
    for text in texts:
        for line in re.sub("<[^>]*>", "|", text).splitlines():
            assert not si_units(line), line


def test_numbers_along_axes_are_those_of_the_unit() -> None:
    """A tick stands where its number, read in its unit, is."""
    balance = cp.Engine.preset("v8-crossplane").balance(6000)
    factors = {"": ("N·m", 1.0), "lbf": ("lbf·ft", 0.7375621492772654)}
    for setting, (unit, factor) in factors.items():
        with cp.units(setting):
            ax = balance.plot(quantity="moment")
            ax.figure.canvas.draw()
            assert ax.get_ylabel().endswith(f", {unit}")
            ticks = [(t.get_loc(), t.label1.get_text()) for t in ax.yaxis.get_major_ticks()]
            assert len([text for _, text in ticks if text]) > 2
            for place, text in ticks:
                number = float(text.replace("\N{NO-BREAK SPACE}", "").replace("−", "-"))
                assert number == pytest.approx(place * factor, rel=1e-9, abs=1e-9)


def test_texts_are_converted_with_their_digits() -> None:
    setting = units.read("oz, in, lbf")
    text = units.Text(
        "Sag ", units.Figure((1.27, -2.54, 0.5), "mm", ".4g", "({}, {}, {})"), " under ",
        units.figure(1.3558179, "N·m", 8), "; ", units.figure(8896.0, "N", 3), " along 45°, ",
        "3 m pitch, ", units.Figure((0.047, 0.015), "m", "+.3f", "{} ± {}"),
    )  # fmt: skip
    assert text == (
        "Sag (1.27, -2.54, 0.5) mm under 1.3558179 N·m; 8.9e+03 N along 45°, 3 m pitch, "
        "+0.047 ± +0.015 m"
    )
    assert units.shown(text, setting) == (
        "Sag (0.05, -0.1, 0.01969) in under 0.99999996 lbf·ft; 2000 lbf along 45°, 3 m pitch, "
        "+1.9 ± +0.6 in"
    )


# --- whose setting it is --------------------------------------------------------------------------


def lengths() -> str:
    return units.convert("m").unit


def test_a_setting_is_that_of_its_thread() -> None:
    seen = []
    begun, ended = threading.Event(), threading.Event()

    def other() -> None:
        seen.append(lengths())
        with cp.units("in"):
            begun.set()
            ended.wait(60)
            seen.append(lengths())
        seen.append(lengths())

    thread = threading.Thread(target=other)
    with cp.units("mm"):
        thread.start()
        begun.wait(60)
        assert lengths() == "mm"
    ended.set()
    thread.join()
    assert (seen, lengths()) == (["m", "in", "m"], "m")


def test_a_setting_is_that_of_its_task() -> None:
    async def task(unit: str, turns: int) -> list[str]:
        with cp.units(unit):
            seen = []
            for _ in range(turns):
                await asyncio.sleep(0)
                seen.append(lengths())
            return seen

    async def both() -> list[list[str]]:
        return [*await asyncio.gather(task("mm", 5), task("in", 3))]

    assert asyncio.run(both()) == [["mm"] * 5, ["in"] * 3]
    assert lengths() == "m"


def test_blocks_that_do_not_nest_end_alone() -> None:
    def shown() -> Generator[str, None, None]:
        with cp.units("in"):
            yield lengths()

    generator = shown()
    assert next(generator) == "in"
    with cp.units("mm"):
        generator.close()
        assert lengths() == "mm"
    assert lengths() == "m"


def test_settings_without_a_block_last_until_that_which_is_around_them_ends() -> None:
    with cp.units("mm"):
        cp.units("in")
        cp.units("ft")
        assert lengths() == "ft"
        with cp.units("cm"):
            assert lengths() == "cm"
            cp.units("in")
        assert lengths() == "ft"
    assert lengths() == "m"


@in_turn("seed", range(20))
def test_blocks_in_any_order_leave_no_setting(seed: int) -> None:
    """The innermost of those that go on is that which is shown."""
    chance = np.random.default_rng(seed)
    going_on: list[tuple[str, Any]] = []
    for _ in range(60):
        if going_on and chance.random() < 0.5:
            _, block = going_on.pop(int(chance.integers(len(going_on))))
            block.__exit__(None, None, None)
        else:
            unit = str(chance.choice(["mm", "in", "ft", "cm"]))
            block = cp.units(unit)
            block.__enter__()
            going_on.append((unit, block))
        assert lengths() == (going_on[-1][0] if going_on else "m")
    for _, block in going_on:
        block.__exit__(None, None, None)
    assert lengths() == "m"


def test_a_setting_takes_no_further_attributes() -> None:
    with cp.units("mm") as setting, pytest.raises(AttributeError):
        setting.other = 1  # type: ignore[attr-defined]


NAME = "Run 7: rod 0.145 m, at (0.1, 0.2) m, 3 to 4 N"


@pytest.mark.parametrize("setting", [IMPERIAL, "g, mm, kN, bar"])
def test_figures_of_a_name_stay(setting: str) -> None:
    """A name is shown as it was given, whatever units are shown; figures around it are not."""
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    engine = cp.Engine.preset("i4", cylinder=cylinder).replace(name=NAME)
    fired = engine.with_cycle(cp.Cycle.example())
    results: list[Any] = [
        engine.balance(3000), engine.firing(), cp.sweep(engine, rpm=[1000, 2000]),
        cp.rank({NAME: engine}, rpm=3000, by="total.moment.peak"), cp.bob_weight(engine),
        cp.counterweights(engine, planes=[0, 0.1]), cp.bearing_loads(fired, 3000),
        cp.flywheel(fired, 3000, inertia=0.2), fired.balance(3000).crank_torque, engine.explain(),
        cp.balance_shafts(engine, [2, -2]), cp.tolerances(engine, rpm=3000, z=1e-4, samples=20),
        cp.match_parts(engine, [0.5] * 4), cp.Cycle.example().replace(name=NAME),
        cp.compare(engine, engine, 3000), fired.waveform(3000),
    ]  # fmt: skip
    with cp.units(setting):
        for result in results:
            text = repr(result).replace("\N{NO-BREAK SPACE}", " ")
            assert NAME in text or "0.145" not in text, text
    assert sum(NAME in repr(each).replace("\N{NO-BREAK SPACE}", " ") for each in results) > 10
    assert engine.balance(3000).table.title.startswith(
        NAME.replace(" m", "\N{NO-BREAK SPACE}m")[:9]
    )
