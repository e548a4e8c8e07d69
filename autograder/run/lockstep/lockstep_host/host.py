"""The host, which steps the program in this process through ROS time.

The host replaces `Executor.wait_for_ready_callbacks`, which every kind of spin of rclpy calls. When the program waits
for work and has none, the host waits for the grader's next command instead. The command `step` contains events, each
with an instant of ROS time and numbers of messages. At each event, the program takes these messages and runs the timers
that are due.
"""

from __future__ import annotations

import sys
import threading
import weakref
from pathlib import Path
from typing import Any

import rclpy.executors
import rclpy.experimental.events_executor
import rclpy.time_source
from rclpy.clock import ClockType, ROSClock
from rclpy.context import Context
from rclpy.executors import (
    ConditionReachedException,
    Executor,
    SingleThreadedExecutor,
    TimeoutException,
    TimeoutObject,
)
from rclpy.impl.rcutils_logger import Throttle
from rclpy.time import Time

from . import channels
from .arrivals import Arrivals
from .blocking import Blocking
from .callback_threads import Worker
from .clocks import Clocks
from .description import describe
from .due import EVERY_INSTANT, next_due
from .executors import CallbackThreadsExecutor, spin_until_future_complete
from .hooks import Hooks
from .message_counts import MessageCounts, is_alive
from .pipes import Pipes
from .tasks import TaskPositions

_wait_for_work = Executor.wait_for_ready_callbacks
_can_execute = Executor.can_execute
_init = Context.init
_init_time_source = rclpy.time_source.TimeSource.__init__


