"""Chooses the cases of a long test that run for this commit. The runs of several commits take all cases.

The environment variable `DRAW=all` takes all of them. The workflow sets it: its jobs have a machine each.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@lru_cache(maxsize=1)
def commit() -> str:
    """Return the hash of the commit that is checked out, "" outside of a repository."""
    found = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
    return found.stdout.strip()


def sample(names: Iterable[str], one_in: int, draw: str | None = None) -> set[str]:
    """Return one in so many names, at least one, as a draw chooses them.

    Every draw chooses the same number, so that all runs take equally long.

    Args:
        names: what is drawn from.
        one_in: in how many there is a chosen one.
        draw: the draw; that of the environment, or the commit, if there is none.
    """
    text = os.environ.get("DRAW", commit()) if draw is None else draw
    if text == "all":
        return set(names)
    ranked = sorted(names, key=lambda name: hashlib.sha256(f"{text} {name}".encode()).digest())
    return set(ranked[: -(-len(ranked) // one_in)])


def unless(chosen: bool) -> list[pytest.MarkDecorator]:
    """Return the marks of a case: one that is not chosen runs at night."""
    return [] if chosen else [pytest.mark.nightly]
