"""Can mounts be dragged in the page, and does everything follow?"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.view import mounted
from crankpin.view.page import as_json
from support.chromium import Open, values
from support.view_engines import everything

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from playwright.sync_api import Locator, Page

pytestmark = pytest.mark.slow  # a browser

BODY = cp.RigidBody(148.0, (0.02, 0.07, 0.09), (8.1, 7.6, 4.9))
MOUNTS = [
    cp.Mount("right", (0.28, 0, -0.09), (22e4, 8e4, 8e4), tilt_deg=45, loss_factor=0.1),
    cp.Mount("left", (-0.28, 0, -0.09), (22e4, 8e4, 8e4), tilt_deg=135, loss_factor=0.1),
    cp.Mount("rear", (0, -0.12, 0.55), (10e4, 18e4, 10e4), loss_factor=0.1),
]
FIRED = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.45, bore=0.086)).with_cycle(
    cp.Cycle.example()
)
CAR = cp.Powertrain(FIRED, BODY, MOUNTS)

SHOWN = """() => {
    const all = (selector, name) => [...document.querySelectorAll(selector)]
        .map(each => each.getAttribute(name)).join();
    return {
        modes: all(".modes [data-name]", "data-value"),
        values: all(".values [data-name]", "data-value"),
        curves: all(".run-up .curve", "d"),
        springs: all(".spring", "d"),
    };
}"""
"""What follows the mounts."""


def mount(page: Page, scene: str, name: str) -> Locator:
    return page.locator(f".scene.{scene} .mount[aria-label='mount {name}']")


def places(page: Page) -> list[list[float]]:
    found: list[list[float]] = page.evaluate("crankpin.state.mounts.map(({ at }) => at)")
    return found


def assert_follows(page: Page, before: dict[str, str]) -> None:
    """Everything shown has changed, and is the library's of the mounts as they stand."""
    after = page.evaluate(SHOWN)
    assert [name for name in before if before[name] == after[name]] == []
    now = mounted.changed(CAR, page.evaluate("crankpin.state.mounts"))
    shown = values(page)
    expected = now.modes().frequency
    found = [shown[f"mode-{k}-frequency"] for k in range(1, 7)]
    np.testing.assert_allclose(found, expected, rtol=1e-10)
    force = now.response(shown["rpm"], orders=[2])[2].body_force.rms_xyz
    found = [shown[f"force-{axis}"] for axis in "xyz"]
    within = 1e-10 * float(np.linalg.norm(force))
    np.testing.assert_allclose(found, force, rtol=0, atol=within)


@pytest.mark.parametrize(
    ("scene", "axes", "signs"),
    [("cross", (0, 1), (1, -1)), ("left", (2, 1), (1, -1)), ("above", (2, 0), (1, -1))],
)
def test_a_mount_is_dragged_in_the_plane_of_each_picture(
    open_engine: Open, scene: str, axes: tuple[int, int], signs: tuple[int, int]
) -> None:
    page = open_engine(CAR, rpm=800)
    before, own = page.evaluate(SHOWN), places(page)
    box = mount(page, scene, "rear").locator(".knob").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 10, y + 5)
    page.mouse.move(x - 30, y + 20)
    page.mouse.up()
    scale = page.evaluate(
        """name => { const { element, projection } = crankpin.scenes.find(
            ({ projection }) => projection.name === name);
            return element.getScreenCTM().a * projection.scale; }""",
        scene,
    )
    moved = np.subtract(places(page), own)
    assert not moved[:2].any()
    by = {axes[0]: -30 * signs[0] / scale, axes[1]: 20 * signs[1] / scale}
    for axis in range(3):
        # Whole millimetres; the picture is fitted anew after a drag, by some percent.
        assert moved[2, axis] == pytest.approx(by.get(axis, 0.0), rel=0.2, abs=0.0011)
    assert_follows(page, before)
    page.get_by_role("button", name="as given").click()
    assert places(page) == own
    assert page.evaluate(SHOWN) == before


