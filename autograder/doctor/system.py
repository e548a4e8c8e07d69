"""The doctor's only access to the machine: attributes and methods that a test can replace individually."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from autograder import course_paths
from autograder.bootstrap import closed_to_other_users
from autograder.ros import find
from autograder.ros.launch_packages import describe_launch
from autograder.ros.patch_wheels import unpatched_cmake_files
from autograder.run.sandbox import cgroup
from autograder.run.sandbox.isolation import namespaces_failure

COMMAND_TIMEOUT_SECONDS = 60.0  # a command that runs for longer counts as failed


@dataclass(frozen=True)
class CommandResult:
    """The exit status of a command, and its output on stdout and stderr."""

    status: int
    output: str

    @property
    def last_line(self) -> str:
        """The last line of the output that is not empty, such as the error message below a traceback."""
        lines = [line.strip() for line in self.output.splitlines() if line.strip()]
        return lines[-1] if lines else f"exit status {self.status}"


class System:
    """The machine that the doctor examines."""

    def __init__(self) -> None:
        self.python = sys.version_info[:3]
        self.platform = (platform.system(), platform.machine())
        self.prefix = Path(sys.prefix)
        self.in_venv = sys.prefix != sys.base_prefix
        self.headers = Path(sysconfig.get_path("include"))
        self.environ: Mapping[str, str] = os.environ
        # `gettempdir()` alone would skip a TMPDIR that is not writable, and so hide the problem.
        self.tmp = Path(os.environ.get("TMPDIR") or tempfile.gettempdir())
        self.disk_usage = shutil.disk_usage
        self.find_ros = find
        self.describe_launch = describe_launch
        self.unpatched_cmake_files = unpatched_cmake_files
        self.namespaces_failure = namespaces_failure
        self.bounds = cgroup.bounds

    def which(self, command: str) -> str | None:
        """Find a command on PATH or in the running virtual environment, even if the latter is not activated."""
        bin_folder = str(Path(sys.prefix) / "bin")
        return shutil.which(command, path=os.pathsep.join([bin_folder, os.environ.get("PATH", os.defpath)]))

    def run(self, command: Sequence[str], variables: Mapping[str, str]) -> CommandResult:
        """Run a command with additional environment variables, in a folder that cannot be a submission."""
        try:
            completed = subprocess.run(
                command,
                cwd="/",
                env={**os.environ, **variables},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                timeout=COMMAND_TIMEOUT_SECONDS,
                check=False,
            )
        except OSError as error:
            return CommandResult(127, f"{command[0]}: {error.strerror}")
        except subprocess.TimeoutExpired:
            return CommandResult(124, f"{command[0]} did not end within {COMMAND_TIMEOUT_SECONDS:g} s")
        return CommandResult(completed.returncode, completed.stdout)

    def read(self, path: Path) -> str | None:
        """Return the text of a small file, or None if it does not exist."""
        try:
            return path.read_text()
        except OSError:
            return None

    def writable(self, folder: Path) -> bool:
        """Return whether a file can be created in a folder, or the folder itself can be created."""
        nearest = next((path for path in (folder, *folder.parents) if path.exists()), Path("/"))
        try:
            with tempfile.TemporaryFile(dir=nearest):
                return True
        except OSError:
            return False

    def closed_to_other_users(self) -> str | None:
        """Explain why other users cannot run root's set-up. Return None if they can, or if this user is not root."""
        return closed_to_other_users(Path(sys.executable).resolve(), course_paths.ROOT) if os.geteuid() == 0 else None

    def package(self, name: str) -> str | None:
        """Return the version of a Python package, or None if it is not installed."""
        try:
            return importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            return None
