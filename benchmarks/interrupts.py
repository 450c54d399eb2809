"""How long does it take from Ctrl-C to the exception, at any moment of any long call?

``python benchmarks/interrupts.py`` starts each call again and again, sends SIGINT some time after,
and prints the longest time until ``KeyboardInterrupt`` is caught and the call's memory given back.
"""

from __future__ import annotations

import argparse
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from _timing import machine, print_table, write_csv

CALLS = {
    "sweep, 20 million rod ratios: peaks of sums": (
        "cp.sweep(v6, rpm=1000, rod_ratio=ratios, orders=[1, 2, 4, 6, 8, 10]).total.moment.peak_xy"
    ),
    "sweep, 20 million rod ratios: phasors": (
        "cp.sweep(v6, rpm=1000, rod_ratio=ratios, orders=[1, 2, 4, 6]).moment.xy"
    ),
    "sweep, 20 million rod ratios: torque": (
        "cp.sweep(v6, rpm=1000, rod_ratio=ratios, orders=[1, 2, 4, 6]).torque.phasor"
    ),
    "sweep, 20 million bank angles, offset": (
        "cp.sweep(v6, rpm=1000, bank_angle_deg=angles, hold='pins', pin_offset=1e-3, "
        "orders=[1, 2, 4, 6]).moment.xy"
    ),
    "sweep, 20 million speeds": "cp.sweep(v6, rpm=speeds, orders=[1, 2, 4, 6]).moment.xy",
    "sweep, bank angle × rod ratio × speed": (
        "cp.sweep(v6, rpm=speeds[::20_000], bank_angle_deg=angles[::100_000], hold='pins', "
        "rod_ratio=ratios[::40_000], orders=[2]).moment.xy"
    ),
    "sweep, orders chosen": "cp.sweep(v6, rpm=1000, rod_ratio=ratios, orders='auto').force.xy",
    "sweep, a list of 20 million numbers": (
        "cp.sweep(v6, rpm=1000, rod_ratio=listed, orders=[1, 2, 4, 6]).force.xy"
    ),
    "harmonics": "cp.slider_crank_harmonics(ratios, range(1, 21))",
    "harmonics with an offset, λ = 0.9999": (
        "cp.slider_crank_harmonics(near_one, range(1, 5), 1e-7)"
    ),
    "waveform, kinematics": "v6.waveform(1000, theta_deg=thetas).moment",
    "bearing loads, a million crank angles": "cp.bearing_loads(v6, 1000, thetas[:1_000_000])",
    "waveform, 299 orders": ("v6.waveform(1000, theta_deg=thetas, orders=range(1, 300)).moment"),
    "balance, 10 000 orders, λ = 0.999": "near.balance(1000, orders=range(1, 10_001))",
    "balance, orders chosen, λ = 0.99999": "nearer.balance(1000, orders='auto', rtol=1e-3)",
    "peaks of 10 000 orders, all large": "many_orders().total.force.peak",
    "sweep, peaks of 3000 orders": (
        "cp.sweep(v6, rpm=1000, rod_ratio=ratios[::20_000], orders=range(1, 3001)).total.force.peak"
    ),
    "sweep, 10⁸ rod ratios, the last of which is wrong": (
        "cp.sweep(v6, rpm=1000, rod_ratio=wrong_at_the_end, orders=[2])"
    ),
    "tolerances, 300 orders": (
        "cp.tolerances(v6, rpm=5000, orders=range(1, 301), reciprocating_mass=1e-3, samples=2000)"
    ),
    "tolerances, 1 000 000 samples": (
        "cp.tolerances(v6, rpm=5000, rod_length=1e-4, samples=1_000_000).total.force"
    ),
    "proofs, 1000 cylinders": "long.vanishing_orders([1])",
    "closed forms, 1000 cylinders": "long.closed_form(1)",
    "firing orders of a V16": "v16.firing_orders()",
    "counterweights, 200 planes of 50 angles": (
        "cp.counterweights(v6, planes=list(np.linspace(-0.2, 0.5, 200)), bound=1e-3, "
        "angles_deg=list(range(0, 350, 7)))"
    ),
    "matching of 24 pistons": (
        "cp.match_parts(v12, np.linspace(0.39, 0.41, 24), sets=2, orders=[1, 2])"
    ),
    "matching of 1000 pistons": "cp.match_parts(long, np.linspace(0.39, 0.41, 1000))",
    "trace of 400 cycles, prepared": "cp.prepare_trace(traces, v6.cylinders[0], lowpass_order=50)",
    "trace of 400 cycles, its table": (
        "cp.prepare_trace(traces, bored, lowpass_order=50, intake_pressure=1e5).table"
    ),
    "frame of 20 million rows": (
        "cp.sweep(v6, rpm=1000, rod_ratio=ratios, orders=[2], torque=False).to_csv('/dev/null')"
    ),
    "phasors of 500 cylinders": "five_hundred.balance(1000, orders=[1, 2]).plot(kind='phasors')",
    "design of a V16": (
        "cp.design(16, layout='vee', cylinder=v6.cylinders[0], bank_angle_deg=(45, 90), "
        "spacing=0.1, rpm=6000, by='total.moment.peak')"
    ),
    "search of a V-24": "cp.search_arrangements(24, phases_deg=range(0, 180, 15))",
    "search of a V-22, its bank angles": "cp.search_arrangements(22).bank_angles_deg",
    "search of a V-22 on shared pins": (
        "len(cp.search_arrangements(22, hold='pins', shared_pins=True))"
    ),
    "ranking, 10 million bank angles": (
        "cp.rank(v6, rpm=1000, by='total.moment.peak', bank_angle_deg=angles[::2], hold='pins')"
    ),
}
MOMENTS = (0.002, 0.01, 0.03, 0.06, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0)
"""Seconds after the start of a call."""