def test_arrow_keys_move_a_mount_and_leave_the_crank(open_engine: Open) -> None:
    page = open_engine(CAR, rpm=800)
    for scene, key, expected in [
        ("cross", "ArrowRight", (0.281, 0, -0.09)),
        ("cross", "Shift+ArrowUp", (0.281, 0.01, -0.09)),
        ("left", "ArrowRight", (0.281, 0.01, -0.089)),
        ("left", "ArrowDown", (0.281, 0.009, -0.089)),
        ("above", "Shift+ArrowUp", (0.291, 0.009, -0.089)),
        ("above", "Shift+ArrowLeft", (0.291, 0.009, -0.099)),
    ]:
        before = page.evaluate(SHOWN)
        target = mount(page, scene, "right")
        target.focus()
        page.keyboard.press(key)
        assert tuple(places(page)[0]) == expected
        assert page.evaluate("crankpin.state.angle_deg") == 0
        assert_follows(page, before)
        text = " ".join(
            f"{axis} {1000 * value:.0f} mm," for axis, value in zip("xyz", expected, strict=True)
        )
        assert target.get_attribute("aria-valuetext") == text.rstrip(",").replace("-", "−")
    # Others than arrows are the page's.
    page.keyboard.press("Home")
    page.keyboard.press("Space")
    assert page.evaluate("crankpin.state.playing")


def test_fields_and_sliders_change_the_mount_that_is_chosen(open_engine: Open) -> None:
    page = open_engine(CAR, rpm=800)
    page.get_by_role("button", name="rear").click()
    for label, value, expected in [
        ("rear: x, mm", "-35.5", ("at", 0, -0.0355)),
        ("rear: z, mm", "600", ("at", 2, 0.6)),
        ("rear: second axis, N/mm", "250", ("stiffness", 1, 250e3)),
    ]:
        before = page.evaluate(SHOWN)
        page.get_by_label(label, exact=True).fill(value)
        key, axis, number = expected
        assert page.evaluate("crankpin.state.mounts[2]")[key][axis] == number
        assert_follows(page, before)
    before = page.evaluate(SHOWN)
    page.get_by_label("first axis", exact=True).fill("300")
    assert page.evaluate("crankpin.state.mounts[2].stiffness") == [300e3, 250e3, 100e3]
    assert_follows(page, before)
    for wrong in ("-1", "a", "1e9"):
        page.get_by_label("rear: first axis, N/mm", exact=True).fill(wrong)
        assert page.evaluate("crankpin.state.mounts[2].stiffness[0]") == 300e3
    # What stands there is what Python makes of the mounts.
    code = str(page.locator("[data-name=python]").text_content())
    now = mounted.changed(CAR, page.evaluate("crankpin.state.mounts"))
    assert eval(code, {"powertrain": CAR}) == now  # noqa: S307 - of this page


def test_a_mode_swings_and_the_engine_s_order_returns(open_engine: Open) -> None:
    page = open_engine(CAR, rpm=800)
    said = page.locator(".drawn")
    factor = values(page)["drawn-factor"]
    assert said.text_content() == f"Order 2 at 800 rpm: the block's motion is drawn × {factor:g}"
    moving = "document.querySelector('.scene.cross .box:not(.still)').getAttribute('d')"
    shapes = CAR.modes().shapes
    for k in (0, 5):
        page.get_by_role("button", name=f"mode {k + 1}").click()
        assert str(said.text_content()).startswith(f"Mode {k + 1}, ")
        drawn = np.array(page.evaluate("crankpin.shape"))
        assert np.abs(drawn / np.linalg.norm(drawn)) == pytest.approx(
            np.abs(shapes[:, k] / np.linalg.norm(shapes[:, k])), abs=1e-10
        )
        seen = set()
        for angle in (0, 60, 180):
            page.evaluate("angle_deg => crankpin.set({ angle_deg })", angle)
            seen.add(page.evaluate(moving))
        assert len(seen) == 3
    page.get_by_role("button", name="mode 6").click()
    assert str(said.text_content()).startswith("Order 2 at 800 rpm")
    page.get_by_label("order of the engine that moves the block").select_option("all")
    assert str(said.text_content()).startswith("All orders at 800 rpm")


def test_the_block_moves_as_the_library_says(open_engine: Open) -> None:
    """A corner of the box, magnified, at some crank angles."""
    page = open_engine(CAR, rpm=800)
    factor = 100.0
    page.evaluate("exaggeration => crankpin.set({ exaggeration, order: 'all' })", factor)
    r = CAR.response(800.0)
    box = np.array(page.evaluate("crankpin.figures.mounted.box"))
    point = r.at(box[0]).displacement.xyz
    for angle in (0.0, 77.0, 400.0):
        turned = np.exp(1j * np.radians(angle) * np.array(r.orders, float))
        expected = factor * (point * turned[:, None]).real.sum(axis=0)
        found = page.evaluate(
            "([angle, at]) => crankpin.motionAt(angle).at(at)", [angle, box[0].tolist()]
        )
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


