"""Are the waveforms of a sweep those of its engines, by orders and by kinematics?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import labels
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import time_domain
from support import long_calls
from support.engines import OFFSET

if TYPE_CHECKING:
    from crankpin.model.engine import Hold

V6 = cp.Engine.vee(
    OFFSET, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.13, rotating_mass=0.8
)
UNLIKE = cp.Engine.from_lists(
    [
        cp.Cylinder(
            0.045 + 0.001 * (k % 3), 0.158 + 0.002 * (k % 2), 1.0 + 0.1 * k, 0.001 * (k % 4)
        )
        for k in range(6)
    ],
    tdc_deg=[0, 0.4, 120, 120.4, 0, 0],
    bank_deg=[60, 120, 60, 120, 60, 120],
    z=[0.0, 0.1, 0.2, 0.3, 0.5, 0.7],
    rotating_mass=[0.0, 0.1, 0.2, 0.3, 0.0, 0.5],
    name="unlike",
)
"""Cylinders that move alike or nearly so, of several kinds."""
THETA = np.linspace(-360.0, 720.0, 1300)
"""More than a thousand and no multiple of a power of two: the blocks they are done in show."""

ROUNDING = 1e-13
"""Relative to what all cylinders would exert together: tens of roundings of 1e-16, of angles as of
sums, and accelerations near λ = 1 of some times r·ω²."""


def single(engine: cp.Engine, **point: Any) -> cp.Engine:  # noqa: ANN401 - figures and a word
    """One engine of a sweep, by the builders of engines."""
    if "bank_angle_deg" in point:
        engine = engine.with_bank_angle(point["bank_angle_deg"], hold=point["hold"])
    cylinders = list(engine.cylinders)
    if "pin_offset" in point:
        cylinders = [c.replace(pin_offset=point["pin_offset"]) for c in cylinders]
    if "rod_ratio" in point:
        ratio = point["rod_ratio"]
        cylinders = [c.replace(rod_length=c.crank_radius / ratio) for c in cylinders]
    return engine.replace(cylinder=cylinders)


def size(engine: cp.Engine, rpm: float, quantity: str) -> float:
    """What the cylinders would exert if nothing cancelled."""
    force = sum(c.reciprocating_mass * c.crank_radius for c in engine.cylinders)
    reach = {
        "force": 1.0,
        "moment": float(np.ptp(engine.z)),
        "torque": max(c.crank_radius for c in engine.cylinders),
    }
    return float(force * (2 * np.pi * rpm / 60) ** 2 * reach[quantity])


QUANTITIES = ("force", "moment", "torque")


@pytest.mark.parametrize("hold", ["pins", "firing"])
@pytest.mark.parametrize("how", [None, (1, 2, 3, 4, 6, 8)], ids=["exact", "orders"])
def test_every_point_is_that_engine(hold: Hold, how: tuple[int, ...] | None) -> None:
    angles, ratios, offsets, speeds = [60.0, 71.3], [0.2, 0.35, 0.3], [0.0, 0.002], [1e3, 5e3]
    s = cp.sweep(
        [V6, UNLIKE],
        rpm=speeds,
        bank_angle_deg=angles,
        hold=hold,
        rod_ratio=ratios,
        pin_offset=offsets,
        orders=how or (1,),
    )
    w = s.waveform(THETA, exact=how is None)
    assert w.force.shape == (2, 2, 3, 2, 2, 1300, 2)
    assert w.torque.shape == (2, 2, 3, 2, 2, 1300)
    for index in np.ndindex(w.force.shape[:5]):
        e, a, k, o, v = index
        engine = single(
            (V6, UNLIKE)[e],
            bank_angle_deg=angles[a],
            hold=hold,
            rod_ratio=ratios[k],
            pin_offset=offsets[o],
        )
        one = engine.waveform(speeds[v], theta_deg=THETA, orders=how)
        for quantity in QUANTITIES:
            found, expected = getattr(w, quantity)[index], getattr(one, quantity)
            assert np.abs(found - expected).max() <= ROUNDING * size(engine, speeds[v], quantity)


def test_against_the_rederivation() -> None:
    """Forces added up at every angle, in plain NumPy that knows of no crankpin."""
    parts = UNLIKE.cylinders
    radii = np.array([c.crank_radius for c in parts])
    ratios, theta = [0.2, 0.29, 0.35], np.radians(THETA)
    as_it_is = cp.sweep(UNLIKE, rpm=[4000.0]).waveform(THETA, exact=True)
    swept = cp.sweep(UNLIKE, rpm=4000, rod_ratio=ratios).waveform(THETA, exact=True)
    rods = [np.array([c.rod_length for c in parts]), *(radii / ratio for ratio in ratios)]
    for k, rod_length in enumerate(rods):
        lists = time_domain.EngineLists(
            crank_radius=radii,
            rod_length=rod_length,
            reciprocating_mass=[c.reciprocating_mass for c in parts],
            tdc_deg=UNLIKE.tdc_deg,
            bank_deg=UNLIKE.bank_deg,
            z=UNLIKE.z,
            pin_offset=[c.pin_offset for c in parts],
            rotating_mass=UNLIKE.rotating_mass,
        )
        expected = {
            "force": time_domain.force(lists, 4000.0, theta),
            "moment": time_domain.moment(lists, 4000.0, theta),
            "torque": time_domain.roll_torque(lists, 4000.0, theta),
        }
        w, row = (swept, k - 1) if k else (as_it_is, 0)
        for quantity in QUANTITIES:
            apart = np.abs(getattr(w, quantity)[row] - expected[quantity]).max()
            assert apart <= ROUNDING * size(UNLIKE, 4000.0, quantity)


@pytest.mark.parametrize("exact", [True, False])
def test_many_points_are_those_of_a_few(exact: bool) -> None:
    """Tables that many points share hold what each would work out for itself."""
    ratios, speeds = np.linspace(0.2, 0.35, 150), [1000.0, 3000.0]
    many = cp.sweep([V6, UNLIKE], rpm=speeds, rod_ratio=ratios, orders=(1, 2, 3, 4, 6))
    for k in (0, 63, 64, 127, 128, 149):
        few = cp.sweep([V6, UNLIKE], rpm=speeds, rod_ratio=[ratios[k]], orders=many.orders)
        for quantity in QUANTITIES:
            found = many.waveform(THETA, exact=exact).computed(quantity)[:, k]
            expected = few.waveform(THETA, exact=exact).computed(quantity)[:, 0]
            apart = np.abs(found - expected).max()
            assert apart <= ROUNDING * size(UNLIKE, 3000.0, quantity)


@settings(deadline=None, max_examples=30)
@given(
    name=st.sampled_from(["v8-crossplane", "i4", "v6-60", "single", "v12-60", "i5"]),
    ratio=st.floats(0.05, 0.9),
    rtol=st.sampled_from([1e-3, 1e-6, 1e-9, 1e-12]),
)
def test_the_bound_holds(name: str, ratio: float, rtol: float) -> None:
    engine, theta = cp.Engine.preset(name), np.arange(0.0, 360.0, 1.7)
    s = cp.sweep(engine, rpm=3000, rod_ratio=[0.5 * ratio, ratio], orders="auto", rtol=rtol)
    summed, exact = s.waveform(theta, exact=False), s.waveform(theta, exact=True)
    for quantity in QUANTITIES:
        found, true = getattr(summed, quantity), getattr(exact, quantity)
        missing = np.abs(found - true)
        if quantity != "torque":
            missing = np.hypot(missing[..., 0], missing[..., 1])
        # near λ = 1 accelerations are some times r·ω²
        rounding = 10.0 * ROUNDING * size(engine, 3000, quantity)
        assert missing.max() <= s.error_bound[quantity] + rounding


def test_what_cancels_is_zero() -> None:
    """The moment of an inline-six and the first-order force of a cross-plane V8 are no trace."""
    w = cp.sweep(cp.Engine.preset("i6"), rpm=20_000, rod_ratio=[0.2, 0.3]).waveform(THETA)
    assert not w.moment.any()


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("single", {"rod_ratio": [0.95], "rtol": 1e-12}),
        ("v8-crossplane", {"rod_ratio": [0.3], "rtol": 1e-6, "torque": False}),
        ("single", {"orders": range(1, 100)}),
    ],
)
def test_waveform_sums_the_orders_of_the_sweep_unless_exact_is_given(
    name: str, options: dict[str, Any]
) -> None:
    s = cp.sweep(cp.Engine.preset(name), rpm=1000, **options)
    summed, exact = s.waveform(THETA), s.waveform(THETA, exact=True)
    assert (summed.orders, summed.omitted) == (s.orders, s.omitted)
    assert summed.error_bound == s.error_bound
    assert (exact.orders, exact.omitted) == (None, ())
    assert (exact.error_bound["force"], exact.error_bound["moment"]) == (0.0, 0.0)


@pytest.mark.parametrize("exact", [True, False])
def test_memory_that_is_given(exact: bool) -> None:
    w = cp.sweep(V6, rpm=[1e3, 2e3], rod_ratio=[0.2, 0.3]).waveform(THETA, exact=exact)
    out = np.full((2, 2, 1300, 2), np.nan)
    assert w.computed("force", out=out) is out
    np.testing.assert_array_equal(out, w.force)
    assert out.flags.writeable
    assert not w.force.flags.writeable
    for bad in (
        np.empty((2, 2, 1300)),
        np.empty((2, 2, 1300, 2), np.float32),
        np.empty((2, 2, 1300, 4))[..., ::2],
        w.force,
        [0.0],
    ):
        with pytest.raises(cp.InputError, match="out"):
            w.computed("force", out=bad)  # type: ignore[arg-type]


def test_what_is_refused() -> None:
    s = cp.sweep(V6, rpm=1000, rod_ratio=np.linspace(0.1, 0.5, 100_000), torque=False)
    with pytest.raises(cp.InputError, match=r"sweep.*split theta_deg"):
        _ = s.waveform(np.arange(7200)).force.xy
    with pytest.raises(cp.InputError, match="torque"):
        _ = s.waveform([0.0]).torque
    with pytest.raises(cp.InputError, match="theta_deg"):
        s.waveform([0.0, np.nan])
    with pytest.raises(cp.InputError, match="quantity"):
        s.waveform([0.0]).computed("heave")
    by_spectrum = cp.sweep(V6, rpm=1000, spectrum={1: 1.0, 2: 0.3}, orders=[1, 2])
    with pytest.raises(cp.InputError, match="spectrum"):
        by_spectrum.waveform(exact=True)
    one = V6.waveform(1000, theta_deg=THETA, orders=[1, 2], spectrum={1: 1.0, 2: 0.3})
    # forces are some kg·m times ω²: 1e4 N
    np.testing.assert_allclose(by_spectrum.waveform(THETA).force, one.force, rtol=0, atol=1e-9)
    with pytest.raises(cp.InputError, match="exact"):
        s.waveform(exact="yes")  # type: ignore[arg-type]
    assert s.waveform([]).dims == ("rod_ratio", "theta_deg")
    assert cp.sweep(V6, rpm=1000).waveform([]).force.shape == (0, 2)


def test_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    w = cp.sweep(V6, rpm=1000, rod_ratio=np.linspace(0.2, 0.3, 500)).waveform(THETA)
    w.computed("force", progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] > 1


def test_labels() -> None:
    s = cp.sweep({"a": V6, "b": UNLIKE}, rpm=[1e3, 2e3, 3e3], rod_ratio=0.3)
    dataset = s.waveform([0.0, 90.0]).to_xarray("moment", "torque")
    assert dataset.moment.dims == ("engine", "rpm", "theta_deg", "axis")
    assert dataset.torque.dims == ("engine", "rpm", "theta_deg")
    assert dataset.moment.attrs["units"] == "N m"
    assert dataset.attrs["rod_ratio"] == 0.3
    one = single(UNLIKE, rod_ratio=0.3)
    expected = one.waveform(2e3, theta_deg=[0.0, 90.0], orders=s.orders).moment
    table = s.waveform([0.0, 90.0]).table
    assert table.title.endswith(
        f"Peaks at 2 crank angles, {labels.orders_text(s.orders)}, rod ratio 0.3"
    )
    assert table.header == ["engine", "rpm", "|F| N", "|M| N·m", "|M_z| N·m"]
    assert (table["engine"].values[4], table["rpm"].values[4]) == ("b", 2e3)
    # a sum of squares may round in two ways
    largest = np.linalg.norm(expected, axis=-1).max()
    assert table["|M|"].values[4] == pytest.approx(largest, rel=10 * ROUNDING)
    apart = np.abs(dataset.moment.sel(engine="b", rpm=2e3).to_numpy() - expected).max()
    assert apart <= ROUNDING * size(UNLIKE, 2e3, "moment")


THREADS = """
import hashlib
import numpy as np
import crankpin as cp
v8, theta = cp.Engine.preset("v8-crossplane"), np.linspace(0, 720, 1111)
s = cp.sweep([v8, cp.Engine.preset("i5")], rpm=[1e3, 6e3], rod_ratio=np.linspace(0.2, 0.35, 150))
digest = hashlib.sha256()
for exact in (True, False):
    for quantity in ("force", "moment", "torque"):
        digest.update(np.asarray(s.waveform(theta, exact=exact).read(quantity)))
w = v8.waveform(6000, theta_deg=np.linspace(0, 720, 100_001), orders="auto")
digest.update(np.asarray(w.force))
digest.update(np.asarray(v8.waveform(6000, theta_deg=np.linspace(0, 720, 100_001)).torque))
print(digest.hexdigest())
"""


def test_bits_do_not_depend_on_threads() -> None:
    digests = {long_calls.printed(threads, "-c", THREADS) for threads in ("1", "2", "3", "7")}
    assert len(digests) == 1
