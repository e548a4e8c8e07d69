"""A result of `check` is kept while everything that it depends on is the same, and no longer."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from autograder import course_paths
from autograder.course_paths import Course
from autograder.notebook import checking, stored_results
from autograder.notebook.checking import CheckReport, part_of, run_part
from autograder.result.model import CheckResult
from autograder.suite import Outcome, suites

pytestmark = pytest.mark.slow
CHAPTER, PACKAGE = "08_capstone", "robot_navigation_tutorial"
CHECKS = Path("autograder/checks/ch08_capstone")
# Files of the course and the grader that results depend on: what each file is, and its path.
COURSE = {
    "a visible check": CHECKS / "visible/behaviour.py",
    "the support of visible checks": CHECKS / "support/contract.py",
    "a check of another chapter that they import": Path("autograder/checks/ch02_nodes/support/scans.py"),
    "the grader's version": Path("autograder/suite/fingerprint.py"),
    "the harness": Path("autograder/harness/stepped.py"),
    "the simulator": Path("sim/sensing.py"),
    "a world": Path("assets/worlds/maze.yaml"),
    "the worker": Path("autograder/notebook/check_worker.py"),
}
ANSWER = {
    "a node": f"{PACKAGE}/{PACKAGE}/steering.py",
    "a launch file": f"{PACKAGE}/launch/navigation.launch.py",
    "a file of parameters": f"{PACKAGE}/config/navigation.yaml",
    "a manifest": f"{PACKAGE}/package.xml",
    "a setup.py": f"{PACKAGE}/setup.py",
    "a message": "robot_navigation_interfaces/msg/Clearance.msg",
    "a CMakeLists.txt": "robot_navigation_interfaces/CMakeLists.txt",
    "a test": f"{PACKAGE}/test/test_sectors.py",
}


class Machine:
    """A copy of the course with a workspace, which records the runs of workers."""

    def __init__(self, root: Path) -> None:
        self.root, self.workspace = root, root / "chapters" / CHAPTER / "ws"
        self.runs: list[str] = []
        self.meanwhile: Callable[[], object] = lambda: None

    @property
    def notebook(self) -> Path:
        return self.root / "chapters" / CHAPTER / f"{CHAPTER}.ipynb"

    def change_cell(self, **fields: object) -> None:
        content = json.loads(self.notebook.read_text())
        code = next(cell for cell in content["cells"] if cell["cell_type"] == "code")
        code.update(fields)
        self.notebook.write_text(json.dumps(content))

    @contextmanager
    def run(self, verb: str, workspace: Path, **arguments: Any) -> Iterator[tuple[dict[str, Any], Path]]:
        self.runs.append(arguments["part"])
        self.meanwhile()
        suite = suites.visible(CHAPTER)
        lines = [asdict(CheckResult.of(check, Outcome.PASSED)) for check in suite.checks]
        yield (
            {
                "diagnosis": {"kind": "ok"},
                "checks": lines,
                "sources": suite.sources,
                "reads": suite.reads,
                "lasting": True,
            },
            workspace,
        )

    def check(self, step: int | None = None, *, fresh: bool = False) -> CheckReport:
        return run_part(part_of(CHAPTER, None, step, None), self.workspace, fresh=fresh)

    def has_run(self, step: int | None = None) -> bool:
        """Check, and return whether a worker ran. The report must say the same."""
        before = len(self.runs)
        report = self.check(step)
        assert report.passed
        assert ("Unchanged since" in repr(report)) == (len(self.runs) == before)
        return len(self.runs) > before


@pytest.fixture(scope="module")
def course_copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the course and of the grader. Each test keeps its results elsewhere, and leaves the copy usable."""
    root = tmp_path_factory.mktemp("course")
    for name in ("autograder", "sim", "assets/worlds", f"chapters/{CHAPTER}"):
        shutil.copytree(course_paths.ROOT / name, root / name, ignore=course_paths.NOT_COPIED)
    for package in suites.visible(CHAPTER).sources:
        source = root / "chapters" / CHAPTER / "ws/src" / package
        shutil.copytree(course_paths.SOLUTIONS / package, source, dirs_exist_ok=True)
    return root


