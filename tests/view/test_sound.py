"""Does the page sound as the engine fires, and only when asked to?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Page
    from support.chromium import Open

pytestmark = pytest.mark.slow  # a browser

SOURCES = """() => crankpin.sound.sources.map((source) => ({
    samples: [...source.buffer.getChannelData(0)],
    rate: source.playbackRate.value,
    loop: source.loop,
    sampleRate: source.buffer.sampleRate,
}))"""


def heard(page: Page, cycle: float) -> list[list[float]]:
    """Crank angles of the loudest moments of each bank's pulses, within a cycle."""
    angles = []
    for source in page.evaluate(SOURCES):
        samples = np.array(source["samples"])
        assert source["loop"]
        assert np.abs(samples).max() == pytest.approx(0.6)
        assert abs(samples.mean()) < 1e-6  # samples are singles
        above = samples > 0.5 * samples.max()
        begins = np.flatnonzero(above & ~np.roll(above, 1))
        angles.append((begins * cycle / len(samples)).tolist())
    return angles


def gaps(angles: list[float], cycle: float) -> list[float]:
    following = [*angles[1:], angles[0] + cycle]
    return [after - before for before, after in zip(angles, following, strict=True)]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("v8-crossplane", [[90, 180, 270, 180], [90, 180, 270, 180]]),
        ("v8-flatplane", [[180] * 4, [180] * 4]),
        ("i4", [[180] * 4]),
        ("v-twin-45", [[720], [720]]),
    ],
)
def test_each_bank_is_heard_as_it_fires(
    open_engine: Open, name: str, expected: list[list[float]]
) -> None:
    engine = cp.Engine.preset(name)
    page = open_engine(engine, rpm=1200.0)
    assert page.evaluate("crankpin.sound.sources.length") == 0
    page.get_by_label("sound").check()
    found = heard(page, 720.0)
    # A sample of 48 kHz is 0.15° at this speed; a pulse rides on the tail of that before it.
    for angles, intervals in zip(found, expected, strict=True):
        measured = gaps(angles, 720.0)
        start = next(
            k
            for k in range(len(measured))
            if np.allclose(np.roll(measured, k), intervals, rtol=0, atol=1.0)
        )
        assert start >= 0
    sides = [page.evaluate(f"crankpin.sound.banks()[{k}].side") for k in range(len(expected))]
    assert sum(sides) == pytest.approx(0.0, abs=1e-12)
    assert page.asked == [page.url]  # type: ignore[attr-defined]


def test_follows_the_speed_and_falls_silent(open_engine: Open) -> None:
    page = open_engine(cp.Engine.preset("i4"), rpm=3000.0)
    page.get_by_label("sound").check()
    for rpm in (3000, 6000, 777):
        page.evaluate(f"crankpin.set({{ rpm: {rpm} }})")
        (source,) = page.evaluate(SOURCES)
        seconds = len(source["samples"]) / source["sampleRate"] / source["rate"]
        assert seconds == pytest.approx(120 / rpm, rel=1e-6)  # the rate is a single
    page.evaluate("crankpin.set({ rpm: 0 })")
    assert page.evaluate("crankpin.sound.sources.length") == 0
    page.evaluate("crankpin.set({ rpm: 900 })")
    assert page.evaluate("crankpin.sound.sources.length") == 1
    page.get_by_label("sound").uncheck()
    assert page.evaluate("crankpin.sound.sources.length") == 0


def test_an_engine_without_a_firing_order_has_no_sound(open_engine: Open) -> None:
    engine = cp.Engine.preset("i4").replace(firing_order="")
    page = open_engine(engine)
    assert page.evaluate("crankpin.sound") is None
    assert page.get_by_label("sound").count() == 0
