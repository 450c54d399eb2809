"""Are the page's numbers the library's?

The page evaluates polynomials of what the core computes, cut at 1e-13 of their largest value, and
sums orders down to 1e-12 of the largest. A tolerance of 1e-9 of what the cylinders make one by
one is far above that, and far below a digit that is shown.
"""

from __future__ import annotations

import itertools
import math
from functools import partial
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from support.chromium import Open, values
from support.several_cranks import fired_engine, random_engine
from support.view_engines import everything, opposed_pistons, radial

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Page

pytestmark = pytest.mark.slow  # a browser

ENGINES = {
    **{
        name: cp.Engine.preset(name)
        for name in (
            "single", "i4", "i5", "v6-60", "v6-90-odd-fire", "vr6", "v8-crossplane", "boxer-6",
            "w12", "v14-9.13", "v16-45", "i4-ebook", "radial-9-link-rods", "v12-60-link-rods",
        )
    },
    "everything": everything(),
    "radial": radial(),
    "opposed pistons": opposed_pistons(),
    "unlike opposed pistons": opposed_pistons(0.06),
    "at halves of crank speed": cp.Engine.preset("i4").with_shafts(
        [
            cp.Shaft("1/2", [cp.Unbalance(0.02, 0.1, 30)], x=0.1, y=0.2),
            cp.Shaft("-3/2", [cp.Unbalance(0.004, 0.3, 70)], x=-0.1),
        ]
    ),
    "cranks of many speeds": random_engine(26),
    "cranks of both senses": random_engine(24, ratios=(1, -1)),
}  # fmt: skip
ANGLES = [0.0, 90.0, 97.25, -1234.5, 33.3333333, 1e6 + 0.125]
WITHIN = 1e-9


def moved(
    engine: cp.Engine, bank_angle: float | None, hold: str, rod_ratio: float | None
) -> cp.Engine:
    """Return what the page shows, by the library."""
    if bank_angle is not None:
        engine = engine.with_bank_angle(bank_angle, hold=hold)  # type: ignore[arg-type]
    if rod_ratio is not None:
        engine = engine.replace(
            cylinder=[c.replace(rod_length=c.crank_radius / rod_ratio) for c in engine.cylinders]
        )
    return engine


def sizes(engine: cp.Engine, rpm: float) -> dict[str, float]:
    """Return what all cylinders make one by one: N, N·m."""
    square = (rpm * np.pi / 30) ** 2
    masses = np.array([c.reciprocating_mass for c in engine.cylinders]) + engine.rotating_mass
    radii = np.array([c.crank_radius for c in engine.cylinders])
    x, y, ratio = on_cranks(engine).T
    force = float((masses * radii * ratio**2).sum()) * square
    return {
        "force": force,
        "moment": force * max(np.ptp(engine.z), 0.1),
        "torque": force * float((radii + np.hypot(x, y)).max()),
    }


def on_cranks(engine: cp.Engine) -> np.ndarray:
    """Return axis and speed ratio of each cylinder's crank: (n_cylinders, 3)."""
    cranks, crank_of = engine._core.cranks
    return np.array([cranks[k] for k in crank_of])


def assert_agree(page: Page, engine: cp.Engine, rpm: float, angle: float) -> None:
    found = values(page, "[data-name]:not([data-name=tick])")
    assert found["crank-angle"] == angle
    wave = engine.waveform(rpm, theta_deg=[angle])
    scale = sizes(engine, rpm)
    for quantity in ("force", "moment"):
        expected = np.asarray(getattr(wave, quantity))[0]
        shown = [found[f"{quantity}-x"], found[f"{quantity}-y"]]
        np.testing.assert_allclose(shown, expected, rtol=0, atol=WITHIN * scale[quantity])
    np.testing.assert_allclose(
        found["torque"], np.asarray(wave.torque)[0], rtol=0, atol=WITHIN * scale["torque"]
    )
    heights = [
        float(cylinder.position(abs(ratio) * (angle % 360 - tdc)))
        for cylinder, tdc, (_, _, ratio) in zip(
            engine.cylinders, engine.tdc_deg, on_cranks(engine), strict=True
        )
    ]
    if any(engine.link_rods):
        pistons = np.array(engine._core.rod_ends(angle))[:, 1]
        heights = (pistons * np.exp(-1j * np.radians(engine.bank_deg))).real.tolist()
    shown = [found[f"piston-{number}"] for number in range(1, len(engine) + 1)]
    np.testing.assert_allclose(shown, heights, rtol=WITHIN)


