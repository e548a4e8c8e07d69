"""Finds groups of submissions with similar passages. Text that the course gives does not count.

A group is a hint for a person to read the texts, and no verdict. copydetect compares the passages: each name and each
string is one token, whatever its text, so that other names hide nothing.

A text may be made to take long: of each, so many characters are compared, without empty lines. A pair then takes steps
and memory in proportion to these, and of so many pairs the texts are shown.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Mapping, Sequence
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

Names = tuple[str, ...]
Prints = Mapping[Names, CodeFingerprint]


@dataclass(frozen=True)
class Pair:
    """Two texts that are alike. Students with the same text are on one side; where all have it, the first is alone.

    Attributes:
        names: the students of either text.
        shares: the share of each text's own passages, 0 to 1, that is in the other one.
        texts: both with the passages marked; None if `MAX_PAIRS` other pairs are more alike.
    """

    names: tuple[Names, Names]
    shares: tuple[float, float]
    texts: tuple[Markup, Markup] | None = None


@dataclass(frozen=True)
class Group:
    """Students whose submissions are alike, and the pairs that join them, the most alike first."""

    names: Names
    pairs: tuple[Pair, ...]


@dataclass(frozen=True)
class Comparison:
    """The groups of a class, the most alike first, and the students without a passage of their own."""

    groups: tuple[Group, ...]
    without_own: Names


def compare(
    codes: Mapping[str, str], given: str, least: float, in_part: Callable[[str, str], None] = lambda name, what: None
) -> Comparison:
    """Return the groups of students with similar texts. Each student is in one group at most.

    Args:
        codes: the text of each student.
        given: the text that the course gives.
        least: the share of its own text, 0 to 1, that one of a pair has to have in the other for the two to be in one
            group. What joins a group is the chain of its most similar pairs; the two ends of a chain may be less alike.
        in_part: is called with each student whose text is not compared whole, and what of it is.
    """
    gift = _fingerprint(_dense(given))
    prints: dict[Names, CodeFingerprint] = {}
    for text, names in _by_text(codes, in_part).items():
        found = prints[names] = _fingerprint(text)
        found.hashes -= gift.hashes
        found.hash_idx = {key: places for key, places in found.hash_idx.items() if key in found.hashes}
        found.token_coverage = get_token_coverage(found.hash_idx, MIN_MATCH_TOKENS, len(found.filtered_code))
    own = {names: found for names, found in prints.items() if found.hashes}
    links = sorted(_links(own, least), key=lambda pair: (-max(pair.shares), pair.names))
    groups = _with_texts(_joined(links), own)
    return Comparison(groups, tuple(name for names in prints if names not in own for name in names))


def _by_text(codes: Mapping[str, str], in_part: Callable[[str, str], None]) -> dict[str, Names]:
    """Return the students of each text that is compared."""
    students: dict[str, Names] = {}
    for name, code in codes.items():
        dense = _dense(code)
        if len(dense) > MAX_CHARACTERS:
            in_part(name, f"the first {MAX_CHARACTERS:,} characters of its code, look at the rest yourself")
        text = dense[:MAX_CHARACTERS]
        students[text] = (*students.get(text, ()), name)
    return students


def _links(prints: Prints, least: float) -> Iterable[Pair]:
    """Yield the pairs of texts that are alike, and one for each text that several students have."""
    for names in prints:
        if len(names) > 1:
            yield Pair((names[:1], names[1:]), (1.0, 1.0))
    for one, two in combinations(prints, 2):
        _, shares, _ = compare_files(prints[one], prints[two])
        if max(shares) >= least and max(shares) > 0:
            yield Pair((one, two), (min(1.0, shares[0]), min(1.0, shares[1])))


def _joined(links: Iterable[Pair]) -> list[Group]:
    """Join pairs, the most alike first, to groups; a pair inside a group that other pairs have joined is left out."""
    group_of: dict[str, Group] = {}
    for link in links:
        one, two = (group_of.get(names[0], Group(names, ())) for names in link.names)
        if one.names == two.names:
            continue
        joined = Group((*one.names, *two.names), (*one.pairs, *two.pairs, link))
        group_of.update(dict.fromkeys(joined.names, joined))
    return list(dict.fromkeys(group_of.values()))


def _with_texts(groups: Sequence[Group], prints: Prints) -> tuple[Group, ...]:
    """Return groups in order, with the texts of the pairs that are most alike."""
    ranked = sorted((pair for group in groups for pair in group.pairs), key=_rank)
    shown = {pair: _shown(pair, prints) for pair in ranked[:MAX_PAIRS]}
    ordered = sorted(groups, key=lambda group: min(map(_rank, group.pairs)))
    return tuple(
        Group(tuple(sorted(group.names)), tuple(shown.get(pair, pair) for pair in sorted(group.pairs, key=_rank)))
        for group in ordered
    )


def _rank(pair: Pair) -> tuple[float, tuple[Names, Names]]:
    return -max(pair.shares), pair.names


def _shown(pair: Pair, prints: Prints) -> Pair:
    together = pair.names[0] + pair.names[1]  # students with the same text
    first, second = (prints[together] if together in prints else prints[names] for names in pair.names)
    _, _, slices = compare_files(first, second)
    return Pair(pair.names, pair.shares, (_marked(first.raw_code, slices[0]), _marked(second.raw_code, slices[1])))


def write_page(found: Comparison, out: Path) -> Path:
    """Write a page with the groups, and the texts of each pair side by side, and return its path."""
    out.mkdir(parents=True, exist_ok=True)
    page = out / SUMMARY
    write_atomically(page, environment().get_template("similar.html.j2").render(groups=found.groups).encode())
    return page


def _dense(text: str) -> str:
    """Return a text without its empty lines, of which the lexer looks at all that follow from each."""
    return "\n".join(line for line in text.splitlines() if line.strip())


def _fingerprint(text: str) -> CodeFingerprint:
    """Return all passages of a text: those that are there do not depend on a hash's luck."""
    return CodeFingerprint("submission.py", MIN_MATCH_TOKENS, 1, fp=io.StringIO(text))


def _marked(text: str, slices: object) -> Markup:
    return Markup(highlight_overlap(text, slices, "<mark>", "</mark>", escape_html=True)[0])
