"""The sandboxed kernel runs notebooks that do not end, print without end, ask for input or end their kernel."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from tests.e2e.sandbox_support import in_worker_sandbox


def execute(scratch: Path, cells: list[str]) -> dict[str, Any]:
    """Run cells in the sandboxed kernel; return the output of each, and the kernel's remaining processes."""
    from nbformat.v4 import new_code_cell, new_notebook

    from autograder.grade import run_notebook
    from autograder.harness import Workspace
    from autograder.ros import activate

    folder, home = scratch / "assignment", scratch / "home"
    folder.mkdir()
    home.mkdir()
    notebook = new_notebook(cells=[new_code_cell(cell) for cell in cells])
    run_notebook.CELL_SECONDS = 8
    run_notebook.execute(notebook, folder, Workspace(scratch / "ws", activate(), home))
    deadline = time.monotonic() + 30
    while (remaining := _kernels()) and time.monotonic() < deadline:
        threading.Event().wait(0.05)
    printed = [
        "".join(output.get("text", output.get("evalue", "")) for output in cell.outputs) for cell in notebook.cells
    ]
    return {"printed": printed, "files": sorted(path.name for path in folder.iterdir()), "remaining": remaining}


def _kernels() -> list[str]:
    """Return the process ids of running kernels: each sandbox is a child of this process."""
    children = Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    return [pid for pid in children if Path(f"/proc/{pid}/comm").read_text().strip() == "bwrap"]


@pytest.mark.parametrize(
    ("cell", "printed"),
    [
        pytest.param("while True: pass", "", id="never ends"),
        pytest.param(
            "import signal\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\nwhile True: pass", "", id="ignores SIGINT"
        ),
        pytest.param("import os\nos._exit(0)", "", id="exits"),
        pytest.param("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", "", id="kills itself"),
        pytest.param("get_ipython().kernel.do_shutdown(True)", None, id="restarts its kernel"),
        pytest.param("while True: print('x' * 10_000)", None, id="never stops printing"),
    ],
)
def test_a_cell_over_a_limit_ends_the_run_and_keeps_earlier_files(cell: str, printed: str | None) -> None:
    answer = in_worker_sandbox(execute, ["%%writefile before.txt\nkept", cell])
    assert "before.txt" in answer["files"]
    assert printed is None or answer["printed"][1] == printed
    assert answer["remaining"] == []


EMPTY_THE_ANSWER = """
import os
for pid in filter(str.isdigit, os.listdir("/proc")):
    try:
        for number in os.listdir(f"/proc/{pid}/fd"):
            if "memfd:answer" in os.readlink(path := f"/proc/{pid}/fd/{number}"):
                open(path, "wb").close()
                print("emptied")
    except OSError:
        pass
open("after.txt", "w").close()
os.kill(os.getppid(), 9)
"""


def test_a_cell_that_empties_the_answer_loses_the_outputs_but_not_its_files() -> None:
    answer = in_worker_sandbox(execute, ["%%writefile before.txt\nkept", EMPTY_THE_ANSWER])
    assert answer["files"] == ["after.txt", "before.txt"]


KERNEL = "import os\nkernel = get_ipython().kernel\nsession, io = kernel.session, kernel.iopub_socket\n"


@pytest.mark.parametrize(
    "message",
    [
        pytest.param("session.send(io, 'status', content={}, parent=kernel.get_parent())", id="status without a state"),
        pytest.param("session.key = b'mine'", id="signed with another key"),
        pytest.param("io.send_multipart([b'', b'<IDS|MSG>'])", id="cut short"),
        pytest.param("io.send_multipart([b'x' * 1000] * 100_000)", id="a hundred thousand parts"),
        pytest.param("session.send(io, 'stream', content=[], parent=kernel.get_parent())", id="content is a list"),
        pytest.param("io.send(memoryview(__import__('mmap').mmap(-1, 3 << 30)), copy=False)", id="3 GB"),
    ],
)
def test_an_invalid_kernel_message_keeps_the_files_of_earlier_cells(message: str) -> None:
    answer = in_worker_sandbox(execute, ["%%writefile before.txt\nkept", f"{KERNEL}{message}\nprint('sent')", "1 + 1"])
    assert answer["files"] == ["before.txt"]
    assert answer["remaining"] == []


def test_a_cell_that_asks_for_input_raises_or_exits_does_not_stop_the_next_cell() -> None:
    cells = [
        "input('how many points? ')",
        "1 / 0",
        "raise SystemExit(0)",
        "raise KeyboardInterrupt",
        "print('still here')",
    ]
    answer = in_worker_sandbox(execute, cells)
    assert "division by zero" in answer["printed"][1]
    assert answer["printed"][-1] == "still here\n"


def test_the_kernel_sees_no_hidden_suite_and_no_network() -> None:
    code = """
import socket
try:
    import autograder.checks.ch02_nodes.hidden.worlds
    print("SEEN")
except ImportError:
    print("hidden")
try:
    socket.create_connection(("127.0.0.1", 22), timeout=1)
except OSError as error:
    print(error.errno in (101, 111))
"""
    assert in_worker_sandbox(execute, [code])["printed"] == ["hidden\nTrue\n"]
