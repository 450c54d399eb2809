"""Everything public that can be called, with what may be given to it."""

# ruff: noqa: ANN401 - operands of any type are the point

from __future__ import annotations

import copy
import inspect
import itertools
import operator
import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import crankpin as cp
import numpy as np

from fuzzing.sound import CYCLE, CYLINDER, FIRED, I4, JSON, TOML, V6, ranked, swept, two_stroke, vee

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SLOW = {"plot", "view", "save_html"}  # pictures: fewer calls

SOUND: dict[str, list[Any]] = {
    "layout": ["vee", "inline"],
    "most_shafts": [2],
    "pistons": [[0.5, 0.51, 0.49, 0.5, 0.505, 0.495, 0.5]],
    "pin_split_deg": [0, (-60, 60)],
    "places": [{-1: (0.1, 0.0)}],
    "ratios": [-1, (-2, 2)],
    "first_tdc_deg": [30],
    "sample": [1],
    "samples": [200],
    "sets": [1],
    "shaft_orders": [1],
    "amount": [0.01],
    "counterweights": [[cp.Unbalance(0.01, 0.1, 180, pin=1)]],
    "pin": [1, None],
    "ratio": [-1, 2],
    "shafts": [[cp.Shaft(-1, [cp.Unbalance(0.01, 0.1)], x=0.1)]],
    "unbalances": [[cp.Unbalance(0.01, 0.1)]],
    "after": [V6, I4],
    "amount_g_mm": [[120, 80]],
    "angle_deg": [[30, 200]],
    "bound": [0.01],
    "correction_z": [[0.05, 0.35]],
    "factors": [[0.5, 0.6]],
    "factor": [0.5, {"force": 0.5}],
    "measured_z": [[0.0, 0.4]],
    "mode_shape": [[1, 0.9, 0.7, 0.5, 0.3, 0.1]],
    "minimise": ["squares", "largest"],
    "oil": [0.004],
    "planes": ["ends", "webs", [0.0, 0.2]],
    "target": ["external", "internal"],
    "ax": [None],
    "backward_force": [1j],
    "before": [V6, I4],
    "cycle": [CYCLE, [CYCLE, None, CYCLE, CYCLE]],
    "crankcase": [9e4, None],
    "cycles": [[[CYCLE, CYCLE]]],
    "drive": [FIRED, ([0, 180, 360], [1.0, 3.0, 1.0])],
    "load": [[0.0, 1.0]],
    "pressure": [[1e5, 5e6]],
    "bore": [0.086],
    "chunks": [{"rpm": 1}, 2],
    "core": [I4._core],
    "counterweight": [1.5],
    "cylinders": [6],
    "first_deg": [[0, 120, 240]],
    "high": [90],
    "inertia": [0.0025],
    "length": [0.15],
    "low": [10],
    "mass": [0.6],
    "piston_mass": [0.4],
    "rod": [cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)],
    "second_deg": [[0, 240, 120]],
    "second_order": [(1.0, 2.0)],
    "stroke": [0.086],
    "to_crankpin": [0.05],
    "bank_angle_deg": [60, 90.0, "360/7", [60, 90]],
    "bank_deg": [[60, 120], [90, 90, 90]],
    "by": ["total.moment.peak", ["[1].force.backward"], "spread", lambda b: b.rpm],
    "count": [1, 0],
    "cylinder": [CYLINDER],
    "crank_radius": [0.05],
    "engine": [V6],
    "engines": [V6, I4, [V6, I4], {"a": V6}],
    "firing_order": ["1-3-4-2", [1, 2, 3, 4], "1-2-5-6-3-4", "1+4-2+3"],
    "groups": [[[1, 4], [2, 3]], [[2]]],
    "hold": ["pins", "firing"],
    "intervals_deg": [[180] * 4, [90, 270, "90", 270]],
    "name": ["v6-60", "i4", "a name"],
    "order": [1, 2],
    "orders": [1, [1, 2], [1, 2, 4, 6]],
    "path": ["engine.toml"],
    "pin_deg": [[0, 180]],
    "quantity": ["force", "moment", "torque"],
    "reciprocating_mass": [0.5],
    "rod_length": [0.15],
    "rod_ratio": [0.3, [0.2, 0.3]],
    "rpm": [1000, [1000.0, 2000.0]],
    "spacing": [0.1],
    "spectrum": [{1: 1.0, 2: 0.3}],
    "strokes": [4, 2],
    "values": [[3.0, 1.0, 2.0]],
    "what": ["peak", "phasors"],
    "tdc_deg": [[0, 90], ["360/7", Fraction(1, 3)]],
    "text": [TOML, JSON],
    "theta_deg": [[0.0, 90.0], 30.0],
    "throws_deg": [[0, 120, 240], [0]],
    "timing": [cp.ValveTiming(exhaust_opens_deg="360/7"), cp.PortTiming()],
    "x": ["rpm"],
    "z": [[0.0, 0.1]],
}

