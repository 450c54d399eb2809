"""Flexible supports of mounts: a second rigid body on mounts, or a measured receptance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.record import Input
from crankpin.model.mounts import Mount, RigidBody

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import ArrayLike, NDArray

Coordinate: TypeAlias = tuple[str, str]
"""Name of a mount, and ``"x"``, ``"y"`` or ``"z"``."""
DIRECTIONS = ("x", "y", "z")
PAIRS_HINT = 'give pairs of the name of a mount and "x", "y" or "z"'


class Subframe(Input):
    """Rigid body that carries the mounts of a powertrain, on mounts of its own.

    A subframe, a raft, a base frame, or the body of a vehicle on its wheels, in the engine's axes.
    What carries its own mounts does not move.

    Parameters
    ----------
    body : RigidBody
        The body that carries the powertrain's mounts, without the powertrain.
    mounts : sequence of Mount
        What carries it: one mount or more, of distinct names.

    Raises
    ------
    InputError
        If there is no mount, or two have one name.

    Examples
    --------
    >>> import crankpin as cp
    >>> raft = cp.Subframe(
    ...     cp.RigidBody(mass=300, cg=(0, -0.3, 0.15), inertia=(30, 35, 15)),
    ...     [cp.Mount(f"{x:+} {z:+}", at=(x, -0.4, z), stiffness=4e5, loss_factor=0.05)
    ...      for x in (0.4, -0.4) for z in (0.5, -0.2)],
    ... )
    >>> len(raft.mounts)
    4
    """

    body: RigidBody
    mounts: Sequence[Mount]

    def __post_init__(self) -> None:
        if not isinstance(self.body, RigidBody):
            raise inputs.rejected("body", self.body, "give a crankpin.RigidBody")
        entries = inputs.items("mounts", self.mounts, "give a list of crankpin.Mount")
        for k, mount in enumerate(entries):
            if not isinstance(mount, Mount):
                raise inputs.rejected(f"mounts[{k}]", mount, "give a crankpin.Mount")
        self.__dict__["mounts"] = tuple(entries)
        _core.check_support(self._figures)

    @property
    def _figures(self) -> tuple[Any, ...]:
        return (self.body._figures, [mount._figures for mount in self.mounts])


class Receptance(Input):
    """Measured receptance of the support of the mounts: displacement over force, by frequency.

    Parameters
    ----------
    coordinates : sequence of pairs
        Where forces and displacements were measured: name of a mount of the powertrain, and
        ``"x"``, ``"y"`` or ``"z"`` in the engine's axes. Directions that are not listed do not give
        way.
    table : pair of array_like
        Frequencies, Hz, and the complex receptance at each of them, m/N, at e^{+iωt}: of shapes
        (n_frequencies,) and (n_frequencies, n_coordinates, n_coordinates). It is interpolated,
        never extrapolated; of entries across the diagonal that differ by noise the mean counts.
    receivers : mapping of str to array_like, optional
        Name of a point that moves with it, such as ``"seat rail"``, to its displacement along x, y
        and z over the force at each coordinate, m/N: (n_frequencies, 3, n_coordinates).

    Raises
    ------
    InputError
        If shapes do not fit, or the receptance gives power where force acts, as at e^{−iωt}.

    Examples
    --------
    >>> import crankpin as cp
    >>> import numpy as np
    >>> f = np.linspace(5, 200, 40)
    >>> omega = 2 * np.pi * f
    >>> floor = 1 / (4e5 * (1 + 0.05j) - 300 * omega**2)
    >>> panel = cp.Receptance([("rear", "y")], (f, floor.reshape(-1, 1, 1)))
    >>> panel.coordinates
    (('rear', 'y'),)
    """

    coordinates: Sequence[Coordinate]
    table: tuple[ArrayLike, ArrayLike]
    receivers: Mapping[str, ArrayLike] | Sequence[tuple[str, ArrayLike]] | None = None

    def __post_init__(self) -> None:
        pairs = []
        for k, pair in enumerate(inputs.items("coordinates", self.coordinates, PAIRS_HINT)):
            both = inputs.items(f"coordinates[{k}]", pair, PAIRS_HINT)
            if len(both) != 2:
                raise inputs.rejected(f"coordinates[{k}]", pair, PAIRS_HINT)
            name = inputs.text(f"coordinates[{k}][0]", both[0])
            pairs.append((name, inputs.one_of(f"coordinates[{k}][1]", both[1], DIRECTIONS)))
        hint = (
            "give a pair: frequencies in Hz, and complex receptances of shape "
            "(n_frequencies, n_coordinates, n_coordinates), m/N"
        )
        entries = inputs.items("table", self.table, hint)
        if len(entries) != 2:
            raise inputs.rejected("table", self.table, hint)
        frequency = inputs.listed_numbers("table: frequency", entries[0])
        square = (len(frequency), len(pairs), len(pairs))
        values = _complex("table: receptance", entries[1], square, hint)
        points = []
        for name, moved in _named(self.receivers):
            hint = (
                "give complex receptances of shape (n_frequencies, 3, n_coordinates), m/N: "
                "displacements along x, y and z over the force at each coordinate"
            )
            shape = (len(frequency), 3, len(pairs))
            points.append((name, _nested(_complex(f"receivers[{name!r}]", moved, shape, hint))))
        fields = {"coordinates": tuple(pairs), "table": (tuple(frequency), _nested(values))}
        self.__dict__.update(fields, receivers=tuple(points) or None)
        _core.check_support(self._figures)

    @property
    def _figures(self) -> tuple[Any, ...]:
        """The figures as the core takes them."""
        frequency, values = self.table
        places = [(name, DIRECTIONS.index(axis)) for name, axis in self.coordinates]
        rows = np.array(values).reshape(len(places) and -1, len(places) ** 2)
        points = [
            (name, np.array(moved).transpose(0, 2, 1).tolist())
            for name, moved in dict(self.receivers or ()).items()
        ]
        return (places, frequency, rows.tolist(), points)


def _named(receivers: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401 - checked here
    """Yield names and displacements of the given entries."""
    hint = "give a mapping of names to receptances"
    pairs = receivers.items() if isinstance(receivers, Mapping) else receivers
    for pair in () if pairs is None else inputs.items("receivers", pairs, hint):
        both = inputs.items("receivers", pair, hint)
        if len(both) != 2:
            raise inputs.rejected("receivers", receivers, hint)
        yield inputs.text("receivers", both[0]), both[1]


Support: TypeAlias = Subframe | Receptance


def of_core(figures: Any) -> Support | None:  # noqa: ANN401 - as the core gives them
    """Return a support of the core."""
    if figures is None:
        return None
    if len(figures) == 2:
        (mass, cg, inertia), mounts = figures
        body = RigidBody(mass, cg, inertia, products="tensor")
        return Subframe(body, [Mount._of(mount) for mount in mounts])
    places, frequency, rows, points = figures
    count = len(places)
    values = np.array(rows).reshape(-1, count, count)
    receivers = {name: np.array(moved).transpose(0, 2, 1) for name, moved in points}
    coordinates = [(name, DIRECTIONS[axis]) for name, axis in places]
    return Receptance(coordinates, (frequency, values), receivers or None)


def _complex(
    name: str,
    rows: Any,  # noqa: ANN401 - checked here
    shape: tuple[int, ...],
    hint: str,
) -> NDArray[np.complex128]:
    """Return complex numbers of a shape."""
    try:
        values = np.array(rows, dtype=complex)
    except (TypeError, ValueError) as error:
        raise inputs.rejected(name, rows, f"{hint} ({inputs.reason(error)})") from None
    if values.shape != shape:
        raise inputs.faulty(name, f"has shape {values.shape}", hint)
    return values


def _nested(values: NDArray[np.complex128]) -> Any:  # noqa: ANN401 - tuples of tuples
    """Return an array as tuples, which compare and hash."""

    def frozen(value: Any) -> Any:  # noqa: ANN401 - a list or a number
        return tuple(map(frozen, value)) if isinstance(value, list) else value

    return frozen(values.tolist())
