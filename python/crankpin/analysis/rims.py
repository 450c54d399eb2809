"""Rims and discs: what a flywheel of a moment of inertia measures and weighs."""

from __future__ import annotations

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.frames import Tabled
from crankpin._support.tables import Table

CAST_IRON = 7200.0
"""Density, kg/m³."""


def flywheel_rim(
    inertia: float,
    *,
    mean_diameter: float | None = None,
    rim_speed: float | None = None,
    hoop_stress: float | None = None,
    rpm: float | None = None,
    width_ratio: float | None = None,
    width: float | None = None,
    thickness: float | None = None,
    share: float = 1.0,
    density: float = CAST_IRON,
) -> FlywheelRim:
    """Return the rim of a flywheel: its mass, mean diameter and section.

    A ring of mean radius R and thickness t has the moment of inertia m·(R² + t²/4), a textbook's
    rim m·R². A call without a section has the latter: only a section has a thickness.

    Parameters
    ----------
    inertia : float
        Moment of inertia of the flywheel, kg·m².
    mean_diameter : float, optional
        Mean diameter of the rim, m, or one of the next two with ``rpm``.
    rim_speed : float, optional
        Speed of the rim at its mean diameter, m/s.
    hoop_stress : float, optional
        Stress σ = ρ·v² of a thin ring that turns at the rim's speed v, Pa.
    rpm : float, optional
        Speed of the flywheel, rpm.
    width_ratio : float, optional
        Width along the crank over thickness along the radius; or one of the next two, or none.
    width : float, optional
        Width of the section, m.
    thickness : float, optional
        Thickness of the section, m.
    share : float, default 1.0
        Part of the moment of inertia that is the rim's; arms and hub have the rest, by experience
        5 to 10 %.
    density : float, default 7200.0
        Density of the rim, kg/m³: 7200 of cast iron, 7850 of steel.

    Returns
    -------
    FlywheelRim
        Mass, mean diameter, section, and speed and stress where the speed is known.

    Raises
    ------
    InputError
        If not exactly one figure determines the diameter, several the section, a figure is out of
        range, or the rim would have no hole.

    Examples
    --------
    >>> import crankpin as cp
    >>> rim = cp.flywheel_rim(200.0, rim_speed=25, rpm=240, width_ratio=2, share=0.95)
    >>> round(rim.mean_diameter, 3), round(rim.mass, 1), [round(1e3 * x, 1) for x in rim.section]
    (1.989, 191.9, [92.4, 46.2])
    """
    whole = inputs.positive("inertia", inertia)
    part = inputs.positive("share", share)
    if part > 1.0:
        raise inputs.rejected("share", part, "give a part of 1, such as 0.95")
    inputs.only_one_of(mean_diameter=mean_diameter, rim_speed=rim_speed, hoop_stress=hoop_stress)
    sections = {"width_ratio": width_ratio, "width": width, "thickness": thickness}
    if sum(value is not None for value in sections.values()) > 1:
        inputs.only_one_of(**sections)
    if rpm is None:
        inputs.only_with("rpm", rim_speed=rim_speed, hoop_stress=hoop_stress)
    speed = None if rpm is None else inputs.positive("rpm", rpm)
    dense = inputs.positive("density", density)
    numbers = (
        None if value is None else inputs.positive(name, value)
        for name, value in (
            ("mean_diameter", mean_diameter),
            ("rim_speed", rim_speed),
            ("hoop_stress", hoop_stress),
            *sections.items(),
        )
    )
    mass, diameter, area, section = _core.rim(part * whole, dense, speed or 0.0, *numbers)
    both = None if section is None else (section[0], section[1])
    return FlywheelRim(whole, part, dense, speed, mass, diameter, area, both)


