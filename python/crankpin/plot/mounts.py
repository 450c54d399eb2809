"""An engine on its mounts: energy of its modes, and forces over order and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.patches import Rectangle

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.record import changed
from crankpin.analysis.mounts.modes import COORDINATES, OF_SUBFRAME, PLACES, MountModes
from crankpin.analysis.mounts.response import READ, MountResponse, PointMotion
from crankpin.analysis.quantity import ALL, Quantity
from crankpin.model.supports import Receptance
from crankpin.plot.layout import add_legend, axes_or_new, note_zero, set_title
from crankpin.plot.maps import RANGE, cells, colour_bar
from crankpin.plot.painter import draw_curves, highest, x_axis, y_axis
from crankpin.plot.style import (
    SERIES,
    background,
    colour_map,
    colours,
    foreground,
    muted,
    series,
    tint,
)
from crankpin.plot.words import joined, plain_text, rounded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order, Orders

MOST_CURVES = 5
"""Number of orders drawn over speed where they were not given: those of the largest peaks."""
MOST_SPECTRA = 40
"""Number of speeds whose spectra a waterfall draws."""
TALLEST = 4.0
"""Height of the largest peak of a waterfall, in steps from one spectrum to the next."""
DEEPEST = 0.6
"""Strength of the colour that stands for all of the energy."""
APART = 1.3
"""Ratio of frequencies within which a waterfall names one order alone."""
AT = 20.0
"""Frequency at which a map takes stiffness that depends on it, Hz."""
CRANK_SPEED = "crank speed, rpm"
SEEN = 1e-3
"""Part of the largest peak, or of a whole, below which an order or a share is not drawn."""


@picture.register(MountModes)
def _modes(result: MountModes, ax: Axes | None = None, **style: object) -> Axes:
    """Draw the kinetic energy of each mode by coordinate.

    Parameters
    ----------
    **style : dict, optional
        ``cmap`` and other properties of matplotlib images.
    """
    ax = axes_or_new(ax)
    energy, names = result.energy[list(PLACES)].T, list(COORDINATES)
    if len(result.energy) > 6:
        energy, names = (
            np.column_stack([energy, np.asarray(result.subframe_share)]),
            [*names, OF_SUBFRAME],
        )
    (colour,) = colours(ax, 1)
    # From the background to what texts are still read on.
    shades = LinearSegmentedColormap.from_list(
        "energy", [background(ax), tint(ax, colour, DEEPEST)]
    )
    options: dict[str, Any] = {"cmap": shades, "vmin": 0.0, "vmax": 100.0, "aspect": "auto"}
    ax.imshow(energy, **(options | style))
    for (mode, place), share in np.ndenumerate(energy):
        if share < -100.0 * SEEN:
            cell = Rectangle((place - 0.5, mode - 0.5), 1.0, 1.0, fill=False, hatch="///")
            cell.set(edgecolor=muted(ax, 0.5), linewidth=0.0)
            ax.add_patch(cell)
        look: dict[str, Any] = {"ha": "center", "va": "center", "color": foreground(ax)}
        ax.text(place, mode, rounded(share, 2) if abs(share) >= 100.0 * SEEN else "0", **look)
    ax.set_xticks(range(len(names)), names)
    frequencies = [f"{k + 1}:  {rounded(f, 3)} Hz" for k, f in enumerate(result.frequency)]
    ax.set_yticks(range(len(frequencies)), frequencies)
    ax.tick_params(length=0.0)
    ax.spines[:].set_visible(False)
    hatched = "hatched: below zero" if ax.patches else ""
    what = "kinetic energy of each mode φₖ(Mφ)ₖ, %"
    set_title(ax, labels.name_of(result.powertrain), joined(what, hatched))
    return ax


class Drawn(NamedTuple):
    """A vector by order, in the unit in which it is drawn."""

    result: MountResponse
    vector: Quantity
    unit: str = "N"
    factor: float = 1.0
    orders: tuple[Order, ...] = ()
    """Orders that are drawn."""

    @property
    def peak(self) -> units.Text:
        """Label of an axis, or of a scale of colours."""
        return units.headed("peak", self.unit)

    @property
    def largest(self) -> tuple[Order, ...]:
        """Orders that are seen beside the largest, ascending, or those given to the response."""
        orders = self.result.orders
        if self.result._request.orders is not None:
            return orders
        peaks = np.reshape(self.read(None), (-1, len(orders))).max(axis=0, initial=0.0)
        is_large = peaks > SEEN * peaks.max(initial=0.0)
        return tuple(order for order, is_seen in zip(orders, is_large, strict=True) if is_seen)

    def read(self, order: Order | str | None, name: str = "peak") -> NDArray[np.float64]:
        """Return an array of the vector at an order, at ``"all"``, or of every order."""
        return self.factor * np.asarray(getattr(changed(self.vector, order=order), name))


@picture.register(MountResponse)
def _response(
    result: MountResponse,
    ax: Axes | None = None,
    *,
    kind: str | None = None,
    mount: str | None = None,
    orders: Orders | None = None,
    **style: Any,  # noqa: ANN401 - as `_picture` takes them
) -> Axes:
    """Draw the force on the body, or of one mount.

    Parameters
    ----------
    kind : {"cuts", "map", "waterfall", "spectrum"}, optional
        ``"cuts"``, the default of several speeds: the longest vector of all orders together and
        of the largest orders over speed; ``"map"``: a row of cells for each order over speed,
        with the natural frequencies; ``"waterfall"``: a spectrum over frequency for each speed,
        one above the other, of at most 40 speeds; ``"spectrum"``, that of one speed: peaks
        along x, y and z over order.
    mount : str, optional
        Name of a mount; by default the sum of all.
    orders : sequence of float, optional
        Orders that are drawn; by default those given to the response, or else those that are
        not zero, of ``"cuts"`` the largest.
    **style : dict, optional
        ``label``, for a legend of several results on the same axes; colour, line width and
        other properties of what is drawn.

    Examples
    --------
    >>> import crankpin as cp
    >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
    >>> mounts = [
    ...     cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1)
    ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
    ... ]
    >>> r = cp.Powertrain(cp.Engine.preset("i4"), body, mounts).response(rpm=[800, 900, 1000])
    >>> ax = r.plot(kind="map")
    >>> ax = r.sel(rpm=900).plot(mount="a")
    """
    name = mount if mount is None else inputs.one_of("mount", mount, result.powertrain.names)
    force = result.body_force if name is None else result.mount_force[name]
    words = "force on the body" if name is None else f"force of mount {name}"
    return _picture(Drawn(result, force), words, ax, kind=kind, orders=orders, **style)


@picture.register(PointMotion)
def _point(
    motion: PointMotion,
    ax: Axes | None = None,
    *,
    kind: str | None = None,
    quantity: str = "velocity",
    orders: Orders | None = None,
    **style: Any,  # noqa: ANN401 - as above
) -> Axes:
    """Draw the motion over speed or order.

    Parameters
    ----------
    kind : {"cuts", "map", "waterfall", "spectrum"}, optional
        ``"cuts"``, the default of several speeds: all orders together and the largest over speed;
        ``"map"``: a row of cells for each order over speed; ``"waterfall"``: a spectrum for each
        speed, one above the other; ``"spectrum"``, that of one speed: peaks over order.
    quantity : {"displacement", "velocity", "acceleration"}, default "velocity"
        What is drawn: peaks in µm, mm/s or m/s².
    orders : sequence of float, optional
        Orders that are drawn; by default those given to the response, or else those that are
        not zero; of the motion in one order, that.
    """
    name = inputs.one_of("quantity", quantity, READ)
    if orders is None and motion.order != ALL:
        orders = motion.order
    words = plain_text(f"{name} of {motion._words}")
    drawn = Drawn(motion.result, Quantity(motion, name), *READ[name])
    return _picture(drawn, words, ax, kind=kind, orders=orders, **style)


def _picture(
    drawn: Drawn,
    words: str,
    ax: Axes | None,
    *,
    kind: str | None = None,
    orders: Orders | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw a vector by order, of a kind."""
    kinds = {"cuts": _cuts, "map": _map, "waterfall": _waterfall, "spectrum": _spectrum}
    result = drawn.result
    several = bool(result.dims)
    chosen = inputs.one_of("kind", kind or ("cuts" if several else "spectrum"), kinds)
    if chosen in ("map", "waterfall") and "rpm" not in result.dims and several:
        raise inputs.rejected(
            "kind", chosen, "is of orders over speed: the base moves by frequency"
        )
    if several == (chosen == "spectrum"):
        hint = "needs several speeds"
        if several:
            kind_of = "speed" if "rpm" in result.dims else "frequency"
            hint = f"give one {kind_of}, as r.sel({result.dims[0]}=…)"
        raise inputs.rejected("kind", chosen, hint)
    ax = axes_or_new(ax)
    chosen_orders = drawn.largest if orders is None else inputs.explicit_half_orders(orders)
    notes = kinds[chosen](ax, drawn._replace(orders=tuple(chosen_orders)), label, style)
    speed = "" if several else result._at().removeprefix("at ")
    set_title(
        ax, labels.name_of(result.powertrain), joined(words, speed, result.loads_counted), notes
    )
    return ax


