"""Are blocks, soil and mounts that resist rotation those of other formulae?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from analysis.mounts.test_mount_laws import random_case
from support import in_turn

G, NU, RHO = 6e7, 0.33, 1750.0
SOIL = cp.Soil(G, NU, RHO)


def bushings(seed: int) -> tuple[cp.Powertrain, np.ndarray]:
    """Return a random powertrain, some of whose mounts resist rotation, and random speeds."""
    p, rpm = random_case(seed)
    draw = np.random.default_rng(seed + 77)
    mounts = [
        mount.replace(
            rotational_stiffness=tuple(draw.choice([0.0, 2e3, 5e3], 3)),
            rotational_loss_factor=draw.choice([0.0, 0.1]),
            rotational_damping=tuple(draw.choice([0.0, 7.0], 3)),
        )
        if k % 2
        else mount
        for k, mount in enumerate(p.mounts)
    ]
    return p.replace(mounts=mounts), rpm


def matrices(p: cp.Powertrain, omega: float) -> tuple[np.ndarray, np.ndarray]:
    """Mass and complex stiffness about the CG, from places and axes alone."""
    mass = p.body.mass * np.eye(6)
    mass[3:, 3:] = p.body.inertia
    stiffness = np.zeros((6, 6), dtype=complex)
    for m in p.mounts:
        t = np.radians(m.tilt_deg or 0.0)
        axes = np.array([[np.cos(t), np.sin(t), 0], [-np.sin(t), np.cos(t), 0], [0, 0, 1]])
        x, y, z = np.subtract(m.at, p.body.cg)
        shift = np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])
        turn = np.hstack([np.zeros((3, 3)), np.eye(3)])
        along = np.array(m.stiffness) * (1 + 1j * np.array(m.loss_factor))
        along = along + 1j * omega * np.array(m.damping)
        about = np.array(m.rotational_stiffness) * (1 + 1j * np.array(m.rotational_loss_factor))
        about = about + 1j * omega * np.array(m.rotational_damping)
        for rows, values in ((axes @ shift, along), (axes @ turn, about)):
            stiffness += rows.T @ np.diag(values) @ rows
    return mass, stiffness


@in_turn("seed", range(10))
def test_mounts_that_resist_rotation_are_matrices(seed: int) -> None:
    p, rpm = bushings(seed)
    mass, stiffness = matrices(p, 0.0)
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness.real)).real
    frequency = np.sqrt(np.sort(squares)) / (2 * np.pi)
    modes = p.modes()
    np.testing.assert_allclose(modes.frequency, frequency, rtol=1e-9)
    np.testing.assert_allclose(modes.strain.sum(axis=0), 100.0, rtol=1e-12)
    r = p.response(rpm, orders=[1, 2])
    for k, speed in enumerate(rpm):
        for j, n in enumerate((1, 2)):
            omega = n * speed * np.pi / 30
            mass, stiffness = matrices(p, omega)
            load = np.asarray(r.wrench)[k, j]
            motion = np.linalg.solve(stiffness - omega**2 * mass, load)
            found = np.asarray(r.motion)[k, j]
            assert np.abs(found - motion).max() <= 1e-10 * np.abs(motion).max()
            wrench = np.asarray(r.support_wrench)[k, j]
            expected = stiffness @ motion
            assert np.abs(wrench - expected).max() <= 1e-10 * np.abs(expected).max()
    reactive = np.abs(r.power_in) + np.linalg.norm(r.wrench, axis=-1) * 1e-3
    assert (np.abs(r.power_in - r.power_lost.sum(axis=-1)) <= 1e-11 * reactive).all()
    weight = np.array([0.0, -9.80665 * p.body.mass, 0, 0, 0, -50.0])
    state, (mass, stiffness) = p.static(50.0), matrices(p, 0.0)
    moved = np.linalg.solve(stiffness.real, weight)
    found = np.concatenate(
        [state.sag + state.wind_up, np.radians(state.sag_deg + state.wind_up_deg)]
    )
    np.testing.assert_allclose(found, moved, rtol=1e-8, atol=1e-12 * np.abs(moved).max())


@in_turn("seed", range(4))
def test_tolerances_count_rotational_stiffness(seed: int) -> None:
    p, _ = bushings(seed)
    p = p.replace(mounts=p.mounts[:3])
    r = p.robustness(0.19, corners="mounts")
    np.testing.assert_allclose(r.frequency_bounds[0] / r.frequency, 0.9, rtol=1e-10)


@in_turn("seed", range(6))
def test_power_balances_on_a_subframe_with_bushings(seed: int) -> None:
    above, rpm = bushings(seed)
    below, _ = bushings(seed + 40)
    p = above.with_support(cp.Subframe(below.body, below.mounts))
    r = p.response(rpm, orders=[1, 2])
    omega = np.multiply.outer(rpm, [1, 2]) * np.pi / 30
    lost = 0.0
    moved = np.asarray(r.subframe_motion)
    for k, speed in enumerate(rpm):
        for j, n in enumerate((1, 2)):
            _, stiffness = matrices(below, n * speed * np.pi / 30)
            q = moved[k, j]
            lost = 0.5 * omega[k, j] * (q.conj() @ stiffness.imag @ q)
            passed = np.asarray(r.power_passed)[k, j]
            size = np.abs(r.power_in)[k, j] + omega[k, j] * np.linalg.norm(q) * 1e-9
            assert abs(passed - lost) <= 1e-9 * size
    total = r.power_lost.sum(axis=-1) + r.power_passed
    assert (np.abs(r.power_in - total) <= 1e-10 * (np.abs(r.power_in) + 1e-9)).all()


def test_what_cannot_carry_rotation_says_so() -> None:
    p, _ = bushings(1)
    h = cp.Receptance([("0", "x")], ([1.0, 100.0], np.full((2, 1, 1), 1e-7)))
    with pytest.raises(cp.InputError, match='a receptance under mount "1": has no rotations'):
        p.with_support(h)
    with pytest.raises(cp.InputError, match=r"^rotational_stiffness of mount '1' is given"):
        p.save_html("page.html")
    with pytest.raises(cp.InputError, match=r"^rotational_damping\[2\] = -1"):
        p.mounts[0].replace(rotational_damping=(0, 0, -1))


# --- blocks ---------------------------------------------------------------------------------------


def test_blocks_and_machines_on_them_are_integrals() -> None:
    block = cp.RigidBody.block(
        width=3.0, height=1.6, length=5.0, density=2350, top=(0.2, -0.9, 1.1)
    )
    # Midpoints of cells: exact of first moments, of second ones to 1/n².
    n = 40
    x, y, z = np.meshgrid(*((np.arange(n) + 0.5) / n - 0.5 for _ in range(3)), indexing="ij")
    at = np.stack([0.2 + 3.0 * x, -1.7 + 1.6 * y, 1.1 + 5.0 * z], axis=-1).reshape(-1, 3)
    weight = np.full(len(at), 2350 * 3.0 * 1.6 * 5.0 / n**3)
    machine = cp.RigidBody(9e3, (0.1, 0.3, 0.9), [[4e3, 200, 0], [200, 5e3, -90], [0, -90, 3e3]],
                           products="tensor")  # fmt: skip
    both = cp.RigidBody.combined(block, machine)
    assert np.isclose(both.mass, weight.sum() + 9e3)
    centre = (weight @ at + 9e3 * np.array(machine.cg)) / both.mass
    np.testing.assert_allclose(both.cg, centre, rtol=1e-12)
    arms = np.vstack([at, machine.cg]) - centre
    masses = np.append(weight, 9e3)
    outer = np.einsum("i,ij,ik->jk", masses, arms, arms)
    tensor = np.trace(outer) * np.eye(3) - outer + np.array(machine.inertia)
    np.testing.assert_allclose(both.inertia, tensor, rtol=2e-3, atol=1e-6 * tensor.max())
    assert cp.RigidBody.combined(block) == block
    with pytest.raises(cp.InputError, match=r"^height"):
        cp.RigidBody.block(1, -1, 1)
    with pytest.raises(cp.InputError, match=r"^density"):
        cp.RigidBody.block(1, 1, 1, density=0)
    for sides, said in (((1e4, 1, 1), "width = 10000.0: give metres, 0.001 to 1000"),
                        ((1, 1, 1e-4), "length = 0.0001: give metres")):  # fmt: skip
        with pytest.raises(cp.InputError, match=f"^{said}"):
            cp.RigidBody.block(*sides)
    with pytest.raises(cp.InputError, match=r"^density = 0\.5: give kg/m³, 1 to 100000: 2400"):
        cp.RigidBody.block(1, 1, 1, density=0.5)
    with pytest.raises(cp.InputError, match=r"^height = 'two'"):
        cp.RigidBody.block(1, "two", 1)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"^bodies"):
        cp.RigidBody.combined()


# --- soil -----------------------------------------------------------------------------------------


def six(mount: cp.Mount) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and dashpots along and about x, y, z."""
    stiffness = np.array([*mount.stiffness, *mount.rotational_stiffness])
    return stiffness, np.array([*mount.damping, *mount.rotational_damping])


