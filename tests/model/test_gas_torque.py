"""Is the bundled table of gas torque that of its cycles, and of the equations solved again?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from crankpin import gas_torque_harmonics
from crankpin.model import gas_torque
from rederivation import pressure as again

if TYPE_CHECKING:
    from numpy.typing import NDArray

TABLE = gas_torque_harmonics()


def column(name: str) -> NDArray[np.float64]:
    return np.array(TABLE[name].values)


def test_the_file_is_what_the_command_writes() -> None:
    computed = gas_torque.compute()
    assert TABLE.header == computed.header
    for name in ("cycle", "strokes", "order"):
        assert TABLE[name].values == computed[name].values
    for name in ("rod ratio", "imep", "peak pressure", "amplitude", "cosine", "sine"):
        # Six digits are printed: half a unit of the last, and its rounding on other machines.
        largest = 1.0 if name in ("cosine", "sine") else column(name)
        error = abs(column(name) - np.array(computed[name].values))
        assert (error <= 1e-5 * largest).all()


def test_orders_are_half_to_twelve_and_of_two_strokes_whole() -> None:
    assert set(TABLE["cycle"].values) == {*gas_torque.STATED}
    for name in gas_torque.STATED:
        chosen = (np.array(TABLE["cycle"].values) == name) & (column("rod ratio") == 0.3)
        step = 1.0 if (column("strokes")[chosen] == 2).all() else 0.5
        np.testing.assert_array_equal(column("order")[chosen], np.arange(step, 12 + step, step))
    amplitude = np.hypot(column("cosine"), column("sine"))
    np.testing.assert_allclose(column("amplitude"), amplitude, atol=2e-6)


@pytest.mark.parametrize("name", ["petrol, half load", "diesel, full load"])
def test_rows_are_those_of_the_equations_solved_again(name: str) -> None:
    bore, stroke, figures = gas_torque.STATED[name]
    crank = (stroke / 2, stroke / 2 / 0.3, 0.0)
    given = {"intake_closes_deg": -140.0, "exhaust_opens_deg": 130.0, "a": 6.908}
    given |= {"stoichiometric_ratio": 14.6, "heating_value": 43e6} | figures
    area = np.pi / 4 * bore**2
    ratio = given["compression_ratio"]
    closes, opens = np.radians([given["intake_closes_deg"], given["exhaust_opens_deg"]])
    charge = area * stroke / (ratio - 1) * again.chamber(closes, ratio, crank)
    air = given["intake_pressure"] * charge / (287.05 * given["charge_temperature"])
    fuel = air / given["excess_air"] / given["stoichiometric_ratio"]
    closed, *_ = again.wiebe({**given, "heat": float(fuel * given["heating_value"])}, crank, bore)
    opened = closed(np.array([opens]))[0]
    exhaust, intake = given["exhaust_pressure"], given["intake_pressure"]

    def pressure(theta: NDArray[np.float64]) -> NDArray[np.float64]:
        fall = 0.5 * (1 + np.cos(np.pi * (theta - opens) / (np.pi - opens)))
        after = np.where(theta < np.pi, exhaust + (opened - exhaust) * fall, exhaust)
        after = np.where(theta > 2 * np.pi, intake, after)
        return np.where(theta < opens, closed(np.minimum(theta, opens)), after)

    start, duration = np.radians([given["start_deg"], given["duration_deg"]])
    edges = [closes, start, start + duration, opens, np.pi, 2 * np.pi, closes + 4 * np.pi]
    orders = np.array([0.5, 1.0, 4.5, 12.0])
    mean, phasors = again.torque_phasors(pressure, np.array(edges), orders, bore, crank, 101325.0)
    phasors = phasors / (2 * np.pi * mean)
    for order, phasor in zip(orders, phasors, strict=True):
        chosen = np.array(TABLE["cycle"].values) == name
        chosen &= (column("rod ratio") == 0.3) & (column("order") == order)
        # Six digits of the largest.
        assert column("cosine")[chosen] == pytest.approx(phasor.real, abs=2e-6)
        assert column("sine")[chosen] == pytest.approx(-phasor.imag, abs=2e-6)
