"""Where methods for an engine on its mounts fail: cases as those of ``stability_cases.py``."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import crankpin as cp
import mpmath
import numpy as np
from stability_cases import Case

if TYPE_CHECKING:
    from collections.abc import Callable

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
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # rotation about z is free
        r = p.response(rpm, orders=[1])
    load = r.wrench[0, 0, :2]
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
        return p.modes().read("energy")
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


# --- tensors, centres of gravity, scales ----------------------------------------------------------


def warnings_of(call: Callable[[], object], said: str) -> float:
    """Infinity where a call says nothing, 0 where it warns once of what is meant."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    messages = [str(each.message) for each in caught]
    return 0.0 if len(messages) == 1 and said in messages[0] else math.inf


def lacking_error(missing: float, plain: bool) -> float:
    """0 where a tensor that lacks this much of the triangle inequality is warned of."""
    moments = (7.0, 8.0, 15.0 / (1.0 - missing))
    if plain:
        return math.inf if np.isfinite(np.linalg.cholesky(np.diag(moments))).all() else 0.0
    said = f"lacks {100 * missing:.3g} %"
    return warnings_of(lambda: cp.RigidBody(150.0, (0, 0, 0), moments), said)


def rounded_error(plain: bool) -> float:
    """0 where rounding of a flat body's tensor is taken for what it is."""
    inertia = np.diag([7.0, 8.0, 15.0 * (1.0 + 1e-12)])
    inertia[0, 1], inertia[1, 0] = 0.3, 0.3 * (1.0 + 1e-15)
    if plain:
        small, middle, large = np.linalg.eigvalsh(inertia)
        is_taken = small + middle >= large and (inertia == inertia.T).all()
        return 0.0 if is_taken else math.inf
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        cp.RigidBody(150.0, (0, 0, 0), inertia, products="tensor")
    return math.inf if caught else 0.0


def products_error(plain: bool) -> float:
    """Error of the torque roll axis along x, of products of inertia as CAD systems print them."""
    printed = np.array([[6.0, -0.4, 0.9], [-0.4, 8.5, -0.3], [0.9, -0.3, 3.2]])
    tensor = 2.0 * np.diag(np.diag(printed)) - printed
    with mpmath.workdps(40):
        axis = mpmath.lu_solve(mpmath.matrix(tensor.tolist()), mpmath.matrix([0, 0, 1]))
        exact = float(axis[0] / mpmath.norm(axis))
    if plain:
        taken = np.linalg.solve(printed, [0.0, 0.0, 1.0])
        found = float(taken[0] / np.linalg.norm(taken))
    else:
        body = cp.RigidBody(150.0, (0, 0, 0), printed, products="positive-integrals")
        mounts = [cp.Mount(f"{k}", at, 2e5) for k, at in enumerate(np.eye(3).tolist())]
        found = float(cp.Powertrain(SINGLE, body, mounts).axes().torque_roll[0])
    return abs(found / exact - 1.0)


PLACES = [(0.3, -0.1, 0.0), (-0.3, -0.15, 0.1), (0.05, -0.12, 0.7), (0.0, 0.2, 0.6)]


def on_four(height: float) -> cp.Powertrain:
    """Return a powertrain whose centre of gravity is at this height."""
    mounts = [cp.Mount(f"{k}", at, 1e5 + 2e4 * k) for k, at in enumerate(PLACES)]
    return cp.Powertrain(SINGLE, cp.RigidBody(150.0, (0.02, height, 0.2), (7, 8, 4.5)), mounts)


