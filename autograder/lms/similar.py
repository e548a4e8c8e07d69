"""Finds pairs of submissions with similar passages. Text that the course gives does not count.

A pair is a hint for a person to read both texts, and no verdict. copydetect compares the passages: each name and each
string is one token, whatever its text, so that other names hide nothing.

A text may be made to take long: its length and the processor time for it are bounded, and so is the number of pairs.
"""

from __future__ import annotations

import heapq
import io
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from copydetect.detector import CodeFingerprint, compare_files
from copydetect.utils import get_token_coverage, highlight_overlap
from markupsafe import Markup

from autograder.exceptions import AutograderError
from autograder.plain_text import clean
from autograder.report.feedback.pages import SUMMARY, environment
from autograder.result.model import write_atomically
from autograder.submission.intake import Submission
from autograder.submission.intake.notebooks import read_cells

MIN_MATCH_TOKENS = 50  # a shorter passage does not count; these are about three lines
MAX_CHARACTERS = 200_000  # of a text
MAX_SECONDS = 20.0  # of processor time for a text; one of the greatest length needs 1 s
MAX_PAIRS = 100  # on the page, which holds both texts of each


class _TooLong(AutograderError):
    """A text took longer than any that a person writes."""


@dataclass(frozen=True)
class Pair:
    """Two submissions, the share of their own text that is alike, and their texts with the passages marked."""

    names: tuple[str, str]
    shares: tuple[float, float]
    texts: tuple[Markup, Markup]


def code(submission: Submission) -> str:
    """Return the Python of a submission: its modules and the code cells of its notebook."""
    texts = [f"# {file.path}\n{_text(file.data)}" for file in submission.source if file.path.suffix == ".py"]
    if submission.notebook is not None:
        with suppress(ValueError):  # the modules are compared all the same
            texts += [cell["source"] for cell in read_cells(submission.notebook) if cell["cell_type"] == "code"]
    return clean("\n".join(texts))


def pairs(
    codes: Mapping[str, str], given: str, least: float, on_skip: Callable[[str, str], None] = lambda name, why: None
) -> list[Pair]:
    """Return the pairs that are most alike, `MAX_PAIRS` at most, the most alike first.

    It works in the main thread alone, which the limit of processor time interrupts.

    Args:
        codes: the text of each student.
        given: the text that the course gives.
        least: the share of its own text, 0 to 1, that one of a pair has to have in the other.
        on_skip: is called with each student whose text is not compared, and why.
    """
    gift = _fingerprint(given)
    prints: dict[str, CodeFingerprint] = {}
    for name, text in codes.items():
        if len(text) > MAX_CHARACTERS:
            on_skip(name, f"its code has {len(text):,} characters, more than {MAX_CHARACTERS:,}")
            continue
        try:
            with _bounded(MAX_SECONDS):
                prints[name] = _fingerprint(text)
        except _TooLong:
            on_skip(name, f"its code took more than {MAX_SECONDS:g} s to be read: look at it yourself")
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


def _text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace")


@contextmanager
def _bounded(seconds: float) -> Iterator[None]:
    """Raise _TooLong in this block, and in what it calls, after so much processor time."""

    def stop(*_: object) -> None:
        raise _TooLong

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def _fingerprint(text: str) -> CodeFingerprint:
    """Return all passages of a text: those that are there do not depend on a hash's luck."""
    return CodeFingerprint("submission.py", MIN_MATCH_TOKENS, 1, fp=io.StringIO(text))


def _marked(text: str, slices: object) -> Markup:
    return Markup(highlight_overlap(text, slices, "<mark>", "</mark>", escape_html=True)[0])