@pytest.mark.parametrize("name", ENGINES)
def test_any_angle(open_engine: Open, name: str) -> None:
    engine = ENGINES[name]
    rpm = 10.0 if "ebook" in name else 3000.0
    page = open_engine(engine, rpm=rpm)
    field = page.get_by_label("crank angle")
    for angle in ANGLES:
        field.fill(f"{angle}")
        assert_agree(page, engine, rpm, angle)


def test_yokes_and_dummy_pistons_turn(open_engine: Open) -> None:
    """An infinite rod is the bar of a Scotch yoke; a dummy piston has no strokes."""
    yoke = cp.Cylinder(0.045, math.inf, 0.5)
    rod = cp.Cylinder(0.045, 0.15, 0.4, dummy=True)
    engine = cp.Engine.vee(
        [rod, yoke], bank_angle_deg=90, throws_deg=[0], spacing=0.1, firing_order="2"
    )
    page = open_engine(engine, rpm=3000)
    failed = list[str]()
    page.on("pageerror", lambda error: failed.append(str(error)))
    wave = engine.waveform(3000, theta_deg=ANGLES)
    size = sizes(engine, 3000)["force"]
    for k, angle in enumerate(ANGLES):
        page.evaluate("angle => crankpin.set({ angle_deg: angle })", angle)
        found = values(page, "[data-name]:not([data-name=tick])")
        shown = [found["force-x"], found["force-y"]]
        np.testing.assert_allclose(shown, wave.force[k], rtol=0, atol=WITHIN * size)
        heights = [
            float(c.position(angle % 360 - t))
            for c, t in zip(engine.cylinders, engine.tdc_deg, strict=True)
        ]
        heights[1] += 4.0 * 0.045  # the bar of the yoke, four crank radii
        np.testing.assert_allclose([found["piston-1"], found["piston-2"]], heights, rtol=WITHIN)
    assert page.locator("[data-name=firing-order]").text_content() == "2"
    assert failed == []


def test_pistons_of_one_chamber_fire_once(open_engine: Open) -> None:
    page = open_engine(opposed_pistons())
    assert page.locator("[data-name=firing-order]").text_content() == "1-3-2"
    assert page.locator("[data-name=firing-intervals]").text_content() == "(every 120°)"
    assert page.evaluate("crankpin.sound.banks().map(({ angles }) => angles.length)") == [3, 0]
    assert page.locator("[data-name=rod-ratio]").count() == 1
    # Other rods would move where the chambers of unlike pistons are smallest.
    assert open_engine(opposed_pistons(0.06)).locator("[data-name=rod-ratio]").count() == 0


@pytest.mark.parametrize("name", ["v6-60", "vr6", "v8-crossplane", "boxer-6", "everything"])
def test_any_setting(open_engine: Open, name: str) -> None:
    engine = ENGINES[name]
    page = open_engine(engine)
    page.get_by_label("crank angle").fill("97.25")
    settings = itertools.product([0.0, 33.3, 180.0], ["pins", "firing"], [0.2, 0.45])
    for (bank_angle, hold, ratio), rpm in zip(settings, itertools.cycle([777.7, 6000.0])):
        for field, value in [("bank-angle", bank_angle), ("rod-ratio", ratio), ("rpm", rpm)]:
            page.locator(f"[data-name={field}]").fill(f"{value}")
        page.get_by_label("held as the bank angle changes").select_option(hold)
        assert_agree(page, moved(engine, bank_angle, hold, ratio), rpm, 97.25)


@pytest.mark.parametrize(
    ("name", "ratio"),
    [*(("i4", ratio) for ratio in (0.05, 0.31, 0.55, 0.7)), ("opposed pistons", 0.45)],
)
def test_any_rod_ratio(open_engine: Open, name: str, ratio: float) -> None:
    engine = ENGINES[name]
    page = open_engine(engine)
    page.locator("[data-name=rod-ratio]").fill(f"{ratio}")
    page.get_by_label("crank angle").fill("181.5")
    assert_agree(page, moved(engine, None, "pins", ratio), 3000.0, 181.5)


def assert_orders_agree(
    orders: list[dict[str, Any]], engine: cp.Engine, rpm: float, **asked: object
) -> None:
    numbers = [each["order"] for each in orders]
    assert numbers == sorted(numbers)
    balance = engine.balance(rpm, orders=numbers, torque=False, **asked)  # type: ignore[arg-type]
    scale = sizes(engine, rpm)
    for k, each in enumerate(orders):
        for quantity, part in itertools.product(["force", "moment"], ["forward", "backward"]):
            shown = complex(*each[quantity][part])
            expected = getattr(getattr(balance, quantity), part)[k]
            assert abs(shown - expected) <= WITHIN * scale[quantity]


