"""Reads a package's manifest, package.xml, with catkin_pkg, as rosdep and colcon do."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from catkin_pkg.package import InvalidPackage, parse_package_string  # type: ignore[import-untyped]

from autograder.probes.files import read_plain
from autograder.ros.distribution import DISTRIBUTION
from autograder.submission.exercise_stubs import STILL_TO_BE_WRITTEN
from autograder.submission.packages import MANIFEST, MAX_MANIFEST
from autograder.suite import CheckFailed

PLACEHOLDER = "TODO"

# The kinds of dependency. A <depend> is a build, a build_export and an exec dependency.
KINDS = ("build", "build_export", "buildtool", "exec", "test", "doc")


@dataclass(frozen=True)
class Manifest:
    """A parsed package.xml."""

    name: str
    version: str
    description: str
    format: int
    licences: tuple[str, ...]  # each <license>, as written
    maintainers: tuple[tuple[str, str], ...]  # each (name, e-mail)
    build_type: str  # the text of <build_type> in <export>; without it, ROS treats it as an old CMake package
    depends: Mapping[str, frozenset[str]]  # names by kind, of those whose condition is true in this ROS
    groups: frozenset[str]  # the dependency groups

    def needs(self, *kinds: str) -> frozenset[str]:
        """Return the names of the dependencies of the given kinds; of all kinds if none is given."""
        return frozenset().union(*(self.depends[kind] for kind in kinds or KINDS))


def read(package: Path) -> Manifest:
    """Read the manifest of the package in a folder. Raise a CheckFailed with the reason if ROS rejects it."""
    return parse(_text(package), _file_name(package))


def read_leniently(package: Path) -> Manifest:
    """Read the tags of a manifest, even if ROS rejects it as a whole. Raise a CheckFailed if it is not XML.

    A manifest that ROS accepts is read as by `read`. In any other, conditions are ignored.
    """
    text, file_name = _text(package), _file_name(package)
    try:
        return parse(text, file_name)
    except CheckFailed:
        _refuse_unsafe(text, file_name)
        try:
            root = ElementTree.fromstring(text)
        except ElementTree.ParseError as error:
            raise CheckFailed(f"{file_name} is not well-formed XML: {error}") from None
        return _parse_tags(root)


def _file_name(package: Path) -> str:
    return f"{package.name}/{MANIFEST}"


def _text(package: Path) -> str:
    path = package / MANIFEST
    if path.is_symlink() or not path.is_file():
        raise CheckFailed(f"{package.name} has no {MANIFEST}.")
    data = read_plain(path, MAX_MANIFEST)
    if data is None:
        raise CheckFailed(f"{package.name}/{MANIFEST} is far larger than a manifest.")
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise CheckFailed(f"{package.name}/{MANIFEST} is not UTF-8 text.") from None


def parse(text: str, file_name: str = MANIFEST) -> Manifest:
    """Read a manifest's text. If ROS rejects it, raise a CheckFailed with the reason, which calls it `file_name`."""
    _refuse_unsafe(text, file_name)
    try:
        package = parse_package_string(text, file_name)
    except InvalidPackage as error:
        raise CheckFailed(f"ROS refuses {file_name}: {_reason(error)}") from None
    except Exception as error:  # from expat or catkin_pkg, such as TypeError for a file of bytes
        raise CheckFailed(f"{file_name} is not well-formed XML: {error}") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # from pyparsing, which catkin_pkg uses
            package.evaluate_conditions(DISTRIBUTION.variables)
    except (ValueError, RecursionError) as error:
        raise CheckFailed(f"A condition in {file_name} cannot be read: {error}") from None
    exports = [export for export in package.exports if export.evaluated_condition]
    return Manifest(
        name=package.name,
        version=package.version,
        description=package.description,
        format=package.package_format,
        licences=tuple(str(licence) for licence in package.licenses),
        maintainers=tuple((person.name, person.email or "") for person in package.maintainers),
        build_type=next((export.content or "" for export in exports if export.tagname == "build_type"), ""),
        depends={
            kind: frozenset(item.name for item in getattr(package, f"{kind}_depends") if item.evaluated_condition)
            for kind in KINDS
        },
        groups=frozenset(group.name for group in package.member_of_groups if group.evaluated_condition),
    )


def _refuse_unsafe(text: str, file_name: str) -> None:
    if STILL_TO_BE_WRITTEN in text:
        raise CheckFailed(f"{file_name} is still to be written.")
    # No manifest needs a document type, whose entities can expand a small file to a huge one.
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise CheckFailed(f"{file_name} has a <!DOCTYPE> or <!ENTITY>, which no manifest needs.")


def _parse_tags(root: ElementTree.Element) -> Manifest:
    def texts(tag: str) -> tuple[str, ...]:
        return tuple(" ".join("".join(element.itertext()).split()) for element in root.findall(tag))

    depend_kinds = ("build", "build_export", "exec")  # the kinds that a <depend> declares
    format_text = root.get("format", "1")
    return Manifest(
        name="".join(texts("name")[:1]),
        version="".join(texts("version")[:1]),
        description="".join(texts("description")[:1]),
        format=int(format_text) if format_text in ("1", "2", "3") else 0,
        licences=texts("license"),
        maintainers=tuple(
            ("".join(element.itertext()).strip(), element.get("email", "")) for element in root.findall("maintainer")
        ),
        build_type="".join(texts("export/build_type")[:1]),
        depends={
            kind: frozenset(texts(f"{kind}_depend")) | frozenset(texts("depend") if kind in depend_kinds else ())
            for kind in KINDS
        },
        groups=frozenset(texts("member_of_group")),
    )


def _reason(error: InvalidPackage) -> str:
    """Return catkin_pkg's message without the headline, which repeats the path."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    messages = [line for line in lines if not line.startswith("Error(s) in ")] or lines
    return "; ".join(messages).replace(":; ", ": ")
