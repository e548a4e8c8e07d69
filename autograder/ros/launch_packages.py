"""The source repositories of the real `launch`, `launch_ros` and `ros2cli`, and which of their packages are installed.

Tags and commits are those of `distribution.json`. The records in tests/e2e were written with them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from autograder.ros.distribution import DISTRIBUTION

STANDINS = "stand-ins"  # returned by `describe_launch` if no real package is installed


@dataclass(frozen=True)
class Location:
    """The URL and tag to clone, and the commit that the tag must point to ("" accepts any)."""

    url: str
    tag: str
    commit: str


@dataclass(frozen=True)
class Source:
    """A repository and the packages to take from it.

    Attributes:
        variable: the environment variable that overrides the URL and the tag.
        url: the default URL.
        tag: the tag of a release, which is also the version of the packages.
        commit: the tag's commit, 40 hexadecimal digits.
        packages: folders in the repository, in installation order.
        is_interface: whether the packages define interfaces and are built by colcon. Otherwise, pip builds them.
    """

    variable: str
    url: str
    tag: str
    commit: str
    packages: tuple[str, ...]
    is_interface: bool = False

    def location(self, environ: Mapping[str, str]) -> Location:
        """Return the URL, tag and commit to clone: the pinned ones, unless the variable overrides them."""
        override = environ.get(self.variable)
        if not override:
            return Location(self.url, self.tag, self.commit)
        url, separator, tag = override.rpartition("@")
        # An @ before the last slash or colon belongs to the URL, as in git@host:folder.
        has_tag = separator and not {"/", ":"} & set(tag)
        return Location(url, tag, "") if has_tag else Location(override, self.tag, self.commit)


def _pinned_source(variable: str, repository: str, *packages: str, is_interface: bool = False) -> Source:
    name = repository.rpartition("/")[2]
    url = f"https://github.com/{repository}.git"
    return Source(variable, url, DISTRIBUTION.tags[name], DISTRIBUTION.commits[name], packages, is_interface)


SOURCES = (
    _pinned_source("ROS2_INTERFACES_SOURCE", "ros2/rcl_interfaces", "composition_interfaces", is_interface=True),
    _pinned_source("ROS2_RUNTIME_SOURCE", "ros2/rosidl_runtime_py", "."),
    _pinned_source(
        "ROS2_LAUNCH_SOURCE",
        "ros2/launch",
        "launch",
        "launch_xml",
        "launch_yaml",
        "launch_testing",
        "launch_pytest",
    ),
    _pinned_source("ROS2_LAUNCH_ROS_SOURCE", "ros2/launch_ros", "launch_ros", "ros2launch", "launch_testing_ros"),
    # `ros2 pkg create` reads the licence texts from it.
    _pinned_source("ROS2_LINT_SOURCE", "ament/ament_lint", "ament_copyright"),
    _pinned_source(
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
    """Return the pinned version of each Python package in the sources, by its name."""
    return {
        Path(source.url).stem if package == "." else package: source.tag
        for source in sources
        if not source.is_interface
        for package in source.packages
    }


def installed_packages(names: Iterable[str]) -> dict[str, str]:
    """Return the versions of those Python packages among `names` that are installed."""
    versions: dict[str, str] = {}
    for name in names:
        with suppress(PackageNotFoundError):
            versions[name] = version(name)
    return versions


def describe_launch() -> str:
    """Return the versions of the real `launch`, `launch_ros` and `ros2cli`, or "stand-ins" if none is installed."""
    installed_versions = installed_packages(("launch", "launch_ros", "ros2cli"))
    return ", ".join(f"{name} {number}" for name, number in installed_versions.items()) or STANDINS