@pytest.mark.parametrize("name", ENGINES)
def test_phasors(open_engine: Open, name: str) -> None:
    engine = ENGINES[name]
    page = open_engine(engine, rpm=1000.0 if "ebook" not in name else 10.0)
    rpm = values(page)["rpm"]
    assert_orders_agree(page.evaluate("crankpin.orders"), engine, rpm)
    # What is written of them.
    found = values(page)
    for each in page.evaluate("crankpin.shown"):
        for quantity, part in itertools.product(["force", "moment"], ["forward", "backward"]):
            written = found[f"{quantity}-{part}-{each['order']}"]
            assert written == pytest.approx(abs(complex(*each[quantity][part])), rel=1e-14)


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.7])
@pytest.mark.parametrize("offset", [0.0, 1e-9, 0.0004, -0.0004])
def test_phasors_of_any_proportions(open_engine: Open, ratio: float, offset: float) -> None:
    cylinder = cp.Cylinder(0.045, 0.158, 0.5, pin_offset=offset)
    engine = cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.1)
    page = open_engine(engine)
    page.evaluate("ratio => crankpin.set({ rod_ratio: ratio })", ratio)
    shown = [complex(*each["force"]["forward"]) for each in page.evaluate("crankpin.orders")]
    changed = moved(engine, None, "pins", ratio).balance(3000.0, orders=range(1, 25), torque=False)
    # Relative to each order, however small: polynomials are cut at 1e-13 of their largest value.
    np.testing.assert_allclose(shown, changed.force.forward, rtol=1e-10, atol=1e-300)


@pytest.mark.parametrize("name", ["i4", "v6-60", "v8-crossplane", "w12", "everything"])
def test_longest_vectors_are_those_of_the_turn(open_engine: Open, name: str) -> None:
    engine = ENGINES[name]
    found = values(open_engine(engine))
    total = engine.balance(3000.0).total
    for quantity in ("force", "moment", "torque"):
        # Followed by parabolas to their tops: beyond the digits shown.
        expected = getattr(total, quantity).peak
        assert found[f"{quantity}-longest"] == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_spectrum_is_summed_by_orders(open_engine: Open) -> None:
    engine, spectrum = (
        ENGINES["v6-60"].replace(reference_z=0.05),
        {1: 0.067, 2: 0.02 + 0.001j, 3: 0.004j},
    )
    asked = {"spectrum": spectrum}
    page = open_engine(engine, save=asked)
    page.get_by_label("crank angle").fill("97.25")
    wave = engine.waveform(3000.0, theta_deg=[97.25], orders=[1, 2, 3], torque=False, **asked)  # type: ignore[arg-type]
    found = values(page)
    for quantity in ("force", "moment"):
        shown = [found[f"{quantity}-x"], found[f"{quantity}-y"]]
        expected = np.asarray(getattr(wave, quantity))[0]
        np.testing.assert_allclose(
            shown, expected, rtol=0, atol=1e-9 * sizes(engine, 3000)["force"]
        )
    assert "torque" not in found
    torque = page.locator("output[data-name=torque]")
    assert torque.text_content() == "not determined by a spectrum"
    assert_orders_agree(page.evaluate("crankpin.orders"), engine, 3000.0, **asked)


def test_digits_shown_are_the_value_s(open_engine: Open) -> None:
    page = open_engine(ENGINES["v8-crossplane"])
    page.get_by_label("crank angle").fill("40")
    units = {"N": 1.0, "kN": 1e3, "mN": 1e-3, "N·m": 1.0, "kN·m": 1e3, "mm": 1e-3}
    names = ["force-x", "force-y", "moment-x", "moment-y", "torque", "piston-1", "piston-8"]
    for name in names:
        element = page.locator(f"[data-name={name}]")
        number, unit = (element.text_content() or "").split()
        value = float(element.get_attribute("data-value") or "nan")
        decimals = len(number.partition(".")[2])
        shown = float(number.replace("−", "-")) * units[unit]
        assert shown == pytest.approx(value, abs=0.5000001 * 10.0**-decimals * units[unit])


