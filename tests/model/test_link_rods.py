"""Link rods: figures, loops of rods derived anew, the surface, and what rejects them."""

from __future__ import annotations

import copy
import csv
import pickle
from fractions import Fraction
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import InputError
from crankpin.analysis.geometry import geometry
from rederivation import link_rods as anew
from rederivation.link_rods_mp import TABLE
from rederivation.link_sums_mp import Hung, sums

ONE_RADIAN = 60.0 / (2.0 * np.pi)
"""rpm at which ω is 1."""


def radial(**rods: object) -> cp.Engine:
    """Return five cylinders on a master rod, with pistons of 1 kg."""
    given = {"radius": 0.052, "length": 0.178} | rods
    return cp.Engine.radial(cp.Cylinder(0.06, 0.23, 1.0), 5, rods=cp.LinkRods(**given))  # type: ignore[arg-type]


def star(ahead: float = 0.0) -> anew.Star:
    angles = tuple(72.0 * k for k in range(1, 5))
    return anew.Star(0.06, 0.23, 0.052, 0.178, angles, tuple(angle + ahead for angle in angles))


def turning(engine: cp.Engine, order: int, scale: float = 0.06) -> tuple[float, float]:
    """Return the sizes of forward and backward force over m·r·ω²."""
    force = engine.balance(ONE_RADIAN, orders=[order])[order].force
    return float(abs(force.forward)) / scale, float(abs(force.backward)) / scale


# P60 to P69: Chapter "articulated rods" of the reference; each from loops of rods and 25 digits.
@pytest.mark.parametrize(
    ("order", "side", "value"),
    [(1, 0, 2.5), (2, 0, 0.39958519), (2, 1, 0.00026759569), (4, 1, 0.026812432)],
)
def test_figures_of_a_star(order: int, side: int, value: float) -> None:
    assert turning(radial(), order)[side] == pytest.approx(value, rel=1e-7)


def test_figures_of_strokes_and_leading_terms() -> None:
    assert cp.dead_centres(radial()).stroke.max() / 0.12 == pytest.approx(1.0042384, rel=1e-7)
    assert pytest.approx(0.38104543, rel=1e-7) == 5 * (60 / 178) * (52 / 230)
    alike = cp.Engine.radial(cp.Cylinder(0.06, 0.23, 1.0), 5)
    assert turning(alike, 4)[1] == pytest.approx(0.011691518, rel=1e-7)
    assert turning(alike, 2) == (0.0, 0.0)


def test_figures_of_big_ends_and_the_mass_that_makes_the_star_whole() -> None:
    cylinders = [cp.Cylinder(0.06, 0.23, 0.0)] * 5
    rods = cp.LinkRods(0.052, 0.178, big_end_mass=1.0)
    forward, backward = turning(cp.Engine.radial(cylinders, 5, rods=rods), 1)
    assert backward == pytest.approx(0.11304348, rel=1e-7)
    assert forward == pytest.approx(4.1130435, rel=1e-7)
    cylinders[0] = cylinders[0].replace(reciprocating_mass=52 / 230)
    assert turning(cp.Engine.radial(cylinders, 5, rods=rods), 1)[1] < 1e-14


# P70 to P72: Khurmi 22.14, printed 11.1 and 3.70 kN.
def test_three_cylinder_compressor() -> None:
    three = cp.Engine.radial(cp.Cylinder(0.05, 0.15, 1.5), 3)
    force = three.balance(3000, orders=[1, 2])
    assert force[1].force.peak == pytest.approx(11103.305, rel=1e-7)
    assert force[2].force.peak == pytest.approx(3809.6392, rel=1e-7)
    omega = 2 * np.pi * 50
    assert 1.5 * 1.5 * 0.05 * omega**2 / 3 == pytest.approx(3701.1017, rel=1e-7)


def twin(bank: float, knuckle: float) -> cp.Engine:
    return cp.Engine.vee(
        cp.Cylinder(0.048, 0.19, 1.0), bank_angle_deg=bank, throws_deg=[0], spacing=0.1,
        rods=cp.LinkRods(0.038, 0.152, angles_deg=[knuckle]), master="right",
    )  # fmt: skip


# P73 to P75: longest force over m·r·ω².
def test_figures_of_a_twin() -> None:
    b = twin(45, 45).balance(ONE_RADIAN, orders=[1, 2, 3])
    longest = [abs(b[n].force.forward) + abs(b[n].force.backward) for n in (1, 2, 3)]
    assert longest[0] / 0.048 == pytest.approx(1.7071068, rel=1e-7)
    assert longest[1] / 0.048 == pytest.approx(0.3014848, rel=1e-7)
    assert longest[2] == 0.0


