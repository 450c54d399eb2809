"""Skips tests that need an optional package which is not installed, and says which skips are right.

With ``CRANKPIN_NO_SKIPS=1`` in the environment any skip fails that ``ANYWHERE`` does not name.
"""

from __future__ import annotations

import importlib.util
import os
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Generator

    Report = pytest.CollectReport | pytest.TestReport

OPTIONAL = {
    *(
        "PIL",
        "anywidget",
        "cycler",
        "dask",
        "distributed",
        "exudyn",
        "h5py",
        "hypothesis",
        "jsonschema",
    ),
    *("matplotlib", "mpmath", "nbclient", "nbformat", "numba", "openpyxl", "pandas", "playwright"),
    *("pytest_mpl", "scipy", "sympy", "tqdm", "xarray"),
}
"""Packages without which crankpin works, and tests of other things run."""
ANYWHERE = (
    "CRANKPIN_FUZZ_SECONDS is not set",
    "Python has its lock",
    # LaTeX is 200 MB; its mathematics is parsed by matplotlib everywhere.
    "pdflatex is not installed",
    # In [bench]; .ci/run runs this test where the charts are drawn.
    "could not import 'numba'",
    # In [dev]; .ci/run runs this test where types are checked.
    "could not import 'mypy'",
    # .ci/run builds it and runs these tests where it does.
    "the core for browsers is not built",
    # In an environment of their own: packaging/torsional.txt.
    "could not import 'opentorsion'",
    "could not import 'ross'",
)
"""How reasons begin for which tests are skipped where everything of ``[test]`` is installed."""
NO_SKIPS = os.environ.get("CRANKPIN_NO_SKIPS") == "1"


def absent(error: BaseException | None) -> str | None:
    """Return the optional package that is not installed, if its import raised an error.

    Collectors and ``crankpin`` wrap what importing a module raised.
    """
    while error is not None and not isinstance(error, ModuleNotFoundError):
        error = error.__cause__
    package = (error.name or "").partition(".")[0] if error else ""
    missing = package in OPTIONAL and importlib.util.find_spec(package) is None
    return package if missing else None


def _judge(report: Report, raised: pytest.ExceptionInfo[BaseException] | None, file: str) -> None:
    """Turn a failure for want of a package into a skip, and a skip for no good reason into one."""
    if report.failed and raised and (package := absent(raised.value)):
        report.outcome = "skipped"
        report.longrepr = (file, 1, f"Skipped: {package} is not installed")
    if report.skipped and NO_SKIPS and isinstance(report.longrepr, tuple):
        reason = report.longrepr[2].removeprefix("Skipped: ")
        if not reason.startswith(ANYWHERE):
            report.outcome = "failed"
            report.longrepr = f"{file}: skipped, with CRANKPIN_NO_SKIPS=1: {reason}"


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Judge modules and folders."""
    report = yield
    _judge(report, report.call.excinfo if report.call else None, str(collector.path))
    return report


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Judge tests."""
    report = yield
    _judge(report, call.excinfo, item.location[0])
    return report
