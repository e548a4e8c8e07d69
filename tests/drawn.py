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


def marks(name: str, one_in: int, draw: str | None = None) -> list[pytest.MarkDecorator]:
    """Return the marks of a case: of a draw, by default the commit, one in so many runs, the others at night."""
    text = f"{commit() if draw is None else draw} {name}"
    chosen = int(hashlib.sha256(text.encode()).hexdigest(), 16) % one_in == 0
    return [] if chosen else [pytest.mark.nightly]
