"""The arguments that a launch file declares, as `ros2 launch --show-args` prints them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

_NAME = re.compile(r"^    '(?P<name>.+)':\*?$")  # a star: it is used on condition only
_DEFAULT = re.compile(r"^        \(default: (?P<default>.*)\)$")
_CHOICES = ("Valid choices are: ", "One of: ")  # the text before a list or a tuple
_QUOTED = re.compile(r"'([^']*)'")
_TEXTS = re.compile(r"'[^']*'(?: \+ '[^']*')*")  # one text, or several in a row


@dataclass(frozen=True)
class Argument:
    """A launch argument, as `ros2 launch -s` shows it."""

    name: str
    description: str  # its description, or an empty string
    default: str | None  # the text of its default, None if it has to be given or its default is worked out
    choices: tuple[str, ...]  # the values that are allowed; empty if any is
    is_worked_out: bool = False  # whether it has a default whose text is known only when the launch runs


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
    """Return an argument of the lines below its name."""
    description: list[str] = []
    default: str | None = None
    is_worked_out = False
    choices: tuple[str, ...] = ()
    for line in lines:
        words = line.strip()
        if match := _DEFAULT.match(line):
            is_worked_out = not _TEXTS.fullmatch(match["default"])
            default = None if is_worked_out else "".join(_QUOTED.findall(match["default"]))
            continue
        for phrase in _CHOICES:
            before, separator, listed = words.rpartition(phrase)
            if separator and listed.startswith(("[", "(")) and listed.endswith(("]", ")")):
                words, choices = before.strip(), tuple(_QUOTED.findall(listed))
        description += [words] if words and words != "no description given" else []
    return Argument(name, " ".join(description), default, choices, is_worked_out)
