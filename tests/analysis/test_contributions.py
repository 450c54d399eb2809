"""Do the parts of an engine add up to its balance?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.contributions import contributions, phasors
from support.engines import I4, OFFSET, V6

ORDERS = (1, 2, 3, 4, 6)
FITTED = V6.replace(cylinder=OFFSET, rotating_mass=[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]).replace(
    counterweights=[cp.Unbalance(0.02, 0.0, 180, pin=1), cp.Unbalance(0.01, 0.3, "360/7")],
    shafts=[
        cp.Shaft(-1, [cp.Unbalance(0.01, 0.0, 30), cp.Unbalance(0.02, 0.2, 60)], x=0.1, y=0.05),
        cp.Shaft(2, [cp.Unbalance(0.003, 0.1)], x=-0.1),
    ],
)


def check(engine: cp.Engine, quantity: str, **options: Any) -> None:  # noqa: ANN401
    balance = engine.balance(3000, **{"orders": ORDERS} | options)
    parts = contributions(balance, quantity)
    whole = phasors(balance, quantity)
    largest = max(abs(part.phasors).max() for part in parts)
    total = np.sum([part.phasors for part in parts], axis=0)
    # Rounding of as many terms as there are parts, in angles too.
    np.testing.assert_allclose(total, whole, atol=1e-14 * len(parts) * largest, rtol=0)


@pytest.mark.parametrize("quantity", ["force", "moment", "torque", "crank_torque"])
@pytest.mark.parametrize("engine", [I4, V6, FITTED, cp.Engine.preset("w12")])
def test_the_parts_add_up_to_the_balance(engine: cp.Engine, quantity: str) -> None:
    check(engine, quantity)


@pytest.mark.parametrize("options", [{}, {"spectrum": {1: 0.5, 2: 0.1 + 0.2j}}])
@pytest.mark.parametrize("quantity", ["force", "moment"])
def test_they_have_the_balance_s_plane_and_spectrum(quantity: str, options: Any) -> None:  # noqa: ANN401
    check(FITTED.replace(reference_z=-0.3), quantity, **options)


def test_parts_are_named_by_cylinder_and_grouped_by_bank() -> None:
    parts = contributions(FITTED.balance(3000, orders=ORDERS), "force")
    assert [part.part for part in parts] == ["1", "2", "3", "4", "5", "6", "W1", "W2", "S1", "S2"]
    assert [part.group for part in parts[:2]] == ["right", "left"]
    assert [part.group for part in parts[6:]] == ["counterweights"] * 2 + ["balance shafts"] * 2
    assert parts[0].phasors.shape == (2, len(ORDERS))
    second = parts[-1].phasors  # a shaft of ratio 2 acts at order 2 alone, with the crank
    assert np.flatnonzero(second[0]).tolist() == [1]
    assert not second[1].any()
