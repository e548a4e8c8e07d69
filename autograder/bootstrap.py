"""Makes `.venv`, the step between a clone and a running course: `python3 -I autograder/bootstrap.py`.

Run by the system's Python with the standard library alone. A finished set-up leaves a stamp of everything it depends
on; while the stamp holds, a second call does nothing. The stamp is removed before the first change and written after
the last one, so that an interrupted set-up is made again from the start.
"""

from __future__ import annotations

import argparse
import fcntl
import hashlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

DISTRO = "jazzy"
OLDEST, NEWEST = (3, 10), (3, 13)
STAMP = "course-set-up.json"

# What apt provides, and the commands that show that it, or its like, is there.
TOOLS = {
    "bubblewrap": ("bwrap",),
    "chromium": ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"),
}

Say = Callable[[str], None]


class Run(Protocol):
    """Runs a command to its end and returns its exit status; quietly, nothing of its output is shown."""

    def __call__(self, command: Sequence[str], *, quiet: bool = False) -> int:
        """Run `command`."""


class SetUpError(Exception):
    """The set-up cannot be done here; the message says why and what to do."""


@dataclass(frozen=True)
class Interpreter:
    """The Python that the virtual environment is made with.

    Attributes:
        executable: its path, outside any virtual environment.
        version: major and minor.
        build: the full version text, which tells two builds of one version apart.
        suffix: the file name ending of its extension modules.
    """

    executable: str
    version: tuple[int, int]
    build: str
    suffix: str

    @classmethod
    def running(cls) -> Interpreter:
        """Describe the interpreter that runs this, or the one under it when that is a virtual environment's."""
        executable = getattr(sys, "_base_executable", None) or sys.executable
        return cls(executable, sys.version_info[:2], sys.version, str(sysconfig.get_config_var("EXT_SUFFIX")))


def check_machine(version: tuple[int, int], system: str, machine: str) -> None:
    """Refuse a Python or a machine that the pinned packages do not serve.

    Raises:
        SetUpError: with the sentence to show.
    """
    if not OLDEST <= version <= NEWEST:
        raise SetUpError(
            f"Python {version[0]}.{version[1]} does not serve: ROS 2 Jazzy's wheels are for Python 3.10 to 3.13. "
            "Install one of them (3.12 is Jazzy's own) and run `make PYTHON=python3.12`"
        )
    if (system, machine) != ("Linux", "x86_64"):
        raise SetUpError(
            f"the course runs on Linux x86-64 and this is {system} {machine}: use the container in .devcontainer "
            "(on an ARM computer with --platform linux/amd64), WSL 2 on Windows, or a JupyterHub"
        )


def sourced_ros(environ: Mapping[str, str], venv: Path, interpreter: Interpreter) -> str | None:
    """Return the site-packages folder of the ROS 2 Jazzy that is sourced, or None when the wheels are to be used.

    What this project's own environment puts into the variables does not count as sourced.

    Raises:
        SetUpError: another distribution is sourced, or one that this Python cannot import.
    """

    def foreign(name: str) -> list[Path]:
        paths = [Path(part) for part in environ.get(name, "").split(os.pathsep) if part]
        return [path for path in paths if venv not in (path, *path.parents)]

    distro = environ.get("ROS_DISTRO", "")
    modules = [path for path in foreign("PYTHONPATH") if (path / "rclpy").is_dir()]
    sourced = modules or foreign("AMENT_PREFIX_PATH") or foreign("ROS_PACKAGE_PATH")
    if sourced and (modules or distro) and distro != DISTRO:
        raise SetUpError(
            f"the ROS that is sourced is {distro or 'of no known distribution'} and the course needs Jazzy: open a "
            "shell that does not source it (the wheels are then used), or source /opt/ros/jazzy/setup.bash"
        )
    if not modules:
        return None
    if not (modules[0] / "rclpy" / f"_rclpy_pybind11{interpreter.suffix}").is_file():
        built = re.search(r"python(3\.\d+)", str(modules[0]))
        fits = f"python{built[1]}" if built else "the Python it was built for"
        raise SetUpError(
            f"the sourced ROS 2 Jazzy in {modules[0]} is not for Python {'.'.join(map(str, interpreter.version))}: "
            f"run `make PYTHON={fits}`, or open a shell that does not source it (the wheels are then used)"
        )
    return str(modules[0])


def without_ros(lock: str) -> str:
    """Return a lock's text without the entries of ROS itself, all of which are named `ros-...`."""
    entries = re.split(r"(?m)^(?=[A-Za-z0-9])", lock)
    return "".join(entry for entry in entries if not entry.startswith("ros-"))


