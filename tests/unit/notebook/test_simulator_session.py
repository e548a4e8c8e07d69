"""The robot that lives in the kernel: its run is recorded, and mistakes are told plainly."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest
import rclpy
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from autograder.exceptions import UsageError
from autograder.notebook import Notice, simulator
from autograder.notebook.simulator_session import SimulatorSession
from sim import Recording
from sim.grading import GRADING_VARIABLE


def test_a_world_that_is_not_there_is_named() -> None:
    with pytest.raises(UsageError, match=r"there is no world 'moon'; there are: .*empty_room"), simulator("moon"):
        pass


def test_nothing_is_simulated_while_the_notebook_is_graded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(GRADING_VARIABLE, "1")
    with simulator() as robot:
        assert not [thread for thread in threading.enumerate() if thread.name == "simulator"]
    assert isinstance(robot.track, Notice)


def test_before_its_end_there_is_no_track() -> None:
    assert repr(SimulatorSession().track) == "The robot has not been simulated yet."


def test_the_robots_run_is_recorded() -> None:
    context = Context()
    heard: list[Any] = []
    rclpy.init(context=context)
    node = Node("listener", context=context)
    node.create_subscription(Odometry, "odom", heard.append, 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    deadline = time.monotonic() + 30.0
    with simulator("empty_room") as robot:
        while len(heard) < 10 and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.1)
    node.destroy_node()
    rclpy.try_shutdown(context=context)
    assert isinstance(robot.recording, Recording)
    assert len(robot.recording) > 1
    assert "empty room" in repr(robot.track)
