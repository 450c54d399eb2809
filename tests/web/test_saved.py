"""Is what the workbench saves what it shows, and is nothing lost, in any order of clicks?"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from support.building import cells, choose, engine, faults, field, settle, take_file, type_in

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Download, Page
    from support.chromium import Open

pytestmark = pytest.mark.slow  # a browser

FITS = {"bob": "Bob weight", "counterweights": "Counterweights", "shafts": "Balance shafts"}
"""Panes that fit something, and their titles."""
FIT, OFF = "Fit it to the engine", "Take it off"


def show(page: Page, title: str) -> None:
    """Choose a pane and wait until it is computed."""
    page.get_by_role("tab", name=title, exact=True).click()
    done(page)


def done(page: Page) -> None:
    page.wait_for_function("() => !workbench.jobs.running && !workbench.jobs.waiting.length")
    settle(page)


def fit(page: Page, pane: str, button: str = FIT) -> None:
    show(page, FITS[pane])
    page.get_by_role("button", name=button).click()
    done(page)


def save(page: Page, folder: Path) -> cp.Engine | None:
    """Return the engine that the page saves; None if it saves nothing and says so."""
    downloads = list["Download"]()

    def keep(download: Download) -> None:
        downloads.append(download)

    page.on("download", keep)
    page.get_by_role("button", name="Save", exact=True).click()
    said = page.locator(".said").inner_text()
    if said:
        page.wait_for_timeout(100)
        assert not downloads
        assert said.startswith("Nothing is saved"), said
        assert len(said) > len("Nothing is saved, for what is typed is no engine that is shown. ")
        return None
    while not downloads:
        page.wait_for_timeout(10)
    page.remove_listener("download", keep)
    downloads[0].save_as(folder / "saved.toml")
    return cp.Engine.load(folder / "saved.toml")


def own_engine() -> cp.Engine:
    """Return an inline-3 with a weight on a crankpin, one on the shaft, and a balance shaft."""
    weights = [cp.Unbalance(0.002, 0.05, 10, pin=2), cp.Unbalance(0.001, 0.2, "360/7")]
    shaft = cp.Shaft(-1, [cp.Unbalance(0.0015, 0.1, 30)], 0.1, -0.05)
    return (
        cp.Engine.preset("i3")
        .replace(name="own")
        .with_counterweights(weights)
        .with_shafts([shaft])
        .with_loads(own_loads())
    )


def own_loads() -> list[cp.PeriodicLoad]:
    """Return a load of each kind: on a shaft of its own, that turns, and a table over speed."""
    return [
        cp.PeriodicLoad(
            "valve train", on="both", torque={0: -3, 1.5: 8 + 3j}, ratio="1/2", x=0.1, y=0.25,
            z=0.05, phase_deg="360/7",
        ),
        cp.PeriodicLoad(
            "propeller", on="shaft", force={0: 25, 2: -4.5j}, torque={3: 12 - 1e-7j}, turning=True,
            scaling="speed squared", rpm=2400, z=-0.1, direction_deg=30,
        ),
        cp.PeriodicLoad(
            "pump", on="block", force={0.5: [1, 2 + 1j], 4: [3, 1.5]}, rpm=[500, 8000], cylinder=2
        ),
    ]  # fmt: skip


def opened(open_workbench: Open, engine: cp.Engine | cp.Powertrain, folder: Path) -> Page:
    engine.save(folder / "own.toml")
    page = open_workbench()
    take_file(page, folder / "own.toml")
    return page


def test_fits_replace_their_own_kind_alone(open_workbench: Open, tmp_path: Path) -> None:
    own = own_engine()
    page = opened(open_workbench, own, tmp_path)
    fit(page, "shafts")
    fit(page, "counterweights")
    both = save(page, tmp_path)
    assert both is not None
    assert both.counterweights[:2] == own.counterweights
    assert len(both.counterweights) > 2
    assert (both.shafts[:1], len(both.shafts)) == (own.shafts, 2)
    fit(page, "shafts")  # once more: in place of the first
    assert save(page, tmp_path) == both
    fit(page, "bob")
    bob = save(page, tmp_path)
    assert bob is not None
    assert [each.pin for each in bob.counterweights[:3]] == [1, 2, 3]
    assert bob.shafts == both.shafts
    for pane in FITS:
        fit(page, pane, OFF)
    assert save(page, tmp_path) == own


def test_before_is_the_engine_without_the_fit(open_workbench: Open) -> None:
    page = open_workbench("#preset=single")
    show(page, "Balance shafts")
    before, after = cells(page, "force-before"), cells(page, "force-after")
    fit(page, "shafts")
    assert (cells(page, "force-before"), cells(page, "force-after")) == (before, after)
    assert after[0] < before[0]
    assert before[0] == pytest.approx(cp.Engine.preset("single").balance(rpm=3000)[1].force.peak)


def test_what_a_fit_was_computed_of_is_said(open_workbench: Open) -> None:
    page = open_workbench("#preset=single")
    fit(page, "shafts")
    assert page.get_by_text("The engine was changed since").count() == 0
    type_in(page, stroke="95 mm")
    done(page)
    assert page.get_by_text("The engine was changed since").is_visible()
    fit(page, "shafts")
    assert page.get_by_text("The engine was changed since").count() == 0


def test_own_weights_are_marked_and_stand_where_they_are(
    open_workbench: Open, tmp_path: Path
) -> None:
    own = own_engine()
    page = opened(open_workbench, own, tmp_path)
    show(page, "Counterweights")
    rows = page.locator(".counterweights .tabled").first.locator("tbody tr")
    origins = [row.locator("td").last.inner_text() for row in rows.all()]
    assert origins[:2] == ["the engine’s own"] * 2
    assert set(origins[2:]) == {"this fit"}
    # A crankpin that points along its bore at its top dead centre turns on by that angle.
    pin = float(own.pin_deg[1])
    assert cells(page, "angle")[:2] == pytest.approx([(pin + 10) % 360, 360 / 7])
    show(page, "Balance shafts")
    rows = page.locator(".shafts .tabled").first.locator("tbody tr")
    assert "the engine’s own" in rows.first.inner_text()
    assert "this fit" in rows.last.inner_text()


@pytest.mark.parametrize("text", ["", "x", "170 kg", "0 mm"])
def test_no_engine_is_no_file(open_workbench: Open, tmp_path: Path, text: str) -> None:
    page = open_workbench("#preset=i4")
    field(page, "rod_length").fill(text)  # and Save at once
    assert save(page, tmp_path) is None
    assert "Rod length" in page.locator(".said").inner_text()
    assert page.locator(".stage.stale, .results.stale").count() == 2
    type_in(page, rod_length="170")
    saved = save(page, tmp_path)
    assert saved is not None
    assert saved.cylinders[0].rod_length == 0.17
    assert page.locator(".stale").count() == 0


def test_an_engine_that_is_not_drawn_is_not_saved(open_workbench: Open, tmp_path: Path) -> None:
    page = open_workbench("#preset=i4")
    type_in(page, firing_order="", throws_deg=", ".join(["0"] * 65))
    assert save(page, tmp_path) is None
    assert "up to 64" in page.locator(".said").inner_text()


def test_loads_are_kept_through_fields_links_and_kinds(
    open_workbench: Open, tmp_path: Path
) -> None:
    own = own_engine()
    page = opened(open_workbench, own, tmp_path)
    assert engine(page).loads == own.loads
    link = page.evaluate("async () => { await workbench.writeAddress(); return location.hash; }")
    again = open_workbench(link)
    assert save(again, tmp_path) == own
    choose(page, kind="inline")
    type_in(page, throws_deg="0, 240, 120")
    assert faults(page) == []
    assert engine(page).loads == own.loads
    choose(page, kind="lists")
    saved = save(page, tmp_path)
    assert saved is not None
    assert saved.loads == own.loads
    assert_shown_is(page, saved)


def test_a_load_is_typed(open_workbench: Open, tmp_path: Path) -> None:
    page = open_workbench("#preset=i4")
    page.get_by_role("button", name="Add a periodic load").click()
    settle(page)
    type_in(
        page, **{"load-0-name": "fan", "load-0-force": "2: 8 N@90, 4: 1-2j", "load-0-z": "-100"}
    )
    type_in(page, **{"load-0-torque": ""})
    assert faults(page) == []
    saved = save(page, tmp_path)
    assert saved is not None
    fan = cp.PeriodicLoad("fan", on="shaft", force={2: 8j, 4: 1 - 2j}, z=-0.1)
    assert saved.loads == (fan,)
    assert saved == cp.Engine.preset("i4").with_loads([fan])
    assert_shown_is(page, saved)
    assert field(page, "preset").input_value() == ""
    type_in(page, **{"load-0-force": "2: fast"})
    assert len(faults(page)) == 1
    assert save(page, tmp_path) is None
    page.get_by_role("button", name="Remove this load").click()
    settle(page)
    assert engine(page) == cp.Engine.preset("i4")


def test_a_file_keeps_its_body_and_hardware(open_workbench: Open, tmp_path: Path) -> None:
    body = cp.RigidBody(mass=148, cg=(0.02, 0.07, 0.09), inertia=(8.1, 7.6, 4.9))
    places = {"right": (0.28, 0, -0.09), "left": (-0.28, 0, -0.09), "rear": (0, -0.12, 0.55)}
    mounts = [cp.Mount(name, at, stiffness=(2.2e5, 8e4, 9e4)) for name, at in places.items()]
    car = cp.Powertrain(own_engine(), body, mounts)
    page = opened(open_workbench, car, tmp_path)
    choose(page, gas="petrol 1")
    fit(page, "counterweights")
    assert save(page, tmp_path) is not None
    saved = cp.Powertrain.load(tmp_path / "saved.toml")
    assert (saved.body, saved.mounts) == (car.body, car.mounts)
    assert saved.engine is not None
    assert saved.engine.fired
    choose(page, kind="inline")
    type_in(page, throws_deg="0, 240, 120", firing_order="1-3-2")
    assert faults(page) == []
    saved = cp.Powertrain.load(tmp_path / "saved.toml") if save(page, tmp_path) else saved
    assert saved.mounts == car.mounts
    assert saved.engine is not None
    assert saved.engine.counterweights[:2] == own_engine().counterweights


# --- any order of clicks ------------------------------------------------------------------------

TYPED = {
    "stroke": ["86 mm", "90", "x", "3.5 in"],
    "reciprocating_mass": ["450 g", "0.5 kg", "", "0"],
    "rotating_mass": ["", "300 g", "-1"],
    "throws_deg": ["0", "0, 180", "0, 120, 240", "0, 90, 270, 180", "0,,", "a"],
    "spacing": ["100 mm", "90 mm, 110 mm", "100"],
    "bank_angle_deg": ["60", "90", "181"],
    "firing_order": ["", "1-2", "1-3-2", "1-3-4-2", "9"],
    "name": ["", "n", "<b>"],
    "z": ["0 mm", "0, 100, 250", "0, 100"],
}
LOADS = {
    "name": ["pump", "a: <b>", ""],
    "force": ["2: 10", "1: 8@30, 2.5: 1-2j", "x", "0: 5", "2: 1e3 N"],
    "torque": ["", "0: 4, 2: 1j", "3: 5 N·m"],
    "ratio": ["", "1/2", "-1", "x", "0.3"],
    "z": ["", "100", "-2.5 in"],
    "rpm": ["", "3000", "1000/2000"],
}
PRESETS = ["single", "i3", "i4", "v6-60", "boxer-4"]
KINDS = ["inline", "vee", "boxer", "lists"]


@dataclasses.dataclass
class Own:
    """What the reader's engine has besides its cylinders, and what was fitted to it by pane."""

    engine: cp.Engine
    fits: dict[str, cp.Engine | None] = dataclasses.field(default_factory=dict)
    loads: tuple[cp.PeriodicLoad, ...] | None = dataclasses.field(init=False)
    """Its periodic loads; None while what is typed of one is wrong."""

    def __post_init__(self) -> None:
        self.loads = self.engine.loads