SUBJECTS: dict[str, Any] = {
    "Cylinder": cp.Cylinder,
    "Engine": cp.Engine,
    "Balance": cp.types.Balance,
    "Waveform": cp.types.Waveform,
    "Sweep": cp.types.Sweep,
    "cylinder": CYLINDER,
    "v6": V6,
    "i4": I4,
    "balance": V6.balance(1000),
    "balance of a spectrum": V6.balance(1000, orders=[1], spectrum={1: 1.0}),
    "balance, auto": V6.balance(1000, orders="auto"),
    "vanishing orders": V6.vanishing_orders(),
    "comparison": cp.compare(V6, I4, 1000),
    "closed form": V6.closed_form(1),
    "explanation": FIRED.explain(1000),
    "waveform": V6.waveform(1000, theta_deg=[0.0, 1.0]),
    "waveform, auto": V6.waveform(1000, theta_deg=[0.0, 1.0], orders="auto"),
    "waveform of a spectrum": V6.waveform(1000, theta_deg=[0.0], orders=[1], spectrum={1: 1.0}),
    "bearing loads": cp.bearing_loads(V6, 1000, [0.0, 1.0]),
    "cycle": CYCLE,
    "cycle map": cp.CycleMap([1000, 3000], [0, 1], [[CYCLE, CYCLE]] * 2),
    "fired": FIRED,
    "balance, fired": FIRED.balance(1000),
    "waveform, fired": FIRED.waveform(1000, theta_deg=[0.0, 1.0]),
    "sweep, fired": cp.sweep(FIRED, rpm=[1e3, 2e3], orders=[0.5, 2]),
    "firing": V6.firing("1-2-5-6-3-4"),
    "firing, two-stroke": two_stroke(),
    "star diagram": cp.star_diagram(V6, firing_order="1-2-5-6-3-4"),
    "sweep": cp.sweep([V6, V6], rpm=[1e3, 2e3], bank_angle_deg=[60, 90], hold="pins"),
    "ranking": ranked(by=["total.force.peak_xy", lambda b: b.rpm], refine=True),
    "ranking, as they are": cp.rank(
        [V6, vee()], rpm=1e3, by="total.moment.peak", spectrum={1: 1.0, 2: 0.2}
    ),
    "sweep of a spectrum": cp.sweep(I4, rpm=1e3, spectrum={1: 1.0}),
    "counterweights": cp.counterweights(V6, planes="webs", angles_deg=[0, 120, 240]),
    "bob weight": cp.bob_weight(V6),
    "flywheel": cp.flywheel(([0, 120, 360], [300, 500, 300]), rpm=600, inertia=2.0),
    "balance shafts": cp.balance_shafts(I4, (-2, 2)),
    "balancer options": cp.balancer_options(V6, rpm=1000, most_shafts=1),
    "designs": cp.design(
        3, layout="inline", cylinder=CYLINDER, spacing=0.1, rpm=1000, by="total.moment.peak"
    ),
    "match": cp.match_parts(I4, [0.5, 0.51, 0.49, 0.5, 0.505]),
    "tolerances": cp.tolerances(I4, rpm=1000, reciprocating_mass=0.01, samples=200),
    "two-plane correction": cp.two_plane_correction(
        [120, 80], [30, 200], measured_z=[0.0, 0.4], correction_z=[0.05, 0.35]
    ),
    "waveforms of a sweep": swept().waveform([0.0, 1.0]),
    "waveforms of a sweep, exact": swept().waveform([0.0, 1.0], exact=True),
}
OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "in": operator.contains,
    "[]": operator.getitem,
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "//": operator.floordiv,
    "%": operator.mod,
    "**": operator.pow,
    "@": operator.matmul,
    "&": operator.and_,
    "|": operator.or_,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "r+": lambda subject, value: value + subject,
    "r*": lambda subject, value: value * subject,
    "r<": lambda subject, value: value < subject,
    "inside": lambda subject, value: subject in value,
}
"""What ``subject OPERATOR value`` calls; a TypeError of an operand is Python's or NumPy's."""
ALONE: dict[str, Callable[[Any], Any]] = {
    "len": len,
    "iter": lambda subject: list(itertools.islice(iter(subject), 1000)),
    "reversed": lambda subject: list(itertools.islice(reversed(subject), 1000)),
    "bool": bool,
    "hash": hash,
    "repr": repr,
    "str": str,
    "format": lambda subject: f"{subject:>10}",
    "dir": dir,
    "abs": abs,
    "-": operator.neg,
    "+": operator.pos,
    "~": operator.invert,
    "int": int,
    "float": float,
    "complex": complex,
    "index": operator.index,
    "round": round,
    "bytes": bytes,
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda subject: pickle.loads(pickle.dumps(subject)),  # noqa: S301 - its own
    "array": np.asarray,
}
"""What ``OPERATOR subject`` calls."""
PLAIN = {"Choice", "InputError", "OrderBalance"}  # take anything, and hold it
RESULTS_MADE_ELSEWHERE = {
    "Balance",
    "BalanceShafts",
    "BalancerOptions",
    "BearingLoads",
    "Comparison",
    "Counterweights",
    "Designs",
    "Exercise",
    "Explanation",
    "Firing",
    "Flywheel",
    "Ranking",
    "Waveform",
    "Sweep",
    "SweepWaveform",
    "Tolerances",
}  # by methods of Engine and of Sweep, by sweep and by rank


