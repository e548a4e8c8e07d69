"""The versions with which a machine grades. Only machines with the same versions give the same results.

A worker offers a resource of Dask for each pair of assignment and tier. Its name also holds the digest of the files
that the grading reads, that of the pinned packages, the version of Python and those of the real launch, if it is
installed. A submission asks for one such resource, so the scheduler never gives it to a worker that differs.
"""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable

from autograder import layout
from autograder.ros.launch_packages import describe_launch
from autograder.run.sandbox import Tier
from autograder.run.sandbox.tiers import best_tier
from autograder.suite import suites

LOCK = "requirements.lock"


def resource(assignment: str, tier: Tier) -> str:
    """Return the name of the resource by which this machine grades an assignment in a tier."""
    lock = hashlib.sha256((layout.ROOT / LOCK).read_bytes()).hexdigest()[:12]
    python = ".".join(platform.python_version_tuple()[:2])
    launch = describe_launch().replace(", ", "+").replace(" ", "-")
    return f"autograder {assignment} {suites.hidden(assignment).files_digest} {lock} {python} {launch} {tier.value}"


def resources() -> list[str]:
    """Return the names of all resources that this machine offers. It takes about a second."""
    return [resource(name, tier) for name in suites.graded_assignments() for tier in {Tier.PROCESS, best_tier()}]


def difference(wanted: str, offered: Iterable[str]) -> str:
    """Say in a sentence why a worker that offers these resources does not offer the wanted one; empty if it does."""
    found = [name.split() for name in offered if name.startswith("autograder ")]
    if not found:
        return "it does not say what it grades with: start it with `--preload autograder.grade.cluster`"
    _, assignment, *ours, tier = wanted.split()
    graded = [versions for _, name, *versions, _ in found if name == assignment]
    theirs = graded[0] if graded else ["missing", *ours[1:]]
    for what, their, our in zip((f"suite of {assignment}", LOCK, "Python", "launch"), theirs, ours, strict=True):
        if their != our:
            return f"its {what} is {their}, and here it is {our}: give both the same version of the course"
    if wanted.split() not in found:
        return f"it cannot isolate submissions by {tier}: `autograder doctor` there says what fixes it"
    return ""
