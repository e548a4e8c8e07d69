"""The parser of YAML launch files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TextIO

import yaml
from launch import frontend

from .entity import Entity


class Parser(frontend.Parser):
    """Reads YAML launch files."""

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the root element of a YAML file and a parser.

        Raises yaml.YAMLError if it is not YAML, and RuntimeError unless it has one root.
        """
        if isinstance(file, (str, os.PathLike)):
            with Path(file).open(encoding="utf-8") as opened:
                return cls.load(opened)
        tree = yaml.safe_load(file)  # passes the file instead of its text, so that errors name it
        if not isinstance(tree, dict) or len(tree) != 1:
            raise RuntimeError("Expected only one root")
        ((type_name, element),) = tree.items()
        return Entity(element, type_name), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the file extensions of YAML launch files."""
        return {"launch.yaml", "launch.yml", "yaml", "yml", "launch"}
