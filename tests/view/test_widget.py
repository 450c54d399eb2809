"""Do the widget's traits and its page move each other, and are its numbers the core's?"""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from support.chromium import Open, values
from support.view_engines import everything

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

pytestmark = pytest.mark.slow  # a browser

V8 = cp.Engine.preset("v8-crossplane")

HOST = """async ([source, style, state]) => {
    // What a notebook gives a module: a model with traits, and an element.
    const listeners = new Map();
    const saved = [];
    const model = {
        get: (name) => state[name],
        set: (name, value) => { state[name] = value; saved.push([name, value]); },
        save_changes: () => {},
        on: (event, act) => listeners.set(event, [...(listeners.get(event) ?? []), act]),
        off: (event, act) => listeners.set(
            event, listeners.get(event).filter((each) => each !== act)),
    };
    const sheet = document.createElement("style");
    sheet.textContent = style;
    const el = document.createElement("div");
    document.body.append(sheet, el);
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    const { default: module } = await import(url);
    const cleanUp = await module.render({ model, el });
    window.host = {
        saved,
        cleanUp,
        listening: () => [...listeners.values()].flat().length,
        receive: (changes) => {
            Object.assign(state, changes);
            for (const name of Object.keys(changes)) {
                for (const act of listeners.get(`change:${name}`) ?? []) act();
            }
        },
    };
}"""


@pytest.fixture
def shown(open_file: Open, tmp_path: Path) -> Any:  # noqa: ANN401 - a function
    """Show a widget in a page, as a notebook would."""

    def show(widget: Any) -> Page:  # noqa: ANN401 - of a library that may lack
        file = tmp_path / "host.html"
        file.write_text("<!DOCTYPE html><link rel=icon href='data:,'><body></body>")
        page = open_file(file)
        state = widget.get_state()
        page.evaluate(HOST, [widget._esm, widget._css, json.loads(json.dumps(state))])
        return page

    return show


# --- in Python ----------------------------------------------------------------------------------


def test_traits_begin_as_the_engine() -> None:
    widget = V8.view(rpm=5000)
    assert (widget.angle_deg, widget.rpm, widget.hold) == (0.0, 5000.0, "pins")
    assert widget.bank_angle_deg == 90.0
    assert widget.rod_ratio == V8.cylinders[0].rod_ratio
    assert widget.engine == V8
    i4 = cp.Engine.preset("i4").view()
    assert (i4.rpm, i4.bank_angle_deg) == (3000.0, None)


def test_core_computes_anew_when_a_setting_changes() -> None:
    engine = V8.replace(reference_z=0.1)
    widget = engine.view(rpm=5000)
    widget.bank_angle_deg, widget.rod_ratio, widget.rpm = 60.0, 0.25, 6000
    expected = engine.with_bank_angle(60, hold="pins")
    cylinders = [c.replace(rod_length=c.crank_radius / 0.25) for c in V8.cylinders]
    expected = expected.replace(cylinder=cylinders)
    assert widget.engine == expected
    assert widget.core["settings"] == {
        "rpm": 6000.0,
        "bank_angle_deg": 60.0,
        "rod_ratio": 0.25,
        "hold": "pins",
    }
    balance = expected.balance(6000, orders=range(1, 25), torque=False)
    backward = [complex(*each["moment"]["backward"]) for each in widget.core["orders"]]
    np.testing.assert_array_equal(backward, balance.moment.backward)
    curve = widget.core["curve"]
    angles = np.linspace(0, 360, len(curve["moment"]))
    wave = expected.waveform(6000, theta_deg=angles)
    np.testing.assert_array_equal(curve["moment"], np.asarray(wave.moment))
    np.testing.assert_array_equal(curve["torque"], np.asarray(wave.torque))
    # An angle computes nothing.
    before = widget.core
    widget.angle_deg = 77.0
    assert widget.core is before