def test_a_disc_has_the_springs_of_the_half_space() -> None:
    body = cp.RigidBody.block(2, 1.5, 2)
    (kx, ky, kz, rx, ry, rz), _ = six(SOIL.mount(body, radius=1.2, y=-1.5))
    r = 1.2
    # Boussinesq; Reissner and Sagoci; Borowicka; all in closed form.
    np.testing.assert_allclose(ky, 4 * G * r / (1 - NU), rtol=1e-14)
    np.testing.assert_allclose(ry, 16 * G * r**3 / 3, rtol=1e-14)
    np.testing.assert_allclose([rx, rz], 8 * G * r**3 / (3 * (1 - NU)), rtol=1e-14)
    # Mindlin's 8Gr/(2 − ν), within 3 % of Bycroft's.
    np.testing.assert_allclose([kx, kz], 8 * G * r / (2 - NU), rtol=3e-2)


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0, 3.0])
def test_rectangles_are_those_of_pais_and_kausel_within_the_error_of_circles(ratio: float) -> None:
    """Pais and Kausel, Soil Dyn. Earthq. Eng. 7 (1988) 213: 2B along x, 2L along z, static."""
    b = 1.1
    a = ratio * b
    body = cp.RigidBody.block(2 * b, 1.5, 2 * a)
    found, _ = six(SOIL.mount(body, width=2 * b, length=2 * a, y=-1.5))
    across = G * b / (2 - NU) * (6.8 * ratio**0.65 + 0.8 * ratio + 1.6)
    along = G * b / (2 - NU) * (6.8 * ratio**0.65 + 2.4)
    vertical = G * b / (1 - NU) * (3.1 * ratio**0.75 + 1.6)
    about_across = G * b**3 / (1 - NU) * (3.73 * ratio**2.4 + 0.27)
    torsion = G * b**3 * (4.25 * ratio**2.45 + 4.06)
    about_along = G * b**3 / (1 - NU) * (3.2 * ratio + 0.8)
    expected = [across, vertical, along, about_across, torsion, about_along]
    np.testing.assert_allclose(found, expected, rtol=0.14 if ratio > 2.0 else 0.09)


