"""Is motion on mounts by balance factor right, and the best factor the least of all?"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

SPEEDS = np.arange(2000.0, 8001.0, 250.0)
PLACES = [("front", (0.0, 0.1, -0.25)), ("rear", (0.0, -0.15, 0.3)), ("head", (0.05, 0.3, 0.0))]


def single(mass: float = 0.4, radius: float = 0.04, **changes: Any) -> cp.Engine:  # noqa: ANN401
    """Return an upright single at z = 0."""
    cylinder = cp.Cylinder(crank_radius=radius, rod_length=3.5 * radius, reciprocating_mass=mass)
    return cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.1, **changes)


def frame(
    engine: cp.Engine,
    stiffness: float | tuple[float, ...] = (4e6, 4e5, 1e6),
    loss_factor: float = 0.1,
) -> cp.Powertrain:
    """Return an engine in a frame that is stiff fore and aft and soft up and down."""
    body = cp.RigidBody(mass=45, cg=(0.01, 0.05, 0.02), inertia=(1.1, 1.3, 0.9))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of limits: stiffnesses of no mount
        mounts = [
            cp.Mount(name, at=at, stiffness=stiffness, loss_factor=loss_factor)
            for name, at in PLACES
        ]
    return cp.Powertrain(engine, body, mounts)


# --- a second route: six equations of motion in NumPy ---------------------------------------------


def crossed(a: Any) -> NDArray[np.float64]:  # noqa: ANN401 - a place
    """Return the matrix of a × ·."""
    x, y, z = a
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=float)


def velocity(factor: float, point: Any, rpm: float) -> NDArray[np.complex128]:  # noqa: ANN401
    """Return order-1 velocity of a point of the frame with the single, by six equations."""
    cg, omega = np.array([0.01, 0.05, 0.02]), rpm * math.pi / 30.0
    k = np.zeros((6, 6), dtype=complex)
    for _, at in PLACES:
        moved = np.hstack([np.eye(3), -crossed(np.array(at) - cg)])
        k += moved.T @ np.diag([4e6, 4e5, 1e6]) @ moved * (1 + 0.1j)
    m = np.diag([45, 45, 45, 1.1, 1.3, 0.9])
    pull = 0.4 * 0.04 * omega**2
    # Along the bore cos θ less the weight opposite the pin, whose direction is 90° + θ; across it
    # the weight alone.
    force = np.array([-1j * factor * pull, (1 - factor) * pull, 0.0])  # −κ·cos(90° + θ) = κ sin θ
    load = np.concatenate([force, np.cross(-cg, force)])
    # Roll torque of order 1 of the piston, about the crank, by its own integral.
    theta = np.arange(720) * 2 * math.pi / 720
    slope = 0.04 * (np.sin(theta) + 0.04 * np.sin(theta) * np.cos(theta)
                    / np.sqrt(0.14**2 - (0.04 * np.sin(theta)) ** 2))  # fmt: skip
    bend = np.fft.ifft(1j * np.fft.fftfreq(720, 1 / 720) * np.fft.fft(slope)).real
    torque = -0.4 * omega**2 * slope * bend  # on the crank; the block's is its opposite
    load[5] += -np.conj(2 * np.mean(torque * np.exp(1j * theta)))
    q = np.linalg.solve(k - omega**2 * m, load)
    moved = np.hstack([np.eye(3), -crossed(np.array(point) - cg)])
    return np.asarray(1j * omega * moved @ q)


def test_velocity_by_factor_is_that_of_six_equations() -> None:
    point = (0.3, 0.6, -0.4)
    factors = [0.0, 0.35, 0.5, 1.0]
    swept = frame(single()).sweep(SPEEDS, factor=factors, receivers={"bar end": point}, orders=1)
    expected = [
        [np.linalg.norm(velocity(factor, point, rpm)) / math.sqrt(2.0) for rpm in SPEEDS]
        for factor in factors
    ]
    np.testing.assert_allclose(np.asarray(swept.velocity)[..., 0], expected, rtol=1e-10)
    # and the best factor that of a grid of these equations
    grid = np.linspace(0.0, 1.0, 2001)
    ends = np.array([[velocity(end, point, rpm) for rpm in SPEEDS] for end in (0.0, 1.0)])
    of_grid = ends[0] + grid[:, None, None] * (ends[1] - ends[0])
    sizes = np.sqrt(0.5 * (np.abs(of_grid) ** 2).sum(axis=-1))
    best = swept.best()
    assert best is not None
    assert abs(best - grid[sizes.max(axis=1).argmin()]) <= 0.5 / 2000 + 1e-9
    rms = swept.best(norm="rms")
    assert rms is not None
    assert abs(rms - grid[(sizes**2).mean(axis=1).argmin()]) <= 0.5 / 2000 + 1e-9


ENGINES = {
    "single": single(),
    "360 twin": cp.Engine.preset("i2-360"),
    "270 twin": cp.Engine.preset("i2-270"),
    "v-twin": cp.Engine.preset("v-twin-45"),
}


@in_turn("name", ENGINES)
def test_best_factor_is_least_of_all(name: str) -> None:
    """No factor on a fine grid, evaluated by itself, leaves less than the best one."""
    powertrain = frame(ENGINES[name])
    receivers = {"bar end": (0.3, 0.6, -0.4), "peg": ((0.25, -0.1, 0.2), (0, 1, 0))}
    factors = np.linspace(0.0, 1.2, 49)
    swept = powertrain.sweep(SPEEDS, factor=factors, receivers=receivers)
    values = np.asarray(swept.velocity)
    for names, places in [("bar end", [0]), ("peg", [1]), (None, [0, 1])]:
        for norm in ("largest", "rms"):
            best = swept.best(names, norm)
            assert best is not None
            alone = np.asarray(powertrain.sweep(SPEEDS, factor=best, receivers=receivers).velocity)[
                ..., places
            ]
            rows = values[..., places]
            if norm == "largest":
                least, grid = alone.max(), rows.max(axis=(1, 2))
            else:
                least, grid = (alone**2).sum(), (rows**2).sum(axis=(1, 2))
            assert least <= grid.min() * (1 + 1e-9)
            # and it is between the neighbours of the least on the grid: the norm is convex
            at = int(grid.argmin())
            low, high = factors[max(at - 1, 0)], factors[min(at + 1, len(factors) - 1)]
            assert low <= best <= high


def test_a_free_frame_has_the_textbook_answer() -> None:
    """On mounts so soft that they do not count: half for all directions, 1 along, 0 across."""
    free = frame(single(), stiffness=1.0)
    cg, speeds = (0.01, 0.05, 0.02), [3000.0, 6000.0]
    for direction, best in [(None, 0.5), ((0, 1, 0), 1.0), ((1, 0, 0), 0.0)]:
        place = cg if direction is None else (cg, direction)
        swept = free.sweep(speeds, factor=[0, 1], receivers={"cg": place}, orders=1)
        assert swept.best() == pytest.approx(best, abs=1e-6)
        assert swept.best(norm="rms") == pytest.approx(best, abs=1e-6)


def stiff_force(engine: cp.Engine, rpm: float, factor: float) -> float:
    """Return √(a² + b²) of the half axes of order 1, of the force on mounts that do not give."""
    held = frame(engine, stiffness=1e14, loss_factor=0.0)
    swept = held.sweep(rpm, factor=factor, orders=1)
    return math.sqrt(2.0) * float(np.asarray(swept.force)[0, 0, 0])


def test_forces_of_textbooks_reach_mounts_that_do_not_give() -> None:
    """Residual primary forces of public problems, from their own formulae."""
    # 50 kg, r 150 mm, two thirds balanced, 240 rpm: 2847 N at 60° from dead centre.
    pull, c = 50 * 0.15 * (240 * math.pi / 30) ** 2, 2 / 3
    at_60 = pull * math.hypot((1 - c) * 0.5, c * math.sqrt(0.75))
    assert at_60 == pytest.approx(2847, abs=3)
    expected = pull * math.hypot(1 - c, c)
    assert stiff_force(single(50, 0.15), 240, c) == pytest.approx(expected, rel=1e-9)
    # Sarkar 12.1: 120 kg, r 90 mm, 2/3, 250 rpm: 3264.065 N at 30°.
    pull = 120 * 0.09 * (250 * math.pi / 30) ** 2
    at_30 = pull * math.hypot((1 - c) * math.sqrt(0.75), c * 0.5)
    assert at_30 == pytest.approx(3264.065, abs=0.001)
    expected = pull * math.hypot(1 - c, c)
    assert stiff_force(single(120, 0.09), 250, c) == pytest.approx(expected, rel=1e-9)
    # V-twins on one pin at 50 %: a circle of cos α: 90°, 60°, 45° (Den Hartog; balancing tables).
    for degrees, circle in [(90, 0.0), (60, 0.5), (45, 0.707107)]:
        twin = cp.Engine.vee(cp.Cylinder(0.04, 0.14, 0.4), bank_angle_deg=degrees,
                             throws_deg=[0], spacing=0.1)  # fmt: skip
        pull = 0.4 * 0.04 * (3000 * math.pi / 30) ** 2
        found = stiff_force(twin, 3000, 0.5)
        assert found == pytest.approx(pull * circle * math.sqrt(2), abs=1e-6 * pull)


def test_table_has_the_ellipse_and_the_best_factor() -> None:
    swept = frame(single()).sweep(SPEEDS, factor=[0.0, 0.6, 1.0])
    table = swept.table
    # m·r = 0.016: κ across, 1 − κ along.
    np.testing.assert_allclose(table["force, longest"].values, [0.016, 0.0096, 0.016], rtol=1e-12)
    np.testing.assert_allclose(table["shortest"].values, [0.0, 0.0064, 0.0], atol=1e-17)
    rows = np.asarray(swept.force)[..., 0]
    np.testing.assert_allclose(table["body rms"].values, rows.max(axis=1))
    best = swept.frames["best"]
    assert best["factor"].values == (swept.best(),)
    fitted = swept.fitted.response(SPEEDS).body_force.total.rms
    assert float(np.max(fitted)) == pytest.approx(best["least largest"].values[0], rel=1e-9)
    assert f"{swept.best():.6g}" in table.text()


def test_engines_are_compared_as_their_responses() -> None:
    twins = {name: ENGINES[name] for name in ("360 twin", "270 twin")}
    powertrain = frame(single())
    swept = powertrain.sweep(SPEEDS, engines=twins, receivers="mount_force")
    assert swept.coords["engine"] == tuple(twins)
    for k, engine in enumerate(twins.values()):
        response = powertrain.replace(engine=engine).response(SPEEDS)
        for j, (name, _) in enumerate(PLACES):
            expected = response.mount_force[name].total.rms
            np.testing.assert_allclose(np.asarray(swept.force)[k, :, j], expected, rtol=1e-12)
    assert "factor" not in swept.table
    assert list(swept.frames) == ["table"]
    with pytest.raises(cp.InputError, match="engines are compared"):
        swept.best()


def test_no_difference_and_wrong_arguments() -> None:
    four = frame(cp.Engine.preset("i4"))
    assert four.sweep([3000.0], factor=[0, 1]).best() is None
    with pytest.raises(cp.InputError, match="give one of factor=…, engines=…"):
        four.sweep([3000.0])
    with pytest.raises(cp.InputError, match=r"70 % is 0\.7"):
        four.sweep([3000.0], factor=70)
    with pytest.raises(cp.InputError, match="velocity"):
        _ = four.sweep([3000.0], factor=0.5).velocity


def test_the_shell(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bike.toml"
    powertrain = frame(single())
    powertrain.save(file)
    line = ["mounts", str(file), "--rpm", "2000:8000:250", "--factor", "0:1:0.25"]
    assert main([*line, "--at", "0.3,0.6,-0.4", "--csv"]) == 0
    point = powertrain.response(2000.0).at((0.3, 0.6, -0.4))
    swept = powertrain.sweep(SPEEDS, factor=np.arange(5) / 4, receivers={point._words: point})
    assert capsys.readouterr().out == swept.to_csv()
    assert main([*line, "--frame", "best"]) == 0
    best = powertrain.sweep(SPEEDS, factor=[0, 1]).best()
    assert f"{best:.5g}" in capsys.readouterr().out
    assert main(["mounts", str(file), "--factor", "0.5"]) == 2
    assert "needs --rpm" in capsys.readouterr().err
