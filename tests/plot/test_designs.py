"""Do pictures of designs show the values over bank angle, and ring the designs?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.plot.style import MARK, SERIES
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from support.engines import CYLINDER

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def design(cylinders: int, layout: str, by: Any, **given: Any) -> cp.results.Designs:  # noqa: ANN401
    given = {"cylinder": CYLINDER, "spacing": 0.1, "rpm": 6000.0, "by": by} | given
    return cp.design(cylinders, layout=layout, **given)  # type: ignore[arg-type]


V10 = design(10, "vee", "[1].moment.peak", bank_angle_deg=72)
V6 = design(
    6, "vee", "[1].moment.backward", bank_angle_deg=(40, 100), even_firing=True, shared_pins=False
)
I5 = design(5, "inline", "[1].moment.peak", even_firing=True)


def of(ax: Axes, gid: str) -> list[Any]:
    return [line for line in ax.lines if line.get_gid() == gid]


@pytest.mark.parametrize("found", [V10, V6], ids=["all angles", "a range"])
def test_curves_are_the_objective_over_bank_angle(found: cp.results.Designs) -> None:
    ax = found.plot(count=3)
    curves = of(ax, SERIES)
    assert len(curves) == 3
    for k, curve in enumerate(curves):
        angles, values = curve.get_data()
        np.testing.assert_array_equal(values, found.over_bank_angle(angles, 3)[k])
    low, high = (40.0, 100.0) if found is V6 else (0.0, 180.0)
    assert ax.get_xlim() == (low, high)
    rings = [tuple(map(float, np.ravel(ring.get_data()))) for ring in of(ax, MARK)]
    assert rings == [(each.bank_angle_deg, each.value) for each in found[:3]]
    (legend,) = [ax.get_legend()]
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert names[0] == ("0-120-240° split −60°" if found is V6 else "0-144-216-288-72°")
    assert names[-1] == "design"
    assert ax.get_title(loc="left").startswith("V6, 3" if found is V6 else "V10, 3 of 8")


def test_a_single_design_is_one_design() -> None:
    alone = design(6, "vee", "total.moment.peak", bank_angle_deg=(28, 146))
    assert alone.plot().get_title(loc="left").startswith("V6, 1 design\n")


def test_designs_without_banks_stand_below_each_other() -> None:
    ax = I5.plot(Figure().subplots(), count=8, color="red")
    (dots,) = of(ax, SERIES)
    values, rows = dots.get_data()
    assert values.tolist() == [each.value for each in I5]
    assert rows.tolist() == list(range(8))
    assert dots.get_color() == "red"
    assert ax.get_yticklabels()[0].get_text() == "0-144-216-288-72°"
    assert ax.get_legend() is None
    assert plt.get_fignums() == []


def test_dips_of_one_curve_are_drawn_on_it() -> None:
    found = design(2, "vee", "[2].force.peak", bank_angle_deg=(10, 170))
    assert len(found) > 1
    ax = found.plot(label="twin")
    assert len(of(ax, SERIES)) == 1
    assert len(of(ax, MARK)) == min(len(found), 4)


@pytest.mark.parametrize("count", [0, -1, 1.5])
def test_a_number_of_designs_is_needed(count: Any) -> None:  # noqa: ANN401
    with pytest.raises(cp.InputError, match="count"):
        I5.plot(count=count)
    assert plt.get_fignums() == []
