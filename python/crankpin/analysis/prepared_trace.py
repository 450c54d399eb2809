"""Preparation of measured pressure: top dead centre, reference of the sensor, noise."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Literal

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Frames, Tabled
from crankpin._support.messages import Hint, suppressed, warn
from crankpin._support.record import item_key
from crankpin._support.tables import Column, Table
from crankpin.model import checks, odd_cycles
from crankpin.model.computed_cycles import area
from crankpin.model.cycle import Cycle
from crankpin.model.traces import SHOWN_ORDERS, Traces

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from crankpin.model.cylinder import Cylinder

LOSS_ANGLE = 0.7
"""Degrees by which pressure of a motored cylinder peaks before the top dead centre, since gas loses
heat and leaks: engines have 0.4 to 1.0."""
INTAKE = (-185.0, -175.0)
"""Crank angles, degrees, between which a cylinder has the pressure of its intake."""
COMPRESSION = (-100.0, -60.0)
"""Crank angles, degrees, between which compression is polytropic: after the intake has closed, and
before heat loss, a spark or injection count."""
NOISY = 0.005
"""Noise over peak pressure above which a warning is raised."""
ROUNDING = 1e-12
"""Work below zero, over that of the peak pressure, that rounding makes."""
NAMED = 5
"""Number of omitted cycles that a step names; of more it gives the count."""
FARTHEST_TDC = 5.0
"""Degrees by which encoders are off at most; more is another event or another cylinder's trace."""


