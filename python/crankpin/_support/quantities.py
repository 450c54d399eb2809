"""Registry of quantities: names, symbols, units and scaling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class Kind(NamedTuple):
    """Quantity of an engine: names, symbols, units, and what it scales with."""

    name: str
    """Attribute of a balance, such as ``"force"``."""
    words: str
    """Name in texts."""
    symbols: tuple[str, ...]
    """Symbols of the peaks of its components."""
    components: tuple[str, ...]
    """Names of its components: two of a vector in the cross-section plane, one about z."""
    unit: str
    """Unit, as read by people."""
    unit_over_square: str = ""
    """Unit over ω² of quantities that scale with ω²; empty for the others."""
    dims: tuple[str, ...] = ()
    """Dimensions that it has besides those of a result, such as ``cylinder``."""
    real: bool = False
    """True for what is no phasor, by order too: a power, a ratio."""
    without: tuple[str, ...] = ()
    """Dimensions of a result on which it does not depend."""

    @property
    def planar(self) -> bool:
        """True for vectors in the cross-section plane, which have forward and backward parts."""
        return len(self.components) == 2

    @property
    def axes(self) -> tuple[str, ...]:
        """Coordinates of the dimension ``axis`` of a vector; none of what is no vector."""
        count = len(self.components)
        return ("x", "y", "z")[:count] if count > 1 else ()

    @property
    def vector_symbol(self) -> str:
        """Symbol of the longest vector, or of the peak."""
        return f"|{self.symbols[0][1]}|" if self.planar else self.symbols[0]

    @property
    def xarray_unit(self) -> str:
        """Unit as xarray's users write it."""
        return self.unit.replace("·", " ")


QUANTITIES = {
    kind.name: kind
    for kind in (
        Kind("force", "shaking force", ("|F_x|", "|F_y|"), ("along x", "along y"), "N", "kg·m"),
        Kind("moment", "rocking moment", ("|M_x|", "|M_y|"), ("about x (pitch)", "about y (yaw)"),
             "N·m", "kg·m²"),
        Kind("torque", "roll torque", ("|M_z|",), ("about z (roll)",), "N·m", "kg·m²"),
        Kind("crank_torque", "crank torque", ("|T|",), ("on the crank",), "N·m", "kg·m²"),
    )
}  # fmt: skip
"""Name of a quantity → its entry."""

PART_WORDS = {"gas": "of gas pressure", "inertia": "of inertia forces"}
"""Part of a quantity → its cause in words; others are named after a load."""


def kind_of(name: str, registry: Mapping[str, Kind] | None = None) -> Kind:
    """Return the entry of a quantity, or of a part of one, such as ``"torque.gas"``."""
    whole, _, part = name.partition(".")
    kind = (registry or QUANTITIES)[whole]
    if not part:
        return kind
    return kind._replace(name=name, words=f"{kind.words} {PART_WORDS.get(part, f'of {part}')}")


def parts_of(name: str, names: Sequence[str]) -> tuple[str, ...]:
    """Return the parts of a quantity, of the names of all that makes the quantities of a result.

    None where inertia alone makes it; gas pressure makes torques alone.
    """
    if "." in name or not set(names) - {"inertia"}:
        return ()
    if QUANTITIES[name].planar:
        names = [name for name in names if name != "gas"]
        if not set(names) - {"inertia"}:
            return ()
    usual = [part for part in PART_WORDS if part in names]
    return (*(f"{name}.{part}" for part in (*usual, *(n for n in names if n not in PART_WORDS))),)


PLANE_VECTORS = tuple(name for name, kind in QUANTITIES.items() if kind.planar)
"""Names of the vectors in the cross-section plane."""

COMPONENTS = ("x", "y", "forward", "backward")
"""Components of such a vector, as the core counts them."""

_ACROSS = ("|F_x|", "|F_y|"), ("along x", "along y")
LOADS = {
    kind.name: kind
    for kind in (
        Kind("crankpin", "crankpin", *_ACROSS, "N", "kg·m", ("cylinder",)),
        Kind("wrist_pin", "wrist pin", *_ACROSS, "N", "kg·m", ("cylinder",)),
        Kind("main", "main bearing", *_ACROSS, "N", "kg·m", ("main_bearing",)),
        Kind("side_thrust", "side thrust", ("|F|",), ("across the bore",), "N", "kg·m",
             ("cylinder",)),
        Kind("rod_force", "rod force", ("|F|",), ("along the rod",), "N", "kg·m", ("cylinder",)),
        Kind("gas_force", "gas force", ("|F|",), ("along the bore",), "N", "", ("cylinder",)),
    )
}  # fmt: skip
"""Name of a load inside an engine → its entry."""

