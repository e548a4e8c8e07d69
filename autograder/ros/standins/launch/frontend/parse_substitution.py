"""Substitutions written in text, such as ``$(find-pkg-share my_package)/config``.

The grammar is that of Jazzy's `launch.frontend`: ``$(name argument argument)``, with one space between arguments.
An argument is plain text, a substitution, a sequence of both, or text in quotes, which may contain spaces. A backslash
makes the next character plain text.
"""

from __future__ import annotations

import re
from typing import Any

from standin_notice import make_getattr

from ..substitution import Substitution, TextSubstitution
from .expose import instantiate_substitution

_QUOTES = "'\""
_NAME = re.compile(r"\$\(([A-Za-z][\w-]*)", re.ASCII)


class SubstitutionSyntaxError(ValueError):
    """A substitution has no end, or contains a character that is not allowed."""


def replace_escaped_characters(data: str) -> str:
    """Return the text without the backslashes that escape characters."""
    return re.sub(r"\\(.)", r"\1", data)


def parse_substitution(string_value: str) -> list[Substitution]:
    """Return the parts of a text: plain text and substitutions.

    Raises SubstitutionSyntaxError for a substitution that cannot be parsed, and RuntimeError for an unknown one.
    """
    return _Reader(string_value).parts() or [TextSubstitution(text="")]


def parse_if_substitutions(value: Any) -> Any:
    """Return a value with its texts parsed if they contain substitutions; values that are not text stay unchanged.

    Raises ValueError if the items of a list have different types.
    """
    if isinstance(value, list):
        items = [parse_if_substitutions(item) for item in value]
        types = {type(item) for item in items if not isinstance(item, list)}
        if len(types) > 1:
            raise ValueError("The result is a non-uniform list")
        return items
    if not isinstance(value, str):
        return value
    parts = parse_substitution(value)
    return parts[0].text if len(parts) == 1 and isinstance(parts[0], TextSubstitution) else parts


class _Reader:
    """Reads a text from left to right."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.position = 0

    def parts(self, stops: str = "", quote: str = "") -> list[Substitution]:
        """Read text and substitutions up to one of the characters `stops`.

        Args:
            stops: the characters that end the parts; inside a substitution they do not.
            quote: the quotation mark around the parts, if there is one.
        """
        parts: list[Substitution] = []
        while self._at_substitution() or self._at_text(stops):
            parts.append(self._substitution(quote) if self._at_substitution() else self._plain_text(stops))
        return parts

    def _substitution(self, quote: str) -> Substitution:
        start = self.position
        name = _NAME.match(self.text, start)
        if name is None:
            raise self._error(start)
        self.position = name.end()
        arguments = []
        while self._skip(" "):
            arguments.append(self._argument(quote, start))
        if not self._skip(")"):
            raise self._error(start)
        return instantiate_substitution(name[1], arguments)

    def _argument(self, quote: str, start: int) -> list[Substitution]:
        """Read an argument; inside quotation marks, other quotation marks are text."""
        for mark in _QUOTES if not quote else "":
            if self._skip(mark):
                quoted = self.parts(mark, mark)
                if not self._skip(mark):
                    raise self._error(start)
                return quoted
        parts = self.parts(" ()" + (quote or _QUOTES), quote)
        if not parts:
            raise self._error(start)
        return parts

    def _plain_text(self, stops: str) -> Substitution:
        start = self.position
        while self._at_text(stops):
            self.position += 2 if self.text[self.position] == "\\" else 1
        return TextSubstitution(text=replace_escaped_characters(self.text[start : self.position]))

    def _at_substitution(self) -> bool:
        return self.text.startswith("$(", self.position)

    def _at_text(self, stops: str) -> bool:
        is_at_end = self.position >= len(self.text)
        return not is_at_end and self.text[self.position] not in stops and not self._at_substitution()

    def _skip(self, character: str) -> bool:
        """Skip a character if it is the next one; return whether it was."""
        is_next = self.text.startswith(character, self.position)
        self.position += is_next
        return is_next

    def _error(self, start: int) -> SubstitutionSyntaxError:
        line = self.text[start:].partition("\n")[0]
        return SubstitutionSyntaxError(f"this substitution has no end or cannot be read: {line}")


__getattr__ = make_getattr(__name__)
