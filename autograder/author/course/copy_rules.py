"""The rule for the targets of reference files: in the workspace, each is where the reference has it.

A student's file in another place differs from the reference, but synchronizing and grading the reference do not show
it: the cell contains the right text, and the reference is graded without the notebook.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath

from nbformat import NotebookNode

from autograder import course_paths
from autograder.author.course.cells import copied_file, given_files, is_solution
from autograder.author.course.findings import Finding

WORKSPACE = PurePosixPath("ws", "src")  # the folder of the chapter that contains the student's packages


def target_findings(name: str, notebook: NotebookNode) -> Iterator[Finding]:
    """Yield a finding for each target that does not match its source. `name` is what findings call the notebook.

    Cells that students write need a target in the workspace. Other files may be elsewhere, for example to be printed.
    """
    for cell in notebook.cells:
        if (copy := copied_file(cell)) and (is_solution(cell) or copy.target.is_relative_to(WORKSPACE)):
            yield from _findings(name, cell.id, copy.target, copy.source)
    for target, source in given_files(notebook).items():
        if target.is_relative_to(WORKSPACE):
            yield from _findings(name, None, target, source)


def _findings(name: str, cell: str | None, target: PurePosixPath, source: PurePosixPath) -> Iterator[Finding]:
    is_known = (course_paths.SOLUTIONS / source).is_file()  # otherwise the source is wrong, which another rule reports
    if is_known and target != WORKSPACE / source:
        message = f"the target `{target}` does not match its source {source}: did you mean `{WORKSPACE / source}`?"
        yield Finding(name, cell, message)
