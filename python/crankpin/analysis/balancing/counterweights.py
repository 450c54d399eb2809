"""Counterweights that remove the most of what turns with the crankshaft at order 1."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels, optional
from crankpin._support.frozen import Frozen
from crankpin._support.quantities import QUANTITIES
from crankpin._support.tables import Shown, Table
from crankpin.analysis.balancing import correction_planes
from crankpin.analysis.balancing.first_order import (
    BayLoad,
    Ellipses,
    ForwardPart,
    bay_loads_of,
    ellipses_of,
    first_order,
)
from crankpin.analysis.balancing.fitting import Fit, external, internal
from crankpin.analysis.balancing.planes import turning
from crankpin.analysis.drawing import draw
from crankpin.analysis.request import engine_core
from crankpin.model.crankpins import bays
from crankpin.model.shafts import degrees

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from crankpin._support.inputs import Angles, Orders
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.balancing.correction_planes import Planes
    from crankpin.analysis.balancing.fitting import Minimise, Target
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Unbalance


NOTICEABLE = 1e-6
"""Part of what weights make that is beyond the errors of a fit."""


def counterweights(
    engine: Engine,
    *,
    planes: Planes,
    target: Target = "external",
    fraction: float | Mapping[str, float] = 1.0,
    minimise: Minimise = "squares",
    bound: float | Mapping[str, float] | None = None,
    angles_deg: Angles | Mapping[str, Angles] | None = None,
    length: float | None = None,
    reference_z: float | None = None,
) -> Counterweights:
    """Return the counterweights that remove the most of the forward force and moment of order 1.

    Parameters
    ----------
    engine
        The engine; counterweights that it has stay, and count.
    planes
        Where weights can be: ``"ends"``, at the first and the last cylinder; ``"webs"``, both webs
        of every throw, each midway between the crankpin and its main bearing (bearings are midway
        between neighbouring throws); a list of places z, m; or a mapping name → z.
    target
        ``"external"``: force and moment of the whole engine. ``"internal"``: force and moment that
        each throw brings upon its own two main bearings, by weights between these. That relieves
        bearings and crankshaft, and the engine as a whole too.
    fraction
        Part to remove, 1 for all: of both, or a mapping with ``"force"``, ``"moment"`` or both;
        what it leaves out does not matter. A factor κ of the reciprocating mass, besides all
        rotating mass, removes 2κ of what the pistons do: 52 % is ``fraction=1.04``.
    minimise
        Of weights that leave as little: ``"squares"`` for the least sum of squares of the planes'
        mass·radius, ``"largest"`` for the least largest.
    bound
        Largest mass·radius of a plane, kg·m: a number, or a mapping name → number with the planes
        that have one (needs SciPy where it binds).
    angles_deg
        Angles at which a plane can have weights, degrees from +x at θ = 0: a list for all planes,
        or a mapping name → list; any angle by default. The mass·radius of a plane is
        then the sum of its weights'.
    length
        Where weights cannot remove both, they leave the least |force|² + |moment/length|², m. By
        default the longest lever of a plane or cylinder, or, for internal targets, half of the
        distance between main bearings: what stays is then the least sum of squares of their loads.
    reference_z
        Plane about which external moments are taken, m; by default midway between the first and the
        last cylinder.

    Returns
    -------
    Counterweights

    Raises
    ------
    InputError
        If an argument is out of range.

    Notes
    -----
    Weights on the crankshaft change forward parts only, those that turn with it; what stays at best
    is the backward part. A weight u (kg·m, with its direction) at z makes the force u·ω² and
    the moment i(z − z₀)·u·ω². These are two equations, so that weights at two places remove any
    forward force and moment, and at more places there is a choice.

    Examples
    --------
    The cross-plane V8 needs nothing but counterweights:

    >>> import crankpin as cp
    >>> v8 = cp.counterweights(cp.Engine.preset("v8-crossplane"), planes="ends")
    >>> v8.exact, v8.vanishes
    (True, True)
    >>> [(name, round(weight.amount, 6)) for name, weight in v8.by_plane]
    [('front', 0.020397), ('rear', 0.020397)]
    >>> [round(weight.angle_deg, 6) for weight in v8.unbalances]
    [333.434949, 153.434949]
    >>> float(v8.balance(rpm=6000, orders=[1])[1].moment.peak)
    0.0
    """
    engine_core(engine)
    places = correction_planes.named(engine, planes)
    names = list(places)
    fit = Fit.checked(target, fraction, minimise, length, reference_z)
    found = (external if fit.target == "external" else internal)(
        engine,
        places,
        correction_planes.bounds(names, bound),
        correction_planes.angles(names, angles_deg),
        fit,
    )
    return Counterweights(engine, tuple(places.items()), fit, *found)


class PartVerdict(NamedTuple):
    """Verdicts on the two parts of a quantity: "vanishes", "remains" or "undecided"."""

    forward: str
    """Part that turns with the crank."""
    backward: str
    """Part that turns against the crank."""


class Remainder(NamedTuple):
    """Verdicts on what stays at order 1."""

    force: PartVerdict
    """Shaking force."""
    moment: PartVerdict
    """Rocking moment."""


class Counterweights(Frozen, Shown):
    """Counterweights fitted to an engine, and what they leave.

    Made by :func:`crankpin.counterweights`.

    Examples
    --------
    >>> import crankpin as cp
    >>> i3 = cp.counterweights(cp.Engine.preset("i3"), planes="ends")
    >>> i3.exact, i3.vanishes  # the backward half stays
    (True, False)
    >>> i3.verdicts.moment
    PartVerdict(forward='vanishes', backward='remains')
    """

    _fields: ClassVar[tuple[str, ...]] = (
        "before", "places", "fit", "by_plane", "exact", "missing",
    )  # fmt: skip

    before: Engine
    """The engine that was given."""
    places: tuple[tuple[str, float], ...]
    """Planes in which weights could be: names and places, m."""
    fit: Fit
    """What was wanted, checked."""
    by_plane: tuple[tuple[str, Unbalance], ...]
    """The weights, each with the name of its plane; planes without are left out."""
    exact: bool
    """True if the weights are proved to remove all that was wanted: by the rank of the equations of
    those with room within bounds and angles, not by the size of what stays."""
    missing: float
    """Part of what was wanted that they do not remove; 0 where they are exact."""

    def __init__(
        self,
        before: Engine,
        places: tuple[tuple[str, float], ...],
        fit: Fit,
        by_plane: tuple[tuple[str, Unbalance], ...],
        exact: bool,
        missing: float,
    ) -> None:
        if not isinstance(fit, Fit):
            raise InputError(f"fit = {inputs.shorten(fit)}: use crankpin.counterweights")
        weights = (*before.counterweights, *(weight for _, weight in by_plane))
        engine = before.with_counterweights(weights)
        self._set(
            before=before,
            places=places,
            fit=fit,
            by_plane=by_plane,
            exact=exact,
            missing=missing,
            engine=engine,
        )

    engine: Engine
    """The engine with these weights in addition to those it had."""

    @property
    def unbalances(self) -> tuple[Unbalance, ...]:
        """The weights fitted: kg·m, and angles at θ = 0."""
        return tuple(weight for _, weight in self.by_plane)

    @property
    def largest(self) -> float:
        """Largest mass·radius of a plane, kg·m."""
        sums: dict[str, float] = {}
        for name, weight in self.by_plane:
            sums[name] = sums.get(name, 0.0) + weight.amount
        return max(sums.values(), default=0.0)

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m."""
        plane = self.fit.reference_z
        return self.before.reference_z if plane is None else plane

    # --- what stays -----------------------------------------------------------------------------

    def balance(self, rpm: float, *, orders: Orders = "auto") -> Balance:
        """Return the balance of the engine with its weights.

        Parameters
        ----------
        rpm
            Crank speed.
        orders
            As in :meth:`Engine.balance`.
        """
        return self.engine.balance(rpm, orders=orders).about(self.reference_z)

    @property
    def residual(self) -> ForwardPart:
        """What stays of the forward force and moment, over ω²."""
        return ForwardPart(*turning(self.engine, 1, self.reference_z))

    @property
    def ellipses(self) -> Ellipses:
        """Ellipses that stay at order 1, over ω²."""
        return ellipses_of(self.engine, self.reference_z)

    @property
    def ellipses_before(self) -> Ellipses:
        """Ellipses of order 1 without the weights, over ω²."""
        return ellipses_of(self.before, self.reference_z)

    @property
    def verdicts(self) -> Remainder:
        """Verdicts on what stays at order 1.

        Backward parts are those of the engine before, which no counterweight changes, decided by
        :meth:`Engine.vanishing_orders`. Forward parts vanish where the weights are ``exact`` and
        were to remove all; where they are not, "remains" is a finding of floating point: more than
        a millionth of what the weights make.
        """
        decided = self.before.vanishing_orders([1], reference_z=self.reference_z)[1]
        now = first_order(self.engine, self.reference_z)
        found = {}
        for name in ("force", "moment"):
            before, after = getattr(decided, name), getattr(now, name)
            if self._scaled(name):
                forward = "vanishes" if self.fit.parts[name] == 1.0 else before.forward
            elif not self.by_plane:
                forward = before.forward
            else:
                size = NOTICEABLE * sum(weight.amount for weight in self.unbalances)
                if name == "moment":
                    size *= max(abs(z - self.reference_z) for _, z in self.places)
                forward = "remains" if abs(after.forward) > size else "undecided"
            found[name] = PartVerdict(forward, before.backward)
        return Remainder(**found)

    def _scaled(self, name: str) -> bool:
        """Return whether the forward part is exactly 1 − fraction of what it was."""
        parts = self.fit.parts
        if not self.exact or name not in parts:
            return False
        if self.fit.target == "external":
            return True
        # The engine's parts are sums over its bays, if all that rotates is in one of them, and
        # forces of bays have moments about the engine's plane.
        listed = bays(self.before)
        inside = all(
            any(bay.holds(weight.z) for bay in listed) for weight in self.before.counterweights
        )
        inside = inside and not self.before.shafts
        return inside and (name == "force" or parts.get("force") == parts["moment"])

    @property
    def vanishes(self) -> bool:
        """True if all force and moment of order 1 is proved to vanish.

        The forward parts by the rank of the equations, which the weights solve; the weights as
        rounded numbers leave :meth:`Engine.vanishing_orders` of the fitted engine undecided.
        """
        return all(word == "vanishes" for parts in self.verdicts for word in parts)

    @property
    def bay_loads(self) -> tuple[BayLoad, ...]:
        """What each throw brings upon its main bearings with the weights, over ω²."""
        return bay_loads_of(self.engine)

    @property
    def bay_loads_before(self) -> tuple[BayLoad, ...]:
        """What each throw brings upon its main bearings without the weights, over ω²."""
        return bay_loads_of(self.before)

    # --- tables ---------------------------------------------------------------------------------

    def to_pandas(self) -> pd.DataFrame:
        """Return the weights as a tidy table, one row a weight (needs pandas).

        Columns are plane, z (m), amount (kg·m) and angle_deg.
        """
        rows = [(name, *row) for (name, _), row in zip(self.by_plane, self._rows(), strict=True)]
        columns = ["plane", "z", "amount", "angle_deg"]
        return optional.data_frame(rows, columns=columns)

    def _rows(self) -> list[tuple[float, float, float]]:
        return [(weight.z, weight.amount, degrees(weight.angle_deg)) for weight in self.unbalances]

    @property
    def table(self) -> Table:
        """Table of the weights."""
        name = labels.name_of(self.before)
        note = "" if self.by_plane else "No weights are needed in these planes, or none help."
        names = [(plane,) for plane, _ in self.by_plane]
        rows = np.array(self._rows()).reshape(-1, 3)
        header = ["plane", "z m", "kg·m", "angle °"]
        return Table.from_rows(
            f"{name}: counterweights",
            header,
            names,
            rows,
            note=note,
            below=self.table_of_order_1(),
        )

    def table_of_order_1(self) -> Table:
        """Return the table of what order 1 does before and after: half axes over ω²."""
        rows, names = [], []
        verdicts = self.verdicts
        for place, quantity in enumerate(("force", "moment")):
            unit = QUANTITIES[quantity].unit_over_square
            for state, ellipses in (("before", self.ellipses_before), ("after", self.ellipses)):
                ellipse = ellipses[place]
                names.append((f"{QUANTITIES[quantity].words}, {unit}", state))
                rows.append([ellipse.major, abs(ellipse.minor)])
        words = [
            f"{part} {quantity} {getattr(getattr(verdicts, quantity), part)}"
            for quantity in ("force", "moment")
            for part in ("forward", "backward")
        ]
        header = ["order 1 over ω²", "", "longest", "shortest"]
        note = "; ".join(words) + "."
        if "undecided" in note and self.missing:
            note += f" Within {self.missing:.1e} of what was wanted."
        return Table.from_rows("What stays", header, names, np.array(rows), note=note)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        figure: Figure | SubFigure | None = None,
        kind: str = "summary",
        quantity: str | None = None,
        **style: Any,  # noqa: ANN401 - of lines
    ) -> Any:  # noqa: ANN401 - axes, or an array of axes
        """Draw the weights, and what order 1 does before and after; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones. ``"summary"`` draws the weights on them.
        figure
            Figure or SubFigure for the panels of ``"summary"``; by default a new one.
        kind
            ``"summary"``: panels of weights and of the ellipses of force and moment, those that
            are not zero; ``"weights"``: mass·radius of each plane over its place, with an arrow in
            its direction at θ = 0 seen from the flywheel, and below it arrows of the crankpins;
            ``"ellipses"``: what order 1 traces before and after.
        quantity
            ``"force"`` or ``"moment"``, for ``"ellipses"``; by default the one that is not zero.
        **style
            ``label`` and properties of matplotlib lines.
        """
        return draw(self, ax, figure=figure, kind=kind, quantity=quantity, **style)
