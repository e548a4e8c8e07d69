"""A record in each workspace of the texts that cells last wrote with `%%writefile`."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

RECORD = ".writefile.json"  # in a workspace; maps each path to a digest of the text that a cell last wrote there


def digest(text: str) -> str:
    """Return the SHA-256 of a text as hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def read_record(workspace: Path) -> dict[str, str]:
    """Read the record. It is empty if the file is missing or unreadable."""
    try:
        record = json.loads((workspace / RECORD).read_text())
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) else {}
