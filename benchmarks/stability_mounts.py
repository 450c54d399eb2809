"""Where methods for an engine on its mounts fail: cases as those of ``stability_cases.py``."""

from __future__ import annotations

import math
import warnings

import crankpin as cp
import mpmath
import numpy as np
from stability_cases import Case

SINGLE = cp.Engine.preset("single")
UNIT = cp.RigidBody(100.0, (0.0, 0.0, 0.0), (100.0, 100.0, 100.0))

# --- two modes that merge -------------------------------------------------------------------------

COUPLED = 0.1
"""Half the difference of the loss factors of two modes of one frequency, and what couples them."""


def merging(beyond: float) -> cp.Powertrain:
    """Return modes along x and y of one frequency, coupled by (1 + beyond) of what merges them."""
    e, kappa = COUPLED, COUPLED * (1.0 + beyond)
    stiffness = 1e6

    def along(name: str, tilt: float, part: float, loss: float) -> cp.Mount:
        figures = (part * stiffness, 0.0, 0.0)
        return cp.Mount(name, (0, 0, 0), figures, tilt_deg=tilt, loss_factor=loss / part)

    # Loss factors .3 and .1; the mount at 45° has 2κ, and so κ in each entry.
    pair = [along("x", 0, 1.0 - kappa, 0.2 + e), along("y", 90, 1.0 - kappa, 0.2 - e)]
    others = [
        cp.Mount(name, at, (0.0, 0.0, 4e5), loss_factor=0.1)
        for name, at in [("a", (1, 0, 0)), ("b", (-1, 0, 0)), ("c", (0, 1, 0))]
    ]
    return cp.Powertrain(SINGLE, UNIT, [*pair, along("between", 45, 2.0 * kappa, 0.0), *others])


def merged_error(beyond: float, plain: bool) -> float:
    """Error of the motion along x and y under order 1 at .9 of the frequency of both modes."""
    p = merging(beyond)
    omega = 0.9 * math.sqrt(1e6 / 100.0)
    rpm = np.full(16, omega * 30.0 / math.pi)
    r = p.response(rpm, orders=[1])
    load = r.load[0, 0, :2]
    matrix = np.zeros((2, 2), complex)
    for mount in p.mounts[:3]:
        angle = math.radians(mount.tilt_deg or 0.0)
        axis = np.array([math.cos(angle), math.sin(angle)])
        matrix += mount.dynamic_at(omega / (2.0 * math.pi))[0] * np.outer(axis, axis)
    matrix /= 100.0
    (a, b), (_, c) = matrix.tolist()
    square = omega**2
    determinant = (a - square) * (c - square) - b * b
    exact = np.array([(c - square) * load[0] - b * load[1], (a - square) * load[1] - b * load[0]])
    exact /= 100.0 * determinant
    if plain:
        values, shapes = np.linalg.eig(matrix)
        shapes = shapes / np.sqrt((shapes * shapes).sum(axis=0))
        found = shapes @ ((shapes.T @ load) / (values - square)) / 100.0
    else:
        found = r.motion[0, 0, :2]
    error = float(np.linalg.norm(found - exact) / np.linalg.norm(exact))
    return error if math.isfinite(error) else 1.0


# --- modes of one frequency -----------------------------------------------------------------------


def energies(factor: float, plain: bool) -> np.ndarray:
    """Return the energy table of six modes of one frequency, one mount of which has a factor."""
    body = cp.RigidBody(100.0, (0.0, 0.0, 0.0), (9.0, 18.0, 9.0))
    places = [(x, 0.0, z) for x in (0.3, -0.3) for z in (0.3, -0.3)]
    mounts = [
        cp.Mount(f"{k}", at, 1e5 * (factor if k == 0 else 1.0)) for k, at in enumerate(places)
    ]
    p = cp.Powertrain(SINGLE, body, mounts)
    if not plain:
        return p.modes().energy
    stiffness, mass = matrices(p)
    root = np.sqrt(np.diag(mass))
    _, shapes = np.linalg.eigh(stiffness / np.outer(root, root))
    return np.asarray(100.0 * shapes**2)


def group_error(plain: bool) -> float:
    """Largest change of an energy, of 100, by a stiffness that differs by 1e-12."""
    before, after = (energies(factor, plain) for factor in (1.0, 1.0 + 1e-12))
    return float(np.abs(after - before).max() / 100.0)


