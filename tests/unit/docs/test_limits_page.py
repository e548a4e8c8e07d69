"""Each limit on the page of limits has a test."""

from __future__ import annotations

import runpy

import pytest

from autograder.course_paths import ROOT

SCRIPT = runpy.run_path(str(ROOT / "docs" / "limits_page.py"))


@pytest.mark.promise("The resources that a submission may use, how each limit is enforced, and the file that tests it.")
def test_each_limit_names_a_file_of_tests() -> None:
    test_files = {path.stem for path in (ROOT / "tests").rglob("test_*.py")}
    assert {test for *_, test in SCRIPT["rows"]()} <= test_files
