"""Starts a sandboxed command at the isolation level of this process."""

from __future__ import annotations

import atexit
import logging
import os
import signal
import socket
import subprocess
import tempfile
import threading
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from autograder.ros.environment import WHEEL_BOOTSTRAP_VARIABLES
from autograder.run import patience
from autograder.run.fork_server import seccomp
from autograder.run.fork_server.client import PLACEHOLDER_COMMAND, TIMEOUT, ForkError, ForkServer
from autograder.run.fork_server.request import ForkRequest
from autograder.run.sandbox import bubblewrap, cgroup
from autograder.run.sandbox.cgroup import ControlGroup
from autograder.run.sandbox.isolation import Isolation
from autograder.run.sandbox.process import Process
from autograder.run.sandbox.spec import INTERPRETER, Sandbox

ISOLATION_VARIABLE = "AUTOGRADER_ISOLATION"

# Variables by which a fork server finds the real ROS. They must not name a submission's folder, because the server runs
# outside every sandbox.
_ROS_VARIABLES = (*WHEEL_BOOTSTRAP_VARIABLES, "PYTHONPATH", "AMENT_PREFIX_PATH")

_lock = threading.Lock()
_log = logging.getLogger(__name__)
_servers: dict[str, ForkServer | None] = {}  # by profile; None if its programs could not be forked


def current_isolation() -> Isolation:
    """Return the isolation level of the worker sandbox around this process, or `process` if there is none."""
    return Isolation(os.environ.get(ISOLATION_VARIABLE, Isolation.PROCESS.value))


def restore_sigint() -> None:
    """Let SIGINT end the processes that this one will start. Call it in the main thread.

    A shell's background job ignores SIGINT, and all its descendants inherit that. So without this call, a node would
    end on Ctrl-C if the grader runs in the foreground, but not if the grader runs in the background.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def launch(command: list[str], spec: Sandbox, *, pass_fds: tuple[int, ...] = (), profile: str | None = None) -> Process:
    """Start `command` in the sandbox that `spec` describes, at the current isolation level.

    Args:
        command: the command to run.
        spec: the sandbox.
        pass_fds: descriptors that the command inherits.
        profile: for a Python script, the profile of modules that are imported in advance (`fork_server.profiles`).

    Raises:
        StudentError: the grading has no time left for programs. When its time is over, running programs are stopped.
    """
    patience.require()
    limits = replace(spec.limits, wall_seconds=patience.bounded(spec.limits.wall_seconds))
    spec = replace(spec, limits=limits)
    if profile is not None and current_isolation() is Isolation.BUBBLEWRAP:
        process = _fork(command[1:], spec, pass_fds, profile)
        if process is not None:
            return process
    return _start(command, spec, cgroup.make(spec.limits), pass_fds)


def warm_up(profile: str) -> None:
    """Start the fork server of a profile, if it is not running, so that it begins its imports."""
    with _lock:
        if profile not in _servers:
            ros_variables = {name: os.environ[name] for name in _ROS_VARIABLES if name in os.environ}
            server = _servers[profile] = ForkServer(profile, {"PATH": os.defpath, **INTERPRETER, **ros_variables})
            atexit.register(server.close)


def _start(
    command: list[str],
    spec: Sandbox,
    group: ControlGroup,
    pass_fds: tuple[int, ...] = (),
    stdin: int = subprocess.DEVNULL,
    is_placeholder: bool = False,
) -> Process:
    contained = current_isolation() is Isolation.BUBBLEWRAP
    with tempfile.TemporaryFile() as filter_file, ExitStack() as stack:
        filter_file.write(seccomp.program())
        filter_file.seek(0)
        status: int | None = None
        if contained:
            status, write_end = os.pipe()
            stack.callback(os.close, write_end)
            command = bubblewrap.sandbox(command, spec, filter_file.fileno(), write_end)
            pass_fds = (*pass_fds, filter_file.fileno(), write_end)
        else:
            command = [*bubblewrap.rlimits(spec.limits), *command]
        return Process(
            group.enter(command),
            spec.limits,
            environment={"PATH": os.defpath, **({} if contained else spec.environment)},
            pass_fds=pass_fds,
            cwd=None if contained else spec.workdir,
            contained=contained,
            writable=(Path("/tmp"), Path("/dev/shm"), spec.workdir) if contained else (),
            group=group,
            stdin=stdin,
            is_placeholder=is_placeholder,
            status=status,
        )


def _fork(command: list[str], spec: Sandbox, pass_fds: tuple[int, ...], profile: str) -> Process | None:
    """Fork a program. Return None if that is impossible; then the program has not run."""
    warm_up(profile)
    server = _servers[profile]
    if server is None:
        return None
    group = cgroup.make(spec.limits)
    status, sandbox_end = socket.socketpair()
    with status:
        with sandbox_end:
            process = _start(PLACEHOLDER_COMMAND, spec, group, stdin=sandbox_end.fileno(), is_placeholder=True)
        try:
            status.settimeout(TIMEOUT)
            if not status.recv(1):
                raise ForkError(f"the sandbox was not made: {process.output}")
            request = ForkRequest(
                command,
                dict(spec.environment),
                str(spec.workdir),
                bubblewrap.resource_limits(spec.limits),
                process.innermost(),
                list(map(str, group.folders)),
                list(pass_fds),
            )
            process.adopt(server.spawn(request, status.fileno()))
        except (ForkError, TimeoutError) as error:
            process.kill()
            _servers[profile] = None
            _log.warning("programs are started one by one, which takes longer: %s", error)
            return None
    return process
