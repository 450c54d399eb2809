"""Calls with hostile values, and what is wrong with what they return."""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import math
import os
import pickle
import reprlib
import time
import traceback
import warnings
from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

import crankpin as cp
import numpy as np
from hypothesis import strategies as st

from fuzzing.sound import JSON, PARTS, TOML
from fuzzing.surface import OPERATORS, SOUND, Target
from fuzzing.values import VALUES

SECONDS = float(os.environ.get("CRANKPIN_FUZZ_SECONDS", "0"))
PACKAGE = Path(cp.__file__).parent
PATIENCE = 5.0  # seconds of processors to a call: the longest honest one takes a twentieth of one
ALLOWED = (cp.InputError, OSError, ImportError)

MAP = dict[str, Any]


def shown(value: Any) -> str:
    """Text of a value, however deep or long."""
    try:
        return reprlib.repr(value)[:200]
    except ValueError:  # an integer too long for Python to write
        return f"<{type(value).__name__}>"


class Call(NamedTuple):
    """A target and what it is called with."""

    target: Target
    arguments: MAP

    def __repr__(self) -> str:
        listed = ", ".join(f"{name}={shown(value)}" for name, value in self.arguments.items())
        return f"{self.target.label}({listed})"


OPERAND = [1.5]
"""Argument of an operator, which takes anything."""


def sound_call(target: Target, *, but: str = "") -> Call:
    """A call with good values for what it needs, ``samples`` few, and none for one argument."""
    needed = [p for p in target.parameters if p.default is p.empty or p.name == "samples"]
    named = [p.name for p in needed if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)]
    return Call(target, {name: SOUND.get(name, OPERAND)[0] for name in named if name != but})


@st.composite
def calls(draw: st.DrawFn, among: list[Target]) -> Call:
    """A call with up to three arguments bad and the others good or left out."""
    chosen = draw(st.sampled_from(among))
    parameters = [p for p in chosen.parameters if p.kind is not p.VAR_KEYWORD]
    count = draw(st.integers(1, 3))
    bad = {draw(st.integers(0, max(len(parameters) - 1, 0))) for _ in range(count)}
    arguments = {}
    for k, parameter in enumerate(parameters):
        if k in bad:
            arguments[parameter.name] = draw(VALUES)
        elif parameter.default is parameter.empty or draw(st.booleans()):
            if parameter.name in SOUND:
                arguments[parameter.name] = draw(st.sampled_from(SOUND[parameter.name]))
            elif parameter.default is parameter.empty:
                arguments[parameter.name] = draw(VALUES)
    return Call(chosen, arguments)


def invoke(call: Call) -> Any:
    """Call, the var-positional argument unpacked."""
    positional: list[Any] = []
    named = dict(call.arguments)
    for parameter in call.target.parameters:
        if parameter.kind is parameter.VAR_POSITIONAL:
            values = named.pop(parameter.name, ())
            positional += values if isinstance(values, list | tuple) else [values]
        elif parameter.kind is parameter.POSITIONAL_ONLY and parameter.name in named:
            positional.append(named.pop(parameter.name))
    return call.target.function(*positional, **named)


def finite(value: Any) -> bool:
    """Whether all figures in it are, down through tuples."""
    if isinstance(value, float | complex | np.ndarray | np.generic):
        array = np.asarray(value)
        return array.dtype.kind not in "fc" or bool(np.isfinite(array).all())
    return not isinstance(value, tuple) or all(finite(each) for each in value)


BY_ORDER = [
    "force.xy",
    "moment.xy",
    "torque.phasor",
    "crank_torque.phasor",
    "force.peak",
    "moment.forward",
    "total.force.peak_xy",
    "total.moment.peak",
    "total.torque.peak",
    "force.zero_bound",
    "error_bound",
]
RESULTS = {
    cp.Cylinder: [*PARTS, "rod_ratio"],
    cp.Engine: ["tdc_deg", "bank_deg", "pin_deg", "z", "rotating_mass", "reference_z"],
    cp.types.Balance: BY_ORDER,
    cp.types.Sweep: BY_ORDER,
    cp.types.Waveform: ["force", "moment", "torque", "crank_torque", "error_bound"],
    cp.types.VanishingOrders: ["orders", "reference_z"],
    cp.types.Comparison: ["rpm"],
    cp.types.ClosedForm: ["spacing", "reference_z"],
    cp.types.Firing: ["angles_deg", "intervals_deg", "unevenness_deg"],
    cp.types.Ranking: ["values"],
    cp.types.Counterweights: ["largest", "residual", "verdicts", "bay_loads"],
    cp.types.BearingLoads: ["crankpin", "main", "side_thrust", "rod_force", "tension_deg", "z"],
    cp.types.BobWeight: ["mass", "grams"],
    cp.types.TwoPlaneCorrection: ["amount_g_mm", "angle_deg", "drill_deg"],
}