def prepare_trace(
    traces: Traces,
    cylinder: Cylinder,
    *,
    motored: Traces | Cycle | None = None,
    loss_angle_deg: float | None = None,
    tdc_deg: float | None = None,
    lowpass_order: float | None = None,
    intake_pressure: float | Cycle | Traces | None = None,
    exponent: float | Literal["fit"] | None = None,
    compression_ratio: float | None = None,
    window_deg: tuple[float, float] | None = None,
    leave_out: Literal["odd"] | Iterable[int] | None = None,
    spikes: Literal["replace"] | None = None,
) -> PreparedTrace:
    """Return measured pressure with top dead centre, noise and offset corrected.

    The steps that arguments name are applied, in this order; each is reported with its change of
    mean effective pressure and of orders of the torque.

    Parameters
    ----------
    traces : Traces
        Measured cycles. Their pressure may be off by a constant, another one in each cycle.
    cylinder : Cylinder
        Cylinder with a bore.
    motored : Traces or Cycle, optional
        Pressure of the cylinder without combustion by the same encoder, from which the top dead
        centre is found: pressure peaks before it by the loss angle. A polynomial of degree 6
        through the points within 20° of the largest has that peak.
    loss_angle_deg : float, optional
        Loss angle, from the motored peak to the top dead centre, degrees; by default 0.7. Engines
        have 0.4 to 1.0.
    tdc_deg : float, optional
        Angle of the firing top dead centre as ``traces`` count, degrees, where it is known.
    lowpass_order : float, optional
        Order of crank speed at which a low-pass filter halves the amplitude. Butterworth of order
        4, forwards and backwards, which shifts no phase, over all cycles in a row.
    intake_pressure : float, Cycle or Traces, optional
        Absolute pressure of the intake, Pa. A cycle or traces are those of a sensor in it by the
        same encoder. It is
        that of the cylinder, on average, in the window about the lower dead centre before
        compression.
    exponent : float or "fit", optional
        Exponent of a polytropic compression, such as 1.3, or ``"fit"``. The offset is that by which
        pressure in the window best is ``C·V⁻ⁿ``. With ``"fit"`` the exponent itself is fitted
        to the mean cycle, which needs a trace of little noise.
    compression_ratio : float, optional
        Largest over smallest volume, for ``exponent``.
    window_deg : pair of float, optional
        Crank angles between which the reference is taken, degrees; by default -185 to -175 for the
        intake's pressure, -100 to -60 for a polytropic compression.
    leave_out : "odd" or iterable of int, optional
        Cycles to leave out before all else, by index from 0, or ``"odd"``. Those are what
        ``traces.anomalies`` names, spikes excepted.
    spikes : "replace", optional
        Whether to replace spikes: by the median over cycles plus the cycle's deviation from it,
        interpolated.
        Spikes that are kept count in imep and orders; offsets are computed without them.

    Returns
    -------
    PreparedTrace
        Cycles after all steps, their mean as ``cycle``, and the steps.

    Raises
    ------
    InputError
        If arguments exclude each other, one is missing or out of range, or a filter has a grid of
        uneven steps.

    Warns
    -----
    UserWarning
        If the top dead centre is far from that of the traces, much noise is left, pressure below
        zero is left, or pressure takes work from the crank; of a peak far from the top dead centre,
        which does all of this, once.

    Examples
    --------
    >>> import crankpin as cp
    >>> import numpy as np
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> theta, random = np.arange(-360.0, 360.0, 0.5), np.random.default_rng(0)
    >>> pressure = cp.Cycle.example().pressure_at(theta - 0.5) + 4e4
    >>> traces = cp.Traces(theta, pressure + random.normal(0, 5e3, (60, len(theta))))
    >>> prepared = cp.prepare_trace(traces, cylinder, tdc_deg=0.5, intake_pressure=0.95e5)
    >>> prepared.table.columns[0].values
    ('as measured', 'top dead centre at 0.5° (given)', 'intake at 0.95 bar: -0.400 ± 0.012 bar')
    >>> bool(abs(prepared.cycle.imep(cylinder) / cp.Cycle.example().imep(cylinder) - 1) < 1e-3)
    True
    """
    if not isinstance(traces, Traces):
        raise inputs.rejected("traces", traces, "give crankpin.Traces, such as Traces.load(path)")
    area(cylinder)
    _check_together(
        motored, loss_angle_deg, tdc_deg, intake_pressure, exponent, compression_ratio, window_deg
    )
    tdc, reference = 0.0, None
    with suppressed():  # Warned of where traces were made, and below.
        traces, name = _without(traces, leave_out)
        # Offsets are those of pressure without spikes, whether these stay or not.
        clean = traces.replace(pressure=traces._oddities.repaired(traces.pressure))
        names, stages = [name], [traces]
        if spikes is not None:
            inputs.one_of("spikes", spikes, ("replace",))
            stages.append(clean)
            names.append(_count_of_spikes(traces))
        if motored is not None or tdc_deg is not None:
            tdc, said = _top_dead_centre(motored, loss_angle_deg, tdc_deg)
            theta = traces.theta_deg - tdc
            stages.append(stages[-1].replace(theta_deg=theta))
            clean = clean.replace(theta_deg=theta)
            names.append(f"top dead centre at {tdc:.3g}° ({said})")
        if lowpass_order is not None:
            cutoff = inputs.finite("lowpass_order", lowpass_order)
            stages.append(_filtered(stages[-1], cutoff))
            clean = _filtered(clean, cutoff) if len(traces._oddities.spikes) else stages[-1]
            names.append(f"low-pass at order {cutoff:g} (Butterworth, zero phase)")
        offsets = np.zeros(len(traces))
        if intake_pressure is not None:
            window = _window(stages[-1], INTAKE if window_deg is None else window_deg, 1)
            reference = _reference(intake_pressure, stages[-1].theta_deg[window] + tdc)
            offsets = reference - clean.pressure[:, window].mean(axis=1)
            said = units.Text("intake at ", units.figure(reference / 1e5, "bar", 4))
        elif exponent is not None:
            window = _window(stages[-1], COMPRESSION if window_deg is None else window_deg, 3)
            theta, rows = stages[-1].theta_deg[window], clean.pressure[:, window]
            offsets, said = _compression(
                theta, rows, cylinder, clean.strokes, compression_ratio, exponent
            )
        if intake_pressure is not None or exponent is not None:
            stages.append(stages[-1].replace(pressure=stages[-1].pressure + offsets[:, None]))
            spread = [float(offsets.std(ddof=1))] if len(offsets) > 1 else []
            sizes = tuple(size / 1e5 for size in (float(offsets.mean()), *spread))
            change = units.Figure(sizes, "bar", ".3f", " ± ".join(["{}"] * len(sizes)))
            names.append(units.Text(said, ": ", "+" if sizes[0] >= 0.0 else "", change))
    if len(stages) > 1:
        # Of spikes traces have been warned of; a peak far from the dead centre is the cause of
        # whatever else is wrong, and has been warned of where it is theirs.
        last = stages[-1]
        if _far_peak(last) is None:
            with suppressed(odd_cycles.ABOUT):
                last.replace()
        elif _far_peak(traces) is None:
            checks.peak(last.theta_deg, last.pressure.mean(axis=0), last.period_deg)
    found = PreparedTrace(cylinder, tuple(names), tuple(stages), tdc, offsets)
    _warn(found, reference)
    return found


