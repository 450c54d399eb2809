"""Are amplitudes and phases those of the motion itself, whatever programs read them?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from support import in_turn

PRESETS = ("i4", "i5", "v6-60", "v6-90-odd-fire", "boxer-2", "v8-crossplane", "single")
CYLINDER = cp.Cylinder(crank_radius=0.04, rod_length=0.14, reciprocating_mass=0.5)


def over_angle(rows: Any, quantity: str, component: str, theta_deg: Any) -> Any:  # noqa: ANN401
    """Return Σ amplitude·cos(nθ + phase) of the rows of a component, as an FE deck reads them."""
    chosen = rows[(rows["quantity"] == quantity) & (rows["component"] == component)]
    total = np.zeros_like(theta_deg)
    for _, row in chosen.fillna(0.0).iterrows():
        turned = float(row["order"]) * theta_deg + row["phase_deg"]
        total += row["amplitude"] * np.cos(np.radians(turned))
    return total


@in_turn("name", PRESETS)
def test_cosines_of_the_frame_are_the_waveform(name: str) -> None:
    theta = np.arange(0.0, 720.0, 13.0)
    engine = cp.Engine.preset(name)
    rows = engine.balance(4000, rtol=1e-12).to_pandas(frame="phases")
    wave = engine.waveform(4000, theta)
    for quantity in ("force", "moment"):
        for k, component in enumerate("xy"):
            values = np.asarray(getattr(wave, quantity))[:, k]
            expected = over_angle(rows, quantity, component, theta)
            # omitted orders below 1e-12 of one piston's force, and rounding of a dozen terms
            np.testing.assert_allclose(expected, values, atol=1e-8)
    for quantity in ("torque", "crank_torque"):
        expected = over_angle(rows, quantity, "z", theta)
        np.testing.assert_allclose(expected, np.asarray(getattr(wave, quantity)), atol=1e-8)


def test_a_cylinder_derived_by_hand() -> None:
    """Bore along 60°, pin 100° ahead of it: m·r·ω²·(cos(θ − t) + λ cos 2(θ − t) + …), t = 260°."""
    single = cp.Engine.from_lists(CYLINDER, tdc_deg=[260], bank_deg=[60], z=[0.2])
    first = single.balance(3000, orders=[1]).frames["phases"]
    force = 0.5 * 0.04 * (3000 * np.pi / 30) ** 2
    assert first["component"].values[:2] == ("x", "y")
    np.testing.assert_allclose(
        first["amplitude"].values[:2], [force * 0.5, force * np.sqrt(0.75)], rtol=1e-14
    )
    np.testing.assert_allclose(first["phase_deg"].values[:2], [100.0, 100.0], rtol=1e-13)
    assert "cylinder 1 is at top dead centre at θ = 260°" in first.note


def test_rows_are_by_point_then_order_then_component() -> None:
    engines = {name: cp.Engine.preset(name) for name in ("i4", "v6-60")}
    swept = cp.sweep(engines, rpm=[1000, 2000], orders=[2, 1, 4])
    rows = swept.frames["phases"]
    assert list(rows) == [
        "engine", "rpm", "order", "quantity", "component", "amplitude", "phase_deg", "unit",
    ]  # fmt: skip
    points = list(zip(*(rows[name].values for name in ("engine", "rpm", "order")), strict=True))
    expected = [(e, r, n) for e in engines for r in (1000.0, 2000.0) for n in swept.orders]
    assert points[::6] == expected
    # A point of the sweep has the same frame.
    alone = swept.sel(engine="v6-60", rpm=2000).frames["phases"]
    tail = len(alone)
    for name in ("order", "quantity", "component", "amplitude", "phase_deg", "unit"):
        assert rows[name].values[-tail:] == alone[name].values


def powertrain() -> cp.Powertrain:
    """Return an inline four on three mounts."""
    body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
    places = [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
    mounts = [cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1) for name, at in places]
    return cp.Powertrain(cp.Engine.preset("i4"), body, mounts)


def test_forces_of_mounts_have_their_mount_and_loads_their_units() -> None:
    response = powertrain().response(3000, orders=[2, 4])
    rows = response.to_pandas(frame="phases").fillna(0.0)
    phasors = rows["amplitude"] * np.exp(1j * np.radians(rows["phase_deg"]))
    of_mount = rows["quantity"] == "mount_force"
    assert [*rows["mount"][of_mount]] == [*np.repeat(["a", "b", "c"], 3)] * 2
    np.testing.assert_allclose(
        phasors[of_mount], np.asarray(response.mount_force).ravel(), rtol=1e-13
    )
    loads = rows[rows["quantity"] == "wrench"]
    assert [*loads["unit"]] == ["N", "N", "N", "N·m", "N·m", "N·m"] * 2
    assert {*rows["unit"][rows["quantity"] == "motion"]} == {"m", "rad"}
    assert not (rows["quantity"] == "power_in").any()
    moved = response.at((0, 0.3, 0))
    seat = moved.to_pandas(frame="phases")
    np.testing.assert_allclose(
        seat["amplitude"][seat["quantity"] == "velocity"],
        np.abs(np.asarray(moved.velocity)).ravel(),
        rtol=1e-15,
    )


def test_phases_are_in_the_units_shown_and_angles_stay_degrees() -> None:
    balance = cp.Engine.preset("i4").balance(3000, orders=[2])
    plain, pounds = (balance.to_pandas(frame="phases", units=unit) for unit in ("", "lbf"))
    assert [*pounds["phase_deg"].dropna()] == [*plain["phase_deg"].dropna()]
    assert pounds["amplitude"][1] == pytest.approx(plain["amplitude"][1] / 4.4482216152605)
    assert pounds["unit"][1] == "lbf"


def test_the_shell_prints_the_frame(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["balance", "v6-60", "--orders", "1,2", "--frame", "phases", "--csv"]) == 0
    expected = cp.Engine.preset("v6-60").balance(3000, orders=[1, 2]).to_csv(frame="phases")
    assert capsys.readouterr().out == expected
    assert main(["sweep", "i4", "--rpm", "1000,2000", "--frame", "phases", "--csv"]) == 0
    swept = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000])
    assert capsys.readouterr().out == swept.to_csv(frame="phases")
