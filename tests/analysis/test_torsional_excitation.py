"""Are excitations those of the cylinders, and do openTorsion and ROSS take them as they stand?"""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from numpy.typing import NDArray  # noqa: TC002 - read by tests of signatures
from support import in_turn
from support.several_cranks import random_engine

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, pin_offset=0.002, bore=0.086)
I4 = cp.Engine.preset("i4", cylinder=CYLINDER).with_cycle(cp.Cycle.example())
V6 = cp.Engine.preset("v6-90", cylinder=CYLINDER).with_cycle(
    [cp.Cycle.example(), None, *[cp.Cycle.motored(CYLINDER, compression_ratio=10)] * 4]
)


@pytest.mark.parametrize("engine", [I4, V6, V6.with_cycle(None)], ids=["I4", "V6", "not fired"])
def test_sums_over_cylinders_are_the_torque_of_the_engine(engine: cp.Engine) -> None:
    found = cp.torsional_excitation(engine, rpm=2500)
    halves = engine.cycles is not None
    assert found.orders == (tuple(k / 2 for k in range(1, 25)) if halves else tuple(range(1, 13)))
    torque = engine.balance(2500, orders=found.orders).crank_torque
    size = abs(found.crank_torque).sum(axis=0).max()
    # Roundings of sums of a dozen terms.
    np.testing.assert_allclose(found.crank_torque.sum(axis=0), torque.phasor, atol=1e-12 * size)
    assert found.mean_torque.sum() == pytest.approx(torque.cycle_mean if halves else 0.0)


def test_a_cylinder_is_the_first_one_at_its_firing_angle() -> None:
    found = cp.torsional_excitation(I4, rpm=4000, orders=[0.5, 1.5, 3])
    for k, fires in enumerate(I4.firing_deg):
        late = np.exp(-1j * np.radians(fires) * np.array([0.5, 1.5, 3.0]))
        np.testing.assert_allclose(
            found.crank_torque[k, :], found.crank_torque[0, :] * late, rtol=1e-12
        )


def test_the_table_and_the_dictionary_have_the_same_figures() -> None:
    found = cp.torsional_excitation(V6, rpm=3000, orders=[0.5, 1, 3])
    rows = list(csv.reader(io.StringIO(found.table.to_csv())))
    assert rows[0] == ["cylinder", "order", "frequency rad/s", "amplitude N·m", "phase rad"]
    parts = list(csv.reader(io.StringIO(found.parts().to_csv())))
    heads = ["gas N·m", "gas phase rad", "inertia N·m", "inertia phase rad"]
    assert parts[0] == ["cylinder", "order", *heads]
    assert len(rows) == 19
    given = found.to_dict()
    for row, part in zip(rows[1:], parts[1:], strict=True):
        assert row[:2] == part[:2]
        cylinder, order = int(row[0]) - 1, given["orders"].index(float(row[1]))
        assert float(row[2]) == given["angular_frequency"][order]
        amplitude, phase = float(row[3]), float(row[4])
        assert (amplitude, phase) == pytest.approx(
            (given["amplitude"][cylinder][order], given["phase"][cylinder][order])
        )
        for k, name in enumerate(("gas_amplitude", "gas_phase", "inertia_amplitude")):
            assert float(part[2 + k]) == pytest.approx(given[name][cylinder][order])
        phasor = amplitude * np.exp(1j * phase)
        assert phasor == pytest.approx(found.crank_torque[cylinder, order])
    assert given["angular_frequency"][0] == pytest.approx(0.5 * 100 * np.pi)
    # As programs do that take them for numbers.
    assert [float(omega) for omega in found.angular_frequency] == given["angular_frequency"]


@pytest.mark.parametrize("engine", [I4, V6, V6.with_cycle(None)], ids=["I4", "V6", "not fired"])
def test_a_range_of_speeds_has_what_each_speed_has(engine: cp.Engine) -> None:
    speeds = [800.0, 2500.0, 6000.0]
    many = cp.torsional_excitation(engine, rpm=speeds)
    for k, rpm in enumerate(speeds):
        one = cp.torsional_excitation(engine, rpm=rpm)
        size = abs(one.crank_torque).max()
        # Roundings of a square of a speed.
        np.testing.assert_allclose(many.crank_torque[k, :], one.crank_torque, atol=1e-12 * size)
        np.testing.assert_allclose(
            many.crank_torque.gas[k, :], one.crank_torque.gas, atol=1e-12 * size
        )
        np.testing.assert_allclose(many.angular_frequency[k, :], one.angular_frequency, rtol=1e-14)
        balance = engine.balance(rpm, orders=one.orders)
        for of, phasors in (("gas", one.crank_torque.gas), ("inertia", one.crank_torque.inertia)):
            part = getattr(balance.crank_torque, of)
            np.testing.assert_allclose(phasors.sum(axis=0), part.phasor, atol=1e-12 * size)
    assert len(many.table) == 3 * len(engine) * len(many.orders)
    assert many.table["speed"].values[-1] == 6000.0
    assert np.shape(many.to_dict()["amplitude"]) == many.crank_torque.shape
    with pytest.raises(cp.InputError, match=r"rpm = \[\]: give a crank speed"):
        cp.torsional_excitation(engine, rpm=[])


