"""A package that does not build because its files are unwritten is reported as unwritten."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from autograder.diagnosis import Diagnosis, Kind
from autograder.submission.exercise_stubs import CODE_STUB, explain

FAILED = Diagnosis(Kind.BUILD_FAILED, "colcon build failed.", "CMake Error at CMakeLists.txt:4:")
DEPENDS = '<package format="3"><name>robot</name><exec_depend>interfaces</exec_depend></package>'


def write(source: Path, **files: str) -> Path:
    """Write files below a source folder; a name has `__` for a slash."""
    for name, text in files.items():
        path = source / name.replace("__", "/").replace("_xml", ".xml").replace("_py", ".py").replace("_txt", ".txt")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return source


def test_the_released_stub_is_found_with_its_line(tmp_path: Path) -> None:
    write(tmp_path, robot__CMakeLists_txt=f"cmake_minimum_required(VERSION 3.8)\n{CODE_STUB}\n")
    detail = explain(FAILED, tmp_path, "robot").detail
    assert detail.startswith("src/robot/CMakeLists.txt, line 3: raise NotImplementedError(")


def test_a_written_file_has_no_stub(tmp_path: Path) -> None:
    write(tmp_path, robot__setup_py="raise NotImplementedError('not for this robot')\n")
    assert explain(FAILED, tmp_path, "robot") == FAILED


@pytest.mark.promise("| `still to be written` |")
@pytest.mark.parametrize("name", ["package.xml", "setup.py", "setup.cfg", "CMakeLists.txt", "msg/A.msg", "srv/B.srv"])
def test_a_stub_in_a_file_that_colcon_reads_explains_a_failed_build(tmp_path: Path, name: str) -> None:
    path = tmp_path / "robot" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{CODE_STUB}\n")
    diagnosis = explain(FAILED, tmp_path, "robot")
    assert diagnosis.kind is Kind.UNFINISHED
    assert (
        diagnosis.sentence
        == f"src/robot/{name} is still to be written: replace the line raise NotImplementedError(...) with yours."
    )
    assert diagnosis.detail.startswith(f"src/robot/{name}, line 2: raise NotImplementedError(")


def test_several_files_are_named_in_one_sentence(tmp_path: Path) -> None:
    write(tmp_path, robot__package_xml=CODE_STUB, robot__setup_py=CODE_STUB, robot__CMakeLists_txt=CODE_STUB)
    sentence = explain(FAILED, tmp_path, "robot").sentence
    expected = "src/robot/package.xml, src/robot/setup.py and src/robot/CMakeLists.txt are still to be written"
    assert sentence.startswith(expected)


def test_a_stub_in_a_package_that_it_depends_on_explains_a_failed_build(tmp_path: Path) -> None:
    write(tmp_path, robot__package_xml=DEPENDS, interfaces__CMakeLists_txt=CODE_STUB)
    assert explain(FAILED, tmp_path, "robot").sentence.startswith("src/interfaces/CMakeLists.txt is still")


def test_stubs_of_other_packages_and_modules_do_not_explain_a_failed_build(tmp_path: Path) -> None:
    write(tmp_path, robot__robot__node_py=CODE_STUB, other__setup_py=CODE_STUB)
    assert explain(FAILED, tmp_path, "robot") is FAILED


def test_a_link_and_a_pipe_are_not_read(tmp_path: Path) -> None:
    write(tmp_path, elsewhere=CODE_STUB, robot__package_xml=DEPENDS)
    (tmp_path / "robot/setup.py").symlink_to(tmp_path / "elsewhere")
    os.mkfifo(tmp_path / "robot/setup.cfg")
    assert explain(FAILED, tmp_path, "robot") is FAILED
