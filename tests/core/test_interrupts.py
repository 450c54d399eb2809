"""Does Ctrl-C stop a long call, and do other threads go on while it runs?

A call that could not be stopped would take minutes to hours; benchmarks/interrupts.py measures how
long stopping takes.
"""

from __future__ import annotations

import inspect
import signal
import subprocess
import sys
import threading

import crankpin as cp
import numpy as np
import pytest
from support import in_turn

pytestmark = pytest.mark.slow

LONG_CALLS = {
    "sum of orders over bank angle, rod ratio and speed": (
        "cp.sweep(v6, rpm=np.linspace(1, 9000, 100), bank_angle_deg=np.linspace(0, 180, 400), "
        "hold='pins', rod_ratio=np.linspace(0.1, 0.5, 6000), orders=[1, 2, 4, 6]).total.moment.peak"
    ),
    "sum of orders over rod ratio": (
        "cp.sweep(v6, rpm=1000, rod_ratio=np.linspace(0.1, 0.5, 20_000_000), "
        "orders=[1, 2, 4, 6, 8, 10]).total.moment.peak_xy"
    ),
    "harmonics with an offset": (
        "cp.slider_crank_harmonics(np.full(10_000_000, 0.9999), range(1, 5), 1e-7)"
    ),
    "search of a V-24": "cp.search_arrangements(24, phases_deg=range(0, 180, 15))",
    "ranking by name": (
        "cp.rank(v6, rpm=1000, bank_angle_deg=np.linspace(0, 180, 10_000_000), hold='pins', "
        "by='total.moment.peak')"
    ),
    "ranking by a function": (
        "cp.rank(v6, rpm=1000, bank_angle_deg=np.linspace(0, 180, 10_000_000), hold='pins', "
        "by=lambda balance: balance.rpm)"
    ),
    "waveforms of a sweep": (
        "[cp.sweep(v6, rpm=1000, rod_ratio=np.linspace(0.1, 0.5, 100_000), orders=range(1, 300))"
        ".waveform(np.linspace(0, 720, 2000)).force for _ in range(10_000)]"
    ),
    "waveforms of a sweep by kinematics": (
        "[cp.sweep(v6, rpm=1000, rod_ratio=np.linspace(0.1, 0.5, 100_000), orders=[1, 2, 4, 6])"
        ".waveform(np.linspace(0, 720, 2000), exact=True).force for _ in range(10_000)]"
    ),
    "balance of ten thousand orders": (
        "[near(0.999, 1e-6).balance(1000, orders=range(1, 10_001)) for _ in range(10_000)]"
    ),
    "orders chosen for a balance": "near(0.99999, 1e-9).balance(1000, orders='auto', rtol=1e-3)",
    "waveform of chosen orders": (
        "near(0.99999, 1e-9).waveform(1000, theta_deg=[0.0], orders='auto', rtol=1e-3)"
    ),
    "harmonics of one cylinder": (
        "[near(0.999, 1e-6).cylinders[0].harmonics(range(1, 10_001)) for _ in range(10_000)]"
    ),
    "one point of a sweep": (
        "[cp.sweep(near(0.999, 1e-6), rpm=1000, orders=range(1, 10_001)).torque.phasor "
        "for _ in range(10_000)]"
    ),
    "tolerances": (
        "[cp.tolerances(v6, rpm=1000, rod_length=1e-4, samples=400_000) for _ in range(10_000)]"
    ),
    "response on mounts": (
        "[on_mounts.response(np.linspace(600, 6000, 30_000), orders=range(1, 13)).body_force"
        ".total.peak for _ in range(10_000)]"
    ),
    "designs of mounts": (
        "on_mounts.designs(np.linspace(600, 6000, 2000), {'a': {'stiffness': "
        "np.linspace(1e5, 4e5, 200_000)}}, orders=range(1, 13))"
    ),
    "matching of a thousand parts": (
        "[cp.match_parts(many, np.linspace(0.4, 0.45, 1000)) for _ in range(10_000)]"
    ),
    "designs of cranks": (
        "[cp.design(16, layout='vee', cylinder=v6.cylinders[0], bank_angle_deg=90, spacing=0.1, "
        "rpm=6000, by='total.moment.peak') for _ in range(10_000)]"
    ),
    "sets of shafts": (
        "[cp.balancer_options(v6, 3000, shaft_orders=range(1, 20), most_shafts=10) "
        "for _ in range(10_000)]"
    ),
    "design of mounts": (
        "[cp.design_mounts(on_mounts, vary='stiffness', bounds={'stiffness': (5e4, 5e5)}) "
        "for _ in range(10_000)]"
    ),
    "corners of mounts": "[on_mounts.robustness(0.1) for _ in range(10_000)]",
    "waveform as a sum of orders": (
        "v6.waveform(1000, theta_deg=np.linspace(0, 720, 20_000_000), orders=range(1, 300))"
    ),
}