ROD_LOADS = {
    kind.name: kind
    for kind in (
        Kind("rod_load", "rod load", ("|F|",), ("along the bore",), "N", "kg·m", ("cylinder",)),
        Kind("gas_load", "gas load", ("|F|",), ("along the bore",), "N", "", ("cylinder",)),
        Kind("inertia_load", "inertia load", ("|F|",), ("along the bore",), "N", "kg·m",
             ("cylinder",)),
        *(Kind(name, f"largest {name}", ("F",), ("along the bore",), "N", dims=("cylinder",),
               real=True, without=("theta_deg",)) for name in ("compression", "tension")),
    )
}  # fmt: skip
"""Name of a load of a piston rod → its entry."""

COMPONENTS_OF_LOADS = ("F_x", "F_y", "F_z", "M_x", "M_y", "M_z")
"""Components of a load, and of the motion that answers to it."""

INSIDE = LOADS | {
    "whole_crankpin": Kind("whole_crankpin", "whole crankpin", *_ACROSS, "N", "kg·m",
                           ("shared_pin",)),
}  # fmt: skip
"""The same, and the sum of the rods' forces on each crankpin."""

_XYZ = ("|F_x|", "|F_y|", "|F_z|"), ("along x", "along y", "along z")
_LOAD = ("|L|",), ("of a component",)
MOUNTED = {
    kind.name: kind
    for kind in (
        Kind("body_force", "force on the body", *_XYZ, "N"),
        Kind("mount_force", "force of a mount", *_XYZ, "N", dims=("mount",)),
        Kind("ground_force", "force on the ground", *_XYZ, "N"),
        Kind("wrench", "load of the engine", *_LOAD, "N, N·m", dims=("component",)),
        Kind("support_wrench", "load on the body", *_LOAD, "N, N·m", dims=("component",)),
        Kind("motion", "motion of the CG", *_LOAD, "m, rad", dims=("component",)),
        Kind("subframe_motion", "motion of the subframe's CG", *_LOAD, "m, rad",
             dims=("component",)),
        Kind("transmissibility", "transmissibility", *_LOAD, "", dims=("component",), real=True),
        Kind("transmissibility_db", "transmissibility", *_LOAD, "dB", dims=("component",),
             real=True),
        Kind("base_motion", "motion of the base at the CG", *_LOAD, "m, rad", dims=("component",)),
        Kind("base_transmissibility", "motion over that of the base", *_LOAD, "",
             dims=("component",), real=True),
        Kind("power_in", "mean power put in", ("P",), ("of an order",), "W", real=True),
        Kind("power_lost", "mean power dissipated", ("P",), ("of an order",), "W",
             dims=("mount",), real=True),
        Kind("power_passed", "mean power passed on", ("P",), ("of an order",), "W", real=True),
    )
}  # fmt: skip
"""Name of a quantity of a powertrain on its mounts → its entry."""

MOTIONS = {
    kind.name: kind
    for kind in (
        Kind("displacement", "displacement", *_XYZ, "m"),
        Kind("velocity", "velocity", *_XYZ, "m/s"),
        Kind("acceleration", "acceleration", *_XYZ, "m/s²"),
    )
}
"""Name of a motion of a point → its entry."""

_BY_CYLINDER: dict[str, Any] = {"dims": ("cylinder",), "real": True, "without": ("rpm", "order")}
EXCITATIONS = {
    kind.name: kind
    for kind in (
        QUANTITIES["crank_torque"]._replace(dims=("cylinder",)),
        Kind("mean_torque", "mean torque", ("T",), ("on the crank",), "N·m", **_BY_CYLINDER),
        Kind("reciprocating_inertia", "mean moment of inertia of piston and rod", ("J",),
             ("about the crank",), "kg·m²", **_BY_CYLINDER),
        Kind("tangential_pressure", "tangential pressure", ("|p|",), ("on the crank",), "Pa",
             dims=("cylinder",), without=("rpm",)),
    )
}  # fmt: skip
"""Name of a quantity of a torsional excitation → its entry."""

