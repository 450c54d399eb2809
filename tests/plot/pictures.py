"""Every picture of results, by name, as tests draw it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
from conftest import CYLINDER, I4, V6
from matplotlib import pyplot as plt

if TYPE_CHECKING:
    from collections.abc import Callable

UNNAMED = cp.Engine.inline(CYLINDER, throws_deg=[0, 120, 240], spacing=0.1)
V8 = cp.Engine.preset("v8-crossplane")
ORDERS = ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
FAMILY = [cp.Engine.preset(f"ijesc-v6-{order}") for order in ORDERS]
"""The engines of the IJESC paper."""
BANK_ANGLES = np.arange(10.0, 171.0, 10.0)
SUMMARY = [
    cp.Engine.preset(name)
    for name in ("single-ebook", "i3-ebook", "i4-ebook", "boxer-4", "flat-4", "i6")
]
"""The engines of the e-book's summary."""


def over_bank_angle(**options: Any) -> cp.Sweep:  # noqa: ANN401 - of a sweep
    """The four engines of the IJESC paper over bank angle."""
    return cp.sweep(FAMILY, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="pins", **options)


def over_two(**options: Any) -> cp.Sweep:  # noqa: ANN401 - of a sweep
    """One engine over bank angle and rod ratio."""
    angles, ratios = np.arange(0.0, 181.0, 10.0), np.linspace(0.2, 0.4, 12)
    return cp.sweep(V6, rpm=5000, bank_angle_deg=angles, hold="pins", rod_ratio=ratios, **options)


def _spectra(**place: Any) -> Any:  # noqa: ANN401
    ax = V6.balance(5000).plot(label="60°", **place)
    return V6.with_bank_angle(90, hold="pins").balance(5000).plot(ax, label="90°")


def _waveforms(**place: Any) -> Any:  # noqa: ANN401
    ax = V6.waveform(5000).plot(label="60°", **place)
    return V6.with_bank_angle(90, hold="pins").waveform(5000).plot(ax, label="90°")


def _of_one_panel(plot: Callable[..., Any]) -> Callable[..., Any]:
    return lambda ax=None: plot(plt.subplots(layout="constrained")[1] if ax is None else ax)


PICTURES: dict[str, Callable[..., Any]] = {
    "spectrum": lambda **place: V6.balance(5000).plot(**place),
    "spectrum-log": lambda **place: V6.balance(5000, orders=range(1, 11)).plot(log=True, **place),
    "spectra": _spectra,
    "ellipses": lambda **place: V6.balance(5000).plot(kind="ellipses", **place),
    "ellipses-on-axes": _of_one_panel(lambda ax: V6.balance(5000).plot(ax, kind="ellipses")),
    "waveform": lambda **place: V6.waveform(5000, theta_deg=range(361)).plot(**place),
    "waveforms": _waveforms,
    "orbit": lambda **place: V8.waveform(5000).plot(kind="orbit", **place),
    "sweep": lambda **place: over_bank_angle().plot(**place),
    "sweep-on-axes": _of_one_panel(lambda ax: over_bank_angle().plot(ax)),
    "sweep-scale": lambda **place: over_two(orders=[1, 2]).plot(kind="curves", **place),
    "map": lambda **place: over_two().plot(**place),
    "orders": lambda **place: cp.sweep(
        V6, rpm=np.arange(1000.0, 6001.0, 500.0), orders=range(1, 9)
    ).plot(kind="orders", **place),
    "bars": lambda **place: cp.sweep(SUMMARY, rpm=10).plot(**place),
    "sweep-waveform": lambda **place: cp.sweep(FAMILY, rpm=5000).waveform().plot(**place),
    "envelope": lambda **place: over_two(orders=[1, 2]).waveform(range(361)).plot(**place),
    "ranking": lambda **place: cp.rank(
        dict(zip(ORDERS, FAMILY, strict=True)),
        rpm=5000,
        bank_angle_deg=BANK_ANGLES,
        hold="pins",
        by="total.moment.peak",
        refine=True,
    ).plot(**place),
    "ranking-list": lambda **place: cp.rank(
        [I4, V6, V8, *map(cp.Engine.preset, ("i6", "i5", "boxer-4", "w12"))],
        rpm=5000,
        by="total.moment.peak",
    ).plot(**place),
    "search": lambda **place: cp.search_arrangements(14).within(40, 70).plot(**place),
}
