"""Two-plane correction: measured unbalances moved to planes where metal can be changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.frames import Tabled
from crankpin._support.record import read_only
from crankpin._support.tables import Table
from crankpin.analysis.geometry import direction
from crankpin.model.shafts import Unbalance

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

G_MM = 1e-6
"""A gram millimetre, kg·m."""


def two_plane_correction(
    amount_g_mm: ArrayLike, angle_deg: ArrayLike, *, measured_z: ArrayLike, correction_z: ArrayLike
) -> TwoPlaneCorrection:
    """Return the unbalances in two planes that correct those measured in two others.

    Parameters
    ----------
    amount_g_mm : array_like, shape (2,)
        Unbalances measured in two planes, g·mm.
    angle_deg : array_like, shape (2,)
        Directions in which the crankshaft is heavy, degrees in the direction of rotation.
    measured_z : array_like, shape (2,)
        Places of the planes of measurement along the crank, m.
    correction_z : array_like, shape (2,)
        Places of the planes of correction, m, such as the end webs (internal balance), or
        damper and flywheel (external balance).

    Returns
    -------
    TwoPlaneCorrection
        The corrections, g·mm and degrees.

    Raises
    ------
    InputError
        If an argument has other than two figures, one is out of range, or both corrections are in
        one plane.

    Notes
    -----
    Two rotors exert the same force and moment about every point if they do so about one: the
    corrections v at c satisfy Σv = −Σu and Σc·v = −Σz·u.

    Examples
    --------
    >>> import crankpin as cp
    >>> correction = cp.two_plane_correction(
    ...     [120, 80], [30, 200], measured_z=[0.0, 0.4], correction_z=[0.05, 0.35]
    ... )
    >>> correction.amount_g_mm.round(2), correction.angle_deg.round(2)
    (array([153.15, 113.08]), array([209.13,  21.76]))
    >>> correction.drill_deg.round(2)
    array([ 29.13, 201.76])
    """
    readings = {
        "amount_g_mm": amount_g_mm,
        "angle_deg": angle_deg,
        "measured_z": measured_z,
        "correction_z": correction_z,
    }
    pairs = {name: _pair(name, values) for name, values in readings.items()}
    if min(pairs["amount_g_mm"]) < 0.0:
        hint = "give zero or more; an angle 180° further turns it round"
        raise inputs.rejected("amount_g_mm", amount_g_mm, hint)
    one, other = pairs["correction_z"]
    if one == other:
        hint = "give two different places; in one plane no couple can be corrected"
        raise inputs.rejected("correction_z", correction_z, hint)
    return TwoPlaneCorrection(*pairs.values())


def _pair(name: str, values: ArrayLike) -> tuple[float, float]:
    numbers = inputs.vector(name, values)
    if len(numbers) != 2:
        figures = f"{len(numbers)} figure{'' if len(numbers) == 1 else 's'}"
        raise inputs.faulty(name, f"has {figures}", "give two, one for each plane")
    if not (np.abs(numbers) <= 1e30).all():
        raise inputs.rejected(name, values, "give finite numbers")
    return float(numbers[0]), float(numbers[1])


class TwoPlaneCorrection(Tabled):
    """Corrections in two planes, and the unbalance that they correct.

    Made by :func:`crankpin.two_plane_correction`.
    """

    measured_g_mm: tuple[float, float]
    """Unbalances measured, g·mm."""
    measured_deg: tuple[float, float]
    """Their directions, degrees."""
    measured_z: tuple[float, float]
    """Places of the planes of measurement, m."""
    correction_z: tuple[float, float]
    """Places of the planes of correction, m."""

    def __post_init__(self) -> None:
        for name in ("measured_g_mm", "measured_deg", "measured_z", "correction_z"):
            object.__setattr__(self, name, _pair(name, getattr(self, name)))

    @property
    def _weights(self) -> NDArray[np.complex128]:
        """Weights to add, g·mm."""
        heavy = np.array(self.measured_g_mm) * direction(np.array(self.measured_deg))
        forces = list(zip(heavy.tolist(), self.measured_z, strict=True))
        return -np.array(_core.shared(forces, *self.correction_z))

    @property
    def amount_g_mm(self) -> NDArray[np.float64]:
        """Corrections, g·mm: (2,)."""
        return read_only(np.abs(self._weights))

    @property
    def angle_deg(self) -> NDArray[np.float64]:
        """Directions in which weight is added, degrees in [0, 360): (2,)."""
        return read_only(np.angle(self._weights, deg=True) % 360.0)

    @property
    def drill_deg(self) -> NDArray[np.float64]:
        """Directions in which as much is drilled away instead, degrees in [0, 360): (2,)."""
        return read_only(np.angle(-self._weights, deg=True) % 360.0)

    @property
    def measured(self) -> tuple[Unbalance, ...]:
        """The unbalance that was measured, as unbalances of a crankshaft, kg·m."""
        return tuple(
            Unbalance(amount * G_MM, z, angle)
            for amount, z, angle in zip(
                self.measured_g_mm, self.measured_z, self.measured_deg, strict=True
            )
        )

    @property
    def hardware(self) -> tuple[Unbalance, ...]:
        """The corrections, as unbalances of a crankshaft, kg·m."""
        weights = zip(
            (self.amount_g_mm * G_MM).tolist(),
            self.correction_z,
            self.angle_deg.tolist(),
            strict=True,
        )
        return tuple(Unbalance(amount, z, round(angle, 13)) for amount, z, angle in weights)

    @property
    def table(self) -> Table:
        """Table of the corrections."""
        figures = (self.correction_z, self.amount_g_mm, self.angle_deg, self.drill_deg)
        return Table.from_rows(
            "Two-plane correction",
            ["plane", ("z", "m"), ("unbalance", "g·mm"), ("add at", "°"), ("or drill at", "°")],
            [(k + 1, *(float(figure[k]) for figure in figures)) for k in (0, 1)],
        )
