"""Fixtures of the long tests: all reference packages, in one workspace that is built once."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from autograder.building.build import build
from autograder.course_paths import SOLUTIONS
from autograder.harness import Workspace
from autograder.ros import environment
from autograder.run.sandbox import Mount, Sandbox
from autograder.run.sandbox.launcher import launch
from autograder.submission.packages import find_packages
from tests.e2e.sandbox_support import in_worker_sandbox, is_forked


def forked(scratch: Path) -> bool:
    """Return whether a program whose profile allows a fork is forked into its sandbox."""
    program = scratch / "program.py"
    program.write_text("import signal\nsignal.pause()")
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    with launch([sys.executable, str(program)], spec, profile="tests") as process:
        return is_forked(process)


@pytest.fixture(scope="session")
def forks() -> None:
    """Skip the test if the kernel does not allow a fork into a sandbox: programs are then started instead."""
    if not in_worker_sandbox(forked):
        pytest.skip("this machine does not let a process join a sandbox")


@dataclass(frozen=True)
class Terminal:
    """A terminal in a workspace: its current folder and its environment variables."""

    root: Path
    variables: dict[str, str]

    def run(self, *command: str | Path) -> subprocess.CompletedProcess[str]:
        """Run a command; `stdout` contains both of its streams."""
        return subprocess.run(
            command, cwd=self.root, env=self.variables, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )

    def source(self) -> Terminal:
        """Return the terminal after `source install/setup.bash`."""
        variables = self.run("bash", "-c", ". install/setup.bash && exec env -0").stdout
        return Terminal(self.root, dict(entry.split("=", 1) for entry in variables.split("\0") if "=" in entry))


@pytest.fixture(scope="session")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Terminal:
    """A sourced workspace with every package of `solutions/`, as colcon built them; `log/build.txt` has its output.

    Message packages, which take by far the longest, are built and cached as by the grader, the others as by a student.
    The workers of a run share the workspace: the first one builds it.
    """
    base = tmp_path_factory.getbasetemp()
    root = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "reference-workspace"
    ros = environment.find()
    variables = {**os.environ, **ros.variables(log_dir=root / "log/ros"), "PATH": environment.path_with_scripts()}
    variables.pop("PYTHONDONTWRITEBYTECODE", None)  # setuptools warns if it is set
    terminal = Terminal(root, variables)
    with root.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (root / "log/build.txt").is_file():
            _build_reference(terminal, ros, tmp_path_factory.mktemp("scratch"))
    return terminal.source()


def _build_reference(terminal: Terminal, ros: environment.RosEnvironment, scratch: Path) -> None:
    """Build the workspace. Its log is written last, so it shows that the build is complete."""
    packages, broken = find_packages(SOLUTIONS)
    assert not broken
    for name, folder in packages.items():
        shutil.copytree(folder, terminal.root / "src" / name)
    messages = [name for name, folder in packages.items() if (folder / "CMakeLists.txt").is_file()]
    for name in messages:
        (home := scratch / name).mkdir()
        build(Workspace(terminal.root, ros, home), (name,))
    built = terminal.run("colcon", "build", "--packages-skip", *messages)
    assert built.returncode == 0, built.stdout
    (terminal.root / "log/build.txt").write_text(built.stdout)
