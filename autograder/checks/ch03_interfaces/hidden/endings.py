"""The action drive_distance: how a goal ends that does not come to its good end, and that there is one at a time."""

from __future__ import annotations

import math
import random

from action_msgs.msg import GoalStatus

from autograder.checks import expect, group, hint
from autograder.checks.ch03_interfaces.hidden.action import LONG, MOVES, NAMES, straight
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import PATIENCE
from autograder.checks.ch03_interfaces.support.driver import Driver, stopped

check = group("action", doc=contract.ACTION)


@check(points=3, depends=MOVES)
@hint("Look at goal_handle.is_cancel_requested each time around the loop; stop, then goal_handle.canceled().")
@hint("cancel_callback must return CancelResponse.ACCEPT: without one, each cancel is rejected.")
def test_drive_cancels(ready: Driver, draw: random.Random) -> None:
    """A cancel stops the robot at once: the goal ends CANCELED, and the result says how far it came and why."""
    x, y = ready.x, ready.y
    goal = ready.start(4.5, 0.5)
    ready.roll(goal, LONG, until=lambda: math.dist((x, y), (ready.x, ready.y)) > 0.9)
    there = ready.x, ready.y
    goal.cancel()
    commands = ready.roll(goal, 3.0)
    expect(goal.cancelled is True, "The cancel was not accepted within 3 s.")
    expect(goal.result is not None, "The cancel was accepted, but 3 s later the goal had not ended.", fraction=0.2)
    says = NAMES.get(goal.status, goal.status)
    expect(goal.status == GoalStatus.STATUS_CANCELED, f"After a cancel the goal ended {says}.", fraction=0.2)
    expect(stopped(commands), "After the cancel, the last command was no stop.", fraction=0.3)
    further = math.dist(there, (ready.x, ready.y))
    expect(further <= 0.3, f"After the cancel, the robot drove on for {further:.2f} m.", fraction=0.3)
    driven = math.dist((x, y), (ready.x, ready.y))
    expect(
        abs(goal.result.driven - driven) <= 0.15,
        f"The result says {goal.result.driven:.2f} m of {driven:.2f} m.",
        fraction=0.7,
    )
    expect(goal.result.reason.strip() != "", "The result gives no reason.", fraction=0.8)


@check(points=2, depends=("drive_cancels",))
@hint("Remember that a goal is being driven when you accept it, and forget it when it has ended.")
@hint("self.busy.acquire(blocking=False) in accept, self.busy.release() at the end of execute.")
def test_drive_one_at_a_time(ready: Driver) -> None:
    """While a goal is driven another one is rejected; the first goes on, and after it there is room for the next."""
    first = ready.start(4.5, 0.3)
    ready.roll(first, 0.3)
    second = ready.send(1.0, 0.5)
    commands = ready.roll(first, 0.4)
    expect(not second.accepted, "While a goal was driven, another one was accepted.")
    expect(first.result is None, "The first goal ended when another one came.", fraction=0.3)
    expect(
        bool(commands) and all(straight(command, 0.3) for command in commands),
        "The first goal was not driven on when another one came.",
        fraction=0.3,
    )
    ready.abandon(first)
    third = ready.send(0.1, 0.5)
    expect(third.accepted is True, "After a goal had ended, the next one was rejected.", fraction=0.5)
    ready.finish(third, LONG, "With 0.10 m to drive")


@check(points=2, depends=MOVES)
@hint("Remember how far the robot had come, and when; a centimetre more sets both anew.")
@hint("self.get_clock().now() - progress_time > PATIENCE: stop, abort, and say why.")
def test_drive_stuck(ready: Driver) -> None:
    """A robot that gets no further for a second is stopped, and the goal ends ABORTED with a reason."""
    ready.stuck = True
    began = ready.seconds
    goal = ready.start(1.0, 0.4)
    commands = ready.finish(goal, 6.0, "With wheels that do not turn")
    seconds = ready.seconds - began
    says = NAMES.get(goal.status, goal.status)
    expect(goal.status == GoalStatus.STATUS_ABORTED, f"With wheels that do not turn, the goal ended {says}.")
    expect(
        seconds >= PATIENCE * 0.8,
        f"The goal was given up after {seconds:.1f} s, instead of {PATIENCE:.0f} s.",
        fraction=0.5,
    )
    expect(stopped(commands), "After the goal had been given up, the last command was no stop.", fraction=0.5)
    expect(goal.result.reason.strip() != "", "The result gives no reason.", fraction=0.7)


@check(points=2, depends=("drive_stuck",))
@hint("Without odometry the position stays as it was, and that is no progress, either.")
def test_drive_blind(ready: Driver) -> None:
    """When the odometry falls silent on the way, the robot is stopped and the goal ends ABORTED."""
    goal = ready.start(4.5, 0.5)
    ready.roll(goal, 0.6)
    ready.deaf = True
    commands = ready.finish(goal, 6.0, "With odometry that fell silent")
    says = NAMES.get(goal.status, goal.status)
    expect(goal.status == GoalStatus.STATUS_ABORTED, f"With odometry that fell silent, the goal ended {says}.")
    expect(stopped(commands), "After the goal had been given up, the last command was no stop.", fraction=0.5)
