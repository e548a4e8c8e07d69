"""What the long tests share: the reference packages, all of them in one workspace that is built once."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from autograder.building.build import build
from autograder.harness import Workspace
from autograder.layout import SOLUTIONS
from autograder.packages import find_packages
from autograder.ros import environment
from autograder.sandbox import Mount, Sandbox
from autograder.sandbox.launcher import launch
from tests.e2e.cell_support import in_cell, is_forked


def forked(scratch: Path) -> bool:
    """Return whether a program that may be forked into its sandbox is."""
    program = scratch / "program.py"
    program.write_text("import signal\nsignal.pause()")
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    with launch([sys.executable, str(program)], spec, profile="tests") as process:
        return is_forked(process)


@pytest.fixture(scope="session")
def forks() -> None:
    """For tests of programs that are forked into sandboxes, which a kernel may forbid: then they are started."""
    if not in_cell(forked):
        pytest.skip("this machine lets no process join a sandbox")


@dataclass(frozen=True)
class Terminal:
    """A terminal in a workspace: where it stands, and its environment variables."""

    root: Path
    variables: dict[str, str]

    def run(self, *command: str | Path) -> subprocess.CompletedProcess[str]:
        """Run a command; what it said on both streams is its `stdout`."""
        return subprocess.run(
            command, cwd=self.root, env=self.variables, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )

    def source(self) -> Terminal:
        """Return the terminal after `source install/setup.bash`."""
        variables = self.run("bash", "-c", ". install/setup.bash && exec env -0").stdout
        return Terminal(self.root, dict(entry.split("=", 1) for entry in variables.split("\0") if "=" in entry))


@pytest.fixture(scope="session")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Terminal:
    """A sourced workspace with every package of `solutions/`, as colcon built them; `log/build.txt` has its words.

    Packages of messages, which take by far the longest, are built as the grader builds them, and kept where it keeps
    them. The others are built as a student does it.
    """
    root = tmp_path_factory.mktemp("reference")
    found, broken = find_packages(SOLUTIONS)
    assert not broken
    for name, folder in found.items():
        shutil.copytree(folder, root / "src" / name)
    ros = environment.find()
    messages = [name for name, folder in found.items() if (folder / "CMakeLists.txt").is_file()]
    for name in messages:
        build(Workspace(root, ros, tmp_path_factory.mktemp("scratch")), (name,))
    variables = {**os.environ, **ros.variables(log_dir=root / "log/ros"), "PATH": environment.path_with_scripts()}
    terminal = Terminal(root, variables)
    variables.pop("PYTHONDONTWRITEBYTECODE", None)  # setuptools warns where it is set
    built = terminal.run("colcon", "build", "--packages-skip", *messages)
    assert built.returncode == 0, built.stdout
    (root / "log/build.txt").write_text(built.stdout)
    return terminal.source()
