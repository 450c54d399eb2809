"""Balances: the picture of each kind."""

from __future__ import annotations

from typing import Any

from crankpin._support import inputs
from crankpin.analysis.balance import Balance
from crankpin.plot.axes import check_one_place
from crankpin.plot.dispatch import draw
from crankpin.plot.ellipses import ellipses
from crankpin.plot.spectrum import spectrum

KINDS = {"spectrum": spectrum, "ellipses": ellipses}


@draw.register(Balance)
def _balance(
    result: Balance,
    ax: Any = None,  # noqa: ANN401 - checked
    *,
    figure: Any = None,  # noqa: ANN401 - checked
    kind: str = "spectrum",
    **options: Any,  # noqa: ANN401 - of the kind
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    check_one_place(ax, figure)
    return KINDS[inputs.one_of("kind", kind, KINDS)](result, ax, figure, **options)
