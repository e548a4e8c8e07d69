"""Reads submitted files for nbgrader. A file that is not a notebook does not stop nbgrader's run."""

from __future__ import annotations

from typing import Any

from nbconvert.exporters import NotebookExporter
from nbformat import NotebookNode
from nbformat.v4 import new_notebook

from autograder.exceptions import StudentError
from autograder.grade import submitted_notebook
from autograder.plain_text import visible
from autograder.submission import intake


class SubmissionExporter(NotebookExporter):
    """Reads a file that is not a notebook as an empty notebook. The grader reports the problem."""

    def from_file(self, file_stream: Any, *args: Any, **kwargs: Any) -> Any:
        data = file_stream.buffer.read(intake.MAX_WRAPPED_BYTES + 1)
        convert: Any = self.from_notebook_node
        return convert(self._read(data, file_stream.name), *args, **kwargs)

    def _read(self, data: bytes, name: str) -> NotebookNode:
        if len(data) > intake.MAX_WRAPPED_BYTES:
            self.log.warning("%s is larger than %d MiB", visible(name, line=True), intake.MAX_WRAPPED_BYTES // 2**20)
            return new_notebook()
        try:
            return submitted_notebook.read(data, name)
        except StudentError as error:
            self.log.warning("%s", visible(str(error), line=True))
            return new_notebook()