class Host:
    """One program in lockstep.

    Attributes:
        time: ROS time in nanoseconds.
        phase: the phase of the program: import, start or spin.
        wakes: times of pending wake-ups; None for a wait without a time-out, `EVERY_INSTANT` for a time-out of 0.
    """

    def __init__(self, pipes: Pipes, start_ns: int, clock_rate: float = 1.0) -> None:
        self.pipes = pipes
        self.time = start_ns
        self.phase = "import"
        self.counts = MessageCounts()
        self.arrivals = Arrivals(self.counts)
        self.wakes: list[int | None] = []
        self.hooks = Hooks(self.counts, self.note)
        self.blocking = Blocking(self)
        self.clocks = Clocks(lambda: self.time, self.blocking.sleep, str(Path(__file__).parent), clock_rate)
        self._nodes: list[weakref.ref[Any]] = []
        self._time_sources: weakref.WeakSet[Any] = weakref.WeakSet()
        self._log_clock = ROSClock()  # rclpy would throttle logs by the wall clock, which is much slower than steps
        self._log_clock._set_ros_time_is_active(True)
        self._log_clock.set_ros_time_override(_ros_time(start_ns))
        self._events: list[tuple[int, dict[str, int]]] = []  # the remaining events of the current step
        self._sent: list[dict[str, int]] = []  # how many messages were sent in each finished event of the current step
        self._executors: weakref.WeakSet[Executor] = weakref.WeakSet()
        self._positions = TaskPositions()
        self._has_worked = self._is_stale = self._is_stepping = self._is_quitting = False
        self._notes: list[str] = []
        self._main = threading.current_thread()

    def install(self) -> None:
        """Replace functions of rclpy for the program in this process."""
        self.hooks.install()
        self.blocking.install()
        self.clocks.install()
        time_source = rclpy.time_source.TimeSource
        Context.init = lambda context, args=None, **options: self.init(context, args, **options)
        Executor.wait_for_ready_callbacks = lambda executor, *args, **kwargs: self.wait(executor, *args, **kwargs)
        Executor.can_execute = lambda executor, entity: (
            not self.counts.is_silent(entity) and _can_execute(executor, entity)
        )
        time_source.__init__ = lambda source, *, node=None: self.init_time_source(source, node=node)
        time_source._subscribe_to_clock_topic = lambda source: None  # only the grader steps the clock
        Executor.spin_until_future_complete = lambda executor, future, timeout_sec=None: spin_until_future_complete(
            executor, future, timeout_sec, lambda: self.time
        )
        rclpy.executors.MultiThreadedExecutor = CallbackThreadsExecutor
        # EventsExecutor waits in C++, which cannot be replaced. For a node, both executors behave the same.
        rclpy.experimental.EventsExecutor = rclpy.experimental.events_executor.EventsExecutor = SingleThreadedExecutor
        Throttle.params["throttle_time_source_type"] = self._log_clock

    # Called by rclpy instead of its own functions.

    def init(self, context: Context, args: list[str] | None, **options: Any) -> None:
        """Initialise the default context, or another context of the program, with simulated time."""
        if self.phase == "import":
            self.phase = "start"
        arguments = list(sys.argv if args is None else args)
        _init(context, [*arguments, "--ros-args", "-p", "use_sim_time:=true"], **options)

    def init_time_source(self, source: Any, *, node: Any = None) -> None:
        """Let a new node's clock start at the time of the current step."""
        _init_time_source(source)
        source._last_time_set = _ros_time(self.time)
        self._time_sources.add(source)
        if node is not None:
            self._nodes.append(weakref.ref(node))
            source.attach_node(node)

    def wait(self, executor: Executor, timeout_sec: Any = None, nodes: Any = None, condition: Any = None) -> Any:
        """Return the next callback to run. If none is left in this step, wait for the next step.

        The arguments and exceptions are those of `Executor.wait_for_ready_callbacks`, with time-outs in ROS time.
        """
        condition = condition or (lambda: False)
        timeout = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
        if not self.is_stepped_thread():
            self.note("thread")
            self.stop(event="unsteppable", reason="thread") if self.phase != "spin" else threading.Event().wait()
        end = None if timeout is None or timeout < 0 else self.time + max(1, round(timeout * 1e9))
        threads = getattr(executor, "threads", None)
        self._executors.add(executor)
        while True:
            if condition():
                raise ConditionReachedException
            if threads is not None and threads.resume():
                self.arrivals.record_progress()
                self._positions.clear()
                continue
            is_full = threads is not None and threads.is_full
            unread_readers = self.arrivals.wait(executor) if self.counts.unread_readers and not is_full else []
            work = None if is_full else self._ready(executor, nodes, condition)
            if work is not None:
                return work
            if unread_readers:
                self.arrivals.drop_overdue(unread_readers)
                continue
            # Nothing is left to do now. A finite time-out is in ROS time. A time-out of 0 also waits for the next
            # event, because otherwise a polling loop would never let a step end.
            if end is not None and self.time >= end:
                raise TimeoutException
            self.blocking.check(executor, end)
            wake = EVERY_INSTANT if timeout == 0 else end
            self.wakes.append(wake)
            try:
                self.pass_time()
            finally:
                self.wakes.remove(wake)
            self._is_stale = False

    def is_stepped_thread(self) -> bool:
        """Return whether the current thread is stepped. Threads that the program has created are not."""
        return self._is_stepped(threading.current_thread())

    def _is_stepped(self, thread: threading.Thread) -> bool:
        return thread is self._main or isinstance(thread, Worker)

    def nodes(self) -> list[Any]:
        """Return the nodes that the program has created and not destroyed."""
        return [node for ref in self._nodes if (node := ref()) is not None and is_alive(node)]

    def has_sent(self) -> bool:
        """Return whether a node has sent anything except parameter events."""
        return any(not channel.startswith("/parameter_events ") for channel in self.counts.unreported)

    def note(self, reason: str) -> None:
        """Record for the grader why this program may also run between steps, as one of the protocol's `REASONS`."""
        if reason not in self._notes:
            self._notes.append(reason)

    def stop(self, **event: Any) -> None:
        """Tell the grader that the program cannot continue in lockstep."""
        self.pipes.send(**event)
        while self.pipes.receive()["op"] != "quit":
            pass
        self._is_quitting = True
        raise KeyboardInterrupt

    def pass_time(self) -> None:
        """Continue with the next event of the current step, or wait for the next step."""
        self._is_stale = True
        if self._is_stepping:
            self._sent.append(self.counts.flush())
        while self._events and not self.hooks.changed:  # the grader has to match new endpoints before anything is sent
            event = self._events.pop(0)
            if event[1] or self._is_due(event[0]):
                return self._begin(*event)
            self._sent.append({})
        return self._next_step()

    # The steps.

    def _ready(self, executor: Executor, nodes: Any, condition: Any) -> Any:
        if nodes is None and len(executor.get_nodes()) > 1:
            nodes = self._in_order(executor)
        while True:
            try:
                work = _wait_for_work(executor, timeout_sec=0, nodes=nodes, condition=condition)
            except TimeoutException:
                # Callbacks that ran since the last call of this function may have created tasks, or may have taken time
                # so that timers are due. Only another call finds these.
                if self._is_stale or (self._has_worked and any(not task.done() for task, _, _ in executor._tasks)):
                    self._has_worked = self._is_stale = False
                    continue
                return None
            if self._positions.advances(work[0]):
                self._has_worked = True
                self.arrivals.record_progress()
                return work

    def _in_order(self, executor: Executor) -> list[Any]:
        """Return the executor's nodes, which it keeps in a set, in the order of their creation."""
        executor_nodes = executor.get_nodes()
        return [node for node in self.nodes() if node in executor_nodes]

    def _next_step(self) -> None:
        if self.phase != "spin":
            self.phase = "spin"
            self.pipes.send(event="ready")
        if self._is_stepping:
            self._is_stepping = False
            if not all(map(self._is_stepped, threading.enumerate())):
                self.note("thread")  # another thread may continue while this program is idle
            state = {"sent": self._sent, "lost": self.arrivals.lost, "changed": self.hooks.changed}
            due = self._due()
            self.counts.is_complete = due != EVERY_INSTANT
            state |= {"wake": min(filter(None, self.wakes), default=None), "due": due, "notes": self._notes}
            self.pipes.send(event="done", **state)
        while True:
            command: dict[str, Any] = {"op": "quit"} if self._is_quitting else self.pipes.receive()
            if command["op"] == "quit":
                self._is_quitting = True
                raise KeyboardInterrupt
            if command["op"] == "describe":
                self.pipes.send(event="description", **self._describe())
            elif command["op"] == "match":
                self.counts.match(self._prefix(), command["kept"], command["early"])
                self.counts.flush()
                # Let rclpy check all entities once, because it may have to report discovered endpoints.
                self.counts.is_complete = False
                self.pipes.send(event="matched")
            else:
                break
        self._events = command["events"]
        self._is_stepping = True
        self._sent, self.arrivals.lost = [], []
        self._begin(*self._events.pop(0))

    def _begin(self, instant: int, pending: dict[str, int]) -> None:
        """Begin an event. Messages for later events are held back, as if they had not arrived yet."""
        self.arrivals.record_progress()
        self._set_time(instant)
        self.counts.hold_back(channel for _, later in self._events for channel in later)
        self.counts.count_received(pending)

    def _due(self) -> int | None:
        is_counted = self.counts.is_exact and not (self.arrivals.may_come_late or self.hooks.unpredictable)
        if self._notes or self.counts.unread_readers or not is_counted:
            return EVERY_INSTANT
        return next_due(self.nodes(), self._executors, self.wakes)

    def _is_due(self, instant: int) -> bool:
        due = self._due()
        return due is not None and due <= instant

    def _describe(self) -> dict[str, Any]:
        self.hooks.changed = False
        counts = {"early": self.counts.unreported, "kept": self.counts.kept}
        return {**describe(self.nodes()), **counts, "prefix": self._prefix()}

    def _prefix(self) -> str:
        return next((prefix for node in self.nodes() if (prefix := channels.own_prefix(node))), "")

    def _set_time(self, nanoseconds: int) -> None:
        self.time = nanoseconds
        self._positions.clear()
        now = _ros_time(nanoseconds)
        self._log_clock.set_ros_time_override(now)
        for source in list(self._time_sources):
            source._last_time_set = now
            for clock in source._associated_clocks:
                clock.set_ros_time_override(now)


def _ros_time(nanoseconds: int) -> Time:
    return Time(nanoseconds=nanoseconds, clock_type=ClockType.ROS_TIME)
