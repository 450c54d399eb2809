"""Many designs of mounts: crankpin against batched solving and modal superposition.

``python benchmarks/mounts.py`` times, over the number of designs, the largest force on the body
over 200 speeds of each of 12 orders of an inline four on four mounts: with hysteretic damping,
where stiffness is constant, and with viscous damping, where each frequency has its own. Against
`numpy.linalg.solve` of batches, complex modes in NumPy, and, where numba is installed, an LDLᵀ
factorisation and complex modes compiled with two threads. The others are handed their matrices;
crankpin assembles them, and finds the natural frequencies too. How long a call with one design
takes is printed by itself. It writes ``mounts.csv`` and
``mounts.png`` to ``--out``, by default ``benchmarks/out``.
"""

from __future__ import annotations

import argparse
import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import crankpin as cp
import matplotlib as mpl
import numpy as np
from _timing import interleaved, machine, print_table, write_csv
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ORDERS = list(range(1, 13))
RPM = np.linspace(600.0, 6000.0, 200)
COUNTS = [1, 10, 100, 1000]
SLOW = 100
"""Designs of methods that take seconds for more."""
DRAW = 7
HEADER = ("damping", "method", "designs", "nanoseconds_per_point", "error")
HAS_NUMBA = importlib.util.find_spec("numba") is not None

ENGINE = cp.Engine.inline(
    cp.Cylinder(0.043, 0.145, 0.45), throws_deg=[0, 180, 180, 0], spacing=0.1, name="I4"
).with_counterweights([cp.Unbalance(0.002, z=0.4, angle_deg=20)])
INERTIA = np.array([[7.0, 0.2, -0.4], [0.2, 8.0, 0.3], [-0.4, 0.3, 4.5]])
CG = np.array([0.01, 0.06, 0.15])
BODY = cp.RigidBody(150.0, tuple(CG), INERTIA, products="tensor")
PLACES = [(0.22, -0.12, 0.43), (-0.22, -0.12, 0.43), (0.25, -0.1, -0.13), (-0.2, -0.1, -0.1)]


class Case(NamedTuple):
    """Designs, and what the other methods are handed."""

    powertrain: cp.Powertrain
    vary: dict[str, dict[str, Real]]
    stiffness: Complex
    """(n_designs, 6, 6)"""
    damping: Real
    """(n_designs, 6, 6), viscous"""
    mass: Real
    load: Complex
    """(n_rpm, n_orders, 6)"""
    omega: Real
    """(n_rpm, n_orders)"""


def case(count: int, viscous: float) -> Case:
    """Draw designs."""
    draw = np.random.default_rng(DRAW)
    loss = 0.0 if viscous else 0.1
    mounts = [
        cp.Mount(f"{k}", place, 2e5, loss_factor=loss, damping=viscous)
        for k, place in enumerate(PLACES)
    ]
    powertrain = cp.Powertrain(ENGINE, BODY, mounts)
    vary = {m.name: {"stiffness": draw.uniform(1e5, 4e5, (count, 3))} for m in mounts}
    stiffness = np.zeros((count, 6, 6), complex)
    damping = np.zeros((count, 6, 6))
    for name, place in zip(vary, PLACES, strict=True):
        x, y, z = np.array(place) - CG
        moved = np.hstack([np.eye(3), -np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])])
        along = vary[name]["stiffness"] * (1 + 1j * loss)
        stiffness += np.einsum("ai,da,aj->dij", moved, along, moved)
        damping += viscous * moved.T @ moved
    mass = np.diag([150.0] * 3 + [0.0] * 3)
    mass[3:, 3:] = INERTIA
    load = np.array(powertrain.response(RPM, orders=ORDERS).wrench)
    omega = np.multiply.outer(RPM * 2 * np.pi / 60, ORDERS)
    return Case(powertrain, vary, stiffness, damping, mass, load, omega)


def ours(of: Case) -> Real:
    """Evaluate with crankpin."""
    return of.powertrain.designs(RPM, of.vary, orders=ORDERS).read("body_force")


def solved(of: Case) -> Real:
    """Solve all points of a design in a batch."""
    out = np.empty((len(of.stiffness), len(ORDERS), 3))
    for k, (stiffness, damping) in enumerate(zip(of.stiffness, of.damping, strict=True)):
        whole = stiffness + 1j * of.omega[..., None, None] * damping
        matrix = whole - of.omega[..., None, None] ** 2 * of.mass
        q = np.linalg.solve(matrix, of.load[..., None])
        out[k] = np.abs((whole @ q)[..., :3, 0]).max(axis=0)
    return out


