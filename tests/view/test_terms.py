"""Are the numbers that a page evaluates those of the library, at any setting?

A page has polynomials of the library's terms, cut at 1e-13 of their largest value, and orders down
to 1e-12 of a cylinder's largest. Sums of a few dozen such errors stay below 1e-10 of what the
cylinders make one by one.
"""

from __future__ import annotations

import itertools
import json
import math
from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from crankpin.model.presets import usual_speed
from crankpin.view.figures import Settings, figures
from numpy.polynomial import chebyshev
from support import in_turn
from support.several_cranks import fired_engine, random_engine, size
from support.view_engines import everything, radial

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from playwright.sync_api import Browser, Page

WITHIN = 1e-10
OF_HEIGHTS = 1e-9
"""Pistons' motions are cut at 1e-11 of the crank radius, in a few dozen sums."""
ANGLES = [0.0, 97.25, 181.5, 333.3333333]
NUMBERS = """([figures, settings, angles]) => {
    const { constructor: Numbers } = crankpin.numbers;
    return settings.map((each) => {
        const numbers = new Numbers(figures, each);
        return { orders: numbers.orders, at: angles.map((angle) => numbers.at(angle)) };
    });
}"""
"""What a page's one module of numbers gives of figures at settings."""


@pytest.fixture(scope="module")
def page(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Page:
    """Return a page, whose modules evaluate the figures of any engine."""
    file = tmp_path_factory.mktemp("pages") / "i4.html"
    cp.Engine.preset("i4").save_html(file)
    opened = browser.new_page()
    opened.goto(file.as_uri())
    return opened


def numbers(
    page: Page,
    engine: cp.Engine,
    rpm: float,
    settings: list[Settings],
    spectrum: dict[int, complex] | None = None,
) -> list[dict[str, Any]]:
    """Return what a page evaluates of an engine at settings."""
    known = json.loads(json.dumps(figures(engine, rpm, spectrum=spectrum)))
    listed = [vars(each) for each in settings]
    found: list[dict[str, Any]] = page.evaluate(NUMBERS, [known, listed, ANGLES])
    return found


def all_settings(engine: cp.Engine, rpm: float) -> list[Settings]:
    """Return the engine's own settings and others: both ends of the rod ratios, banks turned."""
    own, (reached, _) = Settings.of(engine, rpm), _core.rod_ratios(engine._core)
    rods = [] if reached is None else [reached[0], 0.237, reached[1]]
    bank = own.bank_angle_deg
    settings = [own, *(Settings(0.3 * rpm, bank, rod) for rod in rods)]
    if bank is not None:
        holds: list[Literal["pins", "firing"]] = ["pins", "firing"]
        banks = itertools.product([0.0, 33.3, 180.0], holds)
        turned = zip(banks, itertools.cycle([own.rod_ratio, *rods]))
        settings += (Settings(rpm, bank, rod, hold) for (bank, hold), rod in turned)
    return settings


def assert_agree(page: Page, engine: cp.Engine, rpm: float = 3000.0) -> None:
    settings = all_settings(engine, rpm)
    for each, found in zip(settings, numbers(page, engine, rpm, settings), strict=True):
        changed = each.applied(engine)
        whole = size(engine, each.rpm)
        wave = changed.waveform(each.rpm, theta_deg=ANGLES)
        for k, at in enumerate(found["at"]):
            shown = [*at["force"], *at["moment"], at["inertia"]]
            torque = wave.read("torque.inertia")[k]
            expected = [*wave.force[k], *wave.moment[k], torque]
            np.testing.assert_allclose(shown, expected, rtol=0, atol=WITHIN * whole)
        balance = changed.balance(
            each.rpm, orders=[order["order"] for order in found["orders"]], torque=False
        )
        for k, order in enumerate(found["orders"]):
            for name, part in itertools.product(("force", "moment"), ("forward", "backward")):
                expected_part = getattr(getattr(balance, name), part)[k]
                assert abs(complex(*order[name][part]) - expected_part) <= WITHIN * whole


@pytest.mark.slow  # a browser
@in_turn("name", cp.presets())
def test_presets(page: Page, name: str) -> None:
    assert_agree(page, cp.Engine.preset(name), usual_speed(name, 3000.0))


@pytest.mark.slow  # a browser
@in_turn("seed", range(12))
def test_random_engines_with_several_cranks(page: Page, seed: int) -> None:
    """With dead cylinders, offsets, rods, counterweights, shafts aside and unequal rod ratios."""
    assert_agree(page, random_engine(seed))


def vee(seed: int) -> cp.Engine:
    """Return a random vee: unequal cylinders, one of them dead, weights on pins, shafts aside."""
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 4))

    def cylinder(mass: float) -> cp.Cylinder:
        offset, inertia = random.uniform(-0.006, 0.006), random.uniform(-1e-3, 1e-3)
        return cp.Cylinder(0.043, 0.145, mass, offset, rod_inertia_excess=inertia * bool(mass))

    engine = cp.Engine.vee(
        cylinder(0.5),
        bank_angle_deg=float(random.uniform(10, 170)),
        throws_deg=random.uniform(0, 360, count).tolist(),
        spacing=0.1,
        pin_split_deg=float(random.uniform(-30, 30)),
        rotating_mass=0.3,
    )
    masses = [0.0, *random.uniform(0.2, 0.8, 2 * count - 1).tolist()]
    weights = [
        cp.Unbalance(0.01, 0.05, float(random.uniform(0, 360)), pin=pin)
        for pin in (None, int(random.integers(1, 2 * count + 1)))
    ]
    shafts = [cp.Shaft(ratio, [cp.Unbalance(0.004, 0.1, 40)], x=0.1, y=-0.2) for ratio in (-1, 2)]
    return (
        engine.replace(cylinder=[cylinder(mass) for mass in masses], reference_z=0.07)
        .with_counterweights(weights)
        .with_shafts(shafts)
    )


