"""A balance shaft that was fitted: what it removes, and the loads on its bearings."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.record import read_only
from crankpin.analysis.geometry import direction
from crankpin.model.shafts import degrees

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.analysis.balancing.planes import Turning
    from crankpin.model.shafts import Shaft


@dataclasses.dataclass(frozen=True)
class FittedShaft:
    """A balance shaft of a :class:`BalanceShafts`, with its bearings."""

    shaft: Shaft
    """The shaft: its ratio, its axis and its unbalances at θ = 0."""
    makes: Turning
    """Force and moment of the shaft, over ω², as vectors x + iy at θ = 0: kg·m, kg·m²."""
    bearings: tuple[float, float] | None
    """Places of its two bearings, front first, m; None if they are not known."""

    @property
    def order(self) -> int:
        """Order that the shaft acts on."""
        return abs(self.shaft.ratio)

    @property
    def part(self) -> str:
        """Part that it acts on: "forward", turning with the crank, or "backward"."""
        return "forward" if self.shaft.ratio > 0 else "backward"

    @property
    def unbalance(self) -> float:
        """Sum of the amounts of its unbalances, kg·m."""
        return float(sum(each.amount for each in self.shaft.unbalances))

    @property
    def removed_force(self) -> float:
        """Force that it balances: length of its own, over ω², kg·m."""
        return abs(self.makes.force)

    @property
    def removed_moment(self) -> float:
        """Moment that it balances: length of its own, over ω², kg·m²."""
        return abs(self.makes.moment)

    @property
    def length(self) -> float | None:
        """Distance between its bearings, m; None if they are not known."""
        return None if self.bearings is None else self.bearings[1] - self.bearings[0]

    def bearing_loads(self, rpm: float) -> NDArray[np.complex128]:
        """Return the loads on its two bearings at θ = 0, front first.

        Forces of the unbalances on the bearings, shared by the lever rule, without weight and
        drive: each keeps its size and turns with the shaft.

        Parameters
        ----------
        rpm
            Crank speed.

        Returns
        -------
        numpy.ndarray
            x + iy, N: (2,).

        Raises
        ------
        InputError
            If the bearings are not known, or the speed is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> fit = cp.balance_shafts(cp.Engine.preset("i3"), -1, bearings=(0.0, 0.3))
        >>> abs(fit[0].bearing_loads(rpm=6000)).round(1)
        array([2205.2, 2205.2])
        """
        if self.bearings is None:
            raise InputError("bearings = None: give bearings=(z_front, z_rear) to balance_shafts")
        forces = [
            (each.amount * complex(direction(degrees(each.angle_deg))), each.z)
            for each in self.shaft.unbalances
        ]
        over = (self.shaft.ratio * inputs.angular_speed(rpm)) ** 2
        return read_only(over * np.array(_core.shared(forces, *self.bearings)))

    def moved(self, x: float, y: float) -> FittedShaft:
        """Return the same shaft with its axis at another place, m from the crank axis."""
        return dataclasses.replace(self, shaft=dataclasses.replace(self.shaft, x=x, y=y))