def _cuts(ax: Axes, drawn: Drawn, label: str | None, style: dict[str, Any]) -> str:
    """Draw the largest orders over speed, and all together."""
    result = drawn.result
    peaks = {order: drawn.read(order) for order in drawn.orders}
    by_size = sorted(peaks, key=lambda order: -float(peaks[order].max()))
    largest = sorted(by_size if result._request.orders is not None else by_size[:MOST_CURVES])
    ((name, values),) = result.coords.items()
    rpm = np.asarray(values)
    along = np.argsort(rpm, kind="stable")
    total = drawn.read(ALL)
    if name != "rpm":  # of a base that moves by frequency
        draw_curves(ax, rpm[along], {"": total[along]}, style, label)
        x_axis(ax, "frequency, Hz", rpm)
        y_axis(ax, drawn.peak, largest=highest(ax))
        add_legend(ax)
        return ""
    bold = {"color": foreground(ax), "linewidth": 1.8} | style | {"linestyle": "-"}
    draw_curves(ax, rpm[along], {"all orders": total[along]}, bold, label)
    columns = {f"order {order}": peaks[order][along] for order in largest}
    draw_curves(ax, rpm[along], columns, style, label)
    x_axis(ax, CRANK_SPEED, rpm)
    y_axis(ax, drawn.peak, largest=highest(ax))
    add_legend(ax)
    rest = len(result.orders) - len(largest)
    is_cut = rest and len(largest) == MOST_CURVES and result._request.orders is None
    return f"the {len(largest)} largest of {len(result.orders)} orders" if is_cut else ""