def test_embedment_is_continuous_and_a_circle_is_a_rectangle_of_its_second_moments() -> None:
    body = cp.RigidBody.block(2, 1.5, 2)
    surface, shallow, deep = (
        np.concatenate(six(SOIL.mount(body, radius=1.2, y=-1.5, embedment=e)))
        for e in (0.0, 1e-9, 1.0)
    )
    np.testing.assert_allclose(shallow, surface, rtol=1e-8)
    # Whitman's factors at h/r = 1/1.2, by hand; torsion has none.
    h, v = 1 / 1.2, NU
    k = [1 + 0.55 * (2 - v) * h, 1 + 0.6 * (1 - v) * h, 1 + 0.55 * (2 - v) * h]
    rocking = 1 + 1.2 * (1 - v) * h + 0.2 * (2 - v) * h**3
    c = [1 + 1.9 * (2 - v) * h, 1 + 1.9 * (1 - v) * h, 1 + 1.9 * (2 - v) * h]
    of_rocking = 1 + 0.7 * (1 - v) * h + 0.6 * (2 - v) * h**3
    factors = [*k, rocking, 1.0, rocking, *c, of_rocking, 1.0, of_rocking]
    np.testing.assert_allclose(deep / surface, factors, rtol=1e-12)


def test_bases_are_given_once() -> None:
    body = cp.RigidBody.block(2, 1.5, 2)
    for base in ({}, {"width": 1.0}, {"width": 1.0, "length": 1.0, "radius": 1.0}):
        with pytest.raises(cp.InputError, match=r"^width is no base"):
            SOIL.mount(body, y=0.0, **base)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"^at = None"):
        SOIL.mount(body, radius=1.0)
    with pytest.raises(cp.InputError, match=r"^poisson = 0.5"):
        cp.Soil(1e7, 0.5)
    assert SOIL.mount(body, radius=1.0, y=-2.0).at == (0.0, -2.0, 0.0)
    lossy = cp.Soil(G, NU, RHO, damping_ratio=0.03).mount(body, radius=1.0, y=-2.0)
    assert lossy.loss_factor == lossy.rotational_loss_factor == (0.06, 0.06, 0.06)