def slope_error(plain: bool) -> float:
    """Largest error of a frequency's derivative by the height of the CG, over the largest."""
    p = on_four(0.06)
    modes, mass = p.modes().frequency, mpmath.diag([150.0] * 3 + [7.0, 8.0, 4.5])
    with mpmath.workdps(40):

        def frequencies(height: mpmath.mpf) -> list[mpmath.mpf]:
            matrix = mpmath.zeros(6, 6)
            for mount in p.mounts:
                x, y, z = (mpmath.mpf(part) for part in mount.at)
                x, y, z = x - mpmath.mpf(0.02), y - height, z - mpmath.mpf(0.2)
                rows = [[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, x], [0, 0, 1, y, -x, 0]]
                moved = mpmath.matrix(rows)
                matrix += mpmath.mpf(mount.stiffness[0]) * moved.T * moved
            root = mpmath.diag([1 / mpmath.sqrt(mass[k, k]) for k in range(6)])
            squares = mpmath.eigsy(root * matrix * root, eigvals_only=True)
            return sorted(mpmath.sqrt(square) / (2 * mpmath.pi) for square in squares)

        step = mpmath.mpf(10) ** -15
        upper, lower = (frequencies(mpmath.mpf(0.06) + sign * step) for sign in (1, -1))
        exact = np.array([float((a - b) / (2 * step)) for a, b in zip(upper, lower, strict=True)])
    if plain:
        found = (on_four(0.061).modes().frequency - modes) / 1e-3
    else:
        found = p.robustness(0.0, corners="mounts").cg_slope[1]
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def millimetres_error(plain: bool) -> float:
    """0 where a centre of gravity in millimetres is warned of, infinity where it is not."""
    if plain:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stiffness, mass = matrices(on_four(60.0))
        return (
            math.inf
            if np.isfinite(np.linalg.eigvals(np.linalg.solve(mass, stiffness))).all()
            else 0.0
        )
    return warnings_of(
        lambda: cp.RigidBody(150.0, (20.0, 60.0, 200.0), (7.0, 8.0, 4.5)), "millimetres"
    )


def scaled(length: float, mass: float, few: bool) -> cp.Powertrain:
    """Return a powertrain of this scale, of the same frequencies, on two mounts or on four."""
    cylinder = cp.Cylinder(0.045 * length, 0.15 * length, 0.6 * mass)
    engine = cp.Engine.inline(cylinder, throws_deg=[0, 180], spacing=0.1 * length)
    body = cp.RigidBody(
        150.0 * mass,
        tuple(length * part for part in (0.02, 0.06, 0.2)),
        tuple(mass * length**2 * moment for moment in (7.0, 8.0, 4.5)),
    )
    mounts = [
        cp.Mount(
            f"{k}", tuple(length * part for part in at), mass * (1e5 + 2e4 * k), loss_factor=0.1
        )
        for k, at in enumerate(PLACES[: 2 if few else 4])
    ]
    return cp.Powertrain(engine, body, mounts)


def scale_error(length: float, mass: float, plain: bool) -> float:
    """Largest error of motions that are free, of frequencies and of the force on the body."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of figures that seem to be in other units
        pairs = [(scaled(1.0, 1.0, few), scaled(length, mass, few)) for few in (True, False)]
    if plain:
        free = [abs(np.linalg.det(matrices(p)[0])) < 1e6 for _, p in pairs]
        return 0.0 if free == [True, False] else math.inf
    worst = 0.0
    for one, other in pairs:
        modes, same = one.modes(), other.modes()
        worst = max(worst, float(len(modes.free) != len(same.free)))
        worst = max(worst, float(np.abs(same.frequency - modes.frequency).max()))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the motion that is free
            forces = [p.response(1500.0, orders=[1, 2]).body_force.xyz for p in (one, other)]
        worst = max(worst, float(np.abs(forces[1] - length * mass * forces[0]).max()))
    return worst


def free_error(plain: bool) -> float:
    """Frequency of the motion that two mounts leave free, over the largest."""
    p = scaled(1.0, 1.0, few=True)
    if plain:
        stiffness, mass = matrices(p)
        values = np.abs(np.linalg.eigvals(np.linalg.solve(mass, stiffness)))
        return float(math.sqrt(values.min() / values.max()))
    modes = p.modes()
    return math.inf if len(modes.free) != 1 else float(modes.frequency[0])


# --- stiffness over frequency, loss ---------------------------------------------------------------

FLAWED = {
    "one point": ([20.0], [1e5 + 1e4j]),
    "not ascending": ([5.0, 50.0, 20.0], [1e5 + 1e4j, 2e5 + 2e4j, 1.5e5 + 1e4j]),
    "a hole": ([5.0, 20.0, 50.0], [1e5 + 1e4j, math.nan, 2e5 + 2e4j]),
}


def flawed_error(plain: bool) -> float:
    """0 where tables that have a flaw are refused, infinity where one is some number."""
    for frequency, stiffness in FLAWED.values():
        if plain:
            if np.isfinite(np.interp(60.0, frequency, np.real(stiffness))):
                return math.inf
            continue
        try:
            cp.Mount("a", (0, 0, 0), 1e5, table=(frequency, [[k] * 3 for k in stiffness]))
        except cp.InputError as error:
            if not str(error).startswith("table"):
                return math.inf
        else:
            return math.inf
    return 0.0


def kink_error(plain: bool) -> float:
    """Error of stiffness half way between a table's points, beside a kink."""
    frequency, along = np.array([10.0, 20.0, 30.0, 40.0]), np.array([1e5, 1e5, 2e5, 3e5])
    if plain:
        found = float(np.polyval(np.polyfit(frequency, along, 3), 15.0))
    else:
        table = (frequency, np.repeat(along[:, None] + 0j, 3, axis=1))
        found = float(cp.Mount("a", (0, 0, 0), 1e5, table=table).dynamic_at(15.0)[0].real)
    return abs(found / 1e5 - 1.0)


