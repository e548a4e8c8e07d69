"""The nbgrader plug-in: nbgrader's commands record the scores of the isolated grader.

`nbgrader autograde` runs two chains of preprocessors on each submitted notebook. `nbgrader_config.py` adds these parts
by name:

    SubmissionExporter   reads a submitted file, even if it is not a notebook
    RestoreCells         restores the released cells (the first preprocessor of the sanitizing chain)
    SandboxedGrade       replaces nbgrader's Execute: grades the submitted folder in a sandbox, and writes the scores
                         into the locked grade cells; nbgrader's SaveAutoGrades records them
    sanitized_markdown   renders a student's text without scripts, for feedback and formgrader
"""

from autograder.lms.nbgrader.exporter import SubmissionExporter
from autograder.lms.nbgrader.restore import RestoreCells
from autograder.lms.nbgrader.sandboxed_grade import SandboxedGrade
from autograder.lms.nbgrader.sanitizing import sanitized_markdown

__all__ = ["RestoreCells", "SandboxedGrade", "SubmissionExporter", "sanitized_markdown"]
