"""Building a student's packages: colcon, in a sandbox that has no network."""

from __future__ import annotations

import time
from pathlib import Path

from autograder.building.colcon import colcon_build
from autograder.building.interface_bundle import install_bundle, interface_bundle
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.packages import find_packages
from autograder.result import Build
from autograder.workspace import Workspace


def require_packages(source: Path, wanted: tuple[str, ...], *, whole: bool = True) -> None:
    """Raise a StudentError unless the wanted packages in `source` are there and whole enough for colcon to build.

    `whole` says whether each needs the files that every Python package of ROS 2 has; if not, colcon is left to judge.
    """
    found, broken = find_packages(source)
    for name in wanted:
        folder = found.get(name)
        if folder is None and broken:
            sentence = broken.get(source / name, next(iter(broken.values())))
            raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
        if folder is None:
            raise StudentError(Diagnosis(Kind.MISSING_PACKAGE, _missing(source, name, found)))
        if not whole or (folder / "CMakeLists.txt").is_file():
            continue
        for part in ("setup.py", "setup.cfg", f"resource/{name}", f"{name}/__init__.py"):
            if not (folder / part).exists():
                sentence = f"src/{folder.name} has no {part}: the package is only half written, colcon needs that file."
                raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))


def build(workspace: Workspace, wanted: tuple[str, ...]) -> Build:
    """Build the wanted packages of a workspace, and those that they depend on, with colcon.

    Its interface packages come from the cache of builds, where the very same ones were built before.

    Raises:
        StudentError: it did not build; the detail holds the end of colcon's output.
    """
    started = time.monotonic()
    found, _ = find_packages(workspace.root / "src")
    bundle = interface_bundle(found, wanted)
    logs = [install_bundle(bundle, workspace)] if bundle else []
    if set(wanted) - set(bundle):
        skipped = ["--packages-skip", *bundle] if bundle else []
        logs.append(colcon_build(workspace, "--packages-up-to", *wanted, *skipped))
    return Build(True, round(time.monotonic() - started, 2), tuple(sorted(found)), "\n".join(filter(None, logs)))


def _missing(source: Path, name: str, found: dict[str, Path]) -> str:
    if not source.is_dir():
        return f"There is no ws/src folder: create the package {name} in it."
    if (source / name).is_dir():
        return f"src/{name} has no package.xml with <name>{name}</name>: without it colcon does not see a package."
    others = ", ".join(sorted(found)) or "no package at all"
    return f"The package {name} is missing: src holds {others}."