def step(page: Page, own: Own, chance: np.random.Generator, files: list[Path]) -> Own:
    """Do something, and return what the engine has then."""
    kind = chance.choice(
        ["type", "type", "fit", "fit", "off", "open", "preset", "kind", "gas", "load", "load"]
    )
    if kind == "type":
        shown = [name for name in TYPED if field(page, name).count()]
        name = str(chance.choice(shown))
        type_in(page, **{name: str(chance.choice(TYPED[name]))})
    elif kind in ("fit", "off"):
        pane = str(chance.choice(list(FITS)))
        show(page, FITS[pane])
        button = page.get_by_role("button", name=FIT if kind == "fit" else OFF)
        if button.count() and button.is_enabled():
            button.click()
            done(page)
            own.fits[pane] = engine(page) if kind == "fit" else None
    elif kind == "load":
        own.loads = change_loads(page, chance)
    elif kind == "open":
        file = files[chance.integers(len(files))]
        take_file(page, file)
        return Own(cp.Engine.load(file))
    elif kind == "preset":
        name = str(chance.choice(PRESETS))
        choose(page, preset="i5")  # that a choice of the same one is a choice
        choose(page, preset=name)
        return Own(cp.Engine.preset(name))
    elif kind == "kind":
        choose(page, kind=str(chance.choice(KINDS)))
    else:
        choose(page, gas=str(chance.choice(["", "petrol 1"])))
    return own


