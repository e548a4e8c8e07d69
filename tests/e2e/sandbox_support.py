"""Runs a piece of test code where the grader's worker runs: in a worker sandbox, with ROS available.

The piece is a function of a test module. It runs by name in a separate process and answers in JSON:

    answer = in_worker_sandbox(probe, "argument")     # runs probe(scratch, "argument") there, and returns its result

Its process is forked from one that has imported ROS and the harness, as in the verification. All pieces of a pytest
process use the same worker sandbox, one after another, and each has its own scratch folder.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import json
import os
import socket
import subprocess
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, TextIO

from autograder.run.sandbox import Isolation, Process, worker_sandbox
from autograder.run.sandbox.limits import VERIFICATION_WORKER
from autograder.run.sandbox.spec import View

ROOT = Path(__file__).resolve().parents[2]
_MARK = "answer: "
_VIEW = View(shown=(ROOT,))  # the tests, and what they grade


def in_worker_sandbox(
    function: Callable[..., Any], *arguments: Any, isolation: Isolation = Isolation.BUBBLEWRAP
) -> Any:
    """Run `function(scratch, *arguments)` in a worker sandbox; return its answer, which crosses as JSON.

    Args:
        function: a function of a test module.
        arguments: what JSON can hold.
        isolation: of the worker sandbox; any level except bubblewrap gets a separate one.
    """
    piece = _piece(function, arguments)
    if isolation is not Isolation.BUBBLEWRAP:
        report = worker_sandbox.run_in_worker_sandbox(
            lambda scratch: [*_PROGRAM, piece, str(scratch)], isolation, view=_VIEW
        )
        status, said = report.returncode, report.output
    else:
        status, said = _shared_cell().run(piece)
    answers = [line for line in said.splitlines() if line.startswith(_MARK)]
    assert status == 0, said
    assert answers, said
    return json.loads(answers[-1].removeprefix(_MARK))


@contextmanager
def started_in_cell(function: Callable[..., Any], *arguments: Any) -> Iterator[Process]:
    """Start `function(scratch, *arguments)` in its own worker sandbox, and end it with the block."""
    command = [*_PROGRAM, _piece(function, arguments)]
    with worker_sandbox.in_worker_sandbox(
        lambda scratch: [*command, str(scratch)], Isolation.BUBBLEWRAP, view=_VIEW
    ) as (process, _):
        yield process


def _piece(function: Callable[..., Any], arguments: tuple[Any, ...]) -> str:
    module = Path(function.__code__.co_filename).relative_to(ROOT).with_suffix("").as_posix().replace("/", ".")
    return json.dumps([module, function.__name__, arguments])


def is_forked(process: Process) -> bool:
    """Return whether a sandboxed program is a fork server's child; True if it has ended."""
    try:
        parent = Path(f"/proc/{process.innermost()}/stat").read_text().rpartition(")")[2].split()[1]
        words = Path(f"/proc/{parent}/cmdline").read_bytes()
    except OSError:
        return True
    return b"autograder.run.fork_server" in words


# A worker sandbox's process is started in /, from where no path leads to the tests.
_RUN = f"import sys; sys.path[0] = {str(ROOT)!r}; from tests.e2e.sandbox_support import main; main()"
_PROGRAM = (sys.executable, "-c", _RUN)


class _SharedCell:
    """A worker sandbox with a process that forks for each piece."""

    def __init__(self) -> None:
        stack = ExitStack()
        atexit.register(stack.close)
        ours, theirs = socket.socketpair()
        with theirs:
            fd = theirs.fileno()
            command = [*_PROGRAM, "serve", str(fd)]
            made = worker_sandbox.in_worker_sandbox(
                lambda scratch: [*command, str(scratch)],
                Isolation.BUBBLEWRAP,
                VERIFICATION_WORKER,
                view=_VIEW,
                pass_fds=(fd,),
            )
            self._process, _ = stack.enter_context(made)
        self._requests, self._replies = ours.makefile("w"), ours.makefile("r")
        self._variables = dict(os.environ)

    def run(self, piece: str) -> tuple[int, str]:
        """Run one piece, with the variables that a test has set; return its exit status and what it wrote."""
        own = {name: value for name, value in os.environ.items() if self._variables.get(name) != value}
        print(json.dumps([own, piece]), file=self._requests, flush=True)
        reply = self._replies.readline()
        assert reply, self._process.output
        status, said = json.loads(reply)
        return status, said


_shared_cell = lru_cache(maxsize=1)(_SharedCell)


def _serve(scratch: Path, requests: TextIO, replies: TextIO) -> None:
    """Run pieces, each in a separate child, until the input ends."""
    from autograder.run.fork_server.profiles import PROFILES
    from autograder.run.sandbox.launcher import warm_up

    importlib.import_module("autograder.harness")
    for profile in PROFILES:  # a server that a child warmed up would end with it
        warm_up(profile)
    gc.collect()
    gc.freeze()  # keeps the garbage collector from copying pages that the children share
    for number, (variables, piece) in enumerate(map(json.loads, requests)):
        place, said = scratch / f"{number}", scratch / f"{number}.log"
        place.mkdir()
        child = os.fork()
        if child == 0:
            os.environ.update(variables)
            _be_child(place, piece, said)
        _, status = os.waitpid(child, 0)
        print(json.dumps([os.waitstatus_to_exitcode(status), said.read_text()]), file=replies, flush=True)
        subprocess.run(["rm", "-rf", "--", place, said], check=True)


def _be_child(place: Path, piece: str, said: Path) -> None:
    status = 1
    try:
        with said.open("w") as log:
            os.dup2(log.fileno(), 1)
            os.dup2(log.fileno(), 2)
        _run(place, piece)
        status = 0
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _run(scratch: Path, piece: str) -> None:
    module, function, arguments = json.loads(piece)
    answer = getattr(importlib.import_module(module), function)(scratch, *arguments)
    print(_MARK + json.dumps(answer), flush=True)


def main() -> None:
    """Run the piece that the command line holds, or serve on the descriptor that it names."""
    from autograder.ros import activate

    activate()
    if sys.argv[1] == "serve":
        with socket.socket(fileno=int(sys.argv[2])) as link:
            _serve(Path(sys.argv[3]), link.makefile("r"), link.makefile("w"))
    else:
        _run(Path(sys.argv[2]), sys.argv[1])
