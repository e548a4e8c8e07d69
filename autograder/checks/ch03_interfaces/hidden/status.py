"""Checks of the status publisher: its topic, quality of service and rate, and its fields for each sensor."""

from __future__ import annotations

import math
import random

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import BatteryState

from autograder.checking import LOCKSTEP, ReceivedMessage, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checking.probes import late_joiner, message_period
from autograder.checks.ch03_interfaces.hidden.trips import INVALID_PERCENTAGES, PERCENTAGES, whole_percents
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import UNKNOWN
from autograder.checks.ch03_interfaces.support.driver_qos import expect_volatile
from autograder.checks.ch03_interfaces.support.reporter import BATTERY, JOINTS, PERIOD, TOPIC, Reporter, is_same_float32

check = group("status")
START_CHECKS = ("status_starts", "robot_status")
PUBLISH_CHECK = ("publishes_status",)
SOME_SECONDS = 5.0  # s to wait for a status, even if its period is wrong
SILENCE = 6.2  # s without sensor messages, so that a status is published more than 5 s after the last one
TUNED_PERIOD = 0.25  # s: the parameter status_period of the tuned publisher
TUNED_SECONDS = 3.0  # s in which the tuned publisher's statuses are counted


@check(points=1, covers="status-node", needs=("builds",), after=("generated",), doc=contract.DEFINE)
@hint("Start it with ros2 run my_robot_package status_publisher and read the last lines of its output.")
@hint("setup.py, which is given, names my_robot_package.nodes.status_publisher:main.")
def test_status_starts(reporter: Reporter) -> None:
    """The node status_publisher starts and spins, with the interfaces of my_robot_interfaces."""
    expect(bool(reporter.nodes()), "The program runs, but there is no node in the graph.")


@check(points=1, covers=("status-topic", "status-node"), needs=("status_starts",), doc=contract.DEFINE)
@hint("create_publisher(RobotStatus, 'robot_status', STATUS_QOS) in __init__.")
@hint("The name is the argument of super().__init__.")
def test_publishes_status(reporter: Reporter) -> None:
    """The node is called status_publisher, and publishes robot_status as my_robot_interfaces/msg/RobotStatus."""
    peers = reporter.node.get_publishers_info_by_topic(TOPIC)
    types = sorted({peer.topic_type for peer in peers})
    expected = f"{contract.INTERFACES}/msg/RobotStatus"
    offered_topics = sorted(
        topic
        for topic, _ in reporter.node.get_topic_names_and_types()
        if topic not in (BATTERY, JOINTS, "/rosout", "/parameter_events", "/clock")
    )
    expect(
        bool(types),
        f"There is no publisher on /robot_status; the node publishes on {', '.join(offered_topics) or 'no topic'}.",
    )
    expect(types == [expected], f"/robot_status has the type {', '.join(types)} instead of {expected}.")
    names = reporter.nodes()
    message = f"There is no node /{contract.STATUS}. Nodes in the graph: {', '.join(names) or 'none'}."
    expect(f"/{contract.STATUS}" in names, message, fraction=0.5)


@check(points=1, covers="status-topic", needs=START_CHECKS, after=PUBLISH_CHECK, doc=contract.QOS)
@hint("STATUS_QOS is defined above the class; use it instead of a number.")
def test_status_for_late_joiners(reporter: Reporter) -> None:
    """Its quality of service keeps the last status for nodes that join late."""
    peers = reporter.node.get_publishers_info_by_topic(TOPIC)
    expect(bool(peers), "There is no publisher on /robot_status.")
    for peer in peers:
        is_durable = peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        is_reliable = peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        expect(is_durable, "A node that joins late gets no status: the publisher's durability is volatile.")
        expect(is_reliable, "The publisher's reliability is best effort instead of reliable.")
    if reporter.time == LOCKSTEP:  # in real time, the node publishes while the other node joins
        reporter.run(2.2)  # so that there are several statuses to keep
        count = late_joiner.count_kept_messages(reporter.node, TOPIC, reporter.types.robot_status)
        expect(count == 1, f"A node that joined late got {count} messages, not only the last one.", fraction=0.5)