@pytest.mark.parametrize("ahead", [0.0, 6.0, 1e-7])
def test_forces_and_roll_are_those_of_the_loops(ahead: float) -> None:
    masses, big_ends = (1.1, 0.9, 0.9, 0.9, 0.9), (0.3,) * 4
    cylinders = [cp.Cylinder(0.06, 0.23, mass) for mass in masses]
    angles = [72 * k + ahead for k in range(1, 5)]
    rods = cp.LinkRods(0.052, 0.178, angles_deg=angles, big_end_mass=0.3)
    engine = cp.Engine.radial(cylinders, 5, rods=rods)
    # Their master stands on the bore at 0°, the engine's upright.
    forward, backward = anew.phasors(anew.force(star(ahead), masses, big_ends))
    b = engine.balance(ONE_RADIAN, orders=range(1, 11))
    for n in range(1, 11):
        # Samples of positions lose n² times their rounding.
        assert abs(b[n].force.forward - 1j * forward[n]) < 1e-12, n
        assert abs(b[n].force.backward - 1j * backward[n]) < 1e-12, n
    still = cp.Engine.radial(
        cylinders, 5, rods=cp.LinkRods(0.052, 0.178, angles_deg=angles, big_end_mass=0.0)
    )
    theta = 360.0 * np.arange(256) / 256
    torque = still.waveform(ONE_RADIAN, theta).torque
    assert np.abs(torque - anew.roll(star(ahead), masses)).max() < 1e-12


def test_odd_orders_vanish_exactly_where_knuckles_stand_at_their_bores() -> None:
    verdicts = radial().vanishing_orders(range(1, 10)).force
    assert set(verdicts.vanishing) >= {3, 5, 7, 9}
    turned = radial(angles_deg=[73, 145, 217, 289])
    assert turned.balance(3000, orders=[3])[3].force.peak > 1.0
    assert 3 not in turned.vanishing_orders([3]).force.vanishing
    # In proportion to the angle between, with all digits, down to nothing.
    third = [
        turning(radial(angles_deg=[72 + by, 144 + by, 216 + by, 288 + by]), 3)[1] / by
        for by in (1e-3, 1e-6, 1e-9)
    ]
    assert third == pytest.approx([third[0]] * 3, rel=1e-4)


def test_a_knuckle_at_the_crankpin_is_a_plain_rod() -> None:
    plain = cp.Engine.radial(cp.Cylinder(0.06, 0.178, 1.0), 5)
    hung = cp.Engine.radial(cp.Cylinder(0.06, 0.178, 1.0), 5, rods=cp.LinkRods(0.0))
    assert np.array_equal(plain.balance(3000).force.xy, hung.balance(3000).force.xy)


def test_dead_centres_are_beside_the_bores() -> None:
    found = cp.dead_centres(radial(), compression_ratio=6.0)
    assert found.tdc_deg[0] == 0.0
    assert found.compression_ratio is not None
    assert found.compression_ratio[0] == pytest.approx(6.0, rel=1e-14)
    assert np.abs(found.tdc_deg[1:] - 72.0 * np.arange(1, 5)).min() > 1.0
    theta = np.linspace(0.0, 2.0 * np.pi, 100_001)
    _, _, pistons = anew.places(star(), theta)
    for k in range(5):
        distance = abs(pistons[k])
        assert found.height[k] == pytest.approx(distance.max(), rel=1e-9)
        assert found.stroke[k] == pytest.approx(np.ptp(distance), rel=1e-8)
        assert found.tdc_deg[k] == pytest.approx(np.degrees(theta[distance.argmax()]), abs=4e-3)
        assert found.bdc_deg[k] == pytest.approx(np.degrees(theta[distance.argmin()]), abs=4e-3)
    head = found.height[0] + found.stroke[0] / 5.0
    assert found.compression_ratio == pytest.approx(1 + found.stroke / (head - found.height))
    with pytest.raises(InputError, match="touch its head"):
        cp.dead_centres(radial(length=0.18), compression_ratio=900)
    assert cp.dead_centres(cp.Engine.preset("i4")).compression_ratio is None


