"""Configures nbgrader for a course; its `nbgrader_config.py` calls this."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from nbgrader.converters import Autograde
from nbgrader.preprocessors import Execute
from traitlets.config import Config

from autograder import course_paths
from autograder.author.course.forms import SETTINGS


def configure(c: Any, root: Path) -> None:
    """Set up nbgrader for the course in the folder `root`.

    `NBGRADER_EXCHANGE` names the exchange folder of a class. Without it the folder is `.build/exchange`.
    """
    # nbgrader runs `alembic` from PATH, which does not contain this environment unless it is activated.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    c.CourseDirectory.root = str(root)
    c.CourseDirectory.course_id = course_paths.course().name
    c.CourseDirectory.source_directory = course_paths.course().chapters
    # Build products of colcon and Python are neither released nor collected.
    c.CourseDirectory.ignore = [
        *(".ipynb_checkpoints", "__pycache__", "*.pyc", "*.egg-info", ".pytest_cache"),
        *("build", "install", "log", "feedback"),
    ]

    exchange = os.environ.get("NBGRADER_EXCHANGE")
    if exchange is None:
        exchange = str(root / ".build" / "exchange")
        Path(exchange).mkdir(parents=True, exist_ok=True)
    c.Exchange.root = exchange

    c.merge(Config(SETTINGS))

    c.Autograde.exporter_class = "autograder.lms.nbgrader.SubmissionExporter"
    c.Autograde.sanitize_preprocessors = [
        "autograder.lms.nbgrader.RestoreCells",
        *Autograde.sanitize_preprocessors.default(),
    ]
    c.Autograde.autograde_preprocessors = [
        "autograder.lms.nbgrader.SandboxedGrade" if step is Execute else step
        for step in Autograde.autograde_preprocessors.default()
    ]

    # Feedback and formgrader show students' text, which must not run scripts on the page.
    c.HTMLExporter.filters = {"markdown2html": "autograder.lms.nbgrader.sanitized_markdown"}
