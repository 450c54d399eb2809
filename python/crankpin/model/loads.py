"""Periodic loads besides pistons, pressure and unbalances, such as driven machines."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.messages import Hint, warn
from crankpin._support.record import Input, read_only
from crankpin.model.shafts import listed_items

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Angle, Order
    from crankpin.model.engine import Engine

Amplitudes: TypeAlias = "Mapping[Order, complex | Sequence[complex]]"
"""Order → peak phasor, or one for each speed of a table; order 0 is the mean."""
On: TypeAlias = Literal["shaft", "block", "both"]
Scaling: TypeAlias = Literal["independent", "speed squared"]

_LARGEST_STEP = 4.0
"""Steps of samples, of the largest, above which the step that closes them is a jump."""


class PeriodicLoad(Input):
    """A load on an engine that repeats with its crank: valve train, pump, belt, propeller, machine.

    Every result of an engine with it (:meth:`Engine.with_loads`) counts it under its name, beside
    ``inertia`` and ``gas``: ``balance.force.part(name)``.

    Amplitudes are peak phasors by order, multiples of the speed of the main crank: at the crank
    angle θ an order n of amplitude A is Re(A·exp(i·n·(θ − phase_deg))).

    Parameters
    ----------
    name : str
        Under which it is counted; several loads may have one.
    on : {"shaft", "block", "both"}
        What it acts on. ``"shaft"``: from outside on its shaft, as a propeller or the pull of a
        belt; bearings carry the force, gears the torque to the main crank. ``"block"``: from
        outside on the block. ``"both"``: on the shaft, and against it on the block, as pumps,
        valve trains and magnets of generators do, whose forces on the whole engine cancel; their
        torque works on the crank, and the block is turned back by as much.
    force : mapping of number to complex, optional
        Order → amplitude of the force, N; of a load tabulated over speed one for each speed.
        Order 0, the mean, only of a force that turns: one that stays does not shake.
    torque : mapping of number to complex, optional
        Order → amplitude of the torque about +z, N·m, on its shaft (with ``on="block"`` on the
        block); order 0 is the mean.
    scaling : {"independent", "speed squared"}, default "independent"
        Whether amplitudes stay as the speed changes, or grow with its square from ``rpm`` on.
    rpm : float or sequence of float, optional
        Crank speed at which amplitudes that grow are those given; or ascending speeds at which a
        table has amplitudes, linear between them and rejected outside.
    direction_deg : number or str, default 0.0
        Direction of the force, degrees from +x; of one that turns, where it points at
        ``phase_deg``.
    turning : bool, default False
        Whether the force turns with its shaft.
    phase_deg : number or str, default 0.0
        Crank angle at which its own angle is 0, degrees, in the two turns of a cycle.
    z : float, default 0.0
        Place along the crank, from the front to the flywheel, m.
    crank : int, optional
        Index of the crank that is its shaft, 0 for the main one; by default a shaft of its own
        with ``ratio``, ``x`` and ``y``, which are those of the main crank.
    ratio : number or str, default 1
        Speed of its own shaft over that of the main crank, a multiple of 1/2, below zero where it
        turns the other way: ``"1/2"`` is a camshaft.
    x, y : float, default 0.0
        Axis of its own shaft from that of the main crank, seen from the flywheel, m.
    cylinder : int, optional
        Number of a cylinder with whose bank it and its axis turn as the bank angle changes, as a
        camshaft's load does; by default it stays.

    Raises
    ------
    InputError
        If a figure is out of range, or there is neither force nor torque.

    Examples
    --------
    >>> import crankpin as cp
    >>> valves = cp.PeriodicLoad("valve train", on="both", torque={2: 4 - 1j, 4: 1.5}, ratio="1/2")
    >>> four = cp.Engine.preset("i4").with_loads([valves])
    >>> float(four.balance(rpm=2000).torque.part("valve train")[2].peak.round(3))
    2.062
    """

    name: str
    on: On
    force: Mapping[Order, Any]
    torque: Mapping[Order, Any]
    scaling: Scaling
    rpm: float | tuple[float, ...] | None
    direction_deg: float = dataclasses.field(compare=False, metadata={"exact": "exact_direction"})
    turning: bool
    phase_deg: float = dataclasses.field(compare=False, metadata={"exact": "exact_phase"})
    z: float
    crank: int | None
    ratio: float
    x: float
    y: float
    cylinder: int | None
    exact_direction: str = dataclasses.field(init=False, repr=False)
    """``direction_deg`` as text that is exact."""
    exact_phase: str = dataclasses.field(init=False, repr=False)
    """``phase_deg`` as text that is exact."""

    def __init__(
        self,
        name: str,
        *,
        on: On,
        force: Amplitudes | None = None,
        torque: Amplitudes | None = None,
        scaling: Scaling = "independent",
        rpm: float | Sequence[float] | None = None,
        direction_deg: Angle = 0.0,
        turning: bool = False,
        phase_deg: Angle = 0.0,
        z: float = 0.0,
        crank: int | None = None,
        ratio: float | str | Fraction = 1.0,
        x: float = 0.0,
        y: float = 0.0,
        cylinder: int | None = None,
    ) -> None:
        def keep(**fields: object) -> None:
            for field, value in fields.items():
                object.__setattr__(self, field, value)

        keep(name=inputs.text("name", name), on=inputs.one_of("on", on, ("shaft", "block", "both")))
        scalings = ("independent", "speed squared")
        keep(scaling=inputs.one_of("scaling", scaling, scalings))
        keep(rpm=self._speeds(rpm), turning=inputs.flag("turning", turning))
        rows = len(self.rpm) if isinstance(self.rpm, tuple) else None
        keep(force=_amplitudes("force", force, rows), torque=_amplitudes("torque", torque, rows))
        if not (self.force or self.torque):
            hint = "give amplitudes of a force, of a torque, or of both: torque={2: 4 - 1j}"
            raise inputs.rejected("force", None, hint)
        keep(exact_direction=inputs.angle("direction_deg", direction_deg))
        keep(exact_phase=inputs.angle("phase_deg", phase_deg))
        keep(direction_deg=inputs.degrees(self.exact_direction))
        keep(phase_deg=inputs.degrees(self.exact_phase))
        for field, value in (("z", z), ("x", x), ("y", y)):
            keep(**{field: inputs.finite(field, value)})
        keep(crank=None if crank is None else inputs.whole("crank", crank, 0, 2**31))
        keep(cylinder=None if cylinder is None else inputs.whole("cylinder", cylinder, 1, 2**31))
        keep(ratio=inputs.speed_ratio("ratio", ratio))
        _core.check_load(self._text())

    def _speeds(self, rpm: object) -> float | tuple[float, ...] | None:
        """Return the speed of amplitudes that grow, those of a table, or None."""
        if rpm is None:
            if self.scaling == "speed squared":
                hint = "give the crank speed at which the amplitudes are those given"
                raise inputs.rejected("rpm", None, hint)
            return None
        if inputs.is_listed(rpm):
            if self.scaling == "speed squared":
                hint = "a table has amplitudes at each speed: leave scaling out, or give one speed"
                raise inputs.rejected("scaling", self.scaling, hint)
            return tuple(inputs.vector("rpm", rpm).tolist())  # type: ignore[arg-type] # listed
        if self.scaling == "independent":
            other = 'give `scaling="speed squared"`, or several speeds'
            hint = Hint.of(f"amplitudes do not depend on it; {other}")
            raise inputs.rejected("rpm", rpm, hint)
        return inputs.finite("rpm", rpm)

    @classmethod
    def from_samples(
        cls,
        name: str,
        *,
        on: On,
        force: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        turns: int = 1,
        rpm: float | Sequence[float] | None = None,
        **options: Any,  # noqa: ANN401 - as those of the class
    ) -> PeriodicLoad:
        """Return a load whose force and torque are sampled over its period.

        Samples are evenly spaced from ``phase_deg`` on; the last is followed by the first, and is
        not the first again. Between samples the load is the sum of the orders that pass through
        them, up to half their number in a turn.

        Parameters
        ----------
        name : str
            As of the class.
        on : {"shaft", "block", "both"}
            As of the class.
        force, torque : array_like, optional
            Samples, N and N·m: (n_samples,), or (n_rpm, n_samples) of a table over speed. The mean
            of a force that does not turn is left out: it does not shake.
        turns : {1, 2}, default 1
            Turns of the main crank in which the load repeats.
        rpm : float or sequence of float, optional
            As of the class.
        **options : dict, optional
            ``scaling``, ``direction_deg``, ``turning``, ``phase_deg``, ``z``, ``crank``, ``ratio``,
            ``x``, ``y`` and ``cylinder``, as of the class.

        Returns
        -------
        PeriodicLoad
            The load, by orders.

        Raises
        ------
        InputError
            If samples are too few, not finite, or not as many rows as speeds.

        Warns
        -----
        UserWarning
            If the samples jump where the last is followed by the first.

        Examples
        --------
        >>> import crankpin as cp
        >>> pump = cp.PeriodicLoad.from_samples("pump", on="both", torque=[2, 3, 2, 1], turns=1)
        >>> complex(pump.torque[1]), complex(pump.torque[0])
        (-1j, (2+0j))
        """
        count = inputs.whole("turns", turns, 1, 2)
        several = inputs.is_listed(rpm)
        amplitudes: dict[str, Any] = {}
        for quantity, samples in (("force", force), ("torque", torque)):
            if samples is None:
                continue
            rows = np.atleast_2d(inputs.array(quantity, samples))
            if rows.ndim != 2 or (np.ndim(samples) == 2) != several:
                shape = "(n_rpm, n_samples)" if several else "(n_samples,)"
                raise inputs.rejected(quantity, samples, f"give samples of shape {shape}")
            if rows.shape[1] < 3:  # two do not determine cosine and sine
                raise inputs.rejected(quantity, samples, "give 3 samples or more over its period")
            _warn_of_jump(quantity, rows)
            by_order = _orders_of(rows, count)
            if quantity == "force" and not options.get("turning", False):
                del by_order[0]
            nonzero = {n: values for n, values in by_order.items() if any(values)}
            amplitudes[quantity] = nonzero if several else {n: a[0] for n, a in nonzero.items()}
        return cls(name, on=on, rpm=rpm, **amplitudes, **options)

    def _text(self) -> str:
        """Return the load as the core reads it."""
        over: Any = "independent"
        if isinstance(self.rpm, tuple):
            over = {"table": self.rpm}
        elif self.rpm is not None:
            over = {"speed_squared": self.rpm}
        fields: dict[str, Any] = {
            "name": self.name,
            "on": self.on,
            "force": _rows(self.force),
            "torque": _rows(self.torque),
            "over_speed": over,
            "direction_deg": self.exact_direction,
            "phase_deg": self.exact_phase,
            "turning": self.turning,
            "z": self.z,
            "ratio": self.ratio,
            "axis": [self.x, self.y],
            "crank": self.crank,
            "cylinder": self.cylinder,
        }
        return json.dumps(fields)

    @classmethod
    def _of(cls, fields: Mapping[str, Any]) -> PeriodicLoad:
        """Return a load of the core."""
        over = fields.get("over_speed", "independent")
        scaling: Scaling = "independent"
        rpm: Any = None
        if isinstance(over, dict):
            ((kind, rpm),) = over.items()
            scaling = "speed squared" if kind == "speed_squared" else "independent"
        x, y = fields.get("axis", (0.0, 0.0))
        table = isinstance(rpm, list)
        return cls(
            fields["name"],
            on=fields["on"],
            force=of_rows(fields.get("force", ()), table=table),
            torque=of_rows(fields.get("torque", ()), table=table),
            scaling=scaling,
            rpm=rpm,
            direction_deg=fields.get("direction_deg", 0.0),
            turning=fields.get("turning", False),
            phase_deg=fields.get("phase_deg", 0.0),
            z=fields.get("z", 0.0),
            crank=fields.get("crank"),
            ratio=fields.get("ratio", 1.0),
            x=x,
            y=y,
            cylinder=fields.get("cylinder"),
        )


def with_loads(core: _core.Engine, loads: Iterable[PeriodicLoad]) -> _core.Engine:
    """Return an engine with these periodic loads."""
    entries = listed_items("loads", loads, PeriodicLoad)
    return core.with_loads(f"[{', '.join(load._text() for load in entries)}]")


def loads(core: _core.Engine) -> tuple[PeriodicLoad, ...]:
    """Return the periodic loads besides pistons, pressure and unbalances."""
    return tuple(PeriodicLoad._of(fields) for fields in json.loads(core.loads))


def of_speed_squared(engine: Engine) -> Engine:
    """Return an engine without the loads that do not scale with the square of the speed."""
    remaining = [load for load in engine.loads if load.scaling == "speed squared"]
    return engine if len(remaining) == len(engine.loads) else engine.with_loads(remaining)


def lines(core: _core.Engine) -> list[units.Text]:
    """Return the periodic loads in words."""
    all_loads = loads(core)
    texts = []
    for load in all_loads[:4]:
        what = " and ".join(name for name in ("force", "torque") if getattr(load, name))
        on = "shaft and block" if load.on == "both" else load.on
        name = labels.one_line(load.name)
        words = f"load {name}: {what} on {on}, z = "
        texts.append(units.Text(words, units.figure(load.z, "m", 4)))
    return texts + [units.Text("…")] * (len(all_loads) > 4)


def _amplitudes(name: str, mapping: object, rows: int | None) -> Mapping[Order, Any]:
    if mapping is None:
        return read_only({})
    if not isinstance(mapping, Mapping):
        raise inputs.rejected(
            name, mapping, "give a mapping: order → complex amplitude, {2: 4 - 1j}"
        )
    amplitudes: dict[Order, Any] = {}
    for order, value in mapping.items():
        key = 0 if order == 0 else inputs.explicit_half_orders([order], name)[0]
        if key in amplitudes:
            raise inputs.rejected(name, order, "is given twice; give each order once")
        if rows is None:
            amplitudes[key] = _amplitude(f"{name}[{key}]", value)
        else:
            values = inputs.items(f"{name}[{key}]", value, "give one amplitude for each speed")
            if len(values) != rows:
                raise inputs.rejected(f"{name}[{key}]", value, f"give {rows}, one for each speed")
            amplitudes[key] = tuple(_amplitude(f"{name}[{key}]", component) for component in values)
    return read_only(dict(sorted(amplitudes.items())))


def _amplitude(name: str, value: object) -> complex:
    hint = "give a complex number, such as 8 + 3j"
    if isinstance(value, (str, bytes, bool)):
        raise inputs.rejected(name, value, hint)
    try:
        amplitude: complex = complex(value)  # type: ignore[call-overload] # anything that complex() takes
    except (TypeError, ValueError, OverflowError):
        raise inputs.rejected(name, value, hint) from None
    if not np.isfinite(amplitude):
        raise inputs.rejected(name, value, hint)
    return amplitude


def _rows(amplitudes: Mapping[Order, Any]) -> list[list[float]]:
    return [
        [
            order,
            *(
                part
                for component in np.atleast_1d(value)
                for part in (component.real, component.imag)
            ),
        ]
        for order, value in amplitudes.items()
    ]


def of_rows(rows: Iterable[Sequence[float]], *, table: bool) -> dict[Order, Any]:
    """Return amplitudes by order of rows of an order, then real and imaginary parts."""
    amplitudes: dict[Order, Any] = {}
    for order, *parts in rows:
        values = [complex(re, im) for re, im in zip(parts[::2], parts[1::2], strict=True)]
        amplitudes[int(order) if order == int(order) else order] = values if table else values[0]
    return amplitudes


def _orders_of(rows: np.ndarray[Any, Any], turns: int) -> dict[Order, list[complex]]:
    """Return the orders of samples over one or two turns, one amplitude for each row."""
    amplitudes = np.fft.rfft(rows) / rows.shape[1]
    # Real samples have each order twice, but the mean and, of an even number, the highest.
    amplitudes[:, 1 : (rows.shape[1] + 1) // 2] *= 2.0
    columns = amplitudes.T.tolist()[: turns * _core.HIGHEST_ORDER + 1]
    return {k if turns == 1 else _half(k): column for k, column in enumerate(columns)}


def _half(halves: int) -> Order:
    return halves // 2 if halves % 2 == 0 else 0.5 * halves


def _warn_of_jump(name: str, rows: np.ndarray[Any, Any]) -> None:
    for row in rows:
        inside = np.abs(np.diff(row)).max(initial=0.0)
        jump = abs(row[0] - row[-1])
        if jump > _LARGEST_STEP * inside > 0.0:
            where = "where its last sample is followed by the first"
            fault = f"jumps from {row[-1]:g} to {row[0]:g} {where}"
            warn(name, fault, "samples are to cover its period once")
            return
