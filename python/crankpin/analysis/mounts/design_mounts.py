"""Design of mounts: stiffness, place and tilt for decoupling, frequencies and forces.

The core has the objectives: decoupling, of which the equations are linear in the stiffnesses,
purity of modes, forces. A bounded optimiser minimises them from several starts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, lazy, optional
from crankpin._support import progress as progress_bar
from crankpin._support.frames import Frames, Tabled
from crankpin._support.messages import Hint, suppressed
from crankpin._support.tables import Column, Table
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.model.mounts import Mount

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.progress import Progress

    Real: TypeAlias = NDArray[np.float64]
    Objective: TypeAlias = tuple[str, Order | None]

KINDS = ("stiffness", "tilt_deg", "x", "y", "z")
"""Properties of a mount that may vary."""
PAIRS = "give lowest and highest, or three such pairs, one for each axis"
FORCE = re.compile(r"(mount_force|body_force)\[(\d+(?:\.[05])?)\]")
"""Objective of an order."""
NEAREST = 1e-5
"""Weight of changes of stiffness beside equations: of equal solutions the nearest is taken."""
NOTHING = 1e-10
"""Sum of objectives, with decoupling squared, at which the search stops."""
WINDOW = 1e-6
"""Share of a limit by which rounding of the optimiser may miss it."""
EQUAL_MERITS = 1e-3
"""Relative difference from the best within which another start counts as equally good."""
MOST_STARTS = 1000


class MountDesign(Tabled):
    """Mounts that were designed, and what they reach.

    ``table`` has the objectives and requirements before and after, ``fitted`` is the powertrain on
    the new mounts. ``plot`` draws shares of energy or frequencies of both. Made by
    :func:`crankpin.design_mounts`.

    Examples
    --------
    >>> import crankpin as cp
    >>> body = cp.RigidBody(200.0, cg=(0, 0.1, 0.2), inertia=(15, 6, 13))
    >>> mounts = [
    ...     cp.Mount(name, at=(x, -0.12, z), stiffness=(3e5, 1e5, 1e5), tilt_deg=90)
    ...     for name, x, z in [("a", 0.3, 0.0), ("b", -0.3, 0.0), ("c", 0.0, 0.6)]
    ... ]
    >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
    >>> d = cp.design_mounts(p, vary="tilt_deg", bounds={"tilt_deg": 45})
    >>> d.names[0], d.wanted[0], d.reached, d.after[0] <= d.before[0]
    ('decoupling', 'least', True, True)
    """

    powertrain: Powertrain
    """The powertrain as it was."""
    fitted: Powertrain
    """The powertrain on the mounts designed."""
    names: tuple[str, ...]
    """Objectives and requirements."""
    before: tuple[float, ...]
    """Their values of the powertrain as it was."""
    after: tuple[float, ...]
    """Their values of the design."""
    limits: tuple[tuple[float, float] | None, ...]
    """Lowest and highest value that a requirement allows; None of others."""
    wanted: tuple[str, ...]
    """``"least"`` or ``"most"`` of an objective; empty of what is required or reported alone."""
    method: str
    """Method, in words."""
    starts: int
    """Number of starts of the optimiser."""
    equally_good: int
    """Number of starts that came to a design as good."""
    modes_between: tuple[float, float] | None = None
    """Lowest and highest frequency for all six modes, Hz, of the requirement; None without it."""

    @property
    def reached(self) -> bool:
        """Whether all requirements are met."""
        return all(self._met())

    def _met(self) -> list[bool]:
        pairs = zip(self.after, self.limits, strict=True)
        return [limit is None or _within(value, limit) for value, limit in pairs]

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.powertrain.loads_counted

    @property
    def table(self) -> Table:
        """Objectives and requirements, before and after."""
        met = self._met()
        wanted = tuple(
            f"{limit[0]:g} to {limit[1]:g}" if limit else word or "–"
            for limit, word in zip(self.limits, self.wanted, strict=True)
        )
        reached = tuple(
            "–" if limit is None else "yes" if good else "no"
            for limit, good in zip(self.limits, met, strict=True)
        )
        columns = (
            Column("of", self.names),
            Column("wanted", wanted),
            Column("before", self.before),
            Column("after", self.after),
            Column("reached", reached),
        )
        missed = [name for name, good in zip(self.names, met, strict=True) if not good]
        note = f"{self.method}."
        if self.starts > 1:
            note += f" {self.equally_good} of {self.starts} starts came to a design as good."
        if missed:
            note += f" Not reached within these bounds: {', '.join(missed)}."
        name, carried = labels.name_of(self.powertrain), self.powertrain._carried
        title = f"{name}: design of its mounts{carried}"
        units = tuple(name.rpartition(" ")[2] for name in self.names)
        return Table(title, columns, note, self.loads_counted, units)

    @property
    def frames(self) -> Frames:
        """``table``; ``mounts``: places, tilt and dynamic stiffness of the design."""
        return self._frames(mounts=self._of_mounts)

    def _of_mounts(self) -> Table:
        pairs = list(zip(self.powertrain.mounts, self.fitted.mounts, strict=True))
        columns = [Column("mount", self.fitted.names)]
        for k, axis in enumerate("xyz"):
            columns.append(Column(axis, tuple(float(new.at[k]) for _, new in pairs), "m"))
        columns.append(Column("tilt", tuple(new.tilt_deg for _, new in pairs), "°"))
        for k in range(3):
            both = [(_dynamic(old)[k], _dynamic(new)[k]) for old, new in pairs]
            columns.append(Column(f"k{k + 1}", tuple(new for _, new in both), "N/m"))
            change = tuple(new / old if old else None for old, new in both)
            columns.append(Column(f"k{k + 1} over before", change))
        title = f"{labels.name_of(self.powertrain)}: mounts designed, dynamic stiffness"
        return Table(title, tuple(columns), "", self.loads_counted)


def design_mounts(
    powertrain: Powertrain,
    by: str | Sequence[str] = "decoupling",
    *,
    vary: Mapping[str, Sequence[str]] | Sequence[str] | str,
    bounds: Mapping[str, Any],
    ratio: Sequence[float] | None = None,
    roll_frequency: float | None = None,
    modes_between: Sequence[float] | None = None,
    rpm: ArrayLike | None = None,
    starts: int = 8,
    seed: int = 0,
    progress: Progress = False,
) -> MountDesign:
    """Return mounts that decouple roll, place frequencies and lower forces, within bounds.

    Where stiffness alone varies, and decoupling is the only objective, the equations are linear and
    the solution is the global optimum. Other questions are optimised from several starts (SciPy).

    Parameters
    ----------
    powertrain : Powertrain
        The powertrain to start from.
    by : str or sequence of str, default "decoupling"
        Objectives to minimise: ``"decoupling"``, the part of the mounts' reaction to a roll about
        the torque roll axis that is no torque of the crank, 0 to 1, of mounts on firm ground;
        ``"mount_force[2]"`` or ``"body_force[0.5]"``, the largest force of an order at the speeds
        ``rpm``; and ``"purity"``, 100 % less the purity of the least pure mode. The sum of several
        counts, each force over that of the given powertrain.
    vary : mapping of str to sequence of str, sequence of str or str
        Name of a mount → what varies of it, among ``"stiffness"``, ``"tilt_deg"``, ``"x"``,
        ``"y"`` and ``"z"``; without names of every mount.
    bounds : mapping of str
        ``"stiffness"``: lowest and highest dynamic stiffness of each axis, N/m, or three such
        pairs; of others how far they may be from where they are: ``{"y": 0.03, "tilt_deg": 15}``, m
        and degrees. A mapping of names gives each mount its own:
        ``{"stiffness": {"left": (5e4, 3e5), "right": (5e4, 6e5)}}``.
    ratio : pair of float, optional
        Lowest and highest stiffness of the first axis (compression) over that of the other two
        (shear) that a rubber maker can build, such as 3 and 10.
    roll_frequency : float, optional
        Frequency of roll about the torque roll axis, Hz; by default that which it has.
    modes_between : pair of float, optional
        Lowest and highest frequency for all modes, Hz, a subframe's too.
    rpm : array_like, optional
        Crank speeds of the forces, rpm; required with them.
    starts : int, default 8
        Starts of the optimiser: the powertrain as it is, the linear solution, and random ones.
    seed : int, default 0
        Seed of the random starts.
    progress : bool or callable, default False
        True for a tqdm bar (needs tqdm), or a function of (starts done, starts in all).

    Returns
    -------
    MountDesign
        The design, and which requirements it meets. Static stiffness changes as dynamic stiffness.

    Raises
    ------
    InputError
        If an argument is out of range, or arguments contradict each other.
    ImportError
        If SciPy is not installed.

    Examples
    --------
    >>> import crankpin as cp
    >>> body = cp.RigidBody(150, (0, 0.06, 0.15), [[7, 0, 0], [0, 8, -0.9], [0, -0.9, 4.5]],
    ...                     products="tensor")
    >>> mounts = [
    ...     cp.Mount(f"{x:+g} {z:+g}", at=(x, -0.12, z + 0.15), stiffness=(3e5, 1e5, 1e5),
    ...              tilt_deg=90 + 100 * x, loss_factor=0.1)
    ...     for x in (0.22, -0.22) for z in (0.28, -0.28)
    ... ]
    >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
    >>> d = cp.design_mounts(p, vary="stiffness", bounds={"stiffness": (3e4, 9e5)})
    >>> d.after[0] < 0.5 * d.before[0]
    True
    """
    question = Question(powertrain, by, vary, bounds, ratio, roll_frequency, modes_between, rpm)
    powertrain._require_engine_axes("design_mounts")
    count = inputs.whole("starts", starts, 1)
    if count > MOST_STARTS:
        raise inputs.rejected("starts", count, f"give {MOST_STARTS} at most")
    start = inputs.whole("seed", seed, 0)
    watched = progress_bar.checked(progress)
    with suppressed():
        return question.designed(count, start, watched)


class Question:
    """Variables with their bounds, objectives and requirements."""

    def __init__(
        self,
        powertrain: Powertrain,
        by: str | Sequence[str],
        vary: Any,  # noqa: ANN401 - checked here
        bounds: Any,  # noqa: ANN401 - checked here
        ratio: Any,  # noqa: ANN401 - checked here
        roll_frequency: float | None,
        modes_between: Any,  # noqa: ANN401 - checked here
        rpm: ArrayLike | None,
    ) -> None:
        if not isinstance(powertrain, Powertrain):
            raise inputs.rejected("powertrain", powertrain, "give a crankpin.Powertrain")
        self.powertrain = powertrain
        self.objectives = [
            _objective(name)
            for name in ([by] if isinstance(by, str) else inputs.items("by", by, "give a list"))
        ]
        if not self.objectives:
            raise inputs.rejected("by", by, 'give "decoupling" or a force such as "mount_force[2]"')
        self.rpm = None if rpm is None else inputs.positive_array("rpm", inputs.vector("rpm", rpm))
        if ("decoupling", None) in self.objectives:
            powertrain._core.require_ground()
        if self.rpm is None and any(order is not None for _, order in self.objectives):
            raise inputs.rejected("rpm", None, "give the speeds at which forces count")
        self.varied = self._varied(vary)
        self.ratio = None if ratio is None else _range("ratio", ratio)
        self.window = None if modes_between is None else _range("modes_between", modes_between)
        self._bounds(bounds)
        if "stiffness" in {kind for _, kind in self.varied} or ("decoupling", None) in (
            self.objectives
        ):
            for mount in powertrain.mounts:
                if mount.table is not None:
                    hint = Hint.of("cannot be designed; give `dynamic_stiffness`")
                    raise inputs.faulty(
                        f"table of mount {mount.name!r}", "has many frequencies", hint
                    )
        _, hertz = powertrain._core.roll()
        if roll_frequency is not None:
            hertz = inputs.positive("roll_frequency", roll_frequency)
        if hertz <= 0.0:
            raise inputs.rejected("roll_frequency", roll_frequency, "give Hz, more than zero")
        self.roll_frequency = hertz
        self.keeps_roll = roll_frequency is not None
        self._frequency = hertz if powertrain._varies else None
        self._scales: list[float] = []
        self._core = _core.MountObjectives(
            powertrain._core,
            powertrain._engine_core,
            self.varied,
            self.objectives,
            [] if self.rpm is None else self.rpm,
            self._frequency,
            ((2.0 * np.pi * hertz) ** 2, self.keeps_roll),
        )

    def _varied(self, vary: Any) -> list[tuple[int, str]]:  # noqa: ANN401 - checked here
        """Return mount and kind of each thing that varies."""
        names = self.powertrain.names
        if not isinstance(vary, Mapping):
            vary = dict.fromkeys(names, vary)
        parts_of = []
        for name, kinds in vary.items():
            inputs.one_of("vary", name, names)
            entries = (
                [kinds] if isinstance(kinds, str) else inputs.items("vary", kinds, "give a list")
            )
            for kind in entries:
                inputs.one_of(f"vary[{name!r}]", kind, KINDS)
                mount = self.powertrain.mounts[names.index(name)]
                if kind == "tilt_deg" and mount.axes is not None:
                    hint = Hint.of("it has `axes`; give it `tilt_deg`, or vary something else")
                    raise inputs.rejected(f"vary[{name!r}]", kind, hint)
                parts_of.append((names.index(name), kind))
        if not parts_of:
            raise inputs.rejected("vary", vary, "give what varies, such as 'stiffness'")
        return parts_of

    def _bounds(self, bounds: Any) -> None:  # noqa: ANN401 - checked here
        """Set start, lowest and highest value of each variable."""
        hint = 'give a mapping such as {"stiffness": (5e4, 5e5), "y": 0.03}'
        if not isinstance(bounds, Mapping):
            raise inputs.rejected("bounds", bounds, hint)
        for name in bounds:
            inputs.one_of("bounds", name, KINDS)
        start: list[float] = []
        low: list[float] = []
        high: list[float] = []
        for place, kind in self.varied:
            if kind not in bounds:
                raise inputs.rejected("bounds", [*bounds], f"it varies, so give {kind!r} too")
            mount, limits, argument = (
                self.powertrain.mounts[place],
                bounds[kind],
                f"bounds[{kind!r}]",
            )
            if isinstance(limits, Mapping):
                for name in limits:
                    inputs.one_of(argument, name, self.powertrain.names)
                if mount.name not in limits:
                    raise inputs.rejected(argument, [*limits], f"give that of {mount.name!r} too")
                limits, argument = limits[mount.name], f"{argument}[{mount.name!r}]"
            if kind == "stiffness":
                entries = (
                    [limits] * 3 if np.ndim(limits) == 1 else inputs.items(argument, limits, PAIRS)
                )
                if len(entries) != 3:
                    raise inputs.rejected(argument, limits, PAIRS)
                pairs = [_range(argument, pair) for pair in entries]
                start += list(_dynamic(mount))
                low += [least for least, _ in pairs]
                high += [most for _, most in pairs]
                continue
            reach = inputs.finite(argument, limits)
            if reach < 0.0:
                raise inputs.rejected(argument, limits, "give zero or more: how far")
            middle = mount.tilt_deg or 0.0 if kind == "tilt_deg" else mount.at["xyz".index(kind)]
            start.append(float(middle))
            low.append(float(middle) - reach)
            high.append(float(middle) + reach)
        self.low, self.high = np.array(low), np.array(high)
        self.start = np.clip(np.array(start), self.low, self.high)

    # --- what a design is -------------------------------------------------------------------------

    def _places(self) -> list[tuple[int, str, slice]]:
        """Return mount, kind and the places of its values among all."""
        mounts, at = [], 0
        for place, kind in self.varied:
            width = 3 if kind == "stiffness" else 1
            mounts.append((place, kind, slice(at, at + width)))
            at += width
        return mounts

    def made(self, values: Real) -> Powertrain:
        """Return the powertrain of some values."""
        mounts, designed = list(self.powertrain.mounts), self._core.mounts(values)
        for place, _ in self.varied:
            mounts[place] = Mount._of(designed[place])
        return self.powertrain.replace(mounts=mounts)

    def _force(self, powertrain: Powertrain, name: str, order: Order) -> float:
        response = powertrain.response(self.rpm, orders=[order])
        return float(np.max(response.read(name, "peak")))

    def _purities(self, powertrain: Powertrain) -> Real:
        return powertrain.modes(self._frequency).read("purity")

    def _modes(self, powertrain: Powertrain) -> Real:
        return powertrain.modes(self._frequency).read("frequency")

    # --- the search -------------------------------------------------------------------------------

    def linear(self) -> Real:
        """Return the values nearest to decoupling, stiffnesses alone, others as they are."""
        optimize = optional.library("scipy.optimize")
        free = [
            column
            for _, kind, where in self._places()
            if kind == "stiffness"
            for column in range(where.start, where.stop)
        ]
        equations, wanted = self._core.equations(self.start)
        scale = self.high[free]
        rows = equations.T * scale
        near = NEAREST * np.eye(len(free))
        rows = np.vstack([rows, near])
        right = np.concatenate([wanted, near @ (self.start[free] / scale)])
        low = self.low[free] / scale
        ratio = self.ratio
        if ratio is None:
            solved = optimize.lsq_linear(rows, right, (low, 1.0), method="bvls", tol=1e-15)
            solution = solved.x
        else:
            solved = optimize.minimize(
                lambda x: (((rows @ x - right) ** 2).sum(), 2.0 * rows.T @ (rows @ x - right)),
                np.clip(self.start[free] / scale, low, 1.0),
                jac=True,
                method="SLSQP",
                bounds=[(least, 1.0) for least in low],
                constraints={"type": "ineq", "fun": lambda x: _ratios(x * scale, ratio)},
                options={"ftol": 1e-16, "maxiter": 500},
            )
            solution = solved.x
        values = self.start.copy()
        values[free] = np.clip(solution * scale, self.low[free], self.high[free])
        return np.asarray(values)

    def designed(self, starts: int, seed: int, progress: Progress) -> MountDesign:
        """Return the best design."""
        kinds = {kind for _, kind in self.varied}
        alone = self.objectives == [("decoupling", None)] and self.window is None
        if kinds == {"stiffness"} and alone:
            words = "Least squares of the linear equations of decoupling, within bounds"
            return self._result(self.linear(), words, 1, 1)
        optional.library("scipy.optimize")
        random = lazy.imported("numpy.random").default_rng(seed)
        begins = [self.start, self.linear()] if "stiffness" in kinds else [self.start]
        while len(begins) < starts:
            begins.append(self._value(random.uniform(size=len(self.low))))
        self._scales = [
            max(value, 1e-300) if order is not None else 1.0
            for value, (_, order) in zip(
                self._core.values(self.start), self.objectives, strict=True
            )
        ]
        candidates = []
        with progress_bar.shown(progress, "mount designs") as bar:
            for k, begin in enumerate(begins[:starts]):
                candidates.append(self._optimum(begin))
                if bar is not None:
                    bar(k + 1, starts)
                if candidates[-1][0] < NOTHING and candidates[-1][1] <= WINDOW:
                    break
        allowed = [pair for pair in candidates if pair[1] <= WINDOW]
        if allowed:
            best = min(allowed, key=lambda pair: pair[0])
        else:
            best = min(candidates, key=lambda pair: pair[1])
        near = best[0] + EQUAL_MERITS * abs(best[0]) + NOTHING
        good = sum(value <= near and miss <= max(best[1], WINDOW) for value, miss, _ in candidates)
        return self._result(best[2], f"Bounded optimisation, seed {seed}", len(candidates), good)

    def _value(self, unit: Real) -> Real:
        """Return values of numbers from 0 to 1, stiffnesses on a logarithmic scale."""
        values = self.low + unit * (self.high - self.low)
        for _, kind, where in self._places():
            if kind == "stiffness":
                ends = np.log(self.low[where]), np.log(self.high[where])
                values[where] = np.exp(ends[0] + unit[where] * (ends[1] - ends[0]))
        return np.asarray(np.clip(values, self.low, self.high))

    def _unit(self, values: Real) -> Real:
        width = np.where(self.high > self.low, self.high - self.low, 1.0)
        unit = (values - self.low) / width
        for _, kind, where in self._places():
            if kind == "stiffness":
                ends = np.log(self.low[where]), np.log(self.high[where])
                wide = np.where(ends[1] > ends[0], ends[1] - ends[0], 1.0)
                unit[where] = (np.log(values[where]) - ends[0]) / wide
        return np.asarray(np.clip(unit, 0.0, 1.0))

    def _required(self, unit: Real) -> Real:
        """Return what is above zero where requirements are met."""
        values = self._value(unit)
        parts = []
        if self.ratio is not None:
            stiff = [values[w] for _, kind, w in self._places() if kind == "stiffness"]
            if stiff:
                ratios = np.array([k[0] / other for k in stiff for other in k[1:]])
                parts += [np.log(ratios / self.ratio[0]), np.log(self.ratio[1] / ratios)]
        if self.window is not None:
            modes = self._core.frequencies(values)
            low, high = self.window
            parts += [np.array([modes[0] / low - 1.0, 1.0 - modes[-1] / high])]
        return np.concatenate(parts) if parts else np.empty(0)

    def _optimum(self, begin: Real) -> tuple[float, float, Real]:
        """Return merit, largest miss of a requirement, and values that a start leads to."""
        optimize = optional.library("scipy.optimize")

        def merit(unit: Real) -> float:
            values = self._core.values(self._value(np.clip(unit, 0.0, 1.0)))
            return sum(a / b for a, b in zip(values, self._scales, strict=True))

        required: Callable[[Real], Real] = lambda unit: self._required(np.clip(unit, 0.0, 1.0))  # noqa: E731
        first = self._unit(begin)
        needed = self.ratio is not None or self.window is not None
        solved = optimize.minimize(
            merit,
            first,
            method="SLSQP",
            bounds=[(0.0, 1.0)] * len(first),
            constraints=[{"type": "ineq", "fun": required}] if needed else [],
            options={"ftol": 1e-10, "maxiter": 100},
        )
        ends = []
        for unit in (first, np.clip(solved.x, 0.0, 1.0)):
            missed = float(np.maximum(-required(unit), 0.0).max(initial=0.0)) if needed else 0.0
            ends.append((merit(unit), missed, self._value(unit)))
        # An optimiser that fails leaves the start.
        return min(ends, key=lambda end: (end[1] > WINDOW, end[1] if end[1] > WINDOW else end[0]))

    def _result(self, values: Real, method: str, starts: int, good: int) -> MountDesign:
        fitted = self.made(values)
        names: list[str] = []
        limits: list[tuple[float, float] | None] = []
        pairs: list[tuple[float, ...]] = []
        wanted = ["most" if name == "purity" else "least" for name, _ in self.objectives]
        for name, order in self.objectives:
            if name == "purity":
                names.append("least purity %")
                both = (self.powertrain, fitted)
                pairs.append(tuple(float(self._purities(powertrain).min()) for powertrain in both))
            elif order is None:
                names.append("decoupling")
                pairs.append(
                    tuple(powertrain._core.roll()[0] for powertrain in (self.powertrain, fitted))
                )
            else:
                names.append(f"{name}[{order}] N")
                old, new = (
                    self._force(powertrain, name, order) for powertrain in (self.powertrain, fitted)
                )
                pairs.append((old, new))
            limits.append(None)
        if ("decoupling", None) in self.objectives:
            names += ["torque in one mode %", "roll frequency Hz"]
            pairs += [
                tuple(
                    powertrain._core.torque_in_one_mode(self._frequency)
                    for powertrain in (self.powertrain, fitted)
                ),
                tuple(powertrain._core.roll()[1] for powertrain in (self.powertrain, fitted)),
            ]
            target = self.roll_frequency
            # Reached to a thousandth: rubber scatters by more.
            limits += [None, (0.999 * target, 1.001 * target) if self.keeps_roll else None]
        if self.window is not None:
            for k, word in ((0, "lowest"), (-1, "highest")):
                names.append(f"{word} mode Hz")
                pairs.append(
                    tuple(
                        float(self._modes(powertrain)[k])
                        for powertrain in (self.powertrain, fitted)
                    )
                )
                limits.append(self.window)
        if self.ratio is not None:
            for pick, word in ((np.min, "least"), (np.max, "largest")):
                names.append(f"{word} ratio of stiffness")
                pairs.append(
                    tuple(
                        float(pick(self._shown(powertrain)))
                        for powertrain in (self.powertrain, fitted)
                    )
                )
                limits.append(self.ratio)
        before, after = zip(*pairs, strict=True)
        return MountDesign(
            self.powertrain,
            fitted,
            tuple(names),
            before,
            after,
            tuple(limits),
            (*wanted, *[""] * (len(names) - len(wanted))),
            method,
            starts,
            good,
            self.window,
        )

    def _shown(self, powertrain: Powertrain) -> list[float]:
        """Return ratios of stiffness of the mounts whose stiffness varies."""
        places = [place for place, kind in self.varied if kind == "stiffness"]
        stiff = [_dynamic(powertrain.mounts[place]) for place in places]
        return [k[0] / other if other else np.inf for k in stiff for other in k[1:]] or [1.0]


def _ratios(values: Real, ratio: tuple[float, float]) -> Real:
    """Return what is above zero where ratios of stiffnesses are within theirs."""
    stiff = values.reshape(-1, 3) / values.max()
    least, most = ratio
    first, others = stiff[:, :1], stiff[:, 1:]
    return np.concatenate([(first - least * others).ravel(), (most * others - first).ravel()])


def _dynamic(mount: Mount) -> tuple[float, float, float]:
    """Return the dynamic stiffness along the axes, N/m, without loss."""
    stiffness: Any = mount.stiffness if mount.dynamic_stiffness is None else mount.dynamic_stiffness
    return stiffness  # type: ignore[no-any-return]


def _within(value: float, limits: tuple[float, float]) -> bool:
    low, high = limits
    return low * (1.0 - WINDOW) <= value <= high * (1.0 + WINDOW)


def _objective(text: object) -> Objective:
    """Return the name and the order of an objective."""
    hint = (
        'give "decoupling", "purity", or a force of an order such as "mount_force[2]" or '
        '"body_force[0.5]"'
    )
    if isinstance(text, str) and text in ("decoupling", "purity"):
        return (text, None)
    match = FORCE.fullmatch(text) if isinstance(text, str) else None
    if match is None:
        raise inputs.rejected("by", text, hint)
    return (match[1], inputs.order(float(match[2])))


def _range(name: str, values: Any) -> tuple[float, float]:  # noqa: ANN401 - checked here
    """Return two numbers above zero, in order."""
    hint = "give two numbers above zero, the lower one first"
    entries = inputs.items(name, values, hint)
    if len(entries) != 2:
        raise inputs.rejected(name, values, hint)
    low, high = (inputs.finite(name, value) for value in entries)
    if not 0.0 < low <= high:
        raise inputs.rejected(name, values, hint)
    return low, high
