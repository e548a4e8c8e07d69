"""The student's distance driver in a harness. The grader simulates its robot, which follows every command at once."""

from __future__ import annotations

import math
import re
from typing import Any

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from autograder.checking import AutoHarness, Goal, ReceivedMessage, Workspace, expect
from autograder.checks.ch03_interfaces.support.contract import DRIVER, PACKAGE, PERIOD
from autograder.checks.ch03_interfaces.support.types import Types

COMMANDS, ODOMETRY, ACTION = "/cmd_vel", "/odom", "/drive_distance"
_EXCEPTION_LINE = re.compile(r"Error raised in execute callback: (.{1,200})")  # as logged by rclpy
_NOT_ENDED_TEXT = "Goal state not set"
STEP = 0.05  # s: one step of the simulated robot
ANSWER_SECONDS = 10.0  # s to wait for an answer; in lockstep, the server answers at once


class Driver(AutoHarness):
    """A harness that sends goals and simulates the robot.

    A program that has been sent goals and then rejects a valid one is restarted: another check tests whether it
    accepts the next goal.

    Attributes:
        x, y, heading: the robot's pose, in m and rad.
        height: the robot's height in m, which must not count as distance.
        is_stuck: whether the wheels are held.
        is_silent: whether the odometry is silent.
        has_goals: whether the program has been sent a goal.
    """

    def __init__(self, workspace: Workspace, types: Types, clock_rate: float = 1.0) -> None:
        publishes, subscribes = {ODOMETRY: Odometry}, {COMMANDS: Twist}
        super().__init__(workspace, PACKAGE, DRIVER, publishes=publishes, subscribes=subscribes, clock_rate=clock_rate)
        self.types = types
        self.x, self.y, self.heading, self.height = 0.0, 0.0, 0.0, 0.0
        self.is_stuck = self.is_silent = self.has_goals = False
        self._first_command = 0  # the number of commands before the last goal was sent

    def restart(self) -> None:
        """Restart the program, and publish the robot's pose."""
        is_stuck, is_silent = self.is_stuck, self.is_silent
        self.__exit__(None, None, None)
        self.__enter__()
        self.has_goals = False
        self.place(self.x, self.y, self.heading)
        self.is_stuck, self.is_silent = is_stuck, is_silent

    def place(self, x: float, y: float, heading: float) -> None:
        """Move the robot to a pose, and publish it."""
        self.x, self.y, self.heading, self.is_stuck, self.is_silent = x, y, heading, False, False
        for _ in range(3):
            self._publish_odometry()
            self.run(STEP)

    def shift(self, distance: float) -> None:
        """Move the robot along its heading, without a command."""
        self.x += distance * math.cos(self.heading)
        self.y += distance * math.sin(self.heading)

    def send(self, distance: float, speed: float | None = None) -> Goal:
        """Send a goal; fail the check if the server does not answer."""
        request = self.types.drive_distance.Goal(distance=distance)
        if speed is not None:
            request.speed = speed
        self._first_command = len(self.messages(COMMANDS))
        goal: Goal = self.send_goal(self.types.drive_distance, ACTION, request, ANSWER_SECONDS)
        self.has_goals = True
        self.until(lambda: goal.accepted is not None, ANSWER_SECONDS)
        expect(goal.accepted is not None, "The action server drive_distance did not answer a goal.")
        return goal

    def start(self, distance: float, speed: float | None = None) -> Goal:
        """Send a goal that must be accepted, if necessary after a restart of the program."""
        has_goals = self.has_goals
        goal = self.send(distance, speed)
        if has_goals and not goal.accepted:
            self.restart()
            goal = self.send(distance, speed)
        expect(goal.accepted is True, f"A valid goal of {distance:.2f} m was rejected.")
        return goal

    def commands(self) -> list[ReceivedMessage]:
        """Return the commands that were published since the last goal was sent."""
        return self.messages(COMMANDS)[self._first_command :]

    def abort_reason(self) -> str:
        """Return why execute did not end its goal, according to rclpy's log, or an empty string."""
        errors = _EXCEPTION_LINE.findall(self.output)
        if errors:
            return f" execute raised an exception: {errors[-1]}."
        return " execute returned without succeed(), canceled() or abort()." if _NOT_ENDED_TEXT in self.output else ""

    def roll(self, goal: Goal, seconds: float, *, until: Any = None) -> list[Twist]:
        """Move the robot until the goal has ended, a condition holds or the time is up; return the commands.

        Each command moves the robot for a tenth of a second, or for the time since the previous one if that is less.
        """
        first = applied_count = len(self.messages(COMMANDS))
        deadline = self.seconds + seconds
        while self.seconds < deadline and goal.result is None and not (until and until()):
            self.run(STEP)
            applied_count = self._apply_commands(applied_count)
            self._publish_odometry()
        self.run(2 * STEP)  # the last command may arrive with the result
        self._apply_commands(applied_count)
        return [received.message for received in self.messages(COMMANDS)[first:]]

    def finish(self, goal: Goal, seconds: float, situation: str) -> list[Twist]:
        """Move the robot until the goal has ended; fail the check if it does not end in time."""
        commands = self.roll(goal, seconds)
        expect(goal.result is not None, f"{situation}, the goal had not ended after {seconds:.0f} s.")
        return commands

    def abandon(self, goal: Goal) -> None:
        """End a goal that is no longer needed, by a cancel or, if that fails, by holding the wheels."""
        goal.cancel()
        self.is_stuck = True
        self.roll(goal, 5.0)
        self.is_stuck = False

    def _apply_commands(self, first: int) -> int:
        commands = self.messages(COMMANDS)
        for index, received in enumerate(commands[first:], first):
            if not self.is_stuck:
                duration = min(PERIOD, received.seconds - commands[index - 1].seconds) if index else PERIOD
                self.shift(duration * received.message.linear.x)
        return len(commands)

    def _publish_odometry(self) -> None:
        if self.is_silent:
            return
        odometry = Odometry()
        odometry.header.frame_id, odometry.child_frame_id = "odom", "base_link"
        odometry.header.stamp.sec, odometry.header.stamp.nanosec = divmod(self.now_ns, 10**9)
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = self.x, self.y
        odometry.pose.pose.position.z = self.height
        odometry.pose.pose.orientation.z = math.sin(self.heading / 2.0)
        odometry.pose.pose.orientation.w = math.cos(self.heading / 2.0)
        self.publish(ODOMETRY, odometry)


def has_stopped(commands: list[Twist]) -> bool:
    """Return whether the last command is a stop."""
    return bool(commands) and commands[-1].linear.x == 0.0 and commands[-1].angular.z == 0.0


def is_remaining(distance: float, driven: float, remaining: float, slack: float) -> bool:
    """Return whether `remaining` fits the other distances, all in m; beyond the goal, it may be 0 or negative."""
    exact = distance - driven
    return any(abs(remaining - expected) <= slack for expected in (exact, max(0.0, exact)))
