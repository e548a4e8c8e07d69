"""The versions of Ubuntu 24.04, the platform of Jazzy, of what students' programs, builds and tests meet.

`pyproject.toml` asks for them. `docs/platform.md` and the doctor tell where others are installed. The versions are from
https://packages.ubuntu.com/noble; catkin_pkg's is that of ROS's own package repository.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class PlatformPackage:
    """A Python package as Ubuntu 24.04 has it.

    Attributes:
        name: what pip calls it.
        debian: what apt calls it.
        version: the version of Ubuntu 24.04.
        meets: where a student meets it.
        differs: why another version may be installed; empty where none may.
    """

    name: str
    debian: str
    version: str
    meets: str
    differs: str = ""


PACKAGES = (
    PlatformPackage("pytest", "python3-pytest", "7.4.4", "`colcon test`, chapter 6"),
    PlatformPackage("pluggy", "python3-pluggy", "1.4.0", "the plug-ins of pytest, `launch_testing` for one"),
    PlatformPackage("setuptools", "python3-setuptools", "68.1.2", "`setup.py` of each Python package"),
    PlatformPackage("wheel", "python3-wheel", "0.42.0", "nothing of a student's; setuptools asks for it"),
    PlatformPackage("packaging", "python3-packaging", "24.0", "setuptools and pytest read versions with it"),
    PlatformPackage("flake8", "flake8", "7.0.0", "`ament_flake8`"),
    PlatformPackage("pycodestyle", "python3-pycodestyle", "2.11.1", "`ament_flake8`"),
    PlatformPackage("pyflakes", "python3-pyflakes", "3.2.0", "`ament_flake8`"),
    PlatformPackage("mccabe", "python3-mccabe", "0.7.0", "`ament_flake8`"),
    PlatformPackage("pydocstyle", "python3-pydocstyle", "6.3.0", "`ament_pep257`"),
    PlatformPackage(
        "pyyaml",
        "python3-yaml",
        "6.0.1",
        "files of parameters",
        "6.0.1 has no wheel for Python 3.13 and does not compile there; 6.0.2 is the first that has one",
    ),
    PlatformPackage("lark", "python3-lark", "1.1.9", "`.msg`, `.srv` and `.action` files"),
    PlatformPackage("empy", "python3-empy", "3.3.4", "the code of messages, which rosidl writes from templates"),
    PlatformPackage("catkin-pkg", "python3-catkin-pkg", "1.0.0", "`package.xml`"),
    PlatformPackage(
        "numpy",
        "python3-numpy",
        "1.26.4",
        "arrays in messages",
        "1.26 has no wheel for Python 3.13; 2.1 is the first that has one",
    ),
    PlatformPackage("cmake", "cmake", "3.28.3", "packages with messages of their own"),
    PlatformPackage("ninja", "ninja-build", "1.11.1", "`colcon build --cmake-args -G Ninja`"),
)


def differences(installed: Mapping[str, str | None]) -> dict[PlatformPackage, str | None]:
    """Return the packages whose version is another than that of Ubuntu 24.04, each with the version that is there.

    Args:
        installed: the version of each package by pip's name; None for one that is not there.
    """
    return {package: installed[package.name] for package in PACKAGES if installed[package.name] != package.version}
