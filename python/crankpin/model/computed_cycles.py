"""Cycles computed for a cylinder: ideal, motored, and of a Wiebe burn."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final, Literal, Self, TypedDict

from crankpin import _core
from crankpin._core import ATMOSPHERE
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.parameters import documented
from crankpin.model.cylinder import Cylinder

if TYPE_CHECKING:
    from typing import Unpack

EXAMPLES: Final = ("petrol", "diesel")
"""Names of the cycles of :meth:`Cycle.example`."""


ENDS: Final = ("head", "crank")
"""Ends of a cylinder: above its piston, and below it, towards the crank."""
OPTIONAL = ("heat", "excess_air", "wall_temperature", "rpm")
"""Figures without which a cycle is computed otherwise."""


class IdealOptions(TypedDict, total=False):
    """Options of ideal cycles: see :meth:`Cycle.dual`."""

    intake_pressure: float
    exhaust_pressure: float | None
    compression_exponent: float
    expansion_exponent: float
    strokes: int
    name: str


class ComputedCycles:
    """Base class of cycles: the ways to compute one."""

    @classmethod
    def _of(cls, core: _core.Cycle, origin: str = "") -> Self:
        """Return the cycle of what the core has."""
        raise NotImplementedError

    @classmethod
    def dual(
        cls,
        cylinder: Cylinder,
        *,
        compression_ratio: float,
        pressure_ratio: float,
        cutoff_ratio: float,
        **options: Unpack[IdealOptions],
    ) -> Self:
        """Return the ideal cycle with combustion at constant volume, then at constant pressure.

        Compression and expansion are polytropic, p·Vⁿ constant, between the ends of the piston's
        travel. A four-stroke's exhaust and intake strokes are at constant pressures; a two-stroke
        changes its gas in the lower dead centre.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore. The cycle is that of its motion.
        compression_ratio : float
            Largest over smallest volume.
        pressure_ratio : float
            Pressure after over before the combustion at constant volume.
        cutoff_ratio : float
            Volume after over before the combustion at constant pressure.
        **options : dict, optional
            ``intake_pressure``, ``exhaust_pressure``: absolute, Pa; by default 101325 and the
            intake's. ``compression_exponent``, ``expansion_exponent``: n, by default 1.3.
            ``strokes``: 4 or 2. ``name``: by default that of the cycle.

        Returns
        -------
        Cycle
            The cycle.

        Raises
        ------
        InputError
            If the cylinder has no bore or a figure is out of range.
        """
        ratios = (compression_ratio, pressure_ratio, cutoff_ratio)
        return cls._ideal("Dual", cylinder, *ratios, **options)

    @classmethod
    @documented(dual)
    def otto(
        cls,
        cylinder: Cylinder,
        *,
        compression_ratio: float,
        pressure_ratio: float,
        **options: Unpack[IdealOptions],
    ) -> Self:
        """Return the ideal cycle with combustion at constant volume.

        Returns
        -------
        Cycle
            The cycle.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.043 / 0.3, 0.5, bore=0.086)
        >>> otto = cp.Cycle.otto(
        ...     cylinder, compression_ratio=10, pressure_ratio=3.5, intake_pressure=1e5
        ... )
        >>> round(otto.imep(cylinder) / 1e5, 4), round(otto.mean_torque(cylinder), 3)
        (9.2154, 36.634)
        """
        ratios = (compression_ratio, pressure_ratio, 1.0)
        return cls._ideal("Otto", cylinder, *ratios, **options)

    @classmethod
    @documented(dual)
    def diesel(
        cls,
        cylinder: Cylinder,
        *,
        compression_ratio: float,
        cutoff_ratio: float,
        **options: Unpack[IdealOptions],
    ) -> Self:
        """Return the ideal cycle with combustion at constant pressure.

        Returns
        -------
        Cycle
            The cycle.

        """
        return cls._ideal("Diesel", cylinder, compression_ratio, 1.0, cutoff_ratio, **options)

    @classmethod
    @documented(dual)
    def motored(
        cls, cylinder: Cylinder, *, compression_ratio: float, **options: Unpack[IdealOptions]
    ) -> Self:
        """Return the cycle without combustion.

        With equal exponents and equal pressures of intake and exhaust its work is zero. For heat
        loss take :meth:`wiebe` with ``heat=0`` and a wall temperature.

        Returns
        -------
        Cycle
            The cycle.

        """
        return cls._ideal("Motored", cylinder, compression_ratio, 1.0, 1.0, **options)

    @classmethod
    def _ideal(
        cls,
        kind: str,
        cylinder: Cylinder,
        compression_ratio: float,
        pressure_ratio: float,
        cutoff_ratio: float,
        *,
        intake_pressure: float = ATMOSPHERE,
        exhaust_pressure: float | None = None,
        compression_exponent: float = 1.3,
        expansion_exponent: float = 1.3,
        strokes: int = 4,
        name: str = "",
    ) -> Self:
        exhaust = intake_pressure if exhaust_pressure is None else exhaust_pressure
        figures = {
            "pressure_ratio": pressure_ratio,
            "cutoff_ratio": cutoff_ratio,
            "compression_exponent": compression_exponent,
            "expansion_exponent": expansion_exponent,
            "intake_pressure": intake_pressure,
            "exhaust_pressure": exhaust,
        }
        return cls._computed(
            _core.Cycle.ideal, kind, cylinder, compression_ratio, strokes, name, figures
        )

    @classmethod
    def compressor(
        cls,
        cylinder: Cylinder,
        *,
        suction: float = ATMOSPHERE,
        discharge: float | None,
        clearance: float = 0.1,
        n: float = 1.3,
        expansion_n: float | None = None,
        end: Literal["head", "crank"] = "head",
        name: str = "",
    ) -> Self:
        """Return the cycle of a compressor with ideal valves, one in each turn.

        What the clearance keeps expands to the suction pressure, gas enters, is compressed to the
        discharge pressure and leaves; expansion and compression are polytropic, p·Vⁿ constant. The
        valves open exactly where the pressures are equal. An engine with it has ``strokes=2``.

        Parameters
        ----------
        cylinder : Cylinder
            The cycle is that of its motion, of which that at the crank end differs.
        suction : float, default 101325.0
            Absolute pressure at which gas enters, Pa.
        discharge : float or None
            Absolute pressure at which gas leaves, Pa; None for an end that is unloaded, at suction
            pressure throughout.
        clearance : float, default 0.1
            Least volume at this end over the volume that the piston sweeps there; 0 for none.
        n : float, default 1.3
            Polytropic exponent of the compression, 1 to 2.
        expansion_n : float, optional
            That of the expansion; by default ``n``.
        end : {"head", "crank"}, default "head"
            End of the cylinder; angles are counted from where its volume is smallest.
        name : str, optional
            Name; by default one with the pressures.

        Returns
        -------
        Cycle
            The cycle.

        Raises
        ------
        InputError
            If a figure is out of range, or the clearance so large that the valves never open.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.1, 0.5, 60, bore=0.3)
        >>> cycle = cp.Cycle.compressor(cylinder, suction=1e5, discharge=4e5)
        >>> f"{cycle.imep(cylinder) / 1e5:.4f} bar"
        '-1.3225 bar'
        """
        if not isinstance(cylinder, Cylinder):
            raise inputs.rejected("cylinder", cylinder, "give a crankpin.Cylinder")
        at = inputs.one_of("end", end, ENDS)
        figures = {
            "suction": inputs.number("suction", suction),
            "discharge": inputs.optional_number("discharge", discharge),
            "clearance": inputs.number("clearance", clearance),
            "n": inputs.number("n", n),
            "expansion_n": inputs.number("expansion_n", n if expansion_n is None else expansion_n),
        }
        kind = "Unloaded end" if discharge is None else "Compressor"
        title = inputs.text("name", name) or (kind if at == "head" else f"{kind}, crank end")
        core = _core.Cycle.compressor(cylinder._parts, at, title, figures)
        facts = {"stroke": cylinder.stroke} | figures
        text = ", ".join(f"{key} {value:.6g}" for key, value in facts.items() if value is not None)
        return cls._of(core, f"Computed, not measured: compressor, {at} end, in SI units {text}")

    @classmethod
    @documented()
    def wiebe(
        cls,
        cylinder: Cylinder,
        *,
        compression_ratio: float,
        heat: float | None = None,
        excess_air: float | None = None,
        start_deg: float = -15.0,
        duration_deg: float = 50.0,
        a: float = 6.908,
        m: float = 2.0,
        gamma: float = 1.33,
        intake_pressure: float = ATMOSPHERE,
        exhaust_pressure: float | None = None,
        charge_temperature: float = 330.0,
        wall_temperature: float | None = None,
        rpm: float | None = None,
        intake_closes_deg: float | None = None,
        exhaust_opens_deg: float | None = None,
        stoichiometric_ratio: float | None = None,
        heating_value: float | None = None,
        strokes: int = 4,
        name: str = "",
    ) -> Self:
        """Return the cycle of one zone with a Wiebe burn, from intake closing to exhaust opening.

        The gas has a constant ratio of heat capacities; the burnt fraction is
        ``1 - exp(-a·yᵐ⁺¹)``, y the part of the burn's duration that is over. It is solved to
        rounding. From exhaust opening to the lower dead centre pressure falls as a cosine to that
        of the exhaust (of the intake in a two-stroke); before and after the exchange of gas it is
        constant.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore.
        compression_ratio : float
            Largest over smallest volume.
        heat : float, optional
            Heat of the fuel of one cycle, J; the burn releases ``1 - exp(-a)`` of it. Exactly
            one of ``heat`` and ``excess_air`` is given.
        excess_air : float, optional
            Instead of ``heat``: air over that of a stoichiometric mixture, λ. The air is that of
            the cylinder when the intake closes.
        start_deg : float, default -15.0
            Start of the burn after the firing top dead centre, degrees; below 0: before.
        duration_deg : float, default 50.0
            Duration of the burn, degrees.
        a : float, default 6.908
            Wiebe's efficiency parameter; 6.908 burns 99.9 %.
        m : float, default 2.0
            Wiebe's form exponent.
        gamma : float, default 1.33
            Ratio of heat capacities.
        intake_pressure : float, default 101325.0
            Absolute pressure of the intake, Pa.
        exhaust_pressure : float, optional
            Absolute pressure of the exhaust, Pa; by default that of the intake.
        charge_temperature : float, default 330.0
            Temperature when the intake closes, K.
        wall_temperature : float, optional
            Temperature of the walls, K, for heat loss by Woschni's correlation (Heywood,
            Internal Combustion Engine Fundamentals, 1988, section 12.4.3, no swirl); by default
            no heat is lost.
        rpm : float, optional
            Crank speed, rpm, for heat loss.
        intake_closes_deg : float, optional
            Intake valve (or port) event after the firing top dead centre, degrees; by default
            -140, in a two-stroke -115.
        exhaust_opens_deg : float, optional
            Exhaust valve (or port) event after the firing top dead centre, degrees; by default
            130, in a two-stroke 105.
        stoichiometric_ratio : float, optional
            Mass of air over that of fuel, for ``excess_air``; by default 14.6.
        heating_value : float, optional
            Lower heating value of the fuel, J/kg, for ``excess_air``; by default 43e6.
        name : str, optional
            Name; by default that of the cycle.

        Returns
        -------
        Cycle
            The cycle.

        Raises
        ------
        InputError
            If the cylinder has no bore, a figure is out of range, or not exactly one of ``heat``
            and ``excess_air`` is given.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> cycle = cp.Cycle.wiebe(cylinder, compression_ratio=10, heat=1200)
        >>> round(cycle.imep(cylinder) / 1e5, 2)
        12.24
        """
        inputs.only_one_of(heat=heat, excess_air=excess_air)
        if excess_air is None:
            inputs.only_with(
                "excess_air", stoichiometric_ratio=stoichiometric_ratio, heating_value=heating_value
            )
        if (rpm is None) != (wall_temperature is None):
            hint = Hint.of("heat loss needs both it and `wall_temperature`")
            raise inputs.rejected("rpm", rpm, hint)
        two = inputs.strokes(strokes) == 2
        closes, opens = (-115.0, 105.0) if two else (-140.0, 130.0)
        figures = {
            "heat": heat,
            "excess_air": excess_air,
            "stoichiometric_ratio": 14.6 if stoichiometric_ratio is None else stoichiometric_ratio,
            "heating_value": 43e6 if heating_value is None else heating_value,
            "start_deg": start_deg,
            "duration_deg": duration_deg,
            "a": a,
            "m": m,
            "gamma": gamma,
            "intake_pressure": intake_pressure,
            "exhaust_pressure": intake_pressure if exhaust_pressure is None else exhaust_pressure,
            "charge_temperature": charge_temperature,
            "wall_temperature": wall_temperature,
            "rpm": rpm,
            "intake_closes_deg": closes if intake_closes_deg is None else intake_closes_deg,
            "exhaust_opens_deg": opens if exhaust_opens_deg is None else exhaust_opens_deg,
        }
        return cls._computed(
            _core.Cycle.wiebe, "Wiebe", cylinder, compression_ratio, strokes, name, figures
        )

    @classmethod
    def example(
        cls, kind: Literal["petrol", "diesel"] = "petrol", *, load: float = 1.0, strokes: int = 4
    ) -> Self:
        """Return a cycle to begin with: computed by :meth:`wiebe`, not measured.

        Parameters
        ----------
        kind : {"petrol", "diesel"}, default "petrol"
            ``"petrol"``: a naturally aspirated four-stroke, at full load and 3000 rpm.
            ``"diesel"``: a turbocharged one, at 2000 rpm. Bore and stroke are 86 mm, the rod is
            145 mm long; ``origin`` has the other figures.
        load : float, default 1.0
            Part of full load: 1, or less, down to 0, which is idling at 800 and 700 rpm. Indicated
            mean effective pressure is linear in it, from 1.2 bar upwards, and set by the pressure
            of the intake (petrol) or by the fuel (diesel, two-strokes); other figures are linear
            in load too.
        strokes : {4, 2}, default 4
            4, or 2 for a two-stroke of the same figures.

        Returns
        -------
        Cycle
            The cycle.

        Raises
        ------
        InputError
            If there is no such example, or the load is not between 0 and 1.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> round(cp.Cycle.example().imep(cylinder) / 1e5, 1)
        12.1
        >>> part = cp.Cycle.example("petrol", load=0.1)
        >>> part.name, round(part.imep(cylinder) / 1e5, 1)
        ('example petrol, 10 % load', 2.3)
        """
        name, figures = example(kind, load, strokes)
        cylinder = Cylinder(0.043, 0.145, 0.5, bore=0.086)
        cycle: Any = cls.wiebe(cylinder, strokes=strokes, name=name, **figures)
        return cycle  # type: ignore[no-any-return]

    @classmethod
    def _computed(
        cls,
        of: Callable[..., _core.Cycle],
        kind: str,
        cylinder: Cylinder,
        compression_ratio: float,
        strokes: int,
        name: str,
        figures: Mapping[str, float | None],
    ) -> Self:
        area(cylinder)
        ratio = inputs.number("compression_ratio", compression_ratio)
        title = inputs.text("name", name) or f"{kind} cycle, compression ratio {ratio:.6g}"
        checked = {
            key: None if value is None and key in OPTIONAL else inputs.number(key, value)
            for key, value in figures.items()
        }
        core = of(cylinder._parts, cylinder.bore, ratio, inputs.strokes(strokes), title, checked)
        figures_of = {"bore": cylinder.bore, "stroke": cylinder.stroke, "compression_ratio": ratio}
        facts = {name: value for name, value in (figures_of | checked).items() if value is not None}
        text = ", ".join(f"{name} {value:.6g}" for name, value in facts.items())
        return cls._of(core, f"Computed, not measured: {kind} cycle, in SI units {text}")


def example(kind: str, load: float = 1.0, strokes: int = 4) -> tuple[str, dict[str, float]]:
    """Return the name of an example and its figures, the arguments of :meth:`Cycle.wiebe`."""
    name, ratio, figures = _core.Cycle.example(
        inputs.one_of("kind", kind, EXAMPLES), inputs.number("load", load), inputs.strokes(strokes)
    )
    return name, {"compression_ratio": ratio, **dict(figures)}


def area(cylinder: Cylinder) -> float:
    """Return the area of a cylinder's piston, m²; an error that names the hint without a bore."""
    if not isinstance(cylinder, Cylinder):
        raise inputs.rejected("cylinder", cylinder, "give a crankpin.Cylinder")
    if cylinder.bore is None:
        hint = Hint.of("gas pressure needs it; give `bore=…`, m, or cylinder.replace(bore=…)")
        raise inputs.rejected("bore", None, hint)
    return math.pi / 4.0 * cylinder.bore**2
