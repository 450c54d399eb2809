"""Force and moment of a thousand cross-plane V8s over crank angle: how exact, and how fast?

``python benchmarks/waveforms.py`` times 720 crank angles × 1000 rod ratios: exact kinematics in
NumPy and numba (all cores), sums of orders in NumPy, crankpin by orders and by kinematics, into new
and into given memory, and writing numbers alone; a multibody code (Exudyn, if installed) steps
one slider-crank. A second panel goes down to one engine, where the cost of a call is all there is.
It writes ``waveforms.csv`` and ``waveforms.png`` to ``--out``, by default ``benchmarks/out``;
``--quick`` takes 30 engines and few settings.

Errors are against 50 digits at 10 engines × 36 angles, the larger of force over m·r·ω² and moment
over m·r·ω² times the longest lever. Times are the least of 20 runs or more after a warm-up, of
Exudyn of 3.

Exudyn's V8 is eight times the same slider-crank, each turned and delayed: one is stepped, and force
and moment of the engine are added up from it. Its time is that of one slider-crank times a thousand
engines, an eighth of what the whole engine would take; its error is against crankpin's kinematics
at all steps of the second turn.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
from _timing import interleaved, least, machine, print_table, write_csv
from _waveform_methods import (
    Scene,
    numba_hoisted,
    numba_plain,
    numpy_exact,
    numpy_orders,
    reference,
)

if TYPE_CHECKING:
    from _waveform_methods import Array

TOLERANCES = [10.0**-k for k in range(1, 15)]
COUNTS = range(1, 13)
STEPS = [252, 500, 1000, 2000, 4000]
ENGINES = [1, 3, 10, 30, 100, 300, 1000]
V8 = cp.Engine.preset("v8-crossplane")

Result = tuple[Any, Any]
Row = tuple[str, str, float, float, int]
"""Method, its knob, error, seconds, engines."""


def scene(engines: int = 1000, angles: int = 720) -> Scene:
    """Return so many rod ratios and crank angles."""
    ratios = np.linspace(0.2, 0.35, engines) if engines > 1 else np.array([0.285])
    return Scene(V8, ratios, np.arange(angles) * (720.0 / angles), 6000.0)


def swept(of: Scene, rtol: float) -> cp.results.Sweep:
    """Return crankpin's sweep, with orders chosen for the tolerance."""
    return cp.sweep(
        of.engine, rpm=of.rpm, rod_ratio=of.ratios, orders="auto", rtol=rtol, torque=False
    )


def ours(of: Scene, rtol: float) -> Result:
    """Choose orders and sum them, into new memory."""
    w = swept(of, rtol).waveform(of.theta_deg, exact=False)
    return w.read("force"), w.read("moment")


def ours_into(of: Scene, rtol: float, out: list[Array]) -> Result:
    """Choose orders and sum them, into given memory."""
    w = swept(of, rtol).waveform(of.theta_deg, exact=False)
    return w.computed("force", out=out[0]), w.computed("moment", out=out[1])


def ours_exact(of: Scene) -> Result:
    """Kinematics, into new memory."""
    s = cp.sweep(of.engine, rpm=of.rpm, rod_ratio=of.ratios, torque=False, orders=[1, 2, 4, 6])
    w = s.waveform(of.theta_deg, exact=True)
    return w.read("force"), w.read("moment")


def accuracy(of: Scene) -> Callable[[Result], float]:
    """Return what takes the error of a result."""
    engines = np.linspace(0, len(of.ratios) - 1, 10).astype(int).tolist()
    angles = np.linspace(0, len(of.theta_deg) - 1, 36).astype(int).tolist()
    true = reference(of, engines, angles)
    scales = of.force, of.force * np.abs(of.levers).max()

    def error(result: Result) -> float:
        found = [np.asarray(values)[np.ix_(engines, angles)] for values in result]
        pairs = zip(found, true, scales, strict=True)
        return float(max(np.abs(a - b).max() / scale for a, b, scale in pairs))

    return error


