"""Residual of an engine's balance when its parts deviate from their figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._support import inputs, lazy
from crankpin._support import progress as progress_bar
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.request import Request, engine_core
from crankpin.analysis.tolerances.samples import Tolerances, names_of
from crankpin.analysis.tolerances.spreads import Distribution, Spreads

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Orders
    from crankpin._support.progress import Progress
    from crankpin.model.engine import Engine

MOST_SEEDS = 2**64
MOST_SAMPLES = 10**9
"""Samples of one call; memory may allow fewer."""


def tolerances(
    engine: Engine,
    rpm: float,
    *,
    reciprocating_mass: ArrayLike = 0.0,
    rotating_mass: ArrayLike = 0.0,
    crank_radius: ArrayLike = 0.0,
    pin_deg: ArrayLike = 0.0,
    z: ArrayLike = 0.0,
    rod_length: ArrayLike = 0.0,
    distribution: Distribution = "normal",
    pins: Iterable[Iterable[int]] | None = None,
    samples: int = 10_000,
    seed: int | np.random.SeedSequence | np.random.Generator = 0,
    by: str | Sequence[str] | None = None,
    orders: Orders = "auto",
    rtol: float | None = None,
    torque: bool = True,
    progress: Progress = False,
) -> Tolerances:
    """Return the residual force, moment and torque when parts deviate from their figures.

    Monte Carlo: each sample is an engine whose figures are drawn independently around the nominal
    ones, and whose balance is evaluated without linearisation. Sums that the layout cancels, such
    as all first and second orders of an inline-6, are due to tolerances alone.

    Parameters
    ----------
    engine : Engine
        The nominal engine; its counterweights and balance shafts are part of every sample.
    rpm : float
        Crank speed, rpm.
    reciprocating_mass, rotating_mass : array_like, default 0.0
        Spreads of the masses of each cylinder, kg: a number for all, or one for each cylinder.
        A rotating mass may deviate where the nominal one is zero, as of a balanced throw.
    crank_radius : array_like, default 0.0
        Spread of the crank radius of each crankpin, m: a number for all, or one for each.
        Cylinders on one pin deviate together, with what is fixed to it.
    pin_deg : array_like, default 0.0
        Spread of the angle of each crankpin, degrees: a number for all, or one for each.
    z : array_like, default 0.0
        Spread of the place of each cylinder along the crank, m.
    rod_length : array_like, default 0.0
        Spread of each rod's length between its centres, m.
    distribution : {"normal", "uniform"}, default "normal"
        ``"normal"`` takes spreads as standard deviations, ``"uniform"`` as half widths.
    pins : sequence of sequence of int, optional
        Numbers of the cylinders on each crankpin, such as ``[[1, 2], [3, 4]]``. By default
        cylinders of different banks share one if their pins point the same way and have one
        radius, and their places are less than a crank radius apart, as in :func:`bob_weight`.
    samples : int, default 10000
        Number of samples.
    seed : int, SeedSequence or Generator, default 0
        Seed of the random numbers, 0 to 2⁶⁴ − 1. Or a NumPy ``SeedSequence`` or ``Generator``, of
        which one number is drawn as seed. Sample k has the same bits whatever the number of
        samples, of threads, and of other figures that spread. Normal deviations are those of
        :class:`numpy.random.Generator`, at most 12.3 spreads.
    by : str or sequence of str, optional
        Quantities of tables, pictures and shares: names as in :func:`crankpin.rank`, such as
        ``"total.moment.peak"`` or ``"[1].force.backward"``. By default the total peaks and the
        forward and backward parts of order 1.
    orders : float, sequence of float or "auto", default "auto"
        Multiples of crank speed; by default the few that leave out at most ``rtol`` of any
        single cylinder, because tolerances undo what the layout cancels.
    rtol : float, optional
        For ``orders="auto"``: what omitted orders of one cylinder may add up to, relative to its
        m·r·ω². By default 1e-4.
    torque : bool, default True
        False to leave out torque.
    progress : bool or callable, default False
        True for a tqdm bar, or a function that is called with the steps done and the steps in all.

    Returns
    -------
    Tolerances
        Samples of force, moment and torque, N and N·m.

    Raises
    ------
    InputError
        If an argument is out of range, no part deviates, or a spread is so wide that a draw would
        leave no engine: a mass below zero, or a crank that cannot turn.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, as with lengths in millimetres.

    Examples
    --------
    An inline-6 has no first-order force by design. What 2 g of piston mass and 0.1° of crankpin
    angle leave:

    >>> import crankpin as cp
    >>> t = cp.tolerances(
    ...     cp.Engine.preset("i6"), rpm=6000, reciprocating_mass=0.002, pin_deg=0.1, samples=2000
    ... )
    >>> float(abs(t.nominal[1].force.forward))
    0.0
    >>> float(t.quantile(0.95, by="[1].force.forward").round(1))  # N
    77.2
    """
    engine_core(engine)
    arguments = {
        "reciprocating_mass": reciprocating_mass,
        "rotating_mass": rotating_mass,
        "crank_radius": crank_radius,
        "pin_deg": pin_deg,
        "z": z,
        "rod_length": rod_length,
    }
    spreads = Spreads.checked(engine, arguments, distribution, pins)
    if not spreads.given:
        first, value = next(iter(arguments.items()))
        hint = f"no part deviates; give a spread, {', '.join(arguments)}"
        raise inputs.rejected(first, value, hint)
    count, start = inputs.whole("samples", samples), _seed(seed)
    if not 1 <= count <= MOST_SAMPLES:
        raise inputs.rejected("samples", samples, f"give 1 to {MOST_SAMPLES}")
    request = Request.checked(
        orders=inputs.half_orders(orders) or "auto", rtol=rtol, spectrum=None, torque=torque,
        default_rtol=1e-4,
    )  # fmt: skip
    speed = inputs.number("rpm", rpm)
    bound = (0.0, 0.0, 0.0)
    if request.orders is None:
        needed, bound = _core.orders_of_samples(engine._core, speed, request.rtol, request.torque)
        request = request.at_orders(tuple(needed))
    names = names_of(by, request)
    report = progress_bar.checked(progress)
    result = Tolerances(engine, speed, spreads, count, start, request, bound, names)
    result.evaluate(report)
    inputs.warn_of_units(mean_piston_speed(engine, speed))
    return result


def _seed(seed: object) -> int:
    """Return a seed, drawn of a generator."""
    numbers = lazy.imported("numpy.random")
    if isinstance(seed, numbers.SeedSequence):
        return int(seed.generate_state(1, np.uint64)[0])
    if isinstance(seed, numbers.Generator):
        return int(seed.integers(MOST_SEEDS, dtype=np.uint64))
    number = inputs.whole("seed", seed)
    if not 0 <= number < MOST_SEEDS:
        raise inputs.rejected("seed", seed, "give a whole number, 0 to 2**64 - 1")
    return number
