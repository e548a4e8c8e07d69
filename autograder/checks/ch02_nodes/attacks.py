"""Attacks: malicious submissions, made from the reference and attack payloads.

An attack that starts from a mutant gains nothing if it fails at least the checks that the mutant fails.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import nbformat
from nbformat.v4 import new_code_cell, new_notebook

from autograder.checking import Kind
from autograder.checking.attacks import FORGE_PASSES, HOLD_KERNEL, STEAL_SECRETS, STOP_PARENT, Attack, Chapter
from autograder.checks.ch02_nodes.attack_payloads import (
    CALL_SPOOF,
    FORGE_PROTOCOL,
    FORK_BOMB,
    INSTALL_OWN_RCLPY,
    LOSE_MESSAGES,
    NOTEBOOK_CELLS,
    OVERRIDE_BUILTINS,
    PACKAGE,
    PLANTED_FILES,
    PUBLISH_NAN,
    SPOOF_ROS,
)

CHAPTER = Chapter("02_nodes")
CONTROLLER = f"{PACKAGE}/nodes/robot_controller.py"
LEAVE_LINK = "import os\nif not os.path.islink('../../install/all'): os.symlink('/', '../../install/all')\n"
WRITEFILE = f"%%writefile ws/src/{PACKAGE}/{CONTROLLER}\n"

PUBLISH = "        self.cmd_vel_pub.publish(command)"
COUNT = "        self.calls = getattr(self, 'calls', 0) + 1\n"
# Robots that ignore every scan and still touch little or nothing: the name, the description, and the lines that are
# inserted before the command is published.
BLIND_ROBOTS = (
    (
        "late driver",
        "stands still for most of a drive, and then drives straight on",
        f"{COUNT}        command = Twist()\n        command.linear.x = 0.3 if self.calls > 470 else 0.0\n",
    ),
    (
        "circling robot",
        "drives in small circles and ignores the lidar",
        "        command = Twist()\n        command.linear.x, command.angular.z = 0.1, 0.5\n",
    ),
)


def package_writer(
    base: str | None,
    *,
    head: str = "",
    foot: str = "",
    replace: Mapping[str, str] = {},
    files: Mapping[str, str] = {},
) -> Callable[[Path], None]:
    """Return a function that writes a source tree with payloads.

    Args:
        base: the mutant to which the payloads are added, or None for the reference.
        head: text before the controller's source.
        foot: text before the controller's `if __name__`.
        replace: parts of the controller's source, each with its new text.
        files: new files by their path below the package. The text for `setup.py` goes before the existing one.
    """

    def write(folder: Path) -> None:
        CHAPTER.write(base)(folder)
        package = folder / "src" / PACKAGE
        text = (package / CONTROLLER).read_text()
        for old, new in replace.items():
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        (package / CONTROLLER).write_text(f"{head}\n{text}".replace("\nif __name__", f"\n{foot}\nif __name__"))
        for name, content in files.items():
            path = (folder / name) if name.startswith("../") else (package / name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content + (path.read_text() if name == "setup.py" else ""))

    return write


def notebook_writer(*cells: str, base: str | None = None) -> Callable[[Path], None]:
    """Return a function that writes a notebook: attack cells, then the exercise with a mutant's answer."""

    def write(folder: Path) -> None:
        package_writer(base)(folder / "answer")
        answer = (folder / "answer" / "src" / PACKAGE / CONTROLLER).read_text()
        exercise = new_code_cell(WRITEFILE + answer)
        exercise.metadata.nbgrader = {"grade_id": "robot-controller", "grade": True, "points": 999, "locked": False}
        forged_cells = [new_code_cell("print('51')") for _ in range(2)]
        for cell in forged_cells:
            cell.metadata.nbgrader = {"grade_id": "grade-timing", "grade": True, "points": 0.0, "solution": True}
        notebook = new_notebook(cells=[*(new_code_cell(cell) for cell in cells), exercise, *forged_cells])
        (folder / "submission").mkdir()
        nbformat.write(notebook, folder / "submission" / f"{CHAPTER.assignment}.ipynb")

    return write


