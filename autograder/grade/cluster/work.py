"""The worker's side: grades one parcel. Dask finds `grade` by its name; bytes go in and bytes come out."""

from __future__ import annotations

import tempfile
import traceback
from dataclasses import replace
from pathlib import Path

from autograder.grade import grade_submission
from autograder.grade.cluster.parcel import Answer, Parcel
from autograder.submission.intake import write_tree


def grade(data: bytes) -> bytes:
    """Grade the submission in a packed `Parcel`, and return a packed `Answer`. It raises nothing."""
    try:
        parcel = Parcel.unpack(data)
        with tempfile.TemporaryDirectory(prefix="parcel-") as folder:
            submission, out = Path(folder, "submission"), Path(folder, "out")
            write_tree(parcel.files, submission)
            grade_submission(replace(parcel.job, path=submission, out=out))
            return Answer({path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}).pack()
    except Exception:
        # An exception would travel as a pickle. The client keeps the text in the grader's log.
        return Answer({}, traceback.format_exc()).pack()