def test_wrong_settings_are_rejected_by_name() -> None:
    widget = V8.view()
    for name, value, message in [
        ("rpm", -1.0, r"^rpm = -1"),
        ("bank_angle_deg", 181.0, r"^bank_angle_deg = 181"),
        ("rod_ratio", 1.5, "the crank cannot turn"),
        ("rod_ratio", 0.8, r"^rod_ratio = 0\.8: a page reaches 0\.05 to 0\.7$"),
    ]:
        before = getattr(widget, name)
        with pytest.raises(cp.InputError, match=message):
            setattr(widget, name, value)
        assert getattr(widget, name) == before
    with pytest.raises(cp.InputError, match="exactly two are needed"):
        cp.Engine.preset("i4").view().bank_angle_deg = 30.0
    with pytest.raises(cp.InputError, match=r"^rpm"):
        V8.view(rpm=float("inf"))


def test_spectrum_has_no_torque() -> None:
    widget = V8.view(spectrum={1: 0.067, 30: 0.001})
    assert {*widget.core["curve"]["torque"]} == {None}
    assert widget.core["orders"][-1]["order"] == 30


def test_without_anywidget_the_remedy_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "crankpin.view.widget", raising=False)
    with pytest.raises(
        ImportError, match=r'anywidget is not installed: pip install "crankpin\[view\]"'
    ):
        V8.view()


# --- in the browser -----------------------------------------------------------------------------


def test_python_moves_the_page(shown: Any) -> None:  # noqa: ANN401 - a fixture
    widget = V8.view(rpm=5000)
    page = shown(widget)
    widget.angle_deg, widget.bank_angle_deg, widget.rpm = 97.25, 60.0, 6000.0
    changes = {name: getattr(widget, name) for name in ("angle_deg", "bank_angle_deg", "rpm")}
    page.evaluate("changes => host.receive(changes)", changes)
    page.evaluate("core => host.receive({ core })", widget.core)
    found = values(page)
    assert (found["crank-angle"], found["bank-angle"], found["rpm"]) == (97.25, 60, 6000)
    wave = widget.engine.waveform(6000, theta_deg=[97.25])
    expected = [*np.asarray(wave.force)[0], *np.asarray(wave.moment)[0], np.asarray(wave.torque)[0]]
    names = ["force-x", "force-y", "moment-x", "moment-y", "torque"]
    np.testing.assert_allclose([found[name] for name in names], expected, rtol=1e-9, atol=1e-6)
    assert page.evaluate("host.saved") == []  # what came from Python is not sent back


def test_page_moves_python(shown: Any) -> None:  # noqa: ANN401 - a fixture
    page = shown(V8.view())
    page.get_by_label("crank angle").fill("-12.5")
    page.locator("[data-name=rod-ratio]").fill("0.25")
    page.get_by_label("held as the bank angle changes").select_option("firing")
    saved = page.evaluate("host.saved")
    assert saved == [["angle_deg", -12.5], ["rod_ratio", 0.25], ["hold", "firing"]]


def test_playing_tells_python_now_and_then(shown: Any) -> None:  # noqa: ANN401 - a fixture
    page = shown(V8.view())
    page.clock.install(time=0)
    page.clock.pause_at(1000)
    page.get_by_role("button", name="play").click()
    page.clock.run_for(1000)
    sent = len(page.evaluate("host.saved"))
    assert 7 <= sent <= 11
    page.get_by_role("button", name="stop").click()
    assert page.evaluate("host.saved").pop() == ["angle_deg", values(page)["crank-angle"]]


