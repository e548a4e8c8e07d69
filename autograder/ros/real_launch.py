"""Installing the real `launch`, `launch_ros` and `ros2cli` on top of the ROS 2 wheels (`make real-launch`).

These, and `ament_copyright`, have no wheels, but are pure Python: pip builds them from the source repositories, at the
tags of one release. Each source is an environment variable, so that a local clone serves where GitHub cannot be
reached:

    ROS2_LAUNCH_SOURCE=/clones/launch python -m autograder.ros.real_launch

A source is anything git can clone, with or without `@tag`. `composition_interfaces`, which launch_ros imports, has to
be built by colcon; it goes into the environment's own prefix. The tags are those with which the records in tests/e2e
were written.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.environment import RosEnvironment, find
from autograder.ros.exceptions import RosError

# Imported by the packages below and to be had from the package index.
REQUIREMENTS = ("psutil", "osrf-pycommon", "lark", "pyyaml", "packaging", "argcomplete")


class RealLaunchError(RosError):
    """The real packages cannot be installed; the text says which step failed and what to do."""


@dataclass(frozen=True)
class Source:
    """A repository and what to take from it.

    Attributes:
        variable: the environment variable that names another place to clone from.
        url: where to clone from by default.
        tag: the tag of the release that was chosen.
        packages: folders in the repository, in the order of their installation.
        built: the folders hold interfaces, for colcon; otherwise Python, for pip.
    """

    variable: str
    url: str
    tag: str
    packages: tuple[str, ...]
    built: bool = False

    def place(self, environ: Mapping[str, str]) -> tuple[str, str]:
        """Return what to clone and which tag; a source given by the user has no tag unless it says so."""
        chosen = environ.get(self.variable)
        if not chosen:
            return self.url, self.tag
        head, sign, tag = chosen.rpartition("@")
        # An @ before the last slash or colon belongs to the address, as in git@host:folder.
        return (head, tag) if sign and not {"/", ":"} & set(tag) else (chosen, "")


_TAGS = DISTRIBUTION.tags
SOURCES = (
    Source(
        "ROS2_INTERFACES_SOURCE",
        "https://github.com/ros2/rcl_interfaces.git",
        _TAGS["rcl_interfaces"],
        ("composition_interfaces",),
        built=True,
    ),
    Source("ROS2_RUNTIME_SOURCE", "https://github.com/ros2/rosidl_runtime_py.git", _TAGS["rosidl_runtime_py"], (".",)),
    Source(
        "ROS2_LAUNCH_SOURCE",
        "https://github.com/ros2/launch.git",
        _TAGS["launch"],
        ("launch", "launch_xml", "launch_yaml", "launch_testing", "launch_pytest"),
    ),
    Source(
        "ROS2_LAUNCH_ROS_SOURCE",
        "https://github.com/ros2/launch_ros.git",
        _TAGS["launch_ros"],
        ("launch_ros", "ros2launch", "launch_testing_ros"),
    ),
    # `ros2 pkg create` asks it for the texts of licences.
    Source("ROS2_LINT_SOURCE", "https://github.com/ament/ament_lint.git", _TAGS["ament_lint"], ("ament_copyright",)),
    Source(
        "ROS2_CLI_SOURCE",
        "https://github.com/ros2/ros2cli.git",
        _TAGS["ros2cli"],
        (
            "ros2cli",
            "ros2action",
            "ros2component",
            "ros2doctor",
            "ros2interface",
            "ros2lifecycle",
            "ros2multicast",
            "ros2node",
            "ros2param",
            "ros2pkg",
            "ros2run",
            "ros2service",
            "ros2topic",
        ),
    ),
)


def install(
    ros: RosEnvironment,
    environ: Mapping[str, str],
    *,
    python: str = sys.executable,
    sources: Sequence[Source] = SOURCES,
    requirements: Sequence[str] = REQUIREMENTS,
) -> list[str]:
    """Install every package of the sources.

    Args:
        ros: what to install on top of; interfaces are built into its first prefix.
        environ: where the variables of the sources are looked up.
        python: the interpreter whose environment gets the Python packages.
        sources: what to install, in this order.
        requirements: what to get from the package index first.

    Returns:
        The names of the packages, in the order of installation.

    Raises:
        RealLaunchError: `ros` is no set of wheels, or a step failed.
    """
    if ros.kind == "sourced":
        raise RealLaunchError(f"{ros.describe()}: it has the real launch and ros2 already, there is nothing to do")
    if shutil.which("git") is None:
        raise RealLaunchError("git is needed to fetch the sources: install it with your system's packages")
    pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    if requirements:
        _run("install what the packages need", [*pip, *requirements])
    names: list[str] = []
    with tempfile.TemporaryDirectory(prefix="real-launch-") as scratch:
        for source in sources:
            clone = _clone(source, environ, Path(scratch) / source.variable.lower())
            folders = {_package_name(clone, package, source): clone / package for package in source.packages}
            if source.built:
                _build(folders, ros, python, Path(scratch))
            else:
                # The wheels have the dependencies already, under names that pip does not know them by.
                command = [*pip, "--no-deps", "--no-build-isolation", *map(str, folders.values())]
                _run(f"install {', '.join(folders)}", command)
            names += folders
    return names


def _clone(source: Source, environ: Mapping[str, str], folder: Path) -> Path:
    url, tag = source.place(environ)
    branch = ["--branch", tag] if tag else []
    command = ["git", "-c", "advice.detachedHead=false", "clone", "--quiet", "--depth", "1", *branch, url, str(folder)]
    _run(
        f"clone {url}{f' at {tag}' if tag else ''}",
        command,
        hint=f"if this machine does not reach it, point {source.variable} at a local clone",
    )
    return folder


def _package_name(clone: Path, package: str, source: Source) -> str:
    manifest = clone / package / "package.xml"
    try:
        name = ElementTree.parse(manifest).findtext("name")
    except (OSError, ElementTree.ParseError) as error:
        raise RealLaunchError(f"{source.variable}: {package} is no ROS package: {error}") from None
    return name or package


def _build(folders: Mapping[str, Path], ros: RosEnvironment, python: str, scratch: Path) -> None:
    """Build interface packages with colcon, straight into the environment's prefix."""
    command = [python, "-m", "colcon", "build", "--merge-install", "--install-base", str(ros.prefixes[0])]
    command += ["--base-paths", *map(str, folders.values()), "--cmake-args", "-DBUILD_TESTING=OFF"]
    path = f"{Path(python).parent}{os.pathsep}{os.environ.get('PATH', '')}"
    environment = {**os.environ, **ros.variables(), "PATH": path}
    _run(f"build {', '.join(folders)}", command, cwd=scratch, env=environment)


def _run(
    what: str, command: Sequence[str], *, hint: str = "", cwd: Path | None = None, env: Mapping[str, str] | None = None
) -> None:
    done = subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True, check=False)
    if done.returncode:
        tail = "\n".join((done.stdout + done.stderr).strip().splitlines()[-15:])
        raise RealLaunchError(f"could not {what}{f' ({hint})' if hint else ''}:\n{tail}")


def main(argv: Sequence[str] | None = None) -> int:
    """Install the real packages and say what is there now; return an exit code."""
    parser = argparse.ArgumentParser(
        prog="real-launch",
        description="Install the real launch, launch_ros and ros2cli on top of the ROS 2 wheels.",
        epilog="Sources: " + ", ".join(f"{source.variable} ({source.url} at {source.tag})" for source in SOURCES),
    )
    parser.parse_args(argv)
    try:
        names = install(find(), os.environ)
    except RosError as error:
        print(f"real-launch: {error}", file=sys.stderr)
        return 1
    print("Installed:", ", ".join(names))
    return 0


if __name__ == "__main__":
    sys.exit(main())
