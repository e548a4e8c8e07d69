"""The files of a result. A new result takes the place of an old one when it is whole, and not before."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from autograder.result.model import UNFINISHED

RESULT = "result.json"
NOTEBOOK = "notebook.ipynb"
LOG = "grader.log"


@contextmanager
def new_result(out: Path) -> Iterator[Path]:
    """Yield an empty folder for a new result; at the end of the block, its files replace those of the folder `out`.

    Until then `out` has the old result, also if the block raises an exception or the process is killed. The mark
    changes in one step, as `result.json` is replaced last. Files of the old result that the new one lacks are removed.
    """
    folder = out / UNFINISHED
    empty(folder)
    try:
        yield folder
        _replace(folder, out)
    finally:
        remove_unfinished(out)


def remove_unfinished(out: Path) -> None:
    """Remove from the folder of a result what a grading left there that was killed."""
    shutil.rmtree(out / UNFINISHED, ignore_errors=True)


def empty(folder: Path) -> None:
    """Make an empty folder, whatever is there."""
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)


def _replace(folder: Path, out: Path) -> None:
    fresh = {path.name for path in folder.iterdir()}
    for name in sorted(fresh - {RESULT}):
        (folder / name).replace(out / name)
    stale = {NOTEBOOK, LOG, *_artifacts(out / RESULT)} - fresh
    for path in out.iterdir():
        if path.name in stale:
            path.unlink()
    (folder / RESULT).replace(out / RESULT)


def _artifacts(result: Path) -> set[str]:
    """Return the names of the pictures and runs of a stored result, none if it cannot be read."""
    if not result.is_file():
        return set()
    try:
        data = json.loads(result.read_text(encoding="utf-8"))
        return {artifact[key] for artifact in data["artifacts"] for key in ("name", "run")}
    except (OSError, ValueError, KeyError, TypeError):
        return set()
