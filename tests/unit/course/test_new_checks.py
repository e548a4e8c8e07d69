"""The files that `autograder new` copies follow the rules for checks."""

from __future__ import annotations

import ast

import pytest

from autograder.course_paths import ROOT

NEW = ROOT / "assets" / "new" / "chapter" / "checks"


@pytest.mark.promise("Checks import everything from `autograder.checking`, and no other part of the autograder.")
def test_the_checks_of_a_new_chapter_import_no_other_part_of_the_autograder() -> None:
    imported = {
        node.module
        for path in NEW.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("autograder.")
    }
    other_modules = {name for name in imported if not name.startswith("autograder.checks.")}
    assert other_modules
    assert all(name.startswith("autograder.checking") for name in other_modules)
