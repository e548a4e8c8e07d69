"""A course is described by its course.yaml alone: the autograder's code names no part of it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.author.course.package_names import ROS_PACKAGES
from autograder.course_paths import Course
from autograder.exceptions import UsageError

LINES = "name: small\ntitle: A small course\n"


def course(folder: Path, lines: str) -> Course:
    (folder / course_paths.COURSE_FILE).write_text(lines)
    return Course.read(folder)


@pytest.mark.promise("A course is a folder with a `course.yaml`, which needs a `name` and a `title`.")
def test_a_course_needs_a_name_and_a_title_and_everything_else_has_a_default(tmp_path: Path) -> None:
    small = course(tmp_path, LINES)
    assert (small.name, small.title, small.chapters, small.checks) == ("small", "A small course", "chapters", "checks")
    assert small.released == ()


@pytest.mark.promise("The file can name other locations")
def test_a_course_file_names_the_folders_and_the_files_that_students_get(tmp_path: Path) -> None:
    small = course(tmp_path, LINES + "checks: suites\nreleased: [chapters/commands.md]\n")
    assert small.checks == "suites"
    assert {"suites", "chapters/commands.md", course_paths.COURSE_FILE} <= set(small.parts)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("name: small\n", "title"),
        (LINES + "colour: red\n", "colour"),
        (LINES + "worlds: ../worlds\n", "'../worlds' is not a path in the course's folder"),
        (LINES + "released: [/etc/passwd]\n", "'/etc/passwd' is not a path in the course's folder"),
        (LINES + "checks: 3\n", "3 is not a path in the course's folder"),
        (LINES + "worlds: .\n", "'.' goes to students, and would show them answers or hidden checks"),
        (LINES + "released: [solutions/robot]\n", "'solutions/robot' goes to students"),
        (LINES + "released: [chapters/01_first]\n", "'chapters/01_first' goes to students"),
        (LINES + "released: [checks.md]\n", "'checks.md' goes to students"),
        ("- name\n", "the lines of this file are name, title"),
        ("name: [\n", "course.yaml"),
    ],
)
def test_a_wrong_line_of_a_course_file_is_named(tmp_path: Path, lines: str, message: str) -> None:
    with pytest.raises(UsageError, match=r"course\.yaml") as excinfo:
        course(tmp_path, lines)
    assert message in str(excinfo.value)


def test_a_folder_without_the_file_is_not_a_course(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"is not a course: it has no course\.yaml"):
        Course.read(tmp_path)


def test_an_installed_autograder_uses_the_course_that_contains_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    course(tmp_path, LINES)
    chapter = tmp_path / "chapters" / "01_first"
    chapter.mkdir(parents=True)
    monkeypatch.chdir(chapter)
    monkeypatch.delenv(course_paths.COURSE_VARIABLE, raising=False)
    assert course_paths._course_folder() == course_paths.ROOT  # the one around the autograder comes first
    monkeypatch.setattr(course_paths, "ROOT", tmp_path / "site-packages")
    assert course_paths._course_folder() == tmp_path
    monkeypatch.setenv(course_paths.COURSE_VARIABLE, str(chapter))
    assert course_paths._course_folder() == chapter


@pytest.mark.slow  # it imports all of them
def test_no_module_of_the_autograder_reads_the_course_when_it_is_imported(tmp_path: Path) -> None:
    # The checks and attacks of chapters are a part of the course. Attacks are built from `payloads`.
    names = [
        ".".join(path.relative_to(course_paths.ROOT).with_suffix("").parts)
        for path in sorted((course_paths.ROOT / "autograder").rglob("*.py"))
        if not {"checks", "standins", "__main__", "__init__"} & {*path.parts, path.stem}
        and not path.stem.endswith(("_runner", "attacks", "payloads"))
        and not any(part.endswith("_host") for part in path.parts)
    ]
    importing = f"import importlib\nfor name in {names}: importlib.import_module(name)\n"
    importing += "from autograder import course_paths\n"
    completed = subprocess.run(
        [sys.executable, "-c", importing + "print(course_paths.course.cache_info().currsize)\ncourse_paths.CHAPTERS"],
        env={**os.environ, course_paths.COURSE_VARIABLE: str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (completed.stdout, "is not a course" in completed.stderr) == ("0\n", True), completed.stderr


def test_each_path_that_the_course_file_names_exists() -> None:
    generated = course_paths.course().guide  # by `autograder course tables`
    assert {part for part in course_paths.course().parts if not (course_paths.course().root / part).exists()} <= {
        generated
    }
    assert course_paths.course().demo in course_paths.assignments()


def test_the_autograder_names_no_chapter_and_no_package_of_the_course() -> None:
    folders = (*course_paths.SOLUTIONS.iterdir(), *course_paths.check_folders())
    names = {*course_paths.assignments(), *(folder.name for folder in folders)} - {"assessment"}
    texts = {
        path: path.read_text(encoding="utf-8", errors="replace")
        for path in (course_paths.ROOT / "autograder").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and path != ROS_PACKAGES
    }
    course_files = [
        path for path in texts if any(path.is_relative_to(folder) for folder in course_paths.check_folders())
    ]
    assert len(names) > 20
    assert len(course_files) > 100
    for path in set(texts) - set(course_files):
        assert [name for name in names if name in texts[path]] == [], path
