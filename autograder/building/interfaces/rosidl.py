"""The parser that ROS's build uses, changed so that untrusted definitions cannot slow it down."""

from __future__ import annotations

import re
from typing import Any

# rosidl_adapter's rule for names of constants. Its own regular expression takes exponential time for a wrong name.
CONSTANT_NAME = re.compile("^(?!.*__)(?!.*_$)[A-Z][A-Z0-9_]*$")


def parser() -> Any:
    """Return rosidl_adapter's parser."""
    from rosidl_adapter import parser

    parser.VALID_CONSTANT_NAME_PATTERN = CONSTANT_NAME
    return parser


def without_comments(text: str) -> str:
    """Empty the comments of a definition, because the parser takes quadratic time to search them for units."""
    return "".join(f"{line.partition('#')[0]}{'#' * ('#' in line)}\n" for line in text.splitlines())
