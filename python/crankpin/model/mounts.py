"""A rigid body and its mounts: mass and inertia, places, stiffness at rest and in motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import suppressed
from crankpin._support.record import Input
from crankpin.model import checks

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Products: TypeAlias = Literal["tensor", "positive-integrals"]
Vector: TypeAlias = tuple[float, float, float]
Rows: TypeAlias = tuple[Vector, Vector, Vector]
Pair: TypeAlias = tuple[float, float]
Sides: TypeAlias = tuple[Pair, Pair, Pair]

THREE = "give three numbers"


class RigidBody(Input):
    """Engine, gearbox and all that moves with them as one body, in the engine's axes.

    Parameters
    ----------
    mass : float
        Mass, kg.
    cg : sequence of float
        Centre of gravity (x, y, z) in the engine's axes, m: x to the right and y up from the
        crank's axis, z along it in the sense of the cylinders' ``z``.
    inertia : array_like
        Inertia tensor **about the centre of gravity**, kg·m²: three rows of three numbers, or the
        three moments of a body without products. One about another point p has to be moved:
        I − m (d² − d dᵀ), with d from the centre of gravity to p (parallel axes).
    products : {"tensor", "positive-integrals"}, optional
        Sign of the entries off the diagonal: ``"tensor"``: −∫xy dm; ``"positive-integrals"``:
        ∫xy dm, as many CAD systems print them. Required where they are not zero: with the wrong one
        the torque roll axis tilts to the other side.

    Raises
    ------
    InputError
        If the tensor is not symmetric or not positive definite, or ``products`` is missing.

    Warns
    -----
    UserWarning
        If the largest principal moment is more than the sum of the others, which no body has, or
        figures seem to be in millimetres or grams.

    Examples
    --------
    >>> import crankpin as cp
    >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0), inertia=(7, 8, 4.5))
    >>> body.principal_moments
    (4.5, 7.0, 8.0)
    """

    mass: float
    cg: Vector
    inertia: Rows
    products: Products | None

    def __init__(
        self, mass: float, cg: ArrayLike, inertia: ArrayLike, products: Products | None = None
    ) -> None:
        mass = inputs.number("mass", mass)
        center = _vector("cg", cg)
        numbers = inputs.array("inertia", inertia)
        if numbers.shape not in ((3,), (3, 3)):
            hint = (
                "give three rows of three numbers, or the three moments of a body without products"
            )
            raise inputs.faulty("inertia", f"has shape {numbers.shape}", hint)
        numbers = np.diag(numbers) if numbers.ndim == 1 else numbers
        if products is not None:
            inputs.one_of("products", products, ("tensor", "positive-integrals"))
        tensor, moments = _core.rigid_body(mass, center, numbers.tolist(), products)
        has_products = any(tensor[i][j] for i in range(3) for j in range(i))
        fields = {
            "mass": mass,
            "cg": center,
            "inertia": tuple(map(tuple, tensor)),
            "products": "tensor" if has_products else None,
            "_moments": tuple(moments),
        }
        self.__dict__.update(fields)
        checks.body(self._figures)

    @classmethod
    def block(
        cls,
        width: float,
        height: float,
        length: float,
        density: float = 2400.0,
        top: ArrayLike = (0.0, 0.0, 0.0),
    ) -> RigidBody:
        """Return a cuboid of one density, such as a block of concrete.

        Parameters
        ----------
        width : float
            Side along x, m.
        height : float
            Side along y, m.
        length : float
            Side along z, along the crank, m.
        density : float, default 2400.0
            Density, kg/m³: 2400 of concrete.
        top : sequence of float, default (0.0, 0.0, 0.0)
            Middle of its top face in the engine's axes, m.

        Returns
        -------
        RigidBody
            The block.

        Raises
        ------
        InputError
            If a figure is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> block = cp.RigidBody.block(width=4, height=2.5, length=9, top=(0, -0.8, 0))
        >>> block.mass, block.cg
        (216000.0, (0.0, -2.05, 0.0))
        """
        x, y, z = _vector("top", top)
        given = {"width": width, "height": height, "length": length}
        sides = [inputs.number(name, side) for name, side in given.items()]
        heavy = inputs.number("density", density)
        centre = (x, y - 0.5 * sides[1], z)
        return cls._of(_core.block(sides, centre, heavy))

    @classmethod
    def combined(cls, *bodies: RigidBody) -> RigidBody:
        """Return several bodies that move as one, such as a machine on a block.

        Parameters
        ----------
        *bodies : RigidBody, optional
            The bodies, in the engine's axes.

        Returns
        -------
        RigidBody
            Their mass, centre of gravity and tensor.

        Raises
        ------
        InputError
            If there is none.

        Examples
        --------
        >>> import crankpin as cp
        >>> block = cp.RigidBody.block(width=4, height=2.5, length=9, top=(0, -0.8, 0))
        >>> machine = cp.RigidBody(mass=54e3, cg=(0, 0.4, 0), inertia=(2.5e5, 2.2e5, 4e4))
        >>> round(cp.RigidBody.combined(block, machine).cg[1], 9)
        -1.56
        """
        for k, body in enumerate(bodies):
            if not isinstance(body, RigidBody):
                raise inputs.rejected(f"bodies[{k}]", body, "give a crankpin.RigidBody")
        return cls._of(_core.combined([body._figures for body in bodies]))

    @classmethod
    def _of(cls, figures: Any) -> RigidBody:  # noqa: ANN401 - as the core gives them
        """Return a body of the core."""
        mass, cg, inertia = figures
        return cls(mass, cg, inertia, products="tensor")

    @property
    def principal_moments(self) -> Vector:
        """Principal moments of inertia, ascending, kg·m²."""
        return self.__dict__["_moments"]  # type: ignore[no-any-return]

    @property
    def _figures(self) -> tuple[float, Any, Any]:
        return (self.mass, self.cg, self.inertia)


class InertiaTrack(Input):
    """Fluid of a hydraulic mount, which swings in a channel between two chambers.

    It adds K(f) = k (−x² + 2iζx)/(1 − x² + 2iζx), x = f/f₀, to the dynamic stiffness of the mount's
    first axis: nothing at rest, k far above f₀, where the fluid is locked, and most loss below f₀.

    Parameters
    ----------
    stiffness : float
        Stiffness k that the chambers' walls add where the fluid is locked, N/m.
    frequency : float
        Frequency f₀ of the fluid on the chambers' walls, Hz.
    damping_ratio : float
        Damping ζ of the fluid over its critical damping.

    Raises
    ------
    InputError
        If a figure is not above zero.

    Examples
    --------
    >>> import crankpin as cp
    >>> track = cp.InertiaTrack(stiffness=1.8e5, frequency=10, damping_ratio=0.25)
    >>> front = cp.Mount("front", at=(0, 0, -0.2), stiffness=2e5, loss_factor=0.06, track=track)
    >>> abs(front.dynamic_at(8)[0]).round(2)
    np.float64(303865.19)
    """

    stiffness: float
    frequency: float
    damping_ratio: float

    def __post_init__(self) -> None:
        for name in ("stiffness", "frequency", "damping_ratio"):
            self.__dict__[name] = inputs.positive(name, getattr(self, name))


class Mount(Input):
    """Elastic mount: a place, three axes, and stiffness along them at rest and in motion.

    Parameters
    ----------
    name : str
        Name of the mount, such as ``"right"``.
    at : sequence of float
        Place (x, y, z) in the engine's axes, m.
    stiffness : float or sequence of float
        Static stiffness along the first, second and third axis, N/m; a number is that of all three.
        It counts for sag and preload.
    tilt_deg : float, optional
        Direction of the first axis from +x towards +y, degrees; the second is a quarter turn ahead
        of it, the third along z. By default 0: the axes are x, y and z.
    axes : array_like, optional
        Directions of the three axes, a row each, in place of ``tilt_deg``.
    dynamic_stiffness : float or sequence of float, optional
        Stiffness in motion, N/m, of rubber often 1.2 to 1.5 times the static one; by default the
        static stiffness. It counts for modes and response.
    loss_factor : float or sequence of float, default 0.0
        Imaginary over real part of the dynamic stiffness (hysteretic damping).
    damping : float or sequence of float, default 0.0
        Viscous damping, N·s/m; it may stand beside a loss factor.
    track : InertiaTrack, optional
        Fluid of a hydraulic mount, along the first axis.
    table : pair of array_like, optional
        Frequencies, Hz, and the complex dynamic stiffness along the three axes at each of them,
        N/m: of shapes (n_frequencies,) and (n_frequencies, 3), in place of ``dynamic_stiffness``,
        ``loss_factor``, ``damping`` and ``track``. It is interpolated, never extrapolated.
    rotational_stiffness : float or sequence of float, default 0.0
        Stiffness about the first, second and third axis, N·m/rad, of a bushing or of soil under a
        base, besides what the places of mounts make; at rest and in motion.
    rotational_loss_factor : float or sequence of float, default 0.0
        Imaginary over real part of that in motion.
    rotational_damping : float or sequence of float, default 0.0
        Viscous damping about the axes, N·m·s/rad.
    gap : float or sequence, default 0.0
        Deflection of the mount, from no load, at which its snubbers touch, m: a number, one for
        each axis, or for each axis a pair, against and along it.
    snubber_stiffness : float or sequence, default 0.0
        Stiffness that each snubber adds beyond its gap, N/m, as ``gap``; 0 is no snubber. In motion
        those that act at rest count (:class:`Powertrain`), with the mount's loss factor.

    Raises
    ------
    InputError
        If a figure is out of range: a stiffness or a damping below zero, axes not at right angles.

    Warns
    -----
    UserWarning
        If a stiffness seems to be in N/mm, damping in N·s/mm, a loss factor in per cent, or a place
            or a gap in millimetres.

    Examples
    --------
    >>> import crankpin as cp
    >>> right = cp.Mount("right", at=(0.28, 0, -0.1), stiffness=(2.2e5, 8e4, 8e4), tilt_deg=130)
    >>> right.replace(loss_factor=0.1).dynamic_at(20)[0]
    np.complex128(220000+22000j)
    >>> cp.Mount("rear", (0, 0, 0.5), 1e5, gap=0.008, snubber_stiffness=[0, (9e5, 4e5), 0]).gap[1]
    (0.008, 0.008)
    """

    name: str
    at: Vector
    stiffness: Vector
    tilt_deg: float | None
    axes: Rows | None
    dynamic_stiffness: Vector | None
    loss_factor: Vector
    damping: Vector
    track: InertiaTrack | None
    table: tuple[tuple[float, ...], tuple[tuple[complex, ...], ...]] | None
    rotational_stiffness: Vector
    rotational_loss_factor: Vector
    rotational_damping: Vector
    gap: Sides
    snubber_stiffness: Sides

    def __init__(
        self,
        name: str,
        at: ArrayLike,
        stiffness: ArrayLike,
        tilt_deg: float | None = None,
        axes: ArrayLike | None = None,
        dynamic_stiffness: ArrayLike | None = None,
        loss_factor: ArrayLike = 0.0,
        damping: ArrayLike = 0.0,
        track: InertiaTrack | None = None,
        table: tuple[ArrayLike, ArrayLike] | None = None,
        rotational_stiffness: ArrayLike = 0.0,
        rotational_loss_factor: ArrayLike = 0.0,
        rotational_damping: ArrayLike = 0.0,
        gap: Any = 0.0,  # noqa: ANN401 - a number, three, or three pairs
        snubber_stiffness: Any = 0.0,  # noqa: ANN401
    ) -> None:
        fields: dict[str, Any] = {"name": inputs.text("name", name), "at": _vector("at", at)}
        of_axes = {
            "stiffness": stiffness,
            "dynamic_stiffness": dynamic_stiffness,
            "loss_factor": loss_factor,
            "damping": damping,
            "rotational_stiffness": rotational_stiffness,
            "rotational_loss_factor": rotational_loss_factor,
            "rotational_damping": rotational_damping,
        }
        for field, value in of_axes.items():
            is_left_out = value is None and field == "dynamic_stiffness"
            fields[field] = None if is_left_out else _along_axes(field, value)
        fields["gap"] = _on_sides("gap", gap)
        fields["snubber_stiffness"] = _on_sides("snubber_stiffness", snubber_stiffness)
        fields["tilt_deg"] = inputs.optional_number("tilt_deg", tilt_deg)
        fields["axes"] = None
        if axes is not None:
            if tilt_deg is not None:
                raise inputs.rejected("tilt_deg", tilt_deg, "leave it out, or axes")
            rows = inputs.array("axes", axes)
            if rows.shape != (3, 3):
                hint = "give three rows of three numbers, the directions of the mount's axes"
                raise inputs.faulty("axes", f"has shape {rows.shape}", hint)
            fields["axes"] = tuple(map(tuple, rows.tolist()))
        if track is not None and not isinstance(track, InertiaTrack):
            raise inputs.rejected("track", track, "give a crankpin.InertiaTrack")
        fields["track"] = track
        fields["table"] = None if table is None else _table(table)
        self.__dict__.update(fields)
        _core.check_mount(self._figures)
        self._warn()

    @property
    def _figures(self) -> Any:  # noqa: ANN401 - as the core takes them
        """The figures as the core takes them."""
        track = self.track
        return (
            self.name,
            self.at,
            self.axes if self.axes is not None else self.tilt_deg or 0.0,
            self.stiffness,
            self.dynamic_stiffness,
            self.loss_factor,
            self.damping,
            None if track is None else (track.stiffness, track.frequency, track.damping_ratio),
            self.table,
            (self.rotational_stiffness, self.rotational_loss_factor, self.rotational_damping),
            (self.gap, self.snubber_stiffness),
        )

    @property
    def _is_snubbed(self) -> bool:
        """True if it has snubbers."""
        return any(any(pair) for pair in self.snubber_stiffness)

    def _warn(self) -> None:
        """Warn of figures in other units."""
        checks.mount(self._figures)

    @classmethod
    def _of(cls, figures: Any) -> Mount:  # noqa: ANN401 - as the core gives them
        """Return a mount of the core."""
        name, at, direction, stiffness, dynamic, loss, damping, *further = figures
        track, table, about, snubbers = further
        is_tilt = isinstance(direction, float)
        with suppressed():  # Warned of where it was given.
            return cls(
                name,
                at,
                stiffness,
                tilt_deg=direction if is_tilt and direction else None,
                axes=None if is_tilt else direction,
                dynamic_stiffness=dynamic,
                loss_factor=loss,
                damping=damping,
                track=None if track is None else InertiaTrack(*track),
                table=table,
                rotational_stiffness=about[0],
                rotational_loss_factor=about[1],
                rotational_damping=about[2],
                gap=snubbers[0],
                snubber_stiffness=snubbers[1],
            )

    def dynamic_at(self, frequency: float) -> NDArray[np.complex128]:
        """Return the complex dynamic stiffness along the three axes at a frequency.

        Parameters
        ----------
        frequency : float
            Frequency, Hz, zero or more; at zero there is no damping.

        Returns
        -------
        ndarray of complex, shape (3,)
            Stiffness, N/m; the imaginary part is the loss.

        Raises
        ------
        InputError
            If the frequency is below zero, or outside of the table.
        """
        return _core.mount_stiffness(self._figures, inputs.number("frequency", frequency))


def _vector(name: str, values: object) -> Vector:
    """Return three finite numbers."""
    entries = inputs.items(name, values, THREE)
    if len(entries) != 3:
        raise inputs.rejected(name, values, THREE)
    x, y, z = (inputs.finite(f"{name}[{k}]", coordinate) for k, coordinate in enumerate(entries))
    return (x, y, z)


def _along_axes(name: str, values: Any) -> Vector:  # noqa: ANN401 - a number or three
    """Return three numbers, of one the same along all axes."""
    if not inputs.is_listed(values):
        number = inputs.number(name, values)
        return (number, number, number)
    return _vector(name, values)


def _on_sides(name: str, values: Any) -> Sides:  # noqa: ANN401 - a number, three, or three pairs
    """Return pairs against and along each axis, of one number the same."""
    hint = "give a number, or for each of three axes one, or a pair, against and along it"
    entries = inputs.items(name, values, hint) if inputs.is_listed(values) else [values] * 3
    if len(entries) != 3:
        raise inputs.rejected(name, values, hint)
    pairs = []
    for axis, entry in enumerate(entries):
        pair = inputs.items(name, entry, hint) if inputs.is_listed(entry) else [entry] * 2
        if len(pair) != 2:
            raise inputs.rejected(f"{name}[{axis}]", entry, hint)
        against, along = (inputs.number(f"{name}[{axis}][{k}]", one) for k, one in enumerate(pair))
        pairs.append((against, along))
    return (pairs[0], pairs[1], pairs[2])


def _table(rows: Any) -> tuple[tuple[float, ...], tuple[Any, ...]]:  # noqa: ANN401 - checked here
    """Return frequencies and complex stiffnesses along the axes."""
    hint = (
        "give a pair: frequencies in Hz, and complex stiffnesses of shape (n_frequencies, 3), N/m"
    )
    pair = inputs.items("table", rows, hint)
    if len(pair) != 2:
        raise inputs.rejected("table", rows, hint)
    frequency = inputs.listed_numbers("table: frequency", pair[0])
    try:
        stiffness = np.array(pair[1], dtype=complex)
    except (TypeError, ValueError) as error:
        raise inputs.rejected("table", pair[1], f"{hint} ({inputs.reason(error)})") from None
    if stiffness.shape != (len(frequency), 3):
        raise inputs.faulty("table", f"has stiffness of shape {stiffness.shape}", hint)
    return tuple(frequency), tuple(map(tuple, stiffness.tolist()))
