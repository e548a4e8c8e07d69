"""Runs a submitted notebook in the sandbox, both the client and the kernel. Its cells write files to a new workspace.

This process receives no messages of the kernel. A program in the sandbox receives them, and answers with the outputs of
each cell in bounded JSON (`notebook_runner`). The cells' texts are never taken from the answer.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import nbformat
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_notebook

import autograder
import sim
from autograder import course_paths
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.grade import submitted_notebook
from autograder.grade.executed_notebook import encode
from autograder.grade.submitted_notebook import STUB
from autograder.run.lockstep.failures import tail
from autograder.run.sandbox import Mount, Process, Sandbox
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import KERNEL
from autograder.run.workspace import Workspace
from autograder.submission.reading import reading
from sim.grading import GRADING_VARIABLE

RUNNER = Path(__file__).with_name("notebook_runner.py")
CELL_SECONDS = 60  # wall time of a cell; one that takes longer ends the run
MAX_OUTPUT = 4 * 1024 * 1024  # characters of all messages of the kernel
MAX_REASON = 2000  # characters of the reason why a run ended early
MAX_ANSWER = 32 * 1024 * 1024  # bytes of all outputs; further bytes are ignored
MAX_LINES = 2000  # lines of an answer, which has one for each cell
MAX_VALUES = 200_000  # values in all outputs, which may be forged: validating a value takes up to 0.1 ms
WRITEFILE = "%%writefile "


def run(submitted: bytes, original: Path, folder: Path, workspace: Workspace, out: Path) -> None:
    """Restore the cells of a submitted notebook that students may not change, run it, and save it with its outputs.

    Args:
        submitted: the content of the submitted notebook.
        original: the path of the source notebook.
        folder: the folder of the assignment, with `ws/`. The notebook may write to it.
        workspace: the workspace whose ROS 2 and scratch folder are used.
        out: the path of the executed notebook.
    """
    source = nbformat.read(original, as_version=4)
    notebook = submitted_notebook.restore(submitted_notebook.read(submitted, original.name), source)
    out.write_bytes(encode(execute(notebook, folder, workspace)))


def execute(notebook: NotebookNode, folder: Path, workspace: Workspace) -> NotebookNode:
    """Run a restored notebook in a sandboxed kernel in `folder`, write the outputs to its cells, and return it.

    A cell that raises an exception does not end the run. The end of the kernel does, and the files written until then
    count.

    Raises:
        StudentError: a file of the submission prevents the kernel from starting.
        GraderError: the sandbox does not answer before the student's code is started.
    """
    (workspace.scratch / "jupyter").mkdir(exist_ok=True)
    skipped = [index for index, cell in enumerate(notebook.cells) if _would_overwrite(cell, folder)]
    request = {"notebook": notebook, "skipped": skipped, "cell_seconds": CELL_SECONDS, "max_output": MAX_OUTPUT}
    with (
        os.fdopen(os.memfd_create("request"), "w+b") as request_file,
        os.fdopen(os.memfd_create("answer"), "w+b") as answer_file,
    ):
        request_file.write(json.dumps(request).encode())
        request_file.seek(0)
        read_end, write_end = os.pipe()
        with os.fdopen(read_end, "rb") as started:
            with os.fdopen(write_end, "wb"):
                descriptors = request_file.fileno(), answer_file.fileno(), write_end
                command = [sys.executable, str(RUNNER), *map(str, descriptors)]
                process = launch(command, _sandbox(folder, workspace), pass_fds=descriptors)
            with process:
                process.wait(KERNEL.wall_seconds + 10)
            if not started.read(1):
                raise GraderError(f"the notebook's sandbox did not answer: {tail(process.output)}")
        answer_file.seek(0)
        answer = read_answer(answer_file.read(MAX_ANSWER))
    if answer.reason and not answer.cells:
        raise _kernel_error(process, answer.reason)
    for index, cell in enumerate(notebook.cells):
        if index in answer.cells and cell.cell_type == "code":
            cell.outputs, cell.execution_count = answer.cells[index].outputs, answer.cells[index].execution_count
    return notebook


@dataclass(frozen=True)
class Answer:
    """The report on a run, as received from the sandbox."""

    reason: str = ""  # why the run ended early; empty if it finished or gave no reason
    cells: Mapping[int, NotebookNode] = field(default_factory=dict)  # valid code cells without text, by their indices


def read_answer(data: bytes) -> Answer:
    """Read the lines of `notebook_runner`, which the student's code may have forged. Invalid lines are left out."""
    reason, cells, remaining = "", dict[int, NotebookNode](), MAX_VALUES
    for line in data.split(b"\n", MAX_LINES)[:MAX_LINES]:
        with suppress(StudentError), reading("An output of your notebook"):
            message = json.loads(line, parse_constant=lambda _: None)
            if message["event"] == "end":
                reason = str(message["reason"])[:MAX_REASON]
            elif message["event"] == "cell" and type(message["index"]) is int:
                remaining -= _count_values(message["outputs"])
                if remaining < 0:
                    continue
                cell = new_code_cell(
                    outputs=nbformat.from_dict(message["outputs"]), execution_count=message["execution_count"]
                )
                nbformat.validate(new_notebook(cells=[cell]))
                nbformat.writes(new_notebook(cells=[cell]))
                cells[message["index"]] = cell
    return Answer(reason, cells)


