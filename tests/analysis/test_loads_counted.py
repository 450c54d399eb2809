"""Does every result say which loads it counts, once, where others could count?"""

from __future__ import annotations

import copy
import inspect
import pickle
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib.pyplot as plt
import numpy as np
import pytest
from crankpin.analysis.labelled import Labelled
from crankpin.cli import main, registered
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from matplotlib.figure import Figure

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
BARE = cp.Engine.preset("i4", cylinder=CYLINDER)
PETROL = cp.Cycle.example()
FIRED = BARE.with_cycle(PETROL)
LAME = BARE.with_cycle([PETROL, PETROL, None, PETROL])
WORDS = {
    "bare": (BARE, "without gas pressure"),
    "fired": (FIRED, "gas: example petrol, full load"),
    "lame": (LAME, "gas: example petrol, full load; cylinder 3 does not fire"),
}
SHAKER = cp.Actuator("shaker", (0, 0.1, 0), (0, 1, 0), force=100)


def mounted(engine: cp.Engine) -> cp.Powertrain:
    """The engine on three mounts."""
    places = {"a": (0.2, 0.0, 0.1), "b": (-0.2, 0.0, 0.1), "c": (0.0, 0.0, 0.4)}
    mounts = [cp.Mount(name, at, 2e5, loss_factor=0.1) for name, at in places.items()]
    return cp.Powertrain(engine, cp.RigidBody(100.0, (0.0, 0.1, 0.0), (7.0, 8.0, 4.5)), mounts)


RESULTS: dict[str, Any] = {
    "mounts": lambda e: mounted(e).response(3000),
    "point": lambda e: mounted(e).response(3000).at((0, 0.1, 0)),
    "on a moving base": lambda e: mounted(e).response(
        3000, orders=[1, 2], base=cp.BaseMotion({2: (0, 1e-5, 0)}, by="order")
    ),
    "mountings": lambda e: cp.compare_mounts(mounted(e), mounted(e), 3000),
    "cancellation": lambda e: mounted(e).response(3000).cancel(SHAKER, (0, 0.1, 0)),
    "driven": lambda e: mounted(e).response(3000).cancel(SHAKER, (0, 0.1, 0)).response,
    "mount designs": lambda e: mounted(e).designs([3000], {"a": {"stiffness": [1e5, 2e5]}}),
    "mount sweep": lambda e: mounted(e).sweep(
        [3000], factor=[0, 0.5], receivers={"seat": (0, 0.1, 0)}
    ),
    "mount design": lambda e: cp.design_mounts(
        mounted(e), vary="stiffness", bounds={"stiffness": (5e4, 5e5)}
    ),
    "balance": lambda e: e.balance(3000, orders=[1, 2]),
    "order": lambda e: e.balance(3000, orders=[1, 2])[2],
    "torque": lambda e: e.balance(3000, orders=[1, 2]).torque,
    "waveform": lambda e: e.waveform(3000, theta_deg=np.arange(0.0, 720.0, 10.0)),
    "sweep": lambda e: cp.sweep(e, rpm=[1000, 2000], orders=[1, 2]),
    "waveforms": lambda e: cp.sweep(e, rpm=[1000, 2000], orders=[1, 2]).waveform([0.0, 90.0]),
    "comparison": lambda e: cp.compare(e, e, 3000, orders=[1, 2]),
    "ranking": lambda e: cp.rank([e, e], rpm=3000, by="total.torque.peak", orders=[1, 2]),
    "bearings": lambda e: cp.bearing_loads(e, 3000, np.arange(0.0, 720.0, 10.0)),
    "rods": lambda e: cp.rod_loads(e, 3000),
    "operating map": lambda e: cp.operating_map(e, [1000, 3000]),
    "options": lambda e: cp.balancer_options(e, 3000, by="total.torque.peak", most_shafts=1),
    "excitation": lambda e: cp.torsional_excitation(e, 3000, orders=[1, 2]),
    "guide moments": lambda e: cp.guide_moments(e, 3000, orders=[1, 2]),
}
OF_GAS: dict[str, Any] = {
    "flywheel": lambda e: cp.flywheel(e, 3000, inertia=0.1),
    "star": lambda e: cp.star_diagram(e, [0.5, 2]),
}