def fired() -> cp.Engine:
    """A cross-plane V8 on petrol, its third cylinder without a load and its fourth a diesel."""
    v8 = cp.Engine.preset("v8-crossplane")
    cycles: list[cp.Cycle | None] = [cp.Cycle.example()] * len(v8)
    cycles[2:4] = [None, cp.Cycle.example("diesel")]
    return v8.replace(cylinder=[c.replace(bore=0.09) for c in v8.cylinders]).with_cycle(cycles)


def assert_gas_agrees(page: Page, engine: cp.Engine, angle: float) -> None:
    assert engine.cycles is not None
    found = page.evaluate("({...crankpin.last, force: null, moment: null})")
    wave = engine.waveform(3000, theta_deg=[angle])
    largest = abs(engine.waveform(3000).read("torque.gas")).max()
    for part in ("gas", "inertia"):
        expected = wave.read(f"torque.{part}")[0]
        assert found[part] == pytest.approx(expected, abs=WITHIN * largest), part
    assert found["torque"] == found["gas"] + found["inertia"]
    of_faces = [*zip(engine.cycles, engine.firing_deg, strict=True)]
    if engine.crank_ends is not None:  # without pin offset lowest half a turn later
        above = np.array([one.side_rods for one in engine.cylinders])
        begins = engine.tdc_deg + np.where(above, 0.0, 180.0)  # of two-strokes
        of_faces += zip(engine.crank_ends, begins, strict=True)
    for (cycle, fires), shown in zip(of_faces, found["pressures"], strict=True):
        if cycle is None:
            assert shown is None
        else:
            pressure, peak = cycle.pressure_at(angle - fires), cycle.pressure.max()
            assert shown == pytest.approx(float(pressure), abs=WITHIN * peak)


def two_stroke() -> cp.Engine:
    """Return a motored two-stroke triple with offset pins, whose rods swing."""
    rod = cp.Rod(mass=0.4, inertia=0.002, length=0.12, to_crankpin=0.04)
    cylinder = cp.Cylinder.from_rod(
        rod, crank_radius=0.032, piston_mass=0.25, pin_offset=0.002, bore=0.07
    )
    engine = cp.Engine.inline(cylinder, throws_deg=[0, 120, 240], spacing=0.09, strokes=2)
    cycle = cp.Cycle.motored(cylinder, compression_ratio=8, strokes=2)
    return engine.replace(firing_order=[1, 3, 2]).with_cycle(cycle)


def double_acting() -> cp.Engine:
    """Return a compressor that acts at both ends, one of them unloaded."""
    cylinder = cp.Cylinder(0.05, 0.16, 3.0, bore=0.12)
    engine = cp.Engine.inline(cylinder, throws_deg=[0, 90], spacing=0.2, strokes=2)
    ends = [
        cp.Cycle.compressor(cylinder, discharge=pressure, end="crank") for pressure in (4e5, None)
    ]
    return engine.with_cycle(
        cp.Cycle.compressor(cylinder, discharge=4e5), crank_end=ends, rod_diameter=0.04
    )


def pumping() -> cp.Engine:
    """Return opposed pistons on one crankshaft, the crankcase and the upper head ends pumps."""
    lower, upper = cp.Cylinder(0.05, 0.16, 2.0, bore=0.1), cp.Cylinder(0.04, 0.3, 2.5, bore=0.1)
    bare = cp.Engine.opposed_pistons(
        lower, upper=upper, throws_deg=[0], spacing=0.1, lead_deg=8, one_crankshaft=True
    )
    pumps = [
        cp.Cycle.compressor(lower, discharge=1.4e5, clearance=0.4, end="crank"),
        cp.Cycle.compressor(upper, discharge=1.4e5, clearance=0.4),
    ]
    return bare.with_cycle(
        cp.Cycle.example("diesel", strokes=2), crank_end=pumps, rod_diameter=[0, 0.04]
    )


@pytest.mark.parametrize(
    "of", [fired, two_stroke, partial(fired_engine, 24), double_acting, pumping]
)
def test_gas_at_any_angle(open_engine: Open, of: Callable[[], cp.Engine]) -> None:
    engine = of()
    page = open_engine(engine)
    for angle in (0.0, 12.25, 333.3, 541.0, -77.7):
        page.get_by_label("crank angle").fill(f"{angle}")
        assert_gas_agrees(page, engine, angle)


