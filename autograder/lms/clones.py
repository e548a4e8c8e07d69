"""Finds the accounts in the names of GitHub Classroom's clones: ASSIGNMENT-ACCOUNT, where both may contain hyphens.

The account is everything after the assignment's name: `hw-ada-bob` does not belong to bob. `gh classroom clone` puts
the clones in a folder named ASSIGNMENT-submissions. In any other folder, the assignment's name is the prefix that most
clones share. If several prefixes are equally frequent, it is the one that most of the roster's accounts follow, and at
least two do.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence

FOLDER_SUFFIX = "-submissions"
MIN_ACCOUNTS = 2  # accounts of the roster; one may only be the end of an unknown account


def prefixes(name: str) -> list[str]:
    """Return the names that the assignment of a clone may have according to the clone's name, shortest first."""
    parts = name.casefold().split("-")
    return ["-".join(parts[:end]) for end in range(1, len(parts))]


def assignment_of(names: Sequence[str], folder: str, course_id: str, accounts: Collection[str]) -> str | None:
    """Return the name that the assignment of some clones has in GitHub Classroom, or None if it is unclear.

    Args:
        names: the names of the clones.
        folder: the name of the folder that contains them.
        course_id: the assignment's name in the course, used as a last resort.
        accounts: the accounts on the roster.
    """
    count = Counter(prefix for name in names for prefix in prefixes(name))
    if not count:
        return None
    folder_prefix = folder.casefold().removesuffix(FOLDER_SUFFIX)
    if folder.casefold().endswith(FOLDER_SUFFIX) and count[folder_prefix]:
        return folder_prefix
    candidates = [prefix for prefix in count if count[prefix] == max(count.values())]
    if len(candidates) == 1:
        return candidates[0]
    known_accounts = {account.casefold() for account in accounts}
    matches = {prefix: sum(account_in(name, prefix) in known_accounts for name in names) for prefix in candidates}
    best, second = sorted(candidates, key=lambda prefix: matches[prefix], reverse=True)[:2]
    if matches[best] >= MIN_ACCOUNTS and matches[best] > matches[second]:
        return best
    chapter = course_id.casefold().replace("_", "-")
    return chapter if chapter in candidates else None


def account_in(name: str, assignment: str) -> str:
    """Return the account in the name of a clone, or an empty string if the clone belongs to another assignment."""
    prefix = f"{assignment}-"
    return name.casefold().removeprefix(prefix) if name.casefold().startswith(prefix) else ""
