"""The parser of XML launch files."""

from __future__ import annotations

import os
from typing import TextIO
from xml.etree import ElementTree

from launch import frontend

from .entity import Entity


class Parser(frontend.Parser):
    """Reads XML launch files."""

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the root element of an XML file and a parser; raise ElementTree.ParseError if it is not XML."""
        return Entity(ElementTree.parse(file).getroot()), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the file extensions of XML launch files."""
        return {"launch.xml", "xml", "launch"}