def change_loads(page: Page, chance: np.random.Generator) -> tuple[cp.PeriodicLoad, ...] | None:
    """Add a load, remove one or type in one; return the loads that are typed, if they are some."""
    listed = page.locator("[data-field$=-force]").count()
    what = chance.choice(["add", "remove", "type", "type"]) if listed else "add"
    if what == "add" and listed < 4:
        page.get_by_role("button", name="Add a periodic load").click()
    elif what == "remove":
        page.get_by_role("button", name="Remove this load").first.click()
    else:
        name = str(chance.choice(["name", "force", "torque", "ratio", "z", "rpm"]))
        type_in(page, **{f"load-{chance.integers(listed)}-{name}": str(chance.choice(LOADS[name]))})
    settle(page)
    return None if faults(page) else engine(page).loads


def assert_nothing_is_lost(saved: cp.Engine, own: Own) -> None:
    if own.loads is not None:
        assert saved.loads == own.loads
    kept = [] if own.fits.get("bob") else list(own.engine.counterweights)
    assert list(saved.counterweights[: len(kept)]) == kept
    assert saved.shafts[: len(own.engine.shafts)] == own.engine.shafts
    extra = len(saved.shafts) - len(own.engine.shafts)
    assert extra == (1 if own.fits.get("shafts") else 0)
    has_weights = len(saved.counterweights) > len(kept)
    assert has_weights == bool(own.fits.get("bob") or own.fits.get("counterweights"))