def chart(engines: int, settings: int | None) -> list[Row]:
    """Time and error of every method at so many engines, at few settings or all."""
    of = scene(engines)
    out = [np.empty((engines, 720, 2)) for _ in range(2)]
    error = accuracy(of)
    methods: dict[tuple[str, str], Callable[[], Result]] = {
        ("NumPy, exact", ""): lambda: numpy_exact(of),
        ("numba, exact", ""): lambda: numba_plain(of),
        ("numba, exact, hoisted", ""): lambda: numba_hoisted(of),
        ("crankpin, exact", ""): lambda: ours_exact(of),
    }
    for count in COUNTS[:settings]:
        methods["NumPy, orders", str(count)] = lambda count=count: numpy_orders(of, count)  # type: ignore[misc]
    for rtol in [*TOLERANCES[:settings], 1e-12] if settings else TOLERANCES:
        knob = f"{rtol:.0e}"
        methods["crankpin, orders", knob] = lambda rtol=rtol: ours(of, rtol)  # type: ignore[misc]
        methods["crankpin, orders, given memory", knob] = lambda rtol=rtol: ours_into(of, rtol, out)  # type: ignore[misc]
    writing: dict[tuple[str, str], Callable[[], Result]] = {
        ("writing, new memory", ""): lambda: (
            np.full(out[0].shape, 1.0),
            np.full(out[1].shape, 1.0),
        ),
        ("writing, given memory", ""): lambda: (out[0].fill(1.0), out[1].fill(1.0)),
    }
    errors = {name: error(run()) for name, run in methods.items()}
    best = timed(methods | writing)
    return [
        (*name, errors.get(name, float("nan")), seconds, engines) for name, seconds in best.items()
    ]


def timed(methods: dict[tuple[str, str], Callable[[], Result]]) -> dict[tuple[str, str], float]:
    """Return least times of 20 runs or more, in turns."""
    named = {"\t".join(name): run for name, run in methods.items()}
    best = interleaved(named, seconds=0.5)
    return {(name.split("\t")[0], name.split("\t")[1]): seconds for name, seconds in best.items()}


def by_engines(most: int) -> list[Row]:
    """Time of a whole call over the number of engines, at 1e-12; set-up of ours is in it."""
    rows: list[Row] = []
    for engines in [count for count in ENGINES if count <= most]:
        of = scene(engines)
        methods: dict[tuple[str, str], Callable[[], Result]] = {
            ("NumPy, exact", "by engines"): lambda of=of: numpy_exact(of),  # type: ignore[misc]
            ("NumPy, orders", "by engines"): lambda of=of: numpy_orders(of, 9),  # type: ignore[misc]
            ("numba, exact, hoisted", "by engines"): lambda of=of: numba_hoisted(of),  # type: ignore[misc]
            ("crankpin, orders", "by engines"): lambda of=of: ours(of, 1e-12),  # type: ignore[misc]
            ("crankpin, exact", "by engines"): lambda of=of: ours_exact(of),  # type: ignore[misc]
        }
        rows += [
            (*name, float("nan"), seconds, engines) for name, seconds in timed(methods).items()
        ]
    return rows


def set_up() -> list[Row]:
    """Time what a call costs beside the sums: choosing orders, one engine at one angle."""
    one, many = scene(1, 1), scene()
    sweep = swept(many, 1e-12)
    small = swept(one, 1e-12).waveform(one.theta_deg)
    runs: dict[str, Callable[[], object]] = {
        "sweep of 1000 engines, orders chosen": lambda: swept(many, 1e-12),
        "Sweep.waveform, nothing computed yet": lambda: sweep.waveform(many.theta_deg),
        "force of one engine at one angle": lambda: small.computed("force"),
        "Engine.waveform at one angle": lambda: V8.waveform(
            6000.0, theta_deg=one.theta_deg, torque=False
        ),
        "numba, one engine at one angle": lambda: numba_hoisted(one),
        "NumPy, one engine at one angle": lambda: numpy_exact(one),
    }
    return [("set-up", name, float("nan"), least(run, 0.1), 1) for name, run in runs.items()]


def multibody(engines: int, settings: int | None) -> list[Row]:
    """Step a slider-crank of the V8 through time, and add up the engine."""
    try:
        from _slider_crank_exudyn import Parts, support_force  # noqa: PLC0415 - if it is installed
    except ImportError:
        print('Exudyn is left out: pip install "crankpin[bench]"')
        return []
    cylinder = V8.cylinders[0]
    radius, rod_mass = cylinder.crank_radius, 0.3 * cylinder.reciprocating_mass
    rod = radius / 0.285
    parts = Parts(radius, rod, cylinder.reciprocating_mass - 0.3 * rod_mass, rod_mass, 0.3 * rod)
    alike = cylinder.replace(rod_length=rod, reciprocating_mass=parts.reciprocating_mass)
    engine = V8.replace(cylinder=alike, rotating_mass=[parts.rotating_mass] * 8)
    levers = scene().levers
    omega = 2 * np.pi * 6000.0 / 60
    scale = alike.reciprocating_mass * radius * omega**2
    rows: list[Row] = []
    for name, implicit in (("Exudyn, generalised alpha", True), ("Exudyn, trapezoidal", False)):
        for steps in STEPS[:settings]:
            times = []
            for _ in range(4):
                start = time.perf_counter()
                along = support_force(parts, omega, steps, implicit=implicit)
                times.append(time.perf_counter() - start)
            exact = engine.waveform(
                6000.0, theta_deg=360.0 / steps * np.arange(steps), torque=False
            )
            turned = [
                np.roll(along, round(tdc * steps / 360)) * np.exp(1j * np.radians(bank))
                for tdc, bank in zip(engine.tdc_deg, engine.bank_deg, strict=True)
            ]
            force = sum(turned)
            moment = sum(1j * lever * each for lever, each in zip(levers, turned, strict=True))
            error = max(
                np.abs(force - exact.force @ [1, 1j]).max() / scale,
                np.abs(moment - exact.moment @ [1, 1j]).max() / scale / np.abs(levers).max(),
            )
            rows.append((name, str(steps), float(error), engines * min(times[1:]), engines))
    return rows