@pytest.mark.parametrize("engine", [V8, cp.Engine.preset("vr6"), everything()])
def test_numbers_are_the_core_s(shown: Any, engine: cp.Engine) -> None:  # noqa: ANN401 - a fixture
    widget = engine.view(rpm=5000)
    page = shown(widget)
    shown_orders = [
        name.rpartition("-")[2] for name in values(page) if name.startswith("moment-forward-")
    ]
    assert shown_orders
    core = {each["order"]: each for each in widget.core["orders"]}
    for order in map(int, shown_orders):
        for quantity in ("force", "moment"):
            for part in ("forward", "backward"):
                found = values(page)[f"{quantity}-{part}-{order}"]
                expected = abs(complex(*core[order][quantity][part]))
                assert found == pytest.approx(expected, rel=1e-15)
    # They are the core's, and not the page's own beside them.
    altered = json.loads(json.dumps(widget.core))
    first = int(shown_orders[0])
    for each in altered["orders"]:
        if each["order"] == first:
            each["moment"]["forward"] = [3.0, 4.0]
    page.evaluate("core => host.receive({ core })", altered)
    assert values(page)[f"moment-forward-{first}"] == 5.0
    # Until Python has followed a new setting the page has its own.
    page.evaluate("host.receive({ rpm: 2500 })")
    mine = values(page)[f"moment-forward-{first}"]
    expected = abs(complex(*core[first]["moment"]["forward"])) / 4
    assert mine == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_speed_of_a_fired_engine_is_the_core_s(shown: Any) -> None:  # noqa: ANN401 - a fixture
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    engine = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    widget = engine.view(rpm=5000, inertia=0.2)
    wheel = cp.flywheel(engine, rpm=5000, inertia=0.2)
    angles = 2.0 * np.arange(361)
    found = np.interp(angles, wheel.theta_deg, wheel.speed_rpm)
    np.testing.assert_array_equal(widget.core["curve"]["speed"], found)
    page = shown(widget)
    altered = json.loads(json.dumps(widget.core))
    altered["curve"]["speed"] = [1.5 * each for each in altered["curve"]["speed"]]
    page.evaluate("core => host.receive({ core })", altered)
    assert values(page)["crank-speed"] == pytest.approx(1.5 * found[0], rel=1e-15)
    # At idle it would stop; without gas nothing drives it.
    widget.rpm = 20
    assert widget.core["curve"]["speed"] is None
    assert V8.view().core["curve"]["speed"] is None
    with pytest.raises(cp.InputError, match="has no driving torque"):
        V8.view(inertia=0.2)


def test_compact_widget(shown: Any) -> None:  # noqa: ANN401 - a fixture
    page = shown(V8.view(compact=True))
    box = page.locator(".crankpin").bounding_box()
    assert (box["width"], box["height"]) == (640, 360)
    page.evaluate("host.receive({ bank_angle_deg: 60, angle_deg: 33 })")
    assert (values(page)["bank-angle"], values(page)["crank-angle"]) == (60, 33)
    page.get_by_label("turn the crank").fill("77")
    assert page.evaluate("host.saved") == [["angle_deg", 77]]
    # JupyterLab leaves its keys alone.
    focused = page.evaluate("document.activeElement.getAttribute('data-lm-suppress-shortcuts')")
    assert focused == "true"


# --- mounts -------------------------------------------------------------------------------------

POWERTRAIN = cp.Powertrain(
    cp.Engine.preset("i4"),
    cp.RigidBody(148.0, (0.02, 0.07, 0.09), (8.1, 7.6, 4.9)),
    [
        cp.Mount("right", (0.28, 0, -0.09), (22e4, 8e4, 8e4), tilt_deg=45, loss_factor=0.1),
        cp.Mount("left", (-0.28, 0, -0.09), (22e4, 8e4, 8e4), tilt_deg=135, loss_factor=0.1),
        cp.Mount("rear", (0, -0.12, 0.55), (10e4, 18e4, 10e4), loss_factor=0.1),
    ],
)


def other_mounts(widget: Any) -> list[dict[str, Any]]:  # noqa: ANN401 - of a library that may lack
    """Return the mounts of a widget, with another place and stiffness of the first."""
    return [{"at": [0.3, 0.02, -0.1], "stiffness": [1e5, 2e5, 3e5]}, *widget.mounts[1:]]


def frequencies(widget: Any) -> list[float]:  # noqa: ANN401 - as above
    return [mode["frequency"] for mode in widget.core["modes"]]


