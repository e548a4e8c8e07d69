"""Finds pairs of submissions with similar passages. Text that the course gives does not count.

A pair is a hint for a person to read both texts, and no verdict. copydetect compares the passages: each name and each
string is one token, whatever its text, so that other names hide nothing.

A text may be made to take long: of each, so many characters are compared, without empty lines. A pair then takes steps
and memory in proportion to these, and so many pairs are shown.
"""

from __future__ import annotations

import heapq
import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from copydetect.detector import CodeFingerprint, compare_files
from copydetect.utils import get_token_coverage, highlight_overlap
from markupsafe import Markup

from autograder.report.feedback.pages import environment
from autograder.result.class_folder import SUMMARY
from autograder.result.model import write_atomically

MIN_MATCH_TOKENS = 50  # a shorter passage does not count; these are about three lines
MAX_CHARACTERS = 100_000  # of a text; these are 2,500 lines, and take 0.5 s and 50 MiB
MAX_PAIRS = 100  # on the page, which holds both texts of each


@dataclass(frozen=True)
class Pair:
    """Two submissions, the share of their own text that is alike, and their texts with the passages marked."""

    names: tuple[str, str]
    shares: tuple[float, float]
    texts: tuple[Markup, Markup]


def pairs(
    codes: Mapping[str, str], given: str, least: float, in_part: Callable[[str, str], None] = lambda name, what: None
) -> list[Pair]:
    """Return the pairs that are most alike, `MAX_PAIRS` at most, the most alike first.

    Args:
        codes: the text of each student.
        given: the text that the course gives.
        least: the share of its own text, 0 to 1, that one of a pair has to have in the other.
        in_part: is called with each student whose text is not compared whole, and what of it is.
    """
    gift = _fingerprint(_dense(given))
    prints: dict[str, CodeFingerprint] = {}
    for name, text in codes.items():
        dense = _dense(text)
        if len(dense) > MAX_CHARACTERS:
            in_part(name, f"the first {MAX_CHARACTERS:,} characters of its code, look at the rest yourself")
        prints[name] = _fingerprint(dense[:MAX_CHARACTERS])
    for found in prints.values():
        found.hashes -= gift.hashes
        found.hash_idx = {key: places for key, places in found.hash_idx.items() if key in found.hashes}
        found.token_coverage = get_token_coverage(found.hash_idx, MIN_MATCH_TOKENS, len(found.filtered_code))
    alike: list[tuple[float, tuple[str, str], tuple[float, float]]] = []
    for one, two in combinations(prints, 2):
        _, shares, _ = compare_files(prints[one], prints[two])
        if max(shares) >= least and max(shares) > 0:
            alike.append((-max(shares), (one, two), (min(1.0, shares[0]), min(1.0, shares[1]))))
    return [_pair(names, shares, prints) for _, names, shares in heapq.nsmallest(MAX_PAIRS, alike)]


def _pair(names: tuple[str, str], shares: tuple[float, float], prints: Mapping[str, CodeFingerprint]) -> Pair:
    first, second = (prints[name] for name in names)
    _, _, slices = compare_files(first, second)
    return Pair(names, shares, (_marked(first.raw_code, slices[0]), _marked(second.raw_code, slices[1])))


def write_pairs(found: Sequence[Pair], out: Path) -> Path:
    """Write a page with the texts of each pair side by side, and return its path."""
    out.mkdir(parents=True, exist_ok=True)
    page = out / SUMMARY
    write_atomically(page, environment().get_template("similar.html.j2").render(pairs=found).encode())
    return page


def _dense(text: str) -> str:
    """Return a text without its empty lines, of which the lexer looks at all that follow from each."""
    return "\n".join(line for line in text.splitlines() if line.strip())


def _fingerprint(text: str) -> CodeFingerprint:
    """Return all passages of a text: those that are there do not depend on a hash's luck."""
    return CodeFingerprint("submission.py", MIN_MATCH_TOKENS, 1, fp=io.StringIO(text))


def _marked(text: str, slices: object) -> Markup:
    return Markup(highlight_overlap(text, slices, "<mark>", "</mark>", escape_html=True)[0])