def child_environment(environ: Mapping[str, str]) -> dict[str, str]:
    """Return the variables for pip and for the new environment's Python.

    pip takes what lies on PYTHONPATH for installed, and the wheels' start-up hook, once it has run for one
    environment, has to run again for the next.
    """
    child = {name: value for name, value in environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    if child.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None):
        child.pop("LD_LIBRARY_PATH", None)
    return {**child, "PIP_DISABLE_PIP_VERSION_CHECK": "1"}


def digest(*parts: str | Path) -> str:
    """Return one digest of texts and of files' contents, in order."""
    whole = hashlib.sha256()
    for part in parts:
        whole.update(hashlib.sha256(part.read_bytes() if isinstance(part, Path) else part.encode()).digest())
    return whole.hexdigest()


def wanted_stamp(root: Path, interpreter: Interpreter, sourced: str | None, *, dev: bool) -> dict[str, str]:
    """Return what a finished set-up of this clone, with this interpreter, would be stamped with."""
    lock, mend = root / "requirements.lock", root / "autograder" / "ros" / "mend.py"
    stamp = {
        # A virtual environment knows its own path: a moved clone needs a new one.
        "base": digest(Path(__file__), lock, mend, str(root), interpreter.executable, interpreter.build, str(sourced)),
        "project": digest(root / "pyproject.toml"),
    }
    if dev:
        stamp["dev"] = digest(root / "requirements-dev.lock")
    return stamp


@dataclass(frozen=True)
class SetUp:
    """One set-up: where, with what, and by which effects.

    Attributes:
        root: the clone.
        interpreter: what the environment is made with.
        sourced: the sourced ROS's site-packages, or None for the wheels.
        run: runs a command.
        say: shows one line.
    """

    root: Path
    interpreter: Interpreter
    sourced: str | None
    run: Run
    say: Say

    @property
    def venv(self) -> Path:
        """The virtual environment's folder."""
        return self.root / ".venv"

    @property
    def python(self) -> str:
        """The virtual environment's Python."""
        return str(self.venv / "bin" / "python")

    def stamp(self) -> dict[str, str]:
        """Return what the last finished set-up was stamped with; empty when there is none or it cannot run."""
        try:
            stamp = json.loads((self.venv / STAMP).read_text())
        except (OSError, ValueError):
            return {}
        return stamp if isinstance(stamp, dict) and Path(self.python).exists() else {}

    def lacks(self, *, dev: bool) -> list[str]:
        """Return which parts have to be made: of `base`, `project` and `dev`."""
        have = self.stamp()
        wanted = wanted_stamp(self.root, self.interpreter, self.sourced, dev=dev)
        return [name for name, key in wanted.items() if have.get(name) != key]

    def make(self, *, dev: bool) -> None:
        """Bring the environment to the wanted state, from the start or by what it lacks.

        Raises:
            SetUpError: a step failed; nothing is stamped.
        """
        lacks, have = self.lacks(dev=dev), self.stamp()
        if not lacks:
            return
        begun = time.monotonic()
        (self.venv / STAMP).unlink(missing_ok=True)
        if "base" in lacks:
            have = {}
            ros = f"the sourced ROS 2 in {self.sourced}" if self.sourced else "ROS 2 Jazzy from wheels"
            self.say(f"set-up: making .venv with Python {self.interpreter.build.split()[0]} and {ros}")
            self._new_environment()
        if "base" in lacks or "dev" in lacks:
            self._install("requirements-dev.lock" if dev else "requirements.lock")
        self._install_project()
        stamp = {**have, **wanted_stamp(self.root, self.interpreter, self.sourced, dev=dev)}
        fresh = self.venv / f"{STAMP}.fresh"
        fresh.write_text(json.dumps(stamp, indent=1))
        fresh.replace(self.venv / STAMP)
        self.say(f"set-up: done in {time.monotonic() - begun:.0f} s")

    def _step(self, failed: str, *command: str) -> None:
        status = self.run(command)
        if status != 0:
            raise SetUpError(f"{failed} (exit status {status} of `{' '.join(command)}`)")

    def _pip(self, failed: str, *arguments: str) -> None:
        self._step(failed, self.python, "-m", "pip", "install", "-qq", *arguments)

    def _new_environment(self) -> None:
        base = self.interpreter.executable
        shutil.rmtree(self.venv, ignore_errors=True)
        with_pip = self.run([base, "-c", "import ensurepip"], quiet=True) == 0
        bare = [] if with_pip else ["--without-pip"]
        self._step("the virtual environment could not be made", base, "-m", "venv", *bare, str(self.venv))
        if not with_pip:
            # Debian ships Python without ensurepip; the system's pip then installs the environment's.
            site = self.venv / "lib" / "python{}.{}".format(*self.interpreter.version) / "site-packages"
            failed = "neither ensurepip nor pip works for this Python: install python3-venv or python3-pip"
            self._step(failed, base, "-m", "pip", "install", "-qq", "--target", str(site), "pip")

    def _install(self, name: str) -> None:
        lock = (self.root / name).read_text()
        chosen = self.venv / name
        chosen.write_text(without_ros(lock) if self.sourced else lock)
        self.say(f"set-up: installing the pinned packages of {name}, a minute or two")
        failed = (
            f"pip could not install {name}: its own lines above say why. Proxies and mirrors are taken from pip's "
            "usual variables and pip.conf. Run the same command again"
        )
        self._pip(failed, "--no-compile", "--require-hashes", "--requirement", str(chosen))
        self.say("set-up: compiling them")
        # Its exit status is not asked: some packages ship templates and old Python that never compile.
        self.run([self.python, "-m", "compileall", "-qq", "-j", "0", str(self.venv / "lib")], quiet=True)

    def _install_project(self) -> None:
        self._pip("the project could not be installed", "--no-build-isolation", "--no-deps", "-e", str(self.root))
        self._step("the ROS wheels could not be mended", self.python, "-m", "autograder.ros.mend")


