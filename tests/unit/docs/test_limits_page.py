"""The page of limits has the values of the code, and each limit's test exists."""

from __future__ import annotations

import runpy

from autograder.layout import ROOT

MADE = runpy.run_path(str(ROOT / "docs" / "limits_page.py"))


def test_the_page_has_the_values_that_the_code_keeps() -> None:
    assert MADE["PAGE"].read_text(encoding="utf-8") == MADE["current"](), "run `python docs/limits_page.py`"


def test_each_limit_names_a_file_of_tests() -> None:
    there = {path.stem for path in (ROOT / "tests").rglob("test_*.py")}
    assert {test for *_, test in MADE["rows"]()} <= there
