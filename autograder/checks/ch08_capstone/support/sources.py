"""The folders of the student's two packages, and whether they were built."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from autograder.checking import OK, CheckFailed, Diagnosis, Kind, Workspace, explain, find_packages


def source_of(workspace: Workspace, package: str) -> Path:
    """Return the folder of a package's source.

    Raises:
        CheckFailed: there is no such package.
    """
    source = workspace.root / "src"
    packages, broken = find_packages(source)
    folder = packages.get(package)
    if folder is None:
        sentence = broken.get(source / package, f"There is no package {package} in src.")
        raise CheckFailed(explain(Diagnosis(Kind.MISSING_PACKAGE, sentence), source, package).sentence)
    return folder


def require_built(builds: Mapping[str, Diagnosis], *packages: str) -> None:
    """Fail the check unless colcon has built the packages.

    Raises:
        CheckFailed: a package was not built; the message says why.
    """
    for package in packages:
        if builds[package] is not OK:
            raise CheckFailed(f"{package} was not built: {builds[package].sentence}")
