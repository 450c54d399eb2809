"""Ranking of engines by objectives over bank angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, cast

from crankpin._support import inputs
from crankpin._support.messages import Hint, suppressed
from crankpin._support.parameters import documented
from crankpin.analysis.arrangements.search import Arrangement, ArrangementSearch
from crankpin.analysis.ranking.objectives import LEFT, tie_tolerance
from crankpin.analysis.ranking.objectives import listed as listed_objectives
from crankpin.analysis.ranking.ranking import Ranking, chosen
from crankpin.analysis.sweeps.sweep import sweep
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.analysis.ranking.objectives import Measure
    from crankpin.analysis.sweeps.sweep import Engines
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Hold


@documented(sweep)
def rank(
    engines: Engines | Arrangement | Sequence[Arrangement] | ArrangementSearch,
    rpm: float,
    *,
    by: str | Measure | Sequence[str | Measure],
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    orders: Orders = "auto",
    rtol: float | None = None,
    spectrum: Spectrum | None = None,
    cylinder: Cylinder | None = None,
    spacing: float | None = None,
    refine: bool = False,
    tie_rtol: float = 1e-9,
) -> Ranking:
    """Rank engines by an objective, each at the bank angles with its smallest value.

    Parameters
    ----------
    engines : Engine, mapping of str to Engine, Arrangement, sequence of either or ArrangementSearch
        An engine, several, or a mapping name → engine, such as one for each firing order; or
        arrangements: some of a search, such as its :meth:`~ArrangementSearch.best`, or all of an
        :class:`ArrangementSearch`.
    rpm : float
        Crank speed, rpm.
    by : str, callable or sequence of these
        Quantity to minimise: the name of an objective (see Notes), several names with
        commas, a function that takes the :class:`Balance` of an engine at a bank angle and returns
        a number (NaN or inf for an engine to avoid), or a list of these; later ones break ties.
    bank_angle_deg : array_like, shape (n_angles,), optional
        Bank angles to choose from, degrees, 0 to 180; by default each engine is taken
        unchanged.
    hold : {"pins", "firing"}, optional
        Quantity that a change of bank angle does not change, as in :func:`crankpin.sweep`.
    cylinder : Cylinder, optional
        Cylinder of the engines of arrangements, as in :meth:`Arrangement.engine`.
    spacing : float, optional
        Spacing of the engines of arrangements, m, as there.
    refine : bool, default False
        Search between the bank angles too: each dip of the first objective is narrowed down to its
        lowest point. Dips that lie wholly between two neighbouring angles, with no given angle on
        their slopes below the next ones, are not found.
    tie_rtol : float, default 1e-09
        Values tie when they differ by at most this, relative to the largest value of the objective
        in the whole ranking.

    Returns
    -------
    Ranking
        The best first.

    Raises
    ------
    InputError
        If an argument is out of range, or an engine does not have the two banks to be turned.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, as with lengths in millimetres.

    Notes
    -----
    Objectives are named by their path from a balance: ``"total.moment.peak"`` minimises
    ``balance.total.moment.peak``. With given ``orders``, *total* is of the orders given.

    ``total.moment.peak``, ``total.force.peak``
        Longest rocking moment or shaking force of all orders together; a true extremum.
    ``total.moment.peak_xy``, ``total.force.peak_xy``
        The larger of the peaks about (along) x and y of all orders together.
    ``total.torque.peak``, ``total.crank_torque.peak``
        Largest roll torque on the block, or inertia torque on the crank.
    ``[1].moment.backward``, ``[1].force.backward``
        Magnitude of the first order's backward part, which the best counterweights on the main
        crankshaft leave.
    ``[2].moment.peak``, ``[2].force.peak``, ``[2].torque.peak``
        Largest of one order, any of which can be named; ``peak_xy``, ``forward`` and ``backward``
        as well. ``moment[2].peak`` is another name for ``[2].moment.peak``.
    ``unevenness_deg``
        Root mean square difference of the firing intervals from equal ones, in the most even
        four-stroke order that the crank allows; up to 16 cylinders.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> orders = ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
    >>> ranking = cp.rank(
    ...     {order: cp.Engine.preset(f"ijesc-v6-{order}") for order in orders},
    ...     rpm=5000,
    ...     bank_angle_deg=np.arange(10, 180, 10),
    ...     hold="pins",
    ...     by=["[1].moment.backward", "[2].moment.peak"],
    ... )
    >>> for choice in ranking:
    ...     print(choice.name, choice.bank_angles_deg, np.round(choice.values, 1))
    1-6-5-4-3-2 (150.0,) [   0.  1160.3]
    1-3-5-2-4-6 (90.0,) [   0.  1698.9]
    1-4-5-2-3-6 (30.0,) [   0.  2009.8]
    1-5-3-6-2-4 (10.0,) [717.3 415.6]

    A function takes the balance of an engine at an angle, and ``refine`` searches between the
    angles:

    >>> (best,) = cp.rank(
    ...     cp.Engine.preset("ijesc-v6-1-6-5-4-3-2"),
    ...     rpm=5000,
    ...     orders=[1, 2, 4, 6],
    ...     bank_angle_deg=np.arange(10, 180, 10),
    ...     hold="pins",
    ...     by=lambda balance: np.hypot(*balance.total.moment.peak_xy),
    ...     refine=True,
    ... )
    >>> round(best.bank_angles_deg[0], 3)
    140.657
    """
    ranked_by = listed_objectives(by)
    tolerance = tie_tolerance(tie_rtol)
    between = inputs.flag("refine", refine)
    if between and bank_angle_deg is None:
        hint = Hint.of("searches between bank angles; give `bank_angle_deg`")
        raise inputs.rejected("refine", True, hint)
    of_engines = _engines(engines, cylinder, spacing)
    with suppressed("mean piston speed"):
        swept = sweep(
            of_engines,
            rpm=inputs.number("rpm", rpm),
            bank_angle_deg=(
                None if bank_angle_deg is None else inputs.vector("bank_angle_deg", bank_angle_deg)
            ),
            hold=hold,
            orders=orders,
            rtol=rtol,
            spectrum=spectrum,
        )
        values = [objective.values(swept) for objective in ranked_by]
        choices = chosen(swept, ranked_by, values, tolerance, refine=between)
    inputs.warn_of_units(swept.mean_piston_speed)
    bare = tuple(objective.bare() for objective in ranked_by)
    if any(ratio < 0 for engine in swept.engines for _, _, ratio in engine._core.cranks[0]):
        # There counterweights on other cranks reach it.
        bare = tuple(
            objective._replace(words=objective.words.removesuffix(LEFT)) for objective in bare
        )
    return Ranking(swept, bare, tuple(values), choices)


def _engines(
    engines: Engines | Arrangement | Sequence[Arrangement] | ArrangementSearch,
    cylinder: object,
    spacing: object,
) -> Engines:
    """Return engines, or those of arrangements."""
    if isinstance(engines, ArrangementSearch) and len(engines) > inputs.MOST_ITEMS:
        raise inputs.faulty(
            "engines",
            f"is a search with {len(engines)} bank angles, more than {inputs.MOST_ITEMS}",
            "give some of them, such as its best(count=100) or within(60, 61)",
        )
    if isinstance(engines, Arrangement):
        engines = [engines]
    is_search = isinstance(engines, ArrangementSearch)
    if not isinstance(engines, (Engine, Mapping, ArrangementSearch)):
        engines = inputs.items("engines", engines, "give crankpin.Engine objects or arrangements")
    entries = [] if isinstance(engines, (Engine, Mapping)) else list(engines)
    if not entries and not isinstance(engines, (Engine, Mapping)):
        where = "the search has no bank angle in its window" if is_search else "give at least one"
        raise inputs.rejected("engines", [], where)
    arrangements = [one for one in entries if isinstance(one, Arrangement)]
    if not arrangements:
        for name, value in (("cylinder", cylinder), ("spacing", spacing)):
            if value is not None:
                hint = "is for arrangements; engines have their own, leave it out"
                raise inputs.rejected(name, value, hint)
        return cast("Engines", [engines] if isinstance(engines, Engine) else engines)
    for one in entries:
        if not isinstance(one, Arrangement):
            raise inputs.rejected("engines", one, "give arrangements alone, or engines alone")
    for name, value in (("cylinder", cylinder), ("spacing", spacing)):
        if value is None:
            raise inputs.rejected(name, None, "arrangements need one, as Arrangement.engine does")
    return {
        f"arrangement {k}, {one.bank_angle_deg:.6g}°": one.engine(cylinder, spacing=spacing)  # type: ignore[arg-type]
        for k, one in enumerate(arrangements)
    }