@in_turn("seed", range(6))
def test_reciprocating_inertia_is_the_mean_of_what_moves(seed: int) -> None:
    """Of all cylinders, the mean of the moving inertia that a flywheel sees; near half m·r²."""
    rng = np.random.default_rng(seed)
    rod = cp.Rod(0.6, rng.uniform(0.001, 0.005), rng.uniform(0.13, 0.2), 0.05)
    cylinder = cp.Cylinder.from_rod(
        rod, crank_radius=0.043, piston_mass=rng.uniform(0.2, 0.6), bore=0.086,
        pin_offset=rng.uniform(0.0, 0.01),
    )  # fmt: skip
    engine = cp.Engine.preset("i3", cylinder=cylinder).with_cycle(cp.Cycle.example())
    found = cp.torsional_excitation(engine, rpm=3000, orders=[1])
    wheel = cp.flywheel(engine, 3000, inertia=10.0)
    theta, moving = wheel.theta_deg, wheel.moving_inertia
    mean = np.trapezoid(moving, theta) / (theta[-1] - theta[0])
    # Trapezes of half degrees.
    np.testing.assert_allclose(found.reciprocating_inertia.sum(), mean, rtol=1e-5)
    long = cp.Cylinder(0.043, 1e4, 0.5)
    plain = cp.torsional_excitation(cp.Engine.preset("i3", cylinder=long), rpm=3000)
    np.testing.assert_allclose(plain.reciprocating_inertia, 0.5 * 0.5 * 0.043**2, rtol=1e-6)


@in_turn("seed", range(12))
def test_reciprocating_inertia_is_that_seen_from_the_main_crank(seed: int) -> None:
    """Twice the mean kinetic energy of piston and rod over the square of the main crank's speed."""
    engine = random_engine(seed)
    found = cp.torsional_excitation(engine, 1000, orders=[1]).reciprocating_inertia
    theta = np.arange(3600) / 10.0
    speed = 30.0 / np.pi  # 1 rad/s
    cranks, crank_of = engine._core.cranks
    for cylinder, crank, inertia in zip(engine.cylinders, crank_of, found, strict=True):
        velocity = cylinder.velocity(theta, speed)
        across = cylinder.crank_radius * np.cos(np.radians(theta))
        swing = across / (cylinder.position(theta) - across)
        energy = cylinder.reciprocating_mass * velocity**2 + cylinder.rod_inertia_excess * swing**2
        expected = cranks[crank][2] ** 2 * energy.mean()
        # Means of smooth functions of a turn; where masses and rods cancel, of either part.
        size = cylinder.reciprocating_mass * cylinder.crank_radius**2 + 1e-3
        assert inertia == pytest.approx(expected, rel=1e-12, abs=1e-13 * size)


def test_tangential_pressures_are_those_of_the_cycle() -> None:
    """As class rules tabulate: gas alone, from the firing dead centre, over area and radius."""
    found = cp.torsional_excitation(V6, rpm=3000)
    scale = np.pi / 4 * 0.086**2 * 0.043
    cycles = V6.cycles or ()
    for number, cycle in enumerate(cycles):
        expected = (
            np.zeros(24)
            if cycle is None
            else cycle.torque_harmonics(CYLINDER, found.orders) / scale
        )
        pressures = found.tangential_pressure[number, :]
        np.testing.assert_allclose(pressures, expected, atol=1e-9 * 1e5)
    table = found.tangential()
    first = found.tangential_pressure[0, 1] / 1e5
    row = [table[name].values[1] for name in ("cosine", "sine", "amplitude")]
    assert row == pytest.approx([first.real, -first.imag, abs(first)])
    assert not cp.torsional_excitation(V6.with_cycle(None), 3000).tangential_pressure.any()