def conjugate_error(plain: bool) -> float:
    """0 where stiffness of data that go as e^{−iωt} is refused, infinity where it makes power."""
    along = np.full((2, 3), 1e5 - 1e4j)
    if plain:
        omega = 2.0 * math.pi * 20.0
        moved = 1.0 / (along[0, 0] - 10.0 * omega**2)
        return math.inf if (1j * omega * moved).real < 0.0 else 0.0
    for given in ({"table": ([5.0, 50.0], along)}, {"loss_factor": -0.1}, {"damping": -100.0}):
        try:
            cp.Mount("a", (0, 0, 0), 1e5, **given)
        except cp.InputError as error:
            if "table" in given and "conjugate" not in str(error):
                return math.inf
        else:
            return math.inf
    return 0.0


def much_loss_error(plain: bool) -> float:
    """Error of the vertical transmissibility at four times the resonance, of a loss factor of 5."""
    loss, ratio = 5.0, 4.0
    exact = abs((1.0 + 1j * loss) / (1.0 - ratio**2 + 1j * loss))
    if plain:
        found = abs((1.0 + 1j * loss * ratio) / (1.0 - ratio**2 + 1j * loss * ratio))
    else:
        places = [(x, 0.0, z) for x in (1, -1) for z in (1, -1)]
        mounts = [cp.Mount(f"{k}", at, 2.5e5, loss_factor=loss) for k, at in enumerate(places)]
        rpm = 60.0 * ratio * math.sqrt(1e6 / 100.0) / (2.0 * math.pi)
        r = cp.Powertrain(SINGLE, UNIT, mounts).response(rpm, orders=[1])
        found = float(r.transmissibility[0, 1])
    return abs(found / exact - 1.0)


def at_rest_error(plain: bool) -> float:
    """Error of stiffness at rest, where there is no damping, of a loss factor of 5."""
    mount = cp.Mount("a", (0, 0, 0), 1e5, loss_factor=5.0, damping=100.0)
    found = 1e5 * (1.0 + 5.0j) if plain else complex(mount.dynamic_at(0.0)[0])
    return abs(found / 1e5 - 1.0)


