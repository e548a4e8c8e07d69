"""Draws the cases of a long test that run for this commit, so that the runs of a few commits take them all."""

from __future__ import annotations

import hashlib
import subprocess
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@lru_cache(maxsize=1)
def commit() -> str:
    """Return the hash of the commit that is checked out, "" outside of a repository."""
    found = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
    return found.stdout.strip()


def is_drawn(name: str, one_in: int, draw: str | None = None) -> bool:
    """Return whether a case is among the one in so many that a draw, by default the commit, chooses."""
    text = f"{commit() if draw is None else draw} {name}"
    return int(hashlib.sha256(text.encode()).hexdigest(), 16) % one_in == 0


def marks(name: str, one_in: int, draw: str | None = None) -> list[pytest.MarkDecorator]:
    """Return the marks of a case: one that is not drawn is for the night."""
    return [] if is_drawn(name, one_in, draw) else [pytest.mark.nightly]