# --- worked cases of textbooks, computed again ----------------------------------------------------


def amplitude(p: cp.Powertrain, rpm: float, order: float, component: int) -> float:
    """Amplitude of a motion of the CG."""
    return float(abs(np.asarray(p.response(rpm, orders=[order]).motion)[0, component]))


def on_soil(
    table: cp.ForceTable, body: cp.RigidBody, soil: cp.Soil, radius: float, y: float
) -> cp.Powertrain:
    """A body on a disc."""
    return cp.Powertrain(table, body, [soil.mount(body, radius=radius, y=y)])


def test_vertical_vibration_of_a_constant_force() -> None:
    """A reciprocating compressor: one degree of freedom, Lysmer's analog."""
    body = cp.RigidBody(90e3, (0, 0, 0), (1e5, 1e5, 1e5))
    q, rpm, r = 18e3, 480.0, 2.0
    p = on_soil(cp.ForceTable(rpm, None, {1: (0, q, 0, 0, 0, 0)}), body, SOIL, r, 0.0)
    k = 4 * G * r / (1 - NU)
    damping = 0.425 / np.sqrt((1 - NU) * 90e3 / (4 * RHO * r**3))
    ratio = rpm * np.pi / 30 / np.sqrt(k / 90e3)
    expected = q / k / np.hypot(1 - ratio**2, 2 * damping * ratio)
    np.testing.assert_allclose(amplitude(p, rpm, 1, 1), expected, rtol=1e-12)
    assert np.isclose(p.modes().frequency[[2]], np.sqrt(k / 90e3) / (2 * np.pi)).any()


def test_vertical_vibration_of_a_rotating_mass_at_resonance() -> None:
    """Eccentric masses: the peak m_e·e/m / (2D√(1 − D²)) at ω_n/√(1 − 2D²)."""
    body = cp.RigidBody(200e3, (0, 0, 0), (3e5, 3e5, 3e5))
    r, unbalance = 1.5, 30.0
    table = cp.ForceTable(30 / np.pi, {1: (0, unbalance, 0, 0, 0, 0)})
    p = on_soil(table, body, SOIL, r, 0.0)
    k = 4 * G * r / (1 - NU)
    damping = 0.425 / np.sqrt((1 - NU) * 200e3 / (4 * RHO * r**3))
    peak = np.sqrt(k / 200e3) / np.sqrt(1 - 2 * damping**2)
    expected = unbalance / 200e3 / (2 * damping * np.sqrt(1 - damping**2))
    np.testing.assert_allclose(amplitude(p, peak * 30 / np.pi, 1, 1), expected, rtol=1e-12)


