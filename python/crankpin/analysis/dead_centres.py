"""Dead centres: where pistons are highest and lowest, their strokes and compression ratios."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin._support import inputs, labels
from crankpin._support.frames import Tabled
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.request import engine_core
from crankpin.model.engine import Engine  # noqa: TC001 - a field

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class DeadCentres(Tabled):
    """Ends of the travel of each piston of an engine.

    Made by :func:`crankpin.dead_centres`; arrays are of shape (n_cylinders,).
    """

    engine: Engine
    """The engine."""
    tdc_deg: NDArray[np.float64]
    """Crank angles at which pistons are highest, degrees in [0, 360)."""
    bdc_deg: NDArray[np.float64]
    """Crank angles at which pistons are lowest, degrees in [0, 360)."""
    stroke: NDArray[np.float64]
    """Travels of the pistons, m."""
    height: NDArray[np.float64]
    """Distances of the piston pins from the crank's axis along the bore at the highest point, m.

    Of infinite rods from the middle of the stroke.
    """
    compression_ratio: NDArray[np.float64] | None
    """Ratios of largest to smallest volume; None where that of cylinder 1 was not given."""

    @property
    def table(self) -> Table:
        """Angles, strokes and heights by cylinder, and compression ratios if they are known."""
        columns = [
            Column("cylinder", tuple(range(1, len(self.engine) + 1))),
            Column("TDC", self.tdc_deg, "°", decimals=3),
            Column("BDC", self.bdc_deg, "°", decimals=3),
            Column("stroke", self.stroke, "m", digits=7),
            Column("height", self.height, "m", digits=7),
        ]
        if self.compression_ratio is not None:
            columns.append(Column("compression ratio", self.compression_ratio, decimals=4))
        return Table(f"{labels.name_of(self.engine)}: dead centres", tuple(columns))


def dead_centres(engine: Engine, *, compression_ratio: float | None = None) -> DeadCentres:
    """Return where pistons are highest and lowest, their strokes and compression ratios.

    They differ between cylinders of an engine with link rods or pin offsets, whose crankpin stands
    beside the bore there.

    Parameters
    ----------
    engine : Engine
        The engine.
    compression_ratio : float, optional
        Ratio of largest to smallest volume of cylinder 1; those of the others follow, with equal
        pistons and heads equally far from the crank.

    Returns
    -------
    DeadCentres
        Crank angles, degrees, strokes and heights, m, and compression ratios.

    Raises
    ------
    InputError
        If a piston would touch its head.

    Examples
    --------
    >>> import crankpin as cp
    >>> five = cp.Engine.radial(
    ...     cp.Cylinder(0.06, 0.23, 1.0), 5, rods=cp.LinkRods(radius=0.052, length=0.178)
    ... )
    >>> cp.dead_centres(five, compression_ratio=6)
    5 cylinders: dead centres
    cylinder    TDC °    BDC °   stroke m   height m  compression ratio
           1        0  180.000       0.12       0.29             6.0000
           2   74.310  248.331  0.1201559  0.2879662             5.6154
           3  147.124  315.341  0.1205086  0.2893398             5.8868
           4  212.876   44.659  0.1205086  0.2893398             5.8868
           5  285.690  111.669  0.1201559  0.2879662             5.6154
    """
    core = engine_core(engine)
    ratio = inputs.optional_number("compression_ratio", compression_ratio)
    highest, lowest, height, stroke, ratios = zip(*core.dead_centres(ratio), strict=True)
    known = None if ratio is None else read_only(inputs.array("compression_ratio", ratios))
    return DeadCentres(
        engine=engine,
        tdc_deg=read_only(inputs.array("tdc_deg", highest)),
        bdc_deg=read_only(inputs.array("bdc_deg", lowest)),
        stroke=read_only(inputs.array("stroke", stroke)),
        height=read_only(inputs.array("height", height)),
        compression_ratio=known,
    )
