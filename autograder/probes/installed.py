"""Reads the installed files of a Python package. Checks judge setup.py and setup.cfg by these files, not by their text.

Only plain files are read. No link out of the install space is followed, and nothing is imported.
"""

from __future__ import annotations

import configparser
import os
from collections.abc import Mapping
from dataclasses import dataclass
from email.parser import HeaderParser
from pathlib import Path

from autograder.probes.files import plain_files, read_below, read_limited, read_plain
from autograder.submission.reading import reading, reason
from autograder.suite import CheckFailed

MAX_FILES = 2000
MAX_BYTES = 256 * 1024
INDEX = Path("share/ament_index/resource_index/packages")


@dataclass(frozen=True)
class Installed:
    """A package's install prefix, `install/PACKAGE` in colcon's isolated layout."""

    package: str  # the package's name
    prefix: Path  # the folder of the prefix
    executables: tuple[str, ...]  # names in lib/PACKAGE, where `ros2 run` and launch files look
    misplaced: tuple[str, ...]  # names in bin/, where they do not
    # Dotted names of the installed Python modules and packages, including those that belong to another ROS package.
    modules: frozenset[str]
    marker: bool  # whether the ament index lists the package
    shared: tuple[str, ...]  # paths below share/PACKAGE, without those that colcon itself adds
    # Files that setup.py itself installed, below the prefix. colcon adds a marker and package.xml.
    recorded: frozenset[str]
    extras: Mapping[str, tuple[str, ...]]  # the requirements of each extra, such as `test`
    metadata: Mapping[str, str]  # headers such as Version, License, Maintainer-email
    programs: Mapping[str, str]  # the module of each program, both as named in setup.py
    classifiers: tuple[str, ...]  # as listed in setup.py

    @property
    def setup_name(self) -> str:
        """The package's name in setup.py, or an empty string; setuptools may have written - for _."""
        return self.metadata.get("Name", "").replace("-", "_")

    def read(self, name: str) -> bytes | None:
        """Return a file of share/PACKAGE, or None if it does not exist, is not a plain file or is too large."""
        return read_below(self.prefix, Path("share", self.package, name), MAX_BYTES)


def inspect_package(install: Path, package: str) -> Installed:
    """Return the installed files of a package; there are none if it was not installed.

    Raises:
        CheckFailed: there are more than `MAX_FILES`, or the metadata are too large or cannot be parsed.
    """
    with reading(f"The files that colcon installed for {package}"):
        return _inspect_package(install, package)


def _inspect_package(install: Path, package: str) -> Installed:
    prefix = install / package
    # There is only one, because its name contains the version of Python that built the package.
    sites = [path for path in sorted(prefix.glob("lib/python3*/site-packages")) if not path.is_symlink()]
    modules = frozenset(name for site in sites for file in _files(site) if (name := _module(file)))
    eggs = [egg for site in sites for egg in sorted(site.glob("*-info")) if egg.is_dir() and not egg.is_symlink()]
    own_metadata = [egg for egg in eggs if egg.name.lower().replace("-", "_").startswith(package.lower())]
    share = prefix / "share" / package
    return Installed(
        package=package,
        prefix=prefix,
        executables=_executables(prefix / "lib" / package),
        misplaced=_executables(prefix / "bin"),
        modules=modules,
        marker=read_plain(prefix / INDEX / package, MAX_BYTES) is not None,
        shared=tuple(name for name in _files(share) if not _is_added_by_colcon(name)),
        recorded=_recorded_files(install, package),
        extras=_extras(_join_files(own_metadata, "requires.txt")),
        metadata=dict(HeaderParser().parsestr(_join_files(own_metadata, "PKG-INFO")).items()),
        programs=_programs(_join_files(eggs, "entry_points.txt")),
        classifiers=tuple(HeaderParser().parsestr(_join_files(eggs, "PKG-INFO")).get_all("Classifier", [])),
    )


def _files(folder: Path) -> tuple[str, ...]:
    return tuple(map(str, plain_files(folder, MAX_FILES)))


def _recorded_files(install: Path, package: str) -> frozenset[str]:
    """Return the files that setup.py installed, according to the log that it writes in the build space."""
    log = read_below(install.parent / "build", Path(package, "install.log"), MAX_BYTES) or b""
    text = log.decode(errors="replace")
    below = [line.partition(f"/{install.name}/{package}/") for line in text.splitlines()]
    return frozenset(name for _, separator, name in below if separator)


def _join_files(folders: list[Path], name: str) -> str:
    files = [read_limited(folder / name, MAX_BYTES, f"The installed {folder.name}/{name}") for folder in folders]
    return "\n".join(data.decode(errors="replace") for data in files)


def _executables(folder: Path) -> tuple[str, ...]:
    return tuple(name for name in _files(folder) if os.access(folder / name, os.X_OK))


def _module(file: str) -> str | None:
    """Return the dotted name of a module's file, or None for any other file."""
    if not file.endswith(".py"):
        return None
    parts = file.removesuffix(".py").split("/")
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _is_added_by_colcon(name: str) -> bool:
    return name.startswith("hook/") or (name.startswith("package.") and name != "package.xml")


def _programs(text: str) -> dict[str, str]:
    parser = configparser.ConfigParser(delimiters=("=",), interpolation=None, strict=False)
    try:
        parser.read_string(text)
    except configparser.Error as error:
        raise CheckFailed(f"The installed entry_points.txt cannot be parsed: {reason(error)}.") from None
    entries = parser.items("console_scripts") if parser.has_section("console_scripts") else []
    return {name: entry.partition(":")[0].strip() for name, entry in entries}


def _extras(text: str) -> dict[str, tuple[str, ...]]:
    extras: dict[str, list[str]] = {}
    section = None
    for line in filter(None, map(str.strip, text.splitlines())):
        if line.startswith("[") and line.endswith("]"):
            section = extras.setdefault(line[1:-1].split(":")[0], [])
        elif section is not None:
            section.append(line)
    return {name: tuple(lines) for name, lines in extras.items()}
