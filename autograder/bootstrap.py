"""Creates `.venv`, the step between a clone and a running course: `python3 -I autograder/bootstrap.py`.

It runs in the system's Python and needs only the standard library. A finished set-up writes a stamp of everything that
it depends on, and another call does nothing while the stamp is valid. The stamp is removed before the first change and
written after the last one, so an interrupted set-up starts from the beginning.
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
import stat
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

STAMP = "course-set-up.json"
ROS = json.loads(Path(__file__).with_name("ros").joinpath("distribution.json").read_text(encoding="utf-8"))
Run = Callable[..., int]  # run(*command, quiet=False) -> exit status


class SetUpError(Exception):
    """The set-up is impossible here. The message says why and what to do."""


def print_progress(line: str) -> None:
    """Print a line of progress."""
    print(f"set-up: {line}", flush=True)


@dataclass(frozen=True)
class Interpreter:
    """The environment's base Python."""

    executable: str
    version: str  # such as 3.12
    build: str  # the complete version text
    suffix: str  # the suffix of extension modules

    @classmethod
    def running(cls) -> Interpreter:
        """Describe the running interpreter, or the base interpreter of its virtual environment."""
        executable = os.path.realpath(getattr(sys, "_base_executable", None) or sys.executable)
        suffix = str(sysconfig.get_config_var("EXT_SUFFIX"))
        return cls(executable, sysconfig.get_python_version(), sys.version, suffix)


def check_machine(python: str, system: str, machine: str) -> None:
    """Raise SetUpError if the pinned packages do not support this version of Python or this machine."""
    if python not in ROS["pythons"]:
        title, default, (first, *_, last) = ROS["title"], ROS["pythons"][0], sorted(ROS["pythons"])
        raise SetUpError(
            f"Python {python} is not supported: ROS 2 {title}'s wheels are for Python {first} to {last}. "
            f"Install one of them ({title}'s default is {default}) and run `make PYTHON=python{default}`"
        )
    if (system, machine) != ("Linux", "x86_64"):
        raise SetUpError(
            f"the course runs on Linux x86-64, but this is {system} {machine}: use the container in .devcontainer "
            "(on an ARM computer with --platform linux/amd64), WSL 2 on Windows, or a JupyterHub"
        )


def sourced_ros(environ: Mapping[str, str], venv: Path, interpreter: Interpreter) -> str | None:
    """Return the site-packages folder of the sourced ROS 2, or None if the wheels should be used.

    Paths in this project's own environment `venv` do not count as sourced.

    Raises:
        SetUpError: another distribution is sourced, or this Python cannot import the sourced one.
    """

    def outside_venv(name: str) -> list[Path]:
        paths = [Path(part) for part in environ.get(name, "").split(os.pathsep) if part]
        return [path for path in paths if venv not in (path, *path.parents)]

    distro = environ.get("ROS_DISTRO", "")
    modules = [path for path in outside_venv("PYTHONPATH") if (path / "rclpy").is_dir()]
    has_other_ros = distro and (outside_venv("AMENT_PREFIX_PATH") or outside_venv("ROS_PACKAGE_PATH"))
    if (modules or has_other_ros) and distro != ROS["name"]:
        raise SetUpError(
            f"the sourced ROS distribution is {distro or 'unknown'}, but the course needs {ROS['title']}: "
            f"use a shell that does not source it (the wheels are used then), or source {ROS['setup']}"
        )
    if not modules:
        return None
    if not (modules[0] / "rclpy" / f"_rclpy_pybind11{interpreter.suffix}").is_file():
        match = re.search(r"python3\.\d+", str(modules[0]))
        raise SetUpError(
            f"the sourced ROS 2 in {modules[0]} is not for Python {interpreter.version}: "
            f"run `make PYTHON={match[0] if match else 'python' + ROS['pythons'][0]}`, "
            "or use a shell that does not source it (the wheels are used then)"
        )
    return str(modules[0])


def closed_to_other_users(python: Path, course: Path) -> str | None:
    """Explain why other users cannot run `.venv` in the folder `course`, and name a remedy. If they can, return None.

    `python` is the base interpreter of the environment.
    """
    advice = {course: "move the course, to /srv for example, and run `make setup` there"}
    advice[python] = "run `make setup PYTHON=/usr/bin/python3`"
    for path, remedy in advice.items():
        for folder in reversed(path.parents):
            if not folder.stat().st_mode & stat.S_IXOTH:
                return (
                    f"other users cannot run .venv, because they cannot enter {folder}, which contains {path}; {remedy}"
                )
    return None


