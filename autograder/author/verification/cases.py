"""The test cases of the verification: how to write each submission, and the result that it must get."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path

from autograder import course_paths
from autograder.author.course.release import write_released
from autograder.author.course.sync import Chapter
from autograder.author.verification.equivalent_rewrites import rewrites
from autograder.author.verification.generated_mutants import written_by_students
from autograder.author.verification.mutants import Mutant, mutants, write_mutant, write_reference
from autograder.author.verification.verdicts import Attack, CaseKind, verify_full_marks, verify_mutant, verify_zero
from autograder.grade.job import Options
from autograder.result.model import Result
from autograder.suite import suites

Verifier = Callable[[Result], str]
WITHOUT_PICTURES = Options(pictures=False)


@dataclass(frozen=True)
class Case:
    """A submission with a known mark.

    `name` is unique in the assignment. `write` writes the submission to a folder. `verify` describes how a result
    differs from the expected one, or returns an empty string. `options` may limit which checks are run.
    """

    assignment: str
    kind: CaseKind
    name: str
    write: Callable[[Path], None]
    verify: Verifier
    options: Options = WITHOUT_PICTURES


def cases(assignment: str, *, quick: bool = False) -> tuple[Case, ...]:
    """Return the test cases of an assignment.

    The quick cases include one mutant for each check, graded only by the checks that it represents. They include no
    attacks and no answers from `equivalent_rewrites`.
    """
    sources, chapter = suites.hidden(assignment).sources, Chapter(course_paths.chapter(assignment))
    test_cases = [
        Case(assignment, CaseKind.REFERENCE, "reference", partial(write_reference, sources), verify_full_marks),
        Case(assignment, CaseKind.RELEASE, "release", partial(write_released, chapter), verify_zero),
        *_variant_cases(assignment, sources),
    ]
    if quick:
        test_cases += [_mutant_case(assignment, m, sources, only) for m, only in one_mutant_per_check(assignment)]
    else:
        test_cases += [_mutant_case(assignment, mutant, sources) for mutant in mutants(assignment)]
        test_cases += [_attack_case(assignment, attack) for attack in attacks(assignment)]
        test_cases += rewritten_cases(assignment)
    return tuple(test_cases)


def one_mutant_per_check(assignment: str) -> list[tuple[Mutant, tuple[str, ...]]]:
    """Return a small set of mutants that together fail every check.

    Each mutant comes with the checks that it represents and their dependencies. A mutant that fails a check directly
    is preferred to one that also fails a dependency of that check. If no record shows that a mutant fails a check, a
    mutant without a record represents it, provided that it was written for this check.
    """
    suite = suites.hidden(assignment)
    dependencies = {check.id: frozenset(check.dependencies) for check in suite.checks}
    candidates = sorted(mutants(assignment), key=lambda m: m.slow)
    direct_failures = {m.id: {name for name in m.fails if not dependencies[name] & m.fails} for m in candidates}
    all_failures = {m.id: set(m.fails) for m in candidates}
    unrecorded_failures = {m.id: set() if m.fails else {m.check} for m in candidates}
    quick_mutants = [m for m in candidates if not m.slow]
    chosen_checks: dict[str, set[str]] = {}
    uncovered_checks = set(dependencies)
    for covered_by, pool in (
        (direct_failures, quick_mutants),
        (all_failures, quick_mutants),
        (all_failures, candidates),
        (unrecorded_failures, candidates),
    ):
        while best := max(pool, key=lambda m: len(covered_by[m.id] & uncovered_checks), default=None):
            if not covered_by[best.id] & uncovered_checks:
                break
            chosen_checks.setdefault(best.id, set()).update(covered_by[best.id] & uncovered_checks)
            uncovered_checks -= covered_by[best.id]
    return [(m, suite.with_dependencies(*chosen_checks[m.id])) for m in candidates if m.id in chosen_checks]


def _mutant_case(assignment: str, mutant: Mutant, sources: tuple[str, ...], only: tuple[str, ...] = ()) -> Case:
    write, verify = partial(write_mutant, mutant, sources), partial(verify_mutant, mutant, only=frozenset(only))
    return Case(assignment, CaseKind.MUTANT, mutant.id, write, verify, options=replace(WITHOUT_PICTURES, only=only))


def _variant_cases(assignment: str, sources: tuple[str, ...]) -> Iterator[Case]:
    """Yield correct answers in other styles: the reference with some files replaced."""
    folder = suites.hidden(assignment).folder / "variants"
    for variant in sorted(path for path in folder.glob("*") if path.is_dir()):

        def write(target: Path, variant: Path = variant) -> None:
            write_reference(sources, target)
            shutil.copytree(variant, target / "src", dirs_exist_ok=True)

        yield Case(assignment, CaseKind.VARIANT, variant.name, write, verify_full_marks)


def rewritten_cases(assignment: str) -> list[Case]:
    """Return a case for each rewrite of the reference by `equivalent_rewrites`."""
    sources = suites.hidden(assignment).sources

    def write(target: Path, rewrite: Callable[[str], str]) -> None:
        write_reference(sources, target)
        for file, *_ in written_by_students(assignment):
            path = target / "src" / file
            if path.suffix == ".py":
                path.write_text(rewrite(path.read_text(encoding="utf-8")), encoding="utf-8")

    return [
        Case(assignment, CaseKind.VARIANT, style, partial(write, rewrite=rewrite), verify_full_marks)
        for style, rewrite in rewrites().items()
    ]


def _attack_case(assignment: str, attack: Attack) -> Case:
    return Case(assignment, CaseKind.ATTACK, attack.id.replace(" ", "-"), attack.write, attack.verify)


def attacks(assignment: str) -> tuple[Attack, ...]:
    """Return the attacks on an assignment, which `attacks()` in `attacks.py` beside its suites defines."""
    if not (suites.hidden(assignment).folder / "attacks.py").is_file():
        return ()
    chapter_attacks: tuple[Attack, ...] = import_module(f"{suites.HOME}.ch{assignment}.attacks").attacks()
    return chapter_attacks