def modal(of: Case) -> Real:
    """Superpose the complex modes of a design."""
    out = np.empty((len(of.stiffness), len(ORDERS), 3))
    inverse = np.linalg.inv(of.mass)
    for k, stiffness in enumerate(of.stiffness):
        values, shapes = np.linalg.eig(inverse @ stiffness)
        shapes /= np.sqrt(np.einsum("im,ij,jm->m", shapes, of.mass, shapes))
        along = np.einsum("im,rni->rnm", shapes, of.load)
        along /= values - of.omega[..., None] ** 2
        force = np.einsum("im,rnm->rni", (stiffness @ shapes)[:3], along)
        out[k] = np.abs(force).max(axis=0)
    return out


def compiled() -> dict[str, Callable[[Case], Real]]:
    """Return the methods compiled by numba, for constant stiffness; the first for any."""
    if not HAS_NUMBA:
        return {}
    from _mounts_numba import factored, superposed  # noqa: PLC0415 - needs numba

    def modes(of: Case) -> Real:
        values, shapes = np.linalg.eig(np.linalg.inv(of.mass) @ of.stiffness)
        scale = np.sqrt(np.einsum("dim,ij,djm->dm", shapes, of.mass, shapes))
        shapes /= scale[:, None, :]
        rows = np.ascontiguousarray((of.stiffness @ shapes)[:, :3])
        found: Real = superposed(values, np.ascontiguousarray(shapes), rows, of.load, of.omega)
        return found

    def factors(of: Case) -> Real:
        found: Real = factored(of.stiffness, of.damping, of.mass, of.load, of.omega)
        return found

    return {"numba, LDLᵀ": factors, "numba, modes": modes}


def methods(viscous: bool) -> dict[str, Callable[[Case], Real]]:
    """Return the methods for a kind of damping."""
    found: dict[str, Callable[[Case], Real]] = {"numpy.linalg.solve": solved, "NumPy, modes": modal}
    found |= compiled() | {"crankpin": ours}
    return {n: m for n, m in found.items() if not (viscous and "modes" in n)}


def measured(counts: list[int]) -> list[tuple[str, str, int, float, float]]:
    """Time all methods at each number of designs."""
    rows = []
    for damping, viscous in (("hysteretic", 0.0), ("viscous", 400.0)):
        for count in counts:
            of = case(count, viscous)
            chosen = {
                name: method
                for name, method in methods(viscous > 0.0).items()
                if count <= SLOW or "num" not in name.lower() or "numba" in name
            }
            few = case(min(count, 10), viscous)
            expected = solved(few)
            size = np.linalg.norm(expected, axis=-1, keepdims=True)
            size[size == 0.0] = 1.0  # Orders without a load, of which nothing but zero is right.
            calls = {name: (lambda m=method, of=of: m(of)) for name, method in chosen.items()}
            times = interleaved(calls, rounds=3, seconds=0.3, runs=1)
            points = count * len(ORDERS) * len(RPM)
            for name, seconds in times.items():
                error = float((np.abs(chosen[name](few) - expected) / size).max())
                rows.append((damping, name, count, seconds / points * 1e9, error))
    return rows


def draw(rows: list[tuple[str, str, int, float, float]], file: Path) -> None:
    """Draw time a point over the number of designs."""
    mpl.use("agg")
    import matplotlib.pyplot as plt  # noqa: PLC0415 - after the choice of what draws

    figure, axes = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained", sharey=True)
    for ax, damping in zip(axes, ("hysteretic", "viscous"), strict=True):
        for k, name in enumerate(dict.fromkeys(row[1] for row in rows)):
            points = [row[2:4] for row in rows if row[:2] == (damping, name)]
            if points:
                ax.plot(*np.array(points).T, marker="osv^D"[k], color=f"C{k}", label=name)
        ax.set(xscale="log", yscale="log", xlabel="designs", ylabel="ns a point")
        ax.set_title(f"Designs of mounts, {damping} damping", loc="left")
        ax.legend()
    figure.savefig(file, dpi=150)


def main() -> None:
    """Time all, print a table, write figures and chart."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="few designs")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    rows = measured(COUNTS[:2] if given.quick else COUNTS)
    print(machine(*(["numba"] if HAS_NUMBA else [])))
    for damping in ("hysteretic", "viscous"):
        found = [row for row in rows if row[0] == damping]
        own = {row[2]: row[3] for row in found if row[1] == "crankpin"}
        table = [
            [name, str(count), f"{each:.4g}", f"{each / own[count]:.3g}", f"{error:.0e}"]
            for _, name, count, each, error in found
        ]
        header = ["method", "designs", "ns a point", "over crankpin", "error"]
        print_table(f"12 orders × 200 speeds, {damping} damping", header, table)
    points = len(ORDERS) * len(RPM)
    single = [(row[0], row[1], f"{1e-3 * row[3] * points:.4g}") for row in rows if row[2] == 1]
    print_table("One design, a call", ["damping", "method", "µs"], [[*row] for row in single])
    write_csv(given.out / "mounts.csv", machine(), HEADER, rows)
    draw(rows, given.out / "mounts.png")


if __name__ == "__main__":
    main()
