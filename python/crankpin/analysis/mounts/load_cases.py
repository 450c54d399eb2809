"""A powertrain at rest under several load cases: travel and force of each mount, and the worst."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.quantities import RESTING
from crankpin._support.tables import Column, Table
from crankpin.analysis.mounts import static_state
from crankpin.analysis.mounts.response import _require_subframe
from crankpin.analysis.mounts.static_state import AtRest, StaticState

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.frames import Frames
    from crankpin.analysis.mounts.powertrain import Powertrain


class LoadCases(AtRest):
    """A powertrain at rest under several load cases, with the static stiffness of its mounts.

    Quantities have the dimension ``case`` before those that they have in a
    :class:`~crankpin.results.StaticState`; ``cases.sel(case="idle")`` is one of these. Made by
    :meth:`Powertrain.load_cases`.
    """

    powertrain: Powertrain
    """The powertrain."""
    states: Mapping[str, StaticState]
    """Name of each case → the powertrain at rest under it."""

    @property
    def coords(self) -> Mapping[str, Any]:
        """``case``: the names."""
        return {"case": tuple(self.states)}

    @property
    def _names(self) -> tuple[str, ...]:
        below = self._own_coords["subframe_mount"]
        return tuple(name for name in RESTING if below or name != "ground_preload")

    def _check(self, quantity: str) -> None:
        if quantity == "ground_preload":
            _require_subframe(self.powertrain, quantity)
        super()._check(quantity)

    def _values(self, quantity: str) -> NDArray[np.float64]:
        return np.stack([state.read(quantity) for state in self.states.values()])

    def _turned(self, quantity: str, values: NDArray[Any]) -> NDArray[Any]:
        return values  # as those of the states are

    def sel(self, *, case: str) -> StaticState:  # type: ignore[override] # of its one dimension
        """Return the state at rest under one case.

        Parameters
        ----------
        case : str
            Name of the case.

        Returns
        -------
        StaticState
            Displacements, travels and forces under it.

        Raises
        ------
        InputError
            If there is no such case.
        """
        return self.states[inputs.one_of("case", case, tuple(self.states))]

    @property
    def _forces(self) -> NDArray[np.float64]:
        """Force of each mount, and of those of a subframe, on what carries it."""
        if "ground_preload" not in self._names:
            return self.read("preload")
        return np.concatenate([self.read("preload"), self.read("ground_preload")], axis=1)

    @property
    def table(self) -> Table:
        """Travel and force of each mount under each case, and the snubbers that act."""
        names = self._own_coords["all_mounts"]
        rows = [(case, mount) for case in self.states for mount in names]
        columns = [
            Column("case", tuple(case for case, _ in rows)),
            Column("mount", tuple(mount for _, mount in rows)),
        ]
        along = {
            f"travel {axis}": 1e3 * self.read("travel")[..., k] for k, axis in enumerate("xyz")
        }
        own = {f"axis {k + 1}": 1e3 * self.read("deflection")[..., k] for k in range(3)}
        columns += [Column(name, values, "mm", 4) for name, values in (along | own).items()]
        forces = self._forces
        columns += [Column(f"F_{axis}", forces[..., k], "N") for k, axis in enumerate("xyz")]
        if self.powertrain._core.is_snubbed:
            sides = np.stack([self.read("snubber_force") < 0, self.read("snubber_force") > 0], -1)
            flat = sides.reshape(-1, 1, 3, 2).tolist()
            acting = (", ".join(static_state.snubbers_in_words([""], one)) for one in flat)
            columns.append(Column("snubber", tuple(text.replace(" ", "") for text in acting)))
        title = self._title("travel of each mount from no load, force on what carries it")
        return Table(title, tuple(columns), "Static stiffness.")

    @property
    def frames(self) -> Frames:
        """``table``; ``worst``: the largest travel and force of each mount, and under which case.

        And ``motion``: displacement of the centre of gravity and rotation under each case.
        """
        return self._frames(worst=self._of_worst, motion=self._of_motion)

    def _of_worst(self) -> Table:
        cases, columns = tuple(self.states), [Column("mount", self._own_coords["all_mounts"])]
        for k in range(3):
            values = 1e3 * self.read("deflection")[..., k]
            columns.append(Column(f"axis {k + 1} least", values.min(axis=0), "mm", 4))
            columns.append(Column(f"axis {k + 1} largest", values.max(axis=0), "mm", 4))
        for name, vectors, unit in (
            ("travel", 1e3 * self.read("travel"), "mm"),
            ("force", self._forces, "N"),
        ):
            lengths = np.linalg.norm(vectors, axis=-1)
            worst = lengths.argmax(axis=0).tolist()
            columns.append(Column(f"largest {name}", lengths.max(axis=0), unit, 4))
            columns.append(Column(f"case of {name}", tuple(cases[k] for k in worst)))
        return Table(self._title("worst of the cases"), tuple(columns), "Static stiffness.")

    def _of_motion(self) -> Table:
        states = tuple(self.states.values())
        columns = [
            Column("case", tuple(self.states)),
            Column("torque", tuple(state.torque for state in states), "N·m"),
        ]
        moved = 1e3 * (self.read("sag") + self.read("wind_up") + self.read("thrust_shift"))
        turned = self.read("sag_deg") + self.read("wind_up_deg") + self.read("thrust_deg")
        columns += [Column(axis, moved[:, k], "mm", 4) for k, axis in enumerate("xyz")]
        columns += [Column(f"about {axis}", turned[:, k], "°", 4) for k, axis in enumerate("xyz")]
        margins = tuple(1e3 * state.support_margin for state in states)
        columns.append(Column("CG inside the polygon by", margins, "mm", 4))
        return Table(self._title("motion of the CG under each case"), tuple(columns))

    def _title(self, of: str) -> str:
        carried = self.powertrain._carried
        on = f" on its mounts{carried}" if carried else ""
        return f"{labels.name_of(self.powertrain)}{on} at rest: {of}"


def load_cases(powertrain: Powertrain, cases: Mapping[str, Mapping[str, Any]]) -> LoadCases:
    """Return the states; :meth:`Powertrain.load_cases` documents the arguments."""
    if not isinstance(cases, Mapping) or not cases:
        hint = 'give a mapping of names to arguments of Powertrain.static: {"idle": {"torque": 30}}'
        raise inputs.rejected("cases", cases, hint)
    inputs.items("cases", cases, "give fewer cases")
    states = {}
    for name, arguments in cases.items():
        text = inputs.text("cases", name)
        case = static_state.named_case(powertrain, f"cases[{text!r}]", arguments)
        states[text] = StaticState(powertrain, *case)
    return LoadCases(powertrain, states)
