"""Installing the real `launch`, `launch_ros` and `ros2cli` on top of the ROS 2 wheels.

These, and `ament_copyright`, have no wheels, but are pure Python: pip builds them from the source repositories that
`launch_packages` pins. `make setup` runs this module with `--set-up`. Where the sources do not answer within ten
seconds, or anything else fails, nothing is installed, and the stand-ins are used. ROS2_STANDINS=1 asks for them.
`make real-launch` tries again.

Each source is an environment variable, so that a local clone serves where GitHub cannot be reached:

    ROS2_LAUNCH_SOURCE=/clones/launch make real-launch

A source is anything git can clone. The pinned commit is taken from it, or with `@tag` at its end that tag, whatever
commit it is. `composition_interfaces`, which launch_ros imports, has to be built by colcon; it goes into the
environment's own prefix.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from autograder.ros.environment import RosEnvironment, find
from autograder.ros.exceptions import RosError
from autograder.ros.launch_packages import SOURCES, Source, describe_launch, installed_packages, python_packages

CHOOSE_STANDINS = "ROS2_STANDINS"  # the environment variable that is 1 to choose the stand-ins
REACH_SECONDS = 10.0  # for all sources together
CLONE_SECONDS = 120.0
BUILD_SECONDS = 600.0
# The locks have everything else that the packages import.
REQUIREMENT = "osrf-pycommon==2.0.2 --hash=sha256:bba7292491db7518f84be4f11502f008cc24086790d5d8bfca2936f925bdabb5"


class RealLaunchError(RosError):
    """The real packages cannot be installed; the first line of the text says which step failed, and why."""


@dataclass(frozen=True)
class Step:
    """A command, its purpose, and a fix if it fails."""

    what: str
    command: Sequence[str]
    hint: str = ""
    seconds: float = BUILD_SECONDS
    cwd: Path = Path("/")  # if no module is beside Python's own
    variables: Mapping[str, str] | None = None


def install(
    ros: RosEnvironment,
    environ: Mapping[str, str],
    *,
    python: str = sys.executable,
    sources: Sequence[Source] = SOURCES,
    requirement: str = REQUIREMENT,
) -> list[str]:
    """Install every package of the sources, or no Python package at all.

    Args:
        ros: the ROS to extend; interfaces are built into its first prefix.
        environ: where the variables of the sources are looked up.
        python: the interpreter whose environment gets the Python packages.
        sources: the repositories to install, in this order.
        requirement: a package to install from the package index first, with its hash; may be empty.

    Returns:
        The names of the packages, in the order of installation.

    Raises:
        RealLaunchError: `ros` is not a set of wheels, a source does not answer or has another commit, or a step failed.
    """
    if ros.kind == "sourced":
        raise RealLaunchError(f"{ros.describe()}: it has the real launch and ros2 already, there is nothing to do")
    if shutil.which("git") is None:
        raise RealLaunchError("git is needed to fetch the sources: install it with your system's packages")
    pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    python_names: list[str] = []
    interface_names: list[str] = []
    with tempfile.TemporaryDirectory(prefix="real-launch-") as folder:
        scratch, wheels = Path(folder), Path(folder, "wheels")
        for source, clone in _clone(sources, environ, scratch).items():
            folders = {_package_name(clone, package, source): clone / package for package in source.packages}
            if source.built:
                _run(_colcon(folders, ros, python, scratch))
                interface_names += folders
            else:
                # The wheels have the dependencies already, under names that pip does not know them by.
                options = ["--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", str(wheels)]
                _run(Step(f"build {', '.join(folders)}", [*pip, "wheel", *options, *map(str, folders.values())]))
                python_names += folders
        if requirement:
            (pinned := scratch / "requirements.txt").write_text(requirement)
            options = ["--no-deps", "--require-hashes", "-r", str(pinned)]
            _run(Step(f"install {requirement.partition('==')[0]}", [*pip, "install", *options]))
        options = ["--no-deps", "--no-index", "--force-reinstall", *map(str, sorted(wheels.glob("*.whl")))]
        try:
            _run(Step("install what was built", [*pip, "install", *options]))
        except BaseException:  # some real packages do not work with some stand-ins
            remove(python_names, python=python)
            raise
    return [*interface_names, *python_names]


def remove(names: Sequence[str], *, python: str = sys.executable) -> None:
    """Uninstall those of the Python packages that are installed, so that the stand-ins are imported.

    Raises:
        RealLaunchError: pip failed.
    """
    _run(Step("uninstall the real packages", [python, "-m", "pip", "--quiet", "uninstall", "--yes", *names]))


def set_up(environ: Mapping[str, str]) -> str:
    """Install the real packages unless they exist or the stand-ins are chosen. A failure leaves the stand-ins.

    Returns:
        One line about the installed packages and the reason.

    Raises:
        RealLaunchError: the stand-ins are chosen, and the real packages cannot be uninstalled.
    """
    pinned = python_packages()
    installed = installed_packages(pinned)
    if environ.get(CHOOSE_STANDINS) == "1":
        if installed:
            remove(list(installed))
        return f"launch and ros2: {describe_launch()}, as {CHOOSE_STANDINS}=1 asks"
    if installed == pinned:
        return f"launch and ros2: {describe_launch()}"
    try:
        install(find(), environ)
    except RosError as error:
        reason = str(error).partition("\n")[0]
        return f"launch and ros2: {describe_launch()} ({reason}); `make real-launch` tries again"
    return f"launch and ros2: {describe_launch()}"


def _clone(sources: Sequence[Source], environ: Mapping[str, str], scratch: Path) -> dict[Source, Path]:
    """Clone all sources at the same time, once all of them answer; return their folders, in order."""
    here = Path.cwd()  # a source may be a relative path, and git imports nothing
    places = {source: source.place(environ) for source in sources}
    hints = {source: f"point {source.variable} at a clone that this machine reaches" for source in sources}
    _run(
        *(
            Step(f"reach {place.url}", ["git", "ls-remote", place.url, "HEAD"], hints[source], REACH_SECONDS, here)
            for source, place in places.items()
        )
    )
    folders = {source: scratch / source.variable.lower() for source in sources}
    # --no-local: git reads each object, and compares it with its id, also in a folder of this machine.
    git = ["git", "-c", "advice.detachedHead=false", "clone", "--quiet", "--no-local", "--depth", "1"]
    _run(
        *(
            Step(
                f"clone {place.url} at {place.tag}",
                [*git, "--branch", place.tag, place.url, str(folders[source])],
                hints[source],
                CLONE_SECONDS,
                here,
            )
            for source, place in places.items()
        )
    )
    for source, place in places.items():
        (commit,) = _run(Step(f"read {place.url}", ["git", "-C", str(folders[source]), "rev-parse", "HEAD"]))
        if place.commit not in ("", commit.strip()):
            raise RealLaunchError(
                f"refuses tag {place.tag} of {place.url}: it is commit {commit.strip()}, not {place.commit}; "
                f"{source.variable}={place.url}@{place.tag} takes it as it is"
            )
    return folders


def _package_name(clone: Path, package: str, source: Source) -> str:
    manifest = clone / package / "package.xml"
    try:
        name = ElementTree.parse(manifest).findtext("name")
    except (OSError, ElementTree.ParseError) as error:
        raise RealLaunchError(f"found no ROS package {package} in {source.variable}: {error}") from None
    return name or package


def _colcon(folders: Mapping[str, Path], ros: RosEnvironment, python: str, scratch: Path) -> Step:
    """Return the step that builds interface packages, straight into the environment's prefix."""
    command = [python, "-m", "colcon", "build", "--merge-install", "--install-base", str(ros.prefixes[0])]
    command += ["--base-paths", *map(str, folders.values()), "--cmake-args", "-DBUILD_TESTING=OFF"]
    path = f"{Path(python).parent}{os.pathsep}{os.environ.get('PATH', '')}"
    return Step(f"build {', '.join(folders)}", command, cwd=scratch, variables={**ros.variables(), "PATH": path})


