"""Substitutions that find packages, and what is in them, through the ament index."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from standin_notice import guard

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]


def _described(parts: list[Substitution]) -> str:
    return " + ".join(part.describe() for part in parts)


class FindPackage(Substitution):
    """A folder of a package; PackageNotFoundError if the package is not in the ament index."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def describe(self) -> str:
        """Return a description with the package."""
        return f"{type(self).__name__}(pkg={_described(self.package)})"

    def find(self, package_name: str) -> str:
        """Return the folder."""
        raise NotImplementedError

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return self.find(perform_substitutions(context, self.package))


class FindPackagePrefix(FindPackage):
    """The prefix in which a package is installed."""

    def find(self, package_name: str) -> str:
        """Return the prefix."""
        return str(get_package_prefix(package_name))


class FindPackageShare(FindPackage):
    """The share folder of a package."""

    def find(self, package_name: str) -> str:
        """Return the share folder."""
        return str(get_package_share_directory(package_name))


class ExecutableInPackage(FindPackagePrefix):
    """The path of an executable of a package, which is in ``lib/<package>`` of its prefix."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        super().__init__(package)
        self.executable = normalize_to_list_of_substitutions(executable)

    def describe(self) -> str:
        """Return a description with package and executable."""
        return f"ExecInPkg(pkg={_described(self.package)}, exec={_described(self.executable)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the path; SubstitutionFailure if there is no such executable in the package."""
        executable = perform_substitutions(context, self.executable)
        package = perform_substitutions(context, self.package)
        prefix = super().perform(context)
        libexec = Path(prefix, "lib", package)
        if not libexec.exists():
            raise SubstitutionFailure(
                f"package '{package}' found at '{prefix}', but libexec directory '{libexec}' does not exist"
            )
        found = shutil.which(executable, path=os.fspath(libexec))
        if found is None:
            raise SubstitutionFailure(f"executable '{executable}' not found on the libexec directory '{libexec}' ")
        return found


__getattr__ = guard(__name__)
