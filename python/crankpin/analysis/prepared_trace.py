"""Preparation of measured pressure: top dead centre, reference of the sensor, noise."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Literal

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, lazy, units
from crankpin._support.frames import Frames, Tabled
from crankpin._support.record import item_key
from crankpin._support.tables import Column, Table
from crankpin._support.warnings import suppressed, warn
from crankpin.model import checks, odd_cycles
from crankpin.model.computed_cycles import area
from crankpin.model.cycle import Cycle
from crankpin.model.traces import SHOWN_ORDERS, Traces

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from crankpin.model.cylinder import Cylinder

LOSS_ANGLE = 0.7
"""Degrees by which pressure of a motored cylinder peaks before the top dead centre, since gas loses
heat and leaks: engines have 0.4 to 1.0."""
AROUND_PEAK = 20.0
"""Degrees beside the peak of a motored trace within which a polynomial is fitted to it."""
DEGREE_AT_PEAK = 6
"""Its degree: what it leaves of compression, 1e-3, is even and moves no peak; noise of 0.1 bar at
every half degree moves it by 0.1°, in the mean of 60 cycles by 0.01°."""
INTAKE = (-185.0, -175.0)
"""Crank angles, degrees, between which a cylinder has the pressure of its intake."""
COMPRESSION = (-100.0, -60.0)
"""Crank angles, degrees, between which compression is polytropic: after the intake has closed, and
before heat loss, a spark or injection count."""
EXPONENTS = (1.15, 1.45)
"""Range in which the exponent of compression is fitted: air has 1.4, rich mixtures 1.25."""
DEGREE_BY_EXPONENT = 16
"""Degree of the polynomial through what is left at exponents of that range: exact to rounding."""
STEEPNESS = 4
"""Order of the Butterworth filter."""
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
            volume = _volumes(stages[-1], cylinder, compression_ratio, window)
            offsets, said = _polytropic(clean.pressure[:, window], volume, exponent)
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
            with suppressed(odd_cycles.BEGINNING):
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
        raise inputs.rejected("tdc_deg", tdc_deg, "motored gives it; leave one of them out")
    if intake_pressure is not None and exponent is not None:
        hint = "intake_pressure gives the reference; leave one of them out"
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
        warn(
            f"tdc_deg = {found.tdc_deg:.4g}: more than an encoder is off; are traces and motored "
            "of one cylinder and one encoder, and is the event of its origin that of the file?"
        )
    noise, largest = found.traces.noise, float(found.traces.pressure.mean(axis=0).max())
    if noise > NOISY * largest:
        warn(
            f"traces have noise of {noise / 1e5:.3g} bar, {100.0 * noise / largest:.2g} % of their "
            "peak: filter it with lowpass_order=…, and see how imep and orders change"
        )
    imep = float(found.traces.imep(found.cylinder).mean())
    if far is None and imep < -ROUNDING * largest:
        warn(
            f"imep = {imep / 1e5:.3g} bar: pressure takes work from the crank. Is the trace a "
            "motored one? If not, is the top dead centre right?"
        )


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
        return self.traces.mean

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
    at = float(checks.about_tdc(np.array([compression_peak(motored)]), motored.period_deg)[0])
    said = "assumed" if loss_angle_deg is None else "given"
    return at + loss, f"motored peak at {at:.3f}°, loss angle {loss:g}°, {said}"


def compression_peak(motored: Traces | Cycle) -> float:
    """Return the crank angle of the largest pressure of a motored cycle, between points, degrees.

    It is the root of the derivative of a polynomial, fitted to the points about the largest one,
    at which the noise of one point would decide.
    """
    half, theta = motored.period_deg / 2.0, motored.theta_deg
    pressure = np.atleast_2d(motored.pressure).mean(axis=0)
    largest = float(theta[pressure.argmax()])
    away = (theta - largest + half) % (2.0 * half) - half
    near = np.abs(away) <= AROUND_PEAK
    if int(near.sum()) <= DEGREE_AT_PEAK + 2:
        fault = f"has {int(near.sum())} points within {AROUND_PEAK:g}° of its peak"
        raise inputs.faulty("motored", fault, "give a finer one")
    fit = np.polynomial.Polynomial.fit(away[near], pressure[near], DEGREE_AT_PEAK)
    roots = fit.deriv().roots()
    inside = roots[(abs(roots.imag) < 1e-9) & (abs(roots.real) < AROUND_PEAK)].real
    if not len(inside):
        raise inputs.faulty("motored", "has no peak", "give the trace of a motored cylinder")
    return float(largest + inside[fit(inside).argmax()])


def _filtered(traces: Traces, cutoff: float) -> Traces:
    """Return cycles without the orders above one: all in a row, as they were measured."""
    theta = traces.theta_deg
    closed = len(theta) > 1 and theta[-1] - theta[0] > traces.period_deg * (1.0 - 1e-9)
    rows = traces.pressure[:, :-1] if closed else traces.pressure
    steps = np.diff(theta)
    if np.ptp(steps) > 1e-3 * float(steps.max()):
        raise inputs.faulty("traces", "have steps that differ", "filters need equal steps")
    highest = rows.shape[1] * 180.0 / traces.period_deg
    if not _core.SMALLEST <= cutoff < highest:
        hint = f"give an order above 0 and below {highest:g}, half the points of a turn"
        raise inputs.rejected("lowpass_order", cutoff, hint)
    smooth = _convolved(
        rows,
        lambda turns: 1.0 / (1.0 + (turns * 360.0 / traces.period_deg / cutoff) ** (2 * STEEPNESS)),
    )
    if closed:
        smooth = np.column_stack([smooth, smooth[:, :1]])
    return traces.replace(pressure=smooth)


def _convolved(
    rows: NDArray[np.float64], gain: Callable[[NDArray[np.float64]], NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Return rows, one after the other, their spectrum times a gain of periods in a row.

    The transform of all is one over rows and one over columns, with a twist between, so that no
    step takes long: Ctrl-C is answered between them.
    """
    count, length = rows.shape
    fft = lazy.imported("numpy.fft")
    twist = -2j * np.pi / rows.size * np.arange(length)
    spectra = np.empty((count // 2 + 1, length), complex)
    for part in _parts(length, count):
        spectra[:, part] = fft.rfft(rows[:, part], axis=0)
    for k, spectrum in enumerate(spectra):
        turned = np.exp(k * twist)
        turns = np.abs(fft.fftfreq(length, 1.0 / length) + k / count)
        spectrum[:] = fft.ifft(fft.fft(spectrum * turned) * gain(turns)) * turned.conj()
    smooth = np.empty(rows.shape)
    for part in _parts(length, count):
        smooth[:, part] = fft.irfft(spectra[:, part], count, axis=0)
    return smooth


def _parts(length: int, count: int) -> Iterator[slice]:
    """Yield slices of columns of ``count`` rows, of at most :data:`PIECE` numbers."""
    step = max(1, inputs.PIECE_NUMBERS // count)
    return (slice(start, start + step) for start in range(0, length, step))


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
        intake_pressure = intake_pressure.mean
    if isinstance(intake_pressure, Cycle):
        return float(intake_pressure.pressure_at(at_deg).mean())
    value = inputs.finite("intake_pressure", intake_pressure)
    if not value > 0.0:
        raise inputs.rejected("intake_pressure", value, "give absolute pressure, Pa, above zero")
    return value


def _volumes(
    traces: Traces, cylinder: Cylinder, compression_ratio: float | None, window: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Return the volume over the smallest one at the points of a window."""
    if compression_ratio is None:
        raise inputs.rejected("compression_ratio", None, "a polytropic compression needs it")
    ratio, at = inputs.finite("compression_ratio", compression_ratio), traces.theta_deg[window]
    return _core.volume_ratios(cylinder._parts, cylinder.bore, ratio, traces.strokes, at)


def _polytropic(
    pressure: NDArray[np.float64], volume: NDArray[np.float64], exponent: float | Literal["fit"]
) -> tuple[NDArray[np.float64], str]:
    """Return what must be added to each cycle that it is ``C·V⁻ⁿ``, and how."""
    if isinstance(exponent, str):
        inputs.one_of("exponent", exponent, ("fit",))
        n = _fitted(pressure.mean(axis=0), volume)
        said = f"compression with n = {n:.3f} (fitted)"
    else:
        n = inputs.finite("exponent", exponent)
        if not 1.0 <= n <= 2.0:
            raise inputs.rejected("exponent", n, "give 1.25 to 1.4, or one between 1 and 2")
        said = f"compression with n = {n:g} (given)"
    constant = _line(pressure, volume, n)[0]
    return -constant, said


def _line(
    pressure: NDArray[np.float64], volume: NDArray[np.float64], n: float
) -> tuple[NDArray[np.float64], float]:
    """Return the constants of the best ``constant + C·V⁻ⁿ`` and the sum of squares left."""
    matrix = np.column_stack([np.ones(len(volume)), volume**-n])
    rows = np.atleast_2d(pressure)
    found = np.linalg.lstsq(matrix, rows.T, rcond=None)[0]
    return np.asarray(found[0]), float(((matrix @ found - rows.T) ** 2).sum())


def _fitted(pressure: NDArray[np.float64], volume: NDArray[np.float64]) -> float:
    """Return the exponent that leaves the least sum of squares."""
    curve = np.polynomial.Chebyshev.interpolate(
        lambda exponents: np.array([_line(pressure, volume, n)[1] for n in exponents]),
        DEGREE_BY_EXPONENT,
        EXPONENTS,
    )
    roots = curve.deriv().roots()
    real = roots.real[abs(roots.imag) < 1e-9]
    n = float(min(np.clip([*EXPONENTS, *real], *EXPONENTS), key=curve))
    if min(n - EXPONENTS[0], EXPONENTS[1] - n) < 1e-3:
        fault = f"is {n:.3f} at best, an end of {EXPONENTS[0]:g} to {EXPONENTS[1]:g}"
        hint = "the window has no compression, or noise: give a number"
        raise inputs.faulty("exponent", fault, hint)
    return n