def assert_shown_is(page: Page, saved: cp.Engine) -> None:
    """Compare the table of orders with the library's balance of the file."""
    show(page, "Orders")
    rpm = page.evaluate("workbench.slots[0].design.rpm")
    heads = page.locator("th[data-name=order]").all()
    orders = [float(head.get_attribute("data-value") or "nan") for head in heads]
    balance = saved.balance(rpm)
    size = max(float(balance.force.peak.max(initial=0.0)), 1e-6)
    lever = max(float(balance.moment.peak.max(initial=0.0)), 1e-6)
    for name, of, largest in (("force", balance.force, size), ("moment", balance.moment, lever)):
        *shown, total = cells(page, f"{name}-peak")
        expected = [float(of[order].peak) for order in orders]
        np.testing.assert_allclose(shown, expected, rtol=1e-12, atol=1e-11 * largest)
        whole = getattr(balance.total, name).peak
        np.testing.assert_allclose(total, whole, rtol=1e-9, atol=1e-9 * largest)
    assert page.locator("h1").inner_text() == (saved.name or page.locator("h1").inner_text())


@pytest.mark.parametrize("seed", range(3))
def test_any_order_of_clicks(open_workbench: Open, tmp_path: Path, seed: int) -> None:
    files = [tmp_path / "own.toml", tmp_path / "twin.json"]
    own_engine().save(files[0])
    twin = cp.Engine.preset("v-twin-90").with_counterweights([cp.Unbalance(0.02, 0, 180, pin=1)])
    twin.save(files[1])
    chance = np.random.default_rng(seed)
    page = open_workbench("#preset=i4")
    own = Own(cp.Engine.preset("i4"))
    count = 0
    for _ in range(30):
        own = step(page, own, chance, files)
        saved = save(page, tmp_path)
        if saved is not None:
            assert saved == engine(page)
            assert_nothing_is_lost(saved, own)
            assert_shown_is(page, saved)
            count += 1
    assert count > 5