AT_RECEIVERS = {
    kind.name: kind
    for kind in (
        Kind("velocity", "rms velocity", ("v",), ("rms of all orders",), "m/s",
             dims=("receiver",), real=True),
        Kind("force", "rms force", ("F",), ("rms of all orders",), "N", dims=("receiver",),
             real=True),
    )
}  # fmt: skip
"""Name of a quantity of a sweep on mounts → its entry."""

_WAYS = {"horizontal": "H", "vertical": "V"}
FOUNDATION = {
    kind.name: kind
    for kind in (
        Kind(f"{way}_{word}", f"{way} {word}", (f"|{letter}_{symbol}|",), (way,), unit,
             dims=("compensators",))
        for word, letter, unit in (("force", "F", "N"), ("couple", "M", "N·m"))
        for way, symbol in _WAYS.items()
    )
}  # fmt: skip
"""Name of a quantity of a foundation table → its entry."""

GUIDES = {
    kind.name: kind
    for kind in (
        Kind("h_moment", "H-type guide-force moment", ("|H|",), ("about z (roll)",), "N·m"),
        Kind("x_bimoment", "X-type guide-force bimoment", ("|X|",), ("about z (roll)",), "N·m²"),
        Kind("x_moment", "X-type guide-force moment", ("|X|/L",), ("about z (roll)",), "N·m"),
        Kind("cylinder_moment", "guide-force moment of a cylinder", ("|M_H|",),
             ("about z (roll)",), "N·m", dims=("cylinder",)),
    )
}  # fmt: skip
"""Name of a quantity of guide-force moments → its entry."""

_BY_WHEEL: dict[str, Any] = {"dims": ("wheel",), "real": True}
OF_WHEELS = {
    kind.name: kind
    for kind in (
        Kind("hammer_blow", "hammer blow", ("F",), ("on the rail",), "N", **_BY_WHEEL),
        Kind("tractive_variation", "variation of tractive effort", ("F",), ("forwards",), "N"),
        Kind("swaying_couple", "swaying couple", ("M",), ("about the vertical",), "N·m"),
    )
}
"""Name of a quantity of a locomotive → its entry."""

OF_POINTS = {
    name: kind._replace(components=("largest",), real=True) for name, kind in LOADS.items()
}
OF_POINTS |= {
    "irregularity": Kind("irregularity", "irregularity", ("δ",), ("of the speed",), "", real=True),
    "swing_deg": Kind("swing_deg", "swing", ("swing",), ("of the crank",), "°", real=True),
}
"""Name of a quantity of an operating map → its entry."""

_LARGEST = {
    name: kind._replace(real=True, words=f"largest {kind.words}")
    for name, kind in (MOUNTED | MOTIONS).items()
    if name in ("body_force", "mount_force", "velocity")
}
_LARGEST["velocity"] = _LARGEST["velocity"]._replace(dims=("point",))
DESIGNS = {
    "frequency": Kind("frequency", "natural frequency", ("f",), ("of a mode",), "Hz", "",
                      ("mode",), real=True, without=("order",)),
    **_LARGEST,
    **{
        f"{name}_rms": kind._replace(
            name=f"{name}_rms", words=f"{kind.words}, rms of all orders", without=("order",)
        )
        for name, kind in _LARGEST.items()
    },
}  # fmt: skip
"""Name of a quantity of many designs of mounts → its entry."""


def _of(
    name: str,
    words: str,
    unit: str,
    *dims: str,
    symbol: str = "",
    axes: tuple[tuple[str, ...], tuple[str, ...]] | None = None,
    real: bool = True,
) -> Kind:
    """Return a quantity that is no load, of a symbol or along x, y and z."""
    symbols, components = axes or ((symbol or name,), (words,))
    return Kind(name, words, symbols, components, unit, dims=dims, real=real)


def _named(*kinds: Kind) -> dict[str, Kind]:
    return {kind.name: kind for kind in kinds}


