"""Marks secret files with random words, so that the verification can search students' output for them.

Each run draws a new word of ten different syllables. No text contains such a word by chance.
"""

from __future__ import annotations

import random
import re

SYLLABLES = ("ba", "do", "fe", "gi", "ka", "lo", "mu", "ne", "pi", "ra", "so", "tu", "ve", "wa", "xi", "zu")
LENGTH = 10  # syllables of a marker
_MARKER = re.compile(f"(?=((?:{'|'.join(SYLLABLES)}){{{LENGTH}}}))")  # a lookahead, because markers may overlap


def draw_marker(draw: random.Random) -> str:
    """Return a new word."""
    return "".join(draw.sample(SYLLABLES, LENGTH))


def markers_in(text: str) -> set[str]:
    """Return the markers that a text contains."""
    markers: set[str] = set(_MARKER.findall(text))
    return {word for word in markers if len({word[start : start + 2] for start in range(0, len(word), 2)}) == LENGTH}