def _check_together(
    motored: object,
    loss_angle_deg: object,
    tdc_deg: object,
    intake_pressure: object,
    exponent: object,
    compression_ratio: object,
    window_deg: object,
) -> None:
    """Reject arguments that exclude each other, or act only beside another."""
    if motored is not None and tdc_deg is not None:
        raise inputs.rejected(
            "tdc_deg", tdc_deg, Hint.of("`motored` gives it; leave one of them out")
        )
    if intake_pressure is not None and exponent is not None:
        hint = Hint.of("`intake_pressure` gives the reference; leave one of them out")
        raise inputs.rejected("exponent", exponent, hint)
    if motored is None:
        inputs.only_with("motored", loss_angle_deg=loss_angle_deg)
    if exponent is None:
        inputs.only_with("exponent", compression_ratio=compression_ratio)
        if intake_pressure is None:
            inputs.only_with("intake_pressure", window_deg=window_deg)


def _far_peak(traces: Traces) -> float | None:
    """Return the angle of the mean's peak if it is far from the firing top dead centre."""
    return checks.far_peak(traces.theta_deg, traces.pressure.mean(axis=0), traces.period_deg)


def _warn(found: PreparedTrace, reference: float | None) -> None:
    """Warn of a top dead centre that is far off, of noise, of negative work, and of other units."""
    if reference is not None:
        checks.absolute("intake_pressure", reference)
    far = _far_peak(found.traces)
    if far is None and abs(found.tdc_deg) > FARTHEST_TDC:
        hint = (
            "more than an encoder is off; are traces and motored of one cylinder and one encoder, "
            "and is the event of its origin that of the file?"
        )
        warn("tdc_deg", f"= {found.tdc_deg:.4g}", hint)
    noise, largest = found.traces.noise, float(found.traces.pressure.mean(axis=0).max())
    if noise > NOISY * largest:
        share = f"{100.0 * noise / largest:.2g} % of their peak"
        hint = Hint.of("filter it with `lowpass_order=…`, and see how imep and orders change")
        warn("traces", f"have noise of {noise / 1e5:.3g} bar, {share}", hint)
    imep = float(found.traces.imep(found.cylinder).mean())
    if far is None and imep < -ROUNDING * largest:
        hint = (
            "pressure takes work from the crank. Is the trace a motored one? If not, is the top "
            "dead centre right?"
        )
        warn("imep", f"= {imep / 1e5:.3g} bar", hint)


