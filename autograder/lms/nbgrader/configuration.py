"""Configures nbgrader for a course. Its `nbgrader_config.py` calls `configure`."""

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
    """Configure nbgrader for the course in the folder `root`.

    The environment variable `NBGRADER_EXCHANGE` sets the exchange folder, which is `.build/exchange` by default.
    """
    # nbgrader runs `alembic` from PATH, which does not contain this environment unless it is activated.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    c.CourseDirectory.root = str(root)
    c.CourseDirectory.course_id = course_paths.course().name
    c.CourseDirectory.source_directory = course_paths.course().chapters
    # Do not release or collect the build products of colcon and Python.
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

    # Feedback and formgrader show students' text, which must not run scripts in the browser.
    c.HTMLExporter.filters = {"markdown2html": "autograder.lms.nbgrader.sanitized_markdown"}
