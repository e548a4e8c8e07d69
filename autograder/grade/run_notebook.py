"""Runs a submitted notebook in the sandbox, client and kernel. Its cells write files into a fresh workspace.

No message of the kernel reaches this process: a program in the sandbox takes them, and answers with the outputs of each
cell in bounded JSON (`notebook_runner`). The cells' own text is the grader's, never the answer's.
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
MAX_OUTPUT = 4 * 1024 * 1024  # characters
MAX_WHY = 2000  # characters
MAX_ANSWER = 32 * 1024 * 1024  # bytes of all outputs; the rest is left out
MAX_LINES = 2000  # of an answer, which has one for each cell
MAX_VALUES = 200_000  # in all outputs: to check one takes up to 0.1 ms, and they may be forged
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
    out.write_bytes(encode(execute(notebook, folder, workspace)))


def execute(notebook: NotebookNode, folder: Path, workspace: Workspace) -> NotebookNode:
    """Run a restored notebook in a sandboxed kernel in `folder`, write the outputs into its cells, and return it.

    A cell that raises does not end the run. A kernel that dies ends it, and the files written before it count.

    Raises:
        StudentError: a file of the submission keeps the kernel from starting.
        GraderError: the sandbox does not answer before the student's code is started.
    """
    (workspace.scratch / "jupyter").mkdir(exist_ok=True)
    skipped = [index for index, cell in enumerate(notebook.cells) if _would_overwrite(cell, folder)]
    order = {"notebook": notebook, "skipped": skipped, "cell_seconds": CELL_SECONDS, "max_output": MAX_OUTPUT}
    with os.fdopen(os.memfd_create("order"), "w+b") as given, os.fdopen(os.memfd_create("answer"), "w+b") as taken:
        given.write(json.dumps(order).encode())
        given.seek(0)
        begun, theirs = os.pipe()
        with os.fdopen(begun, "rb") as begins:
            with os.fdopen(theirs, "wb"):
                descriptors = given.fileno(), taken.fileno(), theirs
                command = [sys.executable, str(RUNNER), *map(str, descriptors)]
                process = launch(command, _sandbox(folder, workspace), pass_fds=descriptors)
            with process:
                process.wait(KERNEL.wall_seconds + 10)
            if not begins.read(1):
                raise GraderError(f"the notebook's sandbox did not answer: {tail(process.output)}")
        taken.seek(0)
        answer = read_answer(taken.read(MAX_ANSWER))
    if answer.why and not answer.cells:
        raise _no_kernel(process, answer.why)
    for index, cell in enumerate(notebook.cells):
        if index in answer.cells and cell.cell_type == "code":
            cell.outputs, cell.execution_count = answer.cells[index].outputs, answer.cells[index].execution_count
    return notebook


@dataclass(frozen=True)
class Answer:
    """The report of a run from the sandbox."""

    why: str = ""  # why the run ended early; empty if it finished or gave no reason
    cells: Mapping[int, NotebookNode] = field(default_factory=dict)  # valid code cells without text, by their places


def read_answer(data: bytes) -> Answer:
    """Read the lines of `notebook_runner`, which the student's code may have forged. Invalid lines are left out."""
    why, cells, left = "", dict[int, NotebookNode](), MAX_VALUES
    for line in data.split(b"\n", MAX_LINES)[:MAX_LINES]:
        with suppress(StudentError), reading("An output of your notebook"):
            message = json.loads(line, parse_constant=lambda _: None)
            if message["event"] == "end":
                why = str(message["why"])[:MAX_WHY]
            elif message["event"] == "cell" and type(message["index"]) is int:
                left -= _count_values(message["outputs"])
                if left < 0:
                    continue
                cell = new_code_cell(
                    outputs=nbformat.from_dict(message["outputs"]), execution_count=message["execution_count"]
                )
                nbformat.validate(new_notebook(cells=[cell]))
                nbformat.writes(new_notebook(cells=[cell]))
                cells[message["index"]] = cell
    return Answer(why, cells)


def _count_values(value: object) -> int:
    pending, count = [value], 0
    while pending:
        each = pending.pop()
        count += 1
        pending += each.values() if isinstance(each, dict) else each if isinstance(each, list) else ()
    return count


def _no_kernel(process: Process, why: str) -> StudentError:
    sentence = (
        "The notebook's kernel could not start: a file beside the notebook, such as ipykernel_launcher.py, "
        "hides a module of the same name. Rename or remove it."
    )
    return StudentError(Diagnosis(Kind.NOTEBOOK_FAILED, sentence, tail(process.output) or tail(why)))


def _would_overwrite(cell: NotebookNode, folder: Path) -> bool:
    """Return whether an untouched exercise cell would overwrite a file that the student wrote by other means."""
    if cell.cell_type != "code" or STUB not in cell.source or not cell.source.startswith(WRITEFILE):
        return False
    target = cell.source.splitlines()[0].removeprefix(WRITEFILE).strip()
    try:
        path = (folder / target).resolve()
        return bool(path.is_relative_to(folder.resolve()) and path.is_file())
    except (OSError, ValueError, RuntimeError):  # not a file name: the cell itself will fail with a message
        return False


def _sandbox(folder: Path, workspace: Workspace) -> Sandbox:
    plain = workspace.sandbox(KERNEL)
    environment = {
        **plain.environment,
        GRADING_VARIABLE: "1",
        course_paths.COURSE_VARIABLE: str(course_paths.course().root),
        "USER": "student",  # the sandbox has no /etc/passwd, and ros2 pkg create asks for the user's name
        "IPYTHONDIR": str(workspace.scratch / "ipython"),
        "MPLCONFIGDIR": str(workspace.scratch / "matplotlib"),
        "JUPYTER_RUNTIME_DIR": str(workspace.scratch / "jupyter"),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    environment["PYTHONPATH"] = os.pathsep.join([*filter(None, [environment["PYTHONPATH"]]), str(course_paths.ROOT)])
    code = (Path(autograder.__file__).parent, Path(sim.__file__).parent)
    worlds = filter(Path.is_dir, {course_paths.SHARED_WORLDS, course_paths.WORLDS})
    readable = (RUNNER, *code, *worlds, course_paths.course().root / course_paths.COURSE_FILE)
    mounts = (*plain.mounts, *map(Mount, readable), Mount(folder, writable=True))
    return replace(plain, workdir=folder, mounts=mounts, environment=environment, network=False)
