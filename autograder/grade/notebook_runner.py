"""Runs inside the sandbox: executes the cells of a notebook in a kernel, and reports the outcome of each cell.

    python notebook_runner.py REQUEST_FD ANSWER_FD STARTED_FD

The request, `{"notebook": ..., "skipped": [INDEX, ...], "cell_seconds": ..., "max_output": ...}`, is read from one
descriptor. The answer is written to another, one line of JSON for each event: `{"event": "cell", "index": ...,
"outputs": [...], "execution_count": ...}` after each cell, and `{"event": "end", "reason": ...}`. The student's code in
the sandbox can forge or remove the answer. To prove that this program has started, it writes a byte to the third
descriptor, a pipe, and closes it before the kernel starts. The kernel's own messages are not passed on.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from typing import Any


def main() -> None:
    """Execute the notebook, and report the outcome of each cell."""
    with os.fdopen(int(sys.argv[1]), encoding="utf-8") as stream:
        request = json.load(stream)
    answer = os.fdopen(int(sys.argv[2]), "w", encoding="utf-8")
    sys.path.pop(0)  # so that the notebook cannot import the modules beside this one

    def report(event: str, **fields: Any) -> None:
        answer.write(json.dumps({"event": event, **fields}) + "\n")
        answer.flush()

    os.write(int(sys.argv[3]), b".")
    os.close(int(sys.argv[3]))
    try:
        _execute(request, report)
        report("end", reason="")
    except Exception as error:
        report("end", reason=f"{type(error).__name__}: {error}"[:2000])
    answer.flush()
    os._exit(0)  # the kernel ends with the sandbox


def _execute(request: dict[str, Any], report: Any) -> None:
    import nbformat
    from jupyter_client.manager import AsyncKernelManager
    from nbclient import NotebookClient
    from nbclient.exceptions import CellTimeoutError, DeadKernelError

    received_size = 0

    class Client(NotebookClient):
        """Reports the outcome of each cell, and stops a kernel that sends too much."""

        async def async_execute_cell(self, cell: Any, cell_index: int, *args: Any, **kwargs: Any) -> Any:
            if cell_index in request["skipped"] or cell.cell_type != "code":
                return cell
            try:
                return await super().async_execute_cell(cell, cell_index, *args, **kwargs)
            finally:
                report("cell", index=cell_index, outputs=cell.outputs, execution_count=cell.execution_count)

        def process_message(self, msg: dict[str, Any], cell: Any, cell_index: int) -> Any:
            nonlocal received_size
            received_size += len(repr(msg.get("content", "")))
            if received_size > request["max_output"]:
                raise DeadKernelError("it prints endlessly")
            return super().process_message(msg, cell, cell_index)

    notebook = nbformat.from_dict(request["notebook"])
    sockets = f"{os.environ['JUPYTER_RUNTIME_DIR']}/k"
    kernel = AsyncKernelManager(kernel_name="python3", transport="ipc", ip=sockets)
    client = Client(
        notebook, km=kernel, timeout=request["cell_seconds"], allow_errors=True, shutdown_kernel="immediate"
    )
    with contextlib.suppress(DeadKernelError, CellTimeoutError):  # the effects of earlier cells still count
        client.execute()


if __name__ == "__main__":
    main()
