"""Submissions that try to cheat, made from the reference and a little malice.

Each starts from a mutant whose loss is known. An attack that gains nothing loses at least as much.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import nbformat
from nbformat.v4 import new_code_cell, new_notebook

from autograder.checks import suites
from autograder.diagnosis import Kind
from autograder.proof.attack_payloads import (
    ALSO_RCLPY,
    BOMB,
    FORGE_PASSES,
    FORGE_PROTOCOL,
    NAN,
    NOTEBOOK_TRICKS,
    PACKAGE,
    PLANTED,
    SPOOF_ROS,
    SPOOFED,
    STEAL,
    STOP_PARENT,
    TRICKS,
)
from autograder.proof.claims import lost
from autograder.proof.mutants import Mutant, mutants, write_mutant, write_reference
from autograder.result import Result, Status

ASSIGNMENT = "02_nodes"
CONTROLLER = f"{PACKAGE}/nodes/robot_controller.py"
WRITEFILE = f"%%writefile ws/src/{PACKAGE}/{CONTROLLER}\n"


@dataclass(frozen=True)
class Attack:
    """A malicious submission.

    Attributes:
        id: its name.
        rows: the kinds of attack that it holds, in words.
        make: writes it to a folder.
        base: the checks that it does not pass when it is honest.
        diagnosis: what the result may say of it; any when empty.
        exactly: True when the malice does not disturb the rest: nothing but `base` is lost.
    """

    id: str
    rows: str
    make: Callable[[Path], None]
    base: frozenset[str]
    diagnosis: frozenset[Kind] = frozenset()
    exactly: bool = False

    def judge(self, result: Result) -> str:
        """Say what it gained or disturbed; an empty string if nothing."""
        if result.status is not Status.GRADED:
            return result.diagnosis.sentence
        missing = lost(result)
        wrong = [f"gains {', '.join(sorted(self.base - missing))}"] if self.base - missing else []
        if self.exactly and missing != self.base:
            wrong.append(f"disturbs {', '.join(sorted(missing - self.base))}")
        if result.max_score != suites.hidden(ASSIGNMENT).max_score:
            wrong.append(f"changes the maximum to {result.max_score:g}")
        if self.diagnosis and result.diagnosis.kind not in self.diagnosis:
            wrong.append(f"is diagnosed {result.diagnosis.kind.value}")
        return "; ".join(wrong)


@dataclass(frozen=True)
class Edits:
    """Where malice goes: at the head and the foot of the controller, replacements in it, other files."""

    head: str = ""
    foot: str = ""
    replace: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)


def all_checks() -> frozenset[str]:
    """Return the ids of every check."""
    return frozenset(check.id for check in suites.hidden(ASSIGNMENT).checks)


def mutant(name: str) -> Mutant:
    """Return a mutant by its name."""
    return next(found for found in mutants(ASSIGNMENT) if found.id == name)


def package(base: str | None, edits: Edits) -> Callable[[Path], None]:
    """Return a maker of a source tree: a mutant (or the reference) with edits."""

    def make(folder: Path) -> None:
        if base is None:
            write_reference((PACKAGE,), folder)
        else:
            write_mutant(mutant(base), (PACKAGE,), folder)
        home = folder / "src" / PACKAGE
        text = (home / CONTROLLER).read_text()
        for find, put in edits.replace.items():
            assert text.count(find) == 1, find
            text = text.replace(find, put)
        (home / CONTROLLER).write_text(f"{edits.head}\n{text}".replace("\nif __name__", f"\n{edits.foot}\nif __name__"))
        for name, content in edits.files.items():
            path = (folder / name) if name.startswith("../") else (home / name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content + (path.read_text() if name == "setup.py" else ""))

    return make


def notebook(*cells: str, base: str | None = None) -> Callable[[Path], None]:
    """Return a maker of a lone notebook: cells of malice, then the exercise as a mutant answers it."""

    def make(folder: Path) -> None:
        package(base, Edits())(folder / "answer")
        answer = (folder / "answer" / "src" / PACKAGE / CONTROLLER).read_text()
        exercise = new_code_cell(WRITEFILE + answer)
        exercise.metadata.nbgrader = {"grade_id": "robot-controller", "grade": True, "points": 999, "locked": False}
        fakes = [new_code_cell("print('51')") for _ in range(2)]
        for fake in fakes:
            fake.metadata.nbgrader = {"grade_id": "grade-timing", "grade": True, "points": 0.0, "solution": True}
        book = new_notebook(cells=[*(new_code_cell(cell) for cell in cells), exercise, *fakes])
        (folder / "submission").mkdir()
        nbformat.write(book, folder / "submission" / f"{ASSIGNMENT}.ipynb")

    return make


def attacks(assignment: str) -> tuple[Attack, ...]:
    """Return an assignment's attacks, several in one submission where they do not disturb each other."""
    return _corpus() if assignment == ASSIGNMENT else ()


