"""The host: runs a student's unmodified program in the sandbox, and lets the grader step its time.

    python host.py READ_FD WRITE_FD EXECUTABLE [ARGUMENTS...]

It replaces the one function through which every kind of spin of rclpy goes, `Executor.wait_for_ready_callbacks`.
When the program waits for work, the host waits for the grader's next step instead. A step to time `t` first
delivers the messages that the grader has sent, at `t - 1 ns`, then runs the timers that are due at `t`, so data
always comes before timers; it ends when nothing is left to do.

It runs in the student's own process and is trusted with nothing (see `protocol.py`). It imports nothing of the
grader: the sandbox shows it this one file.
"""

from __future__ import annotations

import json
import os
import runpy
import sys
import time
import traceback
import weakref
from collections import Counter
from pathlib import Path
from typing import Any

import rclpy
import rclpy.executors
import rclpy.publisher
import rclpy.time_source
from rclpy.clock import ClockType, ROSClock
from rclpy.exceptions import InvalidHandle
from rclpy.executors import ConditionReachedException, Executor, SingleThreadedExecutor, TimeoutException, TimeoutObject
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.impl.rcutils_logger import Throttle
from rclpy.time import Time

START = 100 * 10**9  # ns of ROS time at which a program starts; 0 would mean "time is not known yet"
PATIENCE = 5.0  # s of real time without any progress, after which messages that were announced count as lost
TEXT = 8000  # characters of an exception's texts that are reported
INFRASTRUCTURE = frozenset({"/rosout", "/parameter_events", "/clock"})

_wait_for_work = Executor.wait_for_ready_callbacks
_take_message = Executor._take_subscription
_publish = rclpy.publisher.Publisher.publish
_init = rclpy.init
_init_time_source = rclpy.time_source.TimeSource.__init__


class Link:
    """The two pipes to the grader, a JSON object a line."""

    def __init__(self, read_fd: int, write_fd: int) -> None:
        self._reader = os.fdopen(read_fd, "r", encoding="utf-8")
        self._writer = os.fdopen(write_fd, "w", encoding="utf-8")

    def send(self, **event: Any) -> None:
        self._writer.write(json.dumps(event) + "\n")
        self._writer.flush()

    def receive(self) -> dict[str, Any]:
        line = self._reader.readline()
        return dict(json.loads(line)) if line else {"op": "quit"}


