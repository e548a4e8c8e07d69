"""Records a digest of each file that all gradings share, with the present GRADER_VERSION.

    python -m tests.unit.fingerprint.record

A module's digest excludes parts that cannot change a mark: full-line comments, docstrings and empty lines.
Each file has its own line, so that branches that change different files do not conflict.
"""

from __future__ import annotations

import ast
import hashlib
import io
import tokenize
from collections.abc import Iterator
from pathlib import Path

from autograder import course_paths
from autograder.suite import fingerprint

RECORD = Path(__file__).with_name("recorded.txt")
LOCK = course_paths.ROOT / "requirements.lock"  # the packages that students' programs use


def current() -> str:
    """Return the record of the present files."""
    any_chapter = course_paths.assignments()[0]
    shared = {*fingerprint.files(any_chapter), LOCK}.difference(fingerprint.chapter_files(any_chapter))
    lines = (f"{_digest(path)}  {path.relative_to(course_paths.ROOT).as_posix()}" for path in sorted(shared))
    return "\n".join([f"GRADER_VERSION {fingerprint.GRADER_VERSION}", *lines, ""])


def _digest(path: Path) -> str:
    data = path.read_bytes()
    if path.suffix == ".py":
        data = "\n".join(_effective_lines(data.decode())).encode()
    return hashlib.sha256(data).hexdigest()[:12]


def _effective_lines(source: str) -> Iterator[str]:
    """Yield the lines of a module that can change what it does."""
    ignored = {number for begin, end in _docstrings(source) for number in range(begin, end + 1)}
    lines = source.split("\n")
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        number, column = token.start
        if token.type == tokenize.COMMENT and not lines[number - 1][:column].strip():
            ignored.add(number)
    for number, line in enumerate(lines, start=1):
        if number not in ignored and line.strip():
            yield line


def _docstrings(source: str) -> Iterator[tuple[int, int]]:
    """Yield the first and the last line of each docstring."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and node.body:
            first = node.body[0]
            if (
                isinstance(first, ast.Expr)
                and isinstance(first.value, ast.Constant)
                and isinstance(first.value.value, str)
            ):
                yield first.lineno, first.end_lineno or first.lineno


if __name__ == "__main__":
    RECORD.write_text(current(), encoding="utf-8")
