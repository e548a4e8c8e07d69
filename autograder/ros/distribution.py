"""The ROS 2 distribution of the course, read from `distribution.json`. No other code repeats facts of that file.

`autograder/bootstrap.py` and the Makefiles read the file themselves, since they run before anything is installed.
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
    """A Python package or tool that pip installs, and its version on the distribution's platform.

    Attributes:
        name: its name in pip.
        debian: its name in apt.
        version: its version on the platform.
        meets: where students use it.
        differs: the reason why a different version may be installed, or an empty string if none may.
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
        title: its name in text.
        rclpy: the major and minor version of its rclpy.
        pythons: the Python versions that its wheels support. The platform's default comes first.
        setup: the file that a shell sources if ROS is installed from packages.
        docs: the URL of its documentation.
        platform: the operating system that it is made for.
        platform_page: the URL of the page that lists the package versions of that system.
        tags: the tag of each source repository that is installed, by the repository's name.
        commits: the commit of each of these tags as 40 hexadecimal digits, a digest of the tag's whole content.
        packages: the packages that students' programs, builds and tests use. Versions are those of `platform_page`,
            except for catkin_pkg, whose version is from ROS's own package repository.
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
        """The environment variables that tell ROS's tools which distribution this is."""
        return {"ROS_DISTRO": self.name, "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}

    @property
    def supported(self) -> str:
        """The supported versions of Python in words, such as `3.10 to 3.13`."""
        first, *_, last = sorted(self.pythons)
        return f"{first} to {last}"

    def differences(self, installed: Mapping[str, str | None]) -> dict[PlatformPackage, str | None]:
        """Return the packages whose installed version differs from the platform's, with the installed version.

        Args:
            installed: the installed version of each package by its name in pip, or None if it is not installed.
        """
        return {p: installed[p.name] for p in self.packages if installed[p.name] != p.version}


DISTRIBUTION = Distribution.read(Path(__file__).with_suffix(".json"))
