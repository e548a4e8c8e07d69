"""Adds files to a copy of the student's package, whose unchanged setup.py has to install them."""

from __future__ import annotations

from dataclasses import dataclass

from autograder.checking import Workspace
from autograder.checking.probes import added_files, installed
from autograder.checks.ch01_package_structure.support import contract


@dataclass(frozen=True)
class ExtendedPackage:
    """An installed copy of the student's package, and its new files.

    Attributes:
        installation: the files that colcon installed.
        shared: the new launch file and the new configuration.
        modules: the new modules, each in its own subpackage; one subpackage is nested, and its name contains "test".
    """

    installation: installed.Installed
    shared: tuple[str, ...]
    modules: tuple[str, ...]

    @property
    def missing(self) -> list[str]:
        """The new files and modules that were not installed."""
        files = [name for name in self.shared if self.installation.read(name) is None]
        return files + [name for name in self.modules if name not in self.installation.modules]


def extend(workspace: Workspace, word: str) -> ExtendedPackage:
    """Copy the student's package, add files to it and build the copy.

    Args:
        workspace: the built workspace, which is not changed.
        word: a word in the names of the new files, so that no handwritten list contains these names.

    Raises:
        StudentError: the copy does not build.
    """
    name = contract.SQUARE_DANCE
    shared, tests = (f"launch/{word}.launch.py", f"config/{word}.yaml"), (f"test/test_{word}.py", "test/__init__.py")
    folders = f"{name}/{word}", f"{name}/utils/contest_{word}"
    code = [f"{folder}/{file}.py" for folder in folders for file in ("__init__", "steps")]
    return ExtendedPackage(
        added_files.install_with(workspace, name, (*shared, *tests, *code)),
        shared,
        tuple(f"{folder.replace('/', '.')}.steps" for folder in folders),
    )
