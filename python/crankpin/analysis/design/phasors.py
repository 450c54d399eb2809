"""Phasors of a candidate's loads as functions of its angles, with their derivatives.

A cylinder's load at order n is, at bore β and crankpin p, its load at 0 times e^{i((1−n)β + np)}
(forward), e^{i((1+n)β − np)} (backward) or e^{−in(β − p)} (about z). What turns with the crank is
forward of order 1, e^{ip}, and follows the first. Angles are linear in the variables, so that a
derivative is a factor i·k for each cylinder.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.design.families import Variable
    from crankpin.model.engine import Engine


class Row(NamedTuple):
    """One complex number of a balance."""

    quantity: str
    """``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``."""
    part: str
    """``"forward"`` or ``"backward"``; empty for a torque."""
    order: int


_TURNS = {
    "forward": lambda n: (1 - n, n),
    "backward": lambda n: (1 + n, -n),
    "": lambda n: (-n, n),
}
"""Part → by how much its phase grows with the bore's and with the crankpin's direction."""


class Phasors:
    """Phasors of an engine whose angles vary.

    Parameters
    ----------
    engine
        The engine with every variable at 0: a vee numbered along the crank, or an inline engine.
    variables
        Angles that vary.
    share
        Balance of one upright cylinder at TDC at θ = 0, with all that follows its crankpin.
    rows
        Phasors to compute.
    removed
        Order and part that balance shafts remove.
    """

    def __init__(
        self,
        engine: Engine,
        variables: Sequence[Variable],
        share: Balance,
        rows: Sequence[Row],
        removed: Sequence[tuple[int, str]] = (),
    ) -> None:
        bores, pins = np.radians(engine.bank_deg), np.radians(engine.pin_deg)
        turned = [_turned(each, engine) for each in variables]
        by_bore, by_pin = (
            np.reshape([each[k] for each in turned], (-1, len(engine))).T for k in (0, 1)
        )
        lever = 1j * (engine.z - engine.reference_z)
        coefficients, phases, slopes = [], [], []
        for row in rows:
            n = row.order
            of_bore, of_pin = _TURNS[row.part](n)
            coefficient = np.full(len(engine), _share(share, row))
            if row.quantity == "moment":
                coefficient = coefficient * lever
            kept = (n, row.part) not in removed
            coefficients.append(coefficient * kept)
            phases.append(of_bore * bores + of_pin * pins)
            slopes.append(of_bore * by_bore + of_pin * by_pin)
        self._coefficients = np.array(coefficients)
        self._phases = np.array(phases)
        self._slopes = np.array(slopes)

    @property
    def sizes(self) -> NDArray[np.float64]:
        """What the cylinders of each row would add up to if all were in phase: (n_rows,)."""
        return np.asarray(np.abs(self._coefficients).sum(axis=1))

    @property
    def steepest(self) -> NDArray[np.float64]:
        """Upper bound on what each row changes by per radian of a variable: (n_rows,)."""
        largest = np.abs(self._slopes).max(axis=2, initial=0.0)
        return np.asarray((np.abs(self._coefficients) * largest).sum(axis=1))

    def values(self, variables: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Return the phasors at some values of the variables, radians: (n, n_rows)."""
        angles = np.tensordot(variables, self._slopes, axes=(1, 2)) + self._phases
        return np.asarray((self._coefficients * np.exp(1j * angles)).sum(axis=2))

    def with_slopes(
        self, variables: NDArray[np.float64]
    ) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Return the phasors and their derivatives per radian: (n_rows,), (n_rows, n_variables)."""
        angles = np.einsum("rcv,v->rc", self._slopes, variables) + self._phases
        each = self._coefficients * np.exp(1j * angles)
        return each.sum(axis=1), 1j * np.einsum("rc,rcv->rv", each, self._slopes)


def _share(share: Balance, row: Row) -> complex:
    """Return the phasor of one cylinder with bore and pin at 0."""
    if row.order not in share.orders:
        return 0.0
    found = getattr(share[row.order], row.quantity if row.quantity != "moment" else "force")
    # Upright, with its pin upright too, a load in the plane is turned by a right angle.
    return complex(getattr(found, row.part) / 1j if row.part else found.phasor)


def _turned(variable: Variable, engine: Engine) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return by how much a variable turns the bore and the crankpin of each cylinder."""
    bores, pins = np.zeros((2, len(engine)))
    banks = list(engine.banks.values())
    if len(banks) == 1:
        pins[:] = variable.throws
        return bores, pins
    right, left = (np.array(numbers) - 1 for numbers in banks)
    bores[right], bores[left] = -0.5 * variable.bank_angle, 0.5 * variable.bank_angle
    if variable.throws:
        pins[right] = pins[left] = variable.throws
    if variable.splits:
        pins[left] += variable.splits
    return bores, pins