@pytest.mark.slow  # a browser
@in_turn("seed", range(8))
def test_random_vees(page: Page, seed: int) -> None:
    assert_agree(page, vee(seed))


def loads(seed: int, cylinders: int) -> list[cp.PeriodicLoad]:
    """Return random periodic loads, of few values, so that they coincide."""
    random = np.random.default_rng(seed)

    def pick(*values: Any) -> Any:  # noqa: ANN401 - one of them
        return values[random.integers(len(values))]

    def one() -> cp.PeriodicLoad:
        speeds: Any = pick(None, 2400.0, [600.0, 1500.0, 4000.0])
        rows = isinstance(speeds, list)

        def amplitude() -> Any:  # noqa: ANN401 - one, or one for each speed
            values = [1e3 * pick(1.0, -2j, 0.0, 3 + 1j) for _ in (speeds if rows else [0])]
            return values if rows else values[0]

        turning = pick(True, False)
        orders = [pick(0.5, 1, 2), pick(1.5, 3, 4)]
        mean = {0: [500.0] * 3 if rows else 500.0}
        return cp.PeriodicLoad(
            pick("pump", "fan"),
            on=pick("shaft", "block", "both"),
            force={n: amplitude() for n in orders} | (mean if turning else {}),
            torque={n: amplitude() for n in orders} | mean,
            scaling="speed squared" if isinstance(speeds, float) else "independent",
            rpm=speeds,
            turning=turning,
            ratio=pick(1, "1/2", -1, 2),
            phase_deg=pick(0, 30, 400),
            direction_deg=pick(0, 90, 33.3),
            z=pick(0.0, 0.1, -0.2),
            x=pick(0.0, 0.1),
            cylinder=pick(None, cylinders),
        )

    return [one() for _ in range(int(random.integers(1, 5)))]


