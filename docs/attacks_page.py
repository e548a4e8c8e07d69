"""The page `attacks.md`, from `attacks.yaml`."""

from __future__ import annotations

from typing import Any

import yaml

from autograder.author.course.markdown_table import table
from autograder.author.verification.cases import attacks
from autograder.layout import ROOT
from autograder.suite import suites

ROWS: list[dict[str, Any]] = yaml.safe_load((ROOT / "docs" / "attacks.yaml").read_text(encoding="utf-8"))

HEAD = """# Attacks and their tests

What a malicious submission can try. The proof grades submissions that try it, and tests try it on a part alone.
`make docs` writes this page from `docs/attacks.yaml`.
"""
OPEN = """
## Not blocked

- **Buffers of sockets, where no control group can be made.** There the limits of a sandbox count what its processes
  have mapped. `autograder doctor` says whether the kernel counts the rest.
- **Answers copied from another student.** No mark depends on it. `autograder similar` shows groups of submissions
  that are alike, for a person to judge.
- **Whole lines of a log that a program prints.** A node that prints what the logger would print is heard as if it had
  logged (07). A launch file that gives its processes other names can print an order that it does not keep (04).
"""


def current() -> str:
    """Return the page as it should be."""
    described = [
        (attack.id, assignment, attack.description)
        for assignment in suites.graded_assignments()
        for attack in attacks(assignment)
    ]
    rows = [
        (str(number), row["attack"], "; ".join(row["submissions"]), _tests(row["tests"]))
        for number, row in enumerate(ROWS, 1)
    ]
    return "\n".join(
        [
            HEAD,
            *table(("#", "attack", "submissions of the proof", "tests"), rows),
            "## The submissions\n",
            *table(("name", "chapter", "what it tries"), described),
            OPEN.strip() + "\n",
        ]
    )


def _tests(files: dict[str, list[str]]) -> str:
    names = (name.removeprefix("test_") for named in files.values() for name in named)
    return "; ".join(name.replace("_s_", "'s ").replace("_", " ") for name in names)