def test_torsion_about_the_vertical() -> None:
    """A pair of horizontal forces: Reissner and Sagoci's spring, B_θ = I/(ρr⁵)."""
    inertia, r, moment, rpm = 4e5, 1.8, 60e3, 300.0
    body = cp.RigidBody(150e3, (0, 0, 0), (5e5, inertia, 5e5))
    p = on_soil(cp.ForceTable(rpm, None, {2: (0, 0, 0, 0, moment, 0)}), body, SOIL, r, 0.0)
    k = 16 * G * r**3 / 3
    damping = 0.5 / (1 + 2 * inertia / (RHO * r**5))
    ratio = 2 * rpm * np.pi / 30 / np.sqrt(k / inertia)
    expected = moment / k / np.hypot(1 - ratio**2, 2 * damping * ratio)
    np.testing.assert_allclose(amplitude(p, rpm, 2, 4), expected, rtol=1e-12)


def test_rocking_about_the_base() -> None:
    """Hall's analog of rocking alone, about the middle of the base: D = 0.15/((1 + B)√B)."""
    inertia, r, moment, rpm = 3e5, 2.2, 80e3, 420.0
    body = cp.RigidBody(120e3, (0, 0, 0), (inertia, 4e5, 5e5))
    p = on_soil(cp.ForceTable(rpm, None, {1: (0, 0, 0, moment, 0, 0)}), body, SOIL, r, 0.0)
    k = 8 * G * r**3 / (3 * (1 - NU))
    b = 3 * (1 - NU) * inertia / (8 * RHO * r**5)
    damping = 0.15 / ((1 + b) * np.sqrt(b))
    ratio = rpm * np.pi / 30 / np.sqrt(k / inertia)
    expected = moment / k / np.hypot(1 - ratio**2, 2 * damping * ratio)
    np.testing.assert_allclose(amplitude(p, rpm, 1, 3), expected, rtol=1e-12)


def test_dashpots_count_inertia_about_the_base() -> None:
    """B of rocking and torsion is of the moments about the middle of the base, not the CG."""
    body = cp.RigidBody.block(width=3.0, height=2.4, length=4.0)
    base = SOIL.mount(body, radius=2.0, at=(0.2, -2.4, 0.3))
    arm = np.array([0.2, -1.2, 0.3])
    about = np.array(body.inertia) + body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    size = RHO * 2.0**5
    for axis, ratio in ((0, 3 * (1 - NU) / 8), (1, 1.0), (2, 3 * (1 - NU) / 8)):
        inertia, k = about[axis, axis], base.rotational_stiffness[axis]
        b = ratio * inertia / size
        damping = 0.5 / (1 + 2 * b) if axis == 1 else 0.15 / ((1 + b) * np.sqrt(b))
        critical = 2 * np.sqrt(k * inertia)
        assert base.rotational_damping[axis] == pytest.approx(damping * critical, rel=1e-12)


def test_coupled_rocking_and_sliding_has_the_roots_of_the_quadratic() -> None:
    """The classic equation of a block whose CG is h above its base (Barkan; Prakash and Puri)."""
    body = cp.RigidBody.block(width=3.0, height=2.4, length=4.0)
    base = SOIL.mount(body, width=3.0, length=4.0, y=-2.4)
    p = cp.Powertrain(cp.ForceTable(300, {1: (1, 0, 0, 0, 0, 0)}), body, [base])
    m, h = body.mass, 1.2
    about_cg = body.inertia[2][2]
    about_base = about_cg + m * h * h
    (kx, *_, rocking), _ = six(base)
    gamma = about_cg / about_base
    sliding, rock = kx / m, rocking / about_base
    roots = np.sort(np.roots([gamma, -(sliding + rock), sliding * rock]).real)
    found = p.modes().frequency
    for root in np.sqrt(roots) / (2 * np.pi):
        assert np.abs(found - root).min() < 1e-9 * root


# --- cases that are printed in public, computed again ---------------------------------------------


