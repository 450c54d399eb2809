"""Are flywheels of turning-moment diagrams those of textbooks: areas, formulas, loads, rims?"""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import crankpin as cp
import numpy as np
import pytest
from support import in_turn

Angles: TypeAlias = "np.typing.NDArray[np.float64]"
MULTICYLINDER = [52.0, -124.0, 92.0, -140.0, 85.0, -72.0, 107.0]
"""Areas, mm², at 600 N·m and 3° a millimetre (Khurmi and Gupta, chapter 16, as remembered)."""
OMEGA_600 = 600 * math.pi / 30


def test_areas_with_scales() -> None:
    """52 − (−120) = 172 mm² of 600·3·π/180 J each; m·k² = ΔE/(0.03·ω²)."""
    a = cp.turning_moment_areas(
        MULTICYLINDER, torque_scale=600, angle_scale_deg=3, rpm=600, irregularity=0.03
    )
    energy = 172 * 600 * 3 * math.pi / 180
    assert a.energy == pytest.approx(energy, rel=1e-14)
    assert (a.highest, a.lowest) == (1, 4)
    assert a.inertia == pytest.approx(energy / (0.03 * OMEGA_600**2), rel=1e-14)
    # The book's mass of a rim of 0.5 m radius, 183 kg.
    assert cp.flywheel_rim(a.inertia or 0, mean_diameter=1).mass == pytest.approx(182.5, abs=0.05)
    assert a.extremes_rpm == pytest.approx((591.0, 609.0))
    assert a.frames["levels"].columns[3].values == ("", "fastest", "", "", "slowest", "", "", "")


def test_irregularity_of_a_given_flywheel() -> None:
    """The same diagram with 36 kg at a radius of gyration of 0.15 m, say."""
    a = cp.turning_moment_areas(MULTICYLINDER, torque_scale=60, rpm=600, inertia=36 * 0.15**2)
    assert a.irregularity == pytest.approx(172 * 60 / (36 * 0.15**2 * OMEGA_600**2), rel=1e-14)


@in_turn("seed", range(20))
def test_areas_are_those_of_a_drawn_diagram(seed: int) -> None:
    """Triangles and rectangles of the areas, drawn over the crank angle, fluctuate as much."""
    draw = np.random.default_rng(seed)
    areas = draw.integers(-4, 5, draw.integers(2, 8)) * 100.0
    areas[-1] -= areas.sum()
    if not areas.any():
        return
    step = 720.0 / len(areas)
    theta, torque = [], []
    for k, area in enumerate(areas):
        triangle = [(0.0, 0.0), (0.5, 2.0), (1.0, 0.0)]
        shape = triangle if draw.random() < 0.5 else [(0.0, 1.0), (1.0, 1.0)]
        theta += [step * (k + where) for where, _ in shape]
        torque += [1000.0 + area * height / math.radians(step) for _, height in shape]
    theta.append(720.0)
    torque.append(torque[0])
    keep = [k for k in range(len(theta)) if k < 2 or not theta[k - 2] == theta[k - 1] == theta[k]]
    drawn = cp.flywheel(
        (np.array(theta)[keep], np.array(torque)[keep]), 1000, inertia=50.0, period_deg=720
    )
    a = cp.turning_moment_areas(areas, rpm=1000, inertia=50.0)
    assert drawn.energy == pytest.approx(a.energy, rel=1e-9)
    # Midway between the extremes is not the mean over time: a small irregularity's square apart.
    assert drawn.irregularity == pytest.approx(a.irregularity, rel=(a.irregularity or 0) + 1e-6)


def test_a_punch_is_driven_by_a_motor() -> None:
    """(1 − t/2s) of the energy of a hole comes from the flywheel, wherever the stroke begins."""
    hole = 7 * math.pi * 38 * 32
    for start in (0.0, 100.0, 3600 * 0.84, 3500.0):
        work = cp.stroke_load(hole, thickness=0.032, stroke=0.1, period_deg=3600, start_deg=start)
        wheel = cp.flywheel(None, 60, load_torque=work, irregularity=0.1)
        assert wheel.energy == pytest.approx(hole * (1 - 32 / 200), rel=1e-12)
        # A hole in ten turns.
        assert wheel.mean_torque == pytest.approx(hole / (20 * math.pi), rel=1e-12)
    even = cp.stroke_load(hole, duration_deg=360)
    assert np.ptp(even[1]) == 0.0