class PreparedTrace(Tabled):
    """Measured pressure before and after each step of its preparation.

    ``plot`` draws the mean before and after, in the band of cycles, and below it the change; on
    axes that were given the pressures alone. Made by :func:`crankpin.prepare_trace`.
    """

    cylinder: Cylinder
    """The cylinder."""
    names: tuple[str, ...]
    """Names of the steps; the first is the trace as measured."""
    stages: tuple[Traces, ...]
    """Cycles after each step."""
    tdc_deg: float
    """Angle of the firing top dead centre as the traces counted, degrees."""
    offsets: NDArray[np.float64]
    """Pressure added to each cycle, Pa: (n_cycles,)."""

    def __post_init__(self) -> None:
        area(self.cylinder)
        if len(self.names) != len(self.stages) or not self.stages:
            raise inputs.rejected("stages", self.stages, "use crankpin.prepare_trace")
        inputs.number("tdc_deg", self.tdc_deg)
        inputs.vector("offsets", self.offsets)
        super().__post_init__()

    @property
    def traces(self) -> Traces:
        """Cycles after all steps."""
        return self.stages[-1]

    @property
    def cycle(self) -> Cycle:
        """Mean cycle after all steps, for :meth:`Engine.with_cycle`."""
        return self.traces.mean_cycle

    def imep(self) -> NDArray[np.float64]:
        """Return the mean effective pressure of each cycle after each step, Pa.

        Returns
        -------
        ndarray of float, shape (n_stages, n_cycles)
            Indicated mean effective pressures, Pa.
        """
        return np.array([each.imep(self.cylinder) for each in self.stages])

    @functools.cached_property
    def _phasors(self) -> NDArray[np.complex128]:
        """Mean phasors of the torque by step and order, N·m."""
        of_cycles = (each.torque_harmonics(self.cylinder, SHOWN_ORDERS) for each in self.stages)
        return np.array([each.mean(axis=0) for each in of_cycles])

    @property
    def table(self) -> Table:
        """Change of mean effective pressure and of the torque's orders by each step."""
        imep = [float(each.imep(self.cylinder).mean()) for each in self.stages]
        phasors = self._phasors
        before = [0, *range(len(self.stages) - 1)]
        with np.errstate(divide="ignore", invalid="ignore"):
            of_imep = [100.0 * (imep[k] / imep[j] - 1.0) for k, j in enumerate(before)]
            moved = 100.0 * np.abs(phasors - phasors[before]) / np.abs(phasors[before])
        columns = [
            Column("step", self.names),
            Column("imep", tuple(each / 1e5 for each in imep), "bar"),
            Column("changes", tuple(of_imep), "%", digits=3),
            *(
                Column(f"order {order:g}", each, "%", digits=3)
                for order, each in zip(SHOWN_ORDERS, moved.T, strict=True)
            ),
        ]
        note = "Orders: magnitude of the change of the torque's phasor, over that before."
        return Table(f"Prepared trace of {self.title}: change by step", tuple(columns), note)

    @property
    def frames(self) -> Frames:
        """``table``; ``orders``: peaks, noise and amplitudes by step; ``spread``: over cycles."""
        return self._frames(orders=self._orders, spread=lambda: self.traces.spread(self.cylinder))

    def _orders(self) -> Table:
        rows = [
            (
                name,
                float(each.pressure.mean(axis=0).max()) / 1e5,
                each.noise / 1e5,
                100.0 * each.cov(self.cylinder),
                *np.abs(phasors).tolist(),
            )
            for name, each, phasors in zip(self.names, self.stages, self._phasors, strict=True)
        ]
        heads: list[str | tuple[str, str]] = [
            "step", ("peak", "bar"), ("noise", "bar"), ("COV of imep", "%"),
            *((f"order {order:g}", "N·m") for order in SHOWN_ORDERS),
        ]  # fmt: skip
        return Table.from_rows("Peak, noise, spread and amplitudes of torque", heads, rows)

    @property
    def title(self) -> str:
        """Title of table and picture."""
        name = labels.one_line(self.traces.name) or "Traces"
        return f"{labels.cut(name)}, {len(self.traces)} cycles"


# --- steps ----------------------------------------------------------------------------------------


def _without(traces: Traces, leave_out: object) -> tuple[Traces, str]:
    """Return the traces without some cycles, and what was done."""
    name = "as measured"
    if leave_out is None:
        return traces, name
    kinds = {each.cycle: each.kind for each in traces._oddities.listed if each.kind != "spike"}
    if isinstance(leave_out, str):
        inputs.one_of("leave_out", leave_out, ("odd",))
        out = list(kinds)
    else:
        hint = 'give indices of cycles, or "odd"'
        listed = inputs.items("leave_out", leave_out, hint)
        out = sorted({item_key(each, len(traces), "leave_out") % len(traces) for each in listed})
    if not out:
        return traces, f"{name}, no cycle left out"
    said = [f"{k} ({kinds[k]})" if k in kinds else str(k) for k in out]
    more = f" and {len(said) - NAMED} more" if len(said) > NAMED else ""
    name += f", without cycle{'s' * (len(out) > 1)} {', '.join(said[:NAMED])}{more}"
    return traces.without_cycles(out), name


