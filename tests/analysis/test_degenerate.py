"""Do choices of engines and parts work where nothing, or next to nothing, shakes?"""

from __future__ import annotations

import warnings

import crankpin as cp
import numpy as np
import pytest

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
        cp.match_parts(engine, masses, objective="spread"),
    ]
    for result in results:
        assert repr(result)
        assert result.table.csv()
        values = [each for column in result.table.columns for each in column.values]
        assert np.isfinite([each for each in values if isinstance(each, float)]).all()