def test_a_block_under_a_rotating_machine() -> None:
    """A template of engineers in Peru after Richart, Hall and Woods, for rotating machines.

    Printed for B 2 m, L 4 m, h 1.5 m, concrete 2.4 tf/m³, machine 6 tf, V_s 200 m/s, soil
    1.8 tf/m³, ν 0.33: r₀ 1.5958 m, k_z 69 947 tf/m, f_z 22.345 Hz. An edition of it took rocking
    about the stiff axis of the base, (B·L³/3π)^¼, where the unbalance rocks it about the soft one.
    """
    g = 9.80665
    density, stiff = 1.8e3, 1.8e3 * 200.0**2
    block = cp.RigidBody.block(width=2, height=1.5, length=4, density=2400)
    machine = cp.RigidBody(6e3, (0, 0, 0), (1e3, 1e3, 1e3))
    body = cp.RigidBody.combined(block, machine)
    mount = cp.Soil(stiff, 0.33, density).mount(body, width=2, length=4, y=-1.5)
    # Figures of five digits.
    assert mount.stiffness[1] / (1e3 * g) == pytest.approx(69947, rel=1e-5)
    assert np.sqrt(mount.stiffness[1] / body.mass) / (2 * np.pi) == pytest.approx(22.345, rel=3e-5)
    rocking, *_, along = mount.rotational_stiffness
    about = 8 * stiff * ((4 * 2**3) / (3 * np.pi)) ** 0.75 / (3 * 0.67)
    assert along == pytest.approx(about, rel=1e-12)
    assert rocking == pytest.approx(about * 2**1.5, rel=1e-12)


def test_a_circular_footing_by_shear_wave_velocity() -> None:
    """A validation case of a solver of structures: r 2 m, V_s 200 m/s, 1800 kg/m³, ν 0.33.

    It cites Gazetas (1991) for 32(1 − ν)Gr/(7 − 8ν), which is Bycroft's, as in Richart, Hall and
    Woods; Gazetas has 8Gr/(2 − ν), 2 % less here.
    """
    body = cp.RigidBody(50e3, (0, 0, 0), (1e5, 1e5, 1e5))
    mount = cp.Soil(72e6, 0.33, 1800).mount(body, radius=2.0, y=0.0)
    vertical, sliding = 4 * 72e6 * 2.0 / 0.67, 32 * 0.67 * 72e6 * 2.0 / 4.36
    rocking = 8 * 72e6 * 8.0 / (3 * 0.67)
    assert mount.stiffness == pytest.approx((sliding, vertical, sliding), rel=1e-12)
    assert mount.rotational_stiffness[0] == pytest.approx(rocking, rel=1e-12)
    assert 8 * 72e6 * 2.0 / 1.67 / sliding == pytest.approx(0.975, abs=1e-3)
    p = cp.Powertrain(None, body, [mount])
    natural = np.sqrt(vertical / 50e3) / (2 * np.pi)
    assert np.abs(np.asarray(p.modes().frequency) - natural).min() < 1e-9 * natural


@pytest.mark.filterwarnings("ignore:stiffness of mount 'soil' = 1e.16")
def test_a_cylinder_that_rocks_about_its_base() -> None:
    """A validation case after Gazetas: G 30 MPa, ν 0.3, r 3 m, h 1.5 m, 2400 kg/m³.

    I = m(r²/4 + h²/3) about the base, ω² = 8Gr³/(3(1 − ν))/I: rocking alone, without sliding.
    """
    r, h = 3.0, 1.5
    mass = 2400 * np.pi * r * r * h
    own = mass * (r * r / 4 + h * h / 12)
    body = cp.RigidBody(mass, (0, -h / 2, 0), (own, mass * r * r / 2, own))
    mount = cp.Soil(3e7, 0.3, 1800).mount(body, radius=r, y=-h)
    about_base = mass * (r * r / 4 + h * h / 3)
    omega = np.sqrt(mount.rotational_stiffness[0] / about_base)
    assert omega**2 == pytest.approx(8 * 3e7 * 27 / 2.1 / about_base, rel=1e-12)
    # Held at its base it rocks so: sliding made stiff.
    held = mount.replace(stiffness=(1e16, 1e16, 1e16), damping=0.0)
    p = cp.Powertrain(None, body, [held])
    natural = omega / (2 * np.pi)
    # Squares of frequencies a hundred thousand apart.
    assert np.abs(np.asarray(p.modes().frequency) - natural).min() < 1e-5 * natural