def test_the_cylinder_of_open_torsions_own_example_has_its_torque() -> None:
    """The six-cylinder diesel of doi.org/10.1243/14644193JMBD126, as openTorsion computes it.

    Tangential forces of absolute pressure and of a mass whose acceleration is a series of four
    orders of the rod ratio, by a transform of their sum: over an open grid here, theirs counts the
    last point twice.
    """
    radius, rod, bore, mass, rpm = 0.137 / 2, 0.207, 0.105, 2.521, 1800.0
    cylinder = cp.Cylinder(radius, rod, mass, bore=bore)
    pressure = cp.Cycle.example("diesel")
    engine = cp.Engine.preset("i6", cylinder=cylinder).with_cycle(pressure, crankcase=0.0)
    found = cp.torsional_excitation(engine, rpm)
    alpha = np.radians(np.arange(0.0, 720.0, 0.1))
    ratio, omega = radius / rod, rpm * np.pi / 30
    beta = np.arcsin(ratio * np.sin(alpha))
    across = np.sin(alpha + beta) / np.cos(beta) * radius
    gas = pressure.pressure_at(np.degrees(alpha)) * np.pi / 4 * bore**2 * across
    series = np.cos(alpha) + ratio * np.cos(2 * alpha) - ratio**3 / 4 * np.cos(4 * alpha)
    series += 9 * ratio**5 / 128 * np.cos(6 * alpha)
    inertia = -mass * radius * series * omega**2 * across
    # Points 0.1° apart beside valves that open.
    expected = 2.0 * np.fft.rfft(gas)[1:25] / len(gas)
    np.testing.assert_allclose(
        found.crank_torque.gas[0, :], expected, atol=1e-4 * abs(expected).max()
    )
    # The series has λ in order 2 where the exact one has λ + λ³/4 and more: 0.0095 of m·r²·ω², half
    # of which is torque, in the orders beside 2.
    expected = 2.0 * np.fft.rfft(inertia)[1:25] / len(inertia)
    left_out = (ratio**3 / 4 + 15 * ratio**5 / 128) * mass * (radius * omega) ** 2 / 2
    np.testing.assert_allclose(found.crank_torque.inertia[0, :], expected, atol=1.2 * left_out)
    assert abs(found.crank_torque.inertia[0, :] - expected).max() > 0.5 * left_out


def test_what_is_no_engine_is_named() -> None:
    with pytest.raises(cp.InputError, match=r"engine = 4: give a crankpin\.Engine"):
        cp.torsional_excitation(4, rpm=3000)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"orders = 0\.3"):
        cp.torsional_excitation(I4, rpm=3000, orders=0.3)


# Flywheel, four throws, pulley: inertias in kg·m², stiffnesses in N·m/rad, dampings in N·m·s.
INERTIAS = [0.004, 0.006, 0.006, 0.006, 0.006, 0.15]
STIFFNESSES = [2e5, 5e5, 5e5, 5e5, 9e5]


def responses(excitation: cp.results.TorsionalExcitation) -> NDArray[np.complex128]:
    """Angles of the disks of the chain, cylinders at disks 1 to 4: (K − ω²J + iωC)q = T."""
    count = len(INERTIAS)
    stiffness = np.zeros((count, count))
    for k, each in enumerate(STIFFNESSES):
        stiffness[k : k + 2, k : k + 2] += each * np.array([[1, -1], [-1, 1]])
    damping = np.diag([0.0, 2.0, 2.0, 2.0, 2.0, 0.0])
    found = []
    for omega, torque in zip(excitation.angular_frequency, excitation.crank_torque.T, strict=True):
        dynamic = stiffness - omega**2 * np.diag(INERTIAS) + 1j * omega * damping
        found.append(np.linalg.solve(dynamic, [0, *torque, 0]))
    return np.array(found).T


def test_open_torsion_takes_the_dictionary() -> None:
    opentorsion = pytest.importorskip("opentorsion")
    excitation = cp.torsional_excitation(I4, rpm=3000)
    shafts = [opentorsion.Shaft(k, k + 1, k=each) for k, each in enumerate(STIFFNESSES)]
    disks = [
        opentorsion.Disk(k, I=each, c=2.0 if 1 <= k <= 4 else 0.0)
        for k, each in enumerate(INERTIAS)
    ]
    assembly = opentorsion.Assembly(shafts, disk_elements=disks)
    given = excitation.to_dict()
    loads = opentorsion.PeriodicExcitation(len(INERTIAS), given["angular_frequency"])
    for node, (amplitude, phase) in enumerate(
        zip(given["amplitude"], given["phase"], strict=True), start=1
    ):
        loads.add_sines(node, given["angular_frequency"], amplitude, phase)
    matrix, omegas = loads.excitation_matrix(), np.array(loads.omegas)
    found: Any = assembly.ss_response(matrix, omegas, C=assembly.C)
    found = found[0] if isinstance(found, tuple) else found
    # Two solvers of one system of equations, whose condition is some 1e4.
    np.testing.assert_allclose(np.squeeze(found), responses(excitation), rtol=1e-9)


