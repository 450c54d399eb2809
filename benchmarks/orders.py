"""How many orders does a tolerance need, and what does leaving out the rest save?

``python benchmarks/orders.py`` counts the orders of force and moment that ``orders="auto"`` takes,
over tolerance and rod ratio, beside those that would be needed if the layout cancelled nothing; and
times waveforms by orders, by all the orders that the rod asks for, and by kinematics. It writes
``orders.csv``, ``orders_machine.txt`` and ``orders.png`` to ``--out``, by default
``benchmarks/out``.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
import matplotlib as mpl
import numpy as np
from _timing import interleaved, machine, print_table

if TYPE_CHECKING:
    from numpy.typing import NDArray

NAMES = {"single": "single", "i4": "inline-4", "v8-crossplane": "cross-plane V8", "v12-60": "V12"}
TOLERANCES = [10.0**-k for k in range(2, 15)]
RATIOS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99]
TIMED_RATIOS = [0.1, 0.3, 0.6, 0.9, 0.99]
TIMED_TOLERANCES = [1e-3, 1e-6, 1e-9, 1e-12]
RPM = 6000.0
THETA = np.arange(0.0, 720.0, 0.25)

Row = dict[str, str | float | int]


def with_rod(engine: cp.Engine, rod_ratio: float) -> cp.Engine:
    """Return the engine with other rods."""
    cylinders = [c.replace(rod_length=c.crank_radius / rod_ratio) for c in engine.cylinders]
    return engine.replace(cylinder=cylinders)


def without_layout(engine: cp.Engine, rtol: float) -> tuple[float, ...]:
    """Return the orders that as many cylinders need if nothing cancels: all of one beside it."""
    one = engine.cylinders[0]
    alike = cp.Engine.from_lists(one, tdc_deg=[0.0], bank_deg=[90.0], z=[0.0])
    # What each of them leaves out adds up.
    return alike.balance(
        RPM, orders="auto", rtol=max(rtol / len(engine), 1e-15), torque=False
    ).orders


def counts() -> list[Row]:
    """Count orders over tolerance and rod ratio."""
    rows: list[Row] = []
    for name in NAMES:
        for rod_ratio in RATIOS:
            engine = with_rod(cp.Engine.preset(name), rod_ratio)
            for rtol in TOLERANCES:
                b = engine.balance(RPM, orders="auto", rtol=rtol, torque=False)
                rows.append(
                    {
                        "kind": "count",
                        "engine": name,
                        "rod_ratio": rod_ratio,
                        "rtol": rtol,
                        "orders": len(b.orders),
                        "highest": max(b.orders, default=0),
                        "without_layout": len(without_layout(engine, rtol)),
                    }
                )
    return rows


def times(quick: bool = False) -> list[Row]:
    """Time waveforms of force and moment: by order sums and by kinematics."""
    return [
        time_waveforms(name, rod_ratio, rtol)
        for name in NAMES
        for rod_ratio in (TIMED_RATIOS[1:4] if quick else TIMED_RATIOS)
        for rtol in ([1e-9] if quick else TIMED_TOLERANCES)
    ]


def time_waveforms(name: str, rod_ratio: float, rtol: float) -> Row:
    """Time one engine's waveforms by each method, and take the errors."""
    engine = with_rod(cp.Engine.preset(name), rod_ratio)
    fewest = engine.balance(RPM, orders="auto", rtol=rtol, torque=False).orders or (1,)
    all_of_them = without_layout(engine, rtol)

    def run(orders: object, rtol: float | None = None) -> cp.results.Waveform:
        return engine.waveform(RPM, theta_deg=THETA, orders=orders, rtol=rtol, torque=False)  # type: ignore[arg-type]

    best = interleaved(
        {
            "auto": lambda: run("auto", rtol),
            "fewest": lambda: run(fewest),
            "all": lambda: run(all_of_them),
            "kinematics": lambda: run(None),
        },
        seconds=0.1,
    )
    auto, exact = run("auto", rtol), run(None)
    return {
        "kind": "time",
        "engine": name,
        "rod_ratio": rod_ratio,
        "rtol": rtol,
        "orders": len(fewest),
        "without_layout": len(all_of_them),
        "error": float(np.hypot(*(auto.force - exact.force).T).max()),
        "bound": auto.error_bound["force"],
        **{f"{method}_seconds": seconds for method, seconds in best.items()},
    }


