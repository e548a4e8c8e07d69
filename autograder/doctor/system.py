"""The doctor's only way to look at the machine: values and functions that a test can replace one by one."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from autograder.ros import RosEnvironment, find
from autograder.ros.mend import baked_files
from autograder.sandbox import cgroup

PATIENCE_SECONDS = 60.0


@dataclass(frozen=True)
class Ran:
    """How a command ended: its exit status and what it wrote, both streams in one."""

    status: int
    output: str

    @property
    def last_line(self) -> str:
        """The last line that says something: of a traceback, the error."""
        lines = [line.strip() for line in self.output.splitlines() if line.strip()]
        return lines[-1] if lines else f"exit status {self.status}"


@dataclass(frozen=True)
class System:
    """The machine as the doctor sees it.

    Attributes:
        python: version of the running interpreter.
        platform: operating system and machine, as in ("Linux", "x86_64").
        prefix: the running environment's folder.
        in_venv: whether that is a virtual environment.
        headers: where this Python's C headers belong.
        environ: environment variables.
        tmp: the folder for temporary files.
        which: finds a command on PATH or in the running environment.
        run: runs a command, with variables added to the environment, to its end.
        read: a small file's text, or None when there is none.
        free: bytes free where a folder is.
        writable: whether a file can be made in a folder, or the folder itself be made.
        package: an installed distribution's version, or None.
        find_ros: finds ROS 2, or raises `RosError`.
        bounded: whether the kernel bounds how many processes a sandbox of this user has.
        baked: how many of the wheels' CMake files under a prefix still name the build machine.
    """

    python: tuple[int, int, int]
    platform: tuple[str, str]
    prefix: Path
    in_venv: bool
    headers: Path
    environ: Mapping[str, str]
    tmp: Path
    which: Callable[[str], str | None]
    run: Callable[[Sequence[str], Mapping[str, str]], Ran]
    read: Callable[[Path], str | None]
    free: Callable[[Path], int]
    writable: Callable[[Path], bool]
    package: Callable[[str], str | None]
    find_ros: Callable[[], RosEnvironment]
    bounded: Callable[[], bool]
    baked: Callable[[Path], int]


def this_system() -> System:
    """Return the machine that this runs on."""
    return System(
        python=sys.version_info[:3],
        platform=(platform.system(), platform.machine()),
        prefix=Path(sys.prefix),
        in_venv=sys.prefix != sys.base_prefix,
        headers=Path(sysconfig.get_path("include")),
        environ=os.environ,
        tmp=_temporary(os.environ),
        which=_which,
        run=_run,
        read=_read,
        free=lambda path: shutil.disk_usage(path).free,
        writable=_writable,
        package=_package,
        find_ros=find,
        bounded=cgroup.bounded,
        baked=lambda prefix: len(baked_files(prefix)),
    )


def _temporary(environ: Mapping[str, str]) -> Path:
    # Not gettempdir(): it passes over a TMPDIR that cannot be written to, and that is what is to be found.
    return Path(environ.get("TMPDIR") or tempfile.gettempdir())


def _which(command: str) -> str | None:
    # The environment's own commands count even when it was not activated.
    own = str(Path(sys.prefix) / "bin")
    return shutil.which(command, path=os.pathsep.join([own, os.environ.get("PATH", os.defpath)]))


def _run(command: Sequence[str], variables: Mapping[str, str]) -> Ran:
    try:
        done = subprocess.run(
            command,
            env={**os.environ, **variables},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=PATIENCE_SECONDS,
            check=False,
        )
    except OSError as error:
        return Ran(127, f"{command[0]}: {error.strerror}")
    except subprocess.TimeoutExpired:
        return Ran(124, f"{command[0]} did not end within {PATIENCE_SECONDS:g} s")
    return Ran(done.returncode, done.stdout)


def _read(path: Path) -> str | None:
    try:
        return path.read_text()
    except OSError:
        return None


def _writable(folder: Path) -> bool:
    nearest = next((path for path in (folder, *folder.parents) if path.exists()), Path("/"))
    try:
        with tempfile.TemporaryFile(dir=nearest):
            return True
    except OSError:
        return False


def _package(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
