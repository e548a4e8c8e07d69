"""A harness for launch files: `ros2 launch` runs in the sandbox, in real time."""

from __future__ import annotations

import contextlib
import itertools
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from rcl_interfaces.srv import GetParameters
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data

import autograder
from autograder.exceptions import StudentError
from autograder.harness.grader_node import DEPTH, GraderNode, OnMessage
from autograder.harness.parameter_values import value_of
from autograder.ros.domains import Domain
from autograder.run.lockstep.failures import diagnose_exit
from autograder.run.sandbox import Mount, Process, Sandbox, procfs
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import LAUNCH
from autograder.run.workspace import Workspace
from autograder.submission.reading import reading, record_data

RUNNER = Path(__file__).with_name("launch_runner.py")
ANSWER_SECONDS = 10.0  # maximum real time until a parameter service answers; if its node spins, it answers at once
_POLL_SECONDS = 0.05  # between two checks of a condition while no message arrives
_PROGRAM = re.compile(r"/lib/(?P<package>[^/]+)/(?P<name>[^/]+)$")
MAX_STATUS = 64  # maximum bytes of the line with a launch's exit status; the launched programs can write to it as well
_STATUS = re.compile(rb"-?[0-9]{1,9}\n")
_DOMAIN_OFFSETS = itertools.count()


@dataclass(frozen=True)
class RunningProgram:
    """A process that runs an executable of a package."""

    pid: int
    package: str
    name: str

    @property
    def start_seconds(self) -> float | None:
        """When it started, in s since boot, up to `LaunchHarness.start_resolution` too early; None if it has ended."""
        return procfs.start_seconds(self.pid)

    @property
    def has_children(self) -> bool:
        """Whether it has started another process."""
        return bool(procfs.children(self.pid))


@dataclass(frozen=True)
class Stop:
    """The outcome of Ctrl-C."""

    status: int | None  # the exit status of the launch; None if it is still running
    left: tuple[str, ...]  # the commands that the launch left running


def start(arguments: Sequence[str], spec: Sandbox, status: int | None = None) -> Process:
    """Start `ros2 ARGUMENTS...`: the real `ros2` if it is installed, otherwise the stand-in.

    Args:
        arguments: the arguments of `ros2`.
        spec: the sandbox, as `sandbox` returns it.
        status: a file descriptor to which the exit status is written as a line; the process then outlives `ros2`.
    """
    command = [sys.executable, str(RUNNER), "-" if status is None else str(status), *arguments]
    return launch(command, spec, pass_fds=() if status is None else (status,), profile="launch")


def sandbox(workspace: Workspace) -> Sandbox:
    """Return the sandbox of a `ros2` command: like that of a node, but the `autograder` package can be imported."""
    package = Path(autograder.__file__).parent
    node_sandbox = workspace.sandbox(LAUNCH)
    path = os.pathsep.join(
        part for part in (node_sandbox.environment.get("PYTHONPATH", ""), str(package.parent)) if part
    )
    return replace(
        node_sandbox,
        mounts=(*node_sandbox.mounts, Mount(package)),
        environment={**node_sandbox.environment, "PYTHONPATH": path},
    )