def test_formulas_are_functions() -> None:
    def sines(deg: Angles) -> Angles:
        waves = 600 * np.sin(np.radians(2 * deg)) - 30 * np.cos(np.radians(deg / 2))
        return np.asarray(5000 + waves)

    by_function = cp.flywheel(sines, 150, inertia=80.0)
    for text in (
        "5000 + 600 sin 2θ - 30 cos 0.5θ",
        "5000+600sin(2theta)−30cos(.5t)",
        "-30*cos(0.5·θ) + 6e2 sin 2 t + 5000",
    ):
        irregularity = cp.flywheel(text, 150, inertia=80.0).irregularity
        # Terms in another order round otherwise.
        assert irregularity == pytest.approx(by_function.irregularity, rel=1e-14)
    for wrong in ("", "torque", "5000 600", "5 sin", "sin 0.3θ", "5 +", "1e400", "sin 0θ", "2θ"):
        with pytest.raises(cp.InputError, match="drive"):
            cp.flywheel(wrong, 150, inertia=80.0)


def test_several_loads_add() -> None:
    drive = "5000 + 600 sin 2θ"
    steps = ([0, 90, 90, 360, 360], [9000, 9000, 3667, 3667, 9000])
    punch = cp.stroke_load(500.0, duration_deg=40, start_deg=300)

    def all_three(deg: Angles) -> Angles:
        turn = deg % 360
        in_stroke = (turn >= 300) & (turn < 340)
        step = np.where(turn < 90, 9000, 3667) + np.where(in_stroke, 500 / np.radians(40), 0)
        return np.asarray(step + 500 * np.sin(np.radians(deg)))

    listed = cp.flywheel(drive, 150, load_torque=[steps, "500 sin θ", punch], inertia=80.0)
    # A function is not known to jump; here all do at edges of cells, half degrees.
    one = cp.flywheel(drive, 150, load_torque=all_three, inertia=80.0)
    assert listed.energy == pytest.approx(one.energy, rel=1e-12)
    assert listed.irregularity == pytest.approx(one.irregularity, rel=1e-9)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"areas": [52, -124, 92]}, "add to zero, these to 20"),
        ({"areas": [1.0]}, "at least two"),
        ({"areas": [1.0, np.nan]}, r"areas\[1\]"),
        ({"areas": [0.0, 0.0]}, "not zero"),
        ({"rpm": None}, "inertia = 1.0: needs rpm"),
        ({"irregularity": 0.1}, "give one of inertia"),
        ({"inertia": 0.0}, "inertia = 0"),
        ({"rpm": 0.0}, "rpm = 0"),
        ({"torque_scale": -1.0}, "torque_scale"),
        ({"angle_scale_deg": 0.0}, "angle_scale_deg"),
        ({"spread": 1}, "spread"),
    ],
)
def test_wrong_areas(changes: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"areas": [2, -2], "rpm": 100.0, "inertia": 1.0} | changes
    with pytest.raises(cp.InputError, match=message):
        cp.turning_moment_areas(**arguments)


def test_measured_areas_are_spread() -> None:
    measured = cp.turning_moment_areas([100, -90], spread=True)
    assert measured.areas == pytest.approx([100 - 1000 / 190, -90 - 900 / 190])
    assert measured.areas.sum() == pytest.approx(0.0, abs=1e-12)


# --- rims -----------------------------------------------------------------------------------------


def inertia_of(rim: cp.results.FlywheelRim) -> float:
    """∫r²dm of a rim, by the midpoints of thin rings."""
    width, thickness = rim.section or (0.0, 0.0)
    inner = 0.5 * (rim.mean_diameter - thickness)
    radii = inner + thickness * (np.arange(100_000) + 0.5) / 100_000
    return float(2 * np.pi * rim.density * width * np.mean(radii**3) * thickness)


