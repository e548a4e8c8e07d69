"""Configures nbgrader, with this repository as the course directory.

The isolated grader (`autograder.nbgrader`) computes the scores, and nbgrader books them. `NBGRADER_EXCHANGE` names the
exchange folder of a class. Without it the folder is `.build/exchange`.

`nbgrader autograde` grades one submission after the other. These commands grade a class on all cores and then book it:

    autograder grade submitted --assignment 02_nodes --out .build/nbgrader/02_nodes -j 8
    nbgrader autograde 02_nodes --SandboxedGrade.resume=True
"""

import os
import sys
from pathlib import Path

from nbgrader.converters import Autograde
from nbgrader.preprocessors import Execute

from autograder.course.forms import CODE_STUB

ROOT = Path(__file__).resolve().parent
# nbgrader starts `alembic` from PATH, which lacks this environment if it was not activated.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])

c = get_config()  # noqa: F821 (traitlets defines it for a configuration file)

c.CourseDirectory.root = str(ROOT)
c.CourseDirectory.course_id = "ros2-python"
c.CourseDirectory.source_directory = "chapters"
# Build products of colcon and Python are neither released nor collected.
c.CourseDirectory.ignore = [
    *(".ipynb_checkpoints", "__pycache__", "*.pyc", "*.egg-info", ".pytest_cache"),
    *("build", "install", "log", "feedback"),
]

exchange = os.environ.get("NBGRADER_EXCHANGE")
if exchange is None:
    exchange = str(ROOT / ".build" / "exchange")
    Path(exchange).mkdir(parents=True, exist_ok=True)
c.Exchange.root = exchange

c.ClearSolutions.code_stub = {"python": CODE_STUB}

# A mark scheme is in the locked cell of its question. Autograding restores it for formgrader.
c.ClearMarkScheme.enforce_metadata = False

c.Autograde.exporter_class = "autograder.nbgrader.SubmissionExporter"
c.Autograde.sanitize_preprocessors = [
    "autograder.nbgrader.RestoreCells",
    *Autograde.sanitize_preprocessors.default(),
]
c.Autograde.autograde_preprocessors = [
    "autograder.nbgrader.SandboxedGrade" if step is Execute else step
    for step in Autograde.autograde_preprocessors.default()
]

# Feedback and formgrader show students' text, which must not run scripts in the page.
c.HTMLExporter.filters = {"markdown2html": "autograder.nbgrader.sanitized_markdown"}