OF_FORCES: dict[str, Any] = {
    "foundation table": lambda e: cp.foundation_table(e, 3000),
    "locomotive": lambda e: cp.Locomotive(
        e.cylinders[0], z=[-0.1, 0.1], throws_deg=[0, 90], wheel_z=[-0.3, 0.3]
    ).forces(3000),
}
"""Results that other loads change, and no pressure."""
OF_DESIGN: dict[str, Any] = {
    # Gas is left out: their parts are not made yet, or deviations would move the pressure.
    "designs": lambda e: cp.design(
        4,
        layout="inline",
        cylinder=CYLINDER,
        spacing=0.1,
        rpm=3000,
        by="total.torque.peak",
        count=1,
    ),
    "tolerances": lambda e: cp.tolerances(e, 3000, pin_deg=0.1, samples=20, orders=[1, 2]),
}
NOTHING_OF_GAS = {
    "Table",  # has its loads itself
    "ArrangementSearch", "BalanceShafts", "BobWeight", "Counterweights", "Match",
    "TwoPlaneCorrection",  # force and moment
    "Oscillogram", "PreparedTrace",  # the pressure itself
    "VanishingOrders", "Verdicts",  # which orders of either there are
    "Firing", "DeadCentres",  # angles; those that do not fire are named
    "MountModes", "MountRobustness", "RollAxes", "StaticState", "LoadCases",
    "AdaptiveLaw", "VelocityFeedback",  # of any load
    "Arrangement", "BalancerOption", "Choice", "Design",  # items of results that say it
    "OrderResponse", "WorstForce",  # parts of a response, which says it
    "Card", "ClosedForm",  # force and moment
    "FlywheelDisc", "FlywheelRim", "TurningMomentAreas",  # of a torque that is given
    "Exercise", "Explanation",  # sentences, which say it themselves
}  # fmt: skip
"""Results in tables that no pressure changes."""


def test_every_result_is_tested() -> None:
    """A class with a table says which loads it counts, or is one that gas does not change."""
    kinds = {name: getattr(cp.results, name) for name in dir(cp.results)}
    shown = {name for name, kind in kinds.items() if inspect.isclass(kind) and "table" in dir(kind)}
    silent = Labelled.loads_counted  # of labelled results that no load changes
    saying = {name for name in shown if getattr(kinds[name], "loads_counted", silent) is not silent}
    assert shown - saying == NOTHING_OF_GAS
    results = {type(of(FIRED)) for of in (RESULTS | OF_GAS | OF_FORCES).values()}
    results |= {type(of(BARE)) for of in OF_DESIGN.values()}
    assert {kind.__name__ for kind in results} == saying


