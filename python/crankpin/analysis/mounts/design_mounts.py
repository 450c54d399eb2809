"""Design of mounts: stiffness, place and tilt for decoupling, frequencies and forces.

A torque of the crank excites one mode alone iff K(0, t) ∥ (0, e_z) with t = I⁻¹e_z (Jeong and
Singh, J. Sound Vib. 235 (2000)): in units in which the mass matrix is 1, with u the direction of
M⁻½(0, e_z), K̃u = ω²u. These are linear equations in the stiffnesses. Other questions go to a
bounded optimiser from several starts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin._support import inputs, labels, lazy, optional
from crankpin._support import progress as progress_bar
from crankpin._support.frames import Frames, Tabled
from crankpin._support.tables import Column, Table
from crankpin._support.warnings import suppressed
from crankpin.analysis.mounts.powertrain import Powertrain

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.progress import Progress
    from crankpin.model.mounts import Mount

    Real: TypeAlias = NDArray[np.float64]
    Objective: TypeAlias = tuple[str, Order | None]

KINDS = ("stiffness", "tilt_deg", "x", "y", "z")
"""Properties of a mount that may vary."""
PAIRS = "give lowest and highest, or three such pairs, one for each axis"
FORCE = re.compile(r"(mount_force|body_force)\[(\d+(?:\.[05])?)\]")
"""Objective of an order."""
POWER = 8.0
"""Exponent of the norm that stands for a maximum while it is optimised: a maximum has edges."""
NEAREST = 1e-5
"""Weight of changes of stiffness beside equations: of equal solutions the nearest is taken."""
NOTHING = 1e-10
"""Sum of objectives, with decoupling squared, at which the search stops."""
WINDOW = 1e-6
"""Share of a limit by which rounding of the optimiser may miss it."""
EQUAL = 1e-3
"""Relative difference from the best within which another start counts as equally good."""
MOST_STARTS = 1000


class MountDesign(Tabled):
    """Mounts that were designed, and what they reach.

    Made by :func:`crankpin.design_mounts`.
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
        return [each is None or _within(value, each) for value, each in pairs]

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.powertrain.engine.loads_counted

    @property
    def table(self) -> Table:
        """Objectives and requirements, before and after."""
        met = self._met()
        wanted = tuple(
            f"{each[0]:g} to {each[1]:g}" if each else word or "–"
            for each, word in zip(self.limits, self.wanted, strict=True)
        )
        reached = tuple(
            "–" if each is None else "yes" if good else "no"
            for each, good in zip(self.limits, met, strict=True)
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
        name, carried = labels.name_of(self.powertrain.engine), self.powertrain._carried
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
        title = f"{labels.name_of(self.powertrain.engine)}: mounts designed, dynamic stiffness"
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
            _objective(each)
            for each in ([by] if isinstance(by, str) else inputs.items("by", by, "give a list"))
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
        self._unit_mass = powertrain._core.unit_mass()
        self._roll = self._unit_mass[5] / np.linalg.norm(self._unit_mass[5])
        if "stiffness" in {kind for _, kind in self.varied} or ("decoupling", None) in (
            self.objectives
        ):
            for mount in powertrain.mounts:
                if mount.table is not None:
                    hint = "cannot be designed; give dynamic_stiffness"
                    raise inputs.faulty(
                        f"table of mount {mount.name!r}", "has many frequencies", hint
                    )
        hertz = self._roll_frequency(powertrain)
        if roll_frequency is not None:
            hertz = inputs.positive("roll_frequency", roll_frequency)
        if hertz <= 0.0:
            raise inputs.rejected("roll_frequency", roll_frequency, "give Hz, more than zero")
        self.square = (2.0 * np.pi * hertz) ** 2
        self.keeps_roll = roll_frequency is not None
        self._scales: list[float] = []

    def _varied(self, vary: Any) -> list[tuple[int, str]]:  # noqa: ANN401 - checked here
        """Return mount and kind of each thing that varies."""
        names = self.powertrain.names
        if not isinstance(vary, Mapping):
            vary = dict.fromkeys(names, vary)
        found = []
        for name, kinds in vary.items():
            inputs.one_of("vary", name, names)
            listed = (
                [kinds] if isinstance(kinds, str) else inputs.items("vary", kinds, "give a list")
            )
            for kind in listed:
                inputs.one_of(f"vary[{name!r}]", kind, KINDS)
                mount = self.powertrain.mounts[names.index(name)]
                if kind == "tilt_deg" and mount.axes is not None:
                    hint = "it has axes; give it tilt_deg, or vary something else"
                    raise inputs.rejected(f"vary[{name!r}]", kind, hint)
                found.append((names.index(name), kind))
        if not found:
            raise inputs.rejected("vary", vary, "give what varies, such as 'stiffness'")
        return found

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
            mount, given, argument = (
                self.powertrain.mounts[place],
                bounds[kind],
                f"bounds[{kind!r}]",
            )
            if isinstance(given, Mapping):
                for name in given:
                    inputs.one_of(argument, name, self.powertrain.names)
                if mount.name not in given:
                    raise inputs.rejected(argument, [*given], f"give that of {mount.name!r} too")
                given, argument = given[mount.name], f"{argument}[{mount.name!r}]"
            if kind == "stiffness":
                each = [given] * 3 if np.ndim(given) == 1 else inputs.items(argument, given, PAIRS)
                if len(each) != 3:
                    raise inputs.rejected(argument, given, PAIRS)
                pairs = [_range(argument, pair) for pair in each]
                start += list(_dynamic(mount))
                low += [least for least, _ in pairs]
                high += [most for _, most in pairs]
                continue
            reach = inputs.finite(argument, given)
            if reach < 0.0:
                raise inputs.rejected(argument, given, "give zero or more: how far")
            own = mount.tilt_deg or 0.0 if kind == "tilt_deg" else mount.at["xyz".index(kind)]
            start.append(float(own))
            low.append(float(own) - reach)
            high.append(float(own) + reach)
        self.low, self.high = np.array(low), np.array(high)
        self.start = np.clip(np.array(start), self.low, self.high)

    # --- what a design is -------------------------------------------------------------------------

    def _places(self) -> list[tuple[int, str, slice]]:
        """Return mount, kind and the places of its values among all."""
        found, at = [], 0
        for place, kind in self.varied:
            width = 3 if kind == "stiffness" else 1
            found.append((place, kind, slice(at, at + width)))
            at += width
        return found

    def made(self, values: Real) -> Powertrain:
        """Return the powertrain of some values."""
        mounts = list(self.powertrain.mounts)
        for place, kind, where in self._places():
            mount, given = mounts[place], values[where].tolist()
            if kind == "stiffness":
                old = np.array(_dynamic(mount))
                share = np.divide(given, old, out=np.ones(3), where=old > 0.0)
                changes: dict[str, Any] = {
                    "stiffness": tuple((np.array(mount.stiffness) * share).tolist())
                }
                if mount.dynamic_stiffness is not None or not (old > 0.0).all():
                    changes["dynamic_stiffness"] = tuple(given)
            elif kind == "tilt_deg":
                changes = {"tilt_deg": given[0]}
            else:
                at = list(mount.at)
                at["xyz".index(kind)] = given[0]
                changes = {"at": tuple(at)}
            mounts[place] = mount.replace(**changes)
        return self.powertrain.replace(mounts=mounts)

    def _reactions(self, powertrain: Powertrain) -> Real:
        """Return K̃u of each stiffness of 1 N/m: (6, 3 × n_mounts)."""
        rows = powertrain._core.deflections().reshape(-1, 6) @ self._unit_mass
        return np.asarray((rows * (rows @ self._roll)[:, None]).T)

    def _reaction(self, powertrain: Powertrain) -> Real:
        """Return K̃u: six numbers."""
        return np.asarray(self._reactions(powertrain) @ _dynamics(powertrain).ravel())

    def _across(self, powertrain: Powertrain) -> Real:
        """Return the part of K̃u that is no torque of the crank, over the length of K̃u."""
        reaction = self._reaction(powertrain)
        length = float(np.linalg.norm(reaction))
        across = reaction - (self._roll @ reaction) * self._roll
        return np.asarray(across / length if length else across)

    def coupling(self, powertrain: Powertrain) -> Real:
        """Return what keeps K̃u from ω²u, over its length or ω²: six numbers."""
        if self.keeps_roll:
            return np.asarray(self._reaction(powertrain) / self.square - self._roll)
        return self._across(powertrain)

    def _share(self, powertrain: Powertrain) -> float:
        """Return the part of the reaction that is no torque of the crank, 0 to 1."""
        return float(np.linalg.norm(self._across(powertrain)))

    def _roll_frequency(self, powertrain: Powertrain) -> float:
        quotient = float(self._roll @ self._reaction(powertrain))
        return float(np.sqrt(max(quotient, 0.0)) / (2.0 * np.pi))

    def _force(self, powertrain: Powertrain, name: str, order: Order, *, smooth: bool) -> float:
        response = powertrain.response(self.rpm, orders=[order])  # type: ignore[arg-type] # given
        if name == "body_force":
            peaks = np.ravel(response.body_force.peak)
        else:
            peaks = np.ravel(np.moveaxis(response.read("mount_force", "peak"), -1, 0))
        largest = float(peaks.max())
        if not smooth or largest == 0.0:
            return largest
        return largest * float(((peaks / largest) ** POWER).mean() ** (1.0 / POWER))

    def _merits(self, powertrain: Powertrain) -> list[float]:
        """Return the objectives as the optimiser sees them."""
        found = []
        for name, order in self.objectives:
            if name == "purity":
                lacks = 1.0 - self._purities(powertrain) / 100.0
                found.append(float((np.abs(lacks) ** POWER).mean() ** (1.0 / POWER)))
            elif order is None:
                found.append(float((self.coupling(powertrain) ** 2).sum()))
            else:
                found.append(self._force(powertrain, name, order, smooth=True))
        return found

    def _purities(self, powertrain: Powertrain) -> Real:
        return powertrain.modes(self._at_frequency()).purity

    def _modes(self, powertrain: Powertrain) -> Real:
        return powertrain.modes(self._at_frequency()).frequency

    def _at_frequency(self) -> float | None:
        return float(np.sqrt(self.square) / (2.0 * np.pi)) if self.powertrain._varies else None

    # --- the search -------------------------------------------------------------------------------

    def linear(self) -> Real:
        """Return the values nearest to decoupling, stiffnesses alone, others as they are."""
        optimize = optional.library("scipy.optimize")
        base, own = self.made(self.start), np.zeros(len(self.powertrain.mounts) * 3)
        own[:] = _dynamics(base).ravel()
        reaction = self._reactions(base)
        free, columns = [], []
        for place, kind, where in self._places():
            if kind == "stiffness":
                free += list(range(where.start, where.stop))
                columns += [3 * place + k for k in range(3)]
        fixed = np.setdiff1d(np.arange(len(own)), columns)
        scale = self.high[free]
        rows = reaction[:, columns] * scale / self.square
        right = self._roll - reaction[:, fixed] @ own[fixed] / self.square
        near = NEAREST * np.eye(len(free))
        rows = np.vstack([rows, near])
        right = np.concatenate([right, near @ (self.start[free] / scale)])
        low = self.low[free] / scale
        ratio = self.ratio
        if ratio is None:
            solved = optimize.lsq_linear(rows, right, (low, 1.0), method="bvls", tol=1e-15)
            found = solved.x
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
            found = solved.x
        values = self.start.copy()
        values[free] = np.clip(found * scale, self.low[free], self.high[free])
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
        base = self.made(self.start)
        self._scales = [
            max(value, 1e-300) if order is not None else 1.0
            for value, (_, order) in zip(self._merits(base), self.objectives, strict=True)
        ]
        found = []
        with progress_bar.shown(progress, "mount designs") as shown:
            for k, begin in enumerate(begins[:starts]):
                found.append(self._optimum(begin))
                if shown is not None:
                    shown(k + 1, starts)
                if found[-1][0] < NOTHING and found[-1][1] <= WINDOW:
                    break
        allowed = [each for each in found if each[1] <= WINDOW]
        if allowed:
            best = min(allowed, key=lambda each: each[0])
        else:
            best = min(found, key=lambda each: each[1])
        near = best[0] + EQUAL * abs(best[0]) + NOTHING
        good = sum(value <= near and miss <= max(best[1], WINDOW) for value, miss, _ in found)
        return self._result(best[2], f"Bounded optimisation, seed {seed}", len(found), good)

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
            modes = self._modes(self.made(values))
            low, high = self.window
            parts += [np.array([modes[0] / low - 1.0, 1.0 - modes[-1] / high])]
        return np.concatenate(parts) if parts else np.empty(0)

    def _optimum(self, begin: Real) -> tuple[float, float, Real]:
        """Return merit, largest miss of a requirement, and values that a start leads to."""
        optimize = optional.library("scipy.optimize")

        def merit(unit: Real) -> float:
            values = self._merits(self.made(self._value(np.clip(unit, 0.0, 1.0))))
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
                pairs.append(tuple(float(self._purities(each).min()) for each in both))
            elif order is None:
                names.append("decoupling")
                pairs.append(tuple(self._share(each) for each in (self.powertrain, fitted)))
            else:
                names.append(f"{name}[{order}] N")
                old, new = (
                    self._force(each, name, order, smooth=False)
                    for each in (self.powertrain, fitted)
                )
                pairs.append((old, new))
            limits.append(None)
        if ("decoupling", None) in self.objectives:
            names += ["torque in one mode %", "roll frequency Hz"]
            pairs += [
                tuple(self._in_one_mode(each) for each in (self.powertrain, fitted)),
                tuple(self._roll_frequency(each) for each in (self.powertrain, fitted)),
            ]
            target = float(np.sqrt(self.square) / (2.0 * np.pi))
            # Reached to a thousandth: rubber scatters by more.
            limits += [None, (0.999 * target, 1.001 * target) if self.keeps_roll else None]
        if self.window is not None:
            for k, word in ((0, "lowest"), (-1, "highest")):
                names.append(f"{word} mode Hz")
                pairs.append(
                    tuple(float(self._modes(each)[k]) for each in (self.powertrain, fitted))
                )
                limits.append(self.window)
        if self.ratio is not None:
            for pick, word in ((np.min, "least"), (np.max, "largest")):
                names.append(f"{word} ratio of stiffness")
                pairs.append(
                    tuple(float(pick(self._shown(each))) for each in (self.powertrain, fitted))
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

    def _in_one_mode(self, powertrain: Powertrain) -> float:
        """Return the largest share of one mode, or group of them, in the effect of a torque, %."""
        modes = powertrain.modes(self._at_frequency())
        shares = modes.shapes[5] ** 2
        groups = [sum(shares[k - 1] for k in group) for group in modes.groups]
        return float(100.0 * max(groups) / shares.sum())


def _ratios(values: Real, ratio: tuple[float, float]) -> Real:
    """Return what is above zero where ratios of stiffnesses are within theirs."""
    stiff = values.reshape(-1, 3) / values.max()
    least, most = ratio
    first, others = stiff[:, :1], stiff[:, 1:]
    return np.concatenate([(first - least * others).ravel(), (most * others - first).ravel()])


def _dynamic(mount: Mount) -> tuple[float, float, float]:
    """Return the dynamic stiffness along the axes, N/m, without loss."""
    given: Any = mount.stiffness if mount.dynamic_stiffness is None else mount.dynamic_stiffness
    return given  # type: ignore[no-any-return]


def _dynamics(powertrain: Powertrain) -> Real:
    return np.array([_dynamic(mount) for mount in powertrain.mounts])


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
    found = FORCE.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise inputs.rejected("by", text, hint)
    return (found[1], inputs.order(float(found[2])))


def _range(name: str, given: Any) -> tuple[float, float]:  # noqa: ANN401 - checked here
    """Return two numbers above zero, in order."""
    hint = "give two numbers above zero, the lower one first"
    listed = inputs.items(name, given, hint)
    if len(listed) != 2:
        raise inputs.rejected(name, given, hint)
    low, high = (inputs.finite(name, each) for each in listed)
    if not 0.0 < low <= high:
        raise inputs.rejected(name, given, hint)
    return low, high
