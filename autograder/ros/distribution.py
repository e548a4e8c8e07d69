"""The ROS 2 distribution of the course. Its facts are in `distribution.json` beside this, and nowhere else in code.

`autograder/bootstrap.py` and the Makefiles read that file by themselves, since they run before anything is installed.
`docs/distribution.md` lists the other changes for a course on another distribution.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class PlatformPackage:
    """A package of Python, or a tool that pip installs, as the distribution's platform has it.

    Attributes:
        name: its name in pip.
        debian: its name in apt.
        version: the version of the platform.
        meets: where a student meets it.
        differs: why another version may be installed; empty where none may.
    """

    name: str
    debian: str
    version: str
    meets: str
    differs: str = ""


@dataclass(frozen=True)
class Distribution:
    """A ROS 2 distribution.

    Attributes:
        name: the value of ROS_DISTRO, and the name of branches in ROS's repositories.
        title: how people write it.
        rclpy: the first two numbers of its rclpy's version.
        pythons: the versions of Python that its wheels are for. The platform's own comes first.
        setup: the file that a shell sources if ROS is installed from packages.
        docs: the address of its documentation.
        platform: the system that it belongs to.
        platform_page: the address of the versions of that system.
        tags: the tag that is installed of each source repository, by the repository's name.
        commits: the commit of each of these tags, 40 hexadecimal digits. It is a digest of all that the tag holds.
        packages: what students' programs, builds and tests meet. The versions are those of `platform_page`, and that
            of catkin_pkg is from ROS's own package repository.
    """

    name: str
    title: str
    rclpy: str
    pythons: tuple[str, ...]
    setup: str
    docs: str
    platform: str
    platform_page: str
    tags: Mapping[str, str]
    commits: Mapping[str, str]
    packages: tuple[PlatformPackage, ...]

    @classmethod
    def read(cls, path: Path) -> Distribution:
        """Read the JSON file of a distribution."""
        data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        packages = tuple(PlatformPackage(**package) for package in data["packages"])
        return cls(**{**data, "pythons": tuple(data["pythons"]), "packages": packages})

    @property
    def variables(self) -> dict[str, str]:
        """The environment variables by which ROS's tools know the distribution."""
        return {"ROS_DISTRO": self.name, "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}

    @property
    def supported(self) -> str:
        """The supported versions of Python in words, such as `3.10 to 3.13`."""
        first, *_, last = sorted(self.pythons)
        return f"{first} to {last}"

    def differences(self, installed: Mapping[str, str | None]) -> dict[PlatformPackage, str | None]:
        """Return the packages that are installed in another version than the platform's, each with that version.

        Args:
            installed: the version of each package by pip's name; None for one that is not there.
        """
        return {p: installed[p.name] for p in self.packages if installed[p.name] != p.version}


DISTRIBUTION = Distribution.read(Path(__file__).with_suffix(".json"))
