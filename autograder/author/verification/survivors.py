"""Counts and reports the results of the mutants. Each mutant that no check finds needs a reason in `survivors.yaml`.

The report lists these mutants with their reasons, and says where there is none. There are two kinds of reasons:

    - equivalent: why no input can show a difference from the reference
      mutants: [the ids]
    - outside: what the contract leaves free
      mutants: [the ids]
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import yaml

from autograder.author.course.markdown_table import table
from autograder.author.verification.mutation_run import FAILED, MutantResult
from autograder.author.verification.population import Population
from autograder.exceptions import GraderError
from autograder.suite import suites

KINDS = ("equivalent", "outside")
MIN_KILLED, MIN_KILLED_OF_ALL = 0.95, 0.97  # mutation scores of a chapter, and of all chapters
HEAD = """# The mutants

Every mutation by every operator in what students write, graded up to the first check that it loses. A cell is
`killed/all`. The score is killed / (all - equivalent); mutants outside of the contract count as not killed.
Left out before grading, as equivalent or duplicate mutants: """


@dataclass(frozen=True)
class ChapterMutationResult:
    """A chapter's population, the reasons of its survivors, and the results of its mutants."""

    assignment: str
    population: Population
    reasons: Mapping[str, str]
    results: tuple[MutantResult, ...] = ()

    @property
    def survivors(self) -> dict[str, str]:
        """The ids of the mutants that no check killed, each with its reason or ""."""
        return {result.id: self.reasons.get(result.id, "") for result in self.results if not result.killed}

    @property
    def killed(self) -> int:
        """How many mutants a check killed."""
        return len(self.results) - len(self.survivors)

    @property
    def killable(self) -> int:
        """How many mutants were graded, without the survivors that are equivalent to the reference."""
        return len(self.results) - sum(reason.startswith("equivalent: ") for reason in self.survivors.values())

    @property
    def failed(self) -> list[str]:
        """The mutants on which the grader failed."""
        return [result.id for result in self.results if result.killer == FAILED]

    @property
    def unexplained(self) -> list[str]:
        """The survivors that have no reason."""
        return [name for name, reason in self.survivors.items() if not reason and name not in self.failed]


def reasons(assignment: str, population: Population) -> dict[str, str]:
    """Return why mutants of a chapter's population may survive, by their ids.

    Raises:
        GraderError: a reason is of no kind or of two, or its mutants do not exist, or another reason has them.
    """
    path = suites.hidden(assignment).folder / "survivors.yaml"
    entries = yaml.safe_load(path.read_text(encoding="utf-8")) if path.is_file() else []
    found: dict[str, str] = {}
    for entry in entries:
        kinds = [kind for kind in KINDS if entry.get(kind)]
        if len(kinds) != 1 or found.keys() & entry["mutants"]:
            raise GraderError(f"{path}: each mutant has one reason, which is {' or '.join(KINDS)}: correct {entry}")
        found |= dict.fromkeys(entry["mutants"], f"{kinds[0]}: {entry[kinds[0]]}")
    for pair in (mutant.id for mutant in population.mutants if mutant.operator == "pair"):
        halves = [found[name] for name in pair.split(" + ") if name in found]
        if len(halves) == 2:  # if no check sees the pair, either; outside outweighs equivalent
            found.setdefault(pair, max(halves, key=lambda reason: reason.startswith("outside")))
    if gone := found.keys() - {mutant.id for mutant in population.mutants}:
        raise GraderError(f"{path}: there are no such mutants any more: {', '.join(sorted(gone))}")
    return found


def faults(chapters: Sequence[ChapterMutationResult]) -> list[str]:
    """Return a sentence for each mutant without a result or a reason, and for each score that is too low.

    A score counts only where all mutants of the chapter, or of all chapters, were graded.
    """
    found = [f"{each.assignment}: the grader failed on {name}" for each in chapters for name in each.failed]
    found += [f"{each.assignment}: {name} survives without a reason" for each in chapters for name in each.unexplained]
    whole = [each for each in chapters if len(each.results) == len(each.population.mutants)]
    scores = [(each.assignment, each.killed, each.killable, MIN_KILLED) for each in whole]
    if {each.assignment for each in whole} == set(suites.graded_assignments()):
        killed, killable = sum(each.killed for each in whole), sum(each.killable for each in whole)
        scores.append(("all chapters", killed, killable, MIN_KILLED_OF_ALL))
    return found + [
        f"{name}: {killed} of {killable} mutants lose a check, at least {required:.0%} have to"
        for name, killed, killable, required in scores
        if killed < required * killable
    ]


def mutant_counts(chapters: Iterable[ChapterMutationResult]) -> dict[str, dict[str, list[int]]]:
    """Return [killed, all] of each chapter by operator."""
    found: dict[str, dict[str, list[int]]] = {}
    for each in chapters:
        operators = {mutant.id: mutant.operator for mutant in each.population.mutants}
        rows = found[each.assignment] = defaultdict(lambda: [0, 0])
        for result in each.results:
            for row in (rows[operators[result.id]], rows["all"]):
                row[0] += result.killed
                row[1] += 1
    return found


def report(chapters: Sequence[ChapterMutationResult]) -> str:
    """Return the table chapter x operator, and all survivors with their places, as Markdown."""
    left_out = sum(each.population.left_out for each in chapters)
    return "\n".join([f"{HEAD}{left_out}.\n", *_table(chapters), *_survivors(chapters)])


def _table(chapters: Sequence[ChapterMutationResult]) -> Iterator[str]:
    found = mutant_counts(chapters)
    operators = sorted({name for rows in found.values() for name in rows}, key=lambda name: (name == "all", name))
    rows = []
    for operator in operators:
        cells = [chapter.get(operator, [0, 0]) for chapter in found.values()]
        both = [[sum(cell[i] for cell in cells) for i in (0, 1)], *cells]
        rows.append((operator, *(f"{killed}/{every}" if every else "" for killed, every in both)))
    scores = [(each.killed, each.killable) for each in chapters]
    scores.insert(0, (sum(killed for killed, _ in scores), sum(killable for _, killable in scores)))
    rows.append(("without the equivalent", *(f"{killed}/{killable}" for killed, killable in scores)))
    yield from table(("operator", "all", *(name[:2] for name in found)), rows)


def _survivors(chapters: Iterable[ChapterMutationResult]) -> Iterator[str]:
    for each in chapters:
        mutants = {mutant.id: mutant for mutant in each.population.mutants}
        yield f"## {each.assignment}: {len(each.survivors)} of {len(each.results)} survive\n"
        for name, reason in each.survivors.items():
            yield f"`{name}`: {reason or '**no reason**'}\n\n```diff\n{mutants[name].diff()}\n```\n"
