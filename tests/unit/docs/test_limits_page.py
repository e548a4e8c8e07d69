"""Each limit on the page of limits has a test."""

from __future__ import annotations

import runpy

import pytest

from autograder.layout import ROOT

MADE = runpy.run_path(str(ROOT / "docs" / "limits_page.py"))


@pytest.mark.promise("What a submission may use, what keeps the limit, and where that is tested.")
def test_each_limit_names_a_file_of_tests() -> None:
    there = {path.stem for path in (ROOT / "tests").rglob("test_*.py")}
    assert {test for *_, test in MADE["rows"]()} <= there
