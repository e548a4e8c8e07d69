"""Finds installed packages and their executables in the ament index."""

from __future__ import annotations

import os
from pathlib import Path

from ament_index_python.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_packages_with_prefixes,
)

from autograder.ros.ros2.exceptions import Ros2Error


def package_names() -> list[str]:
    """Return the names of all installed packages, sorted."""
    return sorted(get_packages_with_prefixes())


def prefix_of(package: str) -> Path:
    """Return the install prefix of a package.

    Raises:
        Ros2Error: no such package is installed.
    """
    try:
        return Path(get_package_prefix(package))
    except (PackageNotFoundError, ValueError):
        raise Ros2Error(f"Package '{package}' not found") from None


def executables_of(package: str) -> list[Path]:
    """Return the executables of a package, in `<prefix>/lib/<package>`, sorted.

    Raises:
        Ros2Error: no such package is installed.
    """
    folder = prefix_of(package) / "lib" / package
    return sorted(path for path in folder.rglob("*") if path.is_file() and os.access(path, os.X_OK))
