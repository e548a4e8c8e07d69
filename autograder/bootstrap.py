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

# What apt provides, and the commands that show that it, or its like, is there.
TOOLS = {
    "g++": ("g++",),
    "bubblewrap": ("bwrap",),
    "chromium": ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"),
}

Run = Callable[..., int]  # run(*command, quiet=False) -> exit status


class SetUpError(Exception):
    """The set-up cannot be done here; the message says why and what to do."""


def print_progress(line: str) -> None:
    """Show one line of progress."""
    print(f"set-up: {line}", flush=True)


@dataclass(frozen=True)
class Interpreter:
    """The Python that the environment is made with: its path, version, full version text and extension suffix."""

    executable: str
    version: tuple[int, int]
    build: str
    suffix: str

    @classmethod
    def running(cls) -> Interpreter:
        """Describe the interpreter that runs this, or the one under it when that is a virtual environment's."""
        executable = os.path.realpath(getattr(sys, "_base_executable", None) or sys.executable)
        return cls(executable, sys.version_info[:2], sys.version, str(sysconfig.get_config_var("EXT_SUFFIX")))


def check_machine(version: tuple[int, int], system: str, machine: str) -> None:
    """Refuse, with a `SetUpError`, a Python or a machine that the pinned packages do not support."""
    if (python := "{}.{}".format(*version)) not in ROS["pythons"]:
        title, own, (first, *_, last) = ROS["title"], ROS["pythons"][0], sorted(ROS["pythons"])
        raise SetUpError(
            f"Python {python} is not supported: ROS 2 {title}'s wheels are for Python {first} to {last}. "
            f"Install one of them ({own} is {title}'s own) and run `make PYTHON=python{own}`"
        )
    if (system, machine) != ("Linux", "x86_64"):
        raise SetUpError(
            f"the course runs on Linux x86-64 and this is {system} {machine}: use the container in .devcontainer "
            "(on an ARM computer with --platform linux/amd64), WSL 2 on Windows, or a JupyterHub"
        )


def sourced_ros(environ: Mapping[str, str], venv: Path, interpreter: Interpreter) -> str | None:
    """Return the site-packages folder of the ROS 2 that is sourced, or None when the wheels are to be used.

    What this project's own environment puts into the variables does not count as sourced.

    Raises:
        SetUpError: another distribution is sourced, or one that this Python cannot import.
    """

    def outside_venv(name: str) -> list[Path]:
        paths = [Path(part) for part in environ.get(name, "").split(os.pathsep) if part]
        return [path for path in paths if venv not in (path, *path.parents)]

    distro = environ.get("ROS_DISTRO", "")
    modules = [path for path in outside_venv("PYTHONPATH") if (path / "rclpy").is_dir()]
    other = distro and (outside_venv("AMENT_PREFIX_PATH") or outside_venv("ROS_PACKAGE_PATH"))
    if (modules or other) and distro != ROS["name"]:
        raise SetUpError(
            f"the ROS that is sourced is {distro or 'of no known distribution'} and the course needs {ROS['title']}: "
            f"open a shell that does not source it (the wheels are then used), or source {ROS['setup']}"
        )
    if not modules:
        return None
    if not (modules[0] / "rclpy" / f"_rclpy_pybind11{interpreter.suffix}").is_file():
        found = re.search(r"python3\.\d+", str(modules[0]))
        built = found[0] if found else f"python{ROS['pythons'][0]}"
        raise SetUpError(
            f"the sourced ROS 2 in {modules[0]} is not for Python {'.'.join(map(str, interpreter.version))}: "
            f"run `make PYTHON={built}`, or open a shell that does not source it "
            "(the wheels are then used)"
        )
    return str(modules[0])


def closed_to_other_users(python: Path, course: Path) -> str | None:
    """Say why no other user can run the `.venv` that `python` makes in the folder `course`, and what to do; or None."""
    advice = {course: "move the course, to /srv for example, and run `make setup` there"}
    advice[python] = "run `make setup PYTHON=/usr/bin/python3`"
    for path, what_to_do in advice.items():
        for folder in reversed(path.parents):
            if not folder.stat().st_mode & stat.S_IXOTH:
                return f"other users cannot run .venv, as {folder} is closed to them, and {path} is in it; {what_to_do}"
    return None


def without_ros(lock: str) -> str:
    """Return a lock's text without the entries of ROS itself, all of which are named `ros-...`."""
    entries = re.split(r"(?m)^(?=[A-Za-z0-9])", lock)
    return "".join(entry for entry in entries if not entry.startswith("ros-"))


def child_environment(environ: Mapping[str, str]) -> dict[str, str]:
    """Return the variables for pip and for the new environment's Python.

    pip takes what lies on PYTHONPATH for installed, and the wheels' start-up hook, once it has run for one
    environment, has to run again for the next.
    """
    unwanted = ("PYTHONPATH", "PYTHONHOME", "PYTHONSAFEPATH")  # the last one hides the project from `python -m`
    child = {name: value for name, value in environ.items() if name not in unwanted}
    if child.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None):
        child.pop("LD_LIBRARY_PATH", None)
    return {**child, "PIP_DISABLE_PIP_VERSION_CHECK": "1"}


