"""Writes the instructors' guide: the sentence of each hidden check, and the mutants that fail it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from autograder import layout
from autograder.checks import Check, suites
from autograder.course.markdown import table
from autograder.proof.mutants import Mutant, mutants

PAGE = layout.ROOT / "docs" / "checks.md"
HEAD = """# The hidden checks, and what proves them

For instructors; nothing of this page reaches students. Each check is named with the sentence that the student reads,
and with the flawed versions of the reference that fail it by themselves: small, realistic errors, `mutants.yaml` beside
the suite. `autograder verify` grades them all. `autograder course tables` writes this page.
"""
COLUMNS = ("check", "points", "the student reads", "fails in a version that")


def guide() -> str:
    """Return the guide as Markdown."""
    return HEAD + "".join(
        "\n".join(["", f"## {name}", "", *table(COLUMNS, _rows(suites.hidden(name).checks, mutants(name)))])
        for name in suites.graded()
    )


def _rows(checks: Sequence[Check], flawed: Sequence[Mutant]) -> Iterator[tuple[str, ...]]:
    for check in checks:
        alone = [m.title for m in flawed if check.id in m.loses and not m.loses & set(check.depends)]
        yield f"`{check.id}`", f"{check.points:g}", check.title, "; ".join(alone)
