"""A program that the grader starts imports nothing from the folder in which grading was started."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.doctor import ros as doctor_ros
from autograder.doctor.system import System
from autograder.ros import find
from autograder.run.sandbox import warm_caches

GRADER = Path(__file__).parents[3] / "autograder"
STARTERS = {
    *("subprocess.run", "subprocess.call", "subprocess.check_call", "subprocess.check_output", "subprocess.Popen"),
    *("asyncio.create_subprocess_exec", "asyncio.create_subprocess_shell", "Process"),
}
UNFOLDED = ("os.system", "os.popen", "os.spawn", "os.posix_spawn", "os.exec", "pty.spawn")  # these take no folder
ELSEWHERE = {  # modules that start programs in the present folder, and why it is the right one
    "author/verification/fork_server.py": "rm imports nothing",
    "building/build.py": "rm imports nothing",
    "building/interfaces/compile.py": "the compiler gets absolute paths, from a process in /",
    "cli/ros.py": "`autograder ros COMMAND` becomes the user's command, in the user's folder",
    "grade/worker.py": "rm imports nothing",
    "notebook/terminal.py": "`shell` runs the user's command, in the user's folder",
    "ros/ros2/pkg_create.py": "git, for the user's own name",
    "ros/ros2/run.py": "`ros2 run` runs the user's program, in the user's folder",
    "ros/standins/launch/substitutions/evaluate.py": "a student's launch file, in a sandbox",
    "run/fork_server/emulation.py": "a student's program, in a sandbox",
    "run/sandbox/cgroup.py": "the shell of the system, and true",
    "run/sandbox/isolation.py": "bubblewrap, and true",
}


def starts(path: Path) -> Iterator[ast.Call]:
    """Find the calls in a module that start a program in the present folder of this process."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            is_placed = "cwd" in {keyword.arg for keyword in node.keywords}
            if (name in STARTERS and not is_placed) or name.startswith(UNFOLDED):
                yield node


def test_every_started_program_has_an_explicit_working_folder() -> None:
    modules = {str(path.relative_to(GRADER)) for path in GRADER.rglob("*.py") if any(starts(path))}
    assert modules == set(ELSEWHERE), "name a folder (cwd=), or say here why the present one is right"


@pytest.fixture
def import_mark(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Enter a folder in which every module leaves a mark when it is imported; return the path of the mark."""
    mark = tmp_path / "imported"
    folder = tmp_path / "submission"
    folder.mkdir()
    for name in ("matplotlib", "numpy", "rclpy", "std_msgs", *sys.stdlib_module_names):
        (folder / f"{name}.py").write_text(f"open({str(mark)!r}, 'a').write({name!r} + ' ')\n")
    monkeypatch.chdir(folder)
    return mark


def test_the_list_of_fonts_is_made_without_modules_of_the_present_folder(
    import_mark: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(import_mark.parent / "cache"))
    cache = warm_caches.fonts.__wrapped__()
    assert cache is not None
    assert cache.is_relative_to(import_mark.parent / "cache")
    assert not import_mark.exists()


def test_the_doctor_starts_a_node_without_modules_of_the_present_folder(import_mark: Path) -> None:
    finding = doctor_ros.start(System(), find())
    assert finding.state == "a node starts, publishes and stops"
    assert not import_mark.exists()