def draw(rows: list[Row], engines: int, file: Path) -> None:
    """Draw time over error, and time over the number of engines."""
    mpl.use("agg")
    import matplotlib.pyplot as plt  # noqa: PLC0415 - after the choice of what draws

    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 6), layout="constrained")
    names = list(dict.fromkeys(name for name, *_ in rows if name != "set-up"))
    for k, name in enumerate(names):
        style: dict[str, Any] = {"color": f"C{k % 10}", "marker": "osD^vP"[k % 6], "markersize": 5}
        points = [row for row in rows if row[0] == name and row[1] != "by engines"]
        if name.startswith("writing"):
            left.axhline(points[0][3], color="k", ls=":" if "given" in name else "--", label=name)
            continue
        bad = [row for row in points if not np.isfinite(row[2]) or row[2] > 1.0]
        good = [row for row in points if row not in bad]
        left.plot([row[2] for row in good], [row[3] for row in good], label=name, **style)
        # Runs that diverged stand at the edge.
        left.plot([1.0] * len(bad), [row[3] for row in bad], "x", color=style["color"])
        curve = [row for row in rows if row[0] == name and row[1] == "by engines"]
        if curve:
            right.plot([row[4] for row in curve], [row[3] for row in curve], label=name, **style)
    left.set(
        xscale="log",
        yscale="log",
        xlabel="worst error, over m·r·ω² of a cylinder (times the longest lever)",
        ylabel=f"seconds for {engines} engines",
        title=f"720 angles × {engines} cross-plane V8s, force and moment",
    )
    left.invert_xaxis()
    right.set(
        xscale="log",
        yscale="log",
        xlabel="engines",
        ylabel="seconds",
        title="720 angles; crankpin's orders chosen for 1e-12 in each call",
    )
    for ax in (left, right):
        ax.grid(alpha=0.3)
        ax.legend(fontsize="small")
    figure.savefig(file, dpi=120)


def print_ratios(rows: list[Row], engines: int) -> None:
    """Print how many times as long as ours at 1e-12 the others take."""
    seconds = {(row[0], row[1]): row[3] for row in rows if row[1] != "by engines"}
    errors = {(row[0], row[1]): row[2] for row in rows}
    new = seconds["crankpin, orders", "1e-12"]
    given = seconds["crankpin, orders, given memory", "1e-12"]
    listed = [
        [
            " ".join(key),
            f"{1e3 * s:.4g} ms",
            f"{s / new:.3g} ×",
            f"{s / given:.3g} ×",
            f"{errors[key]:.1e}",
        ]
        for key, s in seconds.items()
        if key[0] != "set-up"
    ]
    header = ["method", "time", "of ours, new memory", "of ours, given memory", "error"]
    print_table(f"720 angles × {engines} V8s, force and moment", header, listed)
    listed = [[row[1], f"{1e6 * row[3]:.4g} µs"] for row in rows if row[0] == "set-up"]
    print_table("Set-up", ["what", "time"], listed)
    listed = [
        [row[0], str(row[4]), f"{1e6 * row[3]:.4g} µs"] for row in rows if row[1] == "by engines"
    ]
    print_table("By number of engines, 720 angles", ["method", "engines", "time"], listed)


def main() -> None:
    """Time, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="30 engines, few settings")
    given = parser.parse_args()
    out: Path = given.out
    out.mkdir(parents=True, exist_ok=True)
    engines, settings = (30, 2) if given.quick else (1000, None)
    rows = chart(engines, settings) + by_engines(engines) + set_up()
    rows += multibody(engines, settings)
    exudyn = ("exudyn",) if any(row[0].startswith("Exudyn") for row in rows) else ()
    ran_on = machine("numba", *exudyn)
    write_csv(
        out / "waveforms.csv", ran_on, ("method", "knob", "error", "seconds", "engines"), rows
    )
    draw(rows, engines, out / "waveforms.png")
    print(ran_on)
    print_ratios(rows, engines)


if __name__ == "__main__":
    main()