def digest(*parts: str | Path) -> str:
    """Return one digest of texts and of files' contents, in order."""
    whole = hashlib.sha256()
    for part in parts:
        whole.update(hashlib.sha256(part.read_bytes() if isinstance(part, Path) else part.encode()).digest())
    return whole.hexdigest()


@dataclass(frozen=True)
class SetUp:
    """One set-up: the clone's root, the interpreter, the sourced ROS's site-packages (None: wheels), the effect."""

    root: Path
    interpreter: Interpreter
    sourced: str | None
    run: Run
    standins: bool = False  # the user wants the stand-ins for launch and ros2

    @property
    def venv(self) -> Path:
        """The virtual environment's folder."""
        return self.root / ".venv"

    @property
    def python(self) -> str:
        """The virtual environment's Python."""
        return str(self.venv / "bin" / "python")

    def expected_stamp(self, *, dev: bool) -> dict[str, str]:
        """Return the stamp of a finished set-up."""
        lock, patches = self.root / "requirements.lock", self.root / "autograder" / "ros" / "patch_wheels.py"
        project = (self.root / "pyproject.toml", self.root / "autograder/building/interfaces/tutorials.yaml")
        # A virtual environment knows its own path: a moved clone needs a new one.
        about = (str(self.root), self.interpreter.executable, self.interpreter.build, str(self.sourced))
        launch = digest(json.dumps(ROS["commits"]), str(self.standins))
        base = {"base": digest(Path(__file__), lock, patches, *about), "project": digest(*project), "launch": launch}
        return {**base, "dev": digest(self.root / "requirements-dev.lock")} if dev else base

    def stamp(self) -> dict[str, str]:
        """Return the stamp of the last finished set-up; it is empty if there is none or its Python is gone."""
        try:
            stamp = json.loads((self.venv / STAMP).read_text())
        except (OSError, ValueError):
            return {}
        return stamp if isinstance(stamp, dict) and Path(self.python).exists() else {}

    def missing_parts(self, *, dev: bool) -> list[str]:
        """Return which parts have to be made: of `base`, `project`, `launch` and `dev`."""
        return [name for name, key in self.expected_stamp(dev=dev).items() if self.stamp().get(name) != key]

    def make(self, *, dev: bool, real_launch: bool = False) -> None:
        """Make the whole environment, or its missing parts. The stamp is written only if every step succeeded.

        Where the real launch is not installed, the stand-ins do; with `real_launch`, the end is then a `SetUpError`.
        """
        missing, have = self.missing_parts(dev=dev), self.stamp()
        if not missing and not real_launch:
            return
        (self.venv / STAMP).unlink(missing_ok=True)
        if "base" in missing:
            have = {}
            ros = f"the sourced ROS 2 in {self.sourced}" if self.sourced else f"ROS 2 {ROS['title']} from wheels"
            print_progress(f"making .venv with Python {self.interpreter.build.split()[0]} and {ros}")
            self._new_environment()
        if "base" in missing or "dev" in missing:
            self._install("requirements-dev.lock" if dev else "requirements.lock")
        self._step("the ROS wheels could not be patched", self.python, "-m", "autograder.ros.patch_wheels")
        # Before the project, whose commands of the same names, `ros2` and `launch_test`, switch ROS on first.
        launch = (self.python, "-m", "autograder.ros.real_launch", *(() if real_launch else ("--set-up",)))
        launch_failed = not self.sourced and self.run(*launch) != 0  # a sourced ROS has it
        project = ("--no-build-isolation", "--no-deps", "-e", str(self.root))
        self._step("the project could not be installed", self.python, "-m", "pip", "install", "-qq", *project)
        if not self.sourced:  # an installed ROS 2 has them
            tutorials = "autograder.building.interfaces.tutorials"
            self._step("the tutorials' interfaces were not built", self.python, "-m", tutorials)
        fresh = self.venv / f"{STAMP}.fresh"
        fresh.write_text(json.dumps({**have, **self.expected_stamp(dev=dev)}, indent=1))
        fresh.replace(self.venv / STAMP)
        print_progress("done")
        if real_launch and launch_failed:
            raise SetUpError("the real launch could not be installed: the lines above say why; the rest is set up")

    def _step(self, failed: str, *command: str) -> None:
        if status := self.run(*command):
            raise SetUpError(f"{failed} (exit status {status} of `{' '.join(command)}`)")

    def _new_environment(self) -> None:
        base = self.interpreter.executable
        shutil.rmtree(self.venv, ignore_errors=True)
        without_pip = self.run(base, "-c", "import ensurepip; ensurepip.version()", quiet=True) != 0
        bare = ["--without-pip"] if without_pip else []
        self._step("the virtual environment could not be made", base, "-m", "venv", *bare, str(self.venv))
        if without_pip:
            # Debian ships Python without ensurepip; the system's pip then installs the environment's.
            site = self.venv / "lib" / "python{}.{}".format(*self.interpreter.version) / "site-packages"
            failed = "neither ensurepip nor pip works for this Python: install python3-venv or python3-pip"
            self._step(failed, base, "-m", "pip", "install", "-qq", "--target", str(site), "pip")

    def _install(self, name: str) -> None:
        lock = (self.root / name).read_text()
        (chosen := self.venv / name).write_text(without_ros(lock) if self.sourced else lock)
        print_progress(f"installing the pinned packages of {name}, a minute or two")
        failed = f"pip could not install {name}: its lines above say why; pip.conf is where proxies and mirrors are set"
        # The lock is whole and holds for each supported Python, whatever a package claims (rtamt: to end at 3.12).
        pinned = ("--no-deps", "--ignore-requires-python", "--no-compile", "--require-hashes", "-r", str(chosen))
        self._step(failed, self.python, "-m", "pip", "install", "-qq", *pinned)
        print_progress("compiling them")
        # Its exit status is not asked: some packages ship templates and old Python that never compile.
        self.run(self.python, "-m", "compileall", "-qq", "-j", "0", str(self.venv / "lib"), quiet=True)


