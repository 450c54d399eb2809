"""How calls behave in their process: forked children, no threads, little memory."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from fuzzing.sound import FIRED
from fuzzing.surface import CALLED
from support import in_turn, long_calls

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.slow

linux = pytest.mark.skipif(sys.platform != "linux", reason="fork and limits as on Linux")


def ends_within(seconds: int, child: Callable[[], object]) -> bool:
    """Run a function in a forked child; return whether it ends well in time."""
    process = os.fork()
    if process == 0:
        signal.alarm(seconds)  # ends a child that hangs
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        code = 1
        try:
            child()
            code = 0
        finally:
            os._exit(code)
    return os.waitpid(process, 0)[1] == 0


@linux
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("name", long_calls.CALLS)
def test_fork_after_a_parallel_call_leaves_a_child_that_computes(name: str) -> None:
    call = long_calls.CALLS[name]
    expected = long_calls.digest(call())
    results: list[str] = []

    def child() -> None:
        results.append(long_calls.digest(call()))
        assert results == [expected]

    assert ends_within(60, child)


@linux
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_fork_in_a_forked_child_leaves_a_child_that_computes() -> None:
    def child() -> None:
        over_ratios()
        assert ends_within(30, over_ratios)

    over_ratios()
    assert ends_within(60, child)


def over_ratios() -> np.ndarray:
    return cp.slider_crank_harmonics(np.linspace(0.1, 0.9, 100_000), [2])


# A stack larger than the address space: no thread can be started, by root neither.
NO_THREADS = {"RUST_MIN_STACK": str(2**60)}


@linux
def test_calls_compute_in_the_calling_thread_where_no_thread_can_be_started() -> None:
    program = Path(long_calls.__file__).read_text(encoding="utf-8")
    assert python(program, NO_THREADS) == python(program)


@linux
def test_ctrl_c_stops_a_call_where_no_thread_can_be_started() -> None:
    program = """
import signal
import numpy as np
import crankpin as cp
signal.signal(signal.SIGALRM, signal.default_int_handler)
ratios, offsets = np.full(10_000_000, 0.9999), np.full(10_000_000, 1e-7)
signal.setitimer(signal.ITIMER_REAL, 1)
try:
    cp.slider_crank_harmonics(ratios, range(1, 5), offsets)
except KeyboardInterrupt:
    print("stopped")
"""
    assert python(program, NO_THREADS) == "stopped\n"


LITTLE_MEMORY = """
import resource
import numpy as np
import crankpin as cp
v6 = cp.Engine.preset("v6-60")
v16 = cp.Engine.vee(
    v6.cylinders[0], bank_angle_deg=45, spacing=0.1, throws_deg=[0, 90, 270, 180, 180, 270, 90, 0]
)
def limited(megabytes):
    "Allow so much address space more than is in use."
    with open("/proc/self/statm") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (int(used + megabytes * 10**6), -1))
{before}
limited({megabytes})
try:
    {call}
except MemoryError as error:
    print("MemoryError")
"""


MANY = "many = cp.Engine.inline(v6.cylinders[0], throws_deg=range(1000), spacing=0.1)"


@linux
@pytest.mark.parametrize(
    ("megabytes", "before", "call"),
    [
        (1000, "", "cp.search_arrangements(24, phases_deg=range(0, 180, 15))"),
        (250, "angles = np.linspace(0, 720, 20_000_000)", "v6.waveform(3000, theta_deg=angles)"),
        (
            250,
            "angles = np.linspace(0, 720, 20_000_000)",
            "v6.waveform(3000, theta_deg=angles, orders=[1, 2])",
        ),
        (
            60,
            "ratios = np.linspace(0.1, 0.5, 10_000_000)",
            "cp.sweep(v6, rpm=3000, rod_ratio=ratios, orders='auto')",
        ),
        (
            110,
            "ratios = np.linspace(0.1, 0.5, 10_000_000)",
            "cp.sweep(v6, rpm=3000, rod_ratio=ratios, orders='auto')",
        ),
        (
            110,
            "speeds = np.linspace(100, 5000, 10_000_000)",
            "cp.sweep(v6, rpm=speeds, orders='auto').force",
        ),
        # Small allocations fail where there is almost nothing left.
        (0, "", "v16.firing_orders()"),
        (2, "", "v16.firing_orders()"),
        (16, "", "v16.firing_orders()"),
        (0, "found = cp.search_arrangements(22)", "found.bank_angles_deg"),
        (50, "found = cp.search_arrangements(22)", "found.bank_angles_deg"),
        (0, "found = cp.search_arrangements(22)", "for each in found: pass"),
        (0, "several = v6.balance(5000, orders=range(1, 10_001))", "several.total.force.peak"),
        (3.5, MANY, "many.balance(5000, orders=range(1, 10_001)).total.force.peak"),
        (
            10,
            "given = {'planes': np.linspace(0, 1, 60), 'angles_deg': range(0, 360, 4)}",
            "cp.counterweights(v6, **given, bound=0.01)",
        ),
        (
            0.5,
            "ratios = np.linspace(0.1, 0.5, 20_000)",
            "cp.sweep(v6, rpm=3000, rod_ratio=ratios, orders=[1, 2, 4]).total.moment.peak",
        ),
        (
            250,
            (
                "ratios = np.linspace(0.1, 0.5, 16_384); "
                "several = [v6.replace(name=f'{k}') for k in range(100)]"
            ),
            "cp.sweep(several, rpm=3000, rod_ratio=ratios, orders=[1, 2]).moment.xy",
        ),
        (
            30,
            (
                "swept = cp.sweep(v6, rpm=3000, rod_ratio=np.linspace(0.1, 0.5, 200_000), "
                "orders=[1, 2, 4]).about((0.1, 0.1, 0)); swept.torque.phasor"
            ),
            "swept.total.torque.peak; [np.ones(2**20) for _ in range(99)]",
        ),
        (60, MANY, "[many.tdc_deg for _ in range(10**6)]"),
        (60, MANY, "[many.pin_deg for _ in range(10**6)]"),
        (60, MANY, "[many.to_toml() for _ in range(10**6)]"),
        (60, MANY, "[many._core.cylinders for _ in range(10**6)]"),
        (20, "", "[v6.cylinders[0].harmonics(range(1, 1000)) for _ in range(10**6)]"),
        (20, "import pickle", "[pickle.dumps(v16) for _ in range(10**6)]"),
        (
            8,
            (
                "question = {'layout': 'vee', 'cylinder': v6.cylinders[0], 'bank_angle_deg': 90, "
                "'spacing': 0.1, 'rpm': 6000, 'by': 'total.moment.peak'}; cp.design(4, **question)"
            ),
            "cp.design(16, **question)",
        ),
        # Compiled modules that NumPy imports late.
        (3, "cp.tolerances", "cp.tolerances(v6, 5000, pin_deg=0.1, samples=100)"),
        (3, "cp.match_parts", "cp.match_parts(v6, np.linspace(0.4, 0.45, 6))"),
        (0, "", "v6.save_html('v6.html')"),
    ],
)
def test_memory_that_is_not_there_raises_memory_error(
    megabytes: float, before: str, call: str
) -> None:
    program = LITTLE_MEMORY.format(megabytes=megabytes, before=before, call=call)
    assert python(program) == "MemoryError\n"


@linux
@pytest.mark.parametrize("megabytes", [3, 16])
def test_a_first_product_does_not_end_the_process(megabytes: float, tmp_path: Path) -> None:
    """OpenBLAS does, where it has no memory for its buffer."""
    program = f"""
