"""Installs the real `launch`, `launch_ros` and `ros2cli` on top of the ROS 2 wheels.

These packages and `ament_copyright` have no wheels, but are pure Python. pip builds them from the source repositories
that `launch_packages` pins. `make setup` runs this module with `--set-up`. If the sources do not respond within ten
seconds, or anything else fails, nothing is installed, and the stand-ins are used. ROS2_STANDINS=1 selects the
stand-ins. `make real-launch` tries again.

An environment variable overrides each source, for example with a local clone if GitHub cannot be reached:

    ROS2_LAUNCH_SOURCE=/clones/launch make real-launch

A source is anything that git can clone. By default, its tag has to be the pinned commit. A source that ends in `@tag`
is installed at that tag, whatever its commit. `composition_interfaces`, which launch_ros imports, has to be built by
colcon, and is installed into the environment's own prefix.
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

STANDINS_VARIABLE = "ROS2_STANDINS"  # an environment variable; 1 selects the stand-ins
REACH_SECONDS = 10.0  # the time in which all sources must respond; they are asked in parallel
CLONE_SECONDS = 120.0  # the time in which all sources must be cloned, in parallel
BUILD_SECONDS = 600.0  # the time for any other step
# The lock files list everything else that the packages import.
REQUIREMENT = "osrf-pycommon==2.0.2 --hash=sha256:bba7292491db7518f84be4f11502f008cc24086790d5d8bfca2936f925bdabb5"


class RealLaunchError(RosError):
    """The real packages cannot be installed. The first line of the message names the failed step and the reason."""


@dataclass(frozen=True)
class Step:
    """A command, its purpose, and a fix if it fails."""

    action: str
    command: Sequence[str]
    hint: str = ""
    timeout: float = BUILD_SECONDS
    cwd: Path = Path("/")  # a folder without Python modules that could shadow installed ones
    variables: Mapping[str, str] | None = None


def install(
    ros: RosEnvironment,
    environ: Mapping[str, str],
    *,
    python: str = sys.executable,
    sources: Sequence[Source] = SOURCES,
    requirement: str = REQUIREMENT,
) -> list[str]:
    """Install the packages of all sources. If that fails, none of their Python packages stays installed.

    Args:
        ros: the ROS to extend. Interfaces are built into its first prefix.
        environ: the environment variables, which may override the sources.
        python: the interpreter whose environment gets the Python packages.
        sources: the repositories to install, in this order.
        requirement: a package from the package index, with its hash, to install first; it may be empty.

    Returns:
        The names of the packages, in installation order.

    Raises:
        RealLaunchError: `ros` is a sourced installation, a source does not respond or has a different commit, or a step
            failed.
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
            if source.is_interface:
                _run(_colcon(folders, ros, python, scratch))
                interface_names += folders
            else:
                # The wheels already provide the dependencies, under names that pip does not recognize.
                options = ["--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", str(wheels)]
                _run(Step(f"build {', '.join(folders)}", [*pip, "wheel", *options, *map(str, folders.values())]))
                python_names += folders
        if requirement:
            (requirements_file := scratch / "requirements.txt").write_text(requirement)
            options = ["--no-deps", "--require-hashes", "-r", str(requirements_file)]
            _run(Step(f"install {requirement.partition('==')[0]}", [*pip, "install", *options]))
        options = ["--no-deps", "--no-index", "--force-reinstall", *map(str, sorted(wheels.glob("*.whl")))]
        try:
            _run(Step("install what was built", [*pip, "install", *options]))
        except BaseException:  # a mix of real packages and stand-ins may not work
            remove(python_names, python=python)
            raise
    return [*interface_names, *python_names]


def remove(names: Sequence[str], *, python: str = sys.executable) -> None:
    """Uninstall Python packages, so that the stand-ins are imported. Packages that are not installed are skipped.

    Raises:
        RealLaunchError: pip failed.
    """
    _run(Step("uninstall the real packages", [python, "-m", "pip", "--quiet", "uninstall", "--yes", *names]))