@check(points=1, covers=("status-topic", "status-period", "newest"), needs=START_CHECKS, after=PUBLISH_CHECK)
@hint("create_timer(period, self.publish_status), with the period that read_parameters() returns.")
def test_status_rate(reporter: Reporter, tuned_reporter: Reporter) -> None:
    """It publishes once a second, or with the period that the parameter status_period has."""
    start = reporter.seconds
    for _ in range(10):
        reporter.publish_battery(0.5)
        reporter.publish_joints([0.5])
        reporter.run(0.1)
    sensor_end = reporter.seconds
    statuses = _statuses(reporter, SILENCE)
    is_paced = message_period.is_paced(statuses, PERIOD, reporter.time)
    expect(is_paced, f"It published a status {message_period.describe_pace(statuses)}, instead of every second.")
    count = len(reporter.messages(TOPIC, since=start, until=sensor_end))
    message = f"With ten sensor messages a second, it published {count} statuses in a second, instead of 1."
    expect(count <= 3, message, fraction=0.5)
    later_statuses = [received.message for received in reporter.messages(TOPIC, since=sensor_end)]
    first_values, last_values = (
        (status.battery_level, list(status.joint_positions)) for status in (later_statuses[0], later_statuses[-1])
    )
    change = f"level and joints changed from {first_values} to {last_values}"
    message = f"Within {SILENCE} s after the last message of each sensor, {change}."
    expect(first_values == last_values, f"{message} The newest message counts, however old it is.", fraction=0.5)
    statuses = _statuses(tuned_reporter, TUNED_SECONDS)
    is_paced = message_period.is_paced(statuses, TUNED_PERIOD, tuned_reporter.time)
    expect(
        is_paced,
        f"With a status_period of {TUNED_PERIOD} s, it published a status {message_period.describe_pace(statuses)}.",
        fraction=0.5,
    )


@check(
    points=1,
    covers="status-stamp",
    needs=START_CHECKS,
    after=PUBLISH_CHECK,
    doc="https://docs.ros.org/en/jazzy/p/std_msgs/msg/Header.html",
)
@hint("msg.header.stamp = self.get_clock().now().to_msg(), in publish_status.")
def test_status_stamp(fast_clock_reporter: Reporter) -> None:
    """The stamp of each status is the time at which it was put together, by the node's clock."""
    fast_clock_reporter.publish_battery(0.5)
    fast_clock_reporter.publish_joints([0.5])
    fast_clock_reporter.run(0.5)  # so that the sensor messages' time of arrival would be a wrong stamp
    stamp = fast_clock_reporter.status().header.stamp
    receive_time = fast_clock_reporter.messages(TOPIC)[-1].seconds
    age = (
        fast_clock_reporter.now_ns / 1e9
        - (fast_clock_reporter.seconds - receive_time)
        - (stamp.sec + stamp.nanosec / 1e9)
    )
    expect(stamp.sec != 0, "header.stamp is 0: it was never set.")
    fraction = 0.5 if abs(age) < 1.0 else 0.0  # a stamp that lacks its nanoseconds
    difference = f"{abs(age):.1f} s {'older' if age > 0 else 'newer'} than the message"
    expect(abs(age) <= 0.2, f"header.stamp is {difference}.", fraction=fraction)


@check(points=2, covers="unknown", needs=START_CHECKS, after=PUBLISH_CHECK, doc=contract.BATTERY)
@hint("No message does not mean an empty battery: start with self.battery = None, and publish BATTERY_UNKNOWN.")
def test_status_unknown(silent_reporter: Reporter, tuned_reporter: Reporter) -> None:
    """Before the first sensor message, battery_level is -1, is_charging is False, and joint_positions is empty."""
    status = silent_reporter.status()
    expect(status.battery_level == UNKNOWN, f"battery_level is {status.battery_level} instead of {UNKNOWN}.")
    expect(not status.is_charging, "is_charging is True before the first battery state.")
    count = len(status.joint_positions)
    expect(count == 0, f"joint_positions has {count} values before the first joint state.")
    silent_reporter.publish_joints([0.5])
    _expect_status(silent_reporter, "a joint state, but no battery state", UNKNOWN, False, [0.5])
    tuned_reporter.publish_battery(0.5, status=BatteryState.POWER_SUPPLY_STATUS_CHARGING)
    _expect_status(tuned_reporter, "a battery state, but no joint state", 50, True, [])


def _expect_status(reporter: Reporter, messages: str, level: int, is_charging: bool, positions: list[float]) -> None:
    """Fail the check unless the next status has these values; `messages` says what has arrived."""
    status = reporter.status()
    actual = status.battery_level, status.is_charging, [round(position, 3) for position in status.joint_positions]
    expected = level, is_charging, positions
    fields = "battery_level, is_charging and joint_positions"
    expect(actual == expected, f"After {messages}, {fields} are {actual} instead of {expected}.", fraction=0.5)


@check(points=1, covers="status-name", needs=START_CHECKS, after=PUBLISH_CHECK)
@hint("self.robot_name comes from read_parameters(); put it into each message.")
def test_status_name(tuned_reporter: Reporter, tuned_name: str) -> None:
    """robot_name in the status is the value of the parameter robot_name."""
    tuned_reporter.until(lambda: bool(tuned_reporter.messages(TOPIC)), SOME_SECONDS)
    statuses = tuned_reporter.messages(TOPIC)
    expect(bool(statuses), f"No message was published on robot_status for {SOME_SECONDS:.0f} s.")
    actual = statuses[-1].message.robot_name
    expect(actual == tuned_name, f"robot_name in the status is {actual!r}, but the parameter is {tuned_name!r}.")