def test_box_has_the_body_s_mass_and_inertia() -> None:
    root = np.array([[8.1, 0.3, -0.4], [0.3, 7.6, 0.5], [-0.4, 0.5, 4.9]])
    body = cp.RigidBody(148.0, BODY.cg, root, products="tensor")
    corners = np.array(mounted.figures(CAR.replace(body=body), 800)["mounted"]["box"])
    np.testing.assert_allclose(corners.mean(axis=0), body.cg, atol=1e-15)
    # Of an even box the second moments are a third of those of masses at its corners.
    arms = corners - body.cg
    second = 148.0 * (arms.T @ arms) / 8.0 / 3.0
    np.testing.assert_allclose(np.trace(second) * np.eye(3) - second, root, rtol=1e-12, atol=1e-12)


def test_run_up_marks_the_modes_that_an_order_crosses(open_engine: Open) -> None:
    page = open_engine(CAR, rpm=800)
    shown, frequency = values(page), CAR.modes().frequency
    for k in range(6):
        assert shown[f"crossing-{k + 1}"] == pytest.approx(60 * frequency[k] / 2, rel=1e-10)
    page.get_by_label("quantity over engine speed").select_option("displacement")
    curves = page.evaluate("crankpin.curves")
    expected = CAR.response(curves["speeds"], orders=[2])[2].at(BODY.cg).displacement.rms_xyz
    np.testing.assert_allclose(curves["values"], expected, rtol=1e-8, atol=1e-14)
    box = page.locator(".run-up").bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert values(page)["rpm"] != 800
    page.get_by_label("order of the engine that moves the block").select_option("all")
    assert page.locator(".resonance").count() == 0


def test_run_up_has_curves_beside_resonances_without_damping(open_engine: Open) -> None:
    """Where an order meets a mode exactly, rounding alone bounds the answer: it sets no scale."""
    free = [mount.replace(loss_factor=0.0) for mount in MOUNTS]
    page = open_engine(CAR.replace(mounts=free), rpm=800)
    curves = page.locator(".run-up .curve").all()
    assert [bool(curve.get_attribute("d")) for curve in curves] == [True] * 4
    ticks = [
        float(tick.get_attribute("data-value") or 0) for tick in page.locator(".run-up .tick").all()
    ]
    values = np.array([value for value in page.evaluate("crankpin.curves.values") if value])
    assert max(ticks) < 1e6 * np.median(np.linalg.norm(values, axis=1))


LABELS = {
    "crank_angle": "turn the crank",
    "rpm": "engine speed",
    "order": "order of the engine that moves the block",
    "mode": "mode 1",
    "rocking": "exaggeration of the rocking",
    "mounts": "right: x, mm",
    "view": "quantity over engine speed",
}
"""Label of a control by its name; the first of several."""


@pytest.mark.parametrize(
    ("controls", "shown"),
    [
        (None, list(mounted.CONTROLS)),
        ("none", []),
        (["order", "rpm", "order"], ["order", "rpm"]),
        (["crank_angle", "mode"], ["crank_angle", "mode"]),
        (("mounts", "view", "rocking"), ["mounts", "view", "rocking"]),
    ],
)
def test_a_page_has_the_controls_named(
    open_engine: Open, controls: str | Sequence[str] | None, shown: list[str]
) -> None:
    page = open_engine(CAR, rpm=800, save={"controls": controls})
    found = []
    for name, label in LABELS.items():
        each = page.get_by_label(label, exact=True)
        if each.count() and each.is_visible() and each.is_enabled():
            found.append(name)
    assert found == [name for name in mounted.CONTROLS if name in shown]
    dragged = page.locator(".scene .mount[tabindex]").count()
    assert dragged == (9 if "mounts" in shown else 0)
    own = page.evaluate(SHOWN)
    for locator in (page.locator(".scene.cross .knob").last, page.locator(".run-up")):
        box = locator.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        page.mouse.down()
        page.mouse.move(box["x"] + box["width"] / 2 + 30, box["y"])
        page.mouse.up()
    moved = page.evaluate(SHOWN)
    assert (moved["modes"] != own["modes"]) == ("mounts" in shown)
    assert (values(page).get("rpm", 800.0) != 800.0) == ("rpm" in shown)
    assert (page.evaluate("crankpin.state.rpm") != 800.0) == ("rpm" in shown)


def test_controls_stand_in_the_order_of_their_names(open_engine: Open) -> None:
    page = open_engine(CAR, rpm=800, save={"controls": ["rocking", "rpm"]})
    sliders = page.locator(".settings input[type=range]").all()
    labels = [each.get_attribute("aria-label") for each in sliders]
    assert labels == ["exaggeration of the rocking", "engine speed"]


