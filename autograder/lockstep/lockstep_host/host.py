"""The host: ROS time and its steps, as the program in this process sees them.

It replaces the one function through which every kind of spin of rclpy goes, `Executor.wait_for_ready_callbacks`.
When the program waits for work and there is none, the host waits for the grader's next order instead. An order to step
names instants of ROS time: at each, the program takes all messages that it was sent and runs the timers that are due.
"""

from __future__ import annotations

import sys
import time
import weakref
from typing import Any

import rclpy
import rclpy.executors
import rclpy.time_source
from rclpy.clock import ClockType, ROSClock
from rclpy.executors import ConditionReachedException, Executor, SingleThreadedExecutor, TimeoutException, TimeoutObject
from rclpy.impl.rcutils_logger import Throttle
from rclpy.time import Time

from . import channels, ledger
from .hooks import Hooks
from .link import Link
from .survey import survey

START = 100 * 10**9  # ns of ROS time at which a program starts; 0 would mean "time is not known yet"
PATIENCE = 5.0  # s of real time without any progress, after which messages that were announced count as lost
OVERFLOW = 0.3  # s of real time to wait for more messages than a queue holds, of which some are lost by design

_wait_for_work = Executor.wait_for_ready_callbacks
_init = rclpy.init
_init_time_source = rclpy.time_source.TimeSource.__init__


