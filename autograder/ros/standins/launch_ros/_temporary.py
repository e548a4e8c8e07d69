"""Temporary parameter files, which live until the launching program ends.

They live that long because a node that is respawned reads them again.
"""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path


@functools.lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="launch_params_")


def temporary_parameter_file(text: str) -> Path:
    """Return a new temporary file with `text` in it."""
    with tempfile.NamedTemporaryFile(
        "w", prefix="launch_params_", dir=_folder().name, delete=False, encoding="utf-8"
    ) as file:
        file.write(text)
    return Path(file.name)