@pytest.mark.parametrize("kind", ["stroke", "compression"])
def test_knuckles_are_solved_for_equal_strokes_and_compression(kind: str) -> None:
    radius = 0.052 if kind == "stroke" else None
    rods = cp.LinkRods(radius, 0.178, big_end_mass=0.2, equal=kind)  # type: ignore[arg-type]
    cylinder, offset = cp.Cylinder(0.06, 0.23, 1.0), cp.Cylinder(0.06, 0.23, 1.0, 0.004)
    sixty = [0, 120, 240, 240, 120, 0]
    theta = np.linspace(0.0, 2.0 * np.pi, 20_001)
    twin_of_equal_rods = cp.Engine.vee(cylinder, bank_angle_deg=45, throws_deg=[0], spacing=0.2)
    for engine in (
        *(cp.Engine.radial(cylinder, count, rods=rods) for count in (3, 4, 5, 9)),
        cp.Engine.radial(cylinder, 14, rows=2, spacing=0.2, rods=rods, master=[5, 8]),
        cp.Engine.radial([offset] + [cylinder] * 3, 4, rods=rods),
        cp.Engine.vee(
            cylinder, bank_angle_deg=60, throws_deg=sixty, spacing=0.2, rods=rods, master="left"
        ),
        cp.Engine.vee(cylinder, bank_angle_deg=180, throws_deg=[0], spacing=0.2, rods=rods),
        # One of whose cranks turns the other way.
        cp.Engine.on_cranks([twin_of_equal_rods] * 2, cranks=[(0.5, 0, -1)]).with_link_rods(rods),
    ):  # fmt: skip
        ends = cp.dead_centres(engine, compression_ratio=7)
        assert np.ptp(ends.stroke) <= 1e-12 * ends.stroke[0]
        assert ends.compression_ratio is not None
        if kind == "compression":
            assert np.ptp(ends.height) <= 1e-12 * ends.height[0]
            assert np.ptp(ends.compression_ratio) < 1e-12
        assert cp.Engine.from_toml(engine.to_toml()) == engine
        # The loops of the rods, anew.
        for k, link in enumerate(engine.link_rods):
            if link is None:
                continue
            assert kind == "compression" or link.radius == 0.052
            assert link.big_end_mass == 0.2
            master = engine.cylinders[link.master - 1]
            bores = np.radians(engine.bank_deg)
            own, of_master = bores[k], bores[link.master - 1]
            crankpin = 0.06 * np.exp(1j * theta)
            path = crankpin - 1j * master.pin_offset * np.exp(1j * of_master)
            wrist = anew.on_bore(path, 0.23, np.degrees(of_master))
            shank = (wrist - path) / 0.23
            knuckle = crankpin + link.radius * shank * np.exp(1j * np.radians(link.angle_deg))
            piston = (anew.on_bore(knuckle, 0.178, np.degrees(own)) / np.exp(1j * own)).real
            # Parabolas between steps of a turn's 20 000th part.
            assert np.ptp(piston) == pytest.approx(ends.stroke[link.master - 1], rel=1e-7)
            if kind == "compression":
                assert piston.max() == pytest.approx(ends.height[link.master - 1], rel=1e-8)
            # Near its bore.
            apart = (link.angle_deg - np.degrees(own - of_master) + 180) % 360 - 180
            assert abs(apart) < 2.0


def test_an_opposed_link_keeps_its_knuckle_at_the_bore() -> None:
    flat = cp.Engine.vee(
        cp.Cylinder(0.06, 0.23, 1.0), bank_angle_deg=180, throws_deg=[0], spacing=0.1,
        rods=cp.LinkRods(0.052, 0.178, equal="stroke"),
    )  # fmt: skip
    link = next(link for link in flat.link_rods if link is not None)
    assert link.exact_angle == "180"
    assert flat.vanishing_orders([3, 5]).force.vanishing == (3, 5)


def test_a_link_as_long_as_its_master_hangs_on_the_crankpin() -> None:
    five = cp.Engine.radial(
        cp.Cylinder(0.06, 0.23, 1.0), 5, rods=cp.LinkRods(length=0.23, equal="compression")
    )
    assert {link.radius for link in five.link_rods if link is not None} == {0.0}


def test_pressure_does_work_on_link_pistons() -> None:
    cycle = cp.Cycle.example()
    engine = cp.Engine.radial(
        cp.Cylinder(0.06, 0.23, 1.0, bore=0.12), 5, rods=cp.LinkRods(0.052, 0.178)
    ).with_cycle(cycle)
    theta = np.linspace(0.0, 720.0, 7201)
    _, _, pistons = anew.places(star(), np.radians(theta))
    area, work = 0.25 * np.pi * 0.12**2, 0.0
    for k, begins in enumerate(engine.firing_deg):
        gauge = cycle.pressure_at(theta - begins) - 101325.0
        work += float(np.trapezoid(-gauge * area, abs(pistons[k])))
    # The trapezoidal rule in steps of 0.1°.
    mean = np.mean(engine.waveform(3000, theta[:-1]).crank_torque)
    assert mean == pytest.approx(work / (4.0 * np.pi), rel=1e-4)
    true = cp.dead_centres(engine).tdc_deg
    assert (engine.firing_deg - true) % 360.0 == pytest.approx(np.zeros(5), abs=1e-9)


