"""The parser of ROS's own build, fit for strangers' definitions."""

from __future__ import annotations

import re
from typing import Any

# rosidl_adapter's rule for the name of a constant. Its own expression takes exponential time on a wrong name.
CONSTANT_NAME = re.compile("^(?!.*__)(?!.*_$)[A-Z][A-Z0-9_]*$")


def parser() -> Any:
    """Return rosidl_adapter's parser."""
    from rosidl_adapter import parser

    parser.VALID_CONSTANT_NAME_PATTERN = CONSTANT_NAME
    return parser


def without_comments(text: str) -> str:
    """Return a definition whose comments are empty: the parser looks for units in them, in quadratic time."""
    return "".join(f"{line.partition('#')[0]}{'#' * ('#' in line)}\n" for line in text.splitlines())
