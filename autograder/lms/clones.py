"""Finds the accounts in the names of GitHub Classroom's clones: ASSIGNMENT-ACCOUNT, where either may hold hyphens.

An account is whatever follows the assignment's name, whole: `hw-ada-bob` is not bob's. `gh classroom clone` puts the
clones into the folder ASSIGNMENT-submissions. Where the folder has another name, the assignment's is the beginning that
most clones have; of several, the one after which at least two accounts of the roster stand, and more than after others.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence

FOLDER = "-submissions"
EVIDENCE = 2  # accounts of the roster; after one, a stranger's account can end like it


def beginnings(name: str) -> list[str]:
    """Return what may be the assignment's name in that of a clone, the shortest first."""
    parts = name.casefold().split("-")
    return ["-".join(parts[:end]) for end in range(1, len(parts))]


def assignment_of(names: Sequence[str], folder: str, course_id: str, accounts: Collection[str]) -> str | None:
    """Return the name that GitHub Classroom has for the assignment of some clones, None if it is unclear.

    Args:
        names: those of the clones.
        folder: the name of the folder that they lie in.
        course_id: the course's own name of the assignment, which counts where nothing else tells.
        accounts: those of the roster.
    """
    count = Counter(beginning for name in names for beginning in beginnings(name))
    if not count:
        return None
    said = folder.casefold().removesuffix(FOLDER)
    if folder.casefold().endswith(FOLDER) and count[said]:
        return said
    likely = [beginning for beginning in count if count[beginning] == max(count.values())]
    if len(likely) == 1:
        return likely[0]
    known = {account.casefold() for account in accounts}
    fitting = {one: sum(account_in(name, one) in known for name in names) for one in likely}
    best, second = sorted(likely, key=lambda one: fitting[one], reverse=True)[:2]
    if fitting[best] >= EVIDENCE and fitting[best] > fitting[second]:
        return best
    own = course_id.casefold().replace("_", "-")
    return own if own in likely else None


def account_in(name: str, assignment: str) -> str:
    """Return the account in the name of a clone, empty if it is of another assignment."""
    begin = f"{assignment}-"
    return name.casefold().removeprefix(begin) if name.casefold().startswith(begin) else ""
