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
@hint("A stamp is a message: self.get_clock().now().to_msg(). A level is an int: math.floor gives one.")
def test_status(reporter: Reporter) -> None:
    """The status says what the battery says: unknown at first, then 40 percent."""
    first = reporter.status()
    expect(
        first.battery_level == contract.UNKNOWN, f"Before the battery has spoken its level is {first.battery_level}."
    )
    reporter.publish_battery(0.4)
    level = reporter.status().battery_level
    expect(level == 40, f"At percentage 0.4 battery_level is {level}.")


@check(points=1, covers="percent", group="status", needs=STATUS, after=("status",), doc=contract.BATTERY)
@hint("int() cuts off. math.floor(percent + 0.5) goes to the nearest, and halves go up.")
def test_rounding(reporter: Reporter) -> None:
    """At percentage 0.278 battery_level is 28, not 27."""
    reporter.publish_battery(0.278)
    level = reporter.status().battery_level
    expect(level == 28, f"At percentage 0.278 battery_level is {level}.")


@check(
    points=1,
    covers=("status-stamp", "charging", "joint-topic", "newest"),
    group="status",
    needs=STATUS,
    after=("status",),
    doc=contract.BATTERY,
)
@hint("msg.header.stamp = self.get_clock().now().to_msg(), in publish_status.")
@hint("Compare power_supply_status with the constant; msg.joint_positions = list(...) of the joint state's position.")
def test_sensors(reporter: Reporter) -> None:
    """The status has a stamp, and says what a battery that charges and two joints say."""
    reporter.publish_battery(0.61, status=BatteryState.POWER_SUPPLY_STATUS_CHARGING)
    reporter.publish_joints([0.25, -1.5])
    status = reporter.status()
    expect(status.header.stamp.sec != 0, "header.stamp is 0: it was never set.")
    expect(status.is_charging, "is_charging is False while the battery charges.")
    joints = list(status.joint_positions)
    expect(joints == [0.25, -1.5], f"joint_positions is {joints} instead of [0.25, -1.5].")


@check(points=1, covers=("trip-rule", "trip-enough"), group="service", needs=TRIP, doc=contract.SERVICE)
@hint("battery_at_end = floor(level - sum(legs) / METRES_PER_PERCENT); possible when that is at least reserve.")
def test_trip(reporter: Reporter) -> None:
    """At 40 %, legs of 50 m and 50 m leave 20 %, which is possible; 51 m instead leave 19 %, which is not."""
    reporter.set_battery(40)
    for legs, expected in (([50.0, 50.0], 20), ([50.0, 51.0], 19)):
        answer = reporter.ask(legs)
        expect(
            answer.battery_at_end == expected,
            f"Legs of {legs} leave {answer.battery_at_end} %, instead of {expected} %.",
        )
        expect(
            answer.possible is (expected == 20),
            f"Legs of {legs} are said to be {'' if answer.possible else 'im'}possible.",
        )


@check(points=1, covers=("trip-far", "trip-reason"), group="service", needs=TRIP, after=("trip",), doc=contract.SERVICE)
@hint("max(0, ...) keeps battery_at_end from falling below 0; then compare with what the legs take, too.")
@hint("Whenever possible is False, put a sentence into response.reason.")
def test_too_far(reporter: Reporter) -> None:
    """At 45 %, legs of 120 m and 130 m leave 0 %: not possible, even with a reserve of 0, and the reason says why."""
    reporter.set_battery(45)
    answer = reporter.ask([120.0, 130.0], reserve=0)
    expect(answer.battery_at_end == 0, f"battery_at_end is {answer.battery_at_end}, instead of 0.")
    expect(not answer.possible, "The trip takes more charge than there is, and is said to be possible.")
    expect(bool(answer.reason.strip()), "The response gives no reason.")


@check(points=1, covers="trip-unknown", group="service", needs=TRIP, after=("trip",), doc=contract.SERVICE)
@hint("A leg is a distance: at least 0, and finite. Look at the legs before you add them up.")
def test_negative_leg(reporter: Reporter) -> None:
    """With a leg of -1 m no trip is possible, and battery_at_end is -1."""
    reporter.set_battery(60)
    answer = reporter.ask([10.0, -1.0])
    expect(not answer.possible, "With a leg of -1 m the trip is said to be possible.")
    level = answer.battery_at_end
    expect(level == contract.UNKNOWN, f"With a leg of -1 m battery_at_end is {level}, instead of {contract.UNKNOWN}.")


