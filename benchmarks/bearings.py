"""Loads of all bearings of a cross-plane V8 over crank angle: crankpin against vectorised NumPy.

``python benchmarks/bearings.py`` times both over the number of crank angles, in turns, with the
pins, walls, rods and main bearings that `cp.bearing_loads` has. NumPy has all cylinders and angles
in one array, and shares crankpin loads among bearings by a matrix product. It writes
``bearings.csv`` and ``bearings.png`` to ``--out``, by default ``benchmarks/out``.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import NamedTuple

import crankpin as cp
import matplotlib as mpl
import numpy as np
from _timing import interleaved, machine, print_table, write_csv
from numpy.typing import NDArray

Array = NDArray[np.float64]

RPM = 6000.0
COUNTS = [1, 10, 100, 721, 3000, 10_000, 100_000]
ROD = cp.Rod(mass=0.6, inertia=0.0024, length=0.152, to_crankpin=0.046)
V8 = cp.Engine.preset("v8-crossplane").replace(
    cylinder=cp.Cylinder.from_rod(ROD, crank_radius=0.044, piston_mass=0.5),
    rotating_mass=0.8,
    mains=[-0.05, 0.05, 0.15, 0.25, 0.35],
)
HEADER = ("method", "angles", "seconds", "error")


class Loads(NamedTuple):
    """Loads as complex numbers, x + iy, and as numbers, (n, n_theta)."""

    crankpin: NDArray[np.complex128]
    wrist_pin: NDArray[np.complex128]
    main: NDArray[np.complex128]
    side_thrust: Array
    rod_force: Array


class Figures(NamedTuple):
    """What does not depend on crank angle, gathered before the clock starts."""

    tdc: Array
    bore: NDArray[np.complex128]
    shares: Array
    omega: float


def figures() -> Figures:
    """Gather lists of the engine as columns."""
    bore = np.exp(1j * np.radians(V8.bank_deg))[:, None]
    shares = cp.bearing_loads(V8, RPM, [0.0]).shares
    return Figures(np.radians(V8.tdc_deg)[:, None], bore, shares, 2 * np.pi * RPM / 60)


def in_numpy(of: Figures, theta_deg: Array) -> Loads:
    """Evaluate all loads at once."""
    radius, square = V8.cylinders[0].crank_radius, of.omega**2
    excess, mass = ROD.inertia_excess, V8.cylinders[0].reciprocating_mass
    local = np.radians(theta_deg) - of.tdc
    sin, cos = np.sin(local), np.cos(local)
    height = np.sqrt((ROD.length / radius) ** 2 - sin**2)
    slope = sin / height
    along = -cos - (cos**2 - sin**2) / height - (sin * cos) ** 2 / height**3
    along *= radius * square
    swing = -sin / height + sin * cos**2 / height**3
    across = slope * mass * along - excess * square * swing / (radius * height)
    turning = radius * square * np.exp(1j * local)
    crankpin = (-mass * along + 1j * across + ROD.rotating_mass * turning) * of.bore
    on_pin = (mass - ROD.reciprocating_mass) * along
    crank_mass = V8.rotating_mass[0] - ROD.rotating_mass
    return Loads(
        crankpin,
        (on_pin - 1j * across) * of.bore,
        of.shares @ (crankpin + crank_mass * turning * of.bore),
        across,
        (on_pin + slope * across) / np.hypot(1.0, slope),
    )


def error(theta_deg: Array, of: Figures) -> float:
    """Return the largest difference of both, over the largest load of its kind."""
    ours, theirs = cp.bearing_loads(V8, RPM, theta_deg), in_numpy(of, theta_deg)
    found = 0.0
    for name, expected in theirs._asdict().items():
        values = ours.read(name)
        mine = values @ [1, 1j] if values.ndim == 3 else values
        found = max(found, float(np.abs(mine - expected).max() / np.abs(expected).max()))
    return found


def measured(counts: list[int]) -> list[tuple[str, int, float, float]]:
    """Time both at each number of crank angles."""
    rows, of = [], figures()
    for count in counts:
        theta = np.linspace(0.0, 720.0, count)
        methods = {
            "NumPy": lambda theta=theta: in_numpy(of, theta),
            "crankpin": lambda theta=theta: cp.bearing_loads(V8, RPM, theta),
        }
        differ = error(np.linspace(0.0, 720.0, max(count, 10)), of)
        times = interleaved(methods)
        rows += [(name, count, seconds, differ) for name, seconds in times.items()]
    return rows


def draw(rows: list[tuple[str, int, float, float]], file: Path) -> None:
    """Draw time over the number of crank angles."""
    mpl.use("agg")
    import matplotlib.pyplot as plt  # noqa: PLC0415 - after the choice of what draws

    figure, ax = plt.subplots(figsize=(7, 5), layout="constrained")
    for k, name in enumerate(dict.fromkeys(row[0] for row in rows)):
        points = [(count, seconds) for method, count, seconds, _ in rows if method == name]
        ax.plot(*np.array(points).T, marker="os"[k], label=name)
    ax.set(xscale="log", yscale="log", xlabel="crank angles", ylabel="seconds")
    ax.set_title("Bearing loads of a V8", loc="left")
    ax.legend()
    figure.savefig(file, dpi=150)


def main() -> None:
    """Time both, print a table, write figures and chart."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="few numbers of crank angles")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    rows = measured(COUNTS[2:4] if given.quick else COUNTS)
    print(machine())
    pairs = zip(rows[::2], rows[1::2], strict=True)
    table = [
        [str(a[1]), f"{a[2] * 1e6:.4g}", f"{b[2] * 1e6:.4g}", f"{a[2] / b[2]:.1f}", f"{a[3]:.1e}"]
        for a, b in pairs
    ]
    header = ["crank angles", "NumPy µs", "crankpin µs", "NumPy / crankpin", "largest difference"]
    print_table("Bearing loads of a cross-plane V8 with rigid rods", header, table)
    write_csv(given.out / "bearings.csv", machine(), HEADER, rows)
    draw(rows, given.out / "bearings.png")


if __name__ == "__main__":
    main()
