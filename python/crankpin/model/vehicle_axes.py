"""Axes of a vehicle, or of a CAD model, and how an engine lies in them."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.messages import suppressed
from crankpin._support.record import Input
from crankpin.model.mounts import Mount, RigidBody, Vector, _vector
from crankpin.model.supports import Subframe

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

DIRECTIONS: dict[str, Vector] = {
    "forward": (1.0, 0.0, 0.0),
    "back": (-1.0, 0.0, 0.0),
    "left": (0.0, 1.0, 0.0),
    "right": (0.0, -1.0, 0.0),
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
}
"""Direction of the vehicle → the same along forward, left and up."""
ALONG = ("back", "forward", "left", "right")
"""Directions of a crank."""


class VehicleAxes(Input):
    """Axes of a vehicle, and how an engine lies in them.

    Body, mounts and all else of a :class:`Powertrain` with ``axes`` are in these axes, and so are
    its results: places, forces, displacements along x, y and z, and moments and rotations about
    them.

    Parameters
    ----------
    directions : str, default "back, right, up"
        Directions of x, y and z in the vehicle: of forward, back, left, right, up and down.
        Left-handed ones too: moments and rotations are then those about the axes in their sense.
    flywheel : {"back", "forward", "left", "right"}, default "back"
        Side of the engine on which its flywheel is: the direction of the engine's z.
    origin : sequence of float, default (0.0, 0.0, 0.0)
        Place of the engine's origin in these axes, m: on the crank's axis, where its cylinders'
        ``z`` is 0.
    incline_deg : float, default 0.0
        Angle by which the engine is turned about its crank from upright, degrees:
        counter-clockwise seen from the flywheel.

    Raises
    ------
    InputError
        If the directions are not three across each other, or an argument is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> vehicle = cp.VehicleAxes("back, right, up", flywheel="left", origin=(1.45, 0.2, 0.36))
    >>> vehicle.to_engine((1.25, 0.2, 0.26))
    (-0.2, -0.1, 0.0)
    >>> vehicle.from_engine((-0.2, -0.1, 0.0))
    (1.25, 0.2, 0.26)
    """

    directions: str
    flywheel: str
    origin: Vector
    incline_deg: float

    def __init__(
        self,
        directions: str = "back, right, up",
        flywheel: str = "back",
        origin: ArrayLike = (0.0, 0.0, 0.0),
        incline_deg: float = 0.0,
    ) -> None:
        words = [word.strip() for word in inputs.text("directions", directions).split(",")]
        axes = np.array([DIRECTIONS.get(word, (0.0, 0.0, 0.0)) for word in words])
        if axes.shape != (3, 3) or abs(np.linalg.det(axes)) != 1.0:
            hint = 'give those of x, y and z, such as "back, right, up" or "forward, left, up"'
            raise inputs.rejected("directions", directions, hint)
        inputs.one_of("flywheel", flywheel, ALONG)
        degrees = inputs.finite("incline_deg", incline_deg)
        z, up = np.array(DIRECTIONS[flywheel]), np.array(DIRECTIONS["up"])
        quarter = Decimal(repr(degrees)) / 90
        if quarter == quarter.to_integral_value():
            cos, sin = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
        else:
            cos, sin = float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees)))
        right = np.cross(up, z)
        engine = np.column_stack([cos * right + sin * up, cos * up - sin * right, z])
        self.__dict__.update(
            directions=", ".join(words),
            flywheel=flywheel,
            origin=_vector("origin", origin),
            incline_deg=degrees,
            _turn=axes @ engine + 0.0,
            _down=tuple((-axes @ up + 0.0).tolist()),
        )

    @property
    def _words(self) -> str:
        """Directions of x, y and z, in texts."""
        named = zip("xyz", self.directions.split(", "), strict=True)
        return ", ".join(f"{axis} {word}" for axis, word in named)

    @property
    def down(self) -> Vector:
        """Direction of gravity in these axes."""
        return self.__dict__["_down"]  # type: ignore[no-any-return]

    def to_engine(self, of: Any) -> Any:  # noqa: ANN401 - as it is given
        """Return a place, a body, a mount or a subframe of these axes in the engine's.

        Parameters
        ----------
        of : sequence of float, RigidBody, Mount or Subframe
            A place, m, or what has places, directions and a tensor.

        Returns
        -------
        tuple of float, RigidBody, Mount or Subframe
            The same in the engine's axes.

        Raises
        ------
        InputError
            If it is none of these.
        """
        return self._moved(of, inverse=True)

    def from_engine(self, of: Any) -> Any:  # noqa: ANN401 - as it is given
        """Return a place, a body, a mount or a subframe of the engine's axes in these.

        Parameters
        ----------
        of : sequence of float, RigidBody, Mount or Subframe
            A place, m, or what has places, directions and a tensor.

        Returns
        -------
        tuple of float, RigidBody, Mount or Subframe
            The same in these axes.

        Raises
        ------
        InputError
            If it is none of these.
        """
        return self._moved(of, inverse=False)

    def _moved(self, of: Any, *, inverse: bool) -> Any:  # noqa: ANN401 - as it is given
        turn = self.__dict__["_turn"]
        turn = turn.T if inverse else turn
        match of:
            case RigidBody():
                tensor = turn @ np.array(of.inertia) @ turn.T
                # Exact where the axes only change places; else symmetric but for rounding.
                tensor = (tensor + tensor.T) / 2.0 + 0.0
                place = self._moved(of.cg, inverse=inverse)
                with suppressed():
                    return RigidBody(of.mass, place, tensor, products="tensor")
            case Mount():
                axes = np.array(_core_axes(of)) @ turn.T + 0.0
                figures = {"at": self._moved(of.at, inverse=inverse), "tilt_deg": None}
                rows = None if (axes == np.eye(3)).all() else axes
                with suppressed():  # Warned of where it was given.
                    return of.replace(**figures, axes=rows)
            case Subframe():
                body = self._moved(of.body, inverse=inverse)
                mounts = [self._moved(mount, inverse=inverse) for mount in of.mounts]
                return Subframe(body, mounts)
        place = _vector("of", of)
        if inverse:
            return tuple(self._vectors(_sum(place, self.origin, -1), inverse=True).tolist())
        return _sum(tuple(self._vectors(place).tolist()), self.origin, 1)

    def _vectors(
        self, values: ArrayLike, *, about: bool = False, inverse: bool = False
    ) -> NDArray[Any]:
        """Return vectors of the engine's axes, (…, 3), in these, or the other way round.

        Those about the axes, moments and rotations, change their sense with the axes' handedness.
        """
        turn = self.__dict__["_turn"]
        turn = (turn.T if inverse else turn) * (np.linalg.det(turn).round() if about else 1.0)
        return np.asarray(np.asarray(values) @ turn.T + 0.0)  # Adding zero makes −0 0.


def _sum(place: Vector, other: Vector, sign: int) -> Vector:
    """Return a sum or difference of places, exact of the decimals that floats stand for."""
    x, y, z = (
        float(Decimal(repr(one)) + sign * Decimal(repr(two)))
        for one, two in zip(place, other, strict=True)
    )
    return (x, y, z)


def _core_axes(mount: Mount) -> Any:  # noqa: ANN401 - rows of numbers
    """Return the directions of a mount's axes, a row each."""
    if mount.axes is not None:
        return mount.axes
    angle = np.radians(mount.tilt_deg or 0.0)
    cos, sin = np.cos(angle), np.sin(angle)
    return ((cos, sin, 0.0), (-sin, cos, 0.0), (0.0, 0.0, 1.0))
