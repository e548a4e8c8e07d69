"""nbgrader with this repository as the course directory: `nbgrader generate_assignment 02_nodes`, and so on.

Grades come from the isolated grader (`autograder.nbgrader`); nbgrader books them. `NBGRADER_EXCHANGE` names the
exchange folder of a class; without it there is one below `.build/`, for trying things out.

`nbgrader autograde` takes one submission after the other. To grade a large class on all cores, and then book it:

    autograder grade submitted --assignment 02_nodes --out .build/nbgrader/02_nodes -j 8
    nbgrader autograde 02_nodes --SandboxedGrade.resume=True
"""

import os
import sys
from pathlib import Path

from nbgrader.converters import Autograde
from nbgrader.preprocessors import Execute

from autograder.course import CODE_STUB

ROOT = Path(__file__).resolve().parent
# nbgrader starts `alembic` by its bare name: it must be found also where this environment was not activated.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])

c = get_config()  # noqa: F821 (traitlets puts it into a configuration file's names)

c.CourseDirectory.root = str(ROOT)
c.CourseDirectory.course_id = "ros2-python"
c.CourseDirectory.source_directory = "chapters"
# What colcon and Python leave in a workspace is neither released nor collected.
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

# A mark scheme stands in the locked cell of its question, from which autograding brings it back for formgrader.
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

# Feedback and formgrader show students' text: it must not become part of the page.
c.HTMLExporter.filters = {"markdown2html": "autograder.nbgrader.harmless_markdown"}