@check(points=1, covers=("drives", "arrives", "driven"), group="action", needs=DRIVE, doc=contract.ACTION)
@hint("goal_callback accepts, execute drives: publish feedback and a command, wait, look how far the robot has come.")
@hint("Without a MultiThreadedExecutor, execute never hears of the odometry.")
def test_drive(driver: Driver) -> None:
    """The robot drives 0.35 m, not along x, with feedback and a result, and stops."""
    start = (0.4, -0.3)
    driver.place(*start, 2.2)
    goal = driver.start(0.35, 0.5)
    commands = driver.finish(goal, 10.0, "With 0.35 m to drive")
    expect(goal.status == GoalStatus.STATUS_SUCCEEDED, f"The goal did not succeed.{driver.abort_reason()}")
    driven = math.dist(start, (driver.x, driver.y))
    expect(0.33 <= driven <= 0.55, f"The robot drove {driven:.2f} m.")
    expect(bool(goal.feedback), "There was no feedback on the way.")
    feedback = goal.feedback[-1].message
    adds_up = is_remaining(0.35, feedback.driven, feedback.remaining, 0.01)
    expect(adds_up, f"A feedback said driven {feedback.driven:.2f} m and remaining {feedback.remaining:.2f} m.")
    reported = goal.result.driven
    expect(abs(reported - driven) <= 0.1, f"The result says {reported:.2f} m, it was {driven:.2f} m.")
    expect(has_stopped(commands), "After the goal had ended, the last command was no stop.")


@check(points=1, covers="cancels", group="action", needs=DRIVE, after=("drive",), doc=contract.ACTION)
@hint("cancel_callback accepts, and execute looks at goal_handle.is_cancel_requested.")
@hint("A goal that is rejected: self.busy.release() comes at the end of execute, in finally.")
def test_cancel(driver: Driver) -> None:
    """A cancel stops the robot, and the goal ends CANCELED."""
    goal = driver.start(4.0, 0.3)
    driver.roll(goal, 0.3)
    goal.cancel()
    commands = driver.finish(goal, 5.0, "After a cancel")
    expect(goal.status == GoalStatus.STATUS_CANCELED, "After a cancel the goal did not end CANCELED.")
    expect(has_stopped(commands), "After the cancel, the last command was no stop.")


@check(points=1, covers=("rejects", "busy"), group="action", needs=DRIVE, after=("drive",), doc=contract.ACTION)
@hint("0.0 < goal.distance <= MAX_DISTANCE and 0.0 < goal.speed <= MAX_SPEED, in accept.")
@hint("Take self.busy last of all: self.busy.acquire(blocking=False) says whether a goal is being driven.")
def test_reject(driver: Driver) -> None:
    """It rejects -0.5 m, and 0.6 m/s; while a goal is driven it rejects another one, and drives the first on."""
    for distance, speed in ((-0.5, 0.3), (0.5, 0.6)):
        goal = driver.send(distance, speed)
        accepted = bool(goal.accepted)
        if accepted:
            driver.abandon(goal)
        expect(not accepted, f"A goal of {distance} m at {speed} m/s was accepted.")
    first = driver.start(3.0, 0.25)
    driver.roll(first, 0.3)
    second = driver.send(0.4, 0.25)
    driver.roll(first, 0.3)
    is_running = first.result is None
    driver.abandon(first)
    expect(not second.accepted, "While a goal was driven, another one was accepted.")
    expect(is_running, "The first goal ended when another one came.")


@check(points=1, covers="stuck", group="action", needs=DRIVE, after=("drive",), doc=contract.ACTION)
@hint("Remember how far it had come, and when; a centimetre more sets both again.", "After PATIENCE: stop and abort.")
def test_stuck(driver: Driver) -> None:
    """Held at 0.45 m/s, the robot is stopped after a second, and the goal ends ABORTED with a reason."""
    driver.stuck = True
    goal = driver.start(2.0, 0.45)
    commands = driver.finish(goal, 6.0, "With a robot that is held")
    driver.stuck = False
    expect(goal.status == GoalStatus.STATUS_ABORTED, "The goal of a robot that is held did not end ABORTED.")
    expect(has_stopped(commands), "After the goal had been given up, the last command was no stop.")
    expect(bool(goal.result.reason.strip()), "The result gives no reason.")