def in_words(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."


@in_turn("engine", WORDS)
@in_turn("name", [*RESULTS, *OF_GAS, *OF_DESIGN])
def test_results_say_what_they_count(name: str, engine: str) -> None:
    if name in OF_GAS and engine == "bare":
        return  # neither is without a cycle, or knows any
    if name in OF_DESIGN and engine != "bare":
        return
    made, words = WORDS[engine]
    result = (RESULTS | OF_GAS | OF_DESIGN)[name](made)
    assert made.loads_counted == result.loads_counted == words
    assert repr(result).casefold().count(words.casefold()) == 1
    html = result._repr_html_() if hasattr(result, "_repr_html_") else None
    assert html is None or html.count(f"<p>{in_words(words)}</p>") == 1
    if hasattr(result, "to_pandas"):
        assert result.to_pandas().attrs["loads"] == words
    if hasattr(result, "to_xarray"):
        assert result.to_xarray().attrs["loads"] == words


@pytest.mark.parametrize("name", RESULTS)
def test_force_and_moment_alone_say_nothing(name: str) -> None:
    """Gas makes neither."""
    few: dict[str, Any] = {"orders": [1, 2], "torque": False}
    silent: dict[str, Callable[[], Any]] = {
        "balance": lambda: FIRED.balance(3000, **few),
        "order": lambda: FIRED.balance(3000, **few)[2],
        "torque": lambda: FIRED.balance(3000, orders=[1, 2]).moment,
        "waveform": lambda: FIRED.waveform(3000, theta_deg=[0.0], torque=False),
        "sweep": lambda: cp.sweep(FIRED, rpm=[1000, 2000], **few),
        "comparison": lambda: cp.compare(FIRED, BARE, 3000, **few),
        "ranking": lambda: cp.rank([FIRED, BARE], rpm=3000, by="total.moment.peak", orders=[1, 2]),
        "options": lambda: cp.balancer_options(FIRED, 3000, by="total.moment.peak", most_shafts=0),
    }
    if name in silent:
        result = silent[name]()
        assert result.loads_counted == ""
        assert "gas" not in repr(result).casefold()


@pytest.mark.parametrize("name", OF_FORCES)
def test_tables_of_forces_say_nothing_of_gas(name: str) -> None:
    result = OF_FORCES[name](FIRED)
    assert result.loads_counted == ""
    assert "gas" not in repr(result).casefold()


def test_a_foundation_table_says_which_loads_push_the_block() -> None:
    knock = cp.PeriodicLoad("knock", on="block", force={1: 10.0})
    table = cp.foundation_table(FIRED.with_loads([knock]), 3000)
    assert table.loads_counted == "loads: knock"
    assert repr(table).count("Loads: knock.") == 1


def test_a_spectrum_has_words_of_its_own() -> None:
    balance = FIRED.balance(3000, spectrum={1: 1.0, 2: 0.3})
    assert balance.loads_counted == "spectrum given"
    assert repr(balance).endswith("Spectrum given.")
    assert "spectrum given" in balance.plot().get_title(loc="left")
    plt.close("all")


def test_engines_that_differ_are_named() -> None:
    both = cp.sweep({"a": BARE, "b": FIRED}, rpm=[1000, 2000], orders=[1, 2])
    assert both.loads_counted == "without gas pressure (a); gas: example petrol, full load (b)"
    words = cp.compare(BARE, LAME, 3000, orders=[1]).loads_counted
    assert words.startswith("without gas pressure (before); gas: example petrol, full load; cyl")
    assert words.endswith("cylinder 3 does not fire (after)")


def test_further_loads_of_several_engines_are_all_named() -> None:
    """With and without gas, whatever they are called."""
    shake, knock = (
        cp.PeriodicLoad(name, on="block", force={1: 10.0}) for name in ("a; loads: b", "knock")
    )
    engines = {"x": FIRED.with_loads([shake]), "y": BARE.with_loads([knock])}
    swept = cp.sweep(engines, rpm=[1000, 2000], orders=[1, 2])
    further = "loads: a; loads: b (x); loads: knock (y)"
    assert swept.force.loads_counted == further
    assert cp.sweep(engines, rpm=1000, orders=[1], torque=False).loads_counted == further
    with_gas = "gas: example petrol, full load; loads: a; loads: b (x); "
    assert swept.loads_counted == f"{with_gas}without gas pressure; loads: knock (y)"
    assert swept.torque.loads_counted == swept.loads_counted
    one = engines["x"].balance(1000, orders=[1])
    assert one.force.loads_counted == "loads: a; loads: b"
    assert engines["x"].replace(name="z").loads_counted == engines["x"].loads_counted
    for same in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one)):  # noqa: S301 - its own
        assert same.force.loads_counted == one.force.loads_counted
    table = cp.CycleMap([1000, 3000], [0, 1], [[PETROL, PETROL]] * 2)
    mapped = cp.sweep(engines["y"], rpm=[1000, 2000], load=0.5, cycle=table, orders=[1, 2])
    assert mapped.loads_counted == "gas: cycle map; loads: knock"
    assert mapped.force.loads_counted == "loads: knock"


def test_cycles_without_names_and_maps() -> None:
    plain = cp.Cycle(PETROL.theta_deg, PETROL.pressure, degree=PETROL.degree)
    weak = cp.Cycle(plain.theta_deg, 0.9 * plain.pressure, degree=plain.degree)
    assert BARE.with_cycle(plain).loads_counted == "gas: unnamed cycle"
    assert BARE.with_cycle([plain, weak, None, None]).loads_counted == (
        "gas: 2 cycles; cylinders 3, 4 do not fire"
    )
    assert BARE.with_cycle([PETROL, weak, PETROL, PETROL]).loads_counted == (
        "gas: 2 cycles, example petrol, full load"
    )
    table = cp.CycleMap([1000, 3000], [0, 1], [[weak, PETROL]] * 2)
    swept = cp.sweep(BARE, rpm=[1000, 2000], load=0.5, cycle=table, orders=[1, 2])
    assert swept.loads_counted == "gas: cycle map"
    assert swept.sel(rpm=1000).loads_counted == "gas: 1000 rpm, load 0.5"


