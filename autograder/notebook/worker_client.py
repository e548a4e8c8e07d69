"""Starts a trusted worker for a notebook's kernel. The request is JSON, and the reply consists of files."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import Pipe
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.building import bundle_server
from autograder.exceptions import GraderError, UsageError
from autograder.run.sandbox import Isolation, best_isolation
from autograder.run.sandbox.limits import NOTEBOOK_WORKER
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.worker_sandbox import in_worker_sandbox, path_in_sandbox, wait_and_report
from autograder.suite.fingerprint import suite_paths

REQUEST = "request.json"
REPLY_FILE = "answer.json"
EARLY_FILE = "early.json"  # the first part of the reply
RECORDING = "recording.npz"


@contextmanager
def run_in_worker(
    verb: str, workspace: Path, *, early: Callable[[dict[str, Any]], None] | None = None, **arguments: Any
) -> Iterator[tuple[dict[str, Any], Path]]:
    """Run `drive` or `check` in a worker, and yield its reply and the folder with its files.

    Args:
        verb: `drive` or `check`.
        workspace: the student's workspace.
        early: a function that is called once with the first part of the reply, while the worker continues.
        arguments: the verb's arguments.

    Raises:
        UsageError: the workspace does not exist.
        GraderError: the worker failed.
    """
    source = workspace / "src"
    if not source.is_dir():
        raise UsageError(
            f"the folder {source} does not exist: run this in the assignment's folder, which contains ws/src"
        )
    with run_on(source.resolve(), best_isolation(), verb, early=early, **arguments) as reply:
        yield reply


@contextmanager
def run_on(
    source: Path,
    isolation: Isolation,
    verb: str,
    *,
    early: Callable[[dict[str, Any]], None] | None = None,
    **arguments: Any,
) -> Iterator[tuple[dict[str, Any], Path]]:
    """Do the same as `run_in_worker` at a given isolation level. For a check, `source` may be a submission."""
    own_end, worker_end = Pipe()
    with tempfile.TemporaryDirectory(prefix="request-") as folder, own_end:

        def command(scratch: Path) -> list[str]:
            request = {
                "verb": verb,
                "source": path_in_sandbox(source, isolation, scratch),
                "out": folder,
                "scratch": scratch,
            }
            request["arguments"] = arguments
            file = Path(folder) / REQUEST  # a large map does not fit on a command line
            file.write_text(json.dumps(request, default=str))
            return [sys.executable, "-m", "autograder.notebook.check_worker", str(file), str(worker_end.fileno())]

        visible_paths = (
            suite_paths(assignment, parts=("visible",)) if (assignment := arguments.get("assignment")) else []
        )
        if source.is_file():
            # The reader of a submission compares it with the released chapter.
            visible_paths.append(course_paths.chapter(arguments["assignment"]))
        view = View(shown=tuple(visible_paths), submitted=(source,), writable=(Path(folder),))
        with (
            worker_end,
            in_worker_sandbox(command, isolation, NOTEBOOK_WORKER, view=view, pass_fds=(worker_end.fileno(),)) as (
                process,
                _,
            ),
        ):
            worker_end.close()  # now the worker has the only copy, so the connection ends when the worker does
            first_part, listeners = Path(folder) / EARLY_FILE, [early] if early else []

            def has_ended() -> bool:
                """Pass on the first part of the reply once it exists. Return whether the worker has ended."""
                if listeners and first_part.is_file():
                    listeners.pop()(json.loads(first_part.read_text(encoding="utf-8")))
                return process.exit_reason is not None

            # Answer the worker's requests for interface packages until it ends.
            bundle_server.serve_worker(own_end, isolation, has_ended)
            has_ended()  # the worker may have written the first part just before it ended
            report = wait_and_report(process)
        reply = Path(folder) / REPLY_FILE
        if report.returncode != 0 or not reply.is_file():
            raise GraderError(f"the check itself failed, not your code:\n{report.output[-3000:]}")
        yield json.loads(reply.read_text()), Path(folder)