def test_gas_at_any_bank_angle(open_engine: Open) -> None:
    engine = fired()
    page = open_engine(engine)
    page.get_by_label("crank angle").fill("-77.7")
    for hold in ("pins", "firing"):
        page.get_by_label("held as the bank angle changes").select_option(hold)
        page.locator("[data-name=bank-angle]").fill("75")
        # The same cylinders fire in the same turns, though the order may not be one of even names.
        wave = engine.with_bank_angle(75, hold=hold).waveform(3000, theta_deg=[-77.7])
        torque = float(wave.read("torque.gas")[0])
        largest = abs(engine.waveform(3000).read("torque.gas")).max()
        assert page.evaluate("crankpin.last.gas") == pytest.approx(torque, abs=WITHIN * largest)
    assert page.get_by_text("Pressure in the cylinders").count() == 1
    curves = page.locator(".timeline .curve")
    assert curves.locator("xpath=self::*[contains(@class, 'pressure')]").count() == 7


# Torque every two degrees, cubics between, what bends there apart: measured 3e-5 of the
# fluctuation, for burning cycles, whose pressure is rounded and linear between half degrees.
OF_FLUCTUATION = 5e-5


def assert_speed_agrees(page: Page, engine: cp.Engine, rpm: float, inertia: float) -> None:
    wheel = cp.flywheel(engine, rpm=rpm, inertia=inertia)
    found = values(page, ".detail [data-name]")
    assert found["inertia"] == pytest.approx(inertia, rel=1e-15)
    assert found["irregularity"] == pytest.approx(wheel.irregularity, rel=OF_FLUCTUATION)
    span = np.ptp(wheel.speed_rpm)
    for angle in (0.0, 12.25, 133.3, 541.0, -77.7):
        page.get_by_label("crank angle").fill(f"{angle}")
        period = wheel.theta_deg[-1]
        expected = np.interp(angle % period, wheel.theta_deg, wheel.speed_rpm)
        shown = values(page, ".detail [data-name]")["crank-speed"]
        assert shown == pytest.approx(expected, abs=OF_FLUCTUATION * span)


@pytest.mark.parametrize("of", [fired, two_stroke, partial(fired_engine, 24), double_acting])
def test_speed_of_the_crank(open_engine: Open, of: Callable[[], cp.Engine]) -> None:
    engine = of()
    given = cp.flywheel(engine, rpm=3000, irregularity=0.01).inertia
    page = open_engine(engine)
    assert_speed_agrees(page, engine, 3000, given)  # the default, which is stated
    page.locator("[data-name=rpm]").fill("900")
    assert_speed_agrees(page, engine, 900, given)
    page.locator("[data-name=rod-ratio]").fill("0.35")
    assert_speed_agrees(page, moved(engine, None, "pins", 0.35), 900, given)
    # What pistons take from the crank is more than a light one has.
    light = open_engine(engine, rpm=6000, save={"inertia": 0.02})
    assert_speed_agrees(light, engine, 6000, 0.02)


def test_a_crank_that_would_stop(open_engine: Open) -> None:
    page = open_engine(fired(), save={"inertia": 0.1})
    assert page.locator(".detail").is_visible()
    page.locator("[data-name=rpm]").fill("200")
    with pytest.raises(cp.InputError, match="stop"):
        cp.flywheel(fired(), rpm=200, inertia=0.1)
    assert page.get_by_text("the crank would stop").count() == 1
    assert not page.locator(".detail").is_visible()
    page.locator("[data-name=rpm]").fill("0")
    assert page.get_by_text("the crank would stop").count() == 1
    page.locator("[data-name=rpm]").fill("3000")
    assert_speed_agrees(page, fired(), 3000, 0.1)


@pytest.mark.parametrize("name", ["i4", "v8-crossplane", "everything", "cranks of many speeds"])
def test_a_compact_page_has_the_same_numbers(open_engine: Open, name: str) -> None:
    engine = ENGINES[name]
    page = open_engine(engine, save={"compact": True})
    page.evaluate("crankpin.set({ angle_deg: 97.25 })")
    wave, scale = engine.waveform(3000, theta_deg=[97.25]), sizes(engine, 3000)
    for quantity in ("force", "moment", "torque"):
        page.get_by_label("vector shown").select_option(quantity)
        found = values(page)
        names = [quantity] if quantity == "torque" else [f"{quantity}-x", f"{quantity}-y"]
        expected = np.atleast_1d(np.asarray(wave.read(quantity))[0])
        shown = [found[each] for each in names]
        np.testing.assert_allclose(shown, expected, rtol=0, atol=WITHIN * scale[quantity])
        assert {each for each in found if "longest" in each} == {f"{quantity}-longest"}
