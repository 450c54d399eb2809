"""Engines by name."""

from __future__ import annotations

from crankpin._engine import Engine
from crankpin._cylinder import Cylinder


def presets() -> dict[str, str]:
    """Return preset names."""
    return {}


def preset(name: str, *, cylinder: Cylinder | None, spacing: float | None) -> Engine:
    """Return the engine of this name."""
    raise NotImplementedError
