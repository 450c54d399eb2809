"""Names of any characters: files keep them, terminals and spreadsheets do not obey them."""

from __future__ import annotations

import ast
import csv
import html
import inspect
import io
import re
import unicodedata
from functools import reduce
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import crankpin as cp
import pytest
import support.objects
from crankpin._support import labels
from crankpin._support.frames import Framed
from crankpin._support.tables import Column, Table
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support import in_turn
from support.engines import I4, V6

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

ENDS = "a\u0085b\u2028c\u2029d\x0be\x0cf\x1cg\rh\ni\r\nj"
"""Everything that ends a line somewhere."""
NASTY = f"red \x1b[31m\x07 \x9b2J \u202e{ENDS}"
NAMES = st.text(st.characters(exclude_categories=["Cs"]), max_size=30) | st.text(
    st.sampled_from("\u0085\u2028\u2029\x0b\x0c\x1c\x1b\r\n\t \"'\\#=[]ab"), max_size=12
)
many = settings(deadline=None, database=None, suppress_health_check=list(HealthCheck))


def stays(name: str, folder: Path) -> None:
    """Write an engine and a cycle of a name, and read them."""
    shaft = cp.Shaft(-1, [cp.Unbalance(0.01, 0.1)], x=0.1, name=name)
    engine = I4.replace(name=name, source=name).with_shafts([shaft])
    for ending in ("toml", "json"):
        file = folder / f"e.{ending}"
        engine.save(file)
        read = cp.Engine.load(file)
        assert read == engine
        assert (read.name, read.source, read.shafts[0].name) == (name, name, name)
    cycle = cp.Cycle.example().replace(name=name)
    for ending in ("csv", "tsv"):
        file = folder / f"c.{ending}"
        cycle.save(file)
        assert cp.Cycle.load(file) == cycle
        assert cp.Cycle.load(file).name == name


@pytest.mark.parametrize("name", [ENDS, NASTY, '"quoted"', '"', "  two  blanks ", '"""', "# x"])
def test_files_keep_names(name: str, tmp_path: Path) -> None:
    stays(name, tmp_path)


@many
@given(NAMES)
def test_files_keep_any_name(tmp_path_factory: pytest.TempPathFactory, name: str) -> None:
    stays(name, tmp_path_factory.mktemp("names", numbered=True))


RESULTS: dict[str, Callable[[str], Any]] = {
    "engine": lambda name: I4.replace(name=name),
    "explanation": lambda name: I4.replace(name=name).explain(3000),
    "shaft": lambda name: I4.with_shafts(
        [cp.Shaft(-1, [cp.Unbalance(0.01, 0.1)], x=0.1, name=name)]
    ),
    "ranking": lambda name: cp.rank({name: I4, "b": V6}, rpm=3000, by="total.force.peak"),
    "sweep": lambda name: cp.sweep({name: I4, "b": V6}, rpm=[1000, 2000]),
    "counterweights": lambda name: cp.counterweights(V6, planes={name: 0.0, "B": 0.1}),
    "comparison": lambda name: cp.compare(I4.replace(name=name), V6, 3000),
    "bearings": lambda name: cp.bearing_loads(I4.replace(name=name), 1000, [0.0, 1.0]),
    "cycle": lambda name: cp.Cycle.example().replace(name=name),
}


def harmless(text: str) -> bool:
    """Whether a terminal shows each character and obeys none but ends of lines and tabs."""
    return all(c in "\n\t" or c.isprintable() or unicodedata.category(c) == "Zs" for c in text)


@pytest.mark.parametrize("what", RESULTS)
def test_results_show_no_control_characters(what: str) -> None:
    result = RESULTS[what](NASTY)
    shown = [repr(result), str(result)]
    if table := getattr(result, "table", None):
        shown += [repr(table), table._repr_html_()]
        assert len(table.text().splitlines()) == len(table.text().split("\n"))
    for text in shown:
        assert harmless(text), [c for c in text if not harmless(c)]


@pytest.mark.parametrize("what", ["engine", "shaft", "ranking", "sweep", "counterweights"])
def test_pictures_of_any_name_are_xml(what: str) -> None:
    pytest.importorskip("matplotlib")
    from matplotlib import pyplot as plt

    figure = RESULTS[what](NASTY).plot()
    figure = getattr(figure, "flat", [figure])[0].get_figure(root=True)
    with plt.rc_context({"svg.fonttype": "none"}):
        file = io.BytesIO()
        figure.savefig(file, format="svg")
    plt.close(figure)
    ET.fromstring(file.getvalue().decode())  # noqa: S314 - ours


@many
@given(NAMES)
def test_a_table_shows_no_control_characters(name: str) -> None:
    column = Column(name, (name, "b"), name)
    table = Table(name, (column,), note=name)
    for text in (table.text(), table.html(), labels.one_line(name)):
        assert harmless(text)