def grid(rows: list[Row], name: str) -> NDArray[np.float64]:
    """Return the number of orders by rod ratio and tolerance."""
    found = {
        (row["rod_ratio"], row["rtol"]): float(row["orders"])
        for row in rows
        if row["kind"] == "count" and row["engine"] == name
    }
    return np.array([[found[ratio, rtol] for rtol in TOLERANCES] for ratio in RATIOS])


def draw(rows: list[Row], file: Path) -> None:
    """Draw orders over tolerance, over rod ratio, and the times."""
    mpl.use("agg")
    import matplotlib.pyplot as plt  # noqa: PLC0415 - after the choice of what draws

    figure, axes = plt.subplots(1, 3, figsize=(15, 4.8), layout="constrained")
    for color, (name, label) in enumerate(NAMES.items()):
        table = grid(rows, name)
        style = {"color": f"C{color}", "marker": ".", "label": label}
        axes[0].semilogx(TOLERANCES, table[RATIOS.index(0.3)], **style)
        axes[1].semilogy(RATIOS, table[:, TOLERANCES.index(1e-9)], **style)
        timed = [row for row in rows if row["kind"] == "time" and row["engine"] == name]
        timed = [row for row in timed if row["rtol"] == 1e-9]
        ratios = [row["rod_ratio"] for row in timed]
        for method, line in (("kinematics", ":"), ("all", "--")):
            saved = [float(row[f"{method}_seconds"]) / float(row["auto_seconds"]) for row in timed]
            axes[2].semilogy(ratios, saved, line, color=f"C{color}", marker=".")
    plain = [row["without_layout"] for row in rows if row["engine"] == "v12-60"]
    first = RATIOS.index(0.3) * len(TOLERANCES)
    uncancelled = plain[first : first + len(TOLERANCES)]
    axes[0].plot(TOLERANCES, uncancelled, "k--", lw=1, label="V12, if nothing cancelled")
    axes[0].invert_xaxis()
    axes[0].set(xlabel="tolerance", ylabel="orders of force and moment", title="rod ratio 0.3")
    axes[1].set(xlabel="rod ratio", ylabel="orders of force and moment", title="tolerance 1e-9")
    axes[1].set_yticks([2, 5, 10, 20, 50, 100], [2, 5, 10, 20, 50, 100])
    axes[2].set(
        xlabel="rod ratio",
        ylabel="time over that of orders='auto'",
        title=f"waveform of {len(THETA)} angles, tolerance 1e-9",
    )
    axes[2].minorticks_off()
    axes[2].axhline(1.0, color="k", lw=1)
    axes[2].set_yticks([0.5, 1, 2, 5, 10], [0.5, 1, 2, 5, 10])
    axes[2].plot([], [], "k--", label="all orders, if nothing cancelled")
    axes[2].plot([], [], "k:", label="kinematics")
    for ax in axes:
        ax.grid(alpha=0.3)
        ax.legend(fontsize="small")
    figure.savefig(file, dpi=120)


def print_times(rows: list[Row]) -> None:
    """Print what leaving out saves."""
    listed = []
    for row in rows:
        if row["kind"] != "time":
            continue
        auto, everything, kinematics = (
            float(row[f"{method}_seconds"]) for method in ("auto", "all", "kinematics")
        )
        listed.append(
            [
                f"{row['engine']}, {row['rod_ratio']:g}, {row['rtol']:.0e}",
                f"{row['orders']} of {row['without_layout']}",
                f"{1e6 * auto:.0f} µs",
                f"{everything / auto:.2f} ×",
                f"{kinematics / auto:.2f} ×",
            ]
        )
    header = ["engine, rod ratio, tolerance", "orders", "auto", "all", "kinematics"]
    print_table(f"Waveforms of {len(THETA)} angles; ratios to auto", header, listed)


def main() -> None:
    """Count, time, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="time one tolerance only")
    given = parser.parse_args()
    out: Path = given.out
    out.mkdir(parents=True, exist_ok=True)
    rows = counts() + times(given.quick)
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with (out / "orders.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)
    (out / "orders_machine.txt").write_text(machine() + "\n", encoding="utf-8")
    draw(rows, out / "orders.png")
    print(machine())
    print_times(rows)


if __name__ == "__main__":
    main()
