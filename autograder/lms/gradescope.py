"""Reads `submission_metadata.yml` of a Gradescope download: whose each folder is, and when it was handed in.

The file is written by Ruby: its keys are symbols, such as `:submitters:`, which YAML reads as text with a colon.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from autograder.exceptions import UsageError
from autograder.lms.names import HandedIn, Keys

METADATA = "submission_metadata.yml"


def read_metadata(folder: Path) -> list[HandedIn]:
    """Return what a download of Gradescope holds.

    Raises:
        UsageError: its `submission_metadata.yml` cannot be read.
    """
    path = folder / METADATA
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        return [_handed_in(folder / name, told) for name, told in data.items() if (folder / name).is_dir()]
    except (OSError, ValueError, yaml.YAMLError, AttributeError, TypeError, KeyError) as error:
        raise UsageError(f"{path}: cannot be read as Gradescope's list of submissions: {error}") from None


def _handed_in(folder: Path, told: dict[str, Any]) -> HandedIn:
    kinds = {":sid": "number", ":email": "email", ":name": "name"}
    people = told[":submitters"]
    keys: Keys = tuple((kind, str(person[key])) for person in people for key, kind in kinds.items() if person.get(key))
    return HandedIn(folder, keys, (str(told.get(":created_at", "")),))