PROGRAM = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
import numpy as np
import crankpin as cp
v6 = cp.Engine.preset("v6-60")
ratios = np.linspace(0.1, 0.5, 20_000_000)
angles = np.linspace(0, 180, 20_000_000)
speeds = np.linspace(500, 9000, 20_000_000)
near_one = np.full(20_000_000, 0.9999)
thetas = np.linspace(0, 720, 20_000_000)
def unlike(rod_ratio, offset):
    rods = [0.05 / rod_ratio * (1 + 1e-9 * k) for k in range(40)]
    cylinders = [cp.Cylinder(0.05, rod, 1, pin_offset=offset) for rod in rods]
    tdcs, places = [7.3 * k for k in range(40)], [0.1 * k for k in range(40)]
    return cp.Engine.from_lists(cylinders, tdc_deg=tdcs, bank_deg=[0] * 40, z=places)
near, nearer = unlike(0.999, 1e-6), unlike(0.99999, 1e-9)
def many_orders():
    spectrum = {{order: 1e-3 for order in range(1, 10_001)}}
    return v6.balance(5000, spectrum=spectrum, orders=range(1, 10_001))
v12 = cp.Engine.vee(v6.cylinders[0], bank_angle_deg=60, throws_deg=[0, 120, 240] * 2, spacing=0.1)
v16 = cp.Engine.vee(
    v6.cylinders[0], bank_angle_deg=45, throws_deg=[0, 90, 270, 180, 180, 270, 90, 0], spacing=0.1
)
long = cp.Engine.inline(v6.cylinders[0], throws_deg=[7.3 * k for k in range(1000)], spacing=0.1)
wrong_at_the_end = np.append(np.full(10**8 - 1, 0.3), 1.5) if "wrong" in {call!r} else None
five_hundred = cp.Engine.inline(
    v6.cylinders[0], throws_deg=[7.3 * k for k in range(500)], spacing=0.1
)
bored, thetas_of_cycle = v6.cylinders[0].replace(bore=0.08), np.arange(0, 720, 0.1)
pressure = cp.Cycle.example().pressure_at(thetas_of_cycle) * np.linspace(0.9, 1.1, 400)[:, None]
traces = cp.Traces(thetas_of_cycle, pressure)
listed = ratios.tolist() if "listed" in {call!r} else None
for line in sys.stdin:
    try:
        print("begun", flush=True)
        {call}
        ended = "done"
    except KeyboardInterrupt:
        ended = time.monotonic()
    except Exception as error:
        ended = type(error).__name__
    print(ended, flush=True)
"""


def latencies(call: str) -> list[float | str]:
    """Return the time until the call stopped, for each moment, or what it did instead."""
    found: list[float | str] = []
    with subprocess.Popen(  # noqa: S603 - this interpreter
        [sys.executable, "-c", PROGRAM.format(call=call)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        told, heard = process.stdin, process.stdout
        assert told is not None  # noqa: S101
        assert heard is not None  # noqa: S101
        for moment in MOMENTS:
            told.write("go\n")
            told.flush()
            heard.readline()
            time.sleep(moment)
            sent = time.monotonic()
            process.send_signal(signal.SIGINT)
            ended = heard.readline().strip()
            try:
                found.append(float(ended) - sent)
            except ValueError:
                # The call was over before: the signal met the wait for the next.
                found.append(ended or "over")
                break
        process.kill()
    return found


def main() -> None:
    """Print the table and write every latency."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--only", default="", help="calls whose name has this in it")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    ran_on = machine()
    print(ran_on)
    table, rows = [], []
    for name, call in CALLS.items():
        if arguments.only not in name:
            continue
        found = latencies(call)
        times = [latency for latency in found if isinstance(latency, float)]
        rows += [(name, moment, latency) for moment, latency in zip(MOMENTS, found, strict=False)]
        worst = max(times, default=np.nan)
        table.append(
            [
                name,
                str(len(times)),
                f"{np.median(times or [np.nan]) * 1e3:.0f} ms",
                f"{worst * 1e3:.0f} ms",
            ]
        )
    write_csv(arguments.out / "interrupts.csv", ran_on, ("call", "sent_after", "latency"), rows)
    print_table("From Ctrl-C to the exception", ["call", "signals", "median", "longest"], table)


if __name__ == "__main__":
    main()
