"""Finds groups of submissions with similar passages. Code that the course provides is ignored.

A group is a reason for a person to read the submissions, not a verdict. copydetect compares the passages. It treats
every name and every string as one token, so that renaming does not hide a copy.

A submission may try to make the comparison slow. Therefore only the first characters of each text are compared, without
empty lines and in lines of limited length, which bounds the time and memory for a pair. The number of pairs whose texts
are shown is also limited.
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

MIN_MATCH_TOKENS = 50  # about three lines; shorter passages are ignored
MAX_CHARACTERS = 100_000  # compared per text: about 2,500 lines, which take 0.5 s and 50 MiB
MAX_LINE = 500  # characters; longer lines are broken
MAX_PAIRS = 100  # pairs whose texts are shown on the page

Names = tuple[str, ...]
Fingerprints = Mapping[Names, CodeFingerprint]


@dataclass(frozen=True)
class Pair:
    """Two similar texts. If all students have the same text, the first student forms one side of the pair.

    Attributes:
        names: the students of each text.
        shares: for each text, the share of its own passages, 0 to 1, that the other text also contains.
        texts: both texts with the passages highlighted; None if `MAX_PAIRS` other pairs are more similar.
    """

    names: tuple[Names, Names]
    shares: tuple[float, float]
    texts: tuple[Markup, Markup] | None = None


@dataclass(frozen=True)
class Group:
    """Students with similar submissions, and the pairs that connect them, most similar first."""

    names: Names
    pairs: tuple[Pair, ...]


@dataclass(frozen=True)
class Comparison:
    """The groups of a class, most similar first, and the students without any code of their own."""

    groups: tuple[Group, ...]
    without_own_code: Names


def compare(
    codes: Mapping[str, str],
    provided: str,
    min_share: float,
    on_partial: Callable[[str, str], None] = lambda name, part: None,
) -> Comparison:
    """Return the groups of students with similar texts. Each student is in one group at most.

    Args:
        codes: the text of each student.
        provided: the text that the course provides.
        min_share: the share of a student's own text, 0 to 1, that must also be in the other text to put a pair into one
            group. Groups are chains of similar pairs, so the two ends of a chain may be less similar.
        on_partial: called with each student whose text is only compared in part, and a description of the part.
    """
    provided_fingerprint = _fingerprint(_dense(provided))
    fingerprints: dict[Names, CodeFingerprint] = {}
    for text, names in _by_text(codes, on_partial).items():
        fingerprint = fingerprints[names] = _fingerprint(text)
        fingerprint.hashes -= provided_fingerprint.hashes
        positions = {key: position for key, position in fingerprint.hash_idx.items() if key in fingerprint.hashes}
        fingerprint.hash_idx = positions
        fingerprint.token_coverage = get_token_coverage(positions, MIN_MATCH_TOKENS, len(fingerprint.filtered_code))
    with_own_code = {names: fingerprint for names, fingerprint in fingerprints.items() if fingerprint.hashes}
    links = sorted(_links(with_own_code, min_share), key=lambda pair: (-max(pair.shares), pair.names))
    groups = _with_texts(_join(links), with_own_code)
    return Comparison(groups, tuple(name for names in fingerprints if names not in with_own_code for name in names))


def _by_text(codes: Mapping[str, str], on_partial: Callable[[str, str], None]) -> dict[str, Names]:
    """Return the students of each text to compare."""
    students: dict[str, Names] = {}
    for name, code in codes.items():
        dense = _dense(code)
        if len(dense) > MAX_CHARACTERS:
            on_partial(name, f"the first {MAX_CHARACTERS:,} characters of its code; please check the rest yourself")
        text = dense[:MAX_CHARACTERS]
        students[text] = (*students.get(text, ()), name)
    return students


def _links(fingerprints: Fingerprints, min_share: float) -> Iterable[Pair]:
    """Yield the pairs of similar texts, and one pair for each text that several students have."""
    for names in fingerprints:
        if len(names) > 1:
            yield Pair((names[:1], names[1:]), (1.0, 1.0))
    for first, second in combinations(fingerprints, 2):
        _, shares, _ = compare_files(fingerprints[first], fingerprints[second])
        if max(shares) >= min_share and max(shares) > 0:
            yield Pair((first, second), (min(1.0, shares[0]), min(1.0, shares[1])))


def _join(links: Iterable[Pair]) -> list[Group]:
    """Join pairs into groups, most similar first. A pair whose students are already in one group is omitted."""
    group_of: dict[str, Group] = {}
    for link in links:
        first, second = (group_of.get(names[0], Group(names, ())) for names in link.names)
        if first.names == second.names:
            continue
        joined = Group((*first.names, *second.names), (*first.pairs, *second.pairs, link))
        group_of.update(dict.fromkeys(joined.names, joined))
    return list(dict.fromkeys(group_of.values()))


def _with_texts(groups: Sequence[Group], fingerprints: Fingerprints) -> tuple[Group, ...]:
    """Return the groups in order, with the texts of the most similar pairs."""
    ranked_pairs = sorted((pair for group in groups for pair in group.pairs), key=_rank)
    with_texts = {pair: _with_highlights(pair, fingerprints) for pair in ranked_pairs[:MAX_PAIRS]}
    ordered_groups = sorted(groups, key=lambda group: min(map(_rank, group.pairs)))
    return tuple(
        Group(tuple(sorted(group.names)), tuple(with_texts.get(pair, pair) for pair in sorted(group.pairs, key=_rank)))
        for group in ordered_groups
    )


def _rank(pair: Pair) -> tuple[float, tuple[Names, Names]]:
    return -max(pair.shares), pair.names


def _with_highlights(pair: Pair, fingerprints: Fingerprints) -> Pair:
    all_names = pair.names[0] + pair.names[1]  # the key in `fingerprints` if all of them have the same text
    first, second = (
        fingerprints[all_names] if all_names in fingerprints else fingerprints[names] for names in pair.names
    )
    _, _, slices = compare_files(first, second)
    return Pair(pair.names, pair.shares, (_marked(first.raw_code, slices[0]), _marked(second.raw_code, slices[1])))


def write_page(comparison: Comparison, out: Path) -> Path:
    """Write a page with the groups and the texts of each pair side by side, and return its path."""
    out.mkdir(parents=True, exist_ok=True)
    page = out / SUMMARY
    write_atomically(page, environment().get_template("similar.html.j2").render(groups=comparison.groups).encode())
    return page


def _dense(text: str) -> str:
    """Return a text without empty lines and with long lines broken.

    The lexer's time is quadratic in the number of consecutive empty lines, and in the length of a line.
    """
    lines = text.splitlines()
    parts = (line[start : start + MAX_LINE] for line in lines for start in range(0, len(line), MAX_LINE))
    return "\n".join(part for part in parts if part.strip())


def _fingerprint(text: str) -> CodeFingerprint:
    """Return the fingerprint of a text with all of its passages, without copydetect's sampling by hashes."""
    return CodeFingerprint("submission.py", MIN_MATCH_TOKENS, 1, fp=io.StringIO(text))


def _marked(text: str, slices: object) -> Markup:
    return Markup(highlight_overlap(text, slices, "<mark>", "</mark>", escape_html=True)[0])
