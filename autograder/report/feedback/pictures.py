"""Reads the pictures and runs of a result for its page."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.result.model import Artifact


@dataclass(frozen=True)
class Picture:
    """A picture on a page: its data URI, or None if the file is missing, and its alternative text.

    `run` is the run in the picture, as JSON for the player, or None. `name` is unique on the page.
    """

    uri: str | None
    caption: str
    name: str
    run: str | None


def read_picture(artifact: Artifact, folder: Path) -> Picture | None:
    """Return the picture of an artifact, or None if the artifact is not a picture.

    Raises:
        UsageError: the path of the artifact is outside of `folder`.
    """
    if not artifact.name.endswith(".png"):
        return None
    path, uri = _inside(artifact.name, folder), None
    if path.is_file():
        uri = f"data:image/png;base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"
    return Picture(uri, artifact.caption, path.stem, _run(artifact, folder))


def _run(artifact: Artifact, folder: Path) -> str | None:
    """Return an artifact's run as JSON that is safe in a script element, or None if the file is missing."""
    path = _inside(artifact.run, folder)
    if not artifact.run or not path.is_file():
        return None
    try:
        run = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise UsageError(f"{path} is not a valid run: {error}; grade the submission again") from None
    return json.dumps(run, separators=(",", ":")).replace("<", "\\u003c")


def _inside(name: str, folder: Path) -> Path:
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise UsageError(f"{folder}: the artifact {name!r} is outside the result's folder; correct result.json")
    return path