MOUNTS: list[Case] = [
    *(
        Case(
            "mounts",
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
        "mounts",
        "six modes of one frequency, a mount stiffer by 1e-12: energies, of 100 %",
        1e-11,
        "modes of one frequency are a group, whose mean counts",
        "eigenvectors of NumPy",
        lambda: group_error(plain=True),
        lambda: group_error(plain=False),
    ),
    *(
        Case(
            "mounts",
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
        "mounts",
        "an order in a mode without damping",
        0.0,
        "an error that names order, speed and frequency",
        "numpy.linalg.solve",
        lambda: resonance_error(plain=True),
        lambda: resonance_error(plain=False),
    ),
    Case(
        "mounts",
        "an order beyond a table of stiffness",
        0.0,
        "an error that names mount, order and speed",
        "numpy.interp",
        lambda: outside_error(plain=True),
        lambda: outside_error(plain=False),
    ),
    *(
        Case(
            "mounts",
            f"a tensor that lacks {100 * missing:g} % of the triangle inequality",
            0.0,
            "a warning with the three moments and what they lack",
            "positive definite, by Cholesky",
            lambda missing=missing: lacking_error(missing, plain=True),  # type: ignore[misc]
            lambda missing=missing: lacking_error(missing, plain=False),  # type: ignore[misc]
        )
        for missing in (0.06, 1e-3)
    ),
    Case(
        "mounts",
        "a flat body's tensor, off by rounding: taken",
        0.0,
        "rounding is no error of the user's",
        "I₁ + I₂ ≥ I₃, I = Iᵀ",
        lambda: rounded_error(plain=True),
        lambda: rounded_error(plain=False),
    ),
    Case(
        "mounts",
        "products of inertia as CAD systems print them: x of the torque roll axis",
        1e-14,
        "their convention is named; an inverse of a well-conditioned tensor",
        "taken for the tensor's entries",
        lambda: products_error(plain=True),
        lambda: products_error(plain=False),
    ),
    Case(
        "mounts",
        "derivatives of the frequencies by the height of the CG",
        1e-12,
        "derivative of the Rayleigh quotient, no difference",
        "difference over 1 mm",
        lambda: slope_error(plain=True),
        lambda: slope_error(plain=False),
    ),
    Case(
        "mounts",
        "a centre of gravity in millimetres",
        0.0,
        "a warning",
        "eigenvalues of NumPy",
        lambda: millimetres_error(plain=True),
        lambda: millimetres_error(plain=False),
    ),
    *(
        Case(
            "mounts",
            f"a powertrain of {words}, beside 150 kg: free motions, frequencies, force",
            0.0,
            "no threshold has a unit; powers of two scale every step exactly",
            "free where |det K| < 1e6",
            lambda length=length, mass=mass: scale_error(length, mass, plain=True),  # type: ignore[misc]
            lambda length=length, mass=mass: scale_error(length, mass, plain=False),  # type: ignore[misc]
        )
        for words, length, mass in [("40 g", 2.0**-4, 2.0**-12), ("40 t", 2.0**3, 2.0**8)]
    ),
    Case(
        "mounts",
        "two mounts: frequency of the rotation that they leave free, over the largest",
        0.0,
        "rank of the mounts' deflections, with a bound of its rounding; the motion is named",
        "eigenvalues of NumPy",
        lambda: free_error(plain=True),
        lambda: free_error(plain=False),
    ),
    Case(
        "mounts",
        "tables of stiffness of one point, not ascending, with a hole",
        0.0,
        "errors that name the table and its entry",
        "numpy.interp",
        lambda: flawed_error(plain=True),
        lambda: flawed_error(plain=False),
    ),
    Case(
        "mounts",
        "a table with a kink: stiffness beside it",
        1e-15,
        "straight lines between the points: never beyond them",
        "a cubic through four points",
        lambda: kink_error(plain=True),
        lambda: kink_error(plain=False),
    ),
    Case(
        "mounts",
        "stiffness of data that go as e^{−iωt}, loss factor or damping below zero",
        0.0,
        "an error that says how to conjugate them",
        "1/(k − ω²m), which makes power",
        lambda: conjugate_error(plain=True),
        lambda: conjugate_error(plain=False),
    ),
    Case(
        "mounts",
        "a loss factor of 5, at four times the resonance: transmissibility",
        1e-14,
        "hysteretic damping is that at every frequency",
        "viscous, of half the loss factor",
        lambda: much_loss_error(plain=True),
        lambda: much_loss_error(plain=False),
    ),
    Case(
        "mounts",
        "a loss factor of 5, at rest: stiffness",
        0.0,
        "at rest there is no damping",
        "k(1 + iη)",
        lambda: at_rest_error(plain=True),
        lambda: at_rest_error(plain=False),
    ),
]