class Host:
    """One program in lockstep.

    Attributes:
        time: ROS time in nanoseconds.
        phase: how far the program has come: import, start or spin.
    """

    def __init__(self, link: Link) -> None:
        self.link = link
        self.time = START
        self.phase = "import"
        self.ledger = ledger.Ledger()
        self.hooks = Hooks(self.ledger)
        self._nodes: list[weakref.ref[Any]] = []
        self._clocks: weakref.WeakSet[Any] = weakref.WeakSet()  # time sources
        self._log_clock = ROSClock()  # rclpy throttles logs by the wall clock, which steps leave far behind
        self._log_clock._set_ros_time_is_active(True)
        self._log_clock.set_ros_time_override(_ros_time(START))
        self._instants: list[int] = []  # of the present step, still to come
        self._positions: dict[Any, int] = {}  # where coroutines stood when they were last resumed
        self._seen: weakref.WeakSet[Any] = weakref.WeakSet()  # tasks that have been resumed
        self._worked = False
        self._stepping = False
        self._late: list[str] = []
        self._progress = 0.0

    def install(self) -> None:
        """Put the host between rclpy and the program of this process."""
        self.hooks.install()
        time_source = rclpy.time_source.TimeSource
        rclpy.init = self.init
        Executor.wait_for_ready_callbacks = lambda executor, *args, **kwargs: self.wait(executor, *args, **kwargs)
        time_source.__init__ = lambda source, *, node=None: self.init_time_source(source, node=node)
        time_source._subscribe_to_clock_topic = lambda source: None  # the grader steps the clock, nobody else
        rclpy.executors.MultiThreadedExecutor = OneThreadExecutor
        Throttle.params["throttle_time_source_type"] = self._log_clock

    # What rclpy calls instead of its own functions.

    def init(self, *, args: list[str] | None = None, **options: Any) -> Any:
        """Initialise rclpy with simulated time."""
        self.phase = "start"
        arguments = list(sys.argv if args is None else args)
        return _init(args=[*arguments, "--ros-args", "-p", "use_sim_time:=true"], **options)

    def init_time_source(self, source: Any, *, node: Any = None) -> None:
        """Let a new node's clock start at the present step's time."""
        _init_time_source(source)
        source._last_time_set = _ros_time(self.time)
        self._clocks.add(source)
        if node is not None:
            self._nodes.append(weakref.ref(node))
            source.attach_node(node)

    def wait(self, executor: Executor, timeout_sec: Any = None, nodes: Any = None, condition: Any = None) -> Any:
        """Return the next callback to run; when there is none left in this step, wait for the next step."""
        condition = condition or (lambda: False)
        timeout = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
        entered = self.time
        while True:
            if condition():
                raise ConditionReachedException
            owing = self._owing(executor) if self.ledger.owing else []
            for reader, entity in owing:
                # Callbacks run in the order of their creation once all that is owed is there; otherwise, they would
                # run in the order in which messages happen to come in.
                seconds = OVERFLOW if 0 < reader.depth < reader.owes else PATIENCE
                ledger.wait_for(reader, entity, executor.context, self._progress + seconds - time.monotonic())
            work = self._ready(executor, nodes, condition)
            if work is not None:
                return work
            if owing:
                self._give_up(owing)
                continue
            if self._instants:
                self._set_time(self._instants.pop(0))
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
        while True:
            try:
                work = _wait_for_work(executor, timeout_sec=0, nodes=nodes, condition=condition)
            except TimeoutException:
                # What ran since rclpy last looked may have left tasks, which only its next look will find.
                if self._worked and any(not task.done() for task, _, _ in executor._tasks):
                    self._worked = False
                    continue
                return None
            if self._moves(work[0]):
                self._worked = True
                self._progress = time.monotonic()
                return work

    def _moves(self, task: Any) -> bool:
        """Return whether it is worth while to resume a task.

        rclpy resumes coroutines that wait over and over. One that stands where it stood, while nothing else has
        happened, has nothing to do before the next step.
        """
        position = _position(task)
        if task not in self._seen or self._positions.get(task, position) != position:
            self._seen.add(task)
            self._positions.clear()  # this one moves, which may be what others wait for
        elif task in self._positions:
            return False
        self._positions[task] = position
        return True

    def _in_order(self, executor: Executor) -> list[Any]:
        """Return the executor's nodes as they were made; it keeps them in a set, in another order every time."""
        there = executor.get_nodes()
        return [node for node in self._alive() if node in there]

    def _owing(self, executor: Executor) -> list[tuple[ledger.Reader, Any]]:
        """Return the readers of an executor that have not taken all that they were sent, and could now."""
        nodes = executor.get_nodes()
        owing = []
        for reader in list(self.ledger.owing):
            entity = reader.entity
            if entity is None:
                self.ledger.owing.discard(reader)
            elif any(_holds(node, entity) for node in nodes) and executor.can_execute(entity):
                owing.append((reader, entity))
        return owing

    def _give_up(self, owing: list[tuple[ledger.Reader, Any]]) -> None:
        waited = time.monotonic() - self._progress
        lost = [r for r, _ in owing if waited > (OVERFLOW if 0 < r.depth < r.owes else PATIENCE)]
        self._late += [reader.channels[0] for reader in lost if not 0 < reader.depth < reader.owes]
        self.ledger.forgive(lost)

    def _next_step(self) -> None:
        if self.phase != "spin":
            self.phase = "spin"
            self.link.send(event="ready")
        if self._stepping:
            self._stepping = False
            self.link.send(event="done", sent=self.ledger.flush(), late=self._late, changed=self.hooks.changed)
        while True:
            order = self.link.receive()
            if order["op"] == "quit":
                raise KeyboardInterrupt
            if order["op"] == "describe":
                self.link.send(event="description", **self._describe())
            elif order["op"] == "meet":
                self.ledger.meet(self._prefix(), order["kept"], order["early"])
                self.link.send(event="met", sent=self.ledger.flush())
            else:
                break
        self._instants = order["instants"]
        self._stepping = True
        self._late = []
        self._positions.clear()
        self._progress = time.monotonic()
        self._set_time(self._instants.pop(0))
        self.ledger.told(order["mail"])

    def _describe(self) -> dict[str, Any]:
        self.hooks.changed = False
        told = {"early": self.ledger.fresh, "kept": self.ledger.kept, "prefix": self._prefix()}
        return {**survey(self._alive()), **told}

    def _prefix(self) -> str:
        return next((prefix for node in self._alive() if (prefix := channels.own_prefix(node))), "")

    def _alive(self) -> list[Any]:
        """Return the nodes that the program has made and not destroyed."""
        return [node for ref in self._nodes if (node := ref()) is not None and ledger.is_alive(node)]

    def _set_time(self, nanoseconds: int) -> None:
        self.time = nanoseconds
        self._positions.clear()
        now = _ros_time(nanoseconds)
        self._log_clock.set_ros_time_override(now)
        for source in list(self._clocks):
            source._last_time_set = now
            for clock in source._associated_clocks:
                clock.set_ros_time_override(now)


class OneThreadExecutor(SingleThreadedExecutor):
    """Stands for MultiThreadedExecutor in lockstep: one thread, so that the order of callbacks is always the same."""

    def __init__(self, num_threads: int | None = None, *, context: Any = None) -> None:
        super().__init__(context=context)


def _holds(node: Any, entity: Any) -> bool:
    kinds = (node.subscriptions, node.services, node.clients, node.waitables)
    return any(entity is one for kind in kinds for one in kind)


def _position(task: Any) -> int:
    """Return where the innermost coroutine of a task stands."""
    place, inner = -1, task._handler
    while inner is not None:
        frame = getattr(inner, "cr_frame", None)
        place = hash((place, frame.f_lasti)) if frame is not None else place
        inner = getattr(inner, "cr_await", None)
    return place


def _ros_time(nanoseconds: int) -> Time:
    return Time(nanoseconds=nanoseconds, clock_type=ClockType.ROS_TIME)
