"""The source repositories of the real `launch`, `launch_ros` and `ros2cli`, and the packages that are installed here.

Tags and commits are those of `distribution.json`. The records in tests/e2e were written with them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from autograder.ros.distribution import DISTRIBUTION

STANDINS = "stand-ins"  # the value of `describe_launch` if no real package is installed


@dataclass(frozen=True)
class Place:
    """Where a source is cloned from: an address, a tag, and the commit that the tag has to be ("": any)."""

    url: str
    tag: str
    commit: str


@dataclass(frozen=True)
class Source:
    """A repository and the packages to take from it.

    Attributes:
        variable: the environment variable that names another place to clone from.
        url: where to clone from by default.
        tag: the tag of a release, which is the packages' version, too.
        commit: the tag's commit, 40 hexadecimal digits.
        packages: folders in the repository, in the order of their installation.
        built: the folders hold interfaces, for colcon; otherwise Python, for pip.
    """

    variable: str
    url: str
    tag: str
    commit: str
    packages: tuple[str, ...]
    built: bool = False

    def place(self, environ: Mapping[str, str]) -> Place:
        """Return the tag to clone: the pinned one, unless the user names another one."""
        chosen = environ.get(self.variable)
        if not chosen:
            return Place(self.url, self.tag, self.commit)
        head, sign, tag = chosen.rpartition("@")
        # An @ before the last slash or colon belongs to the address, as in git@host:folder.
        return Place(head, tag, "") if sign and not {"/", ":"} & set(tag) else Place(chosen, self.tag, self.commit)


def _pinned(variable: str, repository: str, *packages: str, built: bool = False) -> Source:
    name = repository.rpartition("/")[2]
    url = f"https://github.com/{repository}.git"
    return Source(variable, url, DISTRIBUTION.tags[name], DISTRIBUTION.commits[name], packages, built)


SOURCES = (
    _pinned("ROS2_INTERFACES_SOURCE", "ros2/rcl_interfaces", "composition_interfaces", built=True),
    _pinned("ROS2_RUNTIME_SOURCE", "ros2/rosidl_runtime_py", "."),
    _pinned(
        "ROS2_LAUNCH_SOURCE",
        "ros2/launch",
        "launch",
        "launch_xml",
        "launch_yaml",
        "launch_testing",
        "launch_pytest",
    ),
    _pinned("ROS2_LAUNCH_ROS_SOURCE", "ros2/launch_ros", "launch_ros", "ros2launch", "launch_testing_ros"),
    # `ros2 pkg create` asks it for the texts of licences.
    _pinned("ROS2_LINT_SOURCE", "ament/ament_lint", "ament_copyright"),
    _pinned(
        "ROS2_CLI_SOURCE",
        "ros2/ros2cli",
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
)


def python_packages(sources: Sequence[Source] = SOURCES) -> dict[str, str]:
    """Return the pinned versions of the Python packages of the sources, by the packages' names."""
    return {
        Path(source.url).stem if package == "." else package: source.tag
        for source in sources
        if not source.built
        for package in source.packages
    }


def installed_packages(names: Iterable[str]) -> dict[str, str]:
    """Return the versions of those of some Python packages that are installed here, by their names."""
    versions: dict[str, str] = {}
    for name in names:
        with suppress(PackageNotFoundError):
            versions[name] = version(name)
    return versions


def describe_launch() -> str:
    """Return the installed `launch` and `ros2`: the versions of the real packages, or "stand-ins"."""
    installed = installed_packages(("launch", "launch_ros", "ros2cli"))
    return ", ".join(f"{name} {number}" for name, number in installed.items()) or STANDINS