def test_the_surface() -> None:
    v12 = cp.Engine.vee(
        cp.Cylinder(0.048, 0.19, 1.0), bank_angle_deg=60,
        throws_deg=[0, 120, 240, 240, 120, 0], spacing=0.1,
    )  # fmt: skip
    rods = cp.LinkRods(0.038, 0.152, angles_deg=[67] * 6, big_end_mass=0.2)
    linked = v12.with_link_rods(rods, master="left")
    assert [link is None for link in linked.link_rods] == [False, True] * 6
    assert linked.link_rods[0] == cp.LinkRod(2, 0.038, 67, 0.2)
    assert [one.rod_length for one in linked.cylinders[:2]] == [0.152, 0.19]
    for same in (
        cp.Engine.from_toml(linked.to_toml()), cp.Engine.from_json(linked.to_json()),
        pickle.loads(pickle.dumps(linked)),  # noqa: S301 - its own
        copy.deepcopy(linked), linked.replace(name=""),
        v12.replace(cylinder=linked.cylinders).with_link_rods(linked.link_rods),
    ):  # fmt: skip
        assert same == linked
    assert linked.with_link_rods([None] * 12).link_rods == (None,) * 12
    assert cp.LinkRod(1, 0.04, "360/7").exact_angle == "360/7"
    two_rows = cp.Engine.radial(
        cp.Cylinder(0.06, 0.23, 1.0), 14, rows=2, spacing=0.2,
        rods=cp.LinkRods(0.052, 0.178), master=[5, 8],
    )  # fmt: skip
    assert [k + 1 for k, link in enumerate(two_rows.link_rods) if link is None] == [5, 8]