def test_ross_takes_the_phasors_as_forces() -> None:
    ross = pytest.importorskip("ross")
    excitation = cp.torsional_excitation(I4, rpm=3000, orders=[0.5, 2, 4])
    steel = ross.Material("steel", rho=7810, E=211e9, G_s=81.2e9)
    shafts = [ross.ShaftElement(0.1, 0, 0.06, material=steel, n=k) for k in range(5)]
    disks = [ross.DiskElement(n=k, m=2.0, Id=0.005, Ip=each) for k, each in enumerate(INERTIAS)]
    ends = [ross.BearingElement(n=k, kxx=1e8, cxx=1e3, kzz=1e7, czz=10) for k in (0, 5)]
    rotor = ross.Rotor(shafts, disks, ends)
    omegas = excitation.angular_frequency
    # The sixth freedom of a node is its angle about the shaft.
    force = np.zeros((rotor.ndof, len(omegas)), dtype=complex)
    force[[6 * node + 5 for node in range(1, 5)]] = excitation.crank_torque
    found = rotor.run_forced_response(force=force, speed_range=omegas).forced_resp
    for k, omega in enumerate(omegas):
        dynamic = rotor.K(omega) - omega**2 * rotor.M(omega)
        dynamic = dynamic + 1j * omega * (rotor.C(omega) + rotor.G() * omega)
        expected = np.linalg.solve(dynamic, force[:, k])
        angles = slice(5, None, 6)
        np.testing.assert_allclose(found[angles, k], expected[angles], rtol=1e-6)


PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "torsional-vibration.md"


def blocks_of(page: Path, beginning: str, end: str = "") -> str:
    """The code of a page between two headings that needs packages the manual's build lacks."""
    text = page.read_text("utf-8").partition(f"## {beginning}\n")[2]
    text = text.partition(f"## {end}\n")[0] if end else text
    return "\n".join(re.findall(r"```text\n(.*?)```", text, re.DOTALL))


def names_of_page() -> dict[str, Any]:
    """What the page has before its code for other programs."""
    code = re.findall(r">>> (.*)", PAGE.read_text("utf-8"))
    names: dict[str, Any] = {"np": np}
    exec("\n".join(code), names)  # noqa: S102 - our own page
    return names


def test_the_page_for_open_torsion_runs_and_its_damper_damps() -> None:
    pytest.importorskip("opentorsion")
    names = names_of_page()
    exec(blocks_of(PAGE, "openTorsion", "ROSS"), names)  # noqa: S102 - our own page
    count = len(names["inertias"])
    stiffness = np.zeros((count, count))
    for k, each in enumerate(names["stiffnesses"]):
        stiffness[k : k + 2, k : k + 2] += each * np.array([[1, -1], [-1, 1]])
    squares = np.linalg.eigvals(stiffness / np.array(names["inertias"])[:, np.newaxis])
    # What modal_analysis calls undamped has the damping of the throws, which the rotation of all
    # shares with the first mode: 4e-5 of it.
    np.testing.assert_allclose(names["natural"], np.sqrt(np.sort(squares.real)[1:]), rtol=1e-4)
    before, after = names["before"], names["after"]
    assert after.max() < 0.5 * before.max()
    speeds, worst = names["excitation"].rpm, before.argmax()
    nearest = min(abs(speeds[worst] / each - 1.0) for each in names["critical"].values())
    assert nearest < 0.02  # the largest swing is at a critical speed, to the step of speeds


def test_the_page_for_ross_runs() -> None:
    pytest.importorskip("ross")
    names = names_of_page()
    inertias = [0.017, *[0.030 + names["excitation"].reciprocating_inertia[0]] * 6, 2.07]
    names |= {"inertias": inertias, "stiffnesses": [1.1e6, *[1.25e6] * 5, 2.0e6]}
    exec(blocks_of(PAGE, "ROSS"), names)  # noqa: S102 - our own page
    assert names["response"].forced_resp.shape[1] == 24
    stiffness = np.zeros((8, 8))
    for k, each in enumerate(names["stiffnesses"]):
        stiffness[k : k + 2, k : k + 2] += each * np.array([[1, -1], [-1, 1]])
    mass = np.diag(np.array(inertias))
    first = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)[1])
    # Its shaft elements have a moment of inertia of their own, a few percent of the disks'.
    assert abs(names["modes"].wn / first - 1.0).min() < 0.05
