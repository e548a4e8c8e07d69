"""The worker's side: grades one task. Dask finds `grade` by name, and sends and receives only bytes."""

from __future__ import annotations

import tempfile
import traceback
from dataclasses import replace
from pathlib import Path

from autograder.grade import grade_submission
from autograder.grade.cluster.task import Reply, Task
from autograder.submission.intake import write_tree


def grade(data: bytes) -> bytes:
    """Grade the submission in a packed `Task`, and return a packed `Reply`. Never raises an exception."""
    try:
        task = Task.unpack(data)
        with tempfile.TemporaryDirectory(prefix="task-") as folder:
            submission, out = Path(folder, "submission"), Path(folder, "out")
            write_tree(task.files, submission)
            grade_submission(replace(task.job, path=submission, out=out))
            return Reply({path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}).pack()
    except Exception:
        # Dask would pickle an exception. The client writes the text to the grader's log.
        return Reply({}, traceback.format_exc()).pack()
