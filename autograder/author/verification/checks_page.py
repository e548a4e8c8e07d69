"""The page `checks.md` for instructors: the contract, the hidden checks, and the mutants that fail them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from autograder.author.course.markdown_table import table
from autograder.author.verification.mutants import Mutant, mutants
from autograder.suite import Check, suites
from autograder.suite.contract import Sentence, contract

HEAD = """# The hidden checks, and what proves them

For instructors; nothing of this page reaches students. Each check is named with the sentence that the student reads,
and with the flawed versions of the reference that fail it by themselves: small, realistic errors, `mutants.yaml` beside
the suite. `autograder verify` grades them all. `autograder course tables` writes this page.

The contract of a chapter is the list of the sentences that oblige a student, as they stand in the notebook. Each has
the hidden checks that hold it and the mutants that break it, by their names. A sentence without a check says why.
"""
COLUMNS = ("check", "points", "the student reads", "fails in a version that")
CONTRACT = ("the notebook says", "held by", "broken by")


def checks_page() -> str:
    """Return the page as Markdown."""
    return HEAD + "".join("\n".join(["", f"## {name}", "", *_chapter(name)]) for name in suites.graded_assignments())


def _chapter(name: str) -> list[str]:
    checks, flawed = suites.hidden(name).checks, mutants(name)
    sentences = [_sentence(sentence, checks, flawed) for sentence in contract(name).values()]
    return [*table(COLUMNS, _rows(checks, flawed)), f"### The contract of {name}\n", *table(CONTRACT, sentences)]


def _sentence(sentence: Sentence, checks: Sequence[Check], flawed: Sequence[Mutant]) -> tuple[str, ...]:
    """Return the row of a sentence of the contract."""
    if sentence.unchecked:
        return sentence.text, f"no check: {sentence.unchecked}", ""
    holding = [check for check in checks if sentence.id in check.holds]
    broken = dict.fromkeys(m.id for check in holding for m in flawed if _fails(m, check))
    return sentence.text, ", ".join(f"`{check.id}`" for check in holding), ", ".join(broken)


def _rows(checks: Sequence[Check], flawed: Sequence[Mutant]) -> Iterator[tuple[str, ...]]:
    for check in checks:
        alone = [m.title for m in flawed if _fails(m, check)]
        yield f"`{check.id}`", f"{check.points:g}", check.title, "; ".join(alone)


def _fails(mutant: Mutant, check: Check) -> bool:
    """Return whether a mutant fails a check by itself, not with one that the check needs or comes after."""
    return check.id in mutant.fails and not mutant.fails & set(check.dependencies)
