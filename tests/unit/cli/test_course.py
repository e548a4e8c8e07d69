"""The command line: `autograder course sync|check`."""

from __future__ import annotations

import dataclasses
import json
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner, Result

from autograder import course_paths
from autograder.author.course.exceptions import CourseError
from autograder.author.course.tables import titles
from autograder.cli import course as command
from autograder.course_paths import Course
from autograder.exceptions import UsageError
from autograder.notebook import checking
from autograder.notebook.checking import CheckReport
from autograder.result.model import CheckResult
from autograder.suite import Check, Outcome, Visibility, suites
from tests.unit.course.notebooks import chapter, code, grade, notebook, prose, solution

CHECKS = (Check("named", "It has its name.", 2.0, "graph", Visibility.HIDDEN, (), None, (), ("runs",)),)

SUITE = 'PACKAGES = ("pkg",)\nMODULES = ()\n'
FILES = {
    "syllabus.yaml": "objectives:\n  graph: Graphs\n",
    "solutions/node.py": 'def main():\n    """Run."""\n    return 0\n',
    "solutions/pkg/package.xml": "<package><name>pkg</name></package>\n",
    "checks/ch01_small/hidden/__init__.py": SUITE,
    "checks/ch01_small/visible/__init__.py": SUITE,
    "checks/ch01_small/visible/hidden_titles.json": '[\n "It has its name."\n]\n',
    "checks/ch01_small/mutants.yaml": "file: pkg/package.xml\nmutants:\n"
    "- {id: other, title: other name, edits: [{find: <name>pkg, replace: <name>other}], check: named}\n",
}


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(suites, "hidden", lambda assignment: SimpleNamespace(checks=CHECKS, groups={"graph": 2.0}))
    monkeypatch.setattr(suites, "visible", lambda assignment: SimpleNamespace(checks=()))
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    origin = {"source": "node.py", "target": "ws/src/node.py", "hide": ["main"], "contract": {"runs": "Run."}}
    chapter(
        tmp_path,
        notebook(
            prose("# Title\n\n*5 minutes to read and run, 5 minutes for the exercises.*", "title"),
            code("", "node", course=origin, nbgrader=solution("node")),
            code("grade()", "g", course={"group": "graph"}, nbgrader=grade("g", 1)),
            objectives=[{"objective": "graph", "exercise": "title", "groups": ["graph"]}],
        ),
    )
    return tmp_path


def run(verb: str, *names: str) -> Result:
    return CliRunner().invoke(command.course, [verb, *names])


@pytest.mark.promise("`autograder course check` reports all mistakes in a chapter at once")
def test_course_check_names_all_findings_and_exits_with_1(course: Path) -> None:
    result = run("check")
    assert result.exit_code == 1
    assert "cell 'node': differs from solutions/node.py" in result.output
    assert "cell 'g': has 1 points, but the checks of 'graph' have 2" in result.output


@pytest.mark.promise("`autograder course sync` writes the text of cells with a `source`")
def test_course_check_finds_nothing_after_sync(course: Path) -> None:
    before = {path: path.read_bytes() for path in course.rglob("*") if path.is_file()}
    dry_run = run("sync", "--dry-run")
    assert dry_run.exit_code == 0
    assert "cell 'node': differs from solutions/node.py" in dry_run.output
    assert "cell 'g': has 1 points, but the checks of 'graph' have 2" in dry_run.output
    assert dry_run.output.endswith("01_small: 2 to update\n")
    assert {path: path.read_bytes() for path in course.rglob("*") if path.is_file()} == before
    assert run("sync").output == "01_small: 2 updated\n"
    checked = run("check")
    assert (checked.exit_code, checked.output) == (0, "")
    assert run("sync").output == "01_small: unchanged\n"


def test_an_error_that_sync_cannot_correct_is_raised(course: Path) -> None:
    (course / "solutions/node.py").write_text("def mian():\n    return 0\n")
    result = run("sync")
    assert isinstance(result.exception, CourseError)
    assert "01_small.ipynb, cell 'node': node.py: function 'main' occurs 0 times" in str(result.exception)


def test_a_chapter_that_does_not_exist_is_named_with_those_that_do(course: Path) -> None:
    result = run("check", "99_flying")
    assert isinstance(result.exception, UsageError)
    assert str(result.exception) == "there is no assignment '99_flying'; there are: 01_small"
    assert run("check", "01_small").exit_code == 1


@pytest.mark.promise("`autograder course tables` writes the list of hidden checks that students get")
def test_the_lists_of_hidden_checks_that_students_get_are_up_to_date() -> None:
    stale = [path for path, text in titles().items() if path.read_text(encoding="utf-8") != text]
    assert stale == [], "run `autograder course tables`"
    assert "The node is called robot_controller." in json.loads(course_paths.hidden_titles("02_nodes").read_text())


@pytest.mark.promise("After `check(...)` has passed, it lists the hidden checks")
@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_a_student_whose_visible_checks_all_pass_gets_the_list_of_hidden_checks(
    assignment: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    visible_titles = {check.title for check in suites.visible(assignment).checks}
    hidden_titles = [check.title for check in suites.hidden(assignment).checks if check.title not in visible_titles]
    passed = [
        dataclasses.asdict(CheckResult.of(visible_check, Outcome.PASSED))
        for visible_check in suites.visible(assignment).checks
    ]
    reply = {"diagnosis": {"kind": "ok"}, "checks": passed, "sources": [], "reads": [], "lasting": True}
    monkeypatch.setattr(checking, "run_in_worker", lambda *_, **__: nullcontext((reply, None)))
    report = checking.check(assignment)
    assert isinstance(report, CheckReport)
    lines = repr(report).splitlines()
    assert (
        lines[-len(hidden_titles) - 1]
        == f"After you submit, {len(hidden_titles)} more checks run with their own inputs:"
    )
    assert lines[-len(hidden_titles) :] == [f"- {title}" for title in hidden_titles]
