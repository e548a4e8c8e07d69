"""Writes attacks: the reference, or a mutant whose losses are known, and in it what the payload changes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from autograder.author.verification.mutants import Mutant, mutants, write_mutant, write_reference
from autograder.suite import suites

TELLING = 14  # letters; a shorter id of a check may be a name that anything else has
Write = Callable[[Path], None]


@dataclass(frozen=True)
class Chapter:
    """The chapter whose submissions an attack starts from."""

    assignment: str

    @property
    def checks(self) -> frozenset[str]:
        """The ids of every check."""
        return frozenset(check.id for check in suites.hidden(self.assignment).checks)

    @property
    def telling_names(self) -> tuple[str, ...]:
        """Words that stand around a program only if something tells it by which hidden checks it is judged."""
        return (self.assignment, "hidden", *sorted(name for name in self.checks if len(name) > TELLING))

    def mutant(self, name: str) -> Mutant:
        """Return a mutant by its name."""
        return next(found for found in mutants(self.assignment) if found.id == name)

    def write(
        self,
        base: str | None = None,
        *,
        heads: Mapping[str, str] = {},
        swaps: Mapping[str, tuple[str, str]] = {},
        files: Mapping[str, str] = {},
    ) -> Write:
        """Return a function that writes a source tree with payloads. Paths are below its `src`.

        Args:
            base: the mutant that gets them; the reference if None.
            heads: text that goes before a file's own.
            swaps: part of a file's text, and what takes its place.
            files: whole files.
        """

        def write(folder: Path) -> None:
            sources = suites.hidden(self.assignment).sources
            if base is None:
                write_reference(sources, folder)
            else:
                write_mutant(self.mutant(base), sources, folder)
            home = folder / "src"
            for name, text in files.items():
                (home / name).parent.mkdir(parents=True, exist_ok=True)
                (home / name).write_text(text)
            for name, (find, put) in swaps.items():
                text = (home / name).read_text()
                assert text.count(find) == 1, find
                (home / name).write_text(text.replace(find, put))
            for name, head in heads.items():
                (home / name).write_text(f"{head}\n{(home / name).read_text()}")

        return write
