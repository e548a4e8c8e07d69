"""The student release works on its own, and contains neither hidden checks nor solutions."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import chapters
from autograder.cli import group
from autograder.ros.distribution import DISTRIBUTION


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("release") / "course"
    assert run("--out", str(out)).exit_code == 0
    return out


def run(*arguments: str) -> Result:
    return CliRunner().invoke(group, ["release", *arguments])


def text_of(folder: Path) -> str:
    return "\n".join(path.read_text(errors="replace") for path in folder.rglob("*") if path.is_file())


@pytest.mark.promise("autograder release --out course", "The folder contains the notebooks without their solutions")
def test_the_release_contains_every_chapter_as_nbgrader_releases_it(release: Path) -> None:
    for chapter in chapters():
        released = in_form(chapter.read(), Form.RELEASED)
        text = (release / "chapters" / chapter.assignment / chapter.notebook_path.name).read_text()
        assert all(cell.id in text for cell in released.cells)
        assert "BEGIN SOLUTION" not in text
        assert "BEGIN MARK SCHEME" not in text


def test_the_release_contains_no_caches_or_build_folders(release: Path) -> None:
    caches = [path for name in ("__pycache__", ".mypy_cache", ".pytest_cache") for path in release.rglob(name)]
    assert caches == []
    names = ["src", "build", "__pycache__", ".mypy_cache", ".ruff_cache", ".devcontainer"]
    assert course_paths.NOT_COPIED(str(release), names) == {"build", "__pycache__", ".mypy_cache", ".ruff_cache"}


@pytest.mark.promise("Students start it with `make lab`.")
def test_each_make_target_that_the_release_names_is_in_its_makefile(release: Path) -> None:
    texts = [path for path in release.rglob("*") if path.suffix in (".py", ".md", ".ipynb")]
    named = {name for path in texts for name in re.findall(r"`make ([a-z-]+)`", path.read_text())}
    targets = set(re.findall(r"^([a-z-]+):", (release / "Makefile").read_text(), re.MULTILINE))
    assert {"setup", "real-launch"} <= named <= targets


@pytest.mark.promise("It contains no hidden checks and no solutions.", "autograder release --out course")
def test_the_release_contains_no_line_of_a_hidden_suite(release: Path) -> None:
    released_text = text_of(release)
    hidden = {
        line.strip()
        for path in course_paths.CHECKS.glob("ch*/**/*")
        if path.suffix in (".py", ".yaml") and not {"support", "visible"} & set(path.parts)
        for line in path.read_text().splitlines()
        if line.startswith(("def test_", "    expect(", "  - id: ")) and len(line.strip()) > 30
    }
    public = "".join(text_of(path) for path in course_paths.CHECKS.glob("ch*/*") if path.name in ("support", "visible"))
    # The reference contains the given tests, and so does a variant that is made from the notebook.
    public += text_of(course_paths.SOLUTIONS)
    assert len(hidden) > 300
    assert [line for line in sorted(hidden) if line in released_text and line not in public] == []
    assert not (release / "solutions").exists()
    names = {path.name for path in (release / "autograder" / "checks").glob("ch*/*")}
    assert names == {"__init__.py", "conftest.py", "support", "visible"}


@pytest.mark.promise("autograder check 02_nodes` does the same", "`autograder check 02_nodes` runs the same checks")
def test_check_of_the_release_runs_without_the_instructors_modules(release: Path) -> None:
    """The release needs no environment of its own, because its code comes first on the path."""
    check = [sys.executable, "-m", "autograder", "check", "00_welcome"]
    environment = {**os.environ, "PYTHONPATH": str(release)}
    process = subprocess.run(
        check, cwd=release / "chapters" / "00_welcome", env=environment, text=True, capture_output=True
    )
    assert process.returncode == 1, process.stderr
    assert "square" in process.stdout or "hint 1" in process.stdout
    help_process = subprocess.run(
        [sys.executable, "-m", "autograder", "--help"], cwd=release, env=environment, text=True, capture_output=True
    )
    assert re.findall(r"^  ([a-z]+)  ", help_process.stdout, re.MULTILINE) == ["check", "doctor", "ros", "update"]


@pytest.mark.promise("The image activates ROS for everything that it starts, and sets `JUPYTER_CONFIG_PATH`.")
def test_the_entry_point_of_a_releases_image_activates_ros(release: Path) -> None:
    """It runs on this machine, in a shell without ROS; `tests/e2e/test_image.py` runs it in the image."""
    recipe = (release / ".binder" / "Dockerfile").read_text()
    (settings,) = re.findall(r"\bJUPYTER_CONFIG_PATH=(\S+)$", recipe, re.MULTILINE)
    folders = settings.replace("${HOME}/course", str(release)).split(":")
    assert [folder for folder in folders if (Path(folder) / "jupyter_server_config.json").is_file()]

    (entry_point,) = re.findall(r"^ENTRYPOINT (.*)$", recipe, re.MULTILINE)
    code = "import autograder, os, rclpy; rclpy.init(); print(autograder.__path__[0], os.environ['ROS_DISTRO'])"
    process = subprocess.run(
        [*json.loads(entry_point), "python", "-W", "error", "-c", code],
        cwd=release,
        env={"PATH": f"{Path(sys.executable).parent}:{os.defpath}", "PYTHONPATH": str(release)},
        text=True,
        capture_output=True,
    )
    assert process.stdout.split() == [str(release / "autograder"), DISTRIBUTION.name], process.stderr


@pytest.mark.promise(
    "autograder release 00_welcome 01_package_structure --out week-1",
    "autograder release 02_nodes --out week-2-again --newest /srv/ros2/newest",
    "`--newest` names a folder that students' machines can read",
    ".venv/bin/autograder update ../FOLDER",
    "Students unpack it and type `autograder update FOLDER`.",
    "A later release, of one chapter or all, updates the folders that students already have:",
)
def test_a_release_of_one_chapter_updates_a_release_of_all_chapters(release: Path, tmp_path: Path) -> None:
    installed = shutil.copytree(release, tmp_path / "mine")
    later = tmp_path / "later"
    assert run("02_nodes", "--out", str(later), "--newest", str(later)).exit_code == 0
    answer = installed / "chapters" / "02_nodes" / "ws" / "src" / "mine.py"
    answer.write_text("a student's")
    changed = installed / "sim" / "world.py"
    changed.write_text("changed")
    update = [sys.executable, "-m", "autograder", "update", str(later)]
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    process = subprocess.run(update, cwd=installed, env=environment, text=True, capture_output=True)
    assert process.returncode == 0, process.stderr
    assert "files updated. This is now the release 20" in process.stdout
    assert "You had changed sim/world.py: your version is now sim/world.py.yours." in process.stdout
    assert answer.read_text() == "a student's"
    assert changed.read_bytes() == (later / "sim" / "world.py").read_bytes()
    assert {path.name for path in (installed / "chapters").iterdir()} == {
        p.name for p in (release / "chapters").iterdir()
    }


def test_a_students_pytest_does_not_use_the_options_of_the_courses_tests(release: Path) -> None:
    """The students' lock has no pytest-timeout, and a warning in a student's test is not an error."""
    folder = release / "chapters" / "06_testing" / "ws"
    test = folder / "test_warns.py"
    test.write_text("import warnings\n\n\ndef test_warns():\n    warnings.warn('deprecated', DeprecationWarning)\n")
    command = [sys.executable, "-m", "pytest", "-p", "no:timeout", "-p", "no:cacheprovider", test.name]
    process = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    test.unlink()
    assert process.returncode == 0, process.stdout + process.stderr
    assert "1 passed, 1 warning" in process.stdout


def test_an_existing_folder_is_not_written_to(tmp_path: Path) -> None:
    result = run("--out", str(tmp_path))
    assert "already exists: choose a new folder" in str(result.exception)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_chapter_is_named_and_nothing_is_written(tmp_path: Path) -> None:
    result = run("--out", str(tmp_path / "new"), "99_flying")
    assert "there is no assignment '99_flying'; there are: 00_welcome" in str(result.exception)
    assert not (tmp_path / "new").exists()
