"""Calls with hostile values, and what is wrong with what they return."""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import os
import pickle
import re
import time
import traceback
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import crankpin as cp
import numpy as np
from hypothesis import strategies as st

from fuzzing.kinds import Beside
from fuzzing.sound import CURE, JSON, TOML
from fuzzing.surface import CLASSES, Call, Target, candidates, is_needed, properties, shown, sound
from fuzzing.values import VALUES

SECONDS = float(os.environ.get("CRANKPIN_FUZZ_SECONDS", "0"))
HERE = Path(__file__).parent
PACKAGE = Path(cp.__file__).parent
PATIENCE = 5.0  # seconds of processors to a call: the longest honest one takes a twentieth of one
ALLOWED = (cp.InputError, OSError, ImportError)


@st.composite
def calls(draw: st.DrawFn, among: list[Target]) -> Call:
    """A call with up to three arguments bad and the others good or left out."""
    target = draw(st.sampled_from(among))
    subject: Any = draw(st.sampled_from(target.subjects()))
    parameters = [p for p in target.parameters if p.kind is not p.VAR_KEYWORD]
    count = draw(st.integers(1, 3))
    bad = {draw(st.integers(0, max(len(parameters) - 1, 0))) for _ in range(count)}
    known = sound(target)
    arguments = dict(known.arguments) if known else {}
    for k, parameter in enumerate(parameters):
        good = [each for each in candidates(target, parameter) if not isinstance(each, Beside)]
        if k in bad or (is_needed(parameter) and not good):
            arguments[parameter.name] = draw(VALUES)
        elif good and draw(st.sampled_from([True, False])):
            arguments[parameter.name] = draw(st.sampled_from(good))
    return Call(target, subject, arguments)


def finite(value: Any) -> bool:
    """Whether all figures in it are, down through tuples and mappings."""
    if isinstance(value, float | complex | np.ndarray | np.generic):
        array = np.asarray(value)
        return array.dtype.kind not in "fc" or bool(np.isfinite(array).all())
    if isinstance(value, Mapping):
        value = tuple(value.values())
    return not isinstance(value, tuple) or all(finite(each) for each in value)


def undefined(value: Any) -> set[str]:
    """Names of the figures of an object, or "" of a figure itself, that are not finite."""
    if type(value) not in CLASSES.values():
        return set() if finite(value) else {""}
    names = set()
    for name in properties(type(value)):
        try:
            figure = getattr(value, name)
        except cp.InputError as error:
            assert len(str(error)) > CURE  # noqa: PT017 - either is right
            continue
        if not finite(figure):
            names.add(name)
    return names


def unsound(value: Any) -> str:
    """What is wrong with a result: figures not finite, an engine that does not read back."""
    if type(value) not in CLASSES.values() and not finite(value):
        return f"returned {shown(value)}"
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


def by_python(error: TypeError, call: Call) -> bool:
    """Whether Python itself raised it, of a call's arguments; or a function that was given."""
    if any(callable(value) for value in call.arguments.values()):
        return True
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    return last is not None and Path(last.tb_frame.f_code.co_filename).parent == HERE


def problem(call: Call, changed: str = "") -> str:
    """What comes of a call but a sound result or an allowed error; nothing if all is well.

    ``changed`` is the argument that is not sound, which an error must name.
    """
    start = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of units and pin splits
        try:
            answer = call.make()
            found = unsound(answer)
            is_number = changed and not is_nan(call.arguments[changed])
            if not found and changed and not is_number and call.target.label not in TAKE_NAN:
                found = f"took a number that is none and returned {shown(answer)}"
        except cp.InputError as error:
            found = unclear(error)
            if not found and changed and not names(call.target, changed, str(error)):
                found = f"raised an error that does not name {changed}: {shown(str(error))}"
        except ALLOWED:
            found = ""
        except TypeError as error:
            found = "" if by_python(error, call) else f"raised a bare TypeError: {shown(error)}"
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:
            found = f"raised {type(error).__name__}: {shown(error)}"
    took = time.process_time() - start
    if took > PATIENCE:
        found += f" after {took:.1f} s"
    return found and f"{call!r} {found}"


