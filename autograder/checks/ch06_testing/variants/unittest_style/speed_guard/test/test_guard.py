"""Tests of the node with an executor in a thread and a queue of received messages."""

import contextlib
import queue
import random
import threading
import time

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Range
from speed_guard.guard import SpeedGuard

BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class Harness:
    """Communicates with a guard that spins in another thread."""

    def __init__(self, context, guard):
        """Connect to the guard's topics."""
        self.guard = guard
        self.node = Node("harness", context=context)
        self.answers = queue.Queue()
        self.distances = queue.Queue()
        self.raw = self.node.create_publisher(Twist, "cmd_vel_raw", 5)
        self.range = self.node.create_publisher(Range, "distance", BEST_EFFORT)
        self.node.create_subscription(Twist, "cmd_vel", self.answers.put, 50)
        self.node.create_subscription(Range, "distance", self.distances.put, BEST_EFFORT)
        self.executor = MultiThreadedExecutor(num_threads=2, context=context)
        self.executor.add_node(self.node)
        self.executor.add_node(guard)
        self.finished = threading.Event()
        self.thread = threading.Thread(target=self.spin)
        self.thread.start()

    def spin(self):
        """Spin until the test is over. A waiting thread can miss shutdown(), so wait briefly."""
        while not self.finished.is_set():
            self.executor.spin_once(timeout_sec=0.1)

    def distance(self, value):
        """Publish a distance, and wait until the guard has processed it."""
        self.range.publish(Range(range=value))
        self.distances.get(timeout=8.0)
        self.answer(-1.0)

    def answer(self, x, z=0.0, y=0.0):
        """Publish a command and return the answer."""
        message = Twist()
        message.linear.x, message.linear.y, message.angular.z = x, y, z
        self.raw.publish(message)
        return self.answers.get(timeout=8.0)

    def silence(self, seconds):
        """Return whether no message arrives for this many seconds."""
        try:
            self.answers.get(timeout=seconds)
        except queue.Empty:
            return True
        return False


@contextlib.contextmanager
def running_guard(**parameters):
    """Start a guard and a harness in a new context."""
    context = Context()
    rclpy.init(context=context, domain_id=random.randint(2, 90))
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]
    guard = SpeedGuard(context=context, parameter_overrides=overrides)
    harness = Harness(context, guard)
    try:
        yield harness
    finally:
        harness.finished.set()
        harness.thread.join()
        harness.executor.shutdown()
        guard.destroy_node()
        harness.node.destroy_node()
        rclpy.try_shutdown(context=context)


def test_name():
    """The node has the name that parameter files use."""
    with running_guard() as harness:
        assert "speed_guard" in harness.node.get_node_names()


def test_unknown_at_first():
    """It does not move before the first distance."""
    with running_guard(timeout=30.0) as harness:
        assert harness.answer(0.5).linear.x == 0.0
        assert harness.answer(-0.5).linear.x == -0.5


def test_newest():
    """The last distance counts, farther or nearer."""
    with running_guard(timeout=30.0) as harness:
        for value, expected in [(1.0, 0.25), (9.0, 0.5), (0.4, 0.0), (1.25, 0.375)]:
            harness.distance(value)
            assert harness.answer(0.5).linear.x == pytest.approx(expected, abs=1e-6)


def test_turn():
    """A turn is not changed, in front of a wall or on a clear way."""
    with running_guard(timeout=30.0) as harness:
        for value in (0.4, 9.0):
            harness.distance(value)
            answer = harness.answer(0.5, z=-1.25, y=0.25)
            assert (answer.linear.y, answer.angular.z) == (0.25, -1.25)


def test_one_answer():
    """Each command has exactly one answer."""
    with running_guard(timeout=30.0) as harness:
        harness.answer(0.5)
        assert harness.silence(0.3)


def test_parameters():
    """Both distances are parameters."""
    with running_guard(timeout=30.0, stop_distance=2.0, slow_distance=4.0) as harness:
        for value, expected in [(1.9, 0.0), (3.0, 0.25), (4.5, 0.5)]:
            harness.distance(value)
            assert harness.answer(0.5).linear.x == pytest.approx(expected, abs=1e-6)


def test_timeout():
    """The timeout is a parameter, too: with a long one, nothing becomes old within a second."""
    with running_guard(timeout=30.0) as harness:
        harness.distance(9.0)
        assert harness.silence(1.0)
        assert harness.answer(0.5).linear.x == 0.5


def test_stale():
    """An old distance is forgotten."""
    with running_guard(timeout=0.15) as harness:
        harness.distance(9.0)
        assert harness.answers.get(timeout=8.0) == Twist()
        assert harness.answer(0.5).linear.x == 0.0


def test_stale_under_command():
    """A distance becomes old although commands continue."""
    with running_guard(timeout=1.0) as harness:
        harness.distance(9.0)
        end = time.monotonic() + 2.0  # a number of commands would take longer on a busy machine
        speeds = [harness.answer(0.5).linear.x]
        while time.monotonic() < end and speeds[-1] > 0.0 and harness.silence(0.05):
            speeds.append(harness.answer(0.5).linear.x)
        assert speeds[-1] == 0.0


def test_defaults():
    """The defaults are those of the class's docstring."""
    with running_guard() as harness:
        defaults = {"stop_distance": 0.5, "slow_distance": 1.5, "timeout": 0.5}
        assert {name: harness.guard.get_parameter(name).value for name in defaults} == defaults


def test_watchdog():
    """The guard publishes one stop after a silence, and none before the first command."""
    with running_guard(timeout=0.15) as harness:
        assert harness.silence(0.5)
        for _ in range(2):
            harness.answer(-0.5)
            assert harness.answers.get(timeout=8.0) == Twist()
            assert harness.silence(0.5)