def test_a_rod_with_a_big_end_brings_it_to_the_knuckle() -> None:
    rod = cp.Rod(mass=0.6, inertia=0.0025, length=0.178, to_crankpin=0.05)
    link = cp.Cylinder.from_rod(rod, 0.06, 0.8)
    five = cp.Engine.radial([cp.Cylinder(0.06, 0.23, 1.0)] + [link] * 4, 5, rods=cp.LinkRods(0.052))
    assert five.rotating_mass.tolist() == [0.0] * 5
    assert five.link_rods[1] is not None
    assert five.link_rods[1].big_end_mass == rod.rotating_mass
    assert cp.Engine.from_toml(five.to_toml()) == five


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: radial(length=0.05), "rod_length"),
        (lambda: radial(radius=-1.0), "radius"),
        (lambda: radial(angles_deg=[72]), "angles_deg"),
        (lambda: radial(big_end_mass=np.nan), "big_end_mass"),
        (cp.LinkRods, "radius"),
        (lambda: cp.LinkRods(equal="stroke"), "radius"),
        (lambda: cp.LinkRods(0.05, equal="compression"), "radius"),
        (lambda: cp.LinkRods(0.05, angles_deg=[72] * 4, equal="stroke"), "angles_deg"),
        (lambda: cp.LinkRods(0.05, equal="height"), "equal"),  # type: ignore[arg-type]
        (lambda: radial(radius=None, length=0.24, equal="compression"), "length"),
        # Where the master's offset makes its stroke longer, and the opposed link's at no angle.
        (lambda: cp.Engine.vee(
            [cp.Cylinder(0.06, 0.23, 1, 0.05), cp.Cylinder(0.06, 0.23, 1)], bank_angle_deg=180,
            throws_deg=[0], spacing=0.1, rods=cp.LinkRods(0.0, 0.178, equal="stroke"),
        ), 'equal = "stroke".* cylinder 2 the stroke of cylinder 1'),
        (lambda: cp.LinkRod(0, 0.05, 60), "master"),
        (lambda: radial().with_link_rods([None]), "rods"),
        (lambda: radial().with_link_rods([1] * 5), r"rods\[0\]"),  # type: ignore[list-item]
        (lambda: radial().with_link_rods(cp.LinkRods(0.05), master="middle"), "master"),
        (lambda: radial().with_link_rods(cp.LinkRods(0.05), master=9), "master"),
        (lambda: radial().with_link_rods(cp.LinkRods(0.05), master=[1, 2]), "master"),
        (lambda: cp.Engine.preset("i4").with_link_rods(cp.LinkRods(0.05)), "rods"),
        (lambda: cp.Engine.vee(
            cp.Cylinder(0.04, 0.15, 1), bank_angle_deg=90, throws_deg=[0], spacing=0.1, master=1
        ), "master"),
        (lambda: cp.sweep(radial(), rpm=1000, rod_ratio=[0.2, 0.3]), "rod_ratio"),
        (lambda: cp.sweep(radial(), rpm=1000, pin_offset=[0.0, 0.001]), "pin_offset"),
        (lambda: cp.sweep(twin(45, 45), rpm=1000, bank_angle_deg=[45, 60], hold="pins"),
         "bank_angle_deg"),
        (lambda: twin(45, 45).with_bank_angle(60, hold="pins"), "bank_angle_deg"),
        (lambda: cp.tolerances(radial(), 1000, rod_length=1e-5, samples=20), "rod_length"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_rejected_by_name(call: object, named: str) -> None:
    with pytest.raises(InputError, match=f"^{named}|: {named}|{named}"):
        call()  # type: ignore[operator]


def test_masses_scatter_about_the_linked_engine() -> None:
    engine = radial(big_end_mass=0.2)
    found = cp.tolerances(engine, 3000, reciprocating_mass=1e-9, samples=50, orders=[1, 2])
    assert found is not None


def test_sweeps_of_speed_are_balances() -> None:
    engine = radial(big_end_mass=0.2)
    s = cp.sweep(engine, rpm=[1000, 3000], orders=[1, 2, 4])
    b = engine.balance(3000, orders=[1, 2, 4])
    assert s.force.xy[-1] == pytest.approx(b.force.xy, rel=1e-12)


def test_many_link_rods_are_those_of_engines() -> None:
    rng = np.random.default_rng(7)
    count = 200
    rods = rng.choice([0.178, 0.2, 0.13], count)
    knuckles = rng.choice([0.0, 0.02, 0.052], count)
    bores = rng.choice([0.0, 72.0, -72.0, 144.0, 180.0], count)
    angles = bores + rng.choice([0.0, 0.0, 7.0, 1e-6, 90.0], count)
    orders = [1, 2, 3, 4, 5, 6, 8, 12]
    many = cp.link_rod_harmonics(
        0.06 / rods, orders, master_ratio=0.06 / 0.23, knuckle_ratio=knuckles / 0.06,
        bore_deg=bores, knuckle_deg=angles,
    )  # fmt: skip
    assert many.shape == (count, len(orders))
    theta = 2.0 * np.pi * np.arange(512) / 512
    for k in range(count):
        one = anew.Star(0.06, 0.23, knuckles[k], rods[k], (bores[k],), (angles[k],))
        # θ counts from where the crankpin points along the own bore.
        _, _, pistons = anew.places(one, theta + np.radians(bores[k]))
        height = (pistons[1] / np.exp(1j * np.radians(bores[k]))).real / 0.06
        sampled = 2.0 * np.fft.rfft(height)[orders] / 512 * np.square(orders)
        # Samples of heights of 3 lose n² times their rounding.
        assert np.abs(many[k] - sampled).max() < 1e-12, k
    is_even = (angles == bores) | (knuckles == 0.0)
    assert (many[is_even][:, [2, 4]] == 0.0).all()
    assert (many[is_even, 0] == 1.0).all()
    assert (many[~is_even][:, 2] != 0.0).all()
    with pytest.raises(InputError, match=r"rod_ratio\[1\]"):
        cp.link_rod_harmonics(
            [0.3, 0.9], [2], master_ratio=0.26, knuckle_ratio=0.8, bore_deg=60, knuckle_deg=150
        )
    with pytest.raises(InputError, match="shapes that broadcast"):
        cp.link_rod_harmonics(
            [0.3, 0.2], [2], master_ratio=[0.2] * 3, knuckle_ratio=0.8, bore_deg=60
        )


def test_harmonics_beside_50_digits() -> None:
    with TABLE.open(encoding="utf-8") as lines:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(lines)]
    assert len(rows) > 100
    for row in rows:
        n = int(row["order"])
        arguments = {name: row[name] for name in ("master_ratio", "knuckle_ratio")}
        rod = row["rod_ratio"]
        value = cp.link_rod_harmonics(
            rod, [n], bore_deg=row["bore_deg"], knuckle_deg=row["knuckle_deg"], **arguments
        )[0]
        exact = complex(row["re"], row["im"])
        # The bound of the table: 1e-12 of the largest, which is about 1.
        assert abs(value - exact) < 1e-12, row
        engine = cp.Engine.from_lists(
            [cp.Cylinder(1.0, 1 / row["master_ratio"], 0.0), cp.Cylinder(1.0, 1 / rod, 1.0)],
            tdc_deg=[0, row["bore_deg"]], bank_deg=[0, row["bore_deg"]], z=[0, 0],
        ).with_link_rods(
            [None, cp.LinkRod(1, row["knuckle_ratio"], row["knuckle_deg"])]
        )  # fmt: skip
        turned = np.exp(1j * np.radians(row["bore_deg"]) * (1 - n))
        forward = engine.balance(ONE_RADIAN, orders=[n])[n].force.forward
        assert abs(2.0 * forward / turned - exact) < 1e-12, row
        # Odd orders above the first keep their digits down to none.
        is_small = n % 2 == 1 and n > 1 and row["knuckle_ratio"] > 0.1
        if is_small and 0.0 < abs(row["knuckle_deg"] - row["bore_deg"]) < 1e-3:
            assert abs(value - exact) < 1e-6 * abs(exact), row


