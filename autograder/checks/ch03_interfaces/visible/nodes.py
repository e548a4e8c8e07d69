"""Checks of the two nodes."""

from __future__ import annotations

import math

from action_msgs.msg import GoalStatus
from sensor_msgs.msg import BatteryState

from autograder.checking import check, expect, hint
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.driver import Driver, has_stopped, is_remaining
from autograder.checks.ch03_interfaces.support.reporter import Reporter

STATUS, TRIP, DRIVE = (("builds", definition) for definition in ("robot_status", "check_trip", "drive_distance"))


@check(points=1, covers=("status-topic", "unknown", "percent"), group="status", needs=STATUS, doc=contract.BATTERY)
@hint("create_publisher(RobotStatus, 'robot_status', STATUS_QOS), and a timer that calls publish_status.")
@hint("A stamp is a message: self.get_clock().now().to_msg(). A level is an int: math.floor returns one.")
def test_status(reporter: Reporter) -> None:
    """battery_level is -1 before the first battery state, and 40 at a percentage of 0.4."""
    first = reporter.status()
    message = f"Before the first battery state, battery_level is {first.battery_level} instead of {contract.UNKNOWN}."
    expect(first.battery_level == contract.UNKNOWN, message)
    reporter.publish_battery(0.4)
    level = reporter.status().battery_level
    expect(level == 40, f"At percentage 0.4, battery_level is {level} instead of 40.")


@check(points=1, covers="percent", group="status", needs=STATUS, after=("status",), doc=contract.BATTERY)
@hint("int() rounds down. math.floor(percent + 0.5) rounds to the nearest whole number, and halves up.")
def test_rounding(reporter: Reporter) -> None:
    """At percentage 0.278, battery_level is 28, not 27."""
    reporter.publish_battery(0.278)
    level = reporter.status().battery_level
    expect(level == 28, f"At percentage 0.278, battery_level is {level} instead of 28.")


@check(
    points=1,
    covers=("status-stamp", "charging", "joint-topic", "newest"),
    group="status",
    needs=STATUS,
    after=("status",),
    doc=contract.BATTERY,
)
@hint("msg.header.stamp = self.get_clock().now().to_msg(), in publish_status.")
@hint("Compare power_supply_status with the constant. msg.joint_positions is list(...) of the joint state's position.")
def test_sensors(reporter: Reporter) -> None:
    """The status has a stamp, shows that the battery is charging, and holds the positions of two joints."""
    reporter.publish_battery(0.61, status=BatteryState.POWER_SUPPLY_STATUS_CHARGING)
    reporter.publish_joints([0.25, -1.5])
    status = reporter.status()
    expect(status.header.stamp.sec != 0, "header.stamp is 0: it was never set.")
    expect(status.is_charging, "is_charging is False while the battery charges.")
    joints = list(status.joint_positions)
    expect(joints == [0.25, -1.5], f"joint_positions is {joints} instead of [0.25, -1.5].")


@check(points=1, covers=("trip-rule", "trip-enough"), group="service", needs=TRIP, doc=contract.SERVICE)
@hint("battery_at_end = floor(level - sum(legs) / METRES_PER_PERCENT). possible is True if that is at least reserve.")
def test_trip(reporter: Reporter) -> None:
    """At 40 %, legs of 50 m and 50 m leave 20 % and are possible. Legs of 50 m and 51 m leave 19 % and are not."""
    reporter.set_battery(40)
    for legs, expected in (([50.0, 50.0], 20), ([50.0, 51.0], 19)):
        answer = reporter.ask(legs)
        expect(
            answer.battery_at_end == expected,
            f"With legs of {legs}, battery_at_end is {answer.battery_at_end} instead of {expected}.",
        )
        is_possible = expected == 20
        message = f"With legs of {legs}, possible is {answer.possible} instead of {is_possible}."
        expect(answer.possible is is_possible, message)


@check(points=1, covers=("trip-far", "trip-reason"), group="service", needs=TRIP, after=("trip",), doc=contract.SERVICE)
@hint("max(0, ...) keeps battery_at_end from falling below 0. Also compare the level with what the legs take.")
@hint("Whenever possible is False, put a sentence into response.reason.")
def test_too_far(reporter: Reporter) -> None:
    """At 45 %, legs of 120 m and 130 m leave 0 %, possible is False even with a reserve of 0, and reason says why."""
    reporter.set_battery(45)
    answer = reporter.ask([120.0, 130.0], reserve=0)
    expect(answer.battery_at_end == 0, f"battery_at_end is {answer.battery_at_end} instead of 0.")
    expect(not answer.possible, "possible is True, but the trip takes more charge than the battery has.")
    expect(bool(answer.reason.strip()), "The reason in the response is empty.")