def test_mounts_move_the_library_s_numbers() -> None:
    widget = POWERTRAIN.view(rpm=900)
    assert widget.powertrain == POWERTRAIN
    assert (widget.rpm, widget.order, widget.mode) == (900.0, 2, None)
    widget.mounts = other_mounts(widget)
    first = POWERTRAIN.mounts[0].replace(at=(0.3, 0.02, -0.1), dynamic_stiffness=(1e5, 2e5, 3e5))
    moved = POWERTRAIN.replace(mounts=[first, *POWERTRAIN.mounts[1:]])
    assert widget.powertrain == moved
    assert frequencies(widget) == moved.modes().frequency.tolist()
    motion = np.array(widget.core["parts"][0]["motion"]).view(complex)[:, 0]
    np.testing.assert_array_equal(motion, moved.response(900, orders=[2]).motion[0, :])
    widget.order = "all"
    assert [part["order"] for part in widget.core["parts"]] == list(moved.response(900).orders)
    for name, value, message in [
        ("rpm", 0.0, r"^rpm = 0\.0: give a speed above zero"),
        ("order", 3, "^order = 3"),
        ("mode", 6, "^mode = 6"),
        ("mounts", widget.mounts[:1], "^mounts has 1 entries"),
        ("mounts", [{"at": (0, 0, 0)}] * 3, "^mounts = "),
        ("mounts", [{"at": (0, 0, 0), "stiffness": (1, -1, 1)}] * 3, "^dynamic_stiffness"),
    ]:
        before = getattr(widget, name)
        with pytest.raises(cp.InputError, match=message):
            setattr(widget, name, value)
        assert getattr(widget, name) == before


def test_a_resonance_without_damping_has_no_numbers() -> None:
    bare = POWERTRAIN.replace(mounts=[m.replace(loss_factor=0) for m in POWERTRAIN.mounts])
    widget = bare.view(rpm=900)
    known = []
    for rpm in (900.0, 30.0 * float(bare.modes().frequency[3]), 1000.0):
        widget.rpm = rpm
        known.append(widget.core is not None)
    assert known == [True, False, True]


def test_page_of_mounts_and_python_move_each_other(shown: Any) -> None:  # noqa: ANN401 - a fixture
    widget = POWERTRAIN.view(rpm=900)
    page = shown(widget)
    names = [f"mode-{k}-frequency" for k in range(1, 7)]
    assert [values(page)[name] for name in names] == frequencies(widget)
    widget.mounts = other_mounts(widget)
    page.evaluate("mounts => host.receive({ mounts })", widget.mounts)
    page.evaluate("core => host.receive({ core })", widget.core)
    assert [values(page)[name] for name in names] == frequencies(widget)
    assert page.evaluate("host.saved") == []
    # They are the core's, and not the page's own beside them.
    altered = json.loads(json.dumps(widget.core))
    altered["modes"][0]["frequency"] = 1.25
    page.evaluate("core => host.receive({ core })", altered)
    assert values(page)["mode-1-frequency"] == 1.25
    # Until Python has followed the page has its own.
    page.get_by_label("right: x, mm", exact=True).fill("280")
    [(name, mounts)] = page.evaluate("host.saved")
    widget.mounts = mounts
    assert (name, mounts[0]["at"]) == ("mounts", [0.28, 0.02, -0.1])
    frequency = widget.powertrain.modes().frequency
    own = [values(page)[name] for name in names]
    np.testing.assert_allclose(own, frequency, rtol=1e-10)
    page.get_by_role("button", name="mode 3").click()
    assert page.evaluate("host.saved").pop() == ["mode", 2]
    page.evaluate("host.cleanUp()")
    assert page.evaluate("host.listening()") == 0


def test_nothing_is_left_when_the_output_is_cleared(shown: Any) -> None:  # noqa: ANN401 - a fixture
    page = shown(V8.view())
    page.get_by_role("button", name="play").click()
    assert page.evaluate("host.listening()") == 6
    page.evaluate("host.cleanUp()")
    assert page.evaluate("host.listening()") == 0
    assert page.locator(".crankpin").count() == 0
