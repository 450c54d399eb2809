"""Periodic loads that are given, plainly: what free bodies see of them over crank angle.

A load is a dictionary of its figures in SI: amplitudes of the force and of the torque by order of
the crank, direction and phase in degrees, z and axis, the speed of its shaft over that of the
crank, and what it acts on. Nothing here knows how crankpin sums.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def series(amplitudes: dict[float, complex], psi: Array) -> Array:
    """Return Re Σ A exp(inψ) at angles in radians."""
    value = np.zeros_like(psi)
    for order, amplitude in amplitudes.items():
        value = value + amplitude.real * np.cos(order * psi) - amplitude.imag * np.sin(order * psi)
    return value


def factor(load: dict[str, Any], rpm: float) -> float:
    """Return what amplitudes are multiplied by at a speed."""
    reference = load.get("at_rpm")
    return 1.0 if reference is None else (rpm / reference) ** 2


def force_on_shaft(load: dict[str, Any], theta_deg: Array, rpm: float) -> tuple[Array, Array]:
    """Return the force along x and y, N, with what stays of it."""
    psi = np.deg2rad(theta_deg - load.get("phase_deg", 0.0))
    size = factor(load, rpm) * series(load.get("force", {}), psi)
    angle = np.deg2rad(load.get("direction_deg", 0.0)) * np.ones_like(psi)
    if load.get("turning"):
        angle = angle + load.get("ratio", 1.0) * psi
    return size * np.cos(angle), size * np.sin(angle)


def net(load: dict[str, Any], theta_deg: Array, rpm: float, plane: float) -> dict[str, Array]:
    """Return force, moment about a plane, torques on block and crank; without a constant force.

    Gears hold shafts at even speed. The sum of the moments of all inner forces is zero, so that the
    block bears what acts from outside, and what the crank is given less.
    """
    x, y = force_on_shaft(load, theta_deg, rpm)
    if load["on"] == "both":
        x, y = 0.0 * x, 0.0 * y
    turns = theta_deg - theta_deg.min() < 720.0
    x, y = x - x[turns].mean(), y - y[turns].mean()
    psi = np.deg2rad(theta_deg - load.get("phase_deg", 0.0))
    torque = factor(load, rpm) * series(load.get("torque", {}), psi)
    ratio = load.get("ratio", 1.0)
    if load["on"] == "block":
        crank, outer = 0.0 * torque, torque
    else:
        # Power: what a shaft is given at ratio times the speed of the crank.
        crank, outer = ratio * torque, torque if load["on"] == "shaft" else 0.0 * torque
    at_x, at_y = load.get("axis", (0.0, 0.0))
    lever = load.get("z", 0.0) - plane
    return {
        "force": np.stack([x, y], axis=-1),
        "moment": np.stack([-lever * y, lever * x], axis=-1),
        "torque": outer - crank + at_x * y - at_y * x,
        "crank_torque": crank,
    }