@pytest.mark.slow  # a browser
@in_turn("seed", range(12))
def test_random_loads(page: Page, seed: int) -> None:
    """At other speeds, bank angles and rod ratios, with gas pressure and without."""
    engine = [vee, random_engine, fired_engine][seed % 3](seed)
    engine = engine.with_loads(loads(seed, len(engine)))
    assert_agree(page, engine)
    settings = all_settings(engine, 3000.0)
    for each, found in zip(settings, numbers(page, engine, 3000.0, settings), strict=True):
        changed = each.applied(engine)
        wave = changed.waveform(each.rpm, theta_deg=ANGLES)
        largest = 1e3 + abs(changed.waveform(each.rpm).torque).max()
        shown = [at["torque"] for at in found["at"]]
        np.testing.assert_allclose(shown, wave.torque, rtol=0, atol=1e-9 * largest)


@pytest.mark.slow  # a browser
def test_engines_that_show_everything(page: Page) -> None:
    for engine in (everything(), radial(), everything().replace(reference_z=-0.3)):
        assert_agree(page, engine)


@pytest.mark.slow  # a browser
def test_rods_that_are_barely_long_enough(page: Page) -> None:
    """An engine's own rod ratio is reached, though it be beyond those of other pages."""
    for ratio, offset in ((0.95, 0.0), (0.96, -1e-3), (0.02, 1e-3)):
        cylinder = cp.Cylinder(0.045, 0.045 / ratio, 0.5, offset)
        assert_agree(page, cp.Engine.inline(cylinder, throws_deg=[0, 200], spacing=0.1))


@pytest.mark.slow  # a browser
@pytest.mark.parametrize("seed", [3, 8, 24])
def test_fired_engines(page: Page, seed: int) -> None:
    """Gas beside inertia, and the moment of inertia of what moves, which flywheels share."""
    engine = fired_engine(seed)
    assert_agree(page, engine)
    settings = all_settings(engine, 3000.0)
    for each, found in zip(settings, numbers(page, engine, 3000.0, settings), strict=True):
        wheel = cp.flywheel(each.applied(engine), rpm=each.rpm, inertia=50.0)
        for angle in (0.0, 181.5):  # of which the wheel has samples
            (k,) = np.flatnonzero(abs(wheel.theta_deg - angle) < 1e-9)
            shown = found["at"][ANGLES.index(angle)]["moving"]
            assert shown == pytest.approx(wheel.moving_inertia[k], rel=1e-10)


def measured(engine: cp.Engine, step: float) -> cp.Engine:
    """Return a fired engine with a table, of angles that are no whole degrees, in all cylinders."""
    theta = np.linspace(0.0, 180.0 * engine.strokes, round(180.0 * engine.strokes / step) + 1)
    pressure = cp.Cycle.example(strokes=engine.strokes).pressure_at(theta)
    return engine.with_cycle(cp.Cycle(theta, pressure, strokes=engine.strokes))


@pytest.mark.slow  # a browser
@in_turn("seed", range(40))
def test_torque_of_random_fired_engines(page: Page, seed: int) -> None:
    """At any angle, and at those of a cycle's points, where pressure bends."""
    engine = fired_engine(seed)
    if seed % 3 == 2:
        engine = measured(engine, 0.5 + seed / 16)
    chance = np.random.default_rng(seed)
    angles = [0.0, 75.0, 333.0, *chance.uniform(-720.0, 720.0, 60), *range(0, 720, 37)]
    known = json.loads(json.dumps(figures(engine, 3000.0, spectrum=None)))
    own = vars(Settings.of(engine, 3000.0))
    (found,) = page.evaluate(NUMBERS, [known, [own], angles])
    wave, whole = engine.waveform(3000.0, theta_deg=angles), engine.waveform(3000.0)
    for name, quantity in (("torque", "torque"), ("gas", "torque.gas")):
        largest = abs(whole.read(quantity)).max()
        shown = [at[name] for at in found["at"]]
        np.testing.assert_allclose(shown, wave.read(quantity), rtol=0, atol=1e-9 * largest)