STOPPED_WITHIN = 2.0
"""Seconds from Ctrl-C to the exception, on a busy machine."""

PROGRAM = """
import signal
import numpy as np
import crankpin as cp
v6 = cp.Engine.preset("v6-60")
def near(rod_ratio, offset):
    "Forty unlike cylinders whose cranks can hardly turn."
    rods = [0.05 / rod_ratio * (1 + 1e-9 * k) for k in range(40)]
    cylinders = [cp.Cylinder(0.05, rod, 1, pin_offset=offset) for rod in rods]
    tdcs, places = [7.3 * k for k in range(40)], [0.1 * k for k in range(40)]
    return cp.Engine.from_lists(cylinders, tdc_deg=tdcs, bank_deg=[0] * 40, z=places)
mounts = [
    cp.Mount(name, (x, 0.1 * z, z), 3e5, loss_factor=0.1, damping=100)
    for name, x, z in zip("abcdef", [0.3, -0.3, 0.3, -0.3, 0.1, -0.1], [0, 0, 0.7, 0.7, 0.3, 0.4])
]
on_mounts = cp.Powertrain(v6, cp.RigidBody(250, (0.01, 0.1, 0.2), (14, 15, 9)), mounts)
many = cp.Engine.inline(v6.cylinders[0], throws_deg=range(1000), spacing=0.1)
# Whoever started the tests may ignore SIGINT, as nohup and shells do for background jobs.
signal.signal(signal.SIGINT, signal.default_int_handler)
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


def test_every_function_that_reports_progress_is_among_the_long_calls() -> None:
    """Those are long by what they say themselves."""
    functions = {name: getattr(cp, name) for name in cp.__all__}
    long = [
        name
        for name, function in functions.items()
        if inspect.isfunction(function) and "progress" in inspect.signature(function).parameters
    ]
    assert "match_parts" in long
    typed = " ".join(LONG_CALLS.values())
    assert [name for name in long if f"cp.{name}(" not in typed] == []


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
@in_turn("name", LONG_CALLS)
def test_ctrl_c_stops_a_long_call(name: str) -> None:
    program = PROGRAM.format(call=LONG_CALLS[name])
    with subprocess.Popen(  # noqa: S603 - this interpreter
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(1.0)
        process.send_signal(signal.SIGINT)
        try:
            told, _ = process.communicate(timeout=STOPPED_WITHIN)
        finally:
            process.kill()
        assert (told, process.returncode) == ("stopped\n", 0)


def test_other_threads_go_on() -> None:
    """While one thread is in a long call, another one gets its turns."""
    v6 = cp.Engine.preset("v6-60")
    sweep = cp.sweep(
        v6,
        rpm=[1000, 2000],
        bank_angle_deg=np.linspace(0, 180, 300),
        hold="pins",
        rod_ratio=np.linspace(0.1, 0.5, 40),
        orders=[1, 2, 4, 6],
    )
    done = threading.Event()

    def work() -> None:
        _ = sweep.total.moment.peak_xy
        done.set()

    turns = 0
    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        turns += 1
    thread.join()
    # a call that kept the interpreter would leave a turn before it and one after
    assert turns > 100


def test_several_threads_at_once_agree() -> None:
    v6 = cp.Engine.preset("v6-60")
    alone = v6.waveform(5000, theta_deg=np.arange(5000.0)).moment
    results: list[np.ndarray] = []
    threads = [
        threading.Thread(
            target=lambda: results.append(v6.waveform(5000, theta_deg=np.arange(5000.0)).moment.xy)
        )
        for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 8
    assert all(np.array_equal(alone, result) for result in results)


def test_peaks_of_ten_thousand_orders_leave_the_interpreter_to_others() -> None:
    """It was held for 16 s."""
    v6 = cp.Engine.preset("v6-60")
    balance = v6.balance(5000, orders=range(1, 10_001))
    peaks: list[float] = []
    thread = threading.Thread(target=lambda: peaks.append(balance.total.moment.peak))
    turns = 0
    thread.start()
    while thread.is_alive():
        turns += 1
    # as above: a turn before and one after, if it were kept
    assert turns > 100
    # Powers of e^{iθ} as high as the orders, each with a rounding.
    chosen = v6.balance(5000, rtol=1e-12).total.moment.peak
    assert peaks[0] == pytest.approx(chosen, rel=5e-12)
