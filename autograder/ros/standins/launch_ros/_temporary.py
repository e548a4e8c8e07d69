"""Temporary parameter files, which are deleted when the launching program ends.

They are not deleted earlier, because a respawned node reads them again.
"""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path


@functools.lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="launch_params_")


def temporary_parameter_file(text: str) -> Path:
    """Return a new temporary file that contains `text`."""
    with tempfile.NamedTemporaryFile(
        "w", prefix="launch_params_", dir=_folder().name, delete=False, encoding="utf-8"
    ) as file:
        file.write(text)
    return Path(file.name)
