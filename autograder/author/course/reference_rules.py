"""The rules for the reference's packages, and for the Python files beside a chapter's suites."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterator
from pathlib import Path

from autograder import course_paths
from autograder.author.course.findings import Finding, display_path
from autograder.author.course.python_files import read_python

MANIFEST = "package.xml"


def packages_findings(packages: Collection[str]) -> Iterator[Finding]:
    """Yield the problems in these folders of the reference. A folder without a manifest is not a ROS package."""
    for name in packages:
        folder = course_paths.SOLUTIONS / name
        if (folder / MANIFEST).is_file():
            yield from _manifest_findings(folder / MANIFEST, name)
        for path in sorted(folder.rglob("*.py")):
            yield from read_python(path).findings


def python_findings(folder: Path) -> Iterator[Finding]:
    """Yield a finding for each Python file of a chapter's checks that cannot be parsed, except the suites' modules."""
    for path in sorted([*folder.glob("*.py"), *folder.glob("support/**/*.py"), *folder.glob("*/conftest.py")]):
        yield from read_python(path).findings


def _manifest_findings(path: Path, package: str) -> Iterator[Finding]:
    try:
        name = ET.parse(path).getroot().findtext("name")
    except ET.ParseError as error:
        yield Finding(display_path(path), None, f"is not XML: {error}", error.position[0])
        return
    if name != package:
        lines = path.read_text(encoding="utf-8").splitlines()
        line = next((number for number, text in enumerate(lines, 1) if "<name>" in text), 1)
        message = f"names the package {name!r}, but its folder is called {package!r}"
        yield Finding(display_path(path), None, message, line)
