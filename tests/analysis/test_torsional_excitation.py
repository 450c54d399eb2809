"""Are excitations those of the cylinders, and do openTorsion and ROSS take them as they stand?"""

from __future__ import annotations

import csv
import io
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from numpy.typing import NDArray  # noqa: TC002 - read by tests of signatures

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
    size = abs(found.torque).sum(axis=0).max()
    # Roundings of sums of a dozen terms.
    np.testing.assert_allclose(found.torque.sum(axis=0), torque.phasor, atol=1e-12 * size)
    assert found.mean.sum() == pytest.approx(torque.mean if halves else 0.0)


def test_a_cylinder_is_the_first_one_at_its_firing_angle() -> None:
    found = cp.torsional_excitation(I4, rpm=4000, orders=[0.5, 1.5, 3])
    for k, fires in enumerate(I4.firing_deg):
        late = np.exp(-1j * np.radians(fires) * np.array([0.5, 1.5, 3.0]))
        np.testing.assert_allclose(found.torque[k], found.torque[0] * late, rtol=1e-12)


def test_the_table_and_the_dictionary_have_the_same_figures() -> None:
    found = cp.torsional_excitation(V6, rpm=3000, orders=[0.5, 1, 3])
    rows = list(csv.reader(io.StringIO(found.table.to_csv())))
    assert rows[0] == ["cylinder", "order", "frequency rad/s", "amplitude N·m", "phase rad"]
    assert len(rows) == 19
    given = found.to_dict()
    for row in rows[1:]:
        cylinder, order = int(row[0]) - 1, given["orders"].index(float(row[1]))
        assert float(row[2]) == given["angular_frequency"][order]
        amplitude, phase = float(row[3]), float(row[4])
        assert (amplitude, phase) == pytest.approx(
            (given["amplitude"][cylinder][order], given["phase"][cylinder][order])
        )
        phasor = amplitude * np.exp(1j * phase)
        assert phasor == pytest.approx(found.torque[cylinder, order])
    assert given["angular_frequency"][0] == pytest.approx(0.5 * 100 * np.pi)


def test_what_is_no_engine_is_named() -> None:
    with pytest.raises(cp.InputError, match=r"engine = 4: give a crankpin\.Engine"):
        cp.torsional_excitation(4, rpm=3000)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"orders = 0\.3"):
        cp.torsional_excitation(I4, rpm=3000, orders=0.3)


# Flywheel, four throws, pulley: inertias in kg·m², stiffnesses in N·m/rad, dampings in N·m·s.
INERTIAS = [0.004, 0.006, 0.006, 0.006, 0.006, 0.15]
STIFFNESSES = [2e5, 5e5, 5e5, 5e5, 9e5]


def responses(excitation: cp.types.TorsionalExcitation) -> NDArray[np.complex128]:
    """Angles of the disks of the chain, cylinders at disks 1 to 4: (K − ω²J + iωC)q = T."""
    count = len(INERTIAS)
    stiffness = np.zeros((count, count))
    for k, each in enumerate(STIFFNESSES):
        stiffness[k : k + 2, k : k + 2] += each * np.array([[1, -1], [-1, 1]])
    damping = np.diag([0.0, 2.0, 2.0, 2.0, 2.0, 0.0])
    found = []
    for omega, torque in zip(excitation.angular_frequency, excitation.torque.T, strict=True):
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
    force[[6 * node + 5 for node in range(1, 5)]] = excitation.torque
    found = rotor.run_forced_response(force=force, speed_range=omegas).forced_resp
    for k, omega in enumerate(omegas):
        dynamic = rotor.K(omega) - omega**2 * rotor.M(omega)
        dynamic = dynamic + 1j * omega * (rotor.C(omega) + rotor.G() * omega)
        expected = np.linalg.solve(dynamic, force[:, k])
        angles = slice(5, None, 6)
        np.testing.assert_allclose(found[angles, k], expected[angles], rtol=1e-6)
