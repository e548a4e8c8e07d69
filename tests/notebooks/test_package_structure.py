"""The packages of 01_package_structure have the described faults, and the repairs lead to the reference."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.course_paths import SOLUTIONS, chapter
from autograder.probes import imports, manifest

CHAPTER = Chapter(chapter("01_package_structure"))
NOT_IN_THE_WORKSPACE = {"LICENSE"}


def _cell(name: str, form: Form = Form.SOLVED) -> str:
    source: str = next(cell.source for cell in in_form(CHAPTER.read(), form).cells if cell.id == name)
    return source


def _texts(folder: Path) -> dict[str, str]:
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and "__pycache__" not in path.parts)
    texts = {path.relative_to(folder).as_posix(): path.read_text() for path in files}
    return {name: text for name, text in texts.items() if name not in NOT_IN_THE_WORKSPACE}


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the chapter's folder, as the working folder."""
    shutil.copytree(CHAPTER.folder, tmp_path / "chapter", ignore=shutil.ignore_patterns("build", "install", "log"))
    monkeypatch.chdir(tmp_path / "chapter")
    return tmp_path / "chapter" / "ws" / "src"


def test_the_repairs_in_the_notebook_turn_the_broken_package_into_the_reference(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _texts(workspace / "wall_alarm") != _texts(SOLUTIONS / "wall_alarm")
    source = _cell("repair")
    exec(source, {"Path": Path})
    assert "is not there" not in capsys.readouterr().out
    assert _texts(workspace / "wall_alarm") == _texts(SOLUTIONS / "wall_alarm")
    exec(source, {"Path": Path})  # a student may run a cell twice
    assert _texts(workspace / "wall_alarm") == _texts(SOLUTIONS / "wall_alarm")


def test_the_files_that_the_notebook_writes_turn_the_given_ones_into_the_reference(workspace: Path) -> None:
    for name in ("manifest", "setup", "cfg"):
        first, _, text = _cell(f"square-dance-{name}").partition("\n")
        Path(first.removeprefix("%%writefile ")).write_text(text + "\n")
    exec(_cell("square-dance-skeleton"), {"Path": Path})
    assert _texts(workspace / "square_dance") == _texts(SOLUTIONS / "square_dance")


def test_the_broken_package_lacks_every_dependency_that_the_checks_count(workspace: Path) -> None:
    folder = workspace / "wall_alarm"
    missing = imports.missing(folder, manifest.read(folder))
    assert [dependency.module for dependency in missing["exec"]] == [
        "ament_index_python",
        "launch",
        "launch_ros",
        "numpy",
    ]
    assert missing["test"] == ()


def test_the_printed_package_has_the_setup_py_of_the_textbook_and_no_setup_cfg(workspace: Path) -> None:
    printed = workspace.parents[1] / "printed" / "src" / "my_robot_package"
    setup = (printed / "setup.py").read_text()
    assert "packages=[package_name]," in setup
    assert "tests_require=['pytest']," in setup
    assert "license='Apache License 2.0'," in setup
    assert not (printed / "setup.cfg").exists()
    assert {"CMakeLists.txt", "launch", "resource"} <= set(os.listdir(printed))
