"""The wheels' files are patched once and completely, CMake's with the folders of this interpreter."""

from __future__ import annotations

import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy
import pytest

from autograder.ros import patch_wheels

BAKED = """\
set(headers "/opt/python/cp311-cp311/include/python3.11")
set(numpy "/opt/python/cp311-cp311/lib/python3.11/site-packages/numpy/_core/include;/usr/include")
set(old "/opt/python/cp310-cp310/lib/python3.10/site-packages/numpy/core/include")
set(python "/opt/python/cp311-cp311/bin/python")
"""
PATCHED = """\
set(headers "/H")
set(numpy "/N;/usr/include")
set(old "/N")
set(python "/P/bin/python")
"""


def test_each_kind_of_folder_is_replaced_by_that_of_the_interpreter() -> None:
    assert patch_wheels.patched(BAKED, headers="/H", numpy_headers="/N", prefix="/P") == PATCHED


def test_a_folder_with_backslashes_is_written_literally() -> None:
    text = patch_wheels.patched("/opt/python/cp312-cp312/bin", headers="", numpy_headers="", prefix=r"/odd\1name")
    assert text == r"/odd\1name/bin"


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """A prefix with a CMake file that has foreign paths, a correct one, and a text file that is not to be patched."""
    folder = tmp_path / "share" / "std_msgs" / "cmake"
    folder.mkdir(parents=True)
    (folder / "baked.cmake").write_text(BAKED)
    (folder / "good.cmake").write_text("set(x 1)\n")
    (folder / "notes.txt").write_text(BAKED)
    return tmp_path


def test_only_cmake_files_with_foreign_paths_are_rewritten_and_only_once(prefix: Path) -> None:
    folder = prefix / "share" / "std_msgs" / "cmake"
    assert [path.name for path in patch_wheels.unpatched_cmake_files(prefix)] == ["baked.cmake"]
    assert patch_wheels.patch_wheels(prefix) == 1
    assert patch_wheels.patch_wheels(prefix) == 0
    text = (folder / "baked.cmake").read_text()
    assert sysconfig.get_paths()["include"] in text
    assert numpy.get_include() in text
    assert f'"{prefix}/bin/python"' in text
    assert (folder / "notes.txt").read_text() == BAKED
    assert sorted(path.name for path in folder.iterdir()) == ["baked.cmake", "good.cmake", "notes.txt"]


def test_a_prefix_without_wheels_is_not_changed(tmp_path: Path) -> None:
    assert patch_wheels.patch_wheels(tmp_path) == 0


def test_the_environment_of_the_tests_has_no_foreign_paths() -> None:
    assert patch_wheels.unpatched_cmake_files(Path(sys.prefix)) == []


@pytest.mark.promise(
    "They are used only if the real packages are not importable.",
    "After `make real-launch`, or with a sourced ROS 2,",
)
def test_the_stand_ins_come_last_on_the_path(tmp_path: Path) -> None:
    pth = patch_wheels.link_standins(tmp_path)
    assert patch_wheels.link_standins(tmp_path) == pth
    assert [path.name for path in tmp_path.iterdir()] == [patch_wheels.STANDINS_PTH]
    code = f"import site, sys; site.addsitedir({str(tmp_path)!r}); print(sys.path[-1])"
    completed = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, timeout=60)
    assert completed.stdout.strip() == str(Path(patch_wheels.__file__).parent / "standins"), completed.stderr


def test_flake8_is_set_to_one_process_once(tmp_path: Path) -> None:
    assert not patch_wheels.patch_flake8(tmp_path)
    path = tmp_path / patch_wheels.FLAKE8_INI
    path.parent.mkdir(parents=True)
    path.write_text("[flake8]\nstatistics = true\n\n")
    assert patch_wheels.patch_flake8(tmp_path)
    assert not patch_wheels.patch_flake8(tmp_path)
    assert path.read_text() == "[flake8]\nstatistics = true\njobs = 1\n"
    assert list(path.parent.iterdir()) == [path]


def test_flake8_of_this_environment_is_set_to_one_process() -> None:
    path = Path(sysconfig.get_paths()["purelib"]) / patch_wheels.FLAKE8_INI
    assert not path.is_file() or patch_wheels.ONE_PROCESS in path.read_text()


PAUSE = "            time.sleep(0.0001)  # mended: gives the interpreter to the thread that the handler waits for\n"


def test_the_executor_is_patched_once_and_only_if_its_text_is_known(tmp_path: Path) -> None:
    assert not patch_wheels.patch_executor(tmp_path)
    path = tmp_path / patch_wheels.EXECUTORS
    path.parent.mkdir(parents=True)
    submit, keep = "            self._executor.submit(handler)\n", "            self._futures.append(handler)\n"
    path.write_text(submit + keep)
    assert patch_wheels.patch_executor(tmp_path)
    assert path.read_text() == submit + PAUSE + keep
    assert not patch_wheels.patch_executor(tmp_path)
    path.write_text("a version in which this is done otherwise\n")
    assert not patch_wheels.patch_executor(tmp_path)
    assert list(path.parent.iterdir()) == [path]


def test_the_executor_of_this_environment_is_patched() -> None:
    path = Path(sysconfig.get_paths()["purelib"]) / patch_wheels.EXECUTORS
    if not path.is_file():
        pytest.skip("rclpy is not from the wheels")
    lines = path.read_text().splitlines()
    after = lines[next(i for i, line in enumerate(lines) if "self._executor.submit(handler)" in line) + 1]
    assert "time.sleep" in after


@pytest.mark.promise("Set-up installs an empty replacement.")
def test_cmake_packages_find_ament_lint_auto_where_the_wheels_are(tmp_path: Path) -> None:
    assert not patch_wheels.add_lint_auto(tmp_path)
    (tmp_path / "share/ament_cmake").mkdir(parents=True)
    assert patch_wheels.add_lint_auto(tmp_path)
    assert "macro(ament_lint_auto_find_test_dependencies)" in (tmp_path / patch_wheels.LINT_AUTO).read_text()
    (tmp_path / patch_wheels.LINT_AUTO).write_text("the real one")
    assert not patch_wheels.add_lint_auto(tmp_path)
    assert (tmp_path / patch_wheels.LINT_AUTO).read_text() == "the real one"
