"""Counts what became of the populations of mutants, and says of each survivor why it may live, or that nothing does.

`survivors.yaml` of a suite has the reasons. There are two kinds:

    - equivalent: why nobody could tell the mutants from the reference
      mutants: [the ids]
    - outside: what the contract leaves free
      mutants: [the ids]
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import yaml

from autograder.checks import suites
from autograder.course.markdown_table import table
from autograder.exceptions import GraderError
from autograder.proof.population import Population
from autograder.proof.survey import FAILED, Fate

KINDS = ("equivalent", "outside")
LEAST_KILLED, LEAST_KILLED_OF_ALL = 0.95, 0.97  # mutation scores of a chapter, and of all chapters
HEAD = """# The mutants

Every slip of every operator in what students write, graded up to the first check that it loses. A cell is
`killed/all`. The score is killed / (all - equivalent); mutants outside of the contract count as not killed.
Left out as equivalent or as twins before grading: """


@dataclass(frozen=True)
class Surveyed:
    """A chapter's population, why some of it may survive, and what became of it."""

    assignment: str
    population: Population
    reasons: Mapping[str, str]
    fates: tuple[Fate, ...] = ()

    @property
    def survivors(self) -> dict[str, str]:
        """The ids of the mutants that no check killed, each with its reason or ""."""
        return {fate.id: self.reasons.get(fate.id, "") for fate in self.fates if not fate.killed}

    @property
    def killed(self) -> int:
        """How many mutants a check killed."""
        return len(self.fates) - len(self.survivors)

    @property
    def killable(self) -> int:
        """How many mutants were graded, without the survivors that are equivalent to the reference."""
        return len(self.fates) - sum(reason.startswith("equivalent: ") for reason in self.survivors.values())

    @property
    def unexplained(self) -> list[str]:
        """The survivors that have no reason, and the mutants on which the grader failed."""
        failed = {fate.id for fate in self.fates if fate.killer == FAILED}
        return [name for name, reason in self.survivors.items() if not reason or name in failed]


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
            raise GraderError(f"{path}: each mutant has one reason, which is {' or '.join(KINDS)}: mend {entry}")
        found |= dict.fromkeys(entry["mutants"], f"{kinds[0]}: {entry[kinds[0]]}")
    for pair in (mutant.id for mutant in population.mutants if mutant.operator == "pair"):
        halves = [found[name] for name in pair.split(" + ") if name in found]
        if len(halves) == 2:  # if no check sees the pair, either; outside outweighs equivalent
            found.setdefault(pair, max(halves, key=lambda reason: reason.startswith("outside")))
    if gone := found.keys() - {mutant.id for mutant in population.mutants}:
        raise GraderError(f"{path}: there are no such mutants any more: {', '.join(sorted(gone))}")
    return found


def holds(surveyed: Sequence[Surveyed]) -> bool:
    """Return whether enough mutants were killed, of each chapter and of all, and every other one has a reason."""
    killed, killable = sum(each.killed for each in surveyed), sum(each.killable for each in surveyed)
    enough = all(each.killed >= LEAST_KILLED * each.killable for each in surveyed)
    enough = enough and killed >= LEAST_KILLED_OF_ALL * killable
    return enough and not any(each.unexplained for each in surveyed)


def mutant_counts(surveyed: Iterable[Surveyed]) -> dict[str, dict[str, list[int]]]:
    """Return [killed, all] of each chapter by operator."""
    found: dict[str, dict[str, list[int]]] = {}
    for each in surveyed:
        operators = {mutant.id: mutant.operator for mutant in each.population.mutants}
        rows = found[each.assignment] = defaultdict(lambda: [0, 0])
        for fate in each.fates:
            for row in (rows[operators[fate.id]], rows["all"]):
                row[0] += fate.killed
                row[1] += 1
    return found


def report(surveyed: Sequence[Surveyed]) -> str:
    """Return the table chapter x operator, and all survivors with their places, as Markdown."""
    left_out = sum(each.population.left_out for each in surveyed)
    return "\n".join([f"{HEAD}{left_out}.\n", *_table(surveyed), *_survivors(surveyed)])


def _table(surveyed: Sequence[Surveyed]) -> Iterator[str]:
    found = mutant_counts(surveyed)
    operators = sorted({name for rows in found.values() for name in rows}, key=lambda name: (name == "all", name))
    rows = []
    for operator in operators:
        cells = [chapter.get(operator, [0, 0]) for chapter in found.values()]
        both = [[sum(cell[i] for cell in cells) for i in (0, 1)], *cells]
        rows.append((operator, *(f"{killed}/{every}" if every else "" for killed, every in both)))
    scores = [(each.killed, each.killable) for each in surveyed]
    scores.insert(0, (sum(killed for killed, _ in scores), sum(killable for _, killable in scores)))
    rows.append(("without the equivalent", *(f"{killed}/{killable}" for killed, killable in scores)))
    yield from table(("operator", "all", *(name[:2] for name in found)), rows)


def _survivors(surveyed: Iterable[Surveyed]) -> Iterator[str]:
    for each in surveyed:
        mutants = {mutant.id: mutant for mutant in each.population.mutants}
        yield f"## {each.assignment}: {len(each.survivors)} of {len(each.fates)} survive\n"
        for name, reason in each.survivors.items():
            yield f"`{name}`: {reason or '**no reason**'}\n\n```diff\n{mutants[name].diff()}\n```\n"