def set_up(environ: Mapping[str, str]) -> str:
    """Install the real packages, unless they are already installed or the stand-ins are chosen.

    If the installation fails, the stand-ins remain in use.

    Returns:
        One line that names the installed packages and, after a failure, the reason.

    Raises:
        RealLaunchError: the stand-ins are chosen, but the real packages cannot be uninstalled.
    """
    pinned_versions = python_packages()
    installed_versions = installed_packages(pinned_versions)
    if environ.get(STANDINS_VARIABLE) == "1":
        if installed_versions:
            remove(list(installed_versions))
        return f"launch and ros2: {describe_launch()}, as {STANDINS_VARIABLE}=1 asks"
    if installed_versions == pinned_versions:
        return f"launch and ros2: {describe_launch()}"
    try:
        install(find(), environ)
    except RosError as error:
        reason = str(error).partition("\n")[0]
        return f"launch and ros2: {describe_launch()} ({reason}); `make real-launch` tries again"
    return f"launch and ros2: {describe_launch()}"


def _clone(sources: Sequence[Source], environ: Mapping[str, str], scratch: Path) -> dict[Source, Path]:
    """Check that all sources respond, clone them in parallel, and return the folder of each, in order."""
    cwd = Path.cwd()  # a source may be a relative path
    locations = {source: source.location(environ) for source in sources}
    hints = {source: f"point {source.variable} at a clone that this machine reaches" for source in sources}
    _run(
        *(
            Step(f"reach {location.url}", ["git", "ls-remote", location.url, "HEAD"], hints[source], REACH_SECONDS, cwd)
            for source, location in locations.items()
        )
    )
    folders = {source: scratch / source.variable.lower() for source in sources}
    # With --no-local, git verifies the hash of each object even if it clones a local folder.
    git = ["git", "-c", "advice.detachedHead=false", "clone", "--quiet", "--no-local", "--depth", "1"]
    _run(
        *(
            Step(
                f"clone {location.url} at {location.tag}",
                [*git, "--branch", location.tag, location.url, str(folders[source])],
                hints[source],
                CLONE_SECONDS,
                cwd,
            )
            for source, location in locations.items()
        )
    )
    for source, location in locations.items():
        (commit,) = _run(Step(f"read {location.url}", ["git", "-C", str(folders[source]), "rev-parse", "HEAD"]))
        if location.commit not in ("", commit.strip()):
            raise RealLaunchError(
                f"refuses tag {location.tag} of {location.url}: it is commit {commit.strip()}, not {location.commit}; "
                f"{source.variable}={location.url}@{location.tag} takes it as it is"
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
    """Return the step that builds interface packages into the environment's prefix."""
    command = [python, "-m", "colcon", "build", "--merge-install", "--install-base", str(ros.prefixes[0])]
    command += ["--base-paths", *map(str, folders.values()), "--cmake-args", "-DBUILD_TESTING=OFF"]
    path = f"{Path(python).parent}{os.pathsep}{os.environ.get('PATH', '')}"
    return Step(f"build {', '.join(folders)}", command, cwd=scratch, variables={**ros.variables(), "PATH": path})


def _run(*steps: Step) -> list[str]:
    """Run steps in parallel and return their outputs. If a step fails or times out, the others are stopped."""
    outputs, start = [], time.monotonic()
    with ExitStack() as stack:
        processes = [stack.enter_context(_start_process(step)) for step in steps]
        for step, process in zip(steps, processes, strict=True):
            hint = f"; {step.hint}" if step.hint else ""
            try:
                output, _ = process.communicate(timeout=max(0.0, start + step.timeout - time.monotonic()))
            except subprocess.TimeoutExpired:
                raise RealLaunchError(f"could not {step.action} within {step.timeout:g} s{hint}") from None
            if process.returncode:
                lines = output.strip().splitlines()[-15:] or [f"exit status {process.returncode}"]
                raise RealLaunchError("\n".join([f"could not {step.action}: {lines[-1]}{hint}", *lines[:-1]]))
            outputs.append(output)
    return outputs


@contextmanager
def _start_process(step: Step) -> Iterator[subprocess.Popen[str]]:
    """Start a step's command in its own process group, and kill the group on exit."""
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
    """Install the real packages, print the result, and return an exit code."""
    parser = argparse.ArgumentParser(
        prog="real-launch",
        description="Install the real launch, launch_ros and ros2cli on top of the ROS 2 wheels.",
        epilog="Sources: " + ", ".join(f"{source.variable} ({source.url} at {source.tag})" for source in SOURCES),
    )
    parser.add_argument(
        "--set-up", action="store_true", help=f"where it fails, or {STANDINS_VARIABLE}=1, use stand-ins"
    )
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
