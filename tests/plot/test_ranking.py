"""Are rings of a ranking on their curves, and all engines in the picture? Points of a search?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
from support.engines import I4, V6
from support.pictures import BANK_ANGLES, FAMILY, ORDERS, V8
from support.reading import legend_texts, marks, series, title_of

NAMED = dict(zip(ORDERS, FAMILY, strict=True))


def test_curves_are_the_values_and_rings_are_on_them() -> None:
    ranking = cp.rank(
        NAMED,
        rpm=5000,
        bank_angle_deg=BANK_ANGLES,
        hold="pins",
        by="total.moment.peak",
        refine=True,
    )
    ax = ranking.plot()
    choices = {choice.name: choice for choice in ranking}
    for line, name, values in zip(series(ax), ranking.names, ranking.values, strict=True):
        x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        np.testing.assert_array_equal(y[np.isin(x, BANK_ANGLES)], values)
        assert (np.diff(x) > 0.0).all()
        # Best angles between the given ones are points of the curve.
        for angle in choices[name].bank_angles_deg:
            assert (angle, choices[name].value) in zip(x, y, strict=True)
    rings = {(angle, each.value) for each in ranking for angle in each.bank_angles_deg}
    assert any(angle not in BANK_ANGLES for angle, _ in rings)
    assert set(marks(ax)["o"]) == rings
    assert legend_texts(ax) == [*ORDERS, "best bank angle"]
    best = ranking[0].bank_angles_deg[0]
    assert [text.get_text() for text in ax.texts] == [f"{best:g}°"]
    assert title_of(ax).split("\n") == [
        "4 engines",
        "longest rocking moment, all orders, 5000 rpm",
        "pins held as the bank angle changes",
    ]


def test_engines_without_bank_angles_are_listed_whatever_their_banks() -> None:
    """Among vees, engines of one bank used to be left out."""
    engines = [I4, V6, V8, cp.Engine.preset("i5"), cp.Engine.preset("w12")]
    ranking = cp.rank(engines, rpm=5000, by="total.moment.peak")
    ax = ranking.plot()
    (line,) = series(ax)
    np.testing.assert_array_equal(line.get_xdata(), [choice.value for choice in ranking])
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert names == [choice.name for choice in ranking]
    first = [(choice.value, k) for k, choice in enumerate(ranking) if choice.place == 1]
    assert marks(ax)["o"] == first
    assert ax.get_xlabel() == "longest rocking moment, N·m"


def test_of_many_engines_the_best_are_named() -> None:
    cylinders = [V6.cylinders[0].replace(reciprocating_mass=0.3 + 0.01 * k) for k in range(30)]
    engines = {f"engine {k}": V6.replace(cylinder=each) for k, each in enumerate(cylinders)}
    over = cp.rank(engines, rpm=5000, bank_angle_deg=[60, 90], hold="pins", by="total.moment.peak")
    ax = over.plot()
    assert legend_texts(ax) == ["0", "1", "2", "3", "4", "25 others", "best bank angle"]
    assert len(series(ax)) == 30
    ax = cp.rank(engines, rpm=5000, by="total.moment.peak").plot()
    assert len(ax.get_yticklabels()) == 24
    assert "6 more engines not shown" in title_of(ax)


def test_values_that_are_not_finite_leave_gaps() -> None:
    def measure(balance: cp.results.Balance) -> float:
        return np.nan if balance.engine.bank_angle_deg > 90 else balance.total.moment.peak

    ranking = cp.rank(V6, rpm=5000, bank_angle_deg=[60, 90, 120], hold="pins", by=measure)
    (line,) = series(ranking.plot())
    assert np.isnan(np.asarray(line.get_ydata())).tolist() == [False, False, True]


def test_points_of_a_search_are_its_arrangements() -> None:
    found = cp.search_arrangements(10)
    ax = found.plot()
    (line,) = series(ax)
    np.testing.assert_array_equal(line.get_xdata(), [each.bank_angle_deg for each in found])
    np.testing.assert_array_equal(line.get_ydata(), [max(each.second_order) for each in found])
    assert title_of(ax) == "V10\n46 bank angles without backward moment, firing held"
    ax = found.plot(label="ten")
    cp.search_arrangements(12).plot(ax, label="twelve")
    assert legend_texts(ax) == ["ten", "twelve"]
