"""Counterweights that minimise the forward part of order 1."""

from __future__ import annotations

import itertools
from functools import cached_property
from typing import TYPE_CHECKING

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Frames, Tabled
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.record import read_only
from crankpin._support.tables import Table
from crankpin.analysis.balance import over_square
from crankpin.analysis.balancing import planes as correction_planes
from crankpin.analysis.balancing.fitting import Fit, bay_loads, fitted, left_by, warn_of_appearing
from crankpin.analysis.request import engine_core
from crankpin.model import checks
from crankpin.model.crankpins import bays
from crankpin.model.shafts import with_more

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from crankpin._support.inputs import Angles
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.balancing.fitting import Keep, Minimise, Target
    from crankpin.analysis.balancing.planes import Planes
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Unbalance


NOTICEABLE = 1e-6
"""Part of what weights exert that is beyond the errors of a fit."""


def counterweights(
    engine: Engine,
    *,
    planes: Planes = "webs",
    target: Target = "external",
    keep: Keep = "vanishing",
    factor: float | Mapping[str, float | None] | None = None,
    minimise: Minimise = "squares",
    bound: float | Mapping[str, float] | None = None,
    angles_deg: Angles | Mapping[str, Angles] | None = None,
    length: float | None = None,
) -> Counterweights:
    """Return the counterweights that minimise the parts of order 1 that turn with their cranks.

    Parameters
    ----------
    engine : Engine
        The engine; counterweights that it has stay, and count.
    planes : {"webs", "ends"}, sequence of float or mapping of str to float, default "webs"
        Where weights can be: ``"webs"``, both webs of every throw, each midway between the crankpin
        and its main bearing (bearings are midway between neighbouring throws); ``"ends"``, at the
        first and the last cylinder, both on every crank as fast as the main one; a list of places
        z, m; or a mapping name → z. Those are on the main crank; ``(z, crank)`` in place of z is on
        another, by its index.
    target : {"external", "internal", "half cranks"}, default "external"
        ``"external"`` relieves the mounts, ``"internal"`` every throw's own main bearings, ``"half
        cranks"`` those of each half of a crank. External are force and moment of the whole engine;
        internal those that each throw exerts on its own two main bearings, by weights between
        these, which relieves bearings and crankshaft, or each half of a crank, in front of the main
        bearing in its middle and behind it.
    keep : {"vanishing"} or sequence of {"force", "moment"}, default "vanishing"
        Sums of the whole engine that weights of throws or half cranks do not change: those that
        vanish, so that a balanced engine stays so, or those named; an empty list for none.
    factor : float or mapping of str to float or None, optional
        Share of the reciprocating mass that is balanced, besides all rotating mass; by default
        what removes all of the forward part, 0.5 without pin offset. As by
        :func:`crankpin.bob_weight`, 0.52 leaves 4 % of the pistons' forward part turned round. A
        number for both, or a mapping with ``"force"``, ``"moment"`` or both; what it leaves out
        does not matter. In a mapping None is the default: all of the forward part.
    minimise : {"squares", "largest"}, default "squares"
        Among weights that leave as little ``"squares"`` minimises the sum of squares of the planes'
        mass·radius, ``"largest"`` the largest.
    bound : float or mapping of str to float, optional
        Largest mass·radius of a plane, kg·m. A number, or a mapping name → number with the planes
        that have one.
    angles_deg : sequence of number or str, or mapping of str to these, optional
        Angles at which a plane can have weights, degrees from +x at θ = 0; by default any. A list
        for all planes, or a mapping name → list, at most 10 000 in all. The mass·radius of
        a plane is then the sum of its weights'.
    length : float, optional
        Where weights cannot remove both, they leave the least ``|force|² + |moment/length|²``, m.
        By default the longest lever of a plane or cylinder, or, for internal targets, half of the
        distance between main bearings: the sum of squares of their loads is then least.

    Returns
    -------
    Counterweights
        The weights, the engine with them, and the residual.

    Raises
    ------
    InputError
        If an argument is out of range.

    Warns
    -----
    UserWarning
        If a bound or a place seems to be in another unit, or an order that vanishes appears with
        the weights.

    Notes
    -----
    Weights on a crankshaft change parts only that turn with it: forward ones on the main crank, of
    which the best residual is the backward part, backward ones on a crank that turns against it. Of
    several cranks of one sense each removes what it carries itself, so that its roll torque about
    other axes goes too, and an equal share of what all else exerts in that sense. A weight u
    (kg·m, with its direction) at z makes the force u·ω² and the moment i(z − z₀)·u·ω². These are
    two equations of a sense, so that weights at two places remove any force and moment in it, and
    at more places there is a choice.

    Examples
    --------
    The cross-plane V8 needs nothing but counterweights:

    >>> import crankpin as cp
    >>> v8 = cp.counterweights(cp.Engine.preset("v8-crossplane"), planes="ends")
    >>> v8.exact, v8.vanishes
    (True, True)
    >>> [(name, round(weight.amount, 6)) for name, weight in v8.by_plane]
    [('front', 0.020397), ('rear', 0.020397)]
    >>> [round(weight.angle_deg, 6) for weight in v8.hardware]
    [333.434949, 153.434949]
    >>> float(v8.fitted.balance(rpm=6000)[1].moment.peak)
    0.0
    """
    core = engine_core(engine)
    places = correction_planes.named(engine, planes)
    names = list(places)
    fit = Fit.checked(target, factor, minimise, length, keep)
    limits = correction_planes.bounds(names, bound)
    checks.bounds(core, limits.values())
    checks.place(core, "length", fit.length, middle=0.0)
    allowed = correction_planes.angles(names, angles_deg)
    result = Counterweights(
        engine,
        tuple((name, place.z) for name, place in places.items()),
        fit,
        *fitted(engine, places, limits, allowed, fit),
        tuple(place.crank for place in places.values()),
    )
    warn_of_appearing(engine, with_more(core, result.hardware))
    return result


