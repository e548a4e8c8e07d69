"""Finds files of an exercise that still contain the stub of the release."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind

STILL_TO_BE_WRITTEN = "this part of the exercise is still to be written"
# The text that replaces an answer in a release. It is valid Python in any function. A node that runs it ends with this
# sentence, which tells the student what to do.
CODE_STUB = f"# YOUR CODE HERE\nraise NotImplementedError('{STILL_TO_BE_WRITTEN}')"
TEXT_STUB = "YOUR ANSWER HERE"
MAX_BYTES = 256 * 1024  # more than any file of an exercise has

# Files that colcon and rosidl read to build a package. A stub in any other file does not prevent the build.
_BUILT_FROM = ("package.xml", "setup.py", "setup.cfg", "CMakeLists.txt", "msg/*.msg", "srv/*.srv", "action/*.action")
_DEPENDENCY = re.compile(r"<(?:\w+_)?depend\b[^<>]*>\s*(\w[\w-]{0,99})(?![\w.-])", re.ASCII)


def explain(diagnosis: Diagnosis, source: Path, *packages: str) -> Diagnosis:
    """Return a diagnosis that names unfinished files as the reason why packages were not built, or else `diagnosis`.

    Args:
        diagnosis: the diagnosis of the build.
        source: the folder of the packages.
        packages: packages that were not built. The packages in `source` that they depend on are also searched.
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
    """Yield each file that contains a stub, such as `src/robot/setup.py`, with the line of its first stub."""
    visited: set[str] = set()
    pending = [*reversed(packages)]
    while pending:
        name = pending.pop()
        if name in visited:
            continue
        visited.add(name)
        pending += _DEPENDENCY.findall(_read(source / name / "package.xml"))
        for pattern in _BUILT_FROM:
            for path in sorted((source / name).glob(pattern)):
                lines = enumerate(_read(path).splitlines(), 1)
                stub_lines = [f"line {number}: {line.strip()}" for number, line in lines if STILL_TO_BE_WRITTEN in line]
                if stub_lines:
                    yield f"src/{path.relative_to(source)}", stub_lines[0]


def _read(path: Path) -> str:
    """Return the text of a regular file up to `MAX_BYTES`, or an empty string."""
    if path.is_symlink() or not path.is_file():
        return ""
    with path.open("rb") as file:
        return file.read(MAX_BYTES).decode(errors="replace")