def limited(**figures: float) -> dict[int, complex]:
    """Return harmonics of orders 1 to 6 of a usual link rod with some other figures."""
    usual = {
        "rod_ratio": 0.33, "master_ratio": 0.26, "knuckle_ratio": 0.87, "bore_deg": 72.0,
        "knuckle_deg": 79.0,
    } | figures  # fmt: skip
    values = cp.link_rod_harmonics(usual.pop("rod_ratio"), range(1, 7), **usual)
    return dict(enumerate(values.tolist(), start=1))


def test_limits_of_knuckles() -> None:
    plain = cp.slider_crank_harmonics(0.33, range(1, 7)).tolist()
    # To the last digit on the crankpin, and smoothly towards it.
    linked = cp.Engine.radial(
        [cp.Cylinder(0.06, 0.23, 1)] + [cp.Cylinder(0.06, 0.178, 1)] * 4, 5, rods=cp.LinkRods(0.0)
    )
    alone = cp.Engine.radial([cp.Cylinder(0.06, 0.23, 1)] + [cp.Cylinder(0.06, 0.178, 1)] * 4, 5)
    for quantity in ("force", "moment", "torque"):
        assert np.array_equal(
            linked.balance(3000, orders=range(1, 9)).read(quantity),
            alone.balance(3000, orders=range(1, 9)).read(quantity),
        )
    for small in (1e-3, 1e-6, 1e-9, 1e-12):
        near = limited(knuckle_ratio=small)
        assert max(abs(near[n] - plain[n - 1]) for n in near) < 2 * small + 1e-13
    # Odd orders fall in proportion to the angle between knuckle and bore, and are zero with it.
    by = limited(knuckle_deg=73.0)[3] / np.sin(np.radians(1.0))
    for angle in (1e-2, 1e-5, 1e-8, 1e-11):
        turned = 72.0 + angle
        third = limited(knuckle_deg=turned)[3]
        assert third / np.sin(np.radians(turned - 72.0)) == pytest.approx(by, rel=2e-2)
    assert limited(knuckle_deg=72.0)[3] == 0.0
    assert limited(knuckle_deg=252.0)[3] == 0.0


@pytest.mark.parametrize("part", [0.1, 1e-2, 1e-4, 1.1e-6])
def test_a_link_barely_long_enough(part: float) -> None:
    theta = 2.0 * np.pi * np.arange(2**16) / 2**16
    lean = -np.arcsin(0.26 * np.sin(theta + np.radians(72.0)))
    knuckle = np.exp(1j * theta) + 0.87 * np.exp(1j * (np.radians(7.0) + lean))
    reach = np.abs(knuckle.imag).max()
    rod = reach * (1 + part)
    found = limited(rod_ratio=1.0 / rod)
    heights = knuckle.real + np.sqrt((rod - knuckle.imag) * (rod + knuckle.imag))
    sampled = 2.0 * np.fft.rfft(heights)[:7] / len(theta) * np.arange(7) ** 2
    # The largest order is of size 1; at 1.1e-6 samples are still finer than the root's corner.
    assert max(abs(found[n] - sampled[n]) for n in found) < 1e-11
    with pytest.raises(InputError, match="too short for its knuckle"):
        limited(rod_ratio=1.0 / (reach * (1 - 1e-9)))