TAKE_NAN = {"Sweep.at_minimum"}
"""Targets that leave out numbers that are none, as their docstrings say."""
DERIVED = {
    "throws_deg": "number of cylinders",
    "bank_deg": "number of cylinders",
    "spacing": "z",
    "quantities": "quantity",
    "reference_z": "z",
    "point": "reference_z",
    "z": "reference_z",
    "text": "units|engine file",
    "frequency": "rpm",
    "piston_mass": "reciprocating_mass",
    "stroke": "crank_radius",
    "planes": "counterweights",
    "balanced_to": "counterweights",
    "ratios": "shafts",
    "shaft_orders": "shafts",
    "recorded_rpm": "theta_deg",
    "tdc_deg": "theta_deg",
    "loss_angle_deg": "theta_deg",
    "heat": "pressure",
    "intake_pressure": "pressure",
    "to_crankpin": "inertia",
}
"""Arguments, and what is made of them where an error names that."""
BESIDE = {
    # Contents of a file as it is read: the error names the file, its line and its column.
    ("load", "columns"): "path",
    ("load", "recorded_rpm"): "path",
    ("load_cylinders", "columns"): "path|tdc_deg",
    ("load_cylinders", "recorded_rpm"): "path",
    # Arguments of which one does not fit the other: either may be the wrong one.
    ("CycleMap", "rpm"): "cycles",
    ("PeriodicLoad", "rpm"): "force|torque",
    ("from_samples", "rpm"): "force|torque",
    ("Receptance", "coordinates"): "table",
    ("compressor", "discharge"): "clearance",
    ("compressor", "suction"): "clearance",
    ("Traces", "theta_deg"): "pressure",
    ("flywheel", "rpm"): "inertia",
    ("flywheel", "drive"): "load_torque",
    ("flywheel_rim", "mean_diameter"): "width_ratio",
    ("stroke_load", "period_deg"): "duration_deg",
    ("oscillogram", "source"): "pressure|encoder|index|time",
    ("oscillogram", "pulses"): "encoder",
    ("oscillogram", "strokes"): "pressure",
    ("oscillogram", "sheet"): "source",
    ("sweep", "rod_ratio"): "rtol",
    ("wiebe", "intake_closes_deg"): "start_deg",
}
"""Last part of a target and its argument, and what an error may name instead."""


def names(target: Target, changed: str, message: str) -> bool:
    """Whether a message names the argument that was changed, or what is made of it."""
    beside = BESIDE.get((target.label.rpartition(".")[2], changed))
    words = filter(None, [changed, DERIVED.get(changed), beside])
    return re.search(rf"\b({'|'.join(words)})\b", message) is not None


def of_operator(of: Callable[..., Any], *operands: Any) -> str:
    """What an operator raises but what Python and the value beside it do."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # NumPy's, of an array of phasors
        try:
            of(*operands)
        except (cp.InputError, TypeError):
            return ""
        except Exception as error:
            walked = traceback.walk_tb(error.__traceback__)
            files = (Path(frame.f_code.co_filename) for frame, _ in walked)
            # Masked arrays and fractions take an operand of any type, and fail in their own ways.
            if len(operands) > 1 and not any(PACKAGE in file.parents for file in files):
                return ""
            return f"raised {type(error).__name__}: {shown(str(error))}"
    return ""


def is_nan(value: Any) -> bool:
    """Whether a value is a number that is none, or a list of one."""
    if isinstance(value, list):
        return any(map(is_nan, value))
    if isinstance(value, (float, complex, np.ndarray, np.generic)):
        array = np.asarray(value)
        return array.dtype.kind in "fc" and bool(np.isnan(array).any())
    return False


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
