"""Executes a chapter's notebook in a fresh kernel, on a copy of the chapter's folder, with warnings as errors."""

from __future__ import annotations

import asyncio
import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.plain_text import clean
from autograder.ros.domains import Domain

# Code that runs before the first cell. An environment variable would also turn warnings into errors when Jupyter
# starts, and in the tools that a cell calls (colcon, CMake), for which the notebook is not responsible.
STRICT = """import warnings
warnings.simplefilter('error')
# ipykernel itself emits this warning when it shuts down. As an error, it would prevent the kernel from ending.
warnings.filterwarnings('default', message='For consistency across implementations')
"""


@dataclass(frozen=True)
class Execution:
    """The execution of a notebook: the notebook as far as it was executed, and the failed cell's error, or None."""

    chapter: str
    form: Form
    notebook: NotebookNode
    seconds: float
    failure: str | None

    @property
    def ok(self) -> bool:
        """Whether no cell failed."""
        return self.failure is None


def run_notebook(
    chapter: Chapter,
    form: Form = Form.SOURCE,
    *,
    timeout: float = 120.0,
    report: Path | None = None,
    packages: Path | None = None,
) -> Execution:
    """Execute a chapter's notebook in a separate ROS domain, without changing the chapter's folder.

    A cell may take `timeout` seconds. The executed notebook is written to `report`, and `ws/src` is copied to the
    folder `packages`.
    """
    notebook = in_form(chapter.read(), form)
    start = time.monotonic()
    with working_copy(chapter.folder) as folder, Domain() as domain:
        failure = execute(notebook, folder, timeout, domain.number)
        if packages is not None and (folder / "ws" / "src").is_dir():
            shutil.copytree(folder / "ws" / "src", packages, ignore=course_paths.NOT_COPIED, dirs_exist_ok=True)
    seconds = time.monotonic() - start
    if report is not None:
        report.parent.mkdir(parents=True, exist_ok=True)
        nbformat.write(notebook, report)
    return Execution(chapter.assignment, form, notebook, seconds, failure)


@contextmanager
def working_copy(folder: Path) -> Iterator[Path]:
    """Yield a temporary copy of a chapter's folder without build products."""
    with tempfile.TemporaryDirectory(prefix=f"{folder.name}-") as scratch:
        copy = Path(scratch) / folder.name
        shutil.copytree(folder, copy, ignore=course_paths.NOT_COPIED)
        yield copy


def execute(notebook: NotebookNode, folder: Path, timeout: float, domain: int) -> str | None:
    """Execute a notebook in place, in a new kernel that runs in `folder`. Return the error, or None.

    A cell may take `timeout` seconds. `domain` is the kernel's `ROS_DOMAIN_ID`.
    """
    client = NotebookClient(
        notebook, kernel_name="python3", timeout=timeout, resources={"metadata": {"path": str(folder)}}
    )
    # Use sockets in a private folder, because another process could take a port before the kernel binds it.
    manager = client.create_kernel_manager()
    manager.transport = "ipc"
    manager.ip, manager.connection_file = str(folder.parent / "k"), str(folder.parent / "k.json")
    notebook.cells.insert(0, new_code_cell(STRICT))
    started_cells: list[str] = []
    client.on_cell_start = lambda cell, cell_index: started_cells.append(cell.id)
    try:
        # asyncio.run closes its loop, but nbclient's own call leaves one open in each thread.
        asyncio.run(client.async_execute(env={**os.environ, "ROS_DOMAIN_ID": str(domain)}))
    except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
        return f"cell {started_cells[-1]!r}: {clean(str(error))}"
    finally:
        del notebook.cells[0]
    return None