@contextmanager
def alone(lock: Path, say: Say) -> Iterator[None]:
    """Hold `lock`, so that two set-ups of one clone never meet; say so when that means to wait."""
    lock.parent.mkdir(exist_ok=True)
    with lock.open("w") as held:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say("set-up: another one is at work here, waiting for it")
            fcntl.flock(held, fcntl.LOCK_EX)
        yield


def missing_tools(*, browser: bool) -> list[str]:
    """Return which of the `TOOLS` are missing; Chromium counts only when a browser is asked for."""
    asked = [name for name in TOOLS if browser or name != "chromium"]
    return [name for name in asked if not any(shutil.which(command) for command in TOOLS[name])]


def privilege(uid: int, run: Run) -> list[str] | None:
    """Return the words before `apt-get` that make it work without a question, or None when it cannot."""
    if shutil.which("apt-get") is None:
        return None
    if uid == 0:
        return []
    return ["sudo", "-n"] if shutil.which("sudo") and run(["sudo", "-n", "true"], quiet=True) == 0 else None


def install_tools(missing: Sequence[str], tried: Path, uid: int, run: Run, say: Say) -> None:
    """Install `missing` with apt, once; where that is not possible say the command and go on.

    Args:
        missing: names of packages.
        tried: the file that remembers what apt was asked for before; asking again takes seconds each time.
        uid: the user's number.
        run: runs a command.
        say: shows one line.
    """
    by_hand = f"sudo apt-get install {' '.join(missing)}"
    before = tried.read_text().split() if tried.exists() else []
    prefix = privilege(uid, run) if set(missing) - set(before) else None
    if prefix is None:
        say(f"set-up: {', '.join(missing)} is missing; to install it: {by_hand}")
        return
    say(f"set-up: installing {', '.join(missing)} with apt-get")
    apt = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-o", "DPkg::Lock::Timeout=60"]
    run([*apt, "update"], quiet=True)
    status = run([*apt, "install", "-y", "--no-install-recommends", *missing], quiet=True)
    tried.write_text(" ".join({*before, *missing}))
    if status != 0:
        say(f"set-up: apt-get failed, the rest goes on; by hand: {by_hand}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Set the clone up; return 0 when it is ready, 1 when it cannot be, 2 for a wrong call."""
    parser = argparse.ArgumentParser(description="Make .venv from the pinned packages and mend the ROS 2 wheels.")
    parser.add_argument("--dev", action="store_true", help="also what the tests and benchmarks need")
    parser.add_argument("--browser", action="store_true", help="also Chromium, by apt, when no browser is there")
    options = parser.parse_args(arguments)
    root = Path(__file__).resolve().parent.parent
    environment = child_environment(os.environ)

    def say(line: str) -> None:
        print(line, flush=True)

    def run(command: Sequence[str], *, quiet: bool = False) -> int:
        output = subprocess.DEVNULL if quiet else None
        return subprocess.call(
            command, env=environment, cwd=root, stdin=subprocess.DEVNULL, stdout=output, stderr=output
        )

    try:
        interpreter = Interpreter.running()
        check_machine(interpreter.version, platform.system(), platform.machine())
        sourced = sourced_ros(os.environ, root / ".venv", interpreter)
        set_up = SetUp(root, interpreter, sourced, run, say)
        if set_up.lacks(dev=options.dev):
            with alone(root / ".build" / "set-up.lock", say):
                set_up.make(dev=options.dev)
        missing = missing_tools(browser=options.browser)
        if missing:
            install_tools(missing, set_up.venv / "apt-tried", os.geteuid(), run, say)
    except SetUpError as error:
        print(f"set-up: {error}.", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nset-up: interrupted; the next call starts it again", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