def attacks() -> tuple[Attack, ...]:
    """Return the attacks. One submission combines attacks that do not interfere with each other."""
    slow_losses, blind_losses = CHAPTER.mutant("five_hertz").fails, CHAPTER.mutant("drives_blind").fails
    all_checks = CHAPTER.checks
    return (
        Attack(
            "thief",
            "reads suites, processes and accounts; writes results and code; phones home; leaves a daemon",
            package_writer("five_hertz", head=STEAL_SECRETS + STOP_PARENT + FORGE_PASSES),
            slow_losses,
            exactly=True,
        ),
        Attack(
            "kernel holder",
            "writes kernel settings; holds inotify watches and descriptors that other processes of the user need",
            package_writer("five_hertz", head=HOLD_KERNEL),
            slow_losses,
            exactly=True,
        ),
        Attack(
            "tricks",
            "objects equal to anything; patched builtins, time and unittest; atexit and __del__",
            package_writer("five_hertz", foot=OVERRIDE_BUILTINS),
            slow_losses,
        ),
        Attack(
            "forged protocol",
            "impersonates the host and reports forged steps and counts",
            package_writer("five_hertz", head=STEAL_SECRETS, foot=FORGE_PROTOCOL),
            slow_losses,
        ),
        Attack(
            "lost messages",
            "impersonates the host and reports that none of the grader's messages arrives",
            package_writer("five_hertz", head=LOSE_MESSAGES),
            slow_losses,
        ),
        Attack(
            "spoofed ROS",
            "publishes on the grader's topics, /clock, /rosout and /parameter_events",
            package_writer(
                "drives_blind",
                foot=SPOOF_ROS,
                replace={"        self.last_scan_time = None\n": CALL_SPOOF},
            ),
            blind_losses,
        ),
        Attack(
            "grader's name",
            "gives its node the name of the grader's node",
            package_writer(None, replace={"__init__('robot_controller'": "__init__('grader'"}),
            all_checks,
            frozenset({Kind.RESERVED_NAME}),
        ),
        Attack(
            "constants",
            "always drives forward and ignores the lidar",
            package_writer(None, replace={"clearance = self.current_clearance()": "clearance = 3.0"}),
            frozenset(
                {"turns_when_blocked", "threshold", "nan", "blind", "stops_before_first_scan", "room", "corridor"}
            ),
        ),
        *(
            Attack(
                name,
                description,
                package_writer(None, replace={PUBLISH: f"{lines}{PUBLISH}"}),
                frozenset({"forward_when_clear", "turns_when_blocked", "nan", "room", "pillars", "corridor"}),
            )
            for name, description, lines in BLIND_ROBOTS
        ),
        Attack(
            "nan commands",
            "publishes commands of nan, which equals nothing",
            package_writer(None, replace={PUBLISH: PUBLISH_NAN}),
            frozenset({"forward_when_clear", "turns_when_blocked", "stops_before_first_scan", "room"}),
        ),
        Attack(
            "build thief",
            "setup.py steals and plants conftest.py, pytest.ini and a start-up hook; forges install and build trees",
            package_writer("five_hertz", files=PLANTED_FILES),
            slow_losses,
            exactly=True,
        ),
        Attack(
            "build link",
            "setup.py leaves a symlink that leads out of the install space and that a mount would follow",
            package_writer(None, files={"setup.py": LEAVE_LINK}),
            all_checks,
            frozenset({Kind.BUILD_FAILED}),
        ),
        Attack(
            "shadowed rclpy",
            "the student's package also installs a Python package called rclpy",
            package_writer(
                None,
                files={"rclpy/__init__.py": "print('51/51')\nraise SystemExit(0)", "setup.py": INSTALL_OWN_RCLPY},
            ),
            all_checks,
            frozenset({Kind.ENDED_EARLY, Kind.BUILD_FAILED, Kind.CRASHED_AT_IMPORT}),
        ),
        Attack(
            "fork bomb",
            "a fork bomb in __init__",
            package_writer(None, replace={"        self.last_scan_time = None\n": FORK_BOMB}),
            all_checks,
            frozenset({Kind.OUT_OF_MEMORY}),
        ),
        Attack(
            "notebook tricks",
            "showtraceback, transformers, displayhook; grade cells deleted, doubled, retyped; input()",
            notebook_writer(*NOTEBOOK_CELLS, base="five_hertz"),
            slow_losses,
            exactly=True,
        ),
        Attack(
            "notebook link",
            "a cell replaces the workspace with a symlink to /",
            notebook_writer("import os\nos.rename('ws', 'old')\nos.symlink('/', 'ws')"),
            all_checks,
            frozenset({Kind.NOTHING_SUBMITTED, Kind.UNSAFE_ARCHIVE}),
        ),
    )
