"""What do the e-book's engines, each given as three lists, exert at each order?

Sources: "V-Engines - Flat-Plane vs Cross-Plane" and "Multi-Cylinder Series - Summary", at 10 rpm,
R = 1 m, L = 2 m, a = 0.1 m. An engine is the crank angles at which its cylinders are at top dead
centre (phases), the directions of its bores from +x (banks) and its positions along the crank in
units of a. The books call sum z F_x "pitch" and sum z F_y "yaw": the sizes of our yaw M_y and
pitch M_x. Their phases enter as e^{+i n phi}, a clockwise engine in their x-right, y-up picture;
magnitudes do not change. Their nine kilograms at 1x (rotating and rod parts along the bore too)
and seven from 2x on are kept, as the printed tables need them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rederivation import kinematics

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

RPM = 10.0
CRANK_RADIUS = 1.0  # m
ROD_LENGTH = 2.0  # m
HALF_SPACING = 0.1  # m, the books' a
MASS_AT_FIRST_ORDER = 9.0  # kg, not printed: 9.870 N / (R omega^2)
MASS_ABOVE = 7.0  # kg, not printed: 4.111 N / (a_2 R omega^2)


class Layout(NamedTuple):
    """One engine: three lists, positions in units of a."""

    phases_deg: tuple[float, ...]
    banks_deg: tuple[float, ...]
    positions: tuple[float, ...]


_V90 = (45.0, 135.0)
_V8_PLACES = (-1.5, -1.5, -0.5, -0.5, 0.5, 0.5, 1.5, 1.5)

V_ENGINES: dict[str, Layout] = {
    "v_twin_90": Layout((45, 135), _V90, (0, 0)),
    "v6_60": Layout((60, 120, 300, 0, 180, 240), (60, 120) * 3, (-1, -1, 0, 0, 1, 1)),
    "v8_flat_plane": Layout((45, 135, 225, 315, 225, 315, 45, 135), _V90 * 4, _V8_PLACES),
    "v8_cross_plane": Layout((45, 135, 315, 45, 225, 315, 135, 225), _V90 * 4, _V8_PLACES),
}
"""Presets as the V-engine chapter lists them; its cross-plane has pins at 0, 90, 180, 270."""

MASTER: dict[str, Layout] = {
    "single": Layout((0,), (0,), (0,)),
    "straight_3": Layout((0, 120, 240), (0,) * 3, (-1, 0, 1)),
    "inline_4": Layout((0, 180, 180, 0), (0,) * 4, (-3, -1, 1, 3)),
    "boxer_4": Layout((0, 0, 180, 180), (0, 180) * 2, (-1, -1, 1, 1)),
    "flat_4_non_boxer": Layout((0, 180, 180, 0), (0, 180) * 2, (-1, -1, 1, 1)),
    "straight_6": Layout((0, 120, 240, 240, 120, 0), (0,) * 6, (-2.5, -1.5, -0.5, 0.5, 1.5, 2.5)),
}
"""Configurations of the summary chapter; a sign of -1 is a bank at 180 degrees."""


def v_engine(pins_deg: tuple[float, ...], places: tuple[float, ...]) -> Layout:
    """A 90-degree V with two cylinders per pin: phase = bank - pin (V-engine chapter, section 2).

    ``v_engine((0, 90, 270, 180), (-1.5, -0.5, 0.5, 1.5))`` is the cross-plane that is built.
    """
    phases = tuple(float((bank - pin) % 360) for pin in pins_deg for bank in _V90)
    return Layout(phases, _V90 * len(pins_deg), tuple(z for z in places for _ in _V90))


def exact_coefficients(rod_ratio: float, max_order: int = 8, n_samples: int = 1024) -> Array:
    """a_0 ... a_max of the exact motion, force = m r omega^2 sum a_n cos n theta, (max_order + 1,).

    Fourier transform of the sampled acceleration: a_2 = 0.535552857, a_4 = -0.038426149 at 1/2.
    """
    theta = 2.0 * np.pi * np.arange(n_samples) / n_samples
    spectrum = np.fft.rfft(-kinematics.acceleration(theta, 1.0, 1.0 / rod_ratio)) / n_samples
    coefficients: Array = np.array(2.0 * spectrum[: max_order + 1].real)
    coefficients[0] /= 2.0
    return coefficients


def single_cylinder(rod_ratio: float = CRANK_RADIUS / ROD_LENGTH, max_order: int = 8) -> Array:
    """Peak force F_n of one cylinder along its bore, signed, (max_order + 1,) newtons."""
    mass = np.full(max_order + 1, MASS_ABOVE)
    mass[1] = MASS_AT_FIRST_ORDER
    omega = 2.0 * np.pi * RPM / 60.0
    return np.asarray(mass * CRANK_RADIUS * omega**2 * exact_coefficients(rod_ratio, max_order))


def phasor_sum_2d(layout: Layout, order: int) -> ComplexArray:
    """Sum of (cos beta, sin beta) e^{i n phi}, dimensionless, (2,) (summary, question 2)."""
    turn = np.exp(1j * order * np.deg2rad(layout.phases_deg))
    bank = np.deg2rad(layout.banks_deg)
    return np.array([np.sum(np.cos(bank) * turn), np.sum(np.sin(bank) * turn)])


def phasor_moment_sum_2d(layout: Layout, order: int) -> ComplexArray:
    """Sum of z (cos beta, sin beta) e^{i n phi} in units of a: the books' pitch and yaw, (2,)."""
    turn = np.asarray(layout.positions) * np.exp(1j * order * np.deg2rad(layout.phases_deg))
    bank = np.deg2rad(layout.banks_deg)
    return np.array([np.sum(np.cos(bank) * turn), np.sum(np.sin(bank) * turn)])


def table(
    layout: Layout, max_order: int = 4, rod_ratio: float = CRANK_RADIUS / ROD_LENGTH
) -> Array:
    """|F_x|, |F_y| (N), |sum z F_x|, |sum z F_y| (N m) at orders 0 ... max, (max_order + 1, 4)."""
    amplitude = np.abs(single_cylinder(rod_ratio, max_order))
    rows = [
        np.abs(np.concatenate([phasor_sum_2d(layout, n), phasor_moment_sum_2d(layout, n)]))
        for n in range(max_order + 1)
    ]
    levers = np.array([1.0, 1.0, HALF_SPACING, HALF_SPACING])
    return np.asarray(amplitude[:, np.newaxis] * np.array(rows) * levers)


def master_table(max_order: int = 4) -> dict[str, Array]:
    """Summary, section 2: force (N) and moment (N m) along the one axis, {name: (2, orders)}."""
    return {name: table(layout, max_order)[:, [0, 2]].T for name, layout in MASTER.items()}


def rod_ratio_sweep(rod_ratios: tuple[float, ...] = (2 / 3, 1 / 2, 1 / 3, 1 / 4)) -> Array:
    """Summary, section 4, (n_ratios, 6): single 1x, single 2x, inline-4 2x (N), flat-4 1x,
    straight-3 1x (N m), boxer 2x (N).
    """
    rows = []
    for ratio in rod_ratios:
        tables = {name: table(layout, 2, ratio) for name, layout in MASTER.items()}
        rows.append(
            [
                tables["single"][1, 0],
                tables["single"][2, 0],
                tables["inline_4"][2, 0],
                tables["flat_4_non_boxer"][1, 2],
                tables["straight_3"][1, 2],
                tables["boxer_4"][2, 0],
            ]
        )
    return np.array(rows)
