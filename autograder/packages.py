"""Finds the ROS 2 packages of a source tree by their package.xml. Nothing is imported or executed."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

MANIFEST = "package.xml"
MAX_MANIFEST = 64 * 1024  # bytes
DEPENDS = ("depend", "build_depend", "build_export_depend", "exec_depend", "buildtool_depend")


@dataclass(frozen=True)
class PackageSummary:
    """The name, dependencies and groups in a package.xml. `probes.manifest` validates, this does not."""

    name: str
    depends: tuple[str, ...]
    groups: frozenset[str]


def read_summary(manifest: Path) -> PackageSummary:
    """Read a package.xml; an `ElementTree.ParseError` if it is not well-formed."""
    root = ET.fromstring(manifest.read_bytes())
    return PackageSummary(
        name=root.findtext("name", "").strip(),
        depends=tuple(each.text.strip() for tag in DEPENDS for each in root.iter(tag) if each.text),
        groups=frozenset((each.text or "").strip() for each in root.iter("member_of_group")),
    )


def find_packages(source: Path) -> tuple[dict[str, Path], dict[Path, str]]:
    """Find the packages below a folder: each one's folder by its name, and an error by each unreadable one's folder."""
    found: dict[str, Path] = {}
    broken: dict[Path, str] = {}
    for manifest in sorted(source.rglob(MANIFEST)):
        # To read a named pipe, which a set-up script may have made, would never end.
        if manifest.is_symlink() or not manifest.is_file():
            continue
        where = manifest.relative_to(source)
        if manifest.stat().st_size > MAX_MANIFEST:
            broken[manifest.parent] = f"src/{where} is larger than {MAX_MANIFEST // 1024} KiB: shorten it."
            continue
        try:
            found[read_summary(manifest).name] = manifest.parent
        except ET.ParseError as error:
            sentence = f"src/{where} is not well-formed XML ({error}): correct that line for colcon."
            broken[manifest.parent] = sentence
    return found, broken
