"""The instant at which a goal of drive_distance succeeds, to the millimetre."""

from __future__ import annotations

from action_msgs.msg import GoalStatus

from autograder.checking import expect
from autograder.checks.ch03_interfaces.support.driver import Driver

SHORT_OF, GOAL, BEYOND = 0.3055, 0.308, 0.3095  # m: just short of the goal, the goal, just beyond it
CREEP = 0.01  # m/s: a millimetre between two commands
LONG_SECONDS = 20.0  # s to wait for something that takes a second or two; in real time, the machine may be busy
STATUS_NAMES = {
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}


def expect_exact_arrival(driver: Driver) -> None:
    """Fail the check unless a held robot's goal succeeds once the robot is pushed beyond it, and not just before."""
    driver.is_stuck = True
    goal = driver.start(GOAL, CREEP)
    driver.roll(goal, 0.3)
    driver.shift(SHORT_OF)
    driver.roll(goal, 0.3)
    is_early = goal.result is not None
    driver.shift(BEYOND - SHORT_OF)
    driver.roll(goal, LONG_SECONDS)
    outcome = f"ended {STATUS_NAMES[goal.status]}" if goal.status in STATUS_NAMES else "did not end"
    driver.abandon(goal)
    prefix = f"With {GOAL} m to drive, the goal {outcome}"
    expect(not is_early, f"{prefix} when the robot was only {SHORT_OF} m away from where it started.", fraction=0.75)
    message = f"{prefix}, instead of SUCCEEDED, when the robot was {BEYOND} m away from where it started."
    expect(goal.status == GoalStatus.STATUS_SUCCEEDED, message, fraction=0.75)
