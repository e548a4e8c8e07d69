"""The ROS 2 packages of a source tree, by the names in their manifests. Texts only: nothing is imported or run."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

MANIFEST = "package.xml"
MAX_MANIFEST = 64 * 1024  # bytes
DEPENDS = ("depend", "build_depend", "build_export_depend", "exec_depend", "buildtool_depend")


@dataclass(frozen=True)
class PackageTexts:
    """What a package.xml names, as its text has it: whether ROS would accept it, `probes.manifest` says.

    Attributes:
        name: the package's.
        depends: what it needs to be built and to run.
        groups: of which dependency groups it is a member.
    """

    name: str
    depends: tuple[str, ...]
    groups: frozenset[str]


def read_texts(manifest: Path) -> PackageTexts:
    """Read a package.xml of at most `MAX_MANIFEST` bytes.

    Raises:
        xml.etree.ElementTree.ParseError: it is no well-formed XML.
    """
    root = ET.fromstring(manifest.read_bytes())
    return PackageTexts(
        name=root.findtext("name", "").strip(),
        depends=tuple(each.text.strip() for tag in DEPENDS for each in root.iter(tag) if each.text),
        groups=frozenset((each.text or "").strip() for each in root.iter("member_of_group")),
    )


def find_packages(source: Path) -> tuple[dict[str, Path], dict[Path, str]]:
    """Return the packages by name, and what is wrong with each folder whose package.xml cannot be read."""
    found: dict[str, Path] = {}
    broken: dict[Path, str] = {}
    for manifest in sorted(source.rglob(MANIFEST)):
        if manifest.is_symlink() or not manifest.is_file():  # a set-up script may have left a pipe that nobody fills
            continue
        where = manifest.relative_to(source)
        if manifest.stat().st_size > MAX_MANIFEST:
            broken[manifest.parent] = f"src/{where} is far larger than a manifest."
            continue
        try:
            found[read_texts(manifest).name] = manifest.parent
        except ET.ParseError as error:
            sentence = f"src/{where} is no well-formed XML ({error}): mend that line, colcon cannot read the package."
            broken[manifest.parent] = sentence
    return found, broken