class Target(NamedTuple):
    """Something public that can be called."""

    label: str
    function: Callable[..., Any]
    parameters: tuple[inspect.Parameter, ...]


def target(label: str, function: Callable[..., Any]) -> Target:
    return Target(label, function, tuple(inspect.signature(function).parameters.values()))


def targets() -> Iterator[Target]:
    """Every public function, constructor and method."""
    for name in cp.__all__:
        value = getattr(cp, name)
        if callable(value) and name not in PLAIN:
            yield target(name, value)
    for label, subject in SUBJECTS.items():
        for name in dir(type(subject) if not isinstance(subject, type) else subject):
            of_class = isinstance(subject, type)
            static = inspect.getattr_static(subject if of_class else type(subject), name)
            if name.startswith("_") or of_class != isinstance(static, classmethod | staticmethod):
                continue
            if callable(static) or of_class:
                yield target(f"{label}.{name}", getattr(subject, name))


OPERANDS = {
    label: subject
    for label, subject in (
        SUBJECTS
        | {
            "quantity": SUBJECTS["balance"].moment,
            "order": SUBJECTS["balance"][2],
            "table": SUBJECTS["balance"].table,
            "cylinder": CYLINDER,
            "cycle": CYCLE,
        }
    ).items()
    if not isinstance(subject, type)
}
"""What has operators: objects of every kind, and parts of some."""


def operators() -> Iterator[Target]:
    """Every operator of every operand, whether it has that or not."""
    for label, subject in OPERANDS.items():
        for name, of in OPERATORS.items():

            def operated(value: Any, subject: Any = subject, of: Any = of) -> Any:
                return of(subject, value)

            value = inspect.Parameter("value", inspect.Parameter.POSITIONAL_OR_KEYWORD)
            yield Target(f"{label} {name}", operated, (value,))


TARGETS = [each for each in targets() if each.label.rpartition(".")[2] not in SLOW]
TARGETS += operators()
PICTURES = [each for each in targets() if each.label.rpartition(".")[2] in SLOW]
