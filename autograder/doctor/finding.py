"""Findings about the machine, and their text form."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

VERDICTS = ("Nothing is missing.", "Something is missing.")


class Status(str, Enum):
    """The status of a finding: `weak` works with a restriction, `missing` blocks part of the course."""

    OK = "ok"
    WEAK = "weak"
    MISSING = "missing"


@dataclass(frozen=True)
class Finding:
    """The result of one examination."""

    name: str
    status: Status
    state: str  # a sentence without its full stop
    fix: str = ""  # the one command that fixes it; empty if there is nothing to fix


def healthy(findings: Sequence[Finding]) -> bool:
    """Return whether nothing is missing. Weak findings are acceptable."""
    return all(finding.status is not Status.MISSING for finding in findings)


def render(findings: Sequence[Finding], *, width: int = 100, verdicts: tuple[str, str] = VERDICTS) -> str:
    """Return the findings as aligned lines, each with the command that fixes it, and a summary."""
    longest = max(len(finding.name) for finding in findings)
    lines = []
    for finding in findings:
        head = f"{finding.status.value:8} {finding.name:{longest}}  "
        indent = " " * len(head)
        lines += textwrap.wrap(finding.state, width, initial_indent=head, subsequent_indent=indent)
        if finding.fix:
            # A command is not wrapped, so that it can be copied.
            lines.append(f"{indent}fix: {finding.fix}")
    count = {status: sum(finding.status is status for finding in findings) for status in Status}
    verdict = verdicts[0] if healthy(findings) else verdicts[1]
    return "\n".join(
        [*lines, "", f"{verdict} {count[Status.OK]} ok, {count[Status.WEAK]} weak, {count[Status.MISSING]} missing."]
    )