ERRORS: dict[str, Callable[[], object]] = {
    "choices": lambda: cp.sweep({NASTY: I4, "b": I4}, rpm=[1, 2]).sel(engine="c"),
    "nearest": lambda: cp.Engine.preset(NASTY),
    "TOML": lambda: cp.Engine.from_toml('schema = 1\n"\\u001b[2J\\u0085" = 3\n'),
    "TOML, broken": lambda: cp.Engine.from_toml(f"schema = {NASTY}"),
    "JSON": lambda: cp.Engine.from_json('{"schema": 1, "\\u001b[2J": 3}'),
    "firing order": lambda: I4.firing(NASTY),
    "plane": lambda: cp.counterweights(V6, planes={NASTY: 1e40}),
    "bank": lambda: V6.with_bank_angle(90, hold=NASTY),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("what", ERRORS)
def test_errors_show_no_control_characters(what: str) -> None:
    with pytest.raises(cp.InputError) as raised:
        ERRORS[what]()
    assert harmless(str(raised.value))


@in_turn(
    "text",
    [
        *('=HYPERLINK("https://a.example";"b")', "+1+1", "-2+3", "@SUM(1)", "\t=1", "\r=1", " =1"),
        *("\n=1", "＝1", "-", "--1", "=", "1-3-4-2", "a=b", "-1.5", "+2", "-1e-3", "x", "", "–"),
    ],
)
def test_spreadsheets_run_no_text_of_csv(text: str) -> None:
    table = Table("t", (Column(text, (text, -1.5, 2, -0.25)), Column("n", (1.0, 2.0, 3.0, 4.0))))
    head, *rows = csv.reader(io.StringIO(table.to_csv(), newline=""))
    number = text in ("-1.5", "+2", "-1e-3")
    runs = text.strip()[:1] in tuple("=+-@＝") and not number
    mark = "'" if runs else ""
    shown = text.replace("\r", " ")
    assert (head[0], rows[0][0]) == (mark + text.strip(), mark + shown)
    assert [float(row[0]) for row in rows[1:]] == [-1.5, 2.0, -0.25]


def test_spreadsheets_run_no_name_of_an_engine() -> None:
    name = '=HYPERLINK("https://a.example")'
    found = cp.rank({name: I4, "b": I4}, rpm=3000, by="total.force.peak").table.to_csv()
    assert f"'{name}" in {cell for row in csv.reader(io.StringIO(found)) for cell in row}


# --- names that look like figures, formulas and markup --------------------------------------------


class Renamed(ast.NodeTransformer):
    """The objects of the tests, each engine, cycle, mount and so on with a longer name."""

    def __init__(self, objects: ast.Module, addition: str) -> None:
        self.addition = addition
        self.names: set[object] = set()
        for call in ast.walk(objects):
            if isinstance(call, ast.Call) and (path := self.path(call)):
                first = call.args[:1]
                if first and isinstance(first[0], ast.Dict):  # engines by name
                    first = [key for key in first[0].keys if key is not None]
                elif path.count(".") > 1 or self.place_of_name(path) != 0:
                    first = []
                first += [option.value for option in call.keywords if option.arg == "name"]
                self.names |= {text.value for text in first if isinstance(text, ast.Constant)}

    @staticmethod
    def path(call: ast.Call) -> str:
        """Return the name of a function of crankpin; empty for others."""
        path = ast.unparse(call.func)
        return path if re.fullmatch(r"cp(\.\w+)+", path) else ""

    @staticmethod
    def place_of_name(path: str) -> int | None:
        """Return the place of the name among the parameters of a function."""
        function: Any = reduce(getattr, path.split(".")[1:], cp)
        parameters = inspect.signature(function).parameters
        return [*parameters].index("name") if "name" in parameters else None

    def visit_Constant(self, node: ast.Constant) -> ast.Constant:
        renamed = isinstance(node.value, str) and node.value in self.names
        return ast.Constant(f"{node.value!s} {self.addition}") if renamed else node

    def visit_Call(self, node: ast.Call) -> ast.Call:
        self.generic_visit(node)
        name, path = ast.keyword("name", ast.Constant(self.addition)), self.path(node)
        if path in ("cp.Engine.preset", "cp.Cycle.example"):
            return ast.Call(ast.Attribute(node, "replace", ast.Load()), [], [name])
        place = self.place_of_name(path) if path else None
        if place is not None and place >= len(node.args):
            node.keywords += [name] * all(option.arg != "name" for option in node.keywords)
        return node


def objects_named(addition: str) -> Mapping[str, Any]:
    """Return the objects of the tests, with names that end so."""
    objects = ast.parse(Path(support.objects.__file__).read_text(encoding="utf8"))
    renamed = ast.fix_missing_locations(Renamed(objects, addition).visit(objects))
    namespace: dict[str, Any] = {"__name__": "support.objects_renamed"}
    exec(compile(renamed, "objects", "exec"), namespace)  # noqa: S102 - ours
    found: Mapping[str, Any] = namespace["OBJECTS"]
    return found


def texts(value: object) -> list[str]:
    """Return all that is shown of an object as text."""
    written = [repr(value), str(value)]
    if isinstance(value, Framed):
        for frame in value.frames.values():
            written += [frame.text(), html.unescape(frame.html())]
    return written


LIKE_FIGURES = ("Run 7: rod 0.145 m", "5 N·m, (1, 2) kg", "<b>%s {x} 1 to 2 bar, N")


@pytest.mark.parametrize("name", LIKE_FIGURES)
def test_units_change_no_name(name: str) -> None:
    """A name stands in every text as often, letter by letter, whatever units are set."""
    seen = set()
    for what, value in objects_named(name).items():
        plain = [text.count(name) for text in texts(value)]
        if any(plain):
            seen.add(what)
        for setting in ("lb, in, lbf, psi", "g, mm, kN, bar", "oz·in"):
            with cp.units(setting):
                assert [text.count(name) for text in texts(value)] == plain, (what, setting)
    assert len(seen) > 60, sorted(seen)