@check(
    points=2,
    covers=("battery-topic", "percent", "newest"),
    needs=START_CHECKS,
    after=PUBLISH_CHECK,
    doc=contract.BATTERY,
)
@hint("percentage goes from 0.0 to 1.0; 0.855 is 86 percent.")
@hint("math.floor(percentage * 100.0 + 0.5) rounds halves up; int() would round down.")
def test_status_battery(reporter: Reporter, draw: random.Random) -> None:
    """battery_level is the charge of the newest battery state in whole percent."""
    for percentage in (0.0, 1.0, 0.8549):
        _expect_level(reporter, percentage, before=draw.random())
    expect_each(
        PERCENTAGES,
        lambda drawn: _expect_level(reporter, drawn, before=draw.random()),
        draw,
        count=_case_count(reporter, 16),
    )
    expect_volatile(reporter.node, BATTERY)


def _case_count(reporter: Reporter, count: int) -> int:
    """Return how many drawn cases a check can afford: fewer in real time."""
    return count if reporter.time == LOCKSTEP else 4


def _expect_level(reporter: Reporter, percentage: float, before: float, fraction: float = 0.0) -> None:
    """Fail the check unless the status has the level of the second of two battery states."""
    reporter.publish_battery(before)
    reporter.publish_battery(percentage)
    actual = reporter.status().battery_level
    expected = whole_percents(percentage)
    message = f"At percentage {percentage:.7g}, battery_level is {actual}, not {' or '.join(map(str, expected))}."
    expect(actual in expected, message, fraction=fraction)


@check(points=1, covers="percent-unknown", needs=START_CHECKS, after=PUBLISH_CHECK, doc=contract.BATTERY)
@hint("A driver publishes nan if it does not know the percentage. nan is not between 0.0 and 1.0.")
def test_status_bad_battery(reporter: Reporter, draw: random.Random) -> None:
    """battery_level is -1 if the percentage is nan or outside 0 to 1."""
    _expect_level(reporter, math.nan, before=0.5)
    expect_each(
        INVALID_PERCENTAGES,
        lambda drawn: _expect_level(reporter, drawn, before=0.5, fraction=0.5 * (drawn > 2.0)),
        draw,
        count=_case_count(reporter, 8),
    )


@check(points=1, covers="charging", needs=START_CHECKS, after=PUBLISH_CHECK, doc=contract.BATTERY)
@hint("Compare power_supply_status with BatteryState.POWER_SUPPLY_STATUS_CHARGING.")
def test_status_charging(reporter: Reporter) -> None:
    """is_charging follows the battery's power_supply_status."""
    for name in ("CHARGING", "DISCHARGING", "FULL", "NOT_CHARGING", "UNKNOWN"):
        reporter.publish_battery(0.5, status=getattr(BatteryState, f"POWER_SUPPLY_STATUS_{name}"))
        actual = reporter.status().is_charging
        expect(actual is (name == "CHARGING"), f"is_charging is {actual} while power_supply_status is {name}.")
    reporter.publish_battery(math.nan, status=BatteryState.POWER_SUPPLY_STATUS_CHARGING)
    actual = reporter.status().is_charging
    expect(actual, "is_charging is False for a battery of unknown level that is charging.", fraction=0.5)


@check(points=1, covers=("joint-topic", "newest"), needs=START_CHECKS, after=PUBLISH_CHECK)
@hint("If a joint state has arrived, msg.joint_positions = list(self.joints.position).")
def test_status_joints(reporter: Reporter, draw: random.Random) -> None:
    """joint_positions holds all positions of the newest joint state."""
    for count in (draw.randrange(2, 6), draw.randrange(6, 12), 0):
        positions = [draw.uniform(-3.0, 3.0) for _ in range(count)]
        reporter.publish_joints(positions)
        actual = list(reporter.status().joint_positions)
        is_correct = len(actual) == count and all(map(is_same_float32, actual, positions))
        expect(
            is_correct,
            f"With {count} positions, joint_positions is {_shorten(actual)} instead of {_shorten(positions)}.",
        )
    expect_volatile(reporter.node, JOINTS)


def _statuses(reporter: Reporter, seconds: float) -> list[ReceivedMessage]:
    """Return the statuses of the next `seconds`."""
    start = reporter.seconds
    reporter.run(seconds)
    return reporter.messages(TOPIC, since=start)


def _shorten(numbers: list[float]) -> str:
    return "[" + ", ".join(f"{number:.3f}" for number in numbers[:4]) + (", …]" if len(numbers) > 4 else "]")
