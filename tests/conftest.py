"""What tests share: the folder of tables, the cylinders and the plainest engines."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
from building import open_workbench, workbench  # noqa: F401 - fixtures
from chromium import browser, open_engine, open_file  # noqa: F401 - fixtures
from extras import pytest_make_collect_report, pytest_runtest_makereport  # noqa: F401 - hooks
from rederivation import ijesc

if TYPE_CHECKING:
    from crankpin._support.frames import Tabled

DATA = Path(__file__).parent / "data"
"""Tables of the sources, and reference values."""

CYLINDER = cp.Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=0.5)
OFFSET = CYLINDER.replace(pin_offset=0.001)
IJESC = cp.Cylinder(ijesc.CRANK_RADIUS, ijesc.ROD_LENGTH, ijesc.MASS)
"""The cylinder of the IJESC paper."""

I4 = cp.Engine.inline(CYLINDER, throws_deg=[0, 180, 180, 0], spacing=0.1, name="Inline-4")
V6 = cp.Engine.vee(
    CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.13, name="V6 60°, shared pins"
)


def html_of(result: Tabled) -> str:
    """Return what notebooks show of a result that is shown as tables."""
    text = result._repr_html_()
    assert text is not None
    return text