def matrices(p: cp.Powertrain) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and mass as one would assemble them."""
    stiffness, mass = np.zeros((6, 6)), np.eye(6) * p.body.mass
    mass[3:, 3:] = p.body.inertia
    for mount in p.mounts:
        x, y, z = np.subtract(mount.at, p.body.cg)
        moved = np.hstack([np.eye(3), -np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])])
        stiffness += moved.T @ np.diag(mount.dynamic_at(0.0).real) @ moved
    return stiffness, mass


# --- mounts nearly in a line ----------------------------------------------------------------------


def lowest_error(off: float, plain: bool) -> float:
    """Error of the lowest frequency of three mounts, one of which is so far off a line."""
    places = [(0.3, 0.0, 0.0), (-0.3, 0.0, 0.0), (0.1, off, 0.0)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mounts = [cp.Mount(f"{k}", at, 2e5) for k, at in enumerate(places)]
    p = cp.Powertrain(SINGLE, cp.RigidBody(150.0, (0, 0, 0), (7.0, 8.0, 4.5)), mounts)
    with mpmath.workdps(60):
        moments = [150.0] * 3 + [7.0, 8.0, 4.5]
        root = [1 / mpmath.sqrt(mpmath.mpf(moment)) for moment in moments]
        matrix = mpmath.zeros(6, 6)
        for x, y, z in ([mpmath.mpf(part) for part in at] for at in places):
            rows = [[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, x], [0, 0, 1, y, -x, 0]]
            for row in rows:
                for i in range(6):
                    for j in range(6):
                        matrix[i, j] += 200000 * row[i] * row[j] * root[i] * root[j]
        exact = float(mpmath.sqrt(min(mpmath.eigsy(matrix, eigvals_only=True))) / (2 * mpmath.pi))
    if plain:
        stiffness, mass = matrices(p)
        scale = np.sqrt(np.diag(mass))
        value = np.linalg.eigvalsh(stiffness / np.outer(scale, scale))[0]
        found = math.sqrt(max(value, 0.0)) / (2.0 * math.pi)
    else:
        found = float(p.modes().frequency[0])
    return abs(found / exact - 1.0)


# --- what has no answer ---------------------------------------------------------------------------


def resonance_error(plain: bool) -> float:
    """0 where an undamped resonance is reported as what it is, infinity for some number."""
    mounts = [cp.Mount(f"{k}", at, 1e5) for k, at in enumerate(np.eye(3).tolist())]
    p = cp.Powertrain(SINGLE, UNIT, mounts)
    frequency = p.modes().frequency[0]
    omega = 2.0 * math.pi * frequency
    if plain:
        stiffness, mass = matrices(p)
        load = np.array([0.0, 1.0, 0.0, 0.1, 0.2, 0.3])
        return (
            math.inf
            if np.isfinite(np.linalg.solve(stiffness - omega**2 * mass, load)).all()
            else 0.0
        )
    try:
        p.response(frequency * 60.0, orders=[1])
    except cp.InputError as error:
        return 0.0 if "without damping" in str(error) else math.inf
    return math.inf


def outside_error(plain: bool) -> float:
    """0 where stiffness beyond a table is refused, infinity where it is some number."""
    table = ([5.0, 50.0], np.full((2, 3), 1e5 + 1e4j))
    if plain:
        return math.inf if np.isfinite(np.interp(100.0, table[0], table[1][:, 0].real)) else 0.0
    mounts = [cp.Mount(f"{k}", at, 1e5, table=table) for k, at in enumerate(np.eye(3).tolist())]
    try:
        cp.Powertrain(SINGLE, UNIT, mounts).response(3000.0, orders=[2])
    except cp.InputError as error:
        return 0.0 if "order 2 at 3000 rpm" in str(error) else math.inf
    return math.inf


MOUNTS: list[Case] = [
    *(
        Case(
            "engine on its mounts",
            f"two modes that merge, coupled by 1 + {beyond:g} of what it takes: motion",
            1e-12,
            "back substitution in a Schur form: some hundred roundings of 2e-16",
            "sum over complex modes",
            lambda beyond=beyond: merged_error(beyond, plain=True),  # type: ignore[misc]
            lambda beyond=beyond: merged_error(beyond, plain=False),  # type: ignore[misc]
        )
        for beyond in (1e-8, 1e-12, 0.0)
    ),
    Case(
        "engine on its mounts",
        "six modes of one frequency, a mount stiffer by 1e-12: energies, of 100 %",
        1e-11,
        "modes of one frequency are a group, whose mean counts",
        "eigenvectors of NumPy",
        lambda: group_error(plain=True),
        lambda: group_error(plain=False),
    ),
    *(
        Case(
            "engine on its mounts",
            f"three mounts, one off a line by {off:g} m: lowest frequency",
            1e-9,
            "singular values of the mounts' deflections, by Jacobi; no stiffness is squared",
            "eigenvalues of the stiffness",
            lambda off=off: lowest_error(off, plain=True),  # type: ignore[misc]
            lambda off=off: lowest_error(off, plain=False),  # type: ignore[misc]
        )
        for off in (1e-5, 1e-7)
    ),
    Case(
        "engine on its mounts",
        "an order in a mode without damping",
        0.0,
        "an error that names order, speed and frequency",
        "numpy.linalg.solve",
        lambda: resonance_error(plain=True),
        lambda: resonance_error(plain=False),
    ),
    Case(
        "engine on its mounts",
        "an order beyond a table of stiffness",
        0.0,
        "an error that names mount, order and speed",
        "numpy.interp",
        lambda: outside_error(plain=True),
        lambda: outside_error(plain=False),
    ),
]
