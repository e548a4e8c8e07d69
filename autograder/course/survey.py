"""The course as it stands: every chapter read, laid against the syllabus."""

from __future__ import annotations

from dataclasses import dataclass

from autograder.checks import suites
from autograder.course.syllabus import Coverage, Syllabus, coverage
from autograder.course.sync import chapters
from autograder.course.tables import page
from autograder.layout import CHAPTERS

PAGE = CHAPTERS / "README.md"


@dataclass(frozen=True)
class Survey:
    """What the course has to hold, where it holds it, and each chapter's title."""

    syllabus: Syllabus
    coverage: Coverage
    titles: dict[str, str]

    @classmethod
    def of_the_course(cls) -> Survey:
        """Read the syllabus, the chapters and their hidden suites."""
        syllabus, have_suites = Syllabus.read(), suites.graded()
        notebooks = {chapter.assignment: chapter.read() for chapter in chapters()}
        held = [
            (name, book, suites.hidden(name).checks if name in have_suites else ()) for name, book in notebooks.items()
        ]
        titles = {name: book.cells[0].source.splitlines()[0].removeprefix("# ") for name, book in notebooks.items()}
        return cls(syllabus, coverage(syllabus, held), titles)

    def page(self) -> str:
        """Return the instructors' page."""
        return page(self.syllabus, self.coverage, self.titles)
