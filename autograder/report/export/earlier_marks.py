"""Stores the earlier marks of a class while it is regraded, until the changes have been listed.

The file is beside the results. It is written before the first submission is graded and deleted after the changes have
been listed, so that an interrupted grading does not lose any of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.report.export.changes import Change, changes
from autograder.report.export.stored import load
from autograder.result.class_folder import EARLIER_MARKS, RESULT
from autograder.result.model import Result, Status, write_json


class EarlierMarks:
    """The earlier marks of the students of a grading.

    Args:
        out: the folder of the results.
        students: the names of the folders in `out` whose results may be replaced.

    Raises:
        UsageError: the file of an interrupted grading cannot be read.
    """

    def __init__(self, out: Path, students: Iterable[str]) -> None:
        self._file = out / EARLIER_MARKS
        # After an interrupted grading, compare with the marks before it, not with the marks that it gave.
        earlier = {_key(result): result for result in load(self._file)} if self._file.is_file() else {}
        self._marks = _stored_results(out, students) | earlier
        if self._marks.keys() > earlier.keys():
            self._write()

    def changed(self, results: Sequence[Result]) -> tuple[Change, ...]:
        """Return the changes in marks, or in the points of a check, compared with the earlier results."""
        regraded = [result for result in results if _key(result) in self._marks]
        return changes([self._marks[_key(result)] for result in regraded], regraded)

    def forget(self, results: Iterable[Result]) -> None:
        """Delete the earlier marks of graded submissions. If the grader failed, they are kept for the next grading."""
        for result in results:
            if result.status is Status.GRADED:
                self._marks.pop(_key(result), None)
        self._write()

    def _write(self) -> None:
        if self._marks:
            write_json(self._file, [result.to_json() for result in self._marks.values()])
        else:
            self._file.unlink(missing_ok=True)


def _key(result: Result) -> tuple[str, str]:
    return result.assignment, result.student


def _stored_results(out: Path, students: Iterable[str]) -> dict[tuple[str, str], Result]:
    """Return the students' stored results that have a mark. Unreadable results are ignored: they are regraded."""
    results: list[Result] = []
    for path in (out / student / RESULT for student in students):
        with suppress(UsageError):
            results += load(path) if path.is_file() else ()
    return {_key(result): result for result in results if result.status is Status.GRADED}
