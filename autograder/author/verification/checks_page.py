"""The page `checks.md` for instructors: the requirements, the hidden checks, and the mutants that fail them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from autograder.author.course.markdown_table import table
from autograder.author.verification.mutants import Mutant, mutants
from autograder.suite import Check, suites
from autograder.suite.contract import Sentence, contract

HEAD = """# The hidden checks and their mutants

For instructors: students do not get this page. Each check is listed with the sentence that the student reads, and with
the mutants that fail it directly. A mutant is a version of the reference with one small, realistic error, defined in
`mutants.yaml` beside the suite. `autograder verify` grades all of them. `autograder course tables` writes this page.

The requirements of a chapter are quoted from the notebook. Each is listed with the hidden checks that cover it and the
mutants that break it. A requirement without a check has a reason.
"""
COLUMNS = ("check", "points", "the student reads", "fails in a version that")
CONTRACT = ("the notebook says", "covered by", "broken by")


def checks_page() -> str:
    """Return the page as Markdown."""
    return HEAD + "".join("\n".join(["", f"## {name}", "", *_chapter(name)]) for name in suites.graded_assignments())


def _chapter(name: str) -> list[str]:
    checks, flawed = suites.hidden(name).checks, mutants(name)
    sentences = [_sentence(sentence, checks, flawed) for sentence in contract(name).values()]
    return [*table(COLUMNS, _rows(checks, flawed)), f"### The requirements of {name}\n", *table(CONTRACT, sentences)]


def _sentence(sentence: Sentence, checks: Sequence[Check], flawed: Sequence[Mutant]) -> tuple[str, ...]:
    """Return the row of a requirement."""
    if sentence.unchecked:
        return sentence.text, f"no check: {sentence.unchecked}", ""
    covering = [check for check in checks if sentence.id in check.covers]
    broken_by = dict.fromkeys(m.id for check in covering for m in flawed if _fails(m, check))
    return sentence.text, ", ".join(f"`{check.id}`" for check in covering), ", ".join(broken_by)


def _rows(checks: Sequence[Check], flawed: Sequence[Mutant]) -> Iterator[tuple[str, ...]]:
    for check in checks:
        errors = [m.title for m in flawed if _fails(m, check)]
        yield f"`{check.id}`", f"{check.points:g}", check.title, "; ".join(errors)


def _fails(mutant: Mutant, check: Check) -> bool:
    """Return whether a mutant fails a check directly, without failing any of its dependencies."""
    return check.id in mutant.fails and not mutant.fails & set(check.dependencies)
