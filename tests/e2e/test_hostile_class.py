"""Attackers in a class do not change the results of others, and leave nothing on the machine."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from functools import partial
from itertools import cycle, islice
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook

from autograder.author.verification.cases import cases
from autograder.author.verification.verdicts import Attack, CaseKind, first_sentence
from autograder.checks.ch02_nodes.attack_payloads import PACKAGE
from autograder.checks.ch02_nodes.attacks import CHAPTER, CONTROLLER, WRITEFILE, attacks, package_writer
from autograder.grade.store import NOTEBOOK, RESULT
from autograder.result.model import Result, from_json
from autograder.run.sandbox import cgroup
from autograder.suite import suites
from tests.e2e.leak_monitor import grade_monitored
from tests.e2e.results import without_times

Writers = list[tuple[str, Callable[[Path], None]]]
FEW_CHECKS = ("threshold", "ten_hertz")  # the checks that grade the small class
# The first sentence of the feedback. If an attack has no effect, it describes the flaw of the attacker's program.
SENTENCES = {
    **dict.fromkeys(
        ("thief", "tricks", "forged protocol", "build thief", "notebook tricks"), "published a command every 0.20 s"
    ),
    **dict.fromkeys(("spoofed ROS", "constants"), "the robot drove forward at 0.30 m/s: it should turn left"),
    "nan commands": "was told to move at nan m/s and nan rad/s",
    "grader's name": "is called grader, which is the grader's own name",
    "build link": "left install/all, which leads out of the install space",
    "shadowed rclpy": "ended by itself (exit status 0)",
    "fork bomb": "started far too many threads or processes",
    "notebook link": "there is no folder ws/src",
}
# A fork bomb by root, without control groups, would stop the machine.
ATTACKS = {attack.id: attack for attack in attacks() if attack.id != "fork bomb" or "pids" in cgroup.bounds()}


def write_notebook(folder: Path) -> None:
    """Submit the reference as a notebook."""
    package_writer(None)(folder / "answer")
    text = (folder / "answer" / "src" / PACKAGE / CONTROLLER).read_text()
    (folder / "submission").mkdir()
    nbformat.write(
        new_notebook(cells=[new_code_cell(WRITEFILE + text, id="answer")]),
        folder / "submission" / f"{CHAPTER.assignment}.ipynb",
    )


def honest(number: int) -> Writers:
    """Return `number` honest submissions: a notebook, a slow node, a failing build, then those of the verification."""
    broken = package_writer(None, files={"setup.py": "print('started')\nraise ValueError('no version')\n"})
    writers: Writers = [("notebook", write_notebook), ("slow", package_writer("five_hertz")), ("no build", broken)]
    kinds = (CaseKind.REFERENCE, CaseKind.VARIANT, CaseKind.MUTANT)
    return [*writers, *((case.name, case.write) for case in cases(CHAPTER.assignment) if case.kind in kinds)][:number]


def hostile(names: Iterable[str]) -> Writers:
    """Return the attacks of these names."""
    return [(name, ATTACKS[name].write) for name in names if name in ATTACKS]


def grade(folder: Path, writers: Writers, only: tuple[str, ...]) -> dict[str, Result]:
    """Grade submissions under a leak monitor; return their results."""
    submissions = {}
    for student, write in writers:
        write(path := folder / "submitted" / student)
        submissions[student] = path / "submission" if (path / "submission").is_dir() else path
    grade_monitored(folder, CHAPTER.assignment, submissions, only)
    stored = {student: folder / "results" / student / RESULT for student, _ in writers}
    return {student: from_json(json.loads(path.read_text())) for student, path in stored.items()}


def files_without_times(folder: Path) -> dict[str, Any]:
    """Return the files of a result by name, without the times in them."""
    files: dict[str, Any] = {path.name: path.read_bytes() for path in folder.iterdir()}
    files[RESULT] = without_times(json.loads(files[RESULT]))
    if NOTEBOOK in files:
        files[NOTEBOOK] = json.loads(files[NOTEBOOK])
        for cell in files[NOTEBOOK]["cells"]:
            cell["metadata"].pop("execution", None)
    return files


def require_no_gain(results: dict[str, Result], only: tuple[str, ...]) -> None:
    """Require that no attack gained anything, and that its feedback says what is wrong."""
    for student, result in results.items():
        attack = ATTACKS[student.partition(", ")[0]]
        assert attack.verify(result, frozenset(only)) == "", student
        assert SENTENCES[attack.id] in first_sentence(result), student


@pytest.mark.parametrize(
    ("size", "names", "checks"),
    [
        pytest.param(4, ("thief", "fork bomb"), FEW_CHECKS, id="6"),
        pytest.param(
            15,
            ("thief", "fork bomb", "notebook tricks", "build link", "spoofed ROS"),
            (),
            id="20",
            marks=[pytest.mark.nightly, pytest.mark.timeout(3600)],
        ),
    ],
)
def test_attackers_do_not_change_the_results_of_other_students(
    tmp_path: Path, size: int, names: tuple[str, ...], checks: tuple[str, ...]
) -> None:
    only = suites.hidden(CHAPTER.assignment).with_dependencies(*checks)
    good, bad = honest(size), hostile(names)
    # Each attack is graded at the same time as an honest submission.
    alternating = [*(submission for pair in zip(bad, good, strict=False) for submission in pair), *good[len(bad) :]]
    grade(tmp_path / "without", good, only)
    results = grade(tmp_path / "with", alternating, only)
    require_no_gain({student: results[student] for student, _ in bad}, only)
    for student, _ in good:
        without_attackers, with_attackers = (
            files_without_times(tmp_path / name / "results" / student) for name in ("without", "with")
        )
        assert with_attackers == without_attackers, student


def write_one_of_many(attack: Attack, number: int, folder: Path) -> None:
    """Write an attack with a unique file, because equal submissions are graded only once."""
    attack.write(folder)
    path = folder / "submission"
    (path if path.is_dir() else folder / "src" / PACKAGE).joinpath("number.txt").write_text(f"{number}")


@pytest.mark.slow
@pytest.mark.nightly
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("size", [200])
def test_many_attacks_in_a_row_leave_nothing_on_the_machine(tmp_path: Path, size: int) -> None:
    only = suites.hidden(CHAPTER.assignment).with_dependencies(*FEW_CHECKS)
    submissions: Writers = [
        (f"{attack.id}, {number}", partial(write_one_of_many, attack, number))
        for number, attack in enumerate(islice(cycle(ATTACKS.values()), size))
    ]
    require_no_gain(grade(tmp_path, submissions, only), only)
