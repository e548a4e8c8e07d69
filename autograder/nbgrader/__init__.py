"""The nbgrader plug-in: nbgrader's own commands, with grades that come from the isolated grader.

`nbgrader autograde` runs two chains of preprocessors on each submitted notebook. `nbgrader_config.py` puts these parts
into them, by name:

    SubmissionExporter  reads a notebook whatever is in the file
    RestoreCells        gives back to it what the released one held (first in the sanitizing chain)
    SandboxedGrade      grades the submitted folder in a sandbox and writes the scores into the locked grade cells
                        (where nbgrader would have executed the notebook); nbgrader's SaveAutoGrades books them
    harmless_markdown   shows a student's text in feedback and formgrader without what it could run there
"""

from autograder.nbgrader.exporter import SubmissionExporter
from autograder.nbgrader.grade import SandboxedGrade
from autograder.nbgrader.markdown import harmless_markdown
from autograder.nbgrader.restore import RestoreCells

__all__ = ["RestoreCells", "SandboxedGrade", "SubmissionExporter", "harmless_markdown"]
