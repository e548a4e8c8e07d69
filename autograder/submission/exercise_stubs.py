"""Finds files of an exercise that hold the stub of a release: their student has not written them yet."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind

STILL_TO_BE_WRITTEN = "this part of the exercise is still to be written"
# The text in a release in place of an answer. It is valid Python in any function. A node that runs it ends with this
# sentence, which tells the student what to do.
CODE_STUB = f"# YOUR CODE HERE\nraise NotImplementedError('{STILL_TO_BE_WRITTEN}')"
TEXT_STUB = "YOUR ANSWER HERE"
MAX_BYTES = 256 * 1024  # no file of an exercise is longer

# Files that colcon and rosidl read to build a package. A stub in any other file does not prevent the build.
_BUILT_FROM = ("package.xml", "setup.py", "setup.cfg", "CMakeLists.txt", "msg/*.msg", "srv/*.srv", "action/*.action")
_DEPENDENCY = re.compile(r"<(?:\w+_)?depend\b[^<>]*>\s*(\w[\w-]{0,99})(?![\w.-])", re.ASCII)


def explain(diagnosis: Diagnosis, source: Path, *packages: str) -> Diagnosis:
    """Return why packages in `source` were not built: a file that is still to be written, or else the diagnosis.

    The packages of `source` that these depend on are looked at, too.
    """
    stubs = dict(_stubs(source, packages))
    if not stubs:
        return diagnosis
    paths = list(stubs)
    named = f"{paths[0]} is" if len(paths) == 1 else f"{', '.join(paths[:-1])} and {paths[-1]} are"
    detail = "\n".join(f"{path}, {line}" for path, line in stubs.items())
    return Diagnosis(
        Kind.UNFINISHED,
        f"{named} still to be written: replace the line raise NotImplementedError(...) with yours.",
        detail,
    )


def _stubs(source: Path, packages: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield each file that holds a stub, such as `src/robot/setup.py`, with the first one's line."""
    seen: set[str] = set()
    pending = [*reversed(packages)]
    while pending:
        name = pending.pop()
        if name in seen:
            continue
        seen.add(name)
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