def flywheel_disc(
    inertia: float,
    *,
    diameter: float | None = None,
    thickness: float | None = None,
    density: float = CAST_IRON,
) -> FlywheelDisc:
    """Return the disc without a hole that has a moment of inertia.

    Parameters
    ----------
    inertia : float
        Moment of inertia, kg·m².
    diameter : float, optional
        Diameter, m; or the thickness.
    thickness : float, optional
        Thickness along the crank, m.
    density : float, default 7200.0
        Density, kg/m³: 7200 of cast iron, 7850 of steel.

    Returns
    -------
    FlywheelDisc
        Diameter, thickness and mass.

    Raises
    ------
    InputError
        If both or neither of diameter and thickness are given, or a figure is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> disc = cp.flywheel_disc(0.12, diameter=0.28, density=7850)
    >>> round(1e3 * disc.thickness, 2), round(disc.mass, 3)
    (25.33, 12.245)
    """
    inputs.only_one_of(diameter=diameter, thickness=thickness)
    whole, dense = inputs.positive("inertia", inertia), inputs.positive("density", density)
    deep, across = _core.disc(
        whole,
        dense,
        None if diameter is None else inputs.positive("diameter", diameter),
        None if thickness is None else inputs.positive("thickness", thickness),
    )
    return FlywheelDisc(whole, dense, across, deep)


class FlywheelRim(Tabled):
    """Rim of a flywheel. Made by :func:`crankpin.flywheel_rim`."""

    inertia: float
    """Moment of inertia of the flywheel, kg·m²."""
    share: float
    """Part of it that is the rim's."""
    density: float
    """Density, kg/m³."""
    rpm: float | None
    """Speed, rpm."""
    mass: float
    """Mass of the rim, kg."""
    mean_diameter: float
    """Mean diameter, m."""
    area: float
    """Area of the section, m²."""
    section: tuple[float, float] | None
    """Width along the crank and thickness along the radius, m."""

    def __post_init__(self) -> None:
        for name in ("inertia", "share", "density"):
            inputs.positive(name, getattr(self, name))
        for name in ("mass", "mean_diameter", "area"):
            inputs.finite(name, getattr(self, name))
        inputs.optional_number("rpm", self.rpm)
        if self.section is not None:
            inputs.vector("section", self.section)
        super().__post_init__()

    @property
    def rim_speed(self) -> float | None:
        """Speed at the mean diameter, m/s."""
        if self.rpm is None:
            return None
        return 0.5 * self.mean_diameter * _core.angular_speed(self.rpm)

    @property
    def hoop_stress(self) -> float | None:
        """Stress of a thin ring at that speed, Pa."""
        return None if self.rim_speed is None else self.density * self.rim_speed**2

    @property
    def table(self) -> Table:
        """Figures of the rim."""
        width, thickness = self.section or (None, None)
        outer = None if thickness is None else self.mean_diameter + thickness
        figures = (
            ("moment of inertia", self.share * self.inertia, "kg·m²"),
            ("mass", self.mass, "kg"),
            ("mean diameter", self.mean_diameter, "m"),
            ("outer diameter", outer, "m"),
            ("width", width, "m"),
            ("thickness", thickness, "m"),
            ("area of the section", self.area, "m²"),
            ("rim speed", self.rim_speed, "m/s"),
            ("hoop stress", self.hoop_stress, "Pa"),
        )
        return Table._of_figures("Flywheel rim", figures)


class FlywheelDisc(Tabled):
    """Disc without a hole. Made by :func:`crankpin.flywheel_disc`."""

    inertia: float
    """Moment of inertia, kg·m²."""
    density: float
    """Density, kg/m³."""
    diameter: float
    """Diameter, m."""
    thickness: float
    """Thickness along the crank, m."""

    def __post_init__(self) -> None:
        for name in ("inertia", "density"):
            inputs.positive(name, getattr(self, name))
        for name in ("diameter", "thickness"):
            inputs.finite(name, getattr(self, name))
        super().__post_init__()

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return 8.0 * self.inertia / self.diameter**2

    @property
    def table(self) -> Table:
        """Figures of the disc."""
        figures = (
            ("moment of inertia", self.inertia, "kg·m²"),
            ("mass", self.mass, "kg"),
            ("diameter", self.diameter, "m"),
            ("thickness", self.thickness, "m"),
        )
        return Table._of_figures("Flywheel disc", figures)
