"""One finding about the machine, and a list of them as text."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

VERDICTS = ("Everything needed is here.", "Something needed is missing.")


class Status(str, Enum):
    """How a finding stands: `weak` works with a restriction, `missing` stops a part of the course."""

    OK = "ok"
    WEAK = "weak"
    MISSING = "missing"


@dataclass(frozen=True)
class Finding:
    """What was looked at, and how it stands."""

    name: str
    status: Status
    found: str  # what was found, in a sentence without its full stop
    fix: str = ""  # the one command that fixes it; empty if there is nothing to fix


def healthy(findings: Sequence[Finding]) -> bool:
    """Say whether everything needed is there; a weak finding does not count against it."""
    return all(finding.status is not Status.MISSING for finding in findings)


def render(findings: Sequence[Finding], *, width: int = 100, verdicts: tuple[str, str] = VERDICTS) -> str:
    """Return the findings as aligned lines, the command that fixes a lack under it, and a closing sentence."""
    longest = max(len(finding.name) for finding in findings)
    lines = []
    for finding in findings:
        head = f"{finding.status.value:8} {finding.name:{longest}}  "
        indent = " " * len(head)
        lines += textwrap.wrap(finding.found, width, initial_indent=head, subsequent_indent=indent)
        if finding.fix:
            # Never wrapped: it is there to be copied.
            lines.append(f"{indent}fix: {finding.fix}")
    count = {status: sum(finding.status is status for finding in findings) for status in Status}
    verdict = verdicts[0] if healthy(findings) else verdicts[1]
    return "\n".join(
        [*lines, "", f"{verdict} {count[Status.OK]} ok, {count[Status.WEAK]} weak, {count[Status.MISSING]} missing."]
    )
