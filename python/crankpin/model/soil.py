"""Soil under a block: springs and dashpots of the elastic half-space."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.record import Input
from crankpin.model.mounts import Mount, RigidBody, _vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Soil(Input):
    """Soil as an elastic half-space, which carries a block at its base.

    Parameters
    ----------
    shear_modulus : float
        Dynamic shear modulus G, Pa: some 2e7 of soft clay, 1e8 of dense sand.
    poisson : float, default 0.35
        Poisson's ratio, below 0.5.
    density : float, default 1800.0
        Density, kg/m³.
    damping_ratio : float, default 0.0
        Damping of the material over its critical damping, such as 0.03, besides the waves that
        leave the base.

    Raises
    ------
    InputError
        If a figure is out of range.

    Notes
    -----
    Stiffness and dashpots are those of Richart, Hall and Woods, *Vibrations of Soils and
    Foundations* (1970), chapter 10, of a circular base: springs as in table 3 of Whitman and
    Richart, *J. Soil Mech. Found. Div.* ASCE 93 SM6 (1967) 169, with mass and damping ratios in
    table 12-1 of UFC 3-220-01N (2005). A rectangular base has the circles of equal area and of
    equal second moments of area, whose stiffness is within 9 % of Pais and Kausel's (1988, table
    2-2a of NIST GCR 12-917-21) for sides of 2 to 1, within 14 % for 3 to 1; a square is 4 % stiffer
    up and down than its circle. They are for low frequencies,
    ω·r·√(ρ/G) up to about 1.5. Embedment counts by Whitman's factors, as in Arya, O'Neill and
    Pincus, *Design of Structures and Foundations for Vibrating Machines* (1979), chapter 4, which
    has none for torsion.

    Examples
    --------
    >>> import crankpin as cp
    >>> block = cp.RigidBody.block(width=4, height=2.5, length=9)
    >>> ground = cp.Soil(shear_modulus=6e7, poisson=0.35).mount(block, width=4, length=9, y=-2.5)
    >>> [float(f"{k:.4g}") for k in ground.stiffness]
    [1006000000.0, 1250000000.0, 1006000000.0]
    """

    shear_modulus: float
    poisson: float
    density: float
    damping_ratio: float

    def __init__(
        self,
        shear_modulus: float,
        poisson: float = 0.35,
        density: float = 1800.0,
        damping_ratio: float = 0.0,
    ) -> None:
        given = {
            "shear_modulus": shear_modulus,
            "poisson": poisson,
            "density": density,
            "damping_ratio": damping_ratio,
        }
        self.__dict__.update({name: inputs.number(name, value) for name, value in given.items()})
        _core.check_soil(self._figures)

    @property
    def _figures(self) -> tuple[float, float, float, float]:
        return (self.shear_modulus, self.poisson, self.density, self.damping_ratio)

    def mount(
        self,
        body: RigidBody,
        *,
        width: float | None = None,
        length: float | None = None,
        radius: float | None = None,
        y: float | None = None,
        at: ArrayLike | None = None,
        embedment: float = 0.0,
        name: str = "soil",
    ) -> Mount:
        """Return the soil under a base as a mount that resists all six motions.

        Parameters
        ----------
        body : RigidBody
            All that stands on the base; its inertia counts in the dashpots of rocking and torsion.
        width : float, optional
            Side of a rectangular base along x, m.
        length : float, optional
            Its side along z, m.
        radius : float, optional
            Radius of a circular base in their place, m.
        y : float, optional
            Height of the base in the engine's axes, m, under the body's centre of gravity.
        at : sequence of float, optional
            Middle of the base (x, y, z) in place of ``y``, m.
        embedment : float, default 0.0
            Depth of the base below the surface, m, of soil that touches the sides.
        name : str, default "soil"
            Name of the mount.

        Returns
        -------
        Mount
            Springs and dashpots along and about x, y and z at the middle of the base.

        Raises
        ------
        InputError
            If a figure is out of range, or the base is given twice or not at all.
        """
        if not isinstance(body, RigidBody):
            raise inputs.rejected("body", body, "give a crankpin.RigidBody")
        sides = [side for side in (width, length) if side is not None]
        if (len(sides) == 2) == (radius is not None) or len(sides) == 1:
            hint = Hint.of("give `width` and `length` of a rectangle, or `radius` of a circle")
            raise inputs.faulty("width", "is no base", hint)
        if radius is not None:
            base = [inputs.positive("radius", radius)]
        else:
            base = [inputs.positive("width", width), inputs.positive("length", length)]
        inputs.only_one_of(y=y, at=at)
        if at is None:
            x, _, z = body.cg
            middle = (x, inputs.finite("y", y), z)
        else:
            middle = _vector("at", at)
        depth = inputs.finite("embedment", embedment)
        title = inputs.text("name", name)
        return Mount._of(_core.soil_mount(self._figures, base, title, middle, depth, body._figures))