@pytest.mark.parametrize(
    "section", [{"width_ratio": 2.0}, {"width": 0.1}, {"thickness": 0.08}, {"width_ratio": 0.2}]
)
@pytest.mark.parametrize(
    "size",
    [{"mean_diameter": 1.5}, {"rim_speed": 25.0, "rpm": 240}, {"hoop_stress": 4e6, "rpm": 240}],
)
def test_rims_have_their_moment_of_inertia(
    section: dict[str, float], size: dict[str, float]
) -> None:
    rim = cp.flywheel_rim(120.0, share=0.95, **section, **size)
    # Midpoints of 1e5 rings miss 1e-10.
    assert inertia_of(rim) == pytest.approx(0.95 * 120.0, rel=1e-9)
    ((name, value),) = section.items()
    width, thickness = rim.section or (0.0, 0.0)
    measured = {"width": width, "thickness": thickness, "width_ratio": width / thickness}
    assert measured[name] == pytest.approx(value, rel=1e-14)
    for name in ("mean_diameter", "rim_speed", "hoop_stress"):
        if name in size:
            assert getattr(rim, name) == pytest.approx(size[name], rel=1e-14)


def test_a_thin_rim_is_a_textbooks() -> None:
    rim = cp.flywheel_rim(45.6, hoop_stress=5e6, rpm=600, density=7250)
    speed = math.sqrt(5e6 / 7250)
    radius = speed / OMEGA_600
    assert rim.mass == pytest.approx(45.6 / radius**2, rel=1e-14)
    assert rim.area == pytest.approx(rim.mass / (2 * math.pi * radius * 7250), rel=1e-14)
    assert rim.section is None
    # A section as thin as that changes nothing.
    thin = cp.flywheel_rim(45.6, hoop_stress=5e6, rpm=600, density=7250, thickness=1e-6)
    assert thin.mass == pytest.approx(rim.mass, rel=1e-11)


def test_a_disc() -> None:
    disc = cp.flywheel_disc(0.12, diameter=0.28, density=7850)
    assert 0.5 * disc.mass * 0.14**2 == pytest.approx(0.12, rel=1e-14)
    assert math.pi * 0.14**2 * disc.thickness * 7850 == pytest.approx(disc.mass, rel=1e-14)
    again = cp.flywheel_disc(0.12, thickness=disc.thickness, density=7850)
    assert again.diameter == pytest.approx(0.28, rel=1e-14)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mean_diameter": None}, "give one of mean_diameter"),
        ({"rim_speed": 20.0}, "give one of mean_diameter"),
        ({"mean_diameter": None, "rim_speed": 20.0}, "rim_speed = 20.0: needs rpm"),
        ({"width": 0.1, "thickness": 0.1}, "give one of"),
        ({"share": 1.1}, "a part of 1"),
        ({"inertia": 0.0}, "inertia"),
        ({"density": -1.0}, "density"),
        ({"width": 0.001}, "has no hole"),
    ],
)
def test_wrong_rims(changes: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"inertia": 50.0, "mean_diameter": 0.6} | changes
    with pytest.raises(cp.InputError, match=message):
        cp.flywheel_rim(**arguments)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"energy": 0.0}, "energy"),
        ({"duration_deg": 400.0}, "at most the period"),
        ({"thickness": 0.01}, "give one of duration_deg"),
        ({"stroke": 0.01}, "stroke = 0.01: needs thickness"),
        ({"duration_deg": None, "thickness": 0.2, "stroke": 0.1}, "at most the stroke"),
    ],
)
def test_wrong_strokes(changes: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"energy": 10.0, "duration_deg": 40.0} | changes
    with pytest.raises(cp.InputError, match=message):
        cp.stroke_load(**arguments)


def test_a_motor_needs_a_load() -> None:
    with pytest.raises(cp.InputError, match="load of a motor"):
        cp.flywheel(None, 60, inertia=1.0)
    with pytest.raises(cp.InputError, match="period is that of the load"):
        cp.flywheel(None, 60, inertia=1.0, load_torque="5 sin θ", period_deg=360)
