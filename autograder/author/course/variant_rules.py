"""The rules for variants: each file replaces one of the reference, or another file of the variant uses it.

A file in the wrong place is ignored. The reference beside it gets full marks, so the verification does not notice it.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from autograder import course_paths
from autograder.author.course.findings import Finding, display_path
from autograder.author.course.python_files import read_python
from autograder.author.course.schema_sentences import suggestion

COLLECTED = re.compile(r"(test_.*|.*_test|conftest)\.py")  # pytest finds these files although nothing names them


def variants_findings(folder: Path, packages: Collection[str]) -> Iterator[Finding]:
    """Yield the problems in the variants of a chapter.

    Args:
        folder: the folder of its variants.
        packages: the folders of the reference that form an answer; empty if they are unknown.
    """
    for variant in sorted(path for path in folder.glob("*") if path.is_dir()):
        for package in sorted(path.name for path in variant.iterdir()):
            if packages and package not in packages:
                message = f"`{package}` is not a package of the suite: {suggestion(package, packages)}"
                yield Finding(display_path(variant / package), None, message)
        files = [path for path in sorted(variant.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]
        if all(_is_copy(path, variant) for path in files):
            message = "has the same files as the reference: change one, or remove this variant"
            yield Finding(display_path(variant), None, message)
        for path in files:
            if path.suffix == ".py":
                yield from read_python(path).findings
            if path.relative_to(variant).parts[0] in packages:
                yield from _unused_file(path, variant, files)


def _unused_file(path: Path, variant: Path, files: Sequence[Path]) -> Iterator[Finding]:
    """Yield a finding for a file that the reference lacks, unless another file of the variant contains its name."""
    name = str(path.relative_to(variant))
    if (course_paths.SOLUTIONS / name).is_file() or COLLECTED.fullmatch(path.name):
        return
    stem = path.parent.name if path.name == "__init__.py" else path.name.partition(".")[0]
    word = re.compile(rf"\b{re.escape(stem)}\b".encode())
    if not any(word.search(other.read_bytes()) for other in files if other != path):
        package = course_paths.SOLUTIONS / path.relative_to(variant).parts[0]
        reference_names = [
            str(other.relative_to(course_paths.SOLUTIONS)) for other in sorted(package.rglob("*")) if other.is_file()
        ]
        matches = difflib.get_close_matches(name, reference_names, n=1)
        advice = f"did you mean `{matches[0]}`?" if matches else "correct its path, or remove it"
        message = f"replaces no file of the reference, and no other file of the variant names `{stem}`: {advice}"
        yield Finding(display_path(path), None, message, 1)


def _is_copy(path: Path, variant: Path) -> bool:
    """Return whether the reference has the same file."""
    source = course_paths.SOLUTIONS / path.relative_to(variant)
    return source.is_file() and source.read_bytes() == path.read_bytes()