def _corpus() -> tuple[Attack, ...]:
    slow, blind = mutant("five_hertz").loses, mutant("drives_blind").loses
    everything = all_checks()
    return (
        Attack(
            "thief",
            "reads suites, processes and accounts; writes results and code; phones home; leaves a daemon",
            package("five_hertz", Edits(head=STEAL + STOP_PARENT + FORGE_PASSES)),
            slow,
            exactly=True,
        ),
        Attack(
            "tricks",
            "objects equal to anything; patched builtins, time and unittest; atexit and __del__",
            package("five_hertz", Edits(foot=TRICKS)),
            slow,
        ),
        Attack(
            "forged protocol",
            "answers in the host's place with steps and counts of its own",
            package("five_hertz", Edits(head=STEAL, foot=FORGE_PROTOCOL)),
            slow,
        ),
        Attack(
            "spoofed ROS",
            "publishes on the grader's topics, /clock, /rosout and /parameter_events",
            package(
                "drives_blind",
                Edits(foot=SPOOF_ROS, replace={"        self.last_scan_time = None\n": SPOOFED}),
            ),
            blind,
        ),
        Attack(
            "grader's name",
            "calls its node as the grader's is called",
            package(None, Edits(replace={"__init__('robot_controller'": "__init__('grader'"})),
            everything,
            frozenset({Kind.RESERVED_NAME}),
        ),
        Attack(
            "constants",
            "replays a recorded past: always forward, whatever the lidar says",
            package(None, Edits(replace={"clearance = self.current_clearance()": "clearance = 3.0"})),
            frozenset(
                {"turns_when_blocked", "threshold", "nan", "blind", "stops_before_first_scan", "room", "corridor"}
            ),
        ),
        Attack(
            "nan commands",
            "commands that compare equal to nothing",
            package(None, Edits(replace={"        self.cmd_vel_pub.publish(command)": NAN})),
            frozenset({"forward_when_clear", "turns_when_blocked", "stops_before_first_scan", "room"}),
        ),
        Attack(
            "build thief",
            "setup.py steals; plants conftest.py, pytest.ini and a start-up hook; forged install and build trees",
            package("five_hertz", Edits(files=PLANTED)),
            slow,
            exactly=True,
        ),
        Attack(
            "build link",
            "setup.py leaves a link out of the install space, which a mount would follow",
            package(None, Edits(files={"setup.py": "import os\nos.symlink('/', '../../install/all')\n"})),
            everything,
            frozenset({Kind.BUILD_FAILED}),
        ),
        Attack(
            "shadowed rclpy",
            "a package called rclpy in the student's own",
            package(
                None, Edits(files={"rclpy/__init__.py": "print('51/51')\nraise SystemExit(0)", "setup.py": ALSO_RCLPY})
            ),
            everything,
            frozenset({Kind.ENDED_EARLY, Kind.BUILD_FAILED, Kind.CRASHED_AT_IMPORT}),
        ),
        Attack(
            "fork bomb",
            "a fork bomb in __init__",
            package(None, Edits(replace={"        self.last_scan_time = None\n": BOMB})),
            everything,
            frozenset({Kind.OUT_OF_MEMORY}),
        ),
        Attack(
            "notebook tricks",
            "showtraceback, transformers, displayhook; grade cells deleted, doubled, retyped; input()",
            notebook(*NOTEBOOK_TRICKS, base="five_hertz"),
            slow,
            exactly=True,
        ),
        Attack(
            "notebook link",
            "a cell puts a link to / where the workspace was",
            notebook("import os\nos.rename('ws', 'old')\nos.symlink('/', 'ws')"),
            everything,
            frozenset({Kind.NOTHING_SUBMITTED, Kind.UNSAFE_ARCHIVE}),
        ),
    )
