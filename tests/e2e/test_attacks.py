"""No attack gains a point, sees a hidden check, or stops the grader.

The checks that drive through a world take most of a grading. They are run for the attacks that must lose one of them,
and for all attacks by `make verify`.
"""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest

from autograder import feedback, layout
from autograder.checks import suites
from autograder.checks.ch02_nodes.attack_payloads import CANARY
from autograder.checks.ch02_nodes.attacks import ASSIGNMENT, all_checks, attacks
from autograder.grading import grade_submission
from autograder.grading.job import Scope
from autograder.grading.pipeline import NOTEBOOK
from autograder.grading.submitted_notebook import grade_id
from autograder.proof.claims import Attack
from autograder.result import Result
from autograder.sandbox import cgroup

ATTACKS = attacks()
DRIVES = frozenset({"room", "pillars", "corridor"})


def _hidden_text() -> set[str]:
    """Return lines that stand in the hidden suite only: whoever prints one of them has read it."""
    lines = {
        line.strip()
        for path in suites.hidden(ASSIGNMENT).files
        for line in path.read_text().splitlines()
        if line.startswith(("def ", "    expect", "        expect")) and len(line.strip()) > 30
    }
    public = (path for name in ("support", "visible") for path in layout.CHECKS.glob(f"ch*/{name}/*.py"))
    shown = "\n".join(path.read_text() for path in public)
    return {line for line in lines if line not in shown}


def _everything_written(out: Path) -> str:
    """Return the text of every file that grading and feedback left."""
    texts = (path.read_text(errors="replace") for path in out.rglob("*") if path.suffix in (".json", ".html", ".ipynb"))
    return "\n".join(texts)


def _grade(attack: Attack, checks: frozenset[str], folder: Path) -> Result:
    attack.write(folder / "work")
    submission = folder / "work" / "submission"
    path = submission if submission.is_dir() else folder / "work"
    scope, out = Scope(only=suites.hidden(ASSIGNMENT).with_dependencies(*checks)), folder / "out"
    return grade_submission(path, ASSIGNMENT, student="mallory", seed=2026, out=out, scope=scope)


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.id)
def test_an_attack_gains_no_point_and_learns_nothing(
    attack: Attack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if attack.id == "fork bomb" and "pids" not in cgroup.bounds():
        pytest.skip("root without control groups: a fork bomb stops the machine")
    monkeypatch.setenv("SECRET_OF_THE_GRADER", CANARY)
    checks = all_checks() - (DRIVES - attack.loses)
    result = _grade(attack, checks, tmp_path)
    assert attack.verify(result, checks) == ""

    feedback.write(result, tmp_path / "out")
    written = _everything_written(tmp_path / "out")
    assert "STOLEN /" not in written  # the notebook's own source says "STOLEN", and a comma
    assert f"SECRET_OF_THE_GRADER={CANARY}" not in written
    assert not {line for line in _hidden_text() if line in written}

    if (tmp_path / "out" / NOTEBOOK).is_file():
        notebook = nbformat.read(tmp_path / "out" / NOTEBOOK, as_version=4)
        source = nbformat.read(layout.source_notebook(ASSIGNMENT), as_version=4)
        graded_cells = [cell for cell in notebook.cells if grade_id(cell)]
        wanted = {grade_id(cell): cell for cell in source.cells if grade_id(cell)}
        assert sorted(map(grade_id, graded_cells)) == sorted(wanted)
        for cell in graded_cells:
            assert cell.metadata.nbgrader == wanted[grade_id(cell)].metadata.nbgrader
            assert not cell.metadata.nbgrader.locked or cell.source == wanted[grade_id(cell)].source


def test_there_is_hidden_text_to_look_for() -> None:
    assert len(_hidden_text()) > 20
