"""Parses the arguments that a launch file declares, as `ros2 launch --show-args` prints them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

_NAME = re.compile(r"^    '(?P<name>.+)':\*?$")  # the star marks an argument that is declared under a condition
_DEFAULT = re.compile(r"^        \(default: (?P<default>.*)\)$")
_CHOICES = ("Valid choices are: ", "One of: ")  # the text before a list or a tuple
_QUOTED = re.compile(r"'([^']*)'")
_TEXTS = re.compile(r"'[^']*'(?: \+ '[^']*')*")  # one text, or several in a row


@dataclass(frozen=True)
class Argument:
    """A launch argument, as `ros2 launch -s` shows it."""

    name: str
    description: str  # empty if there is none
    default: str | None  # the text of the default; None if there is none, or it is computed
    choices: tuple[str, ...]  # the values that are allowed; empty if all are
    is_computed: bool = False  # whether the text of the default is known only when the launch runs


def parse_arguments(text: str) -> dict[str, Argument]:
    """Read the output of `ros2 launch -s`; return arguments by name."""
    lines_of: dict[str, list[str]] = {}
    lines: list[str] = []
    for line in text.splitlines():
        if match := _NAME.match(line):
            lines = lines_of[match["name"]] = []
        elif line.startswith("        "):
            lines.append(line)
    return {name: _argument(name, lines) for name, lines in lines_of.items()}


def _argument(name: str, lines: Sequence[str]) -> Argument:
    """Parse an argument from the lines below its name."""
    description: list[str] = []
    default: str | None = None
    is_computed = False
    choices: tuple[str, ...] = ()
    for line in lines:
        text = line.strip()
        if match := _DEFAULT.match(line):
            is_computed = not _TEXTS.fullmatch(match["default"])
            default = None if is_computed else "".join(_QUOTED.findall(match["default"]))
            continue
        for phrase in _CHOICES:
            before, separator, list_text = text.rpartition(phrase)
            if separator and list_text.startswith(("[", "(")) and list_text.endswith(("]", ")")):
                text, choices = before.strip(), tuple(_QUOTED.findall(list_text))
        description += [text] if text and text != "no description given" else []
    return Argument(name, " ".join(description), default, choices, is_computed)
