"""Counts and reports the results of generated mutants. Survivors, which no check kills, need a reason.

`survivors.yaml` contains two kinds of reasons. The report lists all survivors, with or without a reason.

    - equivalent: why no input can reveal a difference from the reference
      mutants: [the ids]
    - outside: which behaviour the requirements leave open
      mutants: [the ids]
"""

from __future__ import annotations

import textwrap
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from autograder.author.course.markdown_table import table
from autograder.author.course.yaml_files import load_yaml
from autograder.author.verification.generated_mutants import GeneratedMutants
from autograder.author.verification.mutation_run import FAILED, MutantResult
from autograder.exceptions import GraderError
from autograder.suite import suites

KINDS = ("equivalent", "outside")
MIN_KILLED, MIN_KILLED_OF_ALL = 0.95, 0.97  # the lowest acceptable scores of one chapter, and of all chapters together
HEAD = """# Generated mutants

Each operator is applied wherever it matches in the files that students write, and each mutant is graded until a check
fails. A cell shows `killed/all`. The score is killed / (all - equivalent). Mutants that the requirements do not cover
count as not killed. Mutants omitted before grading, because they are equivalent or duplicate: """


@dataclass(frozen=True)
class ChapterMutationResult:
    """A chapter's generated mutants, the reasons why mutants may survive, and the results."""

    assignment: str
    generated: GeneratedMutants
    reasons: Mapping[str, str]
    results: tuple[MutantResult, ...] = ()

    @property
    def survivors(self) -> dict[str, str]:
        """The ids of the mutants that no check killed, each with its reason or ""."""
        return {result.id: self.reasons.get(result.id, "") for result in self.results if not result.killed}

    @property
    def killed(self) -> int:
        """The number of mutants that a check killed."""
        return len(self.results) - len(self.survivors)

    @property
    def killable(self) -> int:
        """The number of graded mutants, except survivors that are equivalent to the reference."""
        return len(self.results) - sum(reason.startswith("equivalent: ") for reason in self.survivors.values())

    @property
    def failed(self) -> dict[str, str]:
        """The ids of the mutants on which the grader failed, each with the grader's error."""
        return {result.id: result.error for result in self.results if result.killer == FAILED}

    @property
    def unexplained(self) -> list[str]:
        """The survivors that have no reason."""
        return [name for name, reason in self.survivors.items() if not reason and name not in self.failed]


def reasons(assignment: str, generated: GeneratedMutants) -> dict[str, str]:
    """Return the reasons why generated mutants of a chapter may survive, by id.

    Raises:
        CourseError: `survivors.yaml` is not YAML, or violates its schema.
        GraderError: `survivors.yaml` names a mutant that does not exist, or gives two reasons for one mutant.
    """
    path = suites.hidden(assignment).folder / "survivors.yaml"
    entries = (load_yaml(path) if path.is_file() else None) or []
    by_mutant: dict[str, str] = {}
    for entry in entries:
        kinds = [kind for kind in KINDS if entry.get(kind)]
        if duplicates := by_mutant.keys() & entry["mutants"]:
            raise GraderError(f"{path}: there are two reasons for {', '.join(sorted(duplicates))}: keep one")
        by_mutant |= dict.fromkeys(entry["mutants"], f"{kinds[0]}: {entry[kinds[0]]}")
    for pair in (mutant.id for mutant in generated.mutants if mutant.operator == "pair"):
        pair_reasons = [by_mutant[name] for name in pair.split(" + ") if name in by_mutant]
        if len(pair_reasons) == 2:  # then the pair may also survive; "outside" outweighs "equivalent"
            by_mutant.setdefault(pair, max(pair_reasons, key=lambda reason: reason.startswith("outside")))
    if outdated_mutants := by_mutant.keys() - {mutant.id for mutant in generated.mutants}:
        raise GraderError(f"{path}: these mutants no longer exist: {', '.join(sorted(outdated_mutants))}")
    return by_mutant


