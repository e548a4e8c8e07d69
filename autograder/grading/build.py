"""Building a student's packages: colcon, in a sandbox that has no network."""

from __future__ import annotations

import os
import sys
import time
import xml.etree.ElementTree as ET
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.grading.slim import slim_interfaces
from autograder.lab.workspace import Workspace
from autograder.lockstep.failures import tail
from autograder.result import Build
from autograder.sandbox import Ending, Mount, Sandbox
from autograder.sandbox.launcher import launch
from autograder.sandbox.limits import BUILD

MAX_MANIFEST = 64 * 1024
LOG_LINES = 40


def find_packages(source: Path) -> tuple[dict[str, Path], dict[Path, str]]:
    """Return the packages by name, and what is wrong with each folder whose package.xml cannot be read."""
    found: dict[str, Path] = {}
    broken: dict[Path, str] = {}
    for manifest in sorted(source.rglob("package.xml")):
        where = manifest.relative_to(source)
        if manifest.stat().st_size > MAX_MANIFEST:
            broken[manifest.parent] = f"src/{where} is far larger than a manifest."
            continue
        try:
            found[ET.fromstring(manifest.read_bytes()).findtext("name", "").strip()] = manifest.parent
        except ET.ParseError as error:
            sentence = f"src/{where} is no well-formed XML ({error}): mend that line, colcon cannot read the package."
            broken[manifest.parent] = sentence
    return found, broken


def require_packages(source: Path, wanted: tuple[str, ...], *, whole: bool = True) -> None:
    """See that the wanted packages are there and whole enough for colcon to build.

    Args:
        source: the workspace's `src` folder.
        wanted: the packages' names.
        whole: whether each needs the files that every Python package of ROS 2 has; if not, colcon is left to judge.

    Raises:
        StudentError: one is missing, cannot be read, or lacks such a file.
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
    """Run `colcon build` on the wanted packages of a workspace and on those that they depend on.

    Raises:
        StudentError: it did not build; the detail holds the end of colcon's output.
    """
    started = time.monotonic()
    packages = tuple(sorted(find_packages(workspace.root / "src")[0]))
    colcon = str(Path(sys.executable).with_name("colcon"))
    command = [sys.executable, colcon, "--log-base", str(workspace.scratch / "colcon-log"), "build"]
    command += ["--base-paths", "src", "--event-handlers", "console_cohesion+", "desktop_notification-"]
    command += ["--packages-up-to", *wanted]
    environment = workspace.environment()
    slim = slim_interfaces(workspace.ros.prefixes, workspace.scratch / "cmake-overlay")
    environment |= {
        "CMAKE_PREFIX_PATH": os.pathsep.join([str(slim), environment["CMAKE_PREFIX_PATH"]]),
        "COLCON_HOME": str(workspace.scratch),
        "MAKEFLAGS": f"-j{min(3, (os.cpu_count() or 1) + 1)}",
    }
    system = tuple(Mount(prefix) for prefix in workspace.ros.prefixes if workspace.ros.kind == "sourced")
    spec = Sandbox(
        workdir=workspace.root,
        mounts=(
            *system,
            *(Mount(space) for space in workspace.underlays),
            Mount(workspace.root, writable=True),
            Mount(workspace.scratch, writable=True),
        ),
        environment=environment,
        limits=BUILD,
    )
    with launch(command, spec) as process:
        process.wait(BUILD.wall_seconds + 10)
        output, ending, status = process.output, process.ending, process.returncode
    log = tail(output, LOG_LINES)
    if ending is not Ending.EXITED or status != 0:
        raise StudentError(Diagnosis(Kind.BUILD_FAILED, _build_failure(output, ending), log))
    require_contained(workspace.install)
    return Build(True, round(time.monotonic() - started, 2), packages, log)


def require_contained(install: Path) -> None:
    """See that no link leads out of the install space: it is mounted for nodes, and a mount would follow the link.

    Raises:
        StudentError: one does, or the folders are nested too deep to look at.
    """
    pending = [install]
    while pending:
        path = pending.pop()
        try:
            inside = path.resolve().is_relative_to(install.parent.resolve() / install.name)
            children = [] if path.is_symlink() or not path.is_dir() else list(path.iterdir())
        except (OSError, RuntimeError):  # a name too long, a loop of links
            inside, children = False, []
        if not inside:
            sentence = (
                f"The build left {str(path.relative_to(install.parent))[:200]}, which leads out of the install space: "
                "setup.py and CMakeLists.txt must install files, not links to other places."
            )
            raise StudentError(Diagnosis(Kind.BUILD_FAILED, sentence))
        pending += children


def _missing(source: Path, name: str, found: dict[str, Path]) -> str:
    if not source.is_dir():
        return f"There is no ws/src folder: create the package {name} in it."
    if (source / name).is_dir():
        return f"src/{name} has no package.xml with <name>{name}</name>: without it colcon does not see a package."
    others = ", ".join(sorted(found)) or "no package at all"
    return f"The package {name} is missing: src holds {others}."


def _build_failure(output: str, ending: Ending | None) -> str:
    if ending is not Ending.EXITED and ending is not None:
        return (
            f"colcon build was stopped ({ending.value.replace('_', ' ')}): a build should end within a minute or two."
        )
    if "specified with --packages-up-to was not found" in output:
        return (
            "colcon does not see the package, because its package.xml breaks a rule of ROS: run colcon build and read what "
            "follows “Failed to parse ROS package manifest”."
        )
    # Before that, colcon only looks at what lies in src, and complains of packages that this build does not need.
    output = output[max(output.find("Starting >>> "), 0) :]
    errors = [line.strip() for line in output.splitlines() if "Error" in line or "error:" in line]
    first = f" The first error: {errors[0][:300]}" if errors else ""
    return f"colcon build failed.{first}"