def test_numbers_are_shown_and_typed_in_the_units_that_are_set(open_engine: Open) -> None:
    every = "[data-name]:not([data-name=bound])"  # bounds of fields are round in their unit
    own = values(open_engine(CAR, rpm=800), every)
    with cp.units("lb, in, lbf"):
        page = open_engine(CAR, rpm=800)
    assert values(page, every) == own  # of SI
    pound, inch = 0.45359237 * 9.80665, 0.0254
    shown = {"force-length": ("lbf", pound), "displacement-x": ("in", inch)}
    for name, (unit, factor) in shown.items():
        number, _, written = str(page.locator(f"[data-name={name}]").text_content()).partition(" ")
        assert written == unit
        assert float(number) * factor == pytest.approx(own[name], rel=1e-3)
    cells = {"mount-1-x": (inch, 5e-4), "mount-3-k2": (pound / inch, 0.05)}
    for name, (factor, rounding) in cells.items():
        number = str(page.locator(f"td[data-name={name}]").text_content())
        assert float(number) == pytest.approx(own[name] / factor, abs=1.001 * rounding)
    heads = page.locator(".mounts thead th").all_text_contents()
    assert heads[1:5] == ["x, in", "y, in", "z, in", "first axis, lbf/in"]
    # Decades of the unit that is shown, and curves in it: 10 lbf stands where 44.5 N are.
    ticks = page.eval_on_selector_all(
        ".run-up .tick[text-anchor], .run-up text.tick:not(.degrees)",
        "found => found.map(each => [each.textContent, Number(each.getAttribute('y'))])",
    )
    y = {float(text.partition(" ")[0]): height for text, height in ticks if " lbf" in text}
    decade = y[100.0] - y[1000.0]
    force = float(np.linalg.norm(CAR.response(100.0, orders=[2])[2].body_force.rms_xyz))
    start = str(page.locator(".run-up .curve.length").get_attribute("d"))
    height = float(re.findall(r"-?[\d.]+", start)[1])
    expected = y[100.0] - 4 - decade * np.log10(force / pound / 100.0)
    assert height == pytest.approx(expected, abs=0.02)
    page.get_by_label("right: x, in", exact=True).fill("3.30")
    assert page.get_by_label("right: x, in", exact=True).input_value() == "3.30"
    page.get_by_label("right: first axis, lbf/in", exact=True).fill("1000")
    first = page.evaluate("crankpin.state.mounts[0]")
    assert first["at"][0] == 0.08382
    assert first["stiffness"][0] == pytest.approx(1000 * pound / inch, rel=1e-11)
    text = mount(page, "cross", "right").get_attribute("aria-valuetext")
    assert text == "x 3.3 in, y 0 in, z −3.54 in"
    page.get_by_label("quantity over engine speed").select_option("displacement")
    marks = page.locator(".run-up text.tick:not(.degrees)").all_text_contents()
    assert all(each.endswith(" in") for each in marks)


def test_controls_that_are_none_are_rejected(tmp_path: Path) -> None:
    wrongs: list[tuple[Any, str]] = [
        ("mount", r'^controls = .mount.: give .*did you mean "mounts"'),
        (["rod_ratio"], r"^controls = .rod_ratio.: give"),
        (3, r"^controls = 3: give names, of crank_angle, rpm, order, mode, rocking, mounts, view"),
    ]
    for controls, said in wrongs:
        with pytest.raises(cp.InputError, match=said):
            CAR.save_html(tmp_path / "car.html", controls=controls)


def test_names_stay_text(open_engine: Open) -> None:
    name = "</script><script>alert(1)</script><img src=x onerror=alert(2)>&amp;'\""
    first = MOUNTS[0].replace(name=name)
    p = CAR.replace(engine=FIRED.replace(name=name), mounts=[first, *MOUNTS[1:]])
    page = open_engine(p)
    page.on("dialog", lambda dialog: pytest.fail(dialog.message))
    assert page.title() == f"{name} on its mounts"
    assert page.locator(".scene .mount-name").first.text_content() == name
    assert page.locator("img").count() == 0
    assert page.evaluate("document.scripts.length") == 1
    page.get_by_role("button", name=name).click()
    assert page.locator(".settings b").text_content() == name