def _run(*steps: Step) -> list[str]:
    """Run steps at the same time, return their outputs; one that fails or takes too long stops all of them."""
    outputs, started = [], time.monotonic()
    with ExitStack() as running:
        processes = [running.enter_context(_process(step)) for step in steps]
        for step, process in zip(steps, processes, strict=True):
            hint = f"; {step.hint}" if step.hint else ""
            try:
                output, _ = process.communicate(timeout=max(0.0, started + step.seconds - time.monotonic()))
            except subprocess.TimeoutExpired:
                raise RealLaunchError(f"could not {step.what} within {step.seconds:g} s{hint}") from None
            if process.returncode:
                lines = output.strip().splitlines()[-15:] or [f"exit status {process.returncode}"]
                raise RealLaunchError("\n".join([f"could not {step.what}: {lines[-1]}{hint}", *lines[:-1]]))
            outputs.append(output)
    return outputs


@contextmanager
def _process(step: Step) -> Iterator[subprocess.Popen[str]]:
    """Start a step's command in its own process group, and end the group."""
    environ = {**os.environ, "GIT_TERMINAL_PROMPT": "0", **(step.variables or {})}
    process = subprocess.Popen(
        step.command,
        cwd=step.cwd,
        env=environ,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        start_new_session=True,
    )
    with process:
        try:
            yield process
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)


def main(argv: Sequence[str] | None = None) -> int:
    """Install the real packages and print the result; return an exit code."""
    parser = argparse.ArgumentParser(
        prog="real-launch",
        description="Install the real launch, launch_ros and ros2cli on top of the ROS 2 wheels.",
        epilog="Sources: " + ", ".join(f"{source.variable} ({source.url} at {source.tag})" for source in SOURCES),
    )
    parser.add_argument("--set-up", action="store_true", help=f"where it fails, or {CHOOSE_STANDINS}=1, use stand-ins")
    options = parser.parse_args(argv)
    try:
        if options.set_up:
            print(f"set-up: {set_up(os.environ)}")
            return 0
        names = install(find(), os.environ)
    except RosError as error:
        print(f"real-launch: {error}", file=sys.stderr)
        return 1
    print("Installed:", ", ".join(names))
    return 0


if __name__ == "__main__":
    sys.exit(main())