_DIRECTION = ("x", "y", "z"), ("along x", "along y", "along z")
_TURNS = ("x", "y", "z"), ("about x", "about y", "about z")
MODES = _named(
    _of("frequency", "natural frequency", "Hz", "mode", symbol="f"),
    _of("damped_frequency", "natural frequency with damping", "Hz", "mode", symbol="f"),
    _of("loss_factor", "loss factor", "", "mode", symbol="η"),
    _of("purity", "purity", "%", "mode"),
    _of("subframe_share", "kinetic energy of the subframe", "%", "mode", symbol="share"),
    _of("energy", "kinetic energy", "%", "coordinate", "mode", symbol="share"),
    _of("shapes", "shape of unit mass", "", "coordinate", "mode", symbol="φ"),
    _of("strain", "elastic energy", "%", "mount", "mode", symbol="share"),
)
"""Name of a quantity of modes on mounts → its entry."""

ROBUSTNESS = _named(
    MODES["frequency"],
    MODES["purity"],
    _of("least_purity", "least purity found", "%", "mode", symbol="purity"),
    _of("cg_slope", "slope of the frequency by the place of the CG", "Hz/m", "coordinate", "mode"),
    _of("frequency_bounds", "frequency within the stiffness", "Hz", "bound", "mode", symbol="f"),
    _of("mass_bounds", "frequency within mass and inertia", "Hz", "bound", "mode", symbol="f"),
    _of("cg_range", "frequency with the CG at corners", "Hz", "bound", "mode", symbol="f"),
)
"""Name of a quantity of modes within tolerances → its entry."""

ROLL_AXES = _named(
    _of("torque_roll", "direction of the torque roll axis", "", axes=_DIRECTION),
    _of("mount_distances", "distance from the torque roll axis", "m", "mount", symbol="d"),
    *(
        _of(f"{prefix}{name}", f"{words} of the elastic roll axis{how}", unit, axes=_DIRECTION)
        for prefix, how in (("", ""), ("dynamic_", ", dynamic"))
        for name, words, unit in (
            ("elastic", "direction", ""),
            ("elastic_foot", "foot", "m"),
            ("elastic_offset", "offset from the CG", "m"),
        )
    ),
)
"""Name of a quantity of axes of roll → its entry."""

RESTING = _named(
    *(
        kind
        for name, cause in (("sag", "weight"), ("wind_up", "torque"), ("thrust_shift", "thrust"))
        for kind in (
            _of(name, f"displacement of the CG under the {cause}", "m", axes=_DIRECTION),
            _of(
                f"{name.removesuffix('_shift')}_deg",
                f"rotation under the {cause}", "°", axes=_TURNS,
            ),
            _of(f"{cause}_force", f"force of a mount by the {cause}", "N", "mount", axes=_XYZ),
        )
    ),
    _of("preload", "force of a mount", "N", "mount", axes=_XYZ),
    _of("travel", "travel of a mount", "m", "all_mounts", axes=_DIRECTION),
    _of("deflection", "deflection of a mount along its own axes", "m", "all_mounts", "mount_axis",
        symbol="d"),
    _of("snubber_force", "force of a mount's snubbers along its own axes", "N", "all_mounts",
        "mount_axis", symbol="F"),
    _of("ground_preload", "force of a subframe's mount", "N", "subframe_mount", axes=_XYZ),
)  # fmt: skip
"""Name of a quantity of a powertrain at rest → its entry."""

CANCELLED = _named(
    _of("forces", "force of an actuator", "N", "actuator", symbol="|F|", real=False),
    _of("utilisation", "share of the limit", "", "actuator"),
    _of("residual", "residual at the receivers", ""),
)
"""Name of a quantity of forces that cancel orders → its entry."""

ADAPTED = _named(
    _of("frequency", "frequency", "Hz", symbol="f"),
    _of("critical_delay", "critical delay", "s"),
    _of("error_deg", "error of the model's phase", "°", symbol="δ"),
    _of("largest_step", "largest step", "", symbol="μ"),
    _of("rate", "attenuation", "dB/update"),
)
"""Name of a quantity of a law that adapts phasors → its entry."""

STARS = _named(
    _of("vectors", "phase vector", "", "cylinder", symbol="|v|", real=False),
    _of("sums", "sum of phase vectors", "", symbol="|Σv|", real=False),
)
"""Name of a quantity of a star diagram → its entry."""
