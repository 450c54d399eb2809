"""Skips tests that need a package which is not installed, so that the others run with NumPy alone.

Only what is absent is skipped: an ImportError of crankpin counts if it names the extra to install,
any other one if a test or ``crankpin.plot`` raised it, for the rest has to import without extras.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import crankpin
import pytest

if TYPE_CHECKING:
    from collections.abc import Generator

PACKAGE = Path(crankpin.__file__).parent


def absent(error: BaseException | None) -> str | None:
    """Return which package is not installed, if that is what an error says."""
    while error is not None and not isinstance(error, ImportError):
        error = error.__cause__  # collectors wrap what importing a module raised
    if error is None:
        return None
    if 'pip install "crankpin[' in str(error):
        return str(error)
    frame = error.__traceback__
    while frame is not None and frame.tb_next is not None:
        frame = frame.tb_next
    folders = Path(frame.tb_frame.f_code.co_filename).parents if frame else [PACKAGE]
    if isinstance(error, ModuleNotFoundError) and (
        PACKAGE not in folders or PACKAGE / "plot" in folders
    ):
        return str(error)
    return None


def _skip(
    report: pytest.CollectReport | pytest.TestReport,
    place: tuple[str, int | None],
    raised: pytest.ExceptionInfo[BaseException] | None,
) -> None:
    if report.failed and raised and (reason := absent(raised.value)):
        report.outcome = "skipped"
        report.longrepr = (place[0], (place[1] or 0) + 1, f"Skipped: {reason}")


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Skip modules and folders whose imports need an extra."""
    report = yield
    _skip(report, (str(collector.path), None), report.call.excinfo)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Skip tests that call what needs an extra."""
    report = yield
    _skip(report, item.location[:2], call.excinfo)
    return report
