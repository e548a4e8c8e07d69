"""Finds the files of an exercise that still contain the released stub."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind

STILL_TO_BE_WRITTEN = "this part of the exercise is still to be written"
# The text that replaces an answer in a release. It is valid Python in any function. A node that runs it ends with the
# sentence above, which tells the student what to do.
CODE_STUB = f"# YOUR CODE HERE\nraise NotImplementedError('{STILL_TO_BE_WRITTEN}')"
TEXT_STUB = "YOUR ANSWER HERE"
MAX_BYTES = 256 * 1024  # more than any file of an exercise has

# Files that colcon and rosidl read to build a package. A stub in any other file does not prevent the build.
_BUILD_FILES = ("package.xml", "setup.py", "setup.cfg", "CMakeLists.txt", "msg/*.msg", "srv/*.srv", "action/*.action")
_DEPENDENCY = re.compile(r"<(?:\w+_)?depend\b[^<>]*>\s*(\w[\w-]{0,99})(?![\w.-])", re.ASCII)


def explain(diagnosis: Diagnosis, source: Path, *packages: str) -> Diagnosis:
    """Return a diagnosis that names unfinished files as the reason why packages were not built, or else `diagnosis`.

    Args:
        diagnosis: the diagnosis of the build.
        source: the folder of the packages.
        packages: the packages that were not built. Their dependencies in `source` are searched as well.
    """
    stubs = dict(_stubs(source, packages))
    if not stubs:
        return diagnosis
    paths = list(stubs)
    subject = f"{paths[0]} is" if len(paths) == 1 else f"{', '.join(paths[:-1])} and {paths[-1]} are"
    detail = "\n".join(f"{path}, {line}" for path, line in stubs.items())
    return Diagnosis(
        Kind.UNFINISHED,
        f"{subject} still to be written: replace the line raise NotImplementedError(...) with yours.",
        detail,
    )


def _stubs(source: Path, packages: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield the path of each file with a stub, and its first line with one: `src/robot/setup.py`, `line 9: ...`."""
    visited: set[str] = set()
    pending = [*reversed(packages)]
    while pending:
        name = pending.pop()
        if name in visited:
            continue
        visited.add(name)
        pending += _DEPENDENCY.findall(_read(source / name / "package.xml"))
        for pattern in _BUILD_FILES:
            for path in sorted((source / name).glob(pattern)):
                lines = enumerate(_read(path).splitlines(), 1)
                stub_lines = [f"line {number}: {line.strip()}" for number, line in lines if STILL_TO_BE_WRITTEN in line]
                if stub_lines:
                    yield f"src/{path.relative_to(source)}", stub_lines[0]


def _read(path: Path) -> str:
    """Return the first `MAX_BYTES` of a regular file as text, or an empty string if the path is anything else."""
    if path.is_symlink() or not path.is_file():
        return ""
    with path.open("rb") as file:
        return file.read(MAX_BYTES).decode(errors="replace")
