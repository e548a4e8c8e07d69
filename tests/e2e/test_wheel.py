"""pip installs the students' modules as a wheel, and `autograder check` then runs in a chapter's folder."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import course_paths

CHAPTER, PACKAGE = "02_nodes", "my_robot_package"


def run(*command: str | Path, cwd: Path) -> str:
    """Run a command that must succeed, without the variables of Python and the autograder; return its output."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "AUTOGRADER"))}
    process = subprocess.run(list(map(str, command)), cwd=cwd, env=environment, text=True, capture_output=True)
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


@pytest.mark.nightly
@pytest.mark.timeout(1200)
def test_a_student_checks_a_chapter_by_the_installed_wheel(tmp_path: Path) -> None:
    release, fresh = tmp_path / "release", tmp_path / "fresh"
    run(sys.executable, "-m", "autograder", "release", CHAPTER, "--out", release, cwd=course_paths.ROOT)
    run(sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-w", "dist", release, cwd=tmp_path)
    (wheel,) = (tmp_path / "dist").glob("*.whl")
    run(sys.executable, "-m", "venv", fresh, cwd=tmp_path)
    run(fresh / "bin" / "pip", "install", wheel, cwd=tmp_path)
    for package in ("autograder", "sim"):
        for part in (release / package).iterdir():  # so that only the wheel's modules can be imported
            if part.name != "checks":
                shutil.rmtree(part) if part.is_dir() else part.unlink()
    shutil.rmtree(release / "assets" / "worlds")
    chapter = release / "chapters" / CHAPTER
    print_worlds = (
        "from autograder import course_paths; print(*(course_paths.world_path(name) for name in ('maze', 'office')))"
    )
    for world in run(fresh / "bin" / "python", "-c", print_worlds, cwd=chapter).split():
        assert Path(world).is_relative_to(fresh)
    shutil.copytree(course_paths.SOLUTIONS / PACKAGE, chapter / "ws" / "src" / PACKAGE, dirs_exist_ok=True)
    assert "visible checks passed" in run(fresh / "bin" / "autograder", "check", CHAPTER, cwd=chapter)