@check(points=1, covers="trip-unknown", group="service", needs=TRIP, after=("trip",), doc=contract.SERVICE)
@hint("A leg is a distance: at least 0, and finite. Check the legs before you add them up.")
def test_negative_leg(reporter: Reporter) -> None:
    """With a leg of -1 m, no trip is possible, and battery_at_end is -1."""
    reporter.set_battery(60)
    answer = reporter.ask([10.0, -1.0])
    expect(not answer.possible, "With a leg of -1 m, possible is True instead of False.")
    level = answer.battery_at_end
    expect(level == contract.UNKNOWN, f"With a leg of -1 m, battery_at_end is {level} instead of {contract.UNKNOWN}.")


@check(points=1, covers=("drives", "arrives", "driven"), group="action", needs=DRIVE, doc=contract.ACTION)
@hint("goal_callback accepts. execute publishes feedback and a command, waits, and checks how far the robot has come.")
@hint("Without a MultiThreadedExecutor, no odometry arrives while execute runs.")
def test_drive(driver: Driver) -> None:
    """It drives the robot 0.35 m in a direction other than x, sends feedback and a result, and stops the robot."""
    start = (0.4, -0.3)
    driver.place(*start, 2.2)
    goal = driver.start(0.35, 0.5)
    commands = driver.finish(goal, 10.0, "With 0.35 m to drive")
    expect(goal.status == GoalStatus.STATUS_SUCCEEDED, f"The goal did not succeed.{driver.abort_reason()}")
    driven = math.dist(start, (driver.x, driver.y))
    expect(0.33 <= driven <= 0.55, f"With 0.35 m to drive, the robot drove {driven:.2f} m.")
    expect(bool(goal.feedback), "There was no feedback on the way.")
    feedback = goal.feedback[-1].message
    adds_up = is_remaining(0.35, feedback.driven, feedback.remaining, 0.01)
    values = f"driven is {feedback.driven:.2f} m and remaining is {feedback.remaining:.2f} m"
    expect(adds_up, f"In the last feedback, {values}, which is not 0.35 m together.")
    reported = goal.result.driven
    message = f"In the result, driven is {reported:.2f} m, but the robot drove {driven:.2f} m."
    expect(abs(reported - driven) <= 0.1, message)
    expect(has_stopped(commands), "When the goal ended, the last command was not a stop.")


@check(points=1, covers="cancels", group="action", needs=DRIVE, after=("drive",), doc=contract.ACTION)
@hint("cancel_callback accepts, and execute checks goal_handle.is_cancel_requested.")
@hint("If a valid goal is rejected, check that execute calls self.busy.release() in finally.")
def test_cancel(driver: Driver) -> None:
    """A cancel stops the robot, and the goal ends CANCELED."""
    goal = driver.start(4.0, 0.3)
    driver.roll(goal, 0.3)
    goal.cancel()
    commands = driver.finish(goal, 5.0, "After a cancel")
    expect(goal.status == GoalStatus.STATUS_CANCELED, "After a cancel, the goal did not end CANCELED.")
    expect(has_stopped(commands), "After the cancel, the last command was not a stop.")


@check(points=1, covers=("rejects", "busy"), group="action", needs=DRIVE, after=("drive",), doc=contract.ACTION)
@hint("In accept, test 0.0 < goal.distance <= MAX_DISTANCE and 0.0 < goal.speed <= MAX_SPEED.")
@hint("Take self.busy last: self.busy.acquire(blocking=False) returns False while another goal has it.")
def test_reject(driver: Driver) -> None:
    """It rejects goals of -0.5 m or 0.6 m/s. While a goal is driven, it rejects another one and continues the first."""
    for distance, speed in ((-0.5, 0.3), (0.5, 0.6)):
        goal = driver.send(distance, speed)
        is_accepted = bool(goal.accepted)
        if is_accepted:
            driver.abandon(goal)
        expect(not is_accepted, f"A goal of {distance} m at {speed} m/s was accepted.")
    first = driver.start(3.0, 0.25)
    driver.roll(first, 0.3)
    second = driver.send(0.4, 0.25)
    driver.roll(first, 0.3)
    is_running = first.result is None
    driver.abandon(first)
    expect(not second.accepted, "While a goal was driven, another one was accepted.")
    expect(is_running, "The first goal ended when another one was sent.")


@check(points=1, covers="stuck", group="action", needs=DRIVE, after=("drive",), doc=contract.ACTION)
@hint("Remember the distance and the time of the last progress. Each further centimetre updates both.")
@hint("After PATIENCE without progress, stop and abort.")
def test_stuck(driver: Driver) -> None:
    """A robot that is held is stopped after a second, and the goal ends ABORTED with a reason."""
    driver.is_stuck = True
    goal = driver.start(2.0, 0.45)
    commands = driver.finish(goal, 6.0, "With a robot that is held")
    driver.is_stuck = False
    expect(goal.status == GoalStatus.STATUS_ABORTED, "With a robot that is held, the goal did not end ABORTED.")
    expect(has_stopped(commands), "When the goal was given up, the last command was not a stop.")
    expect(bool(goal.result.reason.strip()), "The reason in the result is empty.")
