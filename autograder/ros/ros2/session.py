"""The node with which a verb queries the graph, and functions that wait for changes of the graph.

These functions do not sleep. They spin the node until a condition holds or a deadline passes, in steps that are short
enough to react to Ctrl-C.
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
LAST_DOMAIN = 232  # in a higher domain, DDS's port numbers would not be valid

# The graph counts as discovered if it has not changed for QUIET seconds. Discovery takes at least MIN_SETTLING seconds,
# or MIN_SETTLING_ALONE while no other node is known, and at most MAX_SETTLING.
QUIET = 0.5
MIN_SETTLING = 1.0
MIN_SETTLING_ALONE = 3.0
MAX_SETTLING = 5.0
# How many seconds to wait until a named node, topic or service appears. Its details are discovered soon after that, so
# LOOKUP_QUIET limits `--spin-time`.
LOOKUP_TIMEOUT = 3.0
LOOKUP_QUIET = 2.0
_STEP = 0.05  # s; how long the node is spun before a condition is tested again


@dataclass(frozen=True)
class Session:
    """The command's node and the executor that spins it.

    Attributes:
        node: a hidden node, that is, one whose name begins with an underscore.
        executor: the executor that spins the node in this thread.
        spin_time: the value of `--spin-time` in seconds, or `None`.
    """

    node: Node
    executor: SingleThreadedExecutor
    spin_time: float | None

    def wait_for(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Spin until `condition` holds, for at most `timeout` (`--spin-time`, or 3 s). Return whether it holds."""
        limit = timeout if timeout is not None else LOOKUP_TIMEOUT if self.spin_time is None else self.spin_time
        deadline = time.monotonic() + limit
        while not condition():
            remaining_seconds = deadline - time.monotonic()
            if remaining_seconds <= 0:
                return False
            self._spin_once(min(_STEP, remaining_seconds))
        return True

    def settle(self, *, max_quiet: float = math.inf) -> None:
        """Spin until the graph has not changed for `--spin-time` (or 0.5 s), or for `max_quiet` if that is shorter."""
        quiet = min(max_quiet, QUIET if self.spin_time is None else self.spin_time)
        previous_graph = self._read_graph()
        last_change = start = time.monotonic()
        while (now := time.monotonic()) - start < self._min_settling(max_quiet) or (
            now - last_change < quiet and now - start < max(MAX_SETTLING, 2 * quiet)
        ):
            self._spin_once(_STEP)
            graph = self._read_graph()
            if graph != previous_graph:
                previous_graph, last_change = graph, time.monotonic()

    def spin_until(self, future: Any, timeout: float | None = None) -> bool:
        """Spin until a future is done, for at most `timeout` seconds if given; return whether it is done."""
        return self.wait_for(future.done, math.inf if timeout is None else timeout)

    def spin(self) -> None:
        """Spin until interrupted."""
        self.wait_for(lambda: False, math.inf)

    def _spin_once(self, seconds: float) -> None:
        with deferred_signals() as received_signals:
            self.executor.spin_once(timeout_sec=seconds)
        for number in received_signals[:1]:
            signal.raise_signal(number)

    def _min_settling(self, limit: float) -> float:
        if self.spin_time is not None:
            return 0.0
        is_alone = len(self.node.get_node_names()) < 2
        return min(limit, MIN_SETTLING_ALONE if is_alone else MIN_SETTLING)

    def _read_graph(self) -> tuple[object, ...]:
        node = self.node
        return (
            sorted(node.get_node_names_and_namespaces()),
            sorted(node.get_topic_names_and_types(no_demangle=True)),
        )


@contextmanager
def deferred_signals() -> Iterator[list[int]]:
    """Collect SIGINT and SIGTERM in a list while the block runs, instead of handling them.

    If a handler raises an exception within rclpy, coroutines are never awaited, or another error replaces it.
    """
    received_signals: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM)
    previous_handlers = {
        number: signal.signal(number, lambda number, _: received_signals.append(number)) for number in numbers
    }
    try:
        yield received_signals
    finally:
        for number, handler in previous_handlers.items():
            signal.signal(number, handler)


@contextmanager
def open_session(args: argparse.Namespace, *, node_name: str | None = None) -> Iterator[Session]:
    """Initialize rclpy and create the command's node; shut both down at the end of the block.

    Raises:
        Ros2Error: `ROS_DOMAIN_ID`, the node's name, or the name of a topic or service used with it is not valid.
    """
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not re.fullmatch(r"\d{1,3}", domain) or int(domain) > LAST_DOMAIN:
        raise Ros2Error(f"ROS_DOMAIN_ID is '{domain}', but must be a number from 0 to {LAST_DOMAIN}")
    parameters = [Parameter("use_sim_time", value=True)] if getattr(args, "use_sim_time", False) else []
    # Without rclpy's signal handlers, the context survives Ctrl-C, so that a goal can still be cancelled.
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
    """Add the options of every verb that queries the graph."""
    parser.add_argument(
        "--spin-time",
        type=float,
        help="Seconds to wait for discovery: of a named thing at most (default: 3), "
        "of the whole graph until nothing new shows up for so long (default: 0.5, 1 at least, 3 if it seems empty)",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time")
    parser.add_argument("--no-daemon", action="store_true", help="Accepted; this stand-in has no daemon anyway")
