"""The simulator beside a notebook records the runs of its robots, and reports wrong settings in plain words."""

from __future__ import annotations

import time
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from autograder.exceptions import UsageError
from autograder.notebook import simulator
from autograder.notebook.notices import Notice
from autograder.notebook.simulator_session import SimulatorSession
from sim import Recording
from sim.grading import GRADING_VARIABLE


def test_a_missing_world_is_named() -> None:
    with pytest.raises(UsageError, match=r"there is no world 'moon'; there are: .*empty_room"), simulator("moon"):
        pass


def test_no_simulation_runs_while_the_notebook_is_graded(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(GRADING_VARIABLE, "1")
    with simulator() as robot:
        pass
    assert isinstance(robot.track, Notice)
    assert capfd.readouterr().out == ""


def test_a_simulation_has_no_track_before_its_end() -> None:
    assert repr(SimulatorSession().track) == "The robot has not been simulated yet."


@pytest.mark.slow
def test_each_robots_run_is_recorded_with_its_events(capsys: pytest.CaptureFixture[str]) -> None:
    context = Context()
    odometry: list[Any] = []
    rclpy.init(context=context)
    node = Node("driver", context=context)
    node.create_subscription(Odometry, "right/odom", odometry.append, 10)
    forward = node.create_publisher(Twist, "right/cmd_vel", 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    deadline = time.monotonic() + 60.0
    with simulator("lab", speed=4.0, robots=["left", "right"]) as robots:
        while not (odometry and odometry[-1].twist.twist.linear.x > 0.1) and time.monotonic() < deadline:
            forward.publish(Twist(linear=Vector3(x=0.2)))
            executor.spin_once(timeout_sec=0.02)
        stopped = len(odometry)
        while (
            not (len(odometry) > stopped and odometry[-1].twist.twist.linear.x == 0.0) and time.monotonic() < deadline
        ):
            executor.spin_once(timeout_sec=0.1)
    node.destroy_node()
    rclpy.try_shutdown(context=context)
    assert isinstance(robots.recording, Recording)
    left, right = (robots.recording.poses[:, index] for index in (0, 1))
    assert (left[0] == left[-1]).all()
    assert not (right[0] == right[-1]).all()
    assert [(event.robot, event.kind) for event in robots.recording.events] == [("right", "watchdog")]
    assert all(len(log.rows) for log in robots.recording.scans)
    assert "the lab" in repr(robots.track)
    output = capsys.readouterr().out
    assert "world 'the lab', 2 robot(s), speed 4" in output
    assert output.count("right had no new command for 0.5 s and stops") == 1


def test_invalid_settings_are_reported_in_the_cell(capsys: pytest.CaptureFixture[str]) -> None:
    with simulator(
        "empty_room", robots=["one", "two", "three", "four", "five", "six", "seven", "eight", "nine"]
    ) as robots:
        pass
    assert isinstance(robots.track, Notice)
    output = capsys.readouterr().out
    assert "9 robots, but the world 'empty room' has" in output
    assert "[exit status 1]" in output