def faults(chapter_results: Sequence[ChapterMutationResult]) -> list[str]:
    """Return a sentence for each mutant on which the grader failed, each unexplained survivor, and each low score.

    The diff of an unexplained survivor follows its sentence, because the id does not show the change. A score is judged
    only if all mutants of the chapter, or of all chapters, were graded.
    """
    sentences = [
        f"{chapter.assignment}: the grader failed on {name}: {error}"
        for chapter in chapter_results
        for name, error in chapter.failed.items()
    ]
    for chapter in chapter_results:
        diffs = {mutant.id: mutant.diff for mutant in chapter.generated.mutants}
        sentences += [
            f"{chapter.assignment}: {name} survives without a reason\n{textwrap.indent(diffs[name](), '    ')}"
            for name in chapter.unexplained
        ]
    complete_chapters = [
        chapter for chapter in chapter_results if len(chapter.results) == len(chapter.generated.mutants)
    ]
    scores = [(chapter.assignment, chapter.killed, chapter.killable, MIN_KILLED) for chapter in complete_chapters]
    if {chapter.assignment for chapter in complete_chapters} == set(suites.graded_assignments()):
        killed, killable = (
            sum(chapter.killed for chapter in complete_chapters),
            sum(chapter.killable for chapter in complete_chapters),
        )
        scores.append(("all chapters", killed, killable, MIN_KILLED_OF_ALL))
    return sentences + [
        f"{name}: {killed} of {killable} mutants fail a check, but at least {min_score:.0%} must"
        for name, killed, killable, min_score in scores
        if killed < min_score * killable
    ]


def mutant_counts(chapter_results: Iterable[ChapterMutationResult]) -> dict[str, dict[str, list[int]]]:
    """Return the counts [killed mutants, all mutants] for each operator of each chapter."""
    counts: dict[str, dict[str, list[int]]] = {}
    for chapter in chapter_results:
        operators = {mutant.id: mutant.operator for mutant in chapter.generated.mutants}
        by_operator = counts[chapter.assignment] = defaultdict(lambda: [0, 0])
        for result in chapter.results:
            for count in (by_operator[operators[result.id]], by_operator["all"]):
                count[0] += result.killed
                count[1] += 1
    return counts


def report(chapter_results: Sequence[ChapterMutationResult]) -> str:
    """Return a Markdown table of chapters and operators, followed by all survivors with their diffs."""
    omitted_count = sum(chapter.generated.omitted for chapter in chapter_results)
    return "\n".join([f"{HEAD}{omitted_count}.\n", *_table(chapter_results), *_survivors(chapter_results)])


def _table(chapter_results: Sequence[ChapterMutationResult]) -> Iterator[str]:
    counts = mutant_counts(chapter_results)
    operators = sorted({name for rows in counts.values() for name in rows}, key=lambda name: (name == "all", name))
    rows = []
    for operator in operators:
        cells = [operator_counts.get(operator, [0, 0]) for operator_counts in counts.values()]
        cells.insert(0, [sum(cell[i] for cell in cells) for i in (0, 1)])
        rows.append((operator, *(f"{killed}/{total}" if total else "" for killed, total in cells)))
    scores = [(chapter.killed, chapter.killable) for chapter in chapter_results]
    scores.insert(0, (sum(killed for killed, _ in scores), sum(killable for _, killable in scores)))
    rows.append(("without equivalent ones", *(f"{killed}/{killable}" for killed, killable in scores)))
    yield from table(("operator", "all", *(name[:2] for name in counts)), rows)


def _survivors(chapter_results: Iterable[ChapterMutationResult]) -> Iterator[str]:
    for chapter in chapter_results:
        mutants = {mutant.id: mutant for mutant in chapter.generated.mutants}
        yield f"## {chapter.assignment}: {len(chapter.survivors)} of {len(chapter.results)} survive\n"
        for name, reason in chapter.survivors.items():
            yield f"`{name}`: {reason or '**no reason**'}\n\n```diff\n{mutants[name].diff()}\n```\n"