def _count_of_spikes(traces: Traces) -> str:
    count = sum(each.kind == "spike" for each in traces._oddities.listed)
    return f"{count} spike{'s' * (count != 1)} replaced"


def _top_dead_centre(
    motored: Traces | Cycle | None, loss_angle_deg: float | None, tdc_deg: float | None
) -> tuple[float, str]:
    """Return the angle of the top dead centre, and its source."""
    if motored is None:
        return inputs.finite("tdc_deg", tdc_deg), "given"
    if not isinstance(motored, (Traces, Cycle)):
        raise inputs.rejected("motored", motored, "give crankpin.Traces, or a Cycle")
    loss = LOSS_ANGLE if loss_angle_deg is None else inputs.finite("loss_angle_deg", loss_angle_deg)
    # As far as encoders are off, whatever turn the file counts from.
    pressure = np.atleast_2d(motored.pressure).mean(axis=0)
    peak = _core.compression_peak(motored.theta_deg, pressure, motored.period_deg)
    at = float(checks.about_tdc(np.array([peak]), motored.period_deg)[0])
    said = "assumed" if loss_angle_deg is None else "given"
    return at + loss, f"motored peak at {at:.3f}°, loss angle {loss:g}°, {said}"


def _filtered(traces: Traces, cutoff: float) -> Traces:
    """Return cycles without the orders above one: all in a row, as they were measured."""
    return traces.replace(
        pressure=_core.low_passed(traces.theta_deg, traces.pressure, traces.period_deg, cutoff)
    )


def _window(traces: Traces, window_deg: object, fewest: int) -> NDArray[np.bool_]:
    """Return which points are between two crank angles."""
    pair = inputs.vector("window_deg", window_deg)  # type: ignore[arg-type] # checked there
    if len(pair) != 2 or not 0.0 < pair[1] - pair[0] < traces.period_deg:
        raise inputs.rejected("window_deg", window_deg, "give two angles, ascending, in one period")
    inside = (traces.theta_deg - pair[0]) % traces.period_deg <= pair[1] - pair[0]
    if int(inside.sum()) < fewest:
        fault = f"has {int(inside.sum())} points of the trace in it"
        raise inputs.faulty("window_deg", fault, f"give a wider one, with {fewest} at least")
    return np.asarray(inside)


def _reference(intake_pressure: object, at_deg: NDArray[np.float64]) -> float:
    """Return the absolute pressure in the intake, Pa: a number, or the mean of a sensor's."""
    if isinstance(intake_pressure, Traces):
        intake_pressure = intake_pressure.mean_cycle
    if isinstance(intake_pressure, Cycle):
        return float(intake_pressure.pressure_at(at_deg).mean())
    value = inputs.finite("intake_pressure", intake_pressure)
    if not value > 0.0:
        raise inputs.rejected("intake_pressure", value, "give absolute pressure, Pa, above zero")
    return value


def _compression(
    theta_deg: NDArray[np.float64],
    rows: NDArray[np.float64],
    cylinder: Cylinder,
    strokes: int,
    compression_ratio: float | None,
    exponent: float | Literal["fit"],
) -> tuple[NDArray[np.float64], str]:
    """Return what must be added to each cycle that it is ``C·V⁻ⁿ`` in a window, and how."""
    if compression_ratio is None:
        raise inputs.rejected("compression_ratio", None, "a polytropic compression needs it")
    ratio = inputs.finite("compression_ratio", compression_ratio)
    fitted = isinstance(exponent, str)
    number = None
    if isinstance(exponent, str):
        inputs.one_of("exponent", exponent, ("fit",))
    else:
        number = inputs.finite("exponent", exponent)
        if not 1.0 <= number <= 2.0:
            raise inputs.rejected("exponent", number, "give 1.25 to 1.4, or one between 1 and 2")
    figures = (cylinder._parts, cylinder.bore, ratio, strokes)
    n, offsets = _core.polytropic_offsets(figures, theta_deg, rows, number)
    how = f"{n:.3f} (fitted)" if fitted else f"{n:g} (given)"
    return offsets, f"compression with n = {how}"
