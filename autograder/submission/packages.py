"""Finds the ROS 2 packages of a source tree by their package.xml. Nothing is imported or executed."""

from __future__ import annotations

import os
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.reading import reading

MANIFEST = "package.xml"
MAX_MANIFEST = 64 * 1024  # bytes
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}")  # a name that colcon accepts, and that a folder can have
# Files that mark a folder in which colcon does not look for packages.
IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
COLCON_PKG = "colcon.pkg"
MAX_PACKAGES = 50  # more than a course has, and few enough for the command line of colcon
DEPENDS = ("depend", "build_depend", "build_export_depend", "exec_depend", "buildtool_depend")


@dataclass(frozen=True)
class Package:
    """A package's folder, and the content of its package.xml. `autograder.probes.manifest` validates it."""

    folder: Path
    name: str
    depends: tuple[str, ...]
    groups: frozenset[str]


def read_package(manifest: Path, label: str = "") -> Package:
    """Read the package that a package.xml describes. Raises a StudentError that calls the file `label`."""
    label = label or f"{manifest.parent.name}/{MANIFEST}"
    with reading(label, Kind.HALF_WRITTEN_PACKAGE, "Correct it for colcon."):
        if manifest.stat().st_size > MAX_MANIFEST:
            raise _manifest_error(f"{label} is larger than {MAX_MANIFEST // 1024} KiB: shorten it.")
        data = manifest.read_bytes()
        # UTF-16 has null bytes. The entities of a document type can expand a small file to 8 MB.
        if b"<!DOCTYPE" in data.replace(b"\0", b""):
            raise _manifest_error(f"{label} has a <!DOCTYPE>, which no manifest needs: remove it.")
        try:
            root = ET.fromstring(data)
        except ET.ParseError as error:
            raise _manifest_error(f"{label} is not well-formed XML ({error}): correct that line for colcon.") from None
        name = root.findtext("name", "").strip()
        if not NAME.fullmatch(name):
            raise _manifest_error(
                f"{label} has the <name> {name[:80]!r}, which is not a package's name: use a-z, 0-9 and _."
            )
        return Package(
            folder=manifest.parent,
            name=name,
            depends=tuple(element.text.strip() for tag in DEPENDS for element in root.iter(tag) if element.text),
            groups=frozenset((element.text or "").strip() for element in root.iter("member_of_group")),
        )


def read_packages(source: Path) -> tuple[dict[str, Package], dict[Path, str]]:
    """Return the valid packages below a folder by name, and the errors of the invalid ones by folder.

    It looks where colcon looks: not in hidden folders, not below a marker such as COLCON_IGNORE, and not inside other
    packages. `building.colcon` passes these folders to colcon, so that it builds the packages that are graded.

    Raises:
        StudentError: two packages have the same name, or the tree has too many.
    """
    packages: dict[str, Package] = {}
    broken: dict[Path, str] = {}
    for folder in _package_folders(source):
        label = f"src/{(folder / MANIFEST).relative_to(source)}"
        try:
            package = read_package(folder / MANIFEST, label)
            if os.path.lexists(folder / COLCON_PKG):  # it can override the name in the manifest
                raise _manifest_error(
                    f"{label} has a {COLCON_PKG} beside it, which no package of ROS needs: remove it."
                )
        except StudentError as error:
            broken[folder] = error.diagnosis.sentence
            continue
        if (other := packages.get(package.name)) is not None:
            paths = " and ".join(f"src/{path.relative_to(source)}" for path in (other.folder, folder))
            raise _manifest_error(
                f"{paths} are two packages with the name {package.name}: colcon builds neither. Remove one."
            )
        packages[package.name] = package
        if len(packages) > MAX_PACKAGES:
            raise _manifest_error(f"src contains more than {MAX_PACKAGES} packages: remove those that are not yours.")
    return packages, broken


def find_packages(source: Path) -> tuple[dict[str, Path], dict[Path, str]]:
    """Return the folders of the valid packages by name, and the errors as `read_packages` does."""
    packages, broken = read_packages(source)
    return {name: package.folder for name, package in packages.items()}, broken


def _package_folders(source: Path) -> Iterator[Path]:
    for here, folders, files in os.walk(source):
        folder = Path(here)
        if any(os.path.lexists(folder / marker) for marker in IGNORED):
            folders.clear()
        # Reading a named pipe, which a set-up script may have created, would block forever.
        elif MANIFEST in files and not (folder / MANIFEST).is_symlink() and (folder / MANIFEST).is_file():
            folders.clear()
            yield folder
        else:
            folders[:] = sorted(name for name in folders if not name.startswith("."))


def _manifest_error(sentence: str) -> StudentError:
    return StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
