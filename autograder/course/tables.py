"""The course's tables for instructors, in Markdown: what is taught where, and which checks judge it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from autograder.course.syllabus import Coverage, Place, Syllabus

HEAD = """# The course, chapter by chapter

One notebook an assignment; its folder is what students get. `autograder course tables` writes this page from the
notebooks' metadata, the hidden checks and `assets/syllabus.yaml`; a test holds it.
"""


def page(syllabus: Syllabus, covered: Coverage, titles: dict[str, str]) -> str:
    """Return the instructors' page.

    Args:
        syllabus: what has to be held.
        covered: where it is held.
        titles: each chapter's title, by name and in order.
    """
    points = {name: _points(covered, name) for name in titles}
    return "\n".join(
        [
            HEAD,
            "## Chapters\n",
            *_table(
                ("chapter", "title", "points"),
                [(f"[{n}]({n}/{n}.ipynb)", t, f"{points[n]:g}" if points[n] else "") for n, t in titles.items()],
            ),
            "## Objectives\n",
            *_table(("objective", "chapter", "exercise", "hidden checks"), _objectives(syllabus, covered)),
            "## The chapter's contents\n",
            *_table(("what", "where"), [(syllabus.items[key], _where(held)) for key, held in covered.items.items()]),
            "## What the chapter gets wrong\n",
            *_table(
                ("#", "the chapter", "here", "where"),
                [(str(n), *syllabus.errata[n], _where(held)) for n, held in covered.errata.items()],
            ),
        ]
    )


def _points(covered: Coverage, name: str) -> float:
    """Return a chapter's points; a group of checks may serve two objectives, and counts once."""
    checks = {check.id: check.points for row in covered.rows if row.chapter == name for check in row.checks}
    return sum(checks.values())


def _objectives(syllabus: Syllabus, covered: Coverage) -> Iterator[tuple[str, ...]]:
    for key, text in syllabus.objectives.items():
        for row in covered.rows:
            if row.objective == key:
                checks = ", ".join(f"`{check.id}`" for check in row.checks)
                yield text, row.chapter, row.exercise, checks


def _where(places: Sequence[Place]) -> str:
    return "; ".join(f"{place.chapter}: {place.heading}" for place in places)


def _table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]] | Iterator[tuple[str, ...]]) -> Iterator[str]:
    for row in (head, tuple("---" for _ in head), *rows):
        yield "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |"
    yield ""
