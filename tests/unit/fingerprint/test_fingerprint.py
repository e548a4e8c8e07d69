"""A suite's version depends on the chapter's files and GRADER_VERSION, its digest on every file a grading reads."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.course_paths import Course
from autograder.suite import fingerprint, suites
from autograder.suite.fingerprint import GRADER_VERSION, digest, files, version

CHAPTER = "02_nodes"
SHARED = {
    "autograder/run/workspace.py": "",
    "autograder/harness/grader_node.py": "",
    "autograder/suite/suites.py": "",
    "sim/world.py": "",
    "assets/worlds/lab.yaml": "",
}
IMPORT = "from autograder.checks.ch01_package_structure.hidden import (\n    growth,\n)\n"
OWN = {
    "autograder/checks/ch02_nodes/conftest.py": "",
    "autograder/checks/ch02_nodes/hidden/__init__.py": "",
    "autograder/checks/ch02_nodes/hidden/graph.py": "from autograder.checks.ch03_interfaces.support import reading\n",
    "autograder/checks/ch02_nodes/hidden/inputs.yaml": "",
    "autograder/checks/ch02_nodes/hidden/versions/second/guard.py": "",
    "autograder/checks/ch02_nodes/support/robot.py": IMPORT,
    "autograder/checks/ch03_interfaces/support/reading.py": "",
    "autograder/checks/ch01_package_structure/hidden/growth.py": "",
    "chapters/02_nodes/02_nodes.ipynb": "{}",
    "chapters/02_nodes/ws/src/chapter_robot/setup.py": "",
    "solutions/speed_guard/setup.py": "",
}
NOT_READ = (
    "autograder/cli/grade.py",
    "autograder/__pycache__/checks.pyc",
    "autograder/checks/ch02_nodes/attacks.py",
    "autograder/checks/ch02_nodes/mutants.yaml",
    "autograder/checks/ch02_nodes/survivors.yaml",
    "autograder/checks/ch02_nodes/variants/other/node.py",
    "autograder/checks/ch02_nodes/.cache/x",
    "autograder/checks/ch03_interfaces/support/driver.py",
    "autograder/checks/ch03_interfaces/hidden/status.py",
    "autograder/checks/ch05_parameters/hidden/files.py",
    "autograder/checks/ch05_parameters/support/robot.py",
    "chapters/03_interfaces/03_interfaces.ipynb",
    "chapters/02_nodes/figures/sector.svg",
    "docs/index.md",
    "solutions/my_robot_package/setup.py",
)
READS = ("solutions/speed_guard",)


LINES = "name: few\ntitle: A course with few files\nchecks: autograder/checks\nworlds: assets/worlds\n"


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A course with few files."""
    for name, text in {**SHARED, **OWN, course_paths.COURSE_FILE: LINES}.items():
        _write(tmp_path / name, text)
    monkeypatch.setattr(course_paths, "ROOT", tmp_path)
    monkeypatch.setattr(course_paths, "course", lambda: Course.read(tmp_path))
    return tmp_path


@pytest.mark.parametrize("name", [*SHARED, *OWN])
def test_a_file_that_a_grading_reads_changes_the_digest(name: str, course: Path) -> None:
    before = digest(CHAPTER, READS)
    with (course / name).open("a") as stream:
        stream.write("# more\n")
    assert digest(CHAPTER, READS) != before


@pytest.mark.promise(
    "`--resume` grades results from other versions again",
    "This command regrades each submission whose result comes from another version of the suite.",
)
@pytest.mark.parametrize("name", OWN)
def test_a_file_of_the_chapter_changes_the_version(name: str, course: Path) -> None:
    before = version(CHAPTER, READS)
    with (course / name).open("a") as stream:
        stream.write("# more\n")
    assert version(CHAPTER, READS) != before


@pytest.mark.parametrize("name", SHARED)
def test_a_file_of_the_grader_changes_the_version_only_with_the_number(
    name: str, course: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = version(CHAPTER, READS)
    (course / name).write_text('"""Another docstring."""\n')
    assert version(CHAPTER, READS) == before
    monkeypatch.setattr(fingerprint, "GRADER_VERSION", GRADER_VERSION + 1)
    assert version(CHAPTER, READS) == before.replace(f"{GRADER_VERSION}-", f"{GRADER_VERSION + 1}-")


def test_the_version_of_another_course_does_not_depend_on_checks_of_this_course(
    course: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other_course = course / "other"
    _write(other_course / course_paths.COURSE_FILE, "name: other\ntitle: Another\n")
    _write(other_course / "checks/ch02_nodes/hidden/graph.py", "")
    monkeypatch.setattr(course_paths, "course", lambda: Course.read(other_course))
    read = {str(path.relative_to(course)) for path in files(CHAPTER)}
    assert "other/checks/ch02_nodes/hidden/graph.py" in read
    assert {"sim/world.py", "autograder/suite/suites.py", "assets/worlds/lab.yaml"} <= read
    assert not [path for path in read if path.startswith(("autograder/checks/ch", "chapters"))]


def test_a_new_file_of_the_suite_changes_the_version(course: Path) -> None:
    before = version(CHAPTER, READS), digest(CHAPTER, READS)
    _write(course / "autograder/checks/ch02_nodes/hidden/more.json", "")
    assert version(CHAPTER, READS) != before[0]
    assert digest(CHAPTER, READS) != before[1]


@pytest.mark.parametrize("name", NOT_READ)
def test_a_file_that_no_grading_reads_does_not_change_the_version(name: str, course: Path) -> None:
    before = version(CHAPTER, READS), digest(CHAPTER, READS)
    _write(course / name, "x")
    assert (version(CHAPTER, READS), digest(CHAPTER, READS)) == before


def test_a_suite_has_the_version_and_digest_of_its_declared_files() -> None:
    suite, reads = suites.hidden("06_testing"), ["solutions/speed_guard"]
    assert suite.version == version("06_testing", reads) != version("06_testing")
    assert suite.files_digest == digest("06_testing", reads) != digest("06_testing")
    assert re.fullmatch(r"\d+-[0-9a-f]{12}", suite.version)


@pytest.mark.slow
def test_every_module_that_a_grading_imports_is_among_the_files() -> None:
    code = (
        "import json, sys\n"
        "import autograder.grade.worker, autograder.grade.run_notebook, autograder.building.interface_bundle\n"
        "from autograder.suite import suites\n"
        "[suites.hidden(name) for name in suites.graded_assignments()]\n"
        "paths = [getattr(module, '__file__', None) for module in list(sys.modules.values())]\n"
        "print(json.dumps([path for path in paths if path]))\n"
    )
    printed = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, cwd=course_paths.ROOT
    )
    folders = (course_paths.ROOT / "autograder", course_paths.ROOT / "sim")
    modules = {Path(place) for place in json.loads(printed.stdout)}
    imported = {module for module in modules if any(folder in module.parents for folder in folders)}
    listed_files = {path for name in suites.graded_assignments() for path in files(name, suites.hidden(name).reads)}
    assert len(imported) > 100
    assert imported - listed_files == set()


def test_each_path_in_reads_of_a_suite_exists() -> None:
    reads = [course_paths.ROOT / path for name in suites.graded_assignments() for path in suites.hidden(name).reads]
    assert course_paths.SOLUTIONS / "speed_guard" in reads
    assert all(path.exists() for path in reads)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