def _map(ax: Axes, drawn: Drawn, label: str | None, style: dict[str, Any]) -> str:
    """Draw a row of cells for each order over speed; the modes' frequencies across them."""
    rpm = _speeds(drawn.result, "map", label)
    peaks = np.stack([drawn.read(order) for order in drawn.orders], axis=-1)[..., np.newaxis]
    x_axis(ax, CRANK_SPEED)
    y_axis(ax, "order", whole=True)
    if not peaks.any():
        note_zero(ax)
        return ""
    largest = float(peaks.max())
    peaks = np.where(peaks > 0.0, np.maximum(peaks, RANGE * largest), 0.0)
    norm = LogNorm(RANGE * largest, largest)
    mesh = cells([ax], rpm, drawn.orders, peaks, {"norm": norm} | style)
    natural, note = _natural(drawn.result)
    fine = np.linspace(max(float(rpm.min()), 1.0), float(rpm.max()), 400)
    colour_bar([ax], mesh, drawn.peak, peaks)
    limits = ax.get_ylim()
    _dashed(ax, [(fine, 60.0 * frequency / fine) for frequency in natural], "black")
    ax.set_xlim(float(rpm.min()), float(rpm.max()))
    ax.set_ylim(limits)
    return note


def _speeds(result: MountResponse, kind: str, label: str | None) -> NDArray[np.float64]:
    """Return the speeds of a picture that has no legend and takes two speeds or more."""
    if label is not None:
        raise inputs.rejected("label", label, f"a {kind} has no legend of several results")
    rpm = np.asarray(result.rpm)
    if len(np.unique(rpm)) < 2:
        raise inputs.rejected("kind", kind, "needs two different speeds or more")
    return rpm


def _natural(result: MountResponse) -> tuple[NDArray[np.float64], str]:
    """Return the natural frequencies above zero, Hz, and a note on the lines that are drawn."""
    if isinstance(result.powertrain.support, Receptance):
        return np.empty(0), ""
    varies = result.powertrain._varies
    frequency = result.powertrain.modes(AT if varies else None).frequency
    at = f", with the stiffness at {AT:g} Hz" if varies else ""
    return frequency[frequency > 0.0], f"dashed: natural frequencies{at}"


