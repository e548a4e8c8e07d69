"""Finds the ROS 2 packages of a source tree by their package.xml. Nothing is imported or executed."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.reading import reading

MANIFEST = "package.xml"
MAX_MANIFEST = 64 * 1024  # bytes
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}")  # what colcon takes, and what can be the name of a folder
DEPENDS = ("depend", "build_depend", "build_export_depend", "exec_depend", "buildtool_depend")


@dataclass(frozen=True)
class Package:
    """A package's folder, and what its package.xml says. `probes.manifest` validates that, this does not."""

    folder: Path
    name: str
    depends: tuple[str, ...]
    groups: frozenset[str]


def read_package(manifest: Path, called: str = "") -> Package:
    """Read the package of a package.xml, which a sentence names as `called`; a StudentError says why it cannot."""
    where = called or f"{manifest.parent.name}/{MANIFEST}"
    with reading(where, Kind.HALF_WRITTEN_PACKAGE, "Correct it for colcon."):
        if manifest.stat().st_size > MAX_MANIFEST:
            raise _wrong(f"{where} is larger than {MAX_MANIFEST // 1024} KiB: shorten it.")
        data = manifest.read_bytes()
        if b"<!DOCTYPE" in data.replace(b"\0", b""):  # also in UTF-16; one can make 8 MB of a small file
            raise _wrong(f"{where} has a <!DOCTYPE>, which no manifest needs: take it out.")
        try:
            root = ET.fromstring(data)
        except ET.ParseError as error:
            raise _wrong(f"{where} is not well-formed XML ({error}): correct that line for colcon.") from None
        name = root.findtext("name", "").strip()
        if not NAME.fullmatch(name):
            raise _wrong(f"{where} has the <name> {name[:80]!r}, which is not a package's name: use a-z, 0-9 and _.")
        return Package(
            folder=manifest.parent,
            name=name,
            depends=tuple(each.text.strip() for tag in DEPENDS for each in root.iter(tag) if each.text),
            groups=frozenset((each.text or "").strip() for each in root.iter("member_of_group")),
        )


def read_packages(source: Path) -> tuple[dict[str, Package], dict[Path, str]]:
    """Read the packages below a folder, by their names; those that cannot be read are errors, by their folders."""
    found: dict[str, Package] = {}
    broken: dict[Path, str] = {}
    for manifest in sorted(source.rglob(MANIFEST)):
        # To read a named pipe, which a set-up script may have made, would never end.
        if manifest.is_symlink() or not manifest.is_file():
            continue
        try:
            package = read_package(manifest, f"src/{manifest.relative_to(source)}")
            found[package.name] = package
        except StudentError as error:
            broken[manifest.parent] = error.diagnosis.sentence
    return found, broken


def find_packages(source: Path) -> tuple[dict[str, Path], dict[Path, str]]:
    """Return the folders of the packages below a folder, and the errors, as `read_packages` does."""
    found, broken = read_packages(source)
    return {name: package.folder for name, package in found.items()}, broken


def _wrong(sentence: str) -> StudentError:
    return StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