class Counterweights(Tabled):
    """Counterweights fitted to an engine, and the residual.

    Made by :func:`crankpin.counterweights`.

    Examples
    --------
    >>> import crankpin as cp
    >>> i3 = cp.counterweights(cp.Engine.preset("i3"), planes="ends")
    >>> i3.exact, i3.vanishes  # the backward half stays
    (True, False)
    >>> dict(i3.verdicts["moment"])
    {'forward': 'vanishes', 'backward': 'remains'}
    """

    engine: Engine
    """The engine to be balanced."""
    places: tuple[tuple[str, float], ...]
    """Planes in which weights could be: names and places, m."""
    fit: Fit
    """Checked request."""
    by_plane: tuple[tuple[str, Unbalance], ...]
    """The weights, each with the name of its plane; planes without are left out."""
    exact: bool
    """True if the weights are proved to remove all that was wanted: by the rank of the equations of
    those with room within bounds and angles, not by the size of the residual."""
    missing: float
    """Share of the target that they do not remove; 0 if they are exact."""
    cranks: tuple[int, ...] = ()
    """Index of the crank of each place; 0 is the main one."""

    def __post_init__(self) -> None:
        if not isinstance(self.fit, Fit):
            raise inputs.rejected("fit", self.fit, "use crankpin.counterweights")

    @property
    def hardware(self) -> tuple[Unbalance, ...]:
        """The weights fitted: kg·m, and angles at θ = 0."""
        return tuple(weight for _, weight in self.by_plane)

    @cached_property
    def fitted(self) -> Engine:
        """The engine with these weights in addition to those it has."""
        return self.engine.with_counterweights((*self.engine.counterweights, *self.hardware))

    @property
    def largest(self) -> float:
        """Largest mass·radius of a plane, kg·m."""
        sums: dict[str, float] = {}
        for name, weight in self.by_plane:
            sums[name] = sums.get(name, 0.0) + weight.amount
        return max(sums.values(), default=0.0)

    # --- residual --------------------------------------------------------------------------------

    @cached_property
    def residual(self) -> Balance:
        """Order 1 of the engine with the weights, over ω²: at 1 rad/s, N are kg·m."""
        return over_square(self.fitted, [1])

    @cached_property
    def verdicts(self) -> Mapping[str, Mapping[str, str]]:
        """Quantity → part → verdict on the residual at order 1.

        Verdicts are "vanishes", "remains" or "undecided", on the forward and the backward part of
        ``"force"`` and ``"moment"``. Parts that no crank with planes turns with are those of the
        engine, decided by :meth:`Engine.vanishing_orders`. Others vanish where the weights are
        ``exact`` and were to remove all; where they are not, "remains" is a finding of floating
        point: more than a millionth of what the weights exert.
        """
        decided = self.engine.vanishing_orders([1])
        ratios = [ratio for _, _, ratio in engine_core(self.engine).cranks[0]]
        weighed = {ratios[crank] for crank in self.cranks}
        return read_only(
            {
                name: {
                    part: self._verdict(name, part)
                    if ratio in weighed
                    else getattr(getattr(decided, name), part)[1]
                    for part, ratio in (("forward", 1), ("backward", -1))
                }
                for name in PLANE_VECTORS
            }
        )

    def _verdict(self, name: str, part: str) -> str:
        """Return the verdict on a part that weights change."""
        if self._meets(name):
            factor = dict(self.fit.parts)[name]
            if factor is None:
                return "vanishes"
            left = left_by(self.engine, factor).vanishing_orders([1])
            return str(getattr(getattr(left, name), part)[1])
        before = str(getattr(getattr(self.engine.vanishing_orders([1]), name), part)[1])
        if not self.by_plane or (self._keeps(name) and before == "vanishes"):
            return before
        size = NOTICEABLE * sum(weight.amount for weight in self.hardware)
        if name == "moment":
            size *= max(abs(z - self.engine.reference_z) for _, z in self.places)
        stays = abs(complex(getattr(getattr(self.residual[1], name), part)))
        return "remains" if stays > size else "undecided"

    def _keeps(self, name: str) -> bool:
        """Return whether the weights were to leave a sum of the engine that vanishes as it is."""
        keep = self.fit.keep
        return self.fit.target != "external" and (keep is None or name in keep)

    def _meets(self, name: str) -> bool:
        """Return whether the weights remove exactly the target."""
        parts = dict(self.fit.parts)
        if not self.exact or name not in parts:
            return False
        if self.fit.target == "external":
            return True
        # The engine's parts are sums over its bays, if all that rotates is in one of them, and
        # forces of bays have moments about the engine's plane.
        all_bays = bays(self.engine)
        inside = all(
            any(bay.holds(weight.z) for bay in all_bays) for weight in self.engine.counterweights
        )
        # What pistons of other cranks exert in a sense is in none of its bays.
        inside = inside and not self.engine.shafts and len(self.engine._core.cranks[0]) == 1
        return inside and (
            name == "force" or ("force" in parts and parts["force"] == parts["moment"])
        )

    @property
    def vanishes(self) -> bool:
        """True if all force and moment of order 1 is proved to vanish.

        Those that weights change by the rank of the equations, which the weights solve; the weights
        as rounded numbers leave :meth:`Engine.vanishing_orders` of the fitted engine undecided.
        """
        return all(
            word == "vanishes" for parts in self.verdicts.values() for word in parts.values()
        )

    @property
    def bay_loads(self) -> NDArray[np.complex128]:
        """Force (kg·m) and moment (kg·m²) of each throw on its main bearings, over ω².

        What turns with its crank: (n_throws, 2), crank by crank from front to flywheel, with the
        weights; moments about the throw's place.
        """
        return bay_loads(self.fitted)

    # --- tables ---------------------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Places, amounts and angles of the weights."""
        heads = ("plane", ("z", "m"), ("amount", "kg·m"), ("angle", "°"))
        rows = [
            (plane, weight.z, weight.amount, inputs.degrees(weight.angle_deg))
            for (plane, _), weight in zip(self.by_plane, self.hardware, strict=True)
        ]
        note = "" if self.by_plane else "No weights are needed in these planes, or none help."
        title = f"{labels.name_of(self.engine)}: counterweights"
        return Table.from_rows(title, heads, rows, note=note)

    @property
    def frames(self) -> Frames:
        """``table``; ``residual``: what order 1 does before and after, over ω²."""
        return self._frames(residual=self._order_1)

    def _order_1(self) -> Table:
        states = {"before": over_square(self.engine, [1]), "after": self.residual}
        rows = []
        for name, (state, balance) in itertools.product(PLANE_VECTORS, states.items()):
            vector, kind = getattr(balance[1], name), QUANTITIES[name]
            head = units.headed(kind.words, kind.unit_over_square)
            rows.append((head, state, float(vector.peak), abs(vector.minor)))
        row_units = [QUANTITIES[name].unit_over_square for name in PLANE_VECTORS for _ in states]
        core = engine_core(self.engine)
        torques = {
            state: float(abs(_core.roll_torque(engine_core(bare), 1, None)))
            for state, bare in (
                ("before", self.engine.with_cycle(None)),
                ("after", self.fitted.with_cycle(None)),
            )
        }
        if any(torques.values()):
            unit = QUANTITIES["torque"].unit_over_square
            head = units.headed(f"roll torque{labels.about_axis(core.cranks[0])}", unit)
            row_units += [unit] * len(torques)
            rows += [(head, state, torque, 0.0) for state, torque in torques.items()]
        words = [
            f"{part} {quantity} {verdict}"
            for quantity, parts in self.verdicts.items()
            for part, verdict in parts.items()
        ]
        note = "; ".join(words) + "."
        if "undecided" in note and self.missing:
            note += f" {100.0 * self.missing:.3g} % of what was wanted is not removed."
        title = "Residual of order 1, half axes over ω²"
        heads = ["quantity", "state", "longest", "shortest"]
        return Table.from_rows(title, heads, rows, note=note, row_units=row_units)
