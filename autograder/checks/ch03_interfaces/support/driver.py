"""The student's distance driver in the harness. The grader turns its wheels: they obey every command at once."""

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
_RAISED = re.compile(r"Error raised in execute callback: (.{1,200})")  # of rclpy, in its log
_NOT_ENDED = "Goal state not set"
LOOK = 0.05  # s between two looks at the commands
ANSWER_SECONDS = 10.0  # for a server to answer: no time at all in lockstep, generous where time is real


class Driver(AutoHarness):
    """A harness in which goals are sent, and a robot rolls.

    A program that rejects a goal although nothing stands against it, once it has been sent others, is started again:
    what it kept of those is for another check.

    Attributes:
        x, y, heading: where the robot is, in m and rad.
        height: of where it is, in m, which counts for no distance.
        stuck: whether the wheels are held.
        deaf: whether the odometry is silent.
        used: whether the program has been sent a goal.
    """

    def __init__(self, workspace: Workspace, types: Types, clock_rate: float = 1.0) -> None:
        publishes, subscribes = {ODOMETRY: Odometry}, {COMMANDS: Twist}
        super().__init__(workspace, PACKAGE, DRIVER, publishes=publishes, subscribes=subscribes, clock_rate=clock_rate)
        self.types = types
        self.x, self.y, self.heading, self.height = 0.0, 0.0, 0.0, 0.0
        self.stuck = self.deaf = self.used = False
        self._began = 0  # how many commands had come when the last goal was sent

    def restart(self) -> None:
        """Start the program anew, and let it hear where the robot is."""
        stuck, deaf = self.stuck, self.deaf
        self.__exit__(None, None, None)
        self.__enter__()
        self.used = False
        self.place(self.x, self.y, self.heading)
        self.stuck, self.deaf = stuck, deaf

    def place(self, x: float, y: float, heading: float) -> None:
        """Put the robot somewhere else, and let the driver hear of it."""
        self.x, self.y, self.heading, self.stuck, self.deaf = x, y, heading, False, False
        for _ in range(3):
            self._publish_odometry()
            self.run(LOOK)

    def shift(self, distance: float) -> None:
        """Move the robot along its heading, which only the odometry tells."""
        self.x += distance * math.cos(self.heading)
        self.y += distance * math.sin(self.heading)

    def send(self, distance: float, speed: float | None = None) -> Goal:
        """Send a goal; fail the check if nobody answers."""
        goal = self.types.drive_distance.Goal(distance=distance)
        if speed is not None:
            goal.speed = speed
        self._began = len(self.messages(COMMANDS))
        sent: Goal = self.send_goal(self.types.drive_distance, ACTION, goal, ANSWER_SECONDS)
        self.used = True
        self.until(lambda: sent.accepted is not None, ANSWER_SECONDS)
        expect(sent.accepted is not None, "The action server drive_distance did not answer a goal.")
        return sent

    def start(self, distance: float, speed: float | None = None) -> Goal:
        """Send a goal that must be accepted, by a program that was started again if need be."""
        used = self.used
        sent = self.send(distance, speed)
        if used and not sent.accepted:
            self.restart()
            sent = self.send(distance, speed)
        expect(sent.accepted is True, f"A goal of {distance:.2f} m was rejected, and nothing stood against it.")
        return sent

    def commands(self) -> list[ReceivedMessage]:
        """Return the commands that have come since the last goal was sent."""
        return self.messages(COMMANDS)[self._began :]

    def why_aborted(self) -> str:
        """Return what rclpy has logged of an execute that did not end its goal, or ""."""
        raised = _RAISED.findall(self.output)
        if raised:
            return f" execute raised an exception: {raised[-1]}."
        return " execute returned without succeed(), canceled() or abort()." if _NOT_ENDED in self.output else ""

    def roll(self, goal: Goal, seconds: float, *, until: Any = None) -> list[Twist]:
        """Let the wheels roll until the goal has ended, or a condition holds, at most so long; return the commands.

        Each command moves the robot for a tenth of a second, or for as long as the one before it lasted.
        """
        before = seen = len(self.messages(COMMANDS))
        end = self.seconds + seconds
        while self.seconds < end and goal.result is None and not (until and until()):
            self.run(LOOK)
            seen = self._obey(seen)
            self._publish_odometry()
        self.run(2 * LOOK)  # the last command may come with the result
        self._obey(seen)
        return [received.message for received in self.messages(COMMANDS)[before:]]

    def finish(self, goal: Goal, seconds: float, situation: str) -> list[Twist]:
        """Let the wheels roll until the goal has ended; fail the check if it does not."""
        commands = self.roll(goal, seconds)
        expect(goal.result is not None, f"{situation}, the goal had not ended after {seconds:.0f} s.")
        return commands

    def abandon(self, goal: Goal) -> None:
        """Get rid of a goal that is of no further use, by a cancel or, if need be, by holding the wheels."""
        goal.cancel()
        self.stuck = True
        self.roll(goal, 5.0)
        self.stuck = False

    def _obey(self, seen: int) -> int:
        commands = self.messages(COMMANDS)
        for number, received in enumerate(commands[seen:], seen):
            if not self.stuck:
                lasts = min(PERIOD, received.seconds - commands[number - 1].seconds) if number else PERIOD
                self.shift(lasts * received.message.linear.x)
        return len(commands)

    def _publish_odometry(self) -> None:
        if self.deaf:
            return
        odometry = Odometry()
        odometry.header.frame_id, odometry.child_frame_id = "odom", "base_link"
        odometry.header.stamp.sec, odometry.header.stamp.nanosec = divmod(self.now_ns, 10**9)
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = self.x, self.y
        odometry.pose.pose.position.z = self.height
        odometry.pose.pose.orientation.z = math.sin(self.heading / 2.0)
        odometry.pose.pose.orientation.w = math.cos(self.heading / 2.0)
        self.publish(ODOMETRY, odometry)


def stopped(commands: list[Twist]) -> bool:
    """Return whether the last command is a stop."""
    return bool(commands) and commands[-1].linear.x == 0.0 and commands[-1].angular.z == 0.0


def is_left(distance: float, driven: float, remaining: float, slack: float) -> bool:
    """Return whether `remaining` is what is left of a goal, all in m: beyond the goal, 0 or a number below it."""
    left = distance - driven
    return any(abs(remaining - right) <= slack for right in (left, max(0.0, left)))
