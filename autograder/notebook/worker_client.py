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
from autograder.building import keeper
from autograder.exceptions import GraderError, UsageError
from autograder.run.sandbox import Isolation, best_isolation
from autograder.run.sandbox.limits import NOTEBOOK_WORKER
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.worker_sandbox import ended, in_worker_sandbox, place_of
from autograder.suite.fingerprint import places

REQUEST = "request.json"
REPLY_FILE = "answer.json"
EARLY_FILE = "early.json"  # the first part of the reply
RECORDING = "recording.npz"


class _Early:
    """Passes the first part of a reply to a listener as soon as its file exists, once."""

    def __init__(self, file: Path, listener: Callable[[dict[str, Any]], None] | None) -> None:
        self._file, self._listener = file, listener

    def has_looked(self) -> bool:
        """Look for the file. Always returns True."""
        if self._listener is not None and self._file.is_file():
            listener, self._listener = self._listener, None
            listener(json.loads(self._file.read_text(encoding="utf-8")))
        return True


@contextmanager
def run_in_worker(
    verb: str, workspace: Path, *, early: Callable[[dict[str, Any]], None] | None = None, **arguments: Any
) -> Iterator[tuple[dict[str, Any], Path]]:
    """Run `drive` or `check` in a worker, and yield its reply and the folder with its files.

    Args:
        verb: `drive` or `check`.
        workspace: the student's workspace.
        early: called once with the first part of the reply, while the worker continues.
        arguments: the verb's arguments.

    Raises:
        UsageError: there is no such workspace.
        GraderError: the worker failed.
    """
    source = workspace / "src"
    if not source.is_dir():
        raise UsageError(f"there is no folder {source}: run this in the assignment's folder, which contains ws/src")
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
    """Do as `run_in_worker` at an isolation level. `source` is a source tree or, for a check, a whole submission."""
    ours, theirs = Pipe()
    with tempfile.TemporaryDirectory(prefix="request-") as folder, ours:

        def command(scratch: Path) -> list[str]:
            place = place_of(source, isolation, scratch)
            request = {"verb": verb, "source": place, "out": folder, "scratch": scratch}
            request["arguments"] = arguments
            file = Path(folder) / REQUEST  # a large map does not fit on a command line
            file.write_text(json.dumps(request, default=str))
            return [sys.executable, "-m", "autograder.notebook.check_worker", str(file), str(theirs.fileno())]

        visible_paths = places(assignment, parts=("visible",)) if (assignment := arguments.get("assignment")) else []
        if source.is_file():
            visible_paths.append(
                course_paths.chapter(arguments["assignment"])
            )  # from which its reader knows what was given
        view = View(shown=tuple(visible_paths), submitted=(source,), writable=(Path(folder),))
        with (
            theirs,
            in_worker_sandbox(command, isolation, NOTEBOOK_WORKER, view=view, pass_fds=(theirs.fileno(),)) as (
                process,
                _,
            ),
        ):
            theirs.close()  # once the worker has ended, nobody holds its end
            tell = _Early(Path(folder) / EARLY_FILE, early)
            # It asks for interface packages. Between its questions, it is looked after.
            keeper.attend(ours, isolation, lambda: tell.has_looked() and process.exit_reason is not None)
            tell.has_looked()  # the worker may have written the file and ended since the last look
            report = ended(process)
        reply = Path(folder) / REPLY_FILE
        if report.returncode != 0 or not reply.is_file():
            raise GraderError(f"the check itself failed, not your code:\n{report.output[-3000:]}")
        yield json.loads(reply.read_text()), Path(folder)
