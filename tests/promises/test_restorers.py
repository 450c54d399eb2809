"""Are the figures of well-known engines on the page for restorers those worked out by hand?"""

from __future__ import annotations

from typing import NamedTuple

import crankpin as cp
import numpy as np
import pytest

PISTON = cp.Cylinder(crank_radius=0.041, rod_length=0.165, reciprocating_mass=0.395)
A, STAGGER = 0.095, 0.042
RPM = 6000.0
OMEGA = RPM * 2.0 * np.pi / 60.0
PULL = 0.395 * 0.041 * OMEGA**2
RATIO = 0.041 / 0.165
SECOND = RATIO + RATIO**3 / 4.0 + 15.0 * RATIO**5 / 128.0 + 35.0 * RATIO**7 / 512.0
"""The second order over the first, by the series of textbooks; the next term is 5e-7."""
HALF = np.sqrt(0.5)


class Worked(NamedTuple):
    """What an engine leaves at a balance factor of 50 %, worked out by hand.

    First and second order of force in pulls, and of couple in pulls times the lever.
    """

    engine: cp.Engine
    force: tuple[float, float]
    couple: tuple[float, float]
    lever: float = A


def inline(*throws: float, strokes: int = 4) -> cp.Engine:
    return cp.Engine.inline(PISTON, throws_deg=throws, spacing=A, strokes=strokes)


ENGINES = {
    # Two pistons together: half of 2 P turns against the crank.
    "360° twin": Worked(inline(0, 0), (1.0, 2.0 * SECOND), (0.0, 0.0)),
    # Two half pulls at a right angle; second orders oppose each other, at ±a/2.
    "270° twin": Worked(inline(0, 270), (HALF, 0.0), (HALF / 2.0, SECOND)),
    # Two half pulls opposite each other, at ±a/2; second orders together.
    "two-stroke twin": Worked(inline(0, 180, strokes=2), (0.0, 2.0 * SECOND), (0.5, 0.0)),
    # 1 + exp(2iα) of the two banks, over two.
    "45° twin": Worked(
        cp.Engine.vee(PISTON, bank_angle_deg=45, throws_deg=[0], spacing=A),
        # Second orders along bores ±α/2 at TDCs α apart: twice over, of cosines and sines.
        (np.cos(np.pi / 4.0), 2.0 * SECOND * np.cos(np.pi / 8.0) * HALF),
        (0.0, 0.0),
    ),
    # Both pistons outwards at once, at ±stagger/2.
    "boxer": Worked(
        cp.Engine.boxer(PISTON, throws_deg=[0], spacing=A, bank_stagger=STAGGER),
        (0.0, 0.0),
        (0.5, SECOND),
        STAGGER,
    ),
    # −a·1 + a·exp(i 240°) is √3 a long.
    "triple": Worked(inline(0, 240, 120), (0.0, 0.0), (np.sqrt(3) / 2.0, np.sqrt(3) * SECOND)),
}


@pytest.mark.parametrize("name", ENGINES)
def test_what_well_known_engines_leave(name: str) -> None:
    worked = ENGINES[name]
    left = cp.bob_weight(worked.engine).fitted.balance(RPM, orders=[1, 2])
    # To the next term of the series.
    np.testing.assert_allclose(left.force.peak / PULL, worked.force, atol=2e-6)
    np.testing.assert_allclose(left.moment.peak / (PULL * worked.lever), worked.couple, atol=2e-6)


def test_straight_lines_and_firing() -> None:
    """½(1 ∓ cos 45°) of a 45° twin, and the intervals that the page tells."""
    (low, along), (high, across) = cp.bob_weight(ENGINES["45° twin"].engine).straight_line_factors(
        "force"
    )
    np.testing.assert_allclose([low, high], [0.5 - HALF / 2.0, 0.5 + HALF / 2.0], rtol=1e-12)
    assert (along, across) == (90.0, 0.0)
    assert {*inline(0, 270).firing_orders()[0].intervals_text.split("-")} == {"270", "450"}
    assert inline(0, 180, strokes=2).firing_orders()[0].even
    yaw = ENGINES["boxer"].engine.balance(RPM, orders=[1])[1].moment.peak_xy
    np.testing.assert_allclose(yaw, [0.0, PULL * STAGGER], rtol=1e-12, atol=1e-12)
