"""Counts how long a beginner takes for a chapter. Its first cell says this time.

Walks through chapters 0 to 4, done as a beginner would do them, were put at 27, 90, 130, 230 and 100 minutes. With the
first two rates as they are, MINUTES_A_LINE is the least-squares fit to these five times: half an hour off at most.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from nbformat import NotebookNode

from autograder.author.course.cells import is_solution
from autograder.author.course.findings import Finding
from autograder.author.course.solution_markers import BEGIN, END

WORDS_A_MINUTE = 120.0  # of a technical text, for somebody who reads English as a second language
FLUENT_WORDS_A_MINUTE = 200.0  # for the limit of `longest_reading`
MINUTES_A_CELL = 1.0  # read a code cell, run it, look at what it shows
MINUTES_A_LINE = 1.2  # think, write and correct
LONGEST_IN_MINUTES = 100.0
_ANSWER = re.compile(f"{BEGIN}\n(.*?){END}", re.DOTALL)


@dataclass(frozen=True)
class Effort:
    """What there is to do in a chapter: words to read, code cells to run, lines to write without the empty ones.

    `longest_reading` is the longest time in minutes for which a fluent reader only reads and runs, and writes nothing.
    """

    words: int
    cells: int
    lines: int
    longest_reading: float = 0.0

    @property
    def reading(self) -> float:
        """Minutes to read and run it."""
        return self.words / WORDS_A_MINUTE + self.cells * MINUTES_A_CELL

    @property
    def writing(self) -> float:
        """Minutes for the exercises."""
        return self.lines * MINUTES_A_LINE


def effort(source: NotebookNode) -> Effort:
    """Count what there is to do in a source notebook."""
    texts = [cell.source for cell in source.cells if cell.cell_type == "markdown"]
    code = [cell.source for cell in source.cells if cell.cell_type == "code"]
    lines = [line for cell in code for answer in _ANSWER.findall(cell) for line in answer.split("\n") if line.strip()]
    stretches = [0.0]
    for cell in source.cells:
        if is_solution(cell):
            stretches.append(0.0)
        else:
            prose = cell.cell_type == "markdown"
            stretches[-1] += len(cell.source.split()) / FLUENT_WORDS_A_MINUTE if prose else MINUTES_A_CELL
    return Effort(sum(len(text.split()) for text in texts), len(code), len(lines), max(stretches))


def time_sentence(needed: Effort) -> str:
    """Return what the first cell of a chapter says about the time that it takes."""
    return f"{duration_text(needed.reading)} to read and run, {duration_text(needed.writing)} for the exercises"


def duration_text(minutes: float) -> str:
    """Return a time in words: up to 100 minutes in steps of five, a longer one in half hours."""
    if minutes <= LONGEST_IN_MINUTES:
        return f"{max(5, 5 * round(minutes / 5))} minutes"
    halves = round(minutes / 30)
    return f"{halves // 2}{'½' if halves % 2 else ''} hours"


def outdated_time_sentence(name: str, source: NotebookNode) -> list[Finding]:
    """Return a finding if the first cell of a source notebook says another time than the counted one."""
    words = time_sentence(effort(source))
    if words in " ".join(source.cells[0].source.split()):
        return []
    return [Finding(name, source.cells[0].id, f"its time is out of date; write: {words}")]