class LaunchHarness(contextlib.ExitStack):
    """A running `ros2 launch` and the grader's node that talks with the launched nodes over DDS; a context manager.

    The end of a launch is not an error: see `status` and `output`. Every waiting method raises a
    `StudentError` if the launch exceeds a limit.

    Args:
        workspace: the student's built workspace.
        package: the package with the launch file.
        file: the launch file's name.
        arguments: launch arguments by name.
        subscribes: topics that the grader subscribes to from the start, with their types.
        publishes: topics that the grader publishes on, with their types.
        qos: for topics in `publishes`, a QoS profile or the size of a reliable queue. The default is that of a sensor,
            best effort: a subscription that asks for reliable messages then receives none.
        environment: environment variables that are set for the launch.

    Attributes:
        another: creates a new harness for the same launch, not yet entered.
        start_resolution: how many seconds too early `RunningProgram.start_seconds` may be.
    """

    start_resolution = procfs.TICK

    def __init__(
        self,
        workspace: Workspace,
        package: str,
        file: str,
        arguments: Mapping[str, str] | None = None,
        *,
        subscribes: Mapping[str, type] | None = None,
        publishes: Mapping[str, type] | None = None,
        qos: Mapping[str, QoSProfile | int] | None = None,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__()
        topics: dict[str, Any] = {"subscribes": subscribes, "publishes": publishes, "qos": qos}
        self.another = partial(LaunchHarness, workspace, package, file, arguments, **topics, environment=environment)
        self._domain = Domain(workspace.domain + next(_DOMAIN_OFFSETS))
        node_sandbox = sandbox(replace(workspace, domain=self._domain.number))
        self._sandbox = replace(node_sandbox, environment={**node_sandbox.environment, **(environment or {})})
        assignments = [f"{name}:={value}" for name, value in (arguments or {}).items()]
        # Without a terminal, the launch itself has to pass Ctrl-C on.
        self._command = ("launch", "--noninteractive", package, file, *assignments)
        self._subscribes, self._publishes, self._qos = dict(subscribes or {}), dict(publishes or {}), dict(qos or {})
        self._received: dict[str, list[Any]] = {topic: [] for topic in self._subscribes}
        self._status_text = b""

    def __enter__(self) -> LaunchHarness:
        self.callback(self._domain.close)
        self._grader_node = GraderNode(self._domain.number)
        self.callback(self._grader_node.close)
        profile = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        for topic, kind in self._subscribes.items():
            self._grader_node.subscribe(topic, kind, _append_to(self._received[topic]), profile)
        create = self._grader_node.node.create_publisher
        self._publishers = {
            topic: create(kind, topic, self._qos.get(topic, qos_profile_sensor_data))
            for topic, kind in self._publishes.items()
        }
        record_data("The programs of the launch")
        self._status_pipe, write_end = os.pipe()
        self.callback(os.close, self._status_pipe)
        os.set_blocking(self._status_pipe, False)
        try:
            self.process = self.enter_context(start(self._command, self._sandbox, write_end))
        except BaseException:
            self.close()
            raise
        finally:
            os.close(write_end)
        return self

    @property
    def output(self) -> str:
        """The output of the launch and its processes so far."""
        record_data("The output of the launch")
        return self.process.output

    @property
    def status(self) -> int | None:
        """The exit status of `ros2 launch`, negative for a signal; None while it runs."""
        with contextlib.suppress(BlockingIOError):
            self._status_text += os.read(self._status_pipe, MAX_STATUS - len(self._status_text))
        if not (self._status_text.endswith(b"\n") or len(self._status_text) == MAX_STATUS):
            return None
        with reading("The exit status of the launch", advice="Do not write to descriptors that you did not open."):
            if not _STATUS.fullmatch(self._status_text):
                raise ValueError(f"{self._status_text!r} is not a number")
            return int(self._status_text)

    def wait_for(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Take messages until `condition` is true, at most `seconds` of real time. Return whether it is.

        If the launch has ended, return at once. Raise a StudentError if it exceeded a limit.
        """
        deadline = time.monotonic() + seconds
        while True:
            is_over = time.monotonic() > deadline or self.status is not None
            self._grader_node.spin(0.0 if is_over else _POLL_SECONDS)
            if condition():
                return True
            if self.process.exit_reason is not None:
                raise StudentError(diagnose_exit(self.process))
            if is_over:
                return False

    def nodes(self) -> list[str]:
        """Return the full names of the nodes that are visible now, repeated if several nodes have the same name."""
        return [name for name in self._grader_node.other_nodes() if "/_" not in name]

    def publishers(self, topic: str) -> list[str]:
        """Return the full names of the nodes that publish on `topic`, except the grader's."""
        return _names_of(self._grader_node.publishers_of(topic))

    def subscribers(self, topic: str) -> list[str]:
        """Return the full names of the nodes that subscribe to `topic`, except the grader's."""
        return _names_of(self._grader_node.subscriptions_of(topic))

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message on a topic of `publishes`."""
        self._publishers[topic].publish(message)

    def messages(self, topic: str) -> list[Any]:
        """Return the messages that were received on a topic of `subscribes`."""
        record_data(f"The messages on {topic}")
        return self._received[topic]

    def parameters(self, node: str, names: Collection[str], seconds: float = ANSWER_SECONDS) -> dict[str, Any] | None:
        """Ask the node with this full name for parameters. Wait at most `seconds` of real time for each answer.

        Returns:
            The values by name, with None for undeclared parameters; or None if the node does not answer.
        """
        values: dict[str, Any] = {}
        service, answers = f"{node}/get_parameters", list[Any]()
        if not self.wait_for(self._grader_node.client(GetParameters, service).service_is_ready, seconds):
            return None
        for name in names:
            # One request per parameter: if one of several is not declared, a node returns none of their values.
            self._grader_node.ask(GetParameters, service, GetParameters.Request(names=[name]), answers.append)
            if not self.wait_for(lambda: len(answers) > len(values), seconds):
                return None
            values[name] = next((value_of(value, name) for value in answers[-1].values), None)
        return values

    def programs(self) -> list[RunningProgram]:
        """Return the running executables of packages, in the order of their process ids.

        A child that a program has forked does not count as another program while it has the program's name.
        """
        processes = self._processes()
        keys = {(program.pid, program.package, program.name) for program in processes}
        return [
            process for process in processes if (procfs.parent(process.pid), process.package, process.name) not in keys
        ]

    def _processes(self) -> list[RunningProgram]:
        """Return the processes that run executables of packages, in the order of their process ids."""
        programs = []
        for pid in sorted(procfs.measure(self.process.innermost()).pids):
            # The path of a script is the interpreter's first argument. A process that has ended has no command line.
            matches = (_PROGRAM.search(word) for word in _command_of(pid)[:2])
            programs += [RunningProgram(pid, match["package"], match["name"]) for match in matches if match is not None]
        return programs

    def kill(self, name: str, number: signal.Signals = signal.SIGKILL) -> int:
        """Send a signal to every program called `name`, including its forks, and return the number of programs."""
        count = sum(program.name == name for program in self.programs())
        for process in self._processes():
            if process.name == name:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process.pid, number)
        return count

    def interrupt(self, seconds: float) -> Stop:
        """Send Ctrl-C, and wait at most `seconds` of real time for the end."""
        if self.status is None:
            runner = self.process.innermost()  # the parent of `ros2`
            os.kill(procfs.children(runner)[0], signal.SIGINT)
        self.wait_for(lambda: self.status is not None, seconds)
        return Stop(self.status, self.left())

    def left(self) -> tuple[str, ...]:
        """Return the commands that the launch left running; none while the launch itself is running."""
        runner = self.process.innermost()
        pids = [pid for pid in procfs.measure(runner).pids if pid != runner and _command_of(pid)]
        return tuple(" ".join(_command_of(pid)) for pid in pids) if self.status is not None else ()


def _append_to(received: list[Any]) -> OnMessage:
    return lambda message, arrived_ns: received.append(message)


def _names_of(endpoints: list[Any]) -> list[str]:
    return sorted(f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}" for endpoint in endpoints)


def _command_of(pid: int) -> list[str]:
    try:
        text = Path(f"/proc/{pid}/cmdline").read_text(errors="replace").rstrip("\0")
    except OSError:
        return []
    return text.split("\0") if text else []