@pytest.mark.parametrize("engine", [FIRED, everything(), cp.Engine.preset("v16-45")])
def test_a_phone_s_width_needs_no_scrolling(open_engine: Open, engine: cp.Engine) -> None:
    page = open_engine(CAR.replace(engine=engine), viewport={"width": 360, "height": 740})
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    # All six numbers of each mount are seen, none beyond an edge.
    hidden = page.eval_on_selector_all(
        ".scrolls, .scrolls :is(td, th button)",
        """found => found.filter(each => each.scrollWidth > each.clientWidth)
            .map(each => each.outerHTML)""",
    )
    assert hidden == []
    odd = page.eval_on_selector_all(
        ".crankpin *",
        """found => found.flatMap(each => [...each.attributes]).filter(({ value }) =>
            /NaN|undefined|Infinity/.test(value)).map(({ name, value }) => `${name}=${value}`)""",
    )
    assert odd == []


def test_every_number_has_a_name_and_controls_have_labels(open_engine: Open) -> None:
    page = open_engine(CAR)
    nameless = page.evaluate(
        """() => {
            const texts = document.createTreeWalker(
                document.querySelector(".crankpin"), NodeFilter.SHOW_TEXT);
            const found = [];
            while (texts.nextNode()) {
                const { data, parentElement } = texts.currentNode;
                const named = parentElement.closest("[data-name][data-value]");
                if (/\\d/.test(data) && !named) found.push(data);
            }
            return found;
        }"""
    )
    assert nameless == []
    nameless = page.eval_on_selector_all(
        ".crankpin :is(button, input, select, svg[role=img], [role=slider])",
        """found => found.filter(each => !(each.getAttribute("aria-label")
            || each.labels?.[0]?.textContent.trim() || each.textContent.trim()))
            .map(each => each.outerHTML.slice(0, 80))""",
    )
    assert nameless == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_and_dark(open_engine: Open, scheme: str) -> None:
    """Springs and curves stand out from the paper."""
    page = open_engine(CAR, color_scheme=scheme)

    def brightness(selector: str, name: str) -> int:
        colour = page.eval_on_selector(
            selector, "(each, name) => getComputedStyle(each)[name]", name
        )
        return sum(int(part) for part in re.findall(r"\d+", colour)[:3])

    card = brightness(".panel", "backgroundColor")
    for selector in (".spring", ".run-up .curve.length", ".box:not(.still)", ".feet"):
        assert abs(brightness(selector, "stroke") - card) > 150


def test_errors_name_what_is_wrong(open_engine: Open, tmp_path: Path) -> None:
    wrongs: list[tuple[dict[str, Any], str]] = [
        ({"rpm": 0}, "^rpm = 0: give a speed above zero"),
        ({"rpm": -1}, "^rpm = -1"),
        ({"frequency": -1.0}, "^frequency"),
        ({"path": "car.txt"}, r"a page ends in \.html$"),
    ]
    for wrong, said in wrongs:
        with pytest.raises(cp.InputError, match=said):
            CAR.save_html(**{"path": tmp_path / "car.html", **wrong})
    base = cp.Subframe(cp.RigidBody(100, (0, -0.1, 0.2), (9, 12, 6)), MOUNTS)
    with pytest.raises(cp.InputError, match=r"^support = a subframe: counts in response"):
        CAR.with_support(base).save_html(tmp_path / "car.html")
    track = cp.InertiaTrack(1.5e5, 10.0, 0.3)
    hydraulic = CAR.replace(mounts=[MOUNTS[0].replace(track=track), *MOUNTS[1:]])
    with pytest.raises(cp.InputError, match=r"^frequency = None"):
        hydraulic.save_html(tmp_path / "car.html")
    page = open_engine(CAR)
    own = page.evaluate("JSON.stringify(crankpin.state.mounts)")
    for change, said in [
        ({"rpm": 0}, "rpm = 0"),
        ({"order": 3}, "order = 3"),
        ({"mode": 6}, "mode = 6"),
        ({"mounts": [{"at": [0, 0, 0], "stiffness": [-1, 1, 1]}] * 3}, "stiffness = [-1,1,1]"),
    ]:
        message = page.evaluate(
            "changes => { try { crankpin.set(changes); } catch (error) { return `${error}`; } }",
            change,
        )
        assert message.startswith(f"RangeError: {said}: give ")
    assert page.evaluate("JSON.stringify(crankpin.state.mounts)") == own


def test_is_at_most_110_kb_beside_its_figures(tmp_path: Path) -> None:
    file = tmp_path / "car.html"
    CAR.save_html(file)
    known = as_json(mounted.figures(CAR, 800.0))
    assert file.stat().st_size - len(known.encode()) <= 110_000
