"""Files of an exercise that nobody has written yet: they hold the stub that a release has in the answer's place."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind

STILL_TO_BE_WRITTEN = "this part of the exercise is still to be written"
MAX_BYTES = 256 * 1024  # no file of an exercise is longer

# What colcon and rosidl read to build a package; a stub in any other file does not keep the package from being built.
_BUILT_FROM = ("package.xml", "setup.py", "setup.cfg", "CMakeLists.txt", "msg/*.msg", "srv/*.srv", "action/*.action")
_DEPENDENCY = re.compile(r"<(?:\w+_)?depend\b[^>]*>\s*([\w.-]+)")


@dataclass(frozen=True)
class Stub:
    """The first stub in a file such as `src/robot/setup.py`: the line's number from 1, and its text."""

    path: str
    line: int
    text: str


def find_stub(text: str, path: str) -> Stub | None:
    """Return the first stub in a file's text, or None; `path` names the file in what is said about it."""
    numbered = enumerate(text.splitlines(), 1)
    return next((Stub(path, number, line.strip()) for number, line in numbered if STILL_TO_BE_WRITTEN in line), None)


def explain(diagnosis: Diagnosis, source: Path, *packages: str) -> Diagnosis:
    """Return why packages in `source` were not built: a file that is still to be written, or else the diagnosis.

    The packages of `source` that these depend on are looked at, too.
    """
    stubs = list(_stubs(source, packages))
    if not stubs:
        return diagnosis
    paths = [stub.path for stub in stubs]
    named = f"{paths[0]} is" if len(paths) == 1 else f"{', '.join(paths[:-1])} and {paths[-1]} are"
    detail = "\n".join(f"{stub.path}, line {stub.line}: {stub.text}" for stub in stubs)
    return Diagnosis(Kind.UNFINISHED, f"{named} still to be written: put your lines in place of the raise.", detail)


def _stubs(source: Path, packages: tuple[str, ...]) -> Iterator[Stub]:
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
                stub = find_stub(_read(path), f"src/{path.relative_to(source)}")
                if stub is not None:
                    yield stub


def _read(path: Path) -> str:
    """Return a file's text as far as it counts; nothing for what is no regular file."""
    if path.is_symlink() or not path.is_file():
        return ""
    with path.open("rb") as file:
        return file.read(MAX_BYTES).decode(errors="replace")