def without_ros(lock: str) -> str:
    """Return the text of a lock without the ROS packages, whose names all start with `ros-`."""
    return "".join(entry for entry in re.split(r"(?m)^(?=[A-Za-z0-9])", lock) if not entry.startswith("ros-"))


def child_environment(environ: Mapping[str, str]) -> dict[str, str]:
    """Return the environment variables for pip and for the new environment's Python."""
    # pip treats packages on PYTHONPATH as installed, and PYTHONSAFEPATH hides the project from `python -m`.
    child = {name: environ[name] for name in environ.keys() - {"PYTHONPATH", "PYTHONHOME", "PYTHONSAFEPATH"}}
    # The wheels' start-up hook marks that it has run, but must run again in a new environment.
    if child.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None):
        child.pop("LD_LIBRARY_PATH", None)
    return {**child, "PIP_DISABLE_PIP_VERSION_CHECK": "1"}


def digest(*parts: str | Path) -> str:
    """Return a digest of texts and of the contents of files, in order."""
    contents = (part.read_bytes() if isinstance(part, Path) else part.encode() for part in parts)
    return hashlib.sha256(b"".join(hashlib.sha256(content).digest() for content in contents)).hexdigest()


@dataclass(frozen=True)
class SetUp:
    """A set-up: the clone's root, the interpreter, and the site-packages of the sourced ROS (None for the wheels)."""

    root: Path
    interpreter: Interpreter
    sourced: str | None
    run: Run
    standins: bool = False  # the user wants the stand-ins for launch and ros2

    @property
    def venv(self) -> Path:
        return self.root / ".venv"

    @property
    def python(self) -> str:
        return str(self.venv / "bin" / "python")

    def expected_stamp(self, *, dev: bool) -> dict[str, str]:
        """Return the stamp of a finished set-up."""
        lock, patches = self.root / "requirements.lock", self.root / "autograder" / "ros" / "patch_wheels.py"
        # A virtual environment contains its own path, so a moved clone needs a new one.
        location = (str(self.root), self.interpreter.executable, self.interpreter.build, str(self.sourced))
        base = digest(Path(__file__), lock, patches, *location)
        files = (self.root / "pyproject.toml", self.root / "autograder/building/interfaces/tutorials.yaml")
        project = digest(*files, json.dumps(ROS["commits"]), str(self.standins))
        dev_part = {"dev": digest(self.root / "requirements-dev.lock")} if dev else {}
        return {"base": base, "project": project, **dev_part}

    def stamp(self) -> dict[str, str]:
        """Return the stamp of the last finished set-up. It is empty if the file or the Python of `.venv` is missing."""
        try:
            stamp = json.loads((self.venv / STAMP).read_text())
        except (OSError, ValueError):
            return {}
        return stamp if isinstance(stamp, dict) and Path(self.python).exists() else {}

    def missing_parts(self, *, dev: bool) -> list[str]:
        """Return which of the parts `base`, `project` and `dev` are missing."""
        stamp = self.stamp()
        return [name for name, key in self.expected_stamp(dev=dev).items() if stamp.get(name) != key]

    def make(self, *, dev: bool, real_launch: bool = False) -> None:
        """Create the environment or its missing parts. The stamp is written only if every step succeeds.

        If the real launch cannot be installed, the stand-ins are used. With `real_launch`, SetUpError is also raised.
        """
        missing = self.missing_parts(dev=dev)
        if not missing and not real_launch:
            return
        valid_parts = {} if "base" in missing else self.stamp()
        (self.venv / STAMP).unlink(missing_ok=True)
        if "base" in missing:
            self._new_environment()
        if "base" in missing or "dev" in missing:
            self._install("requirements-dev.lock" if dev else "requirements.lock")
        self._step("the ROS wheels could not be patched", self.python, "-m", "autograder.ros.patch_wheels")
        # The project is installed later, because its commands `ros2` and `launch_test` must replace the real ones.
        launch = (self.python, "-m", "autograder.ros.real_launch", *(() if real_launch else ("--set-up",)))
        launch_failed = not self.sourced and self.run(*launch) != 0  # a sourced ROS has its own launch
        project = ("--no-build-isolation", "--no-deps", "-e", str(self.root))
        self._step("the project could not be installed", self.python, "-m", "pip", "install", "-qq", *project)
        if not self.sourced:  # a sourced ROS has its own interfaces of the tutorials
            tutorials = "autograder.building.interfaces.tutorials"
            self._step("the tutorials' interfaces were not built", self.python, "-m", tutorials)
        fresh = self.venv / f"{STAMP}.fresh"
        fresh.write_text(json.dumps({**valid_parts, **self.expected_stamp(dev=dev)}, indent=1))
        fresh.replace(self.venv / STAMP)
        print_progress("done")
        if launch_failed and real_launch:
            raise SetUpError("the real launch could not be installed, for the reason above; everything else is set up")

    def _step(self, problem: str, *command: str) -> None:
        if status := self.run(*command):
            raise SetUpError(f"{problem} (exit status {status} of `{' '.join(command)}`)")

    def _new_environment(self) -> None:
        base = self.interpreter.executable
        ros = f"the sourced ROS 2 in {self.sourced}" if self.sourced else f"ROS 2 {ROS['title']} from wheels"
        print_progress(f"creating .venv with Python {self.interpreter.build.split()[0]} and {ros}")
        shutil.rmtree(self.venv, ignore_errors=True)
        without_pip = self.run(base, "-c", "import ensurepip; ensurepip.version()", quiet=True) != 0
        bare = ["--without-pip"] if without_pip else []
        self._step("the virtual environment could not be created", base, "-m", "venv", *bare, str(self.venv))
        if without_pip:
            # Debian's Python has no ensurepip. In this case, the system's pip installs pip in the environment.
            site_packages = self.venv / "lib" / f"python{self.interpreter.version}" / "site-packages"
            problem = "neither ensurepip nor pip works for this Python: install python3-venv or python3-pip"
            self._step(problem, base, "-m", "pip", "install", "-qq", "--target", str(site_packages), "pip")

    def _install(self, name: str) -> None:
        lock = (self.root / name).read_text()
        (lock_file := self.venv / name).write_text(without_ros(lock) if self.sourced else lock)
        print_progress(f"installing the pinned packages of {name}, which takes a minute or two")
        problem = f"pip could not install {name}, for the reason above; set proxies and mirrors in pip.conf"
        # The lock is complete and valid for each supported Python, even where a package's metadata disagree (rtamt).
        pinned = ("--no-deps", "--ignore-requires-python", "--no-compile", "--require-hashes", "-r", str(lock_file))
        self._step(problem, self.python, "-m", "pip", "install", "-qq", *pinned)
        print_progress("compiling them")
        # The exit status is ignored, because some packages contain templates and old Python that never compile.
        self.run(self.python, "-m", "compileall", "-qq", "-j", "0", str(self.venv / "lib"), quiet=True)


