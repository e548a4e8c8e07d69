"""Finds pairs of submissions with similar passages. Text that the course gives does not count.

A pair is a hint for a person to read both texts, and no verdict. copydetect compares the passages: each name and each
string is one token, whatever its text, so that other names hide nothing.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from copydetect.detector import CodeFingerprint, compare_files
from copydetect.utils import get_token_coverage, highlight_overlap
from markupsafe import Markup

from autograder.feedback.pages import SUMMARY, environment
from autograder.intake import Submission
from autograder.intake.notebooks import read_cells
from autograder.result import write_atomically

MIN_MATCH_TOKENS = 50  # a shorter passage does not count; these are about three lines


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
    return "\n".join(texts)


def pairs(codes: Mapping[str, str], given: str, least: float) -> list[Pair]:
    """Return the pairs of which one has at least the share `least` of its own text in the other, most alike first."""
    gift = _fingerprint(given)
    prints = {name: _fingerprint(text) for name, text in codes.items()}
    for found in prints.values():
        found.hashes -= gift.hashes
        found.hash_idx = {key: places for key, places in found.hash_idx.items() if key in found.hashes}
        found.token_coverage = get_token_coverage(found.hash_idx, MIN_MATCH_TOKENS, len(found.filtered_code))
    alike = []
    for one, two in combinations(prints, 2):
        first, second = prints[one], prints[two]
        _, shares, slices = compare_files(first, second)
        if max(shares) >= least and max(shares) > 0:
            texts = (_marked(first.raw_code, slices[0]), _marked(second.raw_code, slices[1]))
            alike.append(Pair((one, two), (min(1.0, shares[0]), min(1.0, shares[1])), texts))
    return sorted(alike, key=lambda pair: (-max(pair.shares), pair.names))


def write_pairs(found: Sequence[Pair], out: Path) -> Path:
    """Write a page with the texts of each pair side by side, and return its path."""
    out.mkdir(parents=True, exist_ok=True)
    page = out / SUMMARY
    write_atomically(page, environment().get_template("similar.html.j2").render(pairs=found).encode())
    return page


def _text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace").replace("\r\n", "\n")


def _fingerprint(text: str) -> CodeFingerprint:
    """Return all passages of a text: those that are there do not depend on a hash's luck."""
    return CodeFingerprint("submission.py", MIN_MATCH_TOKENS, 1, fp=io.StringIO(text))


def _marked(text: str, slices: object) -> Markup:
    return Markup(highlight_overlap(text, slices, "<mark>", "</mark>", escape_html=True)[0])
