"""Reads the pictures and the runs beside a result, for use in a page."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.feedback.model import Picture
from autograder.result import Artifact

MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


def picture_file(artifact: Artifact, folder: Path) -> Path | None:
    """Return the path of an artifact's picture, or None if the artifact is not a picture.

    Raises:
        UsageError: the path of the artifact leads out of `folder`.
    """
    if Path(artifact.name).suffix.lower() not in MEDIA_TYPES:
        return None
    return _inside(artifact.name, folder)


def picture_reader(folder: Path) -> Callable[[Artifact], Picture | None]:
    """Return a function that reads the picture of an artifact in `folder`. It returns None if there is no picture."""

    def read(artifact: Artifact) -> Picture | None:
        path = picture_file(artifact, folder)
        if path is None:
            return None
        run = _run(artifact, folder)
        if not path.is_file():
            return Picture(None, artifact.caption, path.stem, run)
        data = base64.b64encode(path.read_bytes()).decode("ascii")
        return Picture(f"data:{MEDIA_TYPES[path.suffix.lower()]};base64,{data}", artifact.caption, path.stem, run)

    return read


def _run(artifact: Artifact, folder: Path) -> str | None:
    """Return an artifact's run as JSON that no script element ends in, or None if the file was not kept."""
    path = _inside(artifact.run, folder)
    if not artifact.run or not path.is_file():
        return None
    try:
        run = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise UsageError(f"{path}: not a run: {error}; grade the submission again") from None
    return json.dumps(run, separators=(",", ":")).replace("<", "\\u003c")


def _inside(name: str, folder: Path) -> Path:
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise UsageError(f"{folder}: the artifact {name!r} lies outside the result's folder; correct result.json")
    return path
