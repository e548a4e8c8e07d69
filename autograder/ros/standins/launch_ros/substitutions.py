"""Substitutions that find packages, and files in them, through the ament index."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.substitutions import SubstitutionFailure
from launch.substitutions.paths import DirectorySubstitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from standin_notice import make_getattr

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]


def _describe(parts: list[Substitution]) -> str:
    return " + ".join(part.describe() for part in parts)


class FindPackage(DirectorySubstitution):
    """A folder of a package; raises PackageNotFoundError if the package is not in the ament index."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def describe(self) -> str:
        """Return a description with the package."""
        return f"{type(self).__name__}(pkg={_describe(self.package)})"

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
        return f"ExecInPkg(pkg={_describe(self.package)}, exec={_describe(self.executable)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the path; raise SubstitutionFailure if the package has no such executable."""
        executable = perform_substitutions(context, self.executable)
        package = perform_substitutions(context, self.package)
        prefix = super().perform(context)
        libexec = Path(prefix, "lib", package)
        if not libexec.exists():
            raise SubstitutionFailure(
                f"package '{package}' found at '{prefix}', but libexec directory '{libexec}' does not exist"
            )
        path = shutil.which(executable, path=os.fspath(libexec))
        if path is None:
            raise SubstitutionFailure(f"executable '{executable}' not found on the libexec directory '{libexec}' ")
        return path


class Parameter(Substitution):
    """The value of a parameter that was set for all nodes, as text."""

    def __init__(self, name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        is_single = isinstance(default, (str, Substitution)) or not isinstance(default, Iterable)
        items = [default] if is_single else default
        self.default = (
            None
            if default is None
            else normalize_to_list_of_substitutions([x if isinstance(x, Substitution) else str(x) for x in items])
        )

    def describe(self) -> str:
        """Return a description with the name."""
        return f"Parameter(name={_describe(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default; raise SubstitutionFailure without either."""
        name = perform_substitutions(context, self.name)
        for item in context.launch_configurations.get("global_params", ()):
            if isinstance(item, tuple) and item[0] == name:
                return str(item[1])
        if self.default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return perform_substitutions(context, self.default)


__getattr__ = make_getattr(__name__)