import resource, numpy
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + {megabytes} * 2**20, -1))
try:
    from crankpin import Engine
except MemoryError:
    print("MemoryError")
"""
    assert python(program) == "MemoryError\n"
    page = f"v6.save_html({str(tmp_path / 'v6.html')!r}); raise MemoryError"
    program = LITTLE_MEMORY.format(megabytes=megabytes, before="", call=page)
    assert python(program) == "MemoryError\n"  # of the page or of the line


@linux
def test_no_public_call_ends_the_process_or_panics_where_there_is_little_memory() -> None:
    program = Path(long_calls.__file__).with_name("little_memory.py").read_text(encoding="utf-8")
    printed = python(
        program, {"OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    ).splitlines()
    assert printed == [f"{len(CALLED)} calls"]


def test_a_panic_is_an_error_that_asks_to_report_it() -> None:
    with pytest.raises(cp.InputError, match=r"index out of bounds.*; please report the call"):
        FIRED._core.fired_as(FIRED._core, [99])


RUST = Path(__file__).parents[2] / "rust" / "py" / "src"


@in_turn("file", sorted(RUST.glob("*.rs")))
def test_everything_that_python_calls_is_guarded_and_makes_arrays_that_can_fail(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    exported = re.findall(r"^ *#\[(?:pymethods|pyfunction)\b", text, re.MULTILINE)
    guarded = re.findall(r"^( *)#\[guarded\]\n\1#\[(?:pymethods|pyfunction)\b", text, re.MULTILINE)
    assert len(guarded) == len(exported)
    assert not re.findall(r"PyArray\w*::\w+|to_pyarray|into_pyarray|\.read(?:only|write)\(\)", text)


@pytest.mark.parametrize("length", [10**9, 10**30])
def test_length_of_a_range_is_checked_before_it_is_converted(length: int) -> None:
    v6 = cp.Engine.preset("v6-60")
    with pytest.raises(cp.InputError, match=r"theta_deg has .* numbers, more than the limit"):
        v6.waveform(3000, theta_deg=range(length))


def python(program: str, environment: dict[str, str] | None = None) -> str:
    """Return what a program prints."""
    done = subprocess.run(  # noqa: S603 - this interpreter
        [sys.executable, "-c", program],
        env=os.environ | {"RAYON_NUM_THREADS": "2"} | (environment or {}),
        cwd=Path(__file__).parent,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


LEAN = """
import resource
import crankpin as cp
def peak():
    "Return the most memory that the process had, bytes."
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
options = {"reciprocating_mass": 1e-3, "rod_length": 1e-4, "pin_deg": 0.1}
v8 = cp.Engine.preset("v8-crossplane")
cp.tolerances(v8, 600, samples=2, orders=[1, 2], **options)
before = peak()
result = cp.tolerances(v8, 600, samples=73, orders=range(1, 10_001), **options)
arrays = [result.force.forward, result.moment.forward, result.torque.phasor]
print((peak() - before) / 10**6)
"""


@linux
def test_tolerances_take_little_memory_beside_their_results() -> None:
    megabytes = 73 * 10_000 * 10 * 16 / 10**6
    # Half as much again: copies of one sample, harmonics of some orders, pages of the allocator.
    assert float(python(LEAN)) <= 1.5 * megabytes