def test_a_square_is_five_per_cent_stiffer_than_its_circles() -> None:
    """NIST GCR 12-917-21, table 2-2a (Pais and Kausel; Gazetas), of a square 2B at ν = 1/3.

    In G·B and G·B³: Pais and Kausel 7.05, 8.31 and 6.00 up, in torsion and rocking; circles of
    equal area and second moments 6.7703, 7.9326 and 5.9490.
    """
    body = cp.RigidBody.block(2, 1, 2)
    mount = cp.Soil(1e6, 1 / 3, 1800).mount(body, width=2, length=2, y=-1)
    # Figures of five digits.
    assert mount.stiffness[1] / 1e6 == pytest.approx(6.7703, rel=1e-5)
    # Of a radius rounded to five digits, to the third power.
    assert mount.rotational_stiffness[1] / 1e6 == pytest.approx(7.9326, rel=1e-4)
    assert mount.rotational_stiffness[0] / 1e6 == pytest.approx(5.9490, rel=1e-5)
    found = [mount.stiffness[1], *mount.rotational_stiffness[1::-1]]
    ratio = np.array([7.05, 8.31, 6.0]) * 1e6 / found
    assert ratio == pytest.approx([1.041, 1.048, 1.009], abs=1e-3)


def test_a_long_basemat_of_gazetas() -> None:
    """Gazetas, J. Geotech. Eng. 117 (1991) 1363: the example of his figure 4a, static.

    G 120 MPa, ν 0.4, 1850 kg/m³, L/B 3.2, area/(4L²) 0.26, at 18 Hz a₀ = ωB/V_s = 1.23:
    K_z = 4.13·10⁶ kN/m. Of a circle of equal area it is 2 % less.
    """
    half = 1.23 * np.sqrt(120e6 / 1850) / (2 * np.pi * 18)
    area = 0.26 * 4 * (3.2 * half) ** 2
    body = cp.RigidBody.block(2, 1, 2)
    mount = cp.Soil(120e6, 0.4, 1850).mount(body, radius=float(np.sqrt(area / np.pi)), y=-1)
    # His figures have three digits; a circle is softer than a long base.
    assert mount.stiffness[1] / 1e9 == pytest.approx(4.13, rel=0.03)
    assert mount.stiffness[1] / 1e9 < 4.13


def test_an_embedded_disc_of_a_tower() -> None:
    """The soil of NREL's TowerSE, after chapter 4 of Arya, O'Neill and Pincus.

    G 140 MPa, ν 0.4, r₀ 1 m, depth 1 m. One version of it has the derivative of the vertical
    factor by depth with the wrong sign: embedment would soften.
    """
    body = cp.RigidBody.block(2, 1, 2)
    mount = cp.Soil(140e6, 0.4, 1800).mount(body, radius=1.0, y=-1, embedment=1.0)
    vertical = 4 * 140e6 * (1 + 0.6 * 0.6) / 0.6
    sliding = 32 * 0.6 * 140e6 * (1 + 0.55 * 1.6) / (7 - 3.2)
    rocking = 8 * 140e6 * (1 + 1.2 * 0.6 + 0.2 * 1.6) / (3 * 0.6)
    torsion = 16 * 140e6 / 3
    assert mount.stiffness == pytest.approx((sliding, vertical, sliding), rel=1e-12)
    assert mount.rotational_stiffness == pytest.approx((rocking, torsion, rocking), rel=1e-12)
    deeper = cp.Soil(140e6, 0.4, 1800).mount(body, radius=1.0, y=-1, embedment=1.1)
    assert deeper.stiffness[1] > mount.stiffness[1]
