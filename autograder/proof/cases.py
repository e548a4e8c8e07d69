"""The submissions of the proof: what each is, how it is made, and what is claimed of its result."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from autograder import layout, suites
from autograder.proof.attacks import Attack, attacks
from autograder.proof.claims import Kind, as_named, full, killed, nothing
from autograder.proof.generated import Generated, generated
from autograder.result import Result
from autograder.suites.mutants import Mutant, lay_down, lay_down_reference, mutants

Judge = Callable[[Result], str]


@dataclass(frozen=True)
class Case:
    """One submission of the proof.

    Attributes:
        kind: what it is.
        name: unique in its assignment.
        write: writes it to a folder.
        judge: says what is not as claimed, an empty string if all is.
        reason: why it may survive, for a generated mutant.
    """

    kind: Kind
    name: str
    write: Callable[[Path], None]
    judge: Judge
    reason: str = ""


def cases(assignment: str, *, quick: bool = False) -> tuple[Case, ...]:
    """Return an assignment's proof: all of it, or the part for each change.

    Args:
        assignment: whose suite is to be proved.
        quick: one mutant a check, no generated ones and no attacks.
    """
    sources = suites.load(assignment).sources
    found = [
        Case(Kind.REFERENCE, "reference", partial(lay_down_reference, sources), full),
        Case(Kind.RELEASE, "release", partial(write_release, assignment), nothing),
        *_variants(assignment, sources),
    ]
    chosen = one_a_check(assignment) if quick else mutants(assignment)
    found += [Case(Kind.MUTANT, m.id, partial(lay_down, m, sources), partial(as_named, m)) for m in chosen]
    if not quick:
        found += [_generated(made, sources) for made in generated(assignment)]
        found += [_attack(attack) for attack in attacks(assignment)]
    return tuple(found)


def one_a_check(assignment: str) -> tuple[Mutant, ...]:
    """Return few mutants that fail every check that any mutant fails, by itself where one does so.

    A mutant fails a check by itself when the check is not merely skipped for want of one that it depends on.
    """
    depends = {check.id: frozenset(check.depends) for check in suites.manifest(assignment)}
    candidates = sorted(mutants(assignment), key=lambda m: m.slow)
    direct = {m.id: {name for name in m.loses if not depends[name] & m.loses} for m in candidates}
    chosen: list[Mutant] = []
    uncovered = set(depends)
    for covers in (direct, {m.id: set(m.loses) for m in candidates}):
        uncovered -= {name for m in chosen for name in covers[m.id]}
        while best := max(candidates, key=lambda m: (len(covers[m.id] & uncovered), not m.slow), default=None):
            if not covers[best.id] & uncovered:
                break
            chosen.append(best)
            uncovered -= covers[best.id]
    return tuple(chosen)


def write_release(assignment: str, folder: Path) -> None:
    """Write the assignment's folder as students get it."""
    import nbformat

    from autograder.course import Chapter, Form, in_form
    from autograder.course.execute import NOT_COPIED

    chapter = Chapter(layout.chapter(assignment))
    shutil.copytree(chapter.folder, folder, ignore=NOT_COPIED)
    nbformat.write(in_form(chapter.read(), Form.RELEASED), folder / chapter.path.name)


def _variants(assignment: str, sources: tuple[str, ...]) -> Iterator[Case]:
    """Yield the right answers of another style: whole files that take the place of the reference's."""
    folder = suites.load(assignment).files[0].parent / "variants"
    for variant in sorted(folder.iterdir()) if folder.is_dir() else ():

        def write(target: Path, variant: Path = variant) -> None:
            lay_down_reference(sources, target)
            shutil.copytree(variant, target / "src", dirs_exist_ok=True)

        yield Case(Kind.VARIANT, variant.name, write, full)


def _generated(made: Generated, sources: tuple[str, ...]) -> Case:
    def write(folder: Path) -> None:
        lay_down_reference(sources, folder)
        (folder / "src" / made.file).write_text(made.text, encoding="utf-8")

    return Case(Kind.GENERATED, made.id, write, killed, made.reason)


def _attack(attack: Attack) -> Case:
    return Case(Kind.ATTACK, attack.id.replace(" ", "-"), attack.make, attack.judge)
