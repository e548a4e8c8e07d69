"""Pictures that grading left beside a result, put into the page itself."""

from __future__ import annotations

import base64
from collections.abc import Callable
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.feedback.model import Picture
from autograder.result import Artifact

MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


def picture_file(artifact: Artifact, folder: Path) -> Path | None:
    """Return where an artifact's picture is, or None for an artifact that is no picture.

    Raises:
        UsageError: the artifact's name leads out of `folder`.
    """
    if Path(artifact.name).suffix.lower() not in MEDIA_TYPES:
        return None
    path = (folder / artifact.name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise UsageError(f"{folder}: the artifact {artifact.name!r} lies outside the result's folder; it is not shown")
    return path


def from_folder(folder: Path) -> Callable[[Artifact], Picture | None]:
    """Return a reader of the artifacts in a result's folder."""

    def read(artifact: Artifact) -> Picture | None:
        path = picture_file(artifact, folder)
        if path is None:
            return None
        if not path.is_file():
            return Picture(None, artifact.caption)
        data = base64.b64encode(path.read_bytes()).decode("ascii")
        return Picture(f"data:{MEDIA_TYPES[path.suffix.lower()]};base64,{data}", artifact.caption)

    return read