@pytest.mark.slow  # a browser
def test_spectra(page: Page) -> None:
    spectrum = {1: 0.067, 2: 0.02 + 0.001j, 30: 0.004j}
    for engine in (cp.Engine.preset("v6-60"), random_engine(26), vee(1)):
        settings = all_settings(engine, 3000.0)
        known = numbers(page, engine, 3000.0, settings, spectrum=spectrum)
        for each, found in zip(settings, known, strict=True):
            orders = [order["order"] for order in found["orders"]]
            request: dict[str, Any] = {"orders": orders, "spectrum": spectrum, "torque": False}
            wave = each.applied(engine).waveform(each.rpm, theta_deg=ANGLES, **request)
            for k, at in enumerate(found["at"]):
                assert at["torque"] is None
                shown, expected = [*at["force"], *at["moment"]], [*wave.force[k], *wave.moment[k]]
                atol = WITHIN * size(engine, each.rpm)
                np.testing.assert_allclose(shown, expected, rtol=0, atol=atol)


def pressure_of(cycle: dict[str, Any], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return pressure at crank angles, of the polynomials that a page has of a cycle."""
    edges = np.array(cycle["edges_deg"])
    at = edges[0] + (theta - edges[0]) % (edges[-1] - edges[0])
    panels = np.searchsorted(edges, at, side="right") - 1
    places = (2.0 * at - edges[panels] - edges[panels + 1]) / np.diff(edges)[panels]
    values = [
        chebyshev.chebval(place, cycle["coefficients"][panel] or [0.0])
        for place, panel in zip(places, panels, strict=True)
    ]
    return np.array(values)


@in_turn("engine", [*map(fired_engine, range(40)), *cp.presets().values()])
def test_an_engine_is_drawn_from_its_own_places(engine: cp.Engine) -> None:
    drawn = figures(engine, 60.0, spectrum=None)
    cylinders = drawn["cylinders"]
    for name in ("tdc_deg", "bank_deg", "z"):
        assert [each[name] for each in cylinders] == getattr(engine, name).tolist()
    for name in ("crank_radius", "pin_offset"):
        assert [each[name] for each in cylinders] == [getattr(c, name) for c in engine.cylinders]
    banks = [tuple(c["number"] for c in cylinders if c["bank"] == k) for k in range(len(cylinders))]
    assert [numbers for numbers in banks if numbers] == list(engine.banks.values())
    for each, part in zip(cylinders, engine.cylinders, strict=True):
        assert each["yoke"] or each["rod_length"] == part.rod_length
    unbalances = [(each.amount, each.z, each.pin) for each in engine.counterweights]
    assert unbalances == [
        (each["amount"], each["z"], None if each["pin"] is None else each["pin"] + 1)
        for each in drawn["counterweights"]
    ]
    assert [(s.ratio, s.x, s.y, len(s.unbalances)) for s in engine.shafts] == [
        (s["ratio"], s["x"], s["y"], len(s["unbalances"])) for s in drawn["shafts"]
    ]
    if engine.firing_order:
        angles = zip(drawn["firing_deg"], engine.firing().angles_deg, engine.cylinders, strict=True)
        assert all(one is None if part.dummy else one == other for one, other, part in angles)
    timing = cp.ValveTiming() if engine.strokes == 4 else cp.PortTiming()
    assert drawn["exhaust_opens_deg"] == timing.exhaust_opens_deg
    if engine.cycles is None:
        return
    crankcase, cycles = drawn["gas"]["crankcase"], drawn["gas"]["cycles"]
    assert crankcase == engine.crankcase
    theta = np.linspace(0.0, 180.0 * engine.strokes, 1777)[:-1]
    starts = engine.firing_deg
    for k, (each, cycle) in enumerate(zip(cylinders, engine.cycles, strict=True)):
        assert (each["cycle"] is None) == (cycle is None) == ("roll" not in each)
        if cycle is not None:
            assert each["pressure_deg"] == starts[k]
            shown, expected = pressure_of(cycles[each["cycle"]], theta), cycle.pressure_at(theta)
            np.testing.assert_allclose(shown, expected, rtol=0, atol=1e-12 * expected.max())
            # Those that move in different ways have different motions.
            first = next(c for c in cylinders if c["motion"] == each["motion"])
            one, other = engine.cylinders[k], engine.cylinders[first["number"] - 1]
            swept = ("crank_radius", "rod_length", "pin_offset")
            assert all(getattr(one, name) == getattr(other, name) for name in swept)
            volume = math.pi * (one.bore or 0.0) ** 2 / 4.0 * one.crank_radius
            assert each["swept"] == pytest.approx(volume, rel=1e-15)


def row_sums(
    rows: list[Any], drawn: dict[str, Any], ratio: float | None
) -> dict[float, NDArray[np.complex128]]:
    """Return what a page sums of rows of one group, by order."""
    sums = dict[float, Any]()
    for order, power, polynomial, [(_, *values)], *own in rows:
        if ratio is None:
            (factor,) = own
        else:
            least, most, turning = drawn["rod_ratios"]
            low, high, q = np.tan(0.5 * np.arcsin(np.array([least, most, ratio]) / turning))
            x = (2.0 * q - low - high) / (high - low)
            factor = q**power * chebyshev.chebval(x, polynomial or [0.0])
        sums[order] = sums.get(order, 0.0) + factor * np.array(values, float).view(complex)
    return sums


@in_turn("engine", [*map(random_engine, range(20)), everything(), radial(), *map(vee, range(4))])
def test_pistons_stand_where_the_library_has_them(engine: cp.Engine) -> None:
    """At any rod ratio; highest and lowest where it has them."""
    drawn = figures(engine, 60.0, spectrum=None)
    own = drawn["rod_ratio"]
    least, most, _ = drawn["rod_ratios"]
    past = np.linspace(0.0, 360.0, 61)
    for ratio in {own, least, 0.237, most, 0.5 * (least + most)}:
        of = Settings(60.0, None, ratio).applied(engine).cylinders
        for each, part in zip(drawn["cylinders"], of, strict=True):
            motion, r = drawn["motions"][each["motion"]], part.crank_radius
            # An infinite rod is drawn as a bar.
            bar = each["rod_length"] if np.isinf(part.rod_length) else 0.0
            rod = bar or part.rod_length
            height = sum(
                (values[0] * np.exp(1j * np.radians(order * past))).real
                for order, values in row_sums(motion["height"], drawn, ratio).items()
            )
            expected = part.position(past) + bar
            np.testing.assert_allclose(rod + r * height, expected, rtol=OF_HEIGHTS)
            turning = row_sums(motion["turning"], drawn, ratio)
            angles, ends = (turning[place].view(float) for place in (0, 1))
            for angle, end, sign in zip(angles, ends, (1, -1), strict=True):
                there = float(part.position(angle)) + bar
                assert rod + r * end == pytest.approx(there, rel=OF_HEIGHTS)
                beside = part.position(np.array([angle - 0.1, angle + 0.1])) + bar
                assert (sign * beside < sign * there).all()


def test_pages_have_no_mass_to_compute_with() -> None:
    """But that of the block, which is the page's own; forces and torques come as numbers."""
    known = figures(fired_engine(3), 3000.0, spectrum=None)
    text = json.dumps(
        {key: known[key] for key in known if key not in ("block", "sentences", "loads")}
    )
    assert [word for word in ("mass", "inertia", "excess", "bore") if word in text] == []


def test_rod_ratios_that_a_page_does_not_reach_are_rejected() -> None:
    engine = cp.Engine.preset("i4")
    with pytest.raises(cp.InputError, match=r"^rod_ratio = 0\.8: a page reaches 0\.05 to 0\.7$"):
        Settings(3000.0, None, 0.8).check(engine)