@contextmanager
def exclusive_set_up(lock_file: Path) -> Iterator[None]:
    """Lock `lock_file`, so that a clone has only one set-up at a time. Print a line before waiting."""
    lock_file.parent.mkdir(exist_ok=True)
    with lock_file.open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print_progress("waiting for another set-up that is already running")
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def main(arguments: Sequence[str] | None = None) -> int:
    """Set up the clone. Return 0 if it is ready, 1 if the set-up failed, 2 for wrong arguments."""
    parser = argparse.ArgumentParser(description="Create .venv from the pinned packages and patch the ROS 2 wheels.")
    parser.add_argument("--dev", action="store_true", help="also install packages for tests and benchmarks")
    parser.add_argument("--browser", action="store_true", help="also install Chromium with apt if there is no browser")
    parser.add_argument("--real-launch", action="store_true", help="install the real launch again, or fail")
    options = parser.parse_args(arguments)
    root = Path(__file__).resolve().parent.parent
    environment = child_environment(os.environ)

    def run(*command: str, quiet: bool = False) -> int:
        out = subprocess.DEVNULL if quiet else None
        return subprocess.call(command, env=environment, cwd=root, stdin=subprocess.DEVNULL, stdout=out, stderr=out)

    try:
        interpreter = Interpreter.running()
        check_machine(interpreter.version, platform.system(), platform.machine())
        sourced, standins = sourced_ros(os.environ, root / ".venv", interpreter), os.environ.get("ROS2_STANDINS")
        set_up = SetUp(root, interpreter, sourced, run, standins == "1")
        needs_set_up = options.real_launch or bool(set_up.missing_parts(dev=options.dev))
        apt = [sys.executable, "-I", str(root / "autograder" / "doctor" / "apt.py")]
        apt += ["--browser"] if options.browser else []
        apt += ["--require-compiler"] if needs_set_up else []
        if run(*apt) != 0:
            return 1  # apt.py has printed the reason
        if needs_set_up:
            if os.geteuid() == 0 and (problem := closed_to_other_users(Path(interpreter.executable), root)):
                print_progress(problem)
            with exclusive_set_up(root / ".build" / "set-up.lock"):
                set_up.make(dev=options.dev, real_launch=options.real_launch)
    except SetUpError as error:
        print(f"set-up: {error}.", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nset-up: interrupted; run it again to start over", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
