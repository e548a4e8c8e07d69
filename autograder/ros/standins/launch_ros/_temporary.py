"""Parameters as YAML text, and temporary files of it, which live until the launching program ends.

They live that long because a node that is respawned reads them again.
"""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path
from typing import Any

import yaml


class _Dumper(yaml.SafeDumper):
    """Writes all text in quotes: nodes read YAML by other rules than PyYAML, to them 1e3 is a number."""


_Dumper.add_representer(str, lambda dumper, text: dumper.represent_scalar("tag:yaml.org,2002:str", text, style="'"))


def parameter_text(value: Any, *, one_line: bool = False) -> str:
    """Return `value` as YAML, on several lines or on one."""
    text: str = yaml.dump(value, Dumper=_Dumper, default_flow_style=one_line, width=float("inf"))
    return text.removesuffix("\n").removesuffix("\n...")


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