def test_masses_apart_by_little_leave_little() -> None:
    for apart in (1e-12, 1e-9):
        cylinders = [cp.Cylinder(0.06, 0.23, 1.0 + (k == 2) * apart) for k in range(5)]
        engine = cp.Engine.radial(cylinders, 5, rods=cp.LinkRods(0.052, 0.178))
        backward = turning(engine, 1)[1]
        assert backward == pytest.approx(apart / 2, rel=1e-3 if apart < 1e-10 else 1e-6)


@pytest.mark.parametrize("theta", [0.0, 33.0, 250.0])
def test_rods_are_drawn_from_their_knuckles(theta: float) -> None:
    engine = radial(angles_deg=[75, 147, 219, 291])
    at = geometry(engine, theta)
    turn = 1j  # the master of the other stands at 0°
    crankpin, lower, pistons = anew.places(star(3.0), np.array([np.radians(theta)]))
    assert at.rod_foot == pytest.approx(turn * np.concatenate(lower), abs=1e-15)
    assert at.wrist_pin == pytest.approx(turn * np.concatenate(pistons), abs=1e-15)
    assert at.crankpin == pytest.approx(turn * np.repeat(crankpin, 5), abs=1e-15)
    _, _, turned = anew.places(star(3.0), np.linspace(0.0, 2.0 * np.pi, 10_001))
    for k in range(5):
        assert at.highest[k] == pytest.approx(abs(turned[k]).max(), rel=1e-7)
        assert at.lowest[k] == pytest.approx(abs(turned[k]).min(), rel=1e-7)


def test_torques_of_masses_at_knuckles_are_proved() -> None:
    found = radial(big_end_mass=0.3).vanishing_orders(range(1, 7))
    assert set(found.torque.words) == {"remains"}
    assert not any("knuckles" in reason for reason in found.obstacles)
    assert {3, 5} <= set(found.force.vanishing)
    massless = cp.Engine.radial(
        cp.Cylinder(0.06, 0.23, 0.0), 5, rods=cp.LinkRods(0.052, 0.178, big_end_mass=1.0)
    )
    # What a knuckle adds to its parts' torques has no order 6; that of the master's motion has.
    assert massless.vanishing_orders([6]).torque.words == ("remains",)


def exact(value: float) -> Fraction:
    return Fraction(repr(value))


def drawn(seed: int) -> tuple[cp.Engine, list[Hung]]:
    """Return an engine of few values, so that things coincide, and its cylinders for 50 digits."""
    rng = np.random.default_rng(seed)

    def choice(options: list[Any]) -> Any:  # noqa: ANN401
        return options[rng.integers(len(options))]

    throws = choice([[0], [0, 180], [0, 120, 240], [0, 180, 180, 0]])
    count = choice([3, 4, 5, 7])
    star = [Fraction(360 * k, count) for k in range(count)]
    bores = choice([star, star, [Fraction(0), Fraction(choice([45, 60, 90, 180]))]])
    knuckle, big_end, length = choice([0.05, 0.052]), choice([0.0, 0.2, 0.4]), choice([0.2, 0.23])
    mass, ahead = choice([0.0, 1.0]), choice([0, 0, 7])
    # As heavy as makes a star whole again, or not; beyond what is a decimal as the nearest double.
    master_mass = exact(mass) + choice([0, 1]) * exact(big_end) * exact(knuckle) / exact(length)
    engine_of: list[cp.Cylinder] = []
    links: list[cp.LinkRod | None] = []
    hung: list[Hung] = []
    offset = choice([0.0, 0.0, 0.004])
    unlike = choice([0.0, 0.1])
    for row, throw in enumerate(throws):
        for k, bore in enumerate(bores):
            radius, rod, moving = map(exact, (0.06, 0.18, mass))
            own = Hung(radius, rod, moving, bore, Fraction(throw), Fraction(row) / 10)
            if k == 0:
                own = own._replace(rod=exact(length), offset=exact(offset), mass=master_mass)
                links.append(None)
            else:
                end = big_end + unlike * (row == 0 and k == 1)
                own = own._replace(
                    master=len(bores) * row, radius=exact(knuckle), angle=bore + ahead,
                    big_end=exact(end),
                )  # fmt: skip
                links.append(cp.LinkRod(len(bores) * row + 1, knuckle, bore + ahead, end))
            hung.append(own)
            engine_of.append(
                cp.Cylinder(
                    float(own.crank_radius), float(own.rod), float(own.mass), float(own.offset)
                )
            )
    engine = cp.Engine.from_lists(
        engine_of,
        tdc_deg=[own.bore - own.throw for own in hung],
        bank_deg=[own.bore for own in hung],
        z=[float(own.z) for own in hung],
    )
    return engine.with_link_rods(links), hung