def unsound(value: Any) -> str:
    """What is wrong with a result: figures not finite, an engine that does not read back."""
    if not finite(value):
        return f"returned {shown(value)}"
    for name in RESULTS.get(type(value), []):
        try:
            figure = attrgetter(name)(value)
        except cp.InputError:
            continue  # torque, where a spectrum is given
        if name == "rod_length" and figure == math.inf:
            continue  # a Scotch yoke, whose rod ratio is checked too
        if not finite(figure):
            return f"returned one whose {name} is {shown(figure)}"
    if isinstance(value, cp.Engine) and cp.Engine.from_json(value.to_json()) != value:
        return "returned an engine that does not read back"
    repr(value)
    return ""


def unclear(error: cp.InputError) -> str:
    """What an error lacks: an argument and a hint, in its message and in other processes too."""
    argument, hint, message = error.argument, error.hint, str(error)
    copy = pickle.loads(pickle.dumps(error))  # noqa: S301 - its own
    if not (argument and hint and message.startswith(argument) and message.endswith(hint)):
        return f"raised an error of argument {argument!r} and hint {hint!r}: {message}"
    if error.value is not None and f"{argument} = {error.value}: {hint}" != message:
        return f"raised an error of value {error.value!r}: {message}"
    if (type(copy), str(copy), vars(copy)) != (type(error), message, vars(error)):
        return f"raised an error that does not pickle: {message}"
    return ""


def of_operator(call: Call) -> bool:
    """Whether an operator is called, whose answer is as odd as what it was given."""
    return call.target.label.rpartition(" ")[2] in OPERATORS


def by_python(error: TypeError, call: Call) -> bool:
    """Whether Python itself raised it: of a call's arguments, or of an operand or a key."""
    if of_operator(call) or any(callable(value) for value in call.arguments.values()):
        return True  # or a function given, whose errors pass through
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    return last is not None and last.tb_frame.f_code.co_filename == __file__


def by_operand(error: BaseException, call: Call) -> bool:
    """Whether the value beside an operator raised it, before any code of the package ran.

    Masked arrays and fractions take an operand of any type, and fail in their own ways.
    """
    walked = traceback.walk_tb(error.__traceback__)
    files = (Path(frame.f_code.co_filename) for frame, _ in walked)
    ours = any(PACKAGE in file.parents for file in files)
    return of_operator(call) and isinstance(error, Exception) and not ours


def problem(call: Call) -> str:
    """What comes of a call but a sound result or an allowed error; nothing if all is well."""
    start = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of units and pin splits
        if of_operator(call):
            warnings.simplefilter("ignore", RuntimeWarning)  # NumPy's, of an array of phasors
        try:
            answer = invoke(call)
            found = "" if of_operator(call) else unsound(answer)
        except cp.InputError as error:
            found = unclear(error)
        except ALLOWED:
            found = ""
        except TypeError as error:
            found = "" if by_python(error, call) else f"raised a bare TypeError: {shown(error)}"
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:
            found = (
                "" if by_operand(error, call) else f"raised {type(error).__name__}: {shown(error)}"
            )
    took = time.process_time() - start
    if took > PATIENCE:
        found += f" after {took:.1f} s"
    return found and f"{call!r} {found}"


def call_hostile(call: Call) -> None:
    assert not problem(call)


@st.composite
def damaged(draw: st.DrawFn, text: str) -> str:
    """An engine file with a piece of it replaced."""
    start = draw(st.integers(0, len(text)))
    end = draw(st.integers(start, min(len(text), start + 40)))
    piece = draw(
        st.one_of(
            st.text(max_size=20),
            st.sampled_from(["", "nan", "1e999", "-", "[[", "}}", '"', "9" * 500, "null", "\n"]),
            st.integers(0, len(text) - 10).map(lambda k: text[k : k + 10]),
        )
    )
    return text[:start] + piece + text[end:]


DAMAGED = st.tuples(damaged(TOML), damaged(JSON))


def read_damaged(texts: tuple[str, str]) -> None:
    """Each text is refused, or gives a sound engine that reads back."""
    doors = ((cp.Engine.from_toml, cp.Engine.to_toml), (cp.Engine.from_json, cp.Engine.to_json))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of units
        for (read, write), text in zip(doors, texts, strict=True):
            try:
                engine = read(text)
            except ValueError:
                continue
            assert not unsound(engine)
            assert read(write(engine)) == engine
