"""Run a function of a test module where the grader's worker runs: in a worker sandbox, with ROS available.

The function is found by its name, runs in a separate process, and returns a value that JSON can hold:

    value = in_worker_sandbox(probe, "argument")  # runs probe(scratch, "argument") there, and returns its value

Its process is forked from one that has imported ROS and the harness, as in the verification. All calls in a pytest
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
    """Run `function(scratch, *arguments)` in a worker sandbox; return its value, which is passed as JSON.

    Args:
        function: a function of a test module.
        arguments: values that JSON can hold.
        isolation: the level of the worker sandbox. Only calls at bubblewrap share a worker sandbox.
    """
    call = _encode_call(function, arguments)
    if isolation is not Isolation.BUBBLEWRAP:
        report = worker_sandbox.run_in_worker_sandbox(
            lambda scratch: [*_PROGRAM, call, str(scratch)], isolation, view=_VIEW
        )
        status, output = report.returncode, report.output
    else:
        status, output = _shared_sandbox().run(call)
    answers = [line for line in output.splitlines() if line.startswith(_MARK)]
    assert status == 0, output
    assert answers, output
    return json.loads(answers[-1].removeprefix(_MARK))


@contextmanager
def started_in_worker_sandbox(function: Callable[..., Any], *arguments: Any) -> Iterator[Process]:
    """Start `function(scratch, *arguments)` in its own worker sandbox; end it after the block."""
    command = [*_PROGRAM, _encode_call(function, arguments)]
    with worker_sandbox.in_worker_sandbox(
        lambda scratch: [*command, str(scratch)], Isolation.BUBBLEWRAP, view=_VIEW
    ) as (process, _):
        yield process


def _encode_call(function: Callable[..., Any], arguments: tuple[Any, ...]) -> str:
    module = Path(function.__code__.co_filename).relative_to(ROOT).with_suffix("").as_posix().replace("/", ".")
    return json.dumps([module, function.__name__, arguments])


def is_forked(process: Process) -> bool:
    """Return whether a sandboxed program is a child of a fork server, or has ended."""
    try:
        parent = Path(f"/proc/{process.innermost()}/stat").read_text().rpartition(")")[2].split()[1]
        command_line = Path(f"/proc/{parent}/cmdline").read_bytes()
    except OSError:
        return True
    return b"autograder.run.fork_server" in command_line


# A worker sandbox's process starts in /, where Python would not find the tests.
_RUN = f"import sys; sys.path[0] = {str(ROOT)!r}; from tests.e2e.sandbox_support import main; main()"
_PROGRAM = (sys.executable, "-c", _RUN)


class _SharedSandbox:
    """A worker sandbox with a process that forks for each call."""

    def __init__(self) -> None:
        stack = ExitStack()
        atexit.register(stack.close)
        ours, theirs = socket.socketpair()
        with theirs:
            fd = theirs.fileno()
            command = [*_PROGRAM, "serve", str(fd)]
            sandbox = worker_sandbox.in_worker_sandbox(
                lambda scratch: [*command, str(scratch)],
                Isolation.BUBBLEWRAP,
                VERIFICATION_WORKER,
                view=_VIEW,
                pass_fds=(fd,),
            )
            self._process, _ = stack.enter_context(sandbox)
        self._requests, self._replies = ours.makefile("w"), ours.makefile("r")
        self._variables = dict(os.environ)

    def run(self, call: str) -> tuple[int, str]:
        """Run a call with the environment variables that a test has set; return its exit status and its output."""
        changed = {name: value for name, value in os.environ.items() if self._variables.get(name) != value}
        print(json.dumps([changed, call]), file=self._requests, flush=True)
        reply = self._replies.readline()
        assert reply, self._process.output
        status, output = json.loads(reply)
        return status, output


_shared_sandbox = lru_cache(maxsize=1)(_SharedSandbox)


def _serve(scratch: Path, requests: TextIO, replies: TextIO) -> None:
    """Run calls, each in a separate child process, until the input ends."""
    from autograder.run.fork_server.profiles import PROFILES
    from autograder.run.sandbox.launcher import warm_up

    importlib.import_module("autograder.harness")
    for profile in PROFILES:  # a server started by a child would end with that child
        warm_up(profile)
    gc.collect()
    gc.freeze()  # keeps the garbage collector from copying pages that the children share
    for number, (variables, call) in enumerate(map(json.loads, requests)):
        folder, log = scratch / f"{number}", scratch / f"{number}.log"
        folder.mkdir()
        child = os.fork()
        if child == 0:
            os.environ.update(variables)
            _be_child(folder, call, log)
        _, status = os.waitpid(child, 0)
        print(json.dumps([os.waitstatus_to_exitcode(status), log.read_text()]), file=replies, flush=True)
        subprocess.run(["rm", "-rf", "--", folder, log], check=True)


def _be_child(folder: Path, call: str, log: Path) -> None:
    status = 1
    try:
        with log.open("w") as stream:
            os.dup2(stream.fileno(), 1)
            os.dup2(stream.fileno(), 2)
        _run(folder, call)
        status = 0
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _run(scratch: Path, call: str) -> None:
    module, function, arguments = json.loads(call)
    answer = getattr(importlib.import_module(module), function)(scratch, *arguments)
    print(_MARK + json.dumps(answer), flush=True)


def main() -> None:
    """Run the call that the command line contains, or serve on the descriptor that it names."""
    from autograder.ros import activate

    activate()
    if sys.argv[1] == "serve":
        with socket.socket(fileno=int(sys.argv[2])) as link:
            _serve(Path(sys.argv[3]), link.makefile("r"), link.makefile("w"))
    else:
        _run(Path(sys.argv[2]), sys.argv[1])
