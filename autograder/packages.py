"""The ROS 2 packages of a source tree, by the names in their manifests. Texts only: nothing is imported or run."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

MAX_MANIFEST = 64 * 1024


def find_packages(source: Path) -> tuple[dict[str, Path], dict[Path, str]]:
    """Return the packages by name, and what is wrong with each folder whose package.xml cannot be read."""
    found: dict[str, Path] = {}
    broken: dict[Path, str] = {}
    for manifest in sorted(source.rglob("package.xml")):
        if manifest.is_symlink() or not manifest.is_file():  # a set-up script may have left a pipe that nobody fills
            continue
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
