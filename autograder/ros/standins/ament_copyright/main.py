"""The check: find the files, check each, print the errors, and optionally write an xunit file."""

from __future__ import annotations

import argparse
import sys
import time
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from standin_notice import make_getattr

from .headers import IDENTIFIERS, UNKNOWN, licence_of_text, read_header

EXTENSIONS = ("c", "cc", "cpp", "cxx", "h", "hh", "hpp", "hxx", "cmake", "py")


@dataclass(frozen=True)
class FileResult:
    """The result of checking one file."""

    path: Path
    passed: bool
    message: str


def main(argv: Sequence[str] | None = None) -> int:
    """Check the files under the given paths; return 0 if all of them pass, otherwise 1."""
    start = time.monotonic()
    args = _parser().parse_args(argv)
    if args.list_licenses:
        print(*sorted(IDENTIFIERS), sep="\n")
        return 0
    results = [check_file(path) for path in sorted(find_files([Path(p) for p in args.paths], args.exclude))]
    if not results:
        print("No repository roots and files found")
    for result in results:
        if args.verbose or not result.passed:
            print(f"{result.path}: {result.message}", file=sys.stdout if result.passed else sys.stderr)
    errors = sum(not result.passed for result in results)
    if errors:
        print(f"{errors} errors, checked {len(results)} files", file=sys.stderr)
    else:
        print(f"No problems found, checked {len(results)} files")
    if args.xunit_file:
        _write_xunit(Path(args.xunit_file), results, time.monotonic() - start)
    return 1 if errors else 0


def find_files(paths: Sequence[Path], excluded: Sequence[str] = ()) -> Iterator[Path]:
    """Yield the source files under the paths, and LICENSE beside each package.xml.

    Folders whose names start with `.` or `_` are skipped, as is `setup.py` beside a `package.xml`.
    """
    for path in paths:
        if path.is_file():
            candidates = [path]
        else:
            candidates = [
                file
                for file in path.rglob("*")
                if file.is_file() and not any(part.startswith((".", "_")) for part in file.relative_to(path).parts[:-1])
            ]
        for file in candidates:
            beside_package = (file.parent / "package.xml").is_file()
            if file.name in excluded or (file.name == "setup.py" and beside_package):
                continue
            if file.suffix.lstrip(".") in EXTENSIONS or (file.name == "LICENSE" and beside_package):
                yield file


def check_file(path: Path) -> FileResult:
    """Check that a file has a copyright notice and a known licence; an empty source file needs neither."""
    try:
        text = path.read_text(encoding="utf-8")
        header = read_header(path)
    except (OSError, UnicodeDecodeError) as error:
        return FileResult(path, False, f"cannot be read as text: {error}")
    if path.name == "LICENSE":
        licence = licence_of_text(text)
        return FileResult(path, licence != UNKNOWN, licence if text else "file empty")
    if not text:
        return FileResult(path, True, "file empty")
    if not header.copyrights:
        return FileResult(path, False, "could not find copyright notice")
    message = f"copyright={', '.join(header.copyrights)}, license={header.licence}"
    return FileResult(path, header.licence != UNKNOWN, message)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ament_copyright",
        description="Check code files for copyright and license information. "
        "(A stand-in for the real ament_copyright; to have that one, source an installation of ROS 2.)",
    )
    parser.add_argument("paths", nargs="*", default=["."], help="files or folders to check (default: .)")
    parser.add_argument("--exclude", metavar="filename", nargs="*", default=[], help="file names to leave out")
    parser.add_argument("--list-licenses", action="store_true", help="list the names of the known licenses")
    parser.add_argument("--verbose", action="store_true", help="show every file, not only those with errors")
    parser.add_argument("--xunit-file", help="write the results as xunit XML to this file")
    return parser


def _write_xunit(path: Path, results: Sequence[FileResult], elapsed: float) -> None:
    name = f"{path.parent.name}.{path.name.removesuffix('.xml').removesuffix('.xunit')}"
    suite = ET.Element(
        "testsuite",
        name=name,
        tests=str(len(results)),
        errors="0",
        failures=str(sum(not result.passed for result in results)),
        time=f"{elapsed:.3f}",
    )
    for result in results:
        case = ET.SubElement(suite, "testcase", name=str(result.path), classname=name)
        if not result.passed:
            ET.SubElement(case, "failure", message=result.message)
    path.parent.mkdir(parents=True, exist_ok=True)
    ET.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


__getattr__ = make_getattr(__name__)
