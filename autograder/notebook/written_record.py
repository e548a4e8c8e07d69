"""What cells with `%%writefile` wrote last: a record in each workspace."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

RECORD = ".writefile.json"  # in a workspace: by path, a digest of what a cell wrote last


def digest(text: str) -> str:
    """Return the SHA-256 of a text, in hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def read_record(home: Path) -> dict[str, str]:
    """Read what cells wrote last; nothing where there is no record, or none that can be read."""
    try:
        record = json.loads((home / RECORD).read_text())
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) else {}
