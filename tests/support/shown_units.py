"""Units in what is shown."""

from __future__ import annotations

import re

SI = re.compile(
    r"(?<![\w·/])(?:kg|g|mg|m|cm|mm|µm|N|kN|MN|Pa|bar|kPa|MPa)[²³]?(?:[·/](?:s²?|m²?|mm|rad))*"
    r"(?![\w·/²³'])"
)
"""A unit of mass, length, force or pressure that is of the SI."""
IMPERIAL = "oz, in, lbf, psi"


def si_units(line: str) -> list[str]:
    """Return the units of the SI in a line, letters of formulas left out."""
    return SI.findall(re.sub(r"m·r[^ ]*", "", line))