class Host:
    """ROS time and its steps, as the program in this process sees them."""

    def __init__(self, link: Link) -> None:
        self.link = link
        self.time = START
        self.phase = "import"
        self.nodes: list[weakref.ref[Any]] = []
        self.clocks: weakref.WeakSet[Any] = weakref.WeakSet()  # time sources
        self.log_clock = ROSClock()  # rclpy throttles logs by the wall clock, which steps leave far behind
        self.log_clock._set_ros_time_is_active(True)
        self.log_clock.set_ros_time_override(self._ros_time(START))
        self.met: weakref.WeakSet[Any] = weakref.WeakSet()  # subscriptions that the grader was told of
        self.taken: weakref.WeakKeyDictionary[Any, int] = weakref.WeakKeyDictionary()
        self.published: dict[str, int] = {}
        self.announced: dict[str, int] = {}
        self.delivering = False
        self.stepping = False
        self.late = False
        self.progress = 0.0

    # What rclpy calls instead of its own functions.

    def init(self, *, args: list[str] | None = None, **options: Any) -> Any:
        """Initialise rclpy with simulated time."""
        self.phase = "start"
        arguments = list(sys.argv if args is None else args)
        return _init(args=[*arguments, "--ros-args", "-p", "use_sim_time:=true"], **options)

    def init_time_source(self, source: Any, *, node: Any = None) -> None:
        """Let a new node's clock start at the present step's time."""
        _init_time_source(source)
        source._last_time_set = self._ros_time(self.time)
        self.clocks.add(source)
        if node is not None:
            self.nodes.append(weakref.ref(node))
            source.attach_node(node)

    def publish(self, publisher: Any, message: Any) -> None:
        """Publish, and count."""
        _publish(publisher, message)
        self.published[publisher.topic_name] = self.published.get(publisher.topic_name, 0) + 1

    def take(self, executor: Executor, subscription: Any) -> Any:
        """Take a message, and count."""
        execute = _take_message(executor, subscription)
        if execute is not None:
            self.taken[subscription] = self.taken.get(subscription, 0) + 1
        return execute

    def wait(self, executor: Executor, timeout_sec: Any = None, nodes: Any = None, condition: Any = None) -> Any:
        """Return the next callback to run; when there is none left in this step, wait for the next step."""
        condition = condition or (lambda: False)
        timeout = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
        entered = self.time
        while True:
            if condition():
                raise ConditionReachedException
            owed = self._owed(executor)
            self._gather(executor, owed)
            work = self._ready(executor, nodes, condition)
            if work is not None:
                return work
            if owed:
                continue
            if self.delivering:
                self.delivering = False
                self._set_clocks(self.time)
                continue
            # Nothing is left in this step. A finite time-out is ROS time; one of 0 waits for the next step, too,
            # since a polling loop would never let a step end.
            waited = self.time - entered
            if timeout is not None and 0 <= timeout * 1e9 <= waited and waited > 0:
                raise TimeoutException
            self._next_step()

    # The steps.

    def _ready(self, executor: Executor, nodes: Any, condition: Any) -> Any:
        if nodes is None and len(executor.get_nodes()) > 1:
            nodes = self._in_order(executor)
        try:
            work = _wait_for_work(executor, timeout_sec=0, nodes=nodes, condition=condition)
        except TimeoutException:
            return None
        self.progress = time.monotonic()
        return work

    def _in_order(self, executor: Executor) -> list[Any]:
        """Return the executor's nodes as they were made; it keeps them in a set, in another order every time."""
        there = executor.get_nodes()
        return [node for node in self._nodes() if node in there]

    def _owed(self, executor: Executor) -> list[Any]:
        """Return the executor's subscriptions that have not taken every message they were sent."""
        if self.late or not self.announced:
            return []
        owed = [
            subscription
            for node in executor.get_nodes()
            for subscription in node.subscriptions
            if subscription in self.met
            and self.taken.get(subscription, 0) < self.announced.get(subscription.topic_name, 0)
        ]
        self.late = bool(owed) and time.monotonic() - self.progress > PATIENCE
        return [] if self.late else owed

    def _gather(self, executor: Executor, owed: list[Any]) -> None:
        """Wait until each of these subscriptions has a message: they are run in the order of their creation then.

        Without it, the order would be that in which the messages happen to come in.
        """
        for subscription in owed:
            with subscription.handle, executor.context.handle:
                wait_set = rclpy_implementation.WaitSet(1, 0, 0, 0, 0, 0, executor.context.handle)
                wait_set.clear_entities()
                wait_set.add_subscription(subscription.handle)
                wait_set.wait(int(max(0.0, self.progress + PATIENCE - time.monotonic()) * 1e9))

    def _next_step(self) -> None:
        if self.phase != "spin":
            self.phase = "spin"
            self.link.send(event="ready")
        if self.stepping:
            self.stepping = False
            self.link.send(event="done", published=self.published, late=self.late)
        while True:
            order = self.link.receive()
            if order["op"] == "quit":
                raise KeyboardInterrupt
            if order["op"] == "describe":
                self.link.send(event="description", **self._describe())
                continue
            self.time = int(order["t"])
            self.announced = order["sent"]
            self.stepping = self.delivering = True
            self.late = False
            self.progress = time.monotonic()
            self._set_clocks(self.time - 1)
            return

    def _describe(self) -> dict[str, Any]:
        nodes = self._nodes()
        publishers = [p for node in nodes for p in node.publishers if p.topic_name not in INFRASTRUCTURE]
        subscriptions = [(n, s) for n in nodes for s in n.subscriptions if s.topic_name not in INFRASTRUCTURE]
        self.met.update(subscription for _, subscription in subscriptions)
        unmatched = [p.topic_name for p in publishers if not p.get_subscription_count()]
        unmatched += [s.topic_name for node, s in subscriptions if not node.count_publishers(s.topic_name)]
        return {
            "nodes": [node.get_fully_qualified_name() for node in nodes],
            "timers": [timer.timer_period_ns for node in nodes for timer in node.timers],
            "unmatched": sorted(set(unmatched)),
            "subscriptions": Counter(subscription.topic_name for _, subscription in subscriptions),
            "published": self.published,
        }

    def _nodes(self) -> list[Any]:
        """Return the nodes that the program has made and not destroyed."""
        return [node for ref in self.nodes if (node := ref()) is not None and _is_alive(node)]

    def _set_clocks(self, nanoseconds: int) -> None:
        now = self._ros_time(nanoseconds)
        self.log_clock.set_ros_time_override(now)
        for source in list(self.clocks):
            for clock in source._associated_clocks:
                clock.set_ros_time_override(now)

    @staticmethod
    def _ros_time(nanoseconds: int) -> Time:
        return Time(nanoseconds=nanoseconds, clock_type=ClockType.ROS_TIME)


def _is_alive(node: Any) -> bool:
    try:
        with node.handle:
            return True
    except InvalidHandle:
        return False


class OneThreadExecutor(SingleThreadedExecutor):
    """Stands for MultiThreadedExecutor in lockstep: one thread, so that the order of callbacks is always the same."""

    def __init__(self, num_threads: int | None = None, *, context: Any = None) -> None:
        super().__init__(context=context)


def install(host: Host) -> None:
    """Put the host between rclpy and the program of this process."""
    time_source = rclpy.time_source.TimeSource
    rclpy.init = host.init
    rclpy.publisher.Publisher.publish = lambda publisher, message: host.publish(publisher, message)
    Executor._take_subscription = lambda executor, subscription: host.take(executor, subscription)
    Executor.wait_for_ready_callbacks = lambda executor, *args, **kwargs: host.wait(executor, *args, **kwargs)
    time_source.__init__ = lambda source, *, node=None: host.init_time_source(source, node=node)
    time_source._subscribe_to_clock_topic = lambda source: None  # the grader steps the clock, nobody else
    rclpy.executors.MultiThreadedExecutor = OneThreadExecutor
    Throttle.params["throttle_time_source_type"] = host.log_clock


def main() -> None:
    """Run the program that the command line names, in lockstep."""
    read_fd, write_fd, program = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    sys.argv = sys.argv[3:]
    sys.path[0] = str(Path(program).parent)  # as Python sets it for a program that is started by its path
    host = Host(Link(read_fd, write_fd))
    install(host)
    try:
        runpy.run_path(program, run_name="__main__")
    except Exception as error:
        host.link.send(
            event="crash",
            phase=host.phase,
            type=type(error).__name__,
            message=str(error)[-TEXT:],
            traceback="".join(traceback.format_exception(error))[-TEXT:],
        )
        raise


if __name__ == "__main__":
    main()
