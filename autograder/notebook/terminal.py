"""`shell` and `running` run commands in a notebook as in a terminal with a sourced workspace.

A cell must end, and so must the programs that it starts: `running` sends Ctrl-C at the end of its block.
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
from autograder.ros.discovery import fast_discovery
from autograder.submission.exercise_stubs import explain
from sim.grading import grading

NOT_WHILE_GRADING = "Commands are not run while the notebook is graded."
STOP_SECONDS = 30.0  # real time in which a command must end after Ctrl-C; `ros2 launch` waits 10 s for its nodes
_STEP = 0.05  # s; how often a condition is tested
_BUILD = re.compile(r"\bcolcon\b[^|;&]*\bbuild\b(?:[^|;&]*--packages-select(?P<packages>(?: +[\w.]+)+))?")
_SOURCED = '[ ! -f "$0" ] || . "$0" || exit; eval "$1"'


def shell(command: str, *, seconds: float = 600.0, workspace: str | Path = "ws") -> None:
    """Run a command to its end and print its output.

    If a file that a build reads, such as setup.py or a message, is still to be written, a message names it instead. An
    unsolved node does not prevent a build.

    Args:
        command: as typed in a terminal, in the assignment's folder.
        seconds: time after which Ctrl-C is sent, with a message.
        workspace: the workspace to source first, if it has been built.

    Raises:
        UsageError: the workspace does not exist.
    """
    if grading():
        print(NOT_WHILE_GRADING)
        return
    if message := _unsolved_message(command, Path(workspace)):
        print(message)
        return
    with _Terminal(command, Path(workspace)) as terminal:
        terminal.wait(lambda: False, seconds)
        terminal.show()
        if terminal.is_running:
            print(f"[Ctrl-C after {seconds:g} s]", flush=True)
        terminal.stop()


@contextmanager
def running(
    command: str, *, until: str | Sequence[str] = "", seconds: float = 30.0, workspace: str | Path = "ws"
) -> Iterator[None]:
    """Run a command while the block runs. Print its output, and send Ctrl-C at the end.

    Args:
        command: as typed in a terminal, in the assignment's folder.
        until: one or more texts. The block starts when the command has printed all of them, or has ended.
        seconds: time after which the block starts anyway, with a message about the missing texts.
        workspace: the workspace to source first, if it has been built.

    Raises:
        UsageError: the workspace does not exist.
    """
    if grading():
        print(NOT_WHILE_GRADING)
        yield
        return
    texts = [until] if isinstance(until, str) else until
    # All programs in the block announce themselves often, so that `ros2 node list` finds them within a second.
    with fast_discovery(), _Terminal(command, Path(workspace)) as terminal:
        terminal.wait(lambda: all(text in terminal.output() for text in texts), seconds)
        terminal.show()
        missing_texts = [text for text in texts if text not in terminal.output()]
        if missing_texts and terminal.is_running:
            print(f"[not printed within {seconds:g} s: {', '.join(map(repr, missing_texts))}]")
        try:
            yield
        finally:
            terminal.stop()


def _unsolved_message(command: str, workspace: Path) -> str:
    """Return a message if the command is a colcon build that must fail, because a file still contains a stub."""
    if not (build := _BUILD.search(command)):
        return ""
    source = workspace / "src"
    packages = (build["packages"] or "").split()
    reason = explain(OK, source, *(packages or sorted(path.name for path in source.glob("*"))))
    return "" if reason is OK else reason.sentence


class _Terminal:
    """A command that runs in its own session. It writes to a file, because a full pipe could block it."""

    def __init__(self, command: str, workspace: Path) -> None:
        if not workspace.is_dir():
            raise UsageError(f"the folder {workspace} does not exist: run this in the assignment's folder")
        self._file = tempfile.TemporaryFile()  # noqa: SIM115  # closed by __exit__
        self._printed_length = 0
        # With this variable, a build prints byte-code warnings that look like errors in the package.
        inherited_variables = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
        self._process = subprocess.Popen(
            ["bash", "-c", _SOURCED, str(workspace.resolve() / "install" / "local_setup.bash"), command],
            stdin=subprocess.DEVNULL,
            stdout=self._file,
            stderr=subprocess.STDOUT,
            env={**inherited_variables, "PATH": path, "PYTHONUNBUFFERED": "1"},
            start_new_session=True,
        )

    def __enter__(self) -> _Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        self._signal(signal.SIGKILL)
        self._process.wait()
        self._file.close()

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def output(self) -> str:
        return os.pread(self._file.fileno(), os.fstat(self._file.fileno()).st_size, 0).decode(errors="replace")

    def show(self) -> None:
        """Print the new output."""
        text = self.output()
        print(text[self._printed_length :], end="", flush=True)
        self._printed_length = len(text)

    def wait(self, condition: Callable[[], bool], seconds: float) -> None:
        """Wait for a condition or the command's end, for at most `seconds`."""
        deadline = time.monotonic() + seconds
        while not condition() and time.monotonic() < deadline:
            try:
                self._process.wait(_STEP)
            except subprocess.TimeoutExpired:
                continue
            return

    def stop(self) -> None:
        """Send Ctrl-C if the command is still running. Print the rest of its output, and its status if it failed."""
        was_running = self.is_running
        if was_running:
            self._signal(signal.SIGINT)
            self.wait(lambda: False, STOP_SECONDS)
        self.show()
        status = self._process.poll()
        if status is None:
            print(f"[still running {STOP_SECONDS:.0f} s after Ctrl-C: killed]")
        elif status != 0 and not was_running:
            print(f"[exit status {status}]")

    def _signal(self, number: signal.Signals) -> None:
        """Send a signal to the whole session, as a terminal does. If the session has ended, do nothing."""
        try:
            os.killpg(self._process.pid, number)
        except ProcessLookupError:
            return
