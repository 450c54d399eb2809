"""Fixtures and hooks of all tests."""

from support.building import open_workbench, workbench
from support.chromium import browser, open_engine, open_file
from support.core_in_page import ask, core_page
from support.extras import pytest_make_collect_report, pytest_runtest_makereport

__all__ = [
    "ask",
    "browser",
    "core_page",
    "open_engine",
    "open_file",
    "open_workbench",
    "pytest_make_collect_report",
    "pytest_runtest_makereport",
    "workbench",
]