def check_proofs(seeds: range) -> dict[str, int]:
    """Compare verdicts with 50 digits, and return how many there are of each."""
    orders, verdicts = range(1, 7), {"vanishes": 0, "remains": 0, "undecided": 0}
    for seed in seeds:
        engine, hung = drawn(seed)
        found = engine.vanishing_orders(orders)
        words = {
            ("torque", "z"): found.torque.words,
            **{
                (name, part): getattr(getattr(found, name), part).words
                for name in ("force", "moment")
                for part in ("x", "y", "forward", "backward")
            },
        }
        for quantity, values in sums(hung, orders).items():
            for n, word, value in zip(orders, words[quantity], values, strict=True):
                verdicts[word] += 1
                if word == "vanishes":
                    # Less than what samples fold back.
                    assert abs(value) < 1e-30, (seed, quantity, n)
                elif word == "remains":
                    assert abs(value) > 1e-14, (seed, quantity, n)
    return verdicts


def test_proofs_of_links_with_big_ends_beside_50_digits() -> None:
    verdicts = check_proofs(range(3))
    assert min(verdicts["vanishes"], verdicts["remains"]) > 40
    assert verdicts["undecided"] <= 0.01 * sum(verdicts.values())


@pytest.mark.slow
def test_more_proofs_of_links_with_big_ends_beside_50_digits() -> None:
    verdicts = check_proofs(range(3, 60))
    assert verdicts["undecided"] <= 0.01 * sum(verdicts.values())


def test_turning_points_beside_whole_degrees_are_not_rounded() -> None:
    """With a knuckle between 1 and 52 mm a piston is highest 2.0005° past its bore."""

    def past(radius: float) -> float:
        star = cp.Engine.radial(cp.Cylinder(0.06, 0.23, 1.0), 5, rods=cp.LinkRods(radius, 0.178))
        return float(cp.dead_centres(star).tdc_deg[1]) - 72.0

    low, high = 0.001, 0.052
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if past(middle) < 2.0005 else (low, middle)
    assert past(high) == pytest.approx(2.0005, abs=1e-11)  # of roots to 1e-13°


def test_torque_of_big_ends_beside_long_cranks_is_that_of_their_motion() -> None:
    """Of a master rod of 1.15 crank radii, with an offset pin: free masses followed over a turn."""
    link = cp.Cylinder(0.06, 0.068, 1.0)
    cylinders = [link.replace(rod_length=0.069, pin_offset=0.003), link]
    rods = cp.LinkRods(0.004, 0.068, big_end_mass=0.4)
    twin = cp.Engine.vee(cylinders, bank_angle_deg=60, throws_deg=[0], spacing=0.1, rods=rods)
    bore = np.exp(1j * np.radians(60.0))
    crankpin = 0.06 * bore * np.exp(2j * np.pi * np.arange(1024) / 1024)
    aside = crankpin / bore - 0.003j
    wrist = bore * (aside.real + np.sqrt(0.069**2 - aside.imag**2) + 0.003j)
    knuckle = crankpin + 0.004 * bore * (wrist - crankpin) / 0.069
    piston = anew.on_bore(knuckle, 0.068, 120.0)
    free = anew.torques((1.0, 1.0, 0.4), (wrist, piston, knuckle))
    balance = twin.balance(1000, orders=[1, 2, 3])
    omega_squared = (1000 * np.pi / 30) ** 2
    for name, of in zip(("torque", "crank_torque"), free, strict=True):
        phasors = 2.0 * np.fft.fft(of * omega_squared) / 1024
        for order in (1, 2, 3):
            # Derivatives by transforms of 1024 samples lose three digits.
            expected = pytest.approx(complex(phasors[order]), abs=1e-12 * abs(phasors).max())
            assert complex(getattr(balance[order], name).phasor) == expected
        waveform = twin.waveform(1000, theta_deg=360.0 * np.arange(1024) / 1024)
        # Second derivatives of the highest of 512 orders lose another three digits.
        size = abs(of).max() * omega_squared
        over_turn = np.asarray(getattr(waveform, name))
        np.testing.assert_allclose(over_turn, of * omega_squared, rtol=0.0, atol=1e-9 * size)
