"""The submissions of the proof: what each is, how it is made, and what is claimed of its result."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path

from autograder import layout
from autograder.author.course.release import write_released
from autograder.author.course.sync import Chapter
from autograder.author.verification.claims import Attack, CaseKind, verify_full_marks, verify_mutant, verify_zero
from autograder.author.verification.equivalent_rewrites import rewrites
from autograder.author.verification.mutants import Mutant, mutants, write_mutant, write_reference
from autograder.author.verification.population import written_by_students
from autograder.grade.job import Scope
from autograder.result.model import Result
from autograder.suite import suites

Verifier = Callable[[Result], str]
WITHOUT_PICTURES = Scope(pictures=False)


@dataclass(frozen=True)
class Case:
    """One submission of the proof: how it is written, how much of the suite grades it, and what its result must be.

    `name` is unique in the assignment. `verify` returns how a result differs from the expected one, or an empty string.
    """

    assignment: str
    kind: CaseKind
    name: str
    write: Callable[[Path], None]
    verify: Verifier
    scope: Scope = WITHOUT_PICTURES


def cases(assignment: str, *, quick: bool = False) -> tuple[Case, ...]:
    """Return an assignment's proof: all of it, or the part for each change.

    The quick part has one mutant for each check, graded by the checks that it stands for. It has no attacks and no
    answers that `equivalent_rewrites` made.
    """
    sources, chapter = suites.hidden(assignment).sources, Chapter(layout.chapter(assignment))
    found = [
        Case(assignment, CaseKind.REFERENCE, "reference", partial(write_reference, sources), verify_full_marks),
        Case(assignment, CaseKind.RELEASE, "release", partial(write_released, chapter), verify_zero),
        *_variants(assignment, sources),
    ]
    if quick:
        found += [_mutant(assignment, mutant, sources, only) for mutant, only in one_mutant_per_check(assignment)]
    else:
        found += [_mutant(assignment, mutant, sources) for mutant in mutants(assignment)]
        found += [_attack(assignment, attack) for attack in attacks(assignment)]
        found += rewritten_cases(assignment)
    return tuple(found)


def one_mutant_per_check(assignment: str) -> list[tuple[Mutant, tuple[str, ...]]]:
    """Return few mutants that fail every check, each with the checks that it stands for and those that these need.

    A mutant that fails the check alone is preferred to one that also fails a check that this one needs or comes after.
    """
    suite = suites.hidden(assignment)
    dependencies = {check.id: frozenset(check.dependencies) for check in suite.checks}
    candidates = sorted(mutants(assignment), key=lambda m: m.slow)
    direct = {m.id: {name for name in m.fails if not dependencies[name] & m.fails} for m in candidates}
    lost = {m.id: set(m.fails) for m in candidates}
    quick = [m for m in candidates if not m.slow]
    chosen: dict[str, set[str]] = {}
    uncovered = set(dependencies)
    for covers, among in ((direct, quick), (lost, quick), (lost, candidates)):
        while best := max(among, key=lambda m: len(covers[m.id] & uncovered), default=None):
            if not covers[best.id] & uncovered:
                break
            chosen.setdefault(best.id, set()).update(covers[best.id] & uncovered)
            uncovered -= covers[best.id]
    return [(m, suite.with_dependencies(*chosen[m.id])) for m in candidates if m.id in chosen]


def _mutant(assignment: str, mutant: Mutant, sources: tuple[str, ...], only: tuple[str, ...] = ()) -> Case:
    write, verify = partial(write_mutant, mutant, sources), partial(verify_mutant, mutant, only=frozenset(only))
    return Case(assignment, CaseKind.MUTANT, mutant.id, write, verify, scope=replace(WITHOUT_PICTURES, only=only))


def _variants(assignment: str, sources: tuple[str, ...]) -> Iterator[Case]:
    """Yield the right answers of another style: whole files that take the place of the reference's."""
    folder = suites.hidden(assignment).folder / "variants"
    for variant in sorted(folder.iterdir()) if folder.is_dir() else ():

        def write(target: Path, variant: Path = variant) -> None:
            write_reference(sources, target)
            shutil.copytree(variant, target / "src", dirs_exist_ok=True)

        yield Case(assignment, CaseKind.VARIANT, variant.name, write, verify_full_marks)


def rewritten_cases(assignment: str) -> list[Case]:
    """Return the answers that `equivalent_rewrites` makes from the reference, one for each way."""
    sources = suites.hidden(assignment).sources

    def write(target: Path, restyled: Callable[[str], str]) -> None:
        write_reference(sources, target)
        for file, *_ in written_by_students(assignment):
            path = target / "src" / file
            if path.suffix == ".py":
                path.write_text(restyled(path.read_text(encoding="utf-8")), encoding="utf-8")

    return [
        Case(assignment, CaseKind.VARIANT, style, partial(write, restyled=restyled), verify_full_marks)
        for style, restyled in rewrites().items()
    ]


def _attack(assignment: str, attack: Attack) -> Case:
    return Case(assignment, CaseKind.ATTACK, attack.id.replace(" ", "-"), attack.write, attack.verify)


def attacks(assignment: str) -> tuple[Attack, ...]:
    """Return the attacks of an assignment: what `attacks()` in the module of this name gives, beside its suites."""
    if not (suites.hidden(assignment).folder / "attacks.py").is_file():
        return ()
    found: tuple[Attack, ...] = import_module(f"{suites.HOME}.ch{assignment}.attacks").attacks()
    return found