def _count_values(value: object) -> int:
    pending, count = [value], 0
    while pending:
        item = pending.pop()
        count += 1
        pending += item.values() if isinstance(item, dict) else item if isinstance(item, list) else ()
    return count


def _kernel_error(process: Process, reason: str) -> StudentError:
    sentence = (
        "The notebook's kernel could not start: a file beside the notebook, such as ipykernel_launcher.py, "
        "hides a module of the same name. Rename or remove it."
    )
    return StudentError(Diagnosis(Kind.NOTEBOOK_FAILED, sentence, tail(process.output) or tail(reason)))


def _would_overwrite(cell: NotebookNode, folder: Path) -> bool:
    """Return whether an unchanged exercise cell would overwrite a file that the student wrote in another way."""
    if cell.cell_type != "code" or STUB not in cell.source or not cell.source.startswith(WRITEFILE):
        return False
    target = cell.source.splitlines()[0].removeprefix(WRITEFILE).strip()
    try:
        path = (folder / target).resolve()
        return bool(path.is_relative_to(folder.resolve()) and path.is_file())
    except (OSError, ValueError, RuntimeError):  # not a file name: the cell will fail with a message
        return False


def _sandbox(folder: Path, workspace: Workspace) -> Sandbox:
    spec = workspace.sandbox(KERNEL)
    environment = {
        **spec.environment,
        GRADING_VARIABLE: "1",
        course_paths.COURSE_VARIABLE: str(course_paths.course().root),
        "USER": "student",  # the sandbox has no /etc/passwd, and ros2 pkg create needs the user's name
        "IPYTHONDIR": str(workspace.scratch / "ipython"),
        "MPLCONFIGDIR": str(workspace.scratch / "matplotlib"),
        "JUPYTER_RUNTIME_DIR": str(workspace.scratch / "jupyter"),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    environment["PYTHONPATH"] = os.pathsep.join([*filter(None, [environment["PYTHONPATH"]]), str(course_paths.ROOT)])
    code = (Path(autograder.__file__).parent, Path(sim.__file__).parent)
    worlds = filter(Path.is_dir, {course_paths.SHARED_WORLDS, course_paths.WORLDS})
    readable = (RUNNER, *code, *worlds, course_paths.course().root / course_paths.COURSE_FILE)
    mounts = (*spec.mounts, *map(Mount, readable), Mount(folder, writable=True))
    return replace(spec, workdir=folder, mounts=mounts, environment=environment, network=False)
