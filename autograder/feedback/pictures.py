"""Reads the pictures beside a result as data URIs, for use in a page."""

from __future__ import annotations

import base64
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
    path = (folder / artifact.name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise UsageError(
            f"{folder}: the artifact {artifact.name!r} lies outside the result's folder; correct result.json"
        )
    return path


def picture_reader(folder: Path) -> Callable[[Artifact], Picture | None]:
    """Return a function that reads the picture of an artifact in `folder`. It returns None if there is no picture."""

    def read(artifact: Artifact) -> Picture | None:
        path = picture_file(artifact, folder)
        if path is None:
            return None
        if not path.is_file():
            return Picture(None, artifact.caption)
        data = base64.b64encode(path.read_bytes()).decode("ascii")
        return Picture(f"data:{MEDIA_TYPES[path.suffix.lower()]};base64,{data}", artifact.caption)

    return read
