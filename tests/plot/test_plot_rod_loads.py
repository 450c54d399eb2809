"""Do pictures of rod loads draw the loads, and shade where they reverse?"""

from __future__ import annotations

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from support.pictures import RODS

mpl.use("Agg")


def test_curves_and_shades_are_those_of_the_result() -> None:
    ax = RODS.plot(cylinder=2)
    lines = {line.get_label(): np.asarray(line.get_ydata()) for line in ax.lines}
    np.testing.assert_array_equal(lines["both"], RODS.rod_load[1])
    np.testing.assert_array_equal(lines["gas"], RODS.gas_load[1])
    np.testing.assert_array_equal(lines["inertia"], RODS.inertia_load[1])
    shaded = [patch for patch in ax.patches if patch.get_gid() == "crankpin reversal"]
    spans = [patch.get_window_extent().transformed(ax.transData.inverted()) for patch in shaded]
    tension = sum(to - begin for begin, to in RODS.tension_ranges_deg[1])
    lesser = min(tension, 360.0 - tension)
    assert sum(span.width for span in spans) == pytest.approx(lesser, abs=1e-6)
    assert RODS.reversal_deg[1] < lesser  # the longest of two
    for span in spans:
        middle = RODS.theta_deg.searchsorted(0.5 * (span.x0 + span.x1))
        assert (RODS.rod_load[1][middle] < 0.0) == (tension < 180.0)
    with pytest.raises(cp.InputError, match="1 to 2"):
        RODS.plot(cylinder=3)
