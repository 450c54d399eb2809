"""The cylinders and the plainest engines of many tests."""

from __future__ import annotations

import crankpin as cp
from rederivation import ijesc

CYLINDER = cp.Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=0.5)
OFFSET = CYLINDER.replace(pin_offset=0.001)
IJESC = cp.Cylinder(ijesc.CRANK_RADIUS, ijesc.ROD_LENGTH, ijesc.MASS)
"""The cylinder of the IJESC paper."""

I4 = cp.Engine.inline(CYLINDER, throws_deg=[0, 180, 180, 0], spacing=0.1, name="Inline-4")
V6 = cp.Engine.vee(
    CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.13, name="V6 60°, shared pins"
)
