"""Where methods for link rods fail: cases as those of ``stability_cases.py``."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import crankpin as cp
import link_rods
import numpy as np
from stability_cases import Case

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Figures = tuple[float, float, float, float, float]

USUAL: Figures = (0.33, 0.26, 0.87, 72.0, 79.0)
"""r/L, r/l, a/r, bore and knuckle, degrees."""
WRIST_PIN: Figures = (0.1, 0.26, 1 / 0.26, 20.0, 24.0)
ORDERS = np.array(link_rods.ORDERS)
ODD = (ORDERS % 2 == 1) & (ORDERS > 1)


def barely_long(beyond: float) -> Figures:
    """Return usual figures of a link rod that is so much longer than it must be."""
    theta = np.linspace(0.0, 2.0 * np.pi, 100_001)
    lean = -np.arcsin(0.26 * np.sin(theta + np.radians(72.0)))
    place = np.exp(1j * theta) + 0.87 * np.exp(1j * (np.radians(7.0) + lean))
    return (1.0 / ((1.0 + beyond) * float(np.abs(place.imag).max())), *USUAL[1:])


def near(degrees: float) -> Figures:
    """Return usual figures of a knuckle so many degrees ahead of its bore."""
    return (*USUAL[:4], USUAL[3] + degrees)


@functools.cache
def digits(figures: Figures, samples: int = 1024) -> NDArray[np.complex128]:
    """Return the harmonics by 50 digits."""
    return np.array(link_rods.digits(figures, samples))


def ours(figures: Figures) -> NDArray[np.complex128]:
    """Return the harmonics by crankpin."""
    harmonics: NDArray[np.complex128] = link_rods.crankpin(
        tuple(np.array([one]) for one in figures)
    )[0]
    return harmonics


def sampled(figures: Figures) -> NDArray[np.complex128]:
    """Return them by a transform of 96 samples."""
    harmonics: NDArray[np.complex128] = link_rods.fft(tuple(np.array([one]) for one in figures))[0]
    return harmonics


def alike(figures: Figures) -> NDArray[np.complex128]:
    """Return those of a rod on the crankpin."""
    return cp.slider_crank_harmonics(figures[0], link_rods.ORDERS).astype(complex)


def largest(found: NDArray[np.complex128], exact: NDArray[np.complex128]) -> float:
    """Largest error, over that of the largest order."""
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def of_odd(found: NDArray[np.complex128], exact: NDArray[np.complex128]) -> float:
    """Largest error of orders 3 and 5, each relative to itself."""
    return float((np.abs(found - exact)[ODD] / np.abs(exact)[ODD]).max())


def on_the_crankpin(*, plain: bool) -> float:
    """Largest change of an engine by knuckles of no radius; of a harmonic by sampling."""
    if plain:
        return largest(sampled((0.33, 0.26, 0.0, 72.0, 79.0)), alike(USUAL))
    engine = cp.Engine.radial(cp.Cylinder(0.06, 0.178, 1.0), 5)
    linked = engine.with_link_rods(cp.LinkRods(0.0))
    both = [one.balance(3000, orders=range(1, 13)) for one in (linked, engine)]
    quantities = ("force", "moment", "torque")
    pairs = [[b.read(quantity) for b in both] for quantity in quantities]
    return max(float(np.abs(found - exact).max()) for found, exact in pairs)


def at_the_bore(*, plain: bool) -> float:
    """Largest odd order above the first of a knuckle at its bore."""
    found = sampled(near(0.0)) if plain else ours(near(0.0))
    return float(np.abs(found[ODD]).max())


def second_order(*, plain: bool) -> float:
    """Error of the part of order 2 that turns with the crank, of a star of five."""
    cylinder = cp.Cylinder(0.06, 0.23, 1.0)
    linked = cp.Engine.radial(cylinder, 5, rods=cp.LinkRods(radius=0.052, length=0.178))
    engine = cp.Engine.radial(cylinder, 5) if plain else linked
    force = engine.balance(60.0 / (2.0 * np.pi), orders=[2])[2].force
    exact = sum(
        digits((0.06 / 0.178, 0.06 / 0.23, 0.052 / 0.06, 72.0 * k, 72.0 * k))[1]
        * np.exp(-1j * np.radians(72.0 * k))
        for k in range(1, 5)
    )
    exact = 0.03 * abs(exact + digits((0.06 / 0.23, 0.06 / 0.23, 0.0, 0.0, 0.0))[1])
    return float(abs(abs(force.forward) / exact - 1.0))


LINKS = [
    Case(
        "link rods", "knuckles on the crankpin, a = 0: force, moment and torque of plain rods",
        0.0, "it is a plain rod", "transform of 96 samples",
        lambda: on_the_crankpin(plain=True), lambda: on_the_crankpin(plain=False),
    ),
    *(
        Case(
            "link rods", f"knuckle beside the crankpin, a = {radius:g} r: orders 3 and 5, each",
            1e-12, "odd parts of roots have the odd part as a factor", "transform of 96 samples",
            lambda f=(*USUAL[:2], radius, *USUAL[3:]): of_odd(sampled(f), digits(f)),  # type: ignore[misc]
            lambda f=(*USUAL[:2], radius, *USUAL[3:]): of_odd(ours(f), digits(f)),  # type: ignore[misc]
        )
        for radius in (1e-3, 1e-9)
    ),
    Case(
        "link rods", "knuckle at the wrist pin, a = l: orders 1-6, over the largest",
        1e-12, "samples fold back less than 1e-14", "all rods alike",
        lambda: largest(alike(WRIST_PIN), digits(WRIST_PIN)),
        lambda: largest(ours(WRIST_PIN), digits(WRIST_PIN)),
    ),
    *(
        Case(
            "link rods",
            f"link rod longer than it must be by {beyond:g}: orders 1-6, over the largest",
            1e-12, "as many samples as the height of the strip demands",
            "transform of 96 samples",
            lambda b=beyond, n=count: largest(sampled(barely_long(b)), digits(barely_long(b), n)),  # type: ignore[misc]
            lambda b=beyond, n=count: largest(ours(barely_long(b)), digits(barely_long(b), n)),  # type: ignore[misc]
        )
        for beyond, count in ((1e-2, 1024), (1e-4, 4096))
    ),
    *(
        Case(
            "link rods", f"knuckle {degrees}° from its bore: orders 3 and 5, each", 1e-11,
            "the sine of the angle between is a factor, and that known to 1e-16 of a turn", method,
            lambda f=figures, m=by: of_odd(m(f), digits(f)),  # type: ignore[misc]
            lambda f=figures: of_odd(ours(f), digits(f)),  # type: ignore[misc]
        )
        for degrees, figures, method, by in (
            ("0.001", near(1e-3), "all rods alike", alike),
            ("2⁻²⁰", near(2.0**-20), "transform of 96 samples", sampled),
            ("2⁻³³", near(2.0**-33), "transform of 96 samples", sampled),
        )
    ),
    Case(
        "link rods", "knuckle at its bore: orders 3 and 5", 0.0, "zero is zero",
        "transform of 96 samples",
        lambda: at_the_bore(plain=True), lambda: at_the_bore(plain=False),
    ),
    Case(
        "link rods", "star of five: what turns with the crank at order 2", 1e-12,
        "five harmonics of 1e-12 of the largest", "all rods alike",
        lambda: second_order(plain=True), lambda: second_order(plain=False),
    ),
]  # fmt: skip