@pytest.fixture
def machine(course_copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Machine:
    copy = Machine(course_copy)
    module = copy.root / "autograder/notebook/stored_results.py"
    course = Course(copy.root, "a-copy", "A copy", checks="autograder/checks", worlds="assets/worlds")
    monkeypatch.setattr(course_paths, "ROOT", copy.root)
    monkeypatch.setattr(course_paths, "course", lambda: course)
    monkeypatch.setattr(stored_results, "__file__", str(module))
    monkeypatch.setattr(checking, "run_in_worker", copy.run)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return copy


def test_checks_run_again_only_after_a_change_of_a_file(machine: Machine) -> None:
    paths = {name: machine.root / path for name, path in COURSE.items()}
    paths |= {name: machine.workspace / "src" / path for name, path in ANSWER.items()}
    assert machine.has_run()
    assert not machine.has_run()
    for name, path in paths.items():
        path.write_bytes(path.read_bytes() + b"\n")
        assert machine.has_run(), name
    assert not machine.has_run()


def test_checks_run_again_after_a_file_is_added_removed_or_made_executable(machine: Machine) -> None:
    package = machine.workspace / "src" / PACKAGE
    assert machine.has_run()
    (package / "launch/more.launch.py").touch()
    assert machine.has_run()
    (package / "launch/more.launch.py").rename(package / "launch/other.launch.py")
    assert machine.has_run()
    (package / "launch/other.launch.py").unlink()
    assert machine.has_run()
    (package / "setup.py").chmod(0o755)
    assert machine.has_run()
    (package / "__pycache__").mkdir()  # a check does not copy it
    assert not machine.has_run()


def test_checks_run_again_after_a_changed_cell_but_not_after_changed_outputs(machine: Machine) -> None:
    assert machine.has_run()
    machine.change_cell(source="print('another one')")
    assert machine.has_run()
    machine.change_cell(outputs=[{"output_type": "stream", "name": "stdout", "text": "hello"}], execution_count=7)
    assert not machine.has_run()
    text = machine.notebook.read_text()
    machine.notebook.write_text(text[:-100])  # an incomplete save
    assert machine.has_run()
    machine.notebook.write_text(text)
    assert machine.has_run()


def test_checks_run_again_in_another_environment(
    machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed = tmp_path / "site-packages"
    installed.mkdir()
    monkeypatch.setattr(sys, "path", [*sys.path, str(installed)])
    assert machine.has_run()
    (installed / "flake8-99.dist-info").mkdir()
    assert machine.has_run()
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_other_cpp")
    assert machine.has_run()
    monkeypatch.setenv("ROS_DOMAIN_ID", "77")  # they differ in each kernel, and programs do not get them
    assert not machine.has_run()


def test_each_exercise_and_the_chapter_have_a_result_of_their_own(machine: Machine) -> None:
    assert machine.has_run(2)
    assert not machine.has_run(2)
    assert machine.has_run(3)
    assert machine.has_run()
    assert not machine.has_run(2)
    assert machine.runs == ["step 2", "step 3", ""]


@pytest.mark.promise("With `fresh=True` it runs the checks anyway.")
def test_checks_run_again_on_request(machine: Machine) -> None:
    assert machine.has_run()
    assert not machine.check(fresh=True).since
    assert len(machine.runs) == 2


def test_a_result_is_not_kept_if_a_file_was_written_during_the_run_even_with_the_same_text(machine: Machine) -> None:
    path = machine.workspace / "src" / PACKAGE / "setup.py"
    text = path.read_text()

    def save_twice() -> None:
        path.write_text("half of it")
        path.write_text(text)

    machine.meanwhile = save_twice
    assert machine.has_run()
    machine.meanwhile = lambda: None
    assert machine.has_run()
    assert not machine.has_run()


def test_no_result_is_kept_for_a_workspace_with_a_link(machine: Machine, tmp_path: Path) -> None:
    (tmp_path / "elsewhere.py").touch()
    link = machine.workspace / "src" / PACKAGE / "linked.py"
    link.symlink_to(tmp_path / "elsewhere.py")
    assert machine.has_run()
    assert machine.has_run()
    link.unlink()


@pytest.mark.parametrize("text", ["", "[]", '{"": 1}', '{"": {"digest": "a"}}'])
def test_a_damaged_kept_result_is_ignored(text: str, machine: Machine, tmp_path: Path) -> None:
    assert machine.has_run()
    (result_file,) = (tmp_path / "cache").rglob("*.json")
    result_file.write_text(text)
    assert machine.has_run()
    assert not machine.has_run()


def test_only_the_newest_files_are_kept(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored_results, "MAX_FILES", 2)
    folder = tmp_path / "cache/autograder/checks"
    folder.mkdir(parents=True)
    for number in range(3):
        (folder / f"{number}.json").write_text("{}")
        os.utime(folder / f"{number}.json", (number, number))
    assert machine.has_run()
    assert [path.name for path in folder.iterdir() if len(path.name) < 9] == ["2.json"]
    assert not machine.has_run()