@contextmanager
def exclusive_set_up(lock_file: Path) -> Iterator[None]:
    """Lock `lock_file`, so that two set-ups of one clone do not run at the same time; print a line before waiting."""
    lock_file.parent.mkdir(exist_ok=True)
    with lock_file.open("w") as held:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print_progress("another one is at work here, waiting for it")
            fcntl.flock(held, fcntl.LOCK_EX)
        yield


def missing_packages(interpreter: Interpreter, headers: Path, *, browser: bool) -> list[str]:
    """Return the packages of apt's that are not there: tools, and Python's headers in the folder `headers`."""
    tools = [tool for tool in TOOLS if browser or tool != "chromium"]
    missing = [tool for tool in tools if not any(map(shutil.which, TOOLS[tool]))]
    with_headers = (headers / "Python.h").is_file()
    return missing if with_headers else [*missing, "python{}.{}-dev".format(*interpreter.version)]


def require_compiler(missing: Sequence[str]) -> None:
    """Raise a `SetUpError` if a package by which message packages are compiled is missing."""
    if needed := [package for package in missing if package == "g++" or package.endswith("-dev")]:
        lacks = " and ".join("g++" if package == "g++" else "Python.h" for package in needed)
        raise SetUpError(
            f"{lacks} not found, which ROS needs to compile messages: "
            f"run `sudo apt-get install {' '.join(needed)}`, then the same command again"
        )


def install_tools(missing: Sequence[str], tried: Path, uid: int, run: Run) -> None:
    """Install packages with apt, or say the command; `tried` remembers what failed, as each attempt takes seconds."""
    by_hand = f"sudo apt-get install {' '.join(missing)}"
    before = tried.read_text().split() if tried.exists() else []
    sudo = [] if uid == 0 else ["sudo", "-n"]  # `env` turns a missing sudo into an exit status
    possible = shutil.which("apt-get") and run("env", *sudo, "true", quiet=True) == 0
    if not possible or set(missing) <= set(before):
        print_progress(f"{', '.join(missing)} is missing; to install it: {by_hand}")
        return
    print_progress(f"installing {', '.join(missing)} with apt-get")
    apt = [*sudo, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-o", "DPkg::Lock::Timeout=60"]
    run(*apt, "update", quiet=True)
    status = run(*apt, "install", "-y", "--no-install-recommends", *missing, quiet=True)
    tried.parent.mkdir(exist_ok=True)
    tried.write_text(" ".join({*before, *missing}))
    if status != 0:
        print_progress(f"apt-get failed, the rest goes on; by hand: {by_hand}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Set the clone up; return 0 when it is ready, 1 when it cannot be, 2 for a wrong call."""
    parser = argparse.ArgumentParser(description="Make .venv from the pinned packages and patch the ROS 2 wheels.")
    parser.add_argument("--dev", action="store_true", help="also what the tests and benchmarks need")
    parser.add_argument("--browser", action="store_true", help="also Chromium, by apt, when no browser is there")
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
        headers = Path(sysconfig.get_path("include"))
        if missing := missing_packages(interpreter, headers, browser=options.browser):
            install_tools(missing, root / ".build" / "apt-tried", os.geteuid(), run)
        if set_up.missing_parts(dev=options.dev) or options.real_launch:
            require_compiler(missing_packages(interpreter, headers, browser=False))
            if os.geteuid() == 0 and (closed := closed_to_other_users(Path(interpreter.executable), root)):
                print_progress(closed)
            with exclusive_set_up(root / ".build" / "set-up.lock"):
                set_up.make(dev=options.dev, real_launch=options.real_launch)
    except SetUpError as error:
        print(f"set-up: {error}.", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nset-up: interrupted; the next call starts it again", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
