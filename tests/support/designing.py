"""Short calls of :func:`crankpin.design`, shared by its tests."""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
from crankpin.analysis.design.question import Question, checked

from support.engines import CYLINDER

RPM = 6000.0
SPACING = 0.1
UNIT = 0.5 * 0.045 * (RPM * 2.0 * np.pi / 60.0) ** 2
"""m·r·ω² of a cylinder, N."""
A2 = float(CYLINDER.harmonics([2])[0].real)


def design(cylinders: int, layout: str = "vee", **given: Any) -> cp.results.Designs:  # noqa: ANN401
    given = {"cylinder": CYLINDER, "spacing": SPACING, "rpm": RPM} | given
    return cp.design(cylinders, layout=layout, **given)  # type: ignore[arg-type]


def question(cylinders: int, layout: str = "vee", **given: Any) -> Question:  # noqa: ANN401
    defaults: dict[str, Any] = {
        "cylinder": CYLINDER, "spacing": SPACING, "shared_pins": None, "pin_split_deg": None,
        "bank_angle_deg": (0, 180) if layout == "vee" else None, "same_split": True,
        "throws_deg": None, "even_firing": False, "intervals_deg": None, "strokes": 4,
        "bank_stagger": 0.0, "rotating_mass": 0.0, "counterweights": False, "shafts": (),
    }  # fmt: skip
    return checked(cylinders, layout, **defaults | given)
