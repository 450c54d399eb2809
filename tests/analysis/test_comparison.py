"""Are two engines compared at the same orders, and what fell and rose named rightly?"""

from __future__ import annotations

import pickle

import crankpin as cp
import numpy as np
import pytest
from support import html_of, in_turn
from support.engines import I4, V6

SHAFTS = [
    cp.Shaft(ratio, [cp.Unbalance(0.003, z=0.15, angle_deg=-90)], x=x)
    for ratio, x in [(2, 0.08), (-2, -0.08)]
]
FITTED = I4.with_shafts(SHAFTS)


def test_both_balances_are_at_all_orders_that_either_needs() -> None:
    found = cp.compare(I4, V6, rpm=5000)
    needed = {*I4.balance(5000).orders, *V6.balance(5000).orders}
    assert set(found.orders) == needed
    assert found.before == I4.balance(5000, orders=found.orders)
    assert found.after == V6.balance(5000, orders=found.orders)
    assert found.rpm == 5000.0


def test_change_is_relative_to_before() -> None:
    found = cp.compare(I4, FITTED, rpm=5000, orders=[1, 2, 4])
    before, after = found.before.force.peak, found.after.force.peak
    change = found.change("force")
    assert change.tolist() == [0.0, after[1] / before[1] - 1.0, 0.0]
    back = cp.compare(I4, V6, rpm=5000, orders=[1, 2])
    lumped = cp.compare(cp.Engine.preset("v6-60-ebook"), "lumped", 10)
    stays = lumped.change("force")  # of other sums, with the same forces: no change but by rounding
    assert not stays.any()
    assert back.change("force").tolist() == [0.0, -1.0]  # a V6 has no force of order 2
    assert back.change().tolist() == [np.inf, np.inf]  # and an inline-4 no moment


def test_options_are_those_of_a_balance() -> None:
    options = {"orders": [1, 2], "spectrum": {1: 0.5, 2: 0.2}}
    found = cp.compare(I4, FITTED, 5000, **options)  # type: ignore[arg-type]
    assert found.after == FITTED.balance(5000, **options)  # type: ignore[arg-type]
    with pytest.raises(AttributeError, match="torque is not available"):
        found.change("torque")
    with pytest.raises(cp.InputError, match="quantity"):
        found.change("power")
    with pytest.raises(cp.InputError, match="before = 3"):
        cp.compare(3, I4, rpm=5000)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match="after = 3"):
        cp.compare(I4, 3, rpm=5000)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"after = 'i6': give a .*Engine.*, or \"lumped\""):
        cp.compare(I4, "i6", rpm=5000)  # type: ignore[arg-type]
    fit = cp.counterweights(V6)
    with pytest.raises(cp.InputError, match=r"after = .*: give its \.fitted, an engine"):
        cp.compare(V6, fit, rpm=5000)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"engines = .*: give its \.fitted, an engine"):
        cp.sweep([V6, fit], rpm=5000)  # type: ignore[list-item]


def test_the_table_has_what_matters_before_and_after() -> None:
    text = repr(cp.compare(I4, FITTED, rpm=5000, orders=[1, 2, 4]))
    title, header, *lines, loads = text.splitlines()
    assert title == "Inline-4 → Inline-4 with 2 balance shafts at 5000 rpm: peaks"
    assert header.split() == ["quantity", "order", "before", "after", "change", "%"]
    assert [line.split()[:4] for line in lines] == [
        ["shaking", "force,", "N", "2"],
        ["shaking", "force,", "N", "4"],
        ["shaking", "force,", "N", "all"],
        ["roll", "torque,", "N·m", "2"],
        ["roll", "torque,", "N·m", "4"],
        ["roll", "torque,", "N·m", "all"],
    ]
    assert loads == "Without gas pressure."
    assert repr(cp.compare(I4, V6, rpm=5000)).startswith("Inline-4 → V6 60°, shared pins at 5000")
    assert "<td>roll torque, N·m</td>" in html_of(cp.compare(I4, V6, rpm=5000))


def test_it_is_made_of_two_like_balances() -> None:
    found = cp.compare(I4, FITTED, rpm=5000)
    assert pickle.loads(pickle.dumps(found)) == found  # noqa: S301 - our own
    kind = cp.results.Comparison
    with pytest.raises(cp.InputError, match=r"use crankpin\.compare"):
        kind(I4, FITTED)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match="different orders or speeds"):
        kind(I4.balance(5000, orders=[1]), FITTED.balance(5000, orders=[2]))


@in_turn("seed", range(12))
def test_an_engine_that_is_lumped_differs_in_order_1_alone(seed: int) -> None:
    """For any rod ratio, offset and layout; with nothing that rotates, in none."""
    random = np.random.default_rng(seed)
    radius = 0.05
    cylinder = cp.Cylinder(
        radius, radius / random.uniform(0.2, 0.85), 0.4, pin_offset=random.uniform(0.0, 0.005)
    )
    throws = random.uniform(0.0, 360.0, 4)
    engine = cp.Engine.vee(
        cylinder,
        bank_angle_deg=random.uniform(10.0, 120.0),
        throws_deg=throws,
        spacing=0.1,
        rotating_mass=0.3,
    )
    both = cp.compare(engine, "lumped", 3000)
    for name in ("force", "moment"):
        before, after = getattr(both.before, name), getattr(both.after, name)
        # Equal but for rounding: amplitudes are handed over in place of computed ones.
        largest = float(before.peak.max())
        higher = np.array(both.orders) > 1
        np.testing.assert_allclose(
            after.xy[higher], before.xy[higher], rtol=0, atol=1e-14 * largest
        )
        assert abs(after.xy[0] - before.xy[0]).max() > 0.01 * largest
    still = engine.replace(rotating_mass=0.0)
    same = cp.compare(still, "lumped", 3000)
    np.testing.assert_allclose(
        same.after.force.xy, same.before.force.xy, rtol=0, atol=1e-14 * same.before.force.peak.max()
    )


def test_what_was_zero_has_no_change_in_tables() -> None:
    shown = cp.compare(cp.Engine.preset("v6-60"), cp.Engine.preset("i4"), rpm=3000)
    table = shown.table
    assert np.isinf(shown.change("force")).any()
    for before, after, cell in zip(
        table["before"].values, table["after"].values, table["change"].cells(), strict=True
    ):
        assert (cell == "–") == (before == 0.0 and after != 0.0)
    assert "inf" not in shown.to_csv() + table.text() + shown.to_latex()
