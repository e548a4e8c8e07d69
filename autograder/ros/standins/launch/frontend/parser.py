"""The base class of the parsers of launch files, and the choice of the parser for a file."""

from __future__ import annotations

import os
import warnings
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any, ClassVar, TextIO

from ..action import Action
from ..exceptions import InvalidLaunchFileError
from ..launch_description import LaunchDescription
from ..substitution import Substitution
from .entity import Entity
from .expose import instantiate_action
from .parse_substitution import parse_if_substitutions, parse_substitution, replace_escaped_characters


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A launch file in XML or YAML could not be read; the message lists the errors."""


class Parser:
    """Creates actions from elements; the parser of a format, such as `launch_xml.Parser`, overrides `load`.

    Other packages add formats and actions by the entry points ``launch.frontend.parser`` and
    ``launch.frontend.launch_extension``.
    """

    frontend_parsers: ClassVar[dict[str, type[Parser]] | None] = None
    extensions_loaded: ClassVar[bool] = False

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Import the packages that register actions and substitutions."""
        if not Parser.extensions_loaded:
            Parser.extensions_loaded = True
            for point in entry_points(group="launch.frontend.launch_extension"):
                _load_entry_point(point)

    @classmethod
    def load_parser_implementations(cls) -> dict[str, type[Parser]]:
        """Return the parsers of all formats, by the names of the formats."""
        if Parser.frontend_parsers is None:
            parsers = {point.name: _load_entry_point(point) for point in entry_points(group="launch.frontend.parser")}
            Parser.frontend_parsers = {name: parser for name, parser in sorted(parsers.items()) if parser is not None}
        return Parser.frontend_parsers

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the names of the formats."""
        return list(cls.load_parser_implementations())

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the file extensions of this format, without the leading dot."""
        return set()

    @classmethod
    def get_file_extensions_from_parsers(cls) -> set[str]:
        """Return the file extensions of all formats."""
        return {
            extension
            for parser in cls.load_parser_implementations().values()
            for extension in parser.get_file_extensions()
        }

    @classmethod
    def may_parse(cls, filename: str) -> bool:
        """Return whether a file's name has an extension of this format."""
        return any(filename.endswith(f".{extension}") for extension in cls.get_file_extensions())

    @classmethod
    def get_parsers_from_filename(cls, filename: str) -> list[type[Parser]]:
        """Return the parsers of the formats that match a file's name."""
        return [parser for parser in cls.load_parser_implementations().values() if parser.may_parse(filename)]

    @classmethod
    def is_filename_valid(cls, filename: str) -> bool:
        """Return whether a file's name matches any format."""
        return bool(cls.get_parsers_from_filename(filename))

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the root element of a launch file and its parser, by its extension or else the first that can read it.

        Raises InvalidFrontendLaunchFileError if no parser can read it, and OSError if the file cannot be opened.
        """
        if isinstance(file, (str, os.PathLike)):
            with Path(file).open(encoding="utf-8") as opened:
                return cls.load(opened)
        name = str(getattr(file, "name", ""))
        likely = cls.get_parsers_from_filename(name)
        others = [parser for parser in cls.load_parser_implementations().values() if parser not in likely]
        errors: list[Exception] = []
        for parser in likely + others:
            try:
                return parser.load(file)
            except Exception as error:
                errors.append(error)
                file.seek(0)
        extension = Path(name).suffix.removeprefix(".") if likely else ""
        raise InvalidFrontendLaunchFileError(extension, likely_errors=errors)

    def parse_action(self, entity: Entity) -> Action:
        """Return the action that an element describes."""
        self.load_launch_extensions()
        return instantiate_action(entity, self)

    def parse_substitution(self, value: str) -> list[Substitution]:
        """Return the parts of a text: plain text and substitutions."""
        return parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        """Return a value with its texts parsed if they contain substitutions."""
        return parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        """Return the text without the backslashes that escape characters."""
        return replace_escaped_characters(value)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """Return the launch description of a root element; raise RuntimeError unless it is ``launch``."""
        if entity.type_name != "launch":
            raise RuntimeError("Expected 'launch' as root tag")
        deprecated = entity.get_attr("deprecated", optional=True)
        actions = [self.parse_action(child) for child in entity.children]
        return LaunchDescription(actions, deprecated_reason=deprecated)


def _load_entry_point(point: EntryPoint) -> Any:
    """Return the object of an entry point, or None with a warning if it cannot be imported."""
    try:
        return point.load()
    except Exception as error:
        warnings.warn(f"Failed to load the launch extension {point.name}: {error}", stacklevel=2)
        return None
