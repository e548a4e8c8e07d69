"""An edit that makes Python unreadable is found, unless the mutant is meant to be unreadable."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder import course_paths
from autograder.author.course.mutant_rules import mutants_findings, unknown_records
from autograder.course_paths import Course

NODE = "guard/guard/node.py"
TEXT = "def main():\n    print('on guard')\n"
ENTRY = "  - {id: loud, title: t, check: quiet, edits: [EDIT]}\n"
UNREADABLE = "{find: 'main():', replace: 'main()'}"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a chapter's checks, in a course with a small reference."""
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    (tmp_path / "solutions" / NODE).parent.mkdir(parents=True)
    (tmp_path / "solutions" / NODE).write_text(TEXT)
    checks = tmp_path / "checks" / "ch01_small"
    checks.mkdir(parents=True)
    return checks


def found(folder: Path, edit: str, entry: str = ENTRY) -> list[str]:
    (folder / "mutants.yaml").write_text(f"file: {NODE}\nmutants:\n" + entry.replace("EDIT", edit))
    return [str(finding) for finding in mutants_findings(folder, ["quiet"], ["guard"])]


@pytest.mark.parametrize("edit", [UNREADABLE, '{write: "def main()\\n"}'])
def test_an_edit_that_makes_python_unreadable_is_found_with_its_line(folder: Path, edit: str) -> None:
    assert found(folder, edit) == [
        f"checks/ch01_small/mutants.yaml:3: after this edit, {NODE} is not Python: expected ':' in line 1. Correct it, "
        "or, if students make this error, say in `reason` of the mutant that it is intended"
    ]


def test_only_the_result_of_all_edits_has_to_be_python(folder: Path) -> None:
    assert found(folder, UNREADABLE + ", {find: main(), replace: 'run():'}") == []
    assert found(folder, UNREADABLE + ", {delete: true}") == []


def test_another_file_than_python_may_have_any_text(folder: Path) -> None:
    assert found(folder, "{file: guard/package.xml, write: <package}") == []


def test_an_edit_that_does_not_match_is_reported_alone(folder: Path) -> None:
    (message,) = found(folder, "{find: 'start(', replace: 'end('}")
    assert "occurs nowhere" in message


def test_a_mutant_with_a_reason_may_be_unreadable(folder: Path) -> None:
    assert found(folder, UNREADABLE, ENTRY.replace("check:", "reason: it cannot be read, check:")) == []


def test_a_mutant_that_is_recorded_not_to_run_may_be_unreadable(folder: Path) -> None:
    snapshot = folder / "mutants.snapshot.yaml"
    snapshot.write_text("loud: {diagnosis: syntax_error, fails: all}\n")
    assert found(folder, UNREADABLE) == []
    snapshot.write_text("loud: [quiet]\n")
    assert len(found(folder, UNREADABLE)) == 1


def test_a_record_of_an_unknown_mutant_does_not_prevent_the_verification_that_removes_it(folder: Path) -> None:
    (folder / "mutants.snapshot.yaml").write_text("loud: [quiet]\nlord: [quiet]\n")
    assert found(folder, "{find: on guard, replace: on duty}") == []
    assert [str(finding) for finding in unknown_records(folder)] == [
        "checks/ch01_small/mutants.snapshot.yaml:2: mutants.yaml has no mutant `lord`: correct its `id` there, or "
        "remove this record by `autograder verify --assignment 01_small --record`"
    ]


def test_records_of_several_unknown_mutants_are_one_finding(folder: Path) -> None:
    (folder / "mutants.snapshot.yaml").write_text("loud: [quiet]\nlord: [quiet]\ncloud: [quiet]\n")
    assert found(folder, "{find: on guard, replace: on duty}") == []
    (finding,) = unknown_records(folder)
    assert str(finding).endswith(
        "snapshot.yaml:2: mutants.yaml has no mutant `lord`, `cloud`: correct its `id` there, or remove these records "
        "by `autograder verify --assignment 01_small --record`"
    )
