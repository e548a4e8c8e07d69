"""The node through which a verb looks at the graph, and waiting for the graph to show something.

Nothing here sleeps: waiting is spinning until a condition holds or a deadline passes, in steps short enough for
Ctrl-C to be heard.
"""

from __future__ import annotations

import argparse
import math
import os
import re
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import rclpy
from rclpy.exceptions import NameValidationException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.validate_node_name import validate_node_name

from autograder.ros.discovery import fast_discovery
from autograder.ros.ros2.exceptions import Ros2Error

NODE_NAME_PREFIX = "_ros2cli"
# Beyond it, DDS runs out of ports.
LAST_DOMAIN = 232

# Seconds without a change after which the graph counts as discovered, the least that is waited, the least before it
# counts as empty, and the most to wait for all.
QUIET = 0.5
LEAST = 1.0
EMPTY = 3.0
LONGEST_SETTLING = 5.0
# Seconds to wait for something that was named, such as a node; once that is there, the rest of what belongs to it
# follows soon, however long `--spin-time` is.
NAMED = 3.0
NAMED_QUIET = 2.0
_STEP = 0.05


@dataclass(frozen=True)
class Session:
    """A node of our own and the executor that spins it.

    Attributes:
        node: hidden, as its name begins with an underscore.
        executor: spins the node, on this thread.
        spin_time: what `--spin-time` said, in seconds.
    """

    node: Node
    executor: SingleThreadedExecutor
    spin_time: float | None

    def wait_for(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Spin until `condition` holds; return whether it did before `timeout` (`--spin-time`, or 3 s)."""
        limit = timeout if timeout is not None else NAMED if self.spin_time is None else self.spin_time
        deadline = time.monotonic() + limit
        while not condition():
            left = deadline - time.monotonic()
            if left <= 0:
                return False
            self._spin_once(min(_STEP, left))
        return True

    def settle(self, *, longest: float = math.inf) -> None:
        """Spin until the graph has not changed for `--spin-time` (0.5) seconds, or for `longest` if that is less."""
        quiet = min(longest, QUIET if self.spin_time is None else self.spin_time)
        last = self._graph()
        changed = start = time.monotonic()
        while (now := time.monotonic()) - start < self._least(longest) or (
            now - changed < quiet and now - start < max(LONGEST_SETTLING, 2 * quiet)
        ):
            self._spin_once(_STEP)
            graph = self._graph()
            if graph != last:
                last, changed = graph, time.monotonic()

    def spin_until(self, future: Any, timeout: float | None = None) -> bool:
        """Spin until a future is done; return whether it is, after at most `timeout` seconds (none: for ever)."""
        return self.wait_for(future.done, math.inf if timeout is None else timeout)

    def spin(self) -> None:
        """Spin until interrupted."""
        self.wait_for(lambda: False, math.inf)

    def _spin_once(self, seconds: float) -> None:
        with signals_held_back() as noted:
            self.executor.spin_once(timeout_sec=seconds)
        for number in noted[:1]:
            signal.raise_signal(number)

    def _least(self, longest: float) -> float:
        if self.spin_time is not None:
            return 0.0
        alone = len(self.node.get_node_names()) < 2
        return min(longest, EMPTY if alone else LEAST)

    def _graph(self) -> tuple[object, ...]:
        node = self.node
        return (
            sorted(node.get_node_names_and_namespaces()),
            sorted(node.get_topic_names_and_types(no_demangle=True)),
        )


@contextmanager
def signals_held_back() -> Iterator[list[int]]:
    """Note SIGINT and SIGTERM in a list.

    Raised in the middle of rclpy's own calls, they leave coroutines that nobody awaits, or come out as other errors.
    """
    noted: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.signal(number, lambda number, _: noted.append(number)) for number in numbers}
    try:
        yield noted
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def open_session(args: argparse.Namespace, *, node_name: str | None = None) -> Iterator[Session]:
    """Start rclpy with a node of our own, and end it afterwards.

    Raises:
        Ros2Error: `ROS_DOMAIN_ID`, the node's name, or the name of a topic or service used with it is not valid.
    """
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not re.fullmatch(r"\d{1,3}", domain) or int(domain) > LAST_DOMAIN:
        raise Ros2Error(f"ROS_DOMAIN_ID is '{domain}', but must be a number from 0 to {LAST_DOMAIN}")
    parameters = [Parameter("use_sim_time", value=True)] if getattr(args, "use_sim_time", False) else []
    # Python's own handlers stay: Ctrl-C then leaves the context alive, so that a goal can still be cancelled.
    with fast_discovery():
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    try:
        name = node_name or f"{NODE_NAME_PREFIX}_{os.getpid()}"
        validate_node_name(name)
        node = rclpy.create_node(
            name,
            start_parameter_services=False,
            parameter_overrides=parameters,
        )
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        try:
            yield Session(node, executor, getattr(args, "spin_time", None))
        finally:
            executor.shutdown(timeout_sec=0)
            node.destroy_node()
    except NameValidationException as error:
        raise Ros2Error(str(error)) from None
    finally:
        rclpy.try_shutdown()


def add_session_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that every verb that looks at the graph has."""
    parser.add_argument(
        "--spin-time",
        type=float,
        help="Seconds to wait for discovery: of a named thing at most (default: 3), "
        "of the whole graph until nothing new shows up for so long (default: 0.5, 1 at least, 3 if it seems empty)",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time")
    parser.add_argument("--no-daemon", action="store_true", help="Accepted; this stand-in has no daemon anyway")
