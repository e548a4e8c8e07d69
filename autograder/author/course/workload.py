"""Estimates how long a beginner takes for a chapter. The chapter's first cell states this time.

A person who worked through chapters 0 to 4 estimated that a beginner needs 27, 90, 130, 230 and 100 minutes. Given
WORDS_A_MINUTE and MINUTES_A_CELL, MINUTES_A_LINE is the least-squares fit to these five times. The largest error is
half an hour.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from nbformat import NotebookNode

from autograder.author.course.cells import is_solution
from autograder.author.course.findings import Finding
from autograder.author.course.solution_markers import BEGIN, END

WORDS_A_MINUTE = 120.0  # how fast somebody whose second language is English reads a technical text
FLUENT_WORDS_A_MINUTE = 200.0  # how fast a fluent reader reads a text; `longest_reading` uses this speed
MINUTES_A_CELL = 1.0  # to read a code cell, run it, and look at its output
MINUTES_A_LINE = 1.2  # to think about a line, write it and correct it
MAX_SHOWN_IN_MINUTES = 100.0
_ANSWER = re.compile(f"{BEGIN}\n(.*?){END}", re.DOTALL)


@dataclass(frozen=True)
class Effort:
    """The work in a chapter: words to read, code cells to run, and non-empty lines to write.

    `longest_reading` is the longest time in minutes for which a fluent reader only reads and runs cells.
    """

    words: int
    cells: int
    lines: int
    longest_reading: float = 0.0

    @property
    def reading(self) -> float:
        """Minutes to read the chapter and run its cells."""
        return self.words / WORDS_A_MINUTE + self.cells * MINUTES_A_CELL

    @property
    def writing(self) -> float:
        """Minutes for the exercises."""
        return self.lines * MINUTES_A_LINE


def effort(source: NotebookNode) -> Effort:
    """Count the work in a source notebook."""
    texts = [cell.source for cell in source.cells if cell.cell_type == "markdown"]
    code = [cell.source for cell in source.cells if cell.cell_type == "code"]
    lines = [line for cell in code for answer in _ANSWER.findall(cell) for line in answer.split("\n") if line.strip()]
    readings = [0.0]  # minutes before, between and after the cells in which students write
    for cell in source.cells:
        if is_solution(cell):
            readings.append(0.0)
        else:
            is_prose = cell.cell_type == "markdown"
            readings[-1] += len(cell.source.split()) / FLUENT_WORDS_A_MINUTE if is_prose else MINUTES_A_CELL
    return Effort(sum(len(text.split()) for text in texts), len(code), len(lines), max(readings))


def time_sentence(work: Effort) -> str:
    """Return the sentence for the first cell of a chapter that tells students how long the chapter takes."""
    return f"{duration_text(work.reading)} to read and run, {duration_text(work.writing)} for the exercises"


def duration_text(minutes: float) -> str:
    """Return a time in words: in steps of five minutes up to 100 minutes, then in half hours."""
    if minutes <= MAX_SHOWN_IN_MINUTES:
        return f"{max(5, 5 * round(minutes / 5))} minutes"
    halves = round(minutes / 30)
    return f"{halves // 2}{'½' if halves % 2 else ''} hours"


def outdated_time_sentence(name: str, source: NotebookNode) -> list[Finding]:
    """Return a finding if the time in the first cell of a source notebook differs from the estimate."""
    sentence = time_sentence(effort(source))
    if sentence in " ".join(source.cells[0].source.split()):
        return []
    return [Finding(name, source.cells[0].id, f"its time is out of date; write: {sentence}")]
