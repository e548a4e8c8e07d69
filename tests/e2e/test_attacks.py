"""No attack gains a point, sees a hidden check, or stops the grader.

Each attack is graded by the checks that it must fail. Attacks on 02 are graded by all checks, with two exceptions: the
drives through a world, which take most of a grading, and an attack that makes each check wait. `make verify` grades
every attack by all checks.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import nbformat
import pytest

from autograder import course_paths
from autograder.author.verification.cases import attacks
from autograder.author.verification.leaks import STOLEN, hidden_text_in, texts_of
from autograder.author.verification.payloads import CANARY
from autograder.author.verification.verdicts import Attack, hidden_lines
from autograder.checks.ch02_nodes.attacks import CHAPTER
from autograder.grade import grade_submission
from autograder.grade.job import Job, Options
from autograder.grade.store import NOTEBOOK
from autograder.grade.submitted_notebook import grade_id
from autograder.report import feedback
from autograder.result.model import Result
from autograder.run.sandbox import cgroup
from autograder.suite import suites

DRIVES = frozenset(check.id for check in suites.hidden("02_nodes").checks if check.group == "worlds")
STALLS = frozenset({"forged protocol"})  # each check waits 15 s for the messages that it claims and never sends
# The same attacks as "slow in real time" and 02's "circling robot"; they take minutes on a busy machine.
NIGHTLY = frozenset({"hasty in real time", "seldom in real time", "fixed in real time", "circling driver"})


def _attacks() -> Iterator[object]:
    """Yield each attack with its assignment, as parameters of a test."""
    for assignment in suites.graded_assignments():
        for attack in attacks(assignment):
            marks = [pytest.mark.nightly] if attack.id in NIGHTLY else []
            yield pytest.param(assignment, attack, id=f"{assignment} {attack.id}", marks=marks)


def _everything_written(out: Path) -> str:
    """Return the text of every file that grading and feedback wrote."""
    texts = (path.read_text(errors="replace") for path in out.rglob("*") if path.suffix in (".json", ".html", ".ipynb"))
    return "\n".join(texts)


def _grade(assignment: str, attack: Attack, checks: frozenset[str], folder: Path) -> Result:
    attack.write(folder / "work")
    submission = folder / "work" / "submission"
    path = submission if submission.is_dir() else folder / "work"
    options = Options(only=suites.hidden(assignment).with_dependencies(*checks))
    return grade_submission(Job(path, assignment, "mallory", 2026, folder / "out", options=options))


@pytest.mark.promise("No attack gains a point.")
@pytest.mark.parametrize(("assignment", "attack"), _attacks())
def test_an_attack_gains_no_point_and_learns_nothing(
    assignment: str, attack: Attack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if attack.id == "fork bomb" and "pids" not in cgroup.bounds():
        pytest.skip("root without control groups: a fork bomb stops the machine")
    monkeypatch.setenv("SECRET_OF_THE_GRADER", CANARY)
    uses_all_checks = assignment == CHAPTER.assignment and attack.id not in STALLS
    checks = CHAPTER.checks - (DRIVES - attack.fails) if uses_all_checks else attack.fails
    result = _grade(assignment, attack, checks, tmp_path)
    assert attack.verify(result, checks) == ""

    feedback.write(result, tmp_path / "out")
    written = _everything_written(tmp_path / "out")
    assert STOLEN not in written  # in the notebook's own source, a comma follows the word
    assert f"SECRET_OF_THE_GRADER={CANARY}" not in written
    assert not [word for text in texts_of(tmp_path / "out") for word in hidden_text_in(text, hidden_lines(assignment))]

    if (tmp_path / "out" / NOTEBOOK).is_file():
        notebook = nbformat.read(tmp_path / "out" / NOTEBOOK, as_version=4)
        source = nbformat.read(course_paths.source_notebook(assignment), as_version=4)
        graded_cells = [cell for cell in notebook.cells if grade_id(cell)]
        source_cells = {grade_id(cell): cell for cell in source.cells if grade_id(cell)}
        assert sorted(map(grade_id, graded_cells)) == sorted(source_cells)
        for cell in graded_cells:
            assert cell.metadata.nbgrader == source_cells[grade_id(cell)].metadata.nbgrader
            assert not cell.metadata.nbgrader.locked or cell.source == source_cells[grade_id(cell)].source


def test_the_list_of_hidden_texts_is_not_empty() -> None:
    for assignment in suites.graded_assignments():
        assert len(hidden_lines(assignment)) > 20, assignment
