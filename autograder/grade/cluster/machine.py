"""The versions on a machine that affect grading. Only machines with the same versions give the same results.

A worker offers a Dask resource for each assignment and isolation level. The resource's name contains the digests of the
files that the grading reads and of the pinned packages, and the versions of Python and of the real launch, if it is
installed. A submission requests one such resource, so the scheduler never sends it to a worker with other versions.
"""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable

from autograder import course_paths
from autograder.ros.launch_packages import describe_launch
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.isolation import best_isolation
from autograder.suite import suites

LOCK = "requirements.lock"


def resource(assignment: str, isolation: Isolation) -> str:
    """Return the name of this machine's resource for an assignment and an isolation level."""
    lock = hashlib.sha256((course_paths.ROOT / LOCK).read_bytes()).hexdigest()[:12]
    python = ".".join(platform.python_version_tuple()[:2])
    launch = describe_launch().replace(", ", "+").replace(" ", "-")
    return (
        f"autograder {assignment} {suites.hidden(assignment).files_digest} {lock} {python} {launch} {isolation.value}"
    )


def resources() -> list[str]:
    """Return the names of all resources that this machine offers. This takes about a second."""
    return [
        resource(name, isolation)
        for name in suites.graded_assignments()
        for isolation in {Isolation.PROCESS, best_isolation()}
    ]


def difference(required: str, offered: Iterable[str]) -> str:
    """Explain why a worker that offers these resources lacks the required one, or return an empty string."""
    resources = [name.split() for name in offered if name.startswith("autograder ")]
    if not resources:
        return "it does not report its versions: start it with `--preload autograder.grade.cluster`"
    _, assignment, *local_versions, isolation = required.split()
    offered_versions = [versions for _, name, *versions, _ in resources if name == assignment]
    worker_versions = offered_versions[0] if offered_versions else ["missing", *local_versions[1:]]
    parts = (f"suite of {assignment}", LOCK, "Python", "launch")
    for part, theirs, ours in zip(parts, worker_versions, local_versions, strict=True):
        if theirs != ours:
            return f"its {part} is {theirs}, but here it is {ours}: install the same version of the course on both"
    if required.split() not in resources:
        return f"it does not support the isolation level {isolation}: `autograder doctor` there says how to fix it"
    return ""