def _waterfall(ax: Axes, drawn: Drawn, label: str | None, style: dict[str, Any]) -> str:
    """Draw the spectrum over frequency of each speed, a step above that of the one below it."""
    every = _speeds(drawn.result, "waterfall", label)
    _, first = np.unique(every, return_index=True)
    picked = first[
        np.unique(np.linspace(0, len(first) - 1, min(MOST_SPECTRA, len(first))).round().astype(int))
    ]
    rpm = every[picked]
    peaks = np.array([drawn.read(order)[picked] for order in drawn.orders])
    x_axis(ax, "frequency, Hz")
    y_axis(ax, CRANK_SPEED)
    if not peaks.any():
        note_zero(ax)
        return ""
    frequency = np.multiply.outer(np.array(drawn.orders, dtype=np.float64), rpm / 60.0)
    step = float(rpm[-1] - rpm[0]) / (len(rpm) - 1)
    largest = float(peaks.max())
    norm = LogNorm(SEEN * largest, largest, clip=True)
    tips = rpm + TALLEST * step * np.asarray(norm(peaks))
    natural, note = _natural(drawn.result)
    seen = frequency[frequency > 0.0]
    left, right = 0.9 * min([float(seen.min()), *natural]), 1.1 * float(seen.max())
    base: dict[str, Any] = {"color": muted(ax, 0.2), "linewidth": 0.6, "zorder": 1}
    ax.hlines(rpm, left, right, **base)
    feet = np.broadcast_to(rpm, tips.shape)
    ends = np.stack([np.stack([frequency, feet], -1), np.stack([frequency, tips], -1)], -2)
    # The least on top of nothing: the largest are drawn last.
    along = np.argsort(peaks, axis=None, kind="stable")
    options: dict[str, Any] = {"cmap": colour_map(ax), "norm": norm}
    options |= {"linewidth": 1.6, "zorder": 2.0} | style
    stems = LineCollection(list(ends.reshape(-1, 2, 2)[along]), **options)
    stems.set_array(peaks.ravel()[along])
    ax.add_collection(stems)
    low, high = float(rpm[0]), float(tips.max())
    limits = low - 0.5 * step, high + 0.1 * (high - low)
    upright = [((frequency, frequency), limits) for frequency in natural if frequency < right]
    colour_bar([ax], stems, drawn.peak, np.maximum(peaks, SEEN * largest))
    _dashed(ax, upright, muted(ax, 0.7))
    _name_orders(ax, drawn.orders, peaks, np.stack([frequency[:, -1], tips[:, -1] + 0.2 * step]))
    ax.set_xscale("log")
    ax.set_xlim(left, right)
    ax.set_ylim(*limits)
    return note


def _dashed(ax: Axes, modes: Sequence[tuple[Any, Any]], colour: ColorType) -> None:
    """Draw a dashed line, x and y, for each mode."""
    look: dict[str, Any] = {"color": colour, "linewidth": 0.9, "linestyle": (0, (4, 2))}
    for along, height in modes:
        ax.plot(along, height, gid="crankpin modes", zorder=1.5, **look)


def _name_orders(
    ax: Axes, orders: tuple[Order, ...], peaks: NDArray[np.float64], ends: NDArray[np.float64]
) -> None:
    """Write the largest orders above their ends, as far as these are apart."""
    taken: list[float] = []
    look: dict[str, Any] = {"ha": "center", "va": "bottom", "color": foreground(ax)}
    for k in np.argsort(-peaks.max(axis=1), kind="stable"):
        frequency, height = map(float, ends[:, k])
        if all(max(frequency / other, other / frequency) > APART for other in taken):
            taken.append(frequency)
            ax.text(frequency, height, f"{orders[k]}", fontsize="small", **look)


def _spectrum(ax: Axes, drawn: Drawn, label: str | None, style: dict[str, Any]) -> str:
    """Draw stems along x, y and z for each order."""
    vectors = [drawn.read(order, "peak_xyz") for order in drawn.orders]
    peaks: NDArray[np.float64] = np.array(vectors).reshape(-1, 3)
    places = np.array(drawn.orders, dtype=np.float64)
    width = 0.8 * float(np.min(np.diff(places), initial=1.0)) / 3.0
    seen = [k for k in range(3) if peaks[:, k].any()]
    for k, look in zip(seen, series(ax, len(seen), style), strict=True):
        name = joined(label or "", f"along {'xyz'[k]}")
        bars: dict[str, Any] = {"color": look["color"], "linewidth": 0.0, "gid": SERIES}
        ax.bar(places + (k - 1) * width, peaks[:, k], width, label=name, **bars)
    x_axis(ax, "order", whole=True)
    y_axis(ax, drawn.peak, largest=float(peaks.max(initial=0.0)))
    add_legend(ax)
    return ""