@pytest.mark.parametrize("engine", WORDS)
def test_pictures_of_torque_say_it_and_those_of_force_do_not(engine: str) -> None:
    made, words = WORDS[engine]
    pictures: dict[str, Any] = {
        "balance": lambda q: made.balance(3000, orders=[1, 2]).plot(quantity=q),
        "waveform": lambda q: made.waveform(3000).plot(quantity=q),
        "sweep": lambda q: cp.sweep(made, rpm=[1000, 2000], orders=[1, 2]).plot(quantity=q),
        "comparison": lambda q: cp.compare(made, made, 3000, orders=[1, 2]).plot(quantity=q),
    }
    for draw in pictures.values():
        for quantity, said in (("torque", 1), ("force", 0)):
            drawn = draw(quantity)
            assert text_of(drawn).count(words) == said
            plt.close("all")
    assert text_of(cp.bearing_loads(made, 3000).plot()).count(words) == 1
    if made.fired:
        assert text_of(cp.flywheel(made, 3000, inertia=0.1).plot()).count(words) == 1
        assert text_of(cp.star_diagram(made).plot()).count(words) == 1
    plt.close("all")


def text_of(drawn: Any) -> str:  # noqa: ANN401 - axes, or arrays of them
    """All titles of a figure, in one line."""
    figure: Figure = np.ravel(drawn)[0].get_figure(root=True)
    figure.draw_without_rendering()
    titles = [figure.get_suptitle(), *(ax.get_title(loc="left") for ax in figure.axes)]
    return " ".join(" ".join(titles).split())


def test_sentences_on_torque_say_it() -> None:
    bare = str(BARE.explain(3000))
    assert bare.count("183 N·m, without gas pressure.") == 1
    lame = str(LAME.explain(3000))
    assert lame.count("as pressure (example petrol, full load; cylinder 3 does not fire)") == 1
    assert "without gas" not in lame


COMMANDS_SAY = {
    "balance": "",
    "torque": "",
    "bearings": "",
    "rod-load": "",
    "explain": "",
    "sweep": "--rpm 1000:2000:500 --quantity torque",
    "rank": "--by total.torque.peak",
    "shafts": "--by total.torque.peak",
    "tolerances": "--pin 0.1 --samples 20 --orders 1,2",
    "mounts": "--rpm 3000:4000:500",
    "flywheel": "--inertia 0.1",
    "guide-moments": "--orders 1,2",
}
"""Command whose results gas pressure could change → its options."""
COMMANDS_SILENT = {
    "presets", "new", "gallery", "view",  # no results of an engine: the page says it itself
    "firing", "counterweights", "bob-weight", "card", "two-plane", "match", "closed-form",
    "harmonics", "foundation", "locomotive",  # force and moment, angles, masses
    "star", "trace", "exercise", "mounts-fit",  # a firing order, the pressure, sheets, modes
}  # fmt: skip


def test_every_command_is_tested() -> None:
    assert set(registered()) == COMMANDS_SAY.keys() | COMMANDS_SILENT | {"design", "compare"}


@in_turn("engine", WORDS)
@in_turn("name", COMMANDS_SAY)
def test_commands_say_what_they_count(
    name: str, engine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made, words = WORDS[engine]
    if engine == "bare" and name in ("torque", "bearings", "rod-load", "flywheel"):
        words = "gas: example petrol, full load"  # without another cycle
    if engine != "bare" and name == "tolerances":
        return  # which do not count gas
    file = tmp_path / f"{name}.toml"
    (mounted(made) if name == "mounts" else made).save(file)
    options = COMMANDS_SAY[name].split()
    assert main([name, str(file), *options]) == 0
    out, err = capsys.readouterr()
    if name == "explain":
        assert words.removeprefix("gas: ") in out
        return
    assert out.casefold().count(words.casefold()) == 1
    assert err == ""
    assert main([name, str(file), *options, "--csv"]) == 0
    out, err = capsys.readouterr()
    assert "gas" not in out.partition("\n")[2]  # below the heads: for programs
    assert err == f"crankpin: {words}\n"


def test_comparisons_say_that_they_are_without_gas(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "i4", "i4-crossplane"]) == 0
    assert capsys.readouterr().out.casefold().count("without gas pressure") == 1


@pytest.mark.parametrize("options", [[], ["--csv"]])
def test_designs_say_that_they_are_without_gas(
    options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    typed = ["design", "i3-two-stroke", "--by", "total.torque.peak", "--count", "1", *options]
    assert main(typed) == 0
    assert "".join(capsys.readouterr()).casefold().count("without gas pressure") == 1
