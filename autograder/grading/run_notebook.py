"""Runs a submitted notebook in a sandboxed kernel. Its cells write files into a fresh workspace."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import nbformat
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbclient.exceptions import CellTimeoutError, DeadKernelError
from nbformat import NotebookNode

import autograder
import sim
from autograder import layout
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.grading import submitted_notebook
from autograder.grading.submitted_notebook import STUB
from autograder.lockstep.failures import tail
from autograder.sandbox import Mount, Process, Sandbox
from autograder.sandbox.launcher import launch
from autograder.sandbox.limits import KERNEL
from autograder.workspace import Workspace
from sim.grading import GRADING_VARIABLE

CELL_SECONDS = 60  # wall time of a cell; one that takes longer ends the run
MAX_OUTPUT = 4 * 1024 * 1024  # characters
WRITEFILE = "%%writefile "


def run(submitted: bytes, original: Path, folder: Path, workspace: Workspace, out: Path) -> None:
    """Restore the cells of a submitted notebook that students may not change, run it, and save it with its outputs.

    Args:
        submitted: content of the submitted notebook.
        original: path of the source notebook.
        folder: folder of the assignment, with `ws/`. The notebook may write there.
        workspace: workspace whose ROS 2 and scratch folder are used.
        out: path of the executed notebook.
    """
    source = nbformat.read(original, as_version=4)
    notebook = submitted_notebook.restore(submitted_notebook.read(submitted, original.name), source)
    executed = nbformat.writes(execute(notebook, folder, workspace))
    # Half a surrogate pair, in a cell or its output, is not UTF-8.
    out.write_bytes(executed.encode("utf-8", errors="replace"))


def execute(notebook: NotebookNode, folder: Path, workspace: Workspace) -> NotebookNode:
    """Run a restored notebook in a sandboxed kernel in `folder`, write the outputs into its cells, and return it.

    A cell that raises does not end the run. A kernel that dies ends it, and the files written before it count.

    Raises:
        StudentError: a file of the submission keeps the kernel from starting.
        GraderError: the kernel does not answer for another reason.
    """
    connections = workspace.scratch / "jupyter"
    connections.mkdir(exist_ok=True)
    kernel = _SandboxedKernel(_sandbox(folder, workspace), connections)
    skipped = {index for index, cell in enumerate(notebook.cells) if _would_overwrite(cell, folder)}
    client = _Client(notebook, km=kernel, timeout=CELL_SECONDS, allow_errors=True, skipped=skipped)
    with kernel.process as process:
        try:
            client.execute()
        except (DeadKernelError, CellTimeoutError):
            return notebook
        except RuntimeError as error:  # nbclient raises it if the kernel does not start
            raise _no_kernel(process, error) from error
    return notebook


class _SandboxedKernel(AsyncKernelManager):
    """A kernel of the grader's own Python in a sandbox; Jupyter connects to it by Unix sockets in a folder."""

    def __init__(self, sandbox: Sandbox, connections: Path) -> None:
        super().__init__(transport="ipc", connection_file=str(connections / "k.json"), ip=str(connections / "k"))
        self.write_connection_file()
        self.process = launch([sys.executable, "-m", "ipykernel_launcher", "-f", self.connection_file], sandbox)

    @property
    def has_kernel(self) -> bool:
        return True

    async def _async_is_alive(self) -> bool:  # which clients ask
        return self.process.ending is None

    is_alive = _async_is_alive

    async def shutdown_kernel(self, now: bool = False, restart: bool = False) -> None:  # type: ignore[override]
        self.process.kill()


class _Client(NotebookClient):
    """Runs a notebook without the cells in `skipped`, and kills a kernel that sends more than `MAX_OUTPUT`."""

    def __init__(self, notebook: NotebookNode, *, skipped: set[int], **options: Any) -> None:
        super().__init__(notebook, **options)
        self._skipped = skipped
        self._received = 0

    async def async_execute_cell(self, cell: NotebookNode, cell_index: int, *args: Any, **kwargs: Any) -> NotebookNode:
        if cell_index in self._skipped:
            return cell
        return await super().async_execute_cell(cell, cell_index, *args, **kwargs)

    def process_message(self, msg: dict[str, Any], cell: NotebookNode, cell_index: int) -> NotebookNode | None:
        self._received += len(repr(msg.get("content", "")))
        if self._received > MAX_OUTPUT:
            kernel: Any = self.km
            kernel.process.kill()
            return None
        return super().process_message(msg, cell, cell_index)


def _no_kernel(process: Process, error: RuntimeError) -> Exception:
    """Return a StudentError if the kernel died, which a submitted file can cause, and a GraderError otherwise."""
    if process.ending is None:
        return GraderError(f"the sandboxed kernel did not answer: {error}")
    sentence = (
        "The notebook's kernel could not start: a file beside the notebook, such as ipykernel_launcher.py, "
        "hides a module of the same name. Rename or remove it."
    )
    return StudentError(Diagnosis(Kind.NOTEBOOK_FAILED, sentence, tail(process.output)))


def _would_overwrite(cell: NotebookNode, folder: Path) -> bool:
    """Return whether an untouched exercise cell would overwrite a file that the student wrote by other means."""
    if cell.cell_type != "code" or STUB not in cell.source or not cell.source.startswith(WRITEFILE):
        return False
    target = cell.source.splitlines()[0].removeprefix(WRITEFILE).strip()
    path = (folder / target).resolve()
    return bool(path.is_relative_to(folder.resolve()) and path.is_file())


def _sandbox(folder: Path, workspace: Workspace) -> Sandbox:
    plain = workspace.sandbox(KERNEL)
    environment = {
        **plain.environment,
        GRADING_VARIABLE: "1",
        layout.COURSE_VARIABLE: str(layout.COURSE.root),
        "USER": "student",  # the sandbox has no /etc/passwd, and ros2 pkg create asks for the user's name
        "IPYTHONDIR": str(workspace.scratch / "ipython"),
        "MPLCONFIGDIR": str(workspace.scratch / "matplotlib"),
        "JUPYTER_RUNTIME_DIR": str(workspace.scratch / "jupyter"),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    environment["PYTHONPATH"] = os.pathsep.join([*filter(None, [environment["PYTHONPATH"]]), str(layout.ROOT)])
    code = (Path(autograder.__file__).parent, Path(sim.__file__).parent)
    worlds = filter(Path.is_dir, {layout.SHARED_WORLDS, layout.WORLDS})
    readable = (*code, *worlds, layout.COURSE.root / layout.COURSE_FILE)
    mounts = (*plain.mounts, *map(Mount, readable), Mount(folder, writable=True))
    return replace(plain, workdir=folder, mounts=mounts, environment=environment, network=False)
