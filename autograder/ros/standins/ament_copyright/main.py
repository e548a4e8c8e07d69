"""The check itself: find the files, judge each, print what is wrong, optionally write an xunit file."""

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
class Verdict:
    """What the check found out about one file."""

    path: Path
    fine: bool
    message: str


def main(argv: Sequence[str] | None = None) -> int:
    """Check the files under the given paths; return 0 when every one is in order and 1 otherwise."""
    started = time.monotonic()
    args = _parser().parse_args(argv)
    if args.list_licenses:
        print(*sorted(IDENTIFIERS), sep="\n")
        return 0
    verdicts = [judge(path) for path in sorted(find_files([Path(p) for p in args.paths], args.exclude))]
    if not verdicts:
        print("No repository roots and files found")
    for verdict in verdicts:
        if args.verbose or not verdict.fine:
            print(f"{verdict.path}: {verdict.message}", file=sys.stdout if verdict.fine else sys.stderr)
    errors = sum(not verdict.fine for verdict in verdicts)
    if errors:
        print(f"{errors} errors, checked {len(verdicts)} files", file=sys.stderr)
    else:
        print(f"No problems found, checked {len(verdicts)} files")
    if args.xunit_file:
        _write_xunit(Path(args.xunit_file), verdicts, time.monotonic() - started)
    return 1 if errors else 0


def find_files(paths: Sequence[Path], excluded: Sequence[str] = ()) -> Iterator[Path]:
    """Yield the source files under the paths, and LICENSE beside each package.xml.

    Folders whose names start with `.` or `_` are left out, and `setup.py` beside a `package.xml`.
    """
    for path in paths:
        if path.is_file():
            candidates = [path]
        else:
            candidates = [
                found
                for found in path.rglob("*")
                if found.is_file() and not any(p.startswith((".", "_")) for p in found.relative_to(path).parts[:-1])
            ]
        for found in candidates:
            beside_package = (found.parent / "package.xml").is_file()
            if found.name in excluded or (found.name == "setup.py" and beside_package):
                continue
            if found.suffix.lstrip(".") in EXTENSIONS or (found.name == "LICENSE" and beside_package):
                yield found


def judge(path: Path) -> Verdict:
    """Say whether a file carries a copyright notice and a known licence; an empty source file needs none."""
    try:
        text = path.read_text(encoding="utf-8")
        header = read_header(path)
    except (OSError, UnicodeDecodeError) as error:
        return Verdict(path, False, f"cannot be read as text: {error}")
    if path.name == "LICENSE":
        licence = licence_of_text(text)
        return Verdict(path, licence != UNKNOWN, licence if text else "file empty")
    if not text:
        return Verdict(path, True, "file empty")
    if not header.copyrights:
        return Verdict(path, False, "could not find copyright notice")
    message = f"copyright={', '.join(header.copyrights)}, license={header.licence}"
    return Verdict(path, header.licence != UNKNOWN, message)


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


def _write_xunit(path: Path, verdicts: Sequence[Verdict], elapsed: float) -> None:
    name = f"{path.parent.name}.{path.name.removesuffix('.xml').removesuffix('.xunit')}"
    suite = ET.Element(
        "testsuite",
        name=name,
        tests=str(len(verdicts)),
        errors="0",
        failures=str(sum(not verdict.fine for verdict in verdicts)),
        time=f"{elapsed:.3f}",
    )
    for verdict in verdicts:
        case = ET.SubElement(suite, "testcase", name=str(verdict.path), classname=name)
        if not verdict.fine:
            ET.SubElement(case, "failure", message=verdict.message)
    path.parent.mkdir(parents=True, exist_ok=True)
    ET.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


__getattr__ = make_getattr(__name__)
