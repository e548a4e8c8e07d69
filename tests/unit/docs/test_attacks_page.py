"""Each attack has a test, and each submission and test that the page names exists."""

from __future__ import annotations

import re
import runpy

from autograder.author.verification.cases import attacks
from autograder.course_paths import ROOT
from autograder.suite import suites

SCRIPT = runpy.run_path(str(ROOT / "docs" / "attacks_page.py"))
ROWS = SCRIPT["ROWS"]


def test_each_attack_has_a_test() -> None:
    assert len(ROWS) == 49
    assert all(row["tests"] for row in ROWS)


def test_each_test_that_the_table_names_exists() -> None:
    for row in ROWS:
        for file, names in row["tests"].items():
            defined = set(re.findall(r"^def (test_\w+)", (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE))
            assert set(names) <= defined, file


def test_the_table_names_exactly_the_attacks_of_the_verification() -> None:
    named = {name for row in ROWS for name in row["submissions"]}
    ids = [attack.id for assignment in suites.graded_assignments() for attack in attacks(assignment)]
    assert named == set(ids)
    assert len(ids) == len(set(ids))
