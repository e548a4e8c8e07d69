"""The page `attacks.md`, generated from `attacks.yaml`."""

from __future__ import annotations

from typing import Any

import yaml

from autograder.author.course.markdown_table import table
from autograder.author.verification.cases import attacks
from autograder.course_paths import ROOT
from autograder.suite import suites

ROWS: list[dict[str, Any]] = yaml.safe_load((ROOT / "docs" / "attacks.yaml").read_text(encoding="utf-8"))

HEAD = """# Attacks and their tests

This page lists what a malicious submission can try. The verification grades submissions that try it, and tests try it
on single parts of the grader. `make docs` writes this page from `docs/attacks.yaml`.
"""
OPEN = """
## Not blocked

- **Socket buffers without a control group.** In that case, the limits of a sandbox only count the memory that its
  processes have mapped. `autograder doctor` says whether the kernel counts the rest.
- **Answers copied from another student.** Copying does not affect a mark. `autograder similar` shows groups of similar
  submissions for a person to judge.
- **Forged log lines.** A node that prints a line in the logger's format counts as having logged it (07). A launch file
  that renames its processes can print an order that it does not keep (04).
"""


def current() -> str:
    """Return the page as Markdown."""
    submission_rows = [
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
            *table(("#", "attack", "submissions of the verification", "tests"), rows),
            "## The submissions\n",
            *table(("name", "chapter", "what it tries"), submission_rows),
            OPEN.strip() + "\n",
        ]
    )


def _tests(files: dict[str, list[str]]) -> str:
    names = (name.removeprefix("test_") for tests in files.values() for name in tests)
    return "; ".join(name.replace("_s_", "'s ").replace("_", " ") for name in names)
