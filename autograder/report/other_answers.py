"""Other correct answers to an assignment: the variants that students with full marks may see.

`variants/shown.yaml` in a chapter's checks names them and describes how each differs from the usual answer.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import dropwhile
from pathlib import Path

import yaml

from autograder import course_paths
from autograder.exceptions import UsageError

INDEX_FILE = "shown.yaml"


@dataclass(frozen=True)
class OtherAnswer:
    """A correct answer in another style.

    Attributes:
        difference: how it differs from the answer of most students, in a few sentences.
        files: the path and the text of each file that differs.
    """

    difference: str
    files: tuple[tuple[str, str], ...]


def other_answers(assignment: str) -> tuple[OtherAnswer, ...]:
    """Return the other answers to an assignment, in the order of `shown.yaml`.

    Raises:
        UsageError: `shown.yaml` does not exist or is invalid, or it names a variant that does not exist.
    """
    folder = course_paths.CHECKS / f"ch{assignment}" / "variants"
    path = folder / INDEX_FILE
    try:
        texts = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError:
        raise UsageError(f"{assignment} has no other answers to show: {path} does not exist") from None
    except (ValueError, yaml.YAMLError) as error:
        raise UsageError(f"{path} cannot be read as YAML: {error}") from None
    if not isinstance(texts, dict) or not all(isinstance(text, str) for pair in texts.items() for text in pair):
        raise UsageError(f"{path}: for each variant, write its name, a colon and how it differs")
    return tuple(_answer(folder, name, difference) for name, difference in texts.items())


def _answer(folder: Path, name: str, difference: str) -> OtherAnswer:
    variants = sorted(variant.name for variant in folder.iterdir() if variant.is_dir())
    if name not in variants:
        raise UsageError(
            f"{folder / INDEX_FILE} names {name!r}, which is not a variant; the variants are: {', '.join(variants)}"
        )
    paths = sorted(path for path in (folder / name).rglob("*") if path.is_file())
    return OtherAnswer(difference, tuple((path.relative_to(folder / name).as_posix(), _text(path)) for path in paths))


def _text(path: Path) -> str:
    """Return the text of a file, without the licence at the top of a Python file."""
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    if path.suffix == ".py":
        lines = list(dropwhile(lambda line: line.startswith("#") or not line.strip(), lines))
    return "".join(lines)
