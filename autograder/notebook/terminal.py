"""`shell` and `running`: commands in a notebook as in a terminal in which the workspace has been sourced.

A cell must end, and so does what it starts: `running` presses Ctrl-C when its block is over.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from autograder.diagnosis import OK
from autograder.exceptions import UsageError
from autograder.ros.discovery import announcing_often
from autograder.submission.exercise_stubs import explain
from sim.grading import grading

NOT_WHILE_GRADING = "Commands are not run while the notebook is graded."
STOP_SECONDS = 30.0  # real time for what Ctrl-C ends; `ros2 launch` itself gives its nodes 10
_STEP = 0.05
_BUILD = re.compile(r"\bcolcon\b[^|;&]*\bbuild\b(?:[^|;&]*--packages-select(?P<packages>(?: +[\w.]+)+))?")
_SOURCED = '[ ! -f "$0" ] || . "$0" || exit; eval "$1"'


def shell(command: str, *, seconds: float = 600.0, workspace: str | Path = "ws") -> None:
    """Run a command to its end and print its output.

    A build of packages whose files are still to be written is not run: their names are printed instead.

    Args:
        command: as typed in a terminal, in the assignment's folder.
        seconds: after so long, Ctrl-C is pressed, and a line says so.
        workspace: sourced first, once it has been built.

    Raises:
        UsageError: there is no such workspace.
    """
    if grading():
        print(NOT_WHILE_GRADING)
        return
    if unwritten := _unwritten(command, Path(workspace)):
        print(unwritten)
        return
    with _Terminal(command, Path(workspace)) as terminal:
        terminal.wait(lambda: False, seconds)
        terminal.show()
        if terminal.runs:
            print(f"[Ctrl-C after {seconds:g} s]", flush=True)
        terminal.end()


@contextmanager
def running(
    command: str, *, until: str | Sequence[str] = "", seconds: float = 30.0, workspace: str | Path = "ws"
) -> Iterator[None]:
    """Run a command while the block runs; print its output, and press Ctrl-C in the end.

    Args:
        command: as typed in a terminal, in the assignment's folder.
        until: a text, or several; the block begins once the command has printed them all, or has ended.
        seconds: after so long without them, the block begins all the same, and a line says what was not printed.
        workspace: sourced first, once it has been built.

    Raises:
        UsageError: there is no such workspace.
    """
    if grading():
        print(NOT_WHILE_GRADING)
        yield
        return
    texts = [until] if isinstance(until, str) else until
    # All programs of the block announce themselves often: `ros2 node list` then finds them all within a second.
    with announcing_often(), _Terminal(command, Path(workspace)) as terminal:
        terminal.wait(lambda: all(text in terminal.output() for text in texts), seconds)
        terminal.show()
        missing = [text for text in texts if text not in terminal.output()]
        if missing and terminal.runs:
            print(f"[not printed within {seconds:g} s: {', '.join(map(repr, missing))}]")
        try:
            yield
        finally:
            terminal.end()


def _unwritten(command: str, workspace: Path) -> str:
    """Return what is to be said instead of a colcon build that must fail, because a file holds an exercise's stub."""
    if not (build := _BUILD.search(command)):
        return ""
    source = workspace / "src"
    chosen = (build["packages"] or "").split()
    reason = explain(OK, source, *(chosen or sorted(path.name for path in source.glob("*"))))
    return "" if reason is OK else reason.sentence


class _Terminal:
    """A command in a session of its own, which writes to a file: a full pipe could hold it up."""

    def __init__(self, command: str, workspace: Path) -> None:
        if not workspace.is_dir():
            raise UsageError(f"there is no folder {workspace}: run this from the assignment's folder")
        self._file = tempfile.TemporaryFile()  # noqa: SIM115  # closed by __exit__
        self._shown = 0
        # With this variable, a build prints warnings about byte code that look like errors of the package.
        inherited = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
        self._process = subprocess.Popen(
            ["bash", "-c", _SOURCED, str(workspace.resolve() / "install" / "local_setup.bash"), command],
            stdin=subprocess.DEVNULL,
            stdout=self._file,
            stderr=subprocess.STDOUT,
            env={**inherited, "PATH": path, "PYTHONUNBUFFERED": "1"},
            start_new_session=True,
        )

    def __enter__(self) -> _Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        self._signal(signal.SIGKILL)
        self._process.wait()
        self._file.close()

    @property
    def runs(self) -> bool:
        """Whether the command has not ended."""
        return self._process.poll() is None

    def output(self) -> str:
        """Return all that the command has printed so far."""
        return os.pread(self._file.fileno(), os.fstat(self._file.fileno()).st_size, 0).decode(errors="replace")

    def show(self) -> None:
        """Print what has not been printed yet."""
        text = self.output()
        print(text[self._shown :], end="", flush=True)
        self._shown = len(text)

    def wait(self, condition: Callable[[], bool], seconds: float) -> None:
        """Wait for a condition or the command's end, at most so long."""
        deadline = time.monotonic() + seconds
        while not condition() and time.monotonic() < deadline:
            try:
                self._process.wait(_STEP)
            except subprocess.TimeoutExpired:
                continue
            return

    def end(self) -> None:
        """Press Ctrl-C if the command still runs; print the rest, and how it ended if it failed by itself."""
        pressed = self.runs
        if pressed:
            self._signal(signal.SIGINT)
            self.wait(lambda: False, STOP_SECONDS)
        self.show()
        status = self._process.poll()
        if status is None:
            print(f"[still running {STOP_SECONDS:.0f} s after Ctrl-C: killed]")
        elif status != 0 and not pressed:
            print(f"[exit status {status}]")

    def _signal(self, number: signal.Signals) -> None:
        """Signal the whole session, as a terminal does, if it has not ended."""
        try:
            os.killpg(self._process.pid, number)
        except ProcessLookupError:
            return
