"""Does ``import crankpin`` load nothing that is not asked for, and lose no name by it?"""

from __future__ import annotations

import ast
import importlib
import pickle
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import crankpin as cp
import pytest
from crankpin import results

LOADED = "print(*(name for name in sys.modules if name.partition('.')[0] in ('crankpin', 'numpy')))"


def loaded(program: str) -> set[str]:
    """Return the modules of crankpin and NumPy that a program has imported at its end."""
    done = subprocess.run(  # noqa: S603 - this interpreter
        [sys.executable, "-c", f"import sys; {program}; {LOADED}"],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(done.stdout.splitlines()[-1].split())


def test_import_loads_neither_numpy_nor_any_analysis() -> None:
    names = ("", "._support", "._support.calls", "._support.interrupted", "._support.lazy")
    assert loaded("import crankpin") == {f"crankpin{name}" for name in names}
    assert loaded("import crankpin.results") == {f"crankpin{name}" for name in (*names, ".results")}


def test_a_balance_loads_what_it_needs() -> None:
    modules = loaded("import crankpin as cp; cp.Engine.preset('i4').balance(3000)")
    own = {name for name in modules if name.startswith("crankpin")}
    assert not [name for name in own if name.split(".")[1:2] in (["cli"], ["plot"], ["view"])]
    assert not [
        name for name in own if name.startswith("crankpin.analysis.") and name.count(".") > 2
    ]
    assert len(own) < 50  # of more than a hundred


def test_a_command_loads_no_other_command() -> None:
    modules = loaded("from crankpin.cli import main; main(['balance', 'i4'])")
    commands = {name for name in modules if name.startswith("crankpin.cli.")}
    shared = ("arguments", "naming", "options", "outputs")
    assert commands == {f"crankpin.cli.{name}" for name in (*shared, "shaking")}


def homes(module: ModuleType) -> dict[str, str]:
    """Return the names in the stub of a module, and the module each is from."""
    stub = Path(str(module.__file__)).with_suffix(".pyi")
    imports = ast.parse(stub.read_text(encoding="utf-8")).body
    return {
        name.name: str(node.module)
        for node in imports
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    }


@pytest.mark.parametrize("module", [cp, results], ids=lambda module: module.__name__)
def test_names_are_those_that_type_checkers_see(module: ModuleType) -> None:
    static = homes(module)
    assert sorted(static) == sorted(module.__all__)
    for name, home in static.items():
        assert getattr(module, name) is getattr(importlib.import_module(home), name)


def test_a_star_imports_every_public_name() -> None:
    names: dict[str, object] = {}
    exec("from crankpin import *", names)  # noqa: S102 - of this line
    assert {*names} - {"__builtins__"} == {*cp.__all__} == {*dir(cp)}


@pytest.mark.parametrize("module", [cp, results], ids=lambda module: module.__name__)
def test_other_names_are_attribute_errors(module: object) -> None:
    with pytest.raises(AttributeError, match="has no attribute 'nonsense'"):
        module.nonsense  # type: ignore[attr-defined] # noqa: B018
    assert not hasattr(module, "analysis_of_nothing")


def test_functions_and_results_are_pickled_where_nothing_is_loaded() -> None:
    pickled = pickle.dumps((cp.rank, cp.Engine.preset("i4").balance(3000, orders=[2])))
    program = f"import pickle; print(pickle.loads({pickled!r})[1][2].force.peak)"
    done = subprocess.run(  # noqa: S603 - this interpreter
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert float(done.stdout) == cp.Engine.preset("i4").balance(3000, orders=[2])[2].force.peak


FIRST = """
import importlib, sys, crankpin, crankpin.results
for home in sys.argv[1:]:
    for name in [name for name in sys.modules if name.startswith("crankpin.")]:
        if name != "crankpin._core":
            del sys.modules[name]
    importlib.import_module(home)
"""


@pytest.mark.slow
def test_any_module_may_be_the_first() -> None:
    modules = {*homes(cp).values(), *homes(results).values()} - {"crankpin._core"}
    assert len(modules) > 50
    subprocess.run([sys.executable, "-c", FIRST, *modules], check=True)  # noqa: S603 - this interpreter
