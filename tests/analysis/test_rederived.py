"""Sweeps, automatic orders and rankings against sums over crank angles in plain NumPy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from rederivation import time_domain
from support.engines import CYLINDER

if TYPE_CHECKING:
    from crankpin.model.engine import Hold
    from numpy.typing import NDArray

RPM = 1500.0
OMEGA = 2 * np.pi * RPM / 60
THROWS, SPACING, SPLIT = np.array([0.0, 240.0, 120.0]), 0.11, -30.0
R, ROD, MASS = 0.045, 0.158, 0.5
ORDERS = (1, 2, 3, 4, 6)
SAMPLES = 2048

# Fourier sums of 2048 samples of accelerations of some r·ω², with levers below 1 m.
ROUNDING = 1e-12 * MASS * R * OMEGA**2


def v6_lists(
    bank_angle: float,
    *,
    hold: str = "pins",
    rod: float = ROD,
    offset: float = 0.0,
    rotating: float = 0.0,
) -> time_domain.EngineLists:
    """A V6 of cylinders 1, 3, 5 right and 2, 4, 6 left, given with its banks at 60°.

    Cylinder 1 is at top dead centre at 0 there.
    """
    right, left = 90 - bank_angle / 2, 90 + bank_angle / 2
    pins = 60.0 + np.stack([THROWS, THROWS + SPLIT], axis=1).ravel()
    bank = np.tile([right, left], 3)
    given = np.tile([60.0, 120.0], 3)
    tdc = (bank if hold == "pins" else given) - pins
    z = SPACING * np.repeat(np.arange(3.0), 2)
    return time_domain.EngineLists(R, rod, MASS, tdc, bank, z, offset, rotating)


def v6(rotating: float = 0.0) -> cp.Engine:
    return cp.Engine.vee(
        CYLINDER,
        bank_angle_deg=60,
        throws_deg=THROWS,
        pin_split_deg=SPLIT,
        spacing=SPACING,
        rotating_mass=rotating,
    )


@pytest.mark.parametrize("hold", ["pins", "firing"])
@pytest.mark.parametrize("reference_z", [None, -0.2])
def test_sweep_of_bank_angles_and_proportions(hold: Hold, reference_z: float | None) -> None:
    angles, ratios, offsets = [0.0, 47.3, 60.0, 120.0, 180.0], [0.2, 0.31], [-0.004, 0.0, 0.007]
    s = cp.sweep(
        v6(rotating=0.3).replace(reference_z=reference_z),
        rpm=[RPM / 2, RPM],
        bank_angle_deg=angles,
        hold=hold,
        rod_ratio=ratios,
        pin_offset=offsets,
        orders=ORDERS,
    )
    assert list(s.coords) == ["bank_angle_deg", "rod_ratio", "pin_offset", "rpm"]
    for a, angle in enumerate(angles):
        for k, ratio in enumerate(ratios):
            for o, offset in enumerate(offsets):
                lists = v6_lists(angle, hold=hold, rod=R / ratio, offset=offset, rotating=0.3)
                true = time_domain.phasors(lists, RPM, ORDERS, reference_z, SAMPLES)
                for part, speed in ((4.0, 0), (1.0, 1)):
                    place = (a, k, o, speed)
                    for found, expected in (
                        (s.force.xy, true.force),
                        (s.moment.xy, true.moment),
                        (np.asarray(s.torque), true.roll_torque),
                        (np.asarray(s.crank_torque), true.crank_torque),
                    ):
                        assert np.abs(found[place] - expected / part).max() <= ROUNDING
                theta = time_domain.crank_angles(SAMPLES)
                samples = time_domain.moment(lists, RPM, theta, reference_z)
                forward, backward = time_domain.forward_backward(samples, ORDERS)
                assert np.abs(s.moment.forward[a, k, o, 1] - forward).max() <= ROUNDING
                assert np.abs(s.moment.backward[a, k, o, 1] - backward).max() <= ROUNDING


def waveforms(lists: time_domain.EngineLists) -> dict[str, NDArray[np.float64]]:
    theta = time_domain.crank_angles(SAMPLES)
    return {
        "force": time_domain.force(lists, RPM, theta),
        "moment": time_domain.moment(lists, RPM, theta),
        "torque": time_domain.roll_torque(lists, RPM, theta),
    }


def lengths(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.abs(values) if values.ndim == 1 else np.hypot(*values.T)


@pytest.mark.parametrize("rtol", [1e-1, 1e-2, 1e-3, 1e-5, 1e-8])
@pytest.mark.parametrize("ratio", [0.2, 0.31, 0.6])
@pytest.mark.parametrize("angle", [60.0, 90.0, 47.3])
def test_auto_orders_leave_out_no_more_than_their_bound(
    angle: float, ratio: float, rtol: float
) -> None:
    lists = v6_lists(angle, rod=R / ratio)
    engine = cp.Engine.from_lists(
        CYLINDER.replace(rod_length=R / ratio),
        tdc_deg=lists.column("tdc_deg").ravel(),
        bank_deg=lists.column("bank_deg").ravel(),
        z=lists.column("z").ravel(),
    )
    b = engine.balance(RPM, rtol=rtol)
    theta = time_domain.crank_angles(SAMPLES)
    turning = np.exp(1j * np.outer(theta, b.orders))
    scale = MASS * R * OMEGA**2
    scales = {"force": scale, "moment": scale * SPACING, "torque": scale * R}
    for name, true in waveforms(lists).items():
        phasors = np.asarray(getattr(b, name))
        missing = lengths(true - np.tensordot(turning, phasors, axes=(1, 0)).real)
        bound = b.error_bound[name]
        assert missing.max() <= bound + ROUNDING
        assert bound <= rtol * scales[name] * (1 + 1e-12)


def test_totals_are_the_largest_over_the_turn() -> None:
    for angle in (47.3, 60.0, 90.0):
        engine = v6().with_bank_angle(angle, hold="pins")
        total = engine.balance(RPM, rtol=1e-13).total
        for name, true in waveforms(v6_lists(angle)).items():
            sampled = lengths(true).max()
            found = getattr(total, name).peak
            # 2048 samples miss what lies within 1.5e-3 rad of the peak; orders up to some ten.
            assert sampled - ROUNDING <= found <= sampled * (1 + 5e-4)
            if true.ndim == 2:
                xy = np.abs(true).max(axis=0)
                found_xy = np.asarray(getattr(total, name).peak_xy)
                assert (xy - ROUNDING <= found_xy).all()
                assert (found_xy <= xy * (1 + 5e-4) + ROUNDING).all()


def test_rank_sorts_by_totals_that_numpy_finds() -> None:
    angles = [20.0, 47.3, 60.0, 75.0, 90.0, 120.0]
    engines = {f"{angle:g}": v6().with_bank_angle(angle, hold="pins") for angle in angles}
    for name in ("force", "moment", "torque"):
        ranking = cp.rank(engines, rpm=RPM, by=f"total.{name}.peak")
        true = {f"{angle:g}": lengths(waveforms(v6_lists(angle))[name]).max() for angle in angles}
        for choice in ranking:
            assert choice.value == pytest.approx(true[choice.name], rel=5e-4, abs=ROUNDING)
        listed = np.array([true[choice.name] for choice in ranking])
        assert (listed[:-1] <= listed[1:] * (1 + 5e-4) + ROUNDING).all()
        if name == "moment":
            assert listed[0] < 0.9 * listed[-1]


def test_rank_over_bank_angles_finds_the_least_that_numpy_finds() -> None:
    angles = np.arange(10.0, 181.0, 10.0)
    ranking = cp.rank(v6(), rpm=RPM, by="total.moment.peak", bank_angle_deg=angles, hold="pins")
    true = [lengths(waveforms(v6_lists(angle))["moment"]).max() for angle in angles]
    best = ranking[0]
    assert best.bank_angles_deg == (angles[int(np.argmin(true))],)
    assert best.value == pytest.approx(min(true), rel=5e-4)
