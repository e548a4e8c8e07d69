"""The status publisher on the wire: topic, quality of service, rate, and what it makes of the sensors."""

from __future__ import annotations

import math
import random

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import BatteryState

from autograder.checking import LOCKSTEP, ReceivedMessage, expect, group, hint
from autograder.checking.probes import late_joiner, message_period
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import UNKNOWN
from autograder.checks.ch03_interfaces.support.driver_qos import expect_heard
from autograder.checks.ch03_interfaces.support.reporter import BATTERY, JOINTS, PERIOD, TOPIC, Reporter, same

check = group("status")
NEEDS = ("status_starts", "robot_status")
AFTER = ("publishes_status",)
CASES = 4
SOME_SECONDS = 5.0  # until a status has come, even where its period is wrong
SILENCE = 6.2  # s, so that a status comes more than 5 s after the sensors
TUNED_PERIOD = 0.25  # s
TUNED_SECONDS = 3.0


@check(points=1, covers="status-node", needs=("builds",), after=("generated",), doc=contract.DEFINE)
@hint("Start it with ros2 run my_robot_package status_publisher and read its last lines.")
@hint("setup.py is given: it names my_robot_package.nodes.status_publisher:main.")
def test_status_starts(reporter: Reporter) -> None:
    """The node status_publisher starts with the interfaces of my_robot_interfaces, and spins."""
    expect(bool(reporter.nodes()), "The program runs, and the graph holds no node.")


@check(points=1, covers=("status-topic", "status-node"), needs=("status_starts",), doc=contract.DEFINE)
@hint("create_publisher(RobotStatus, 'robot_status', STATUS_QOS) in __init__.")
@hint("The name is the argument of super().__init__.")
def test_publishes_status(reporter: Reporter) -> None:
    """It is called status_publisher, and publishes robot_status as my_robot_interfaces/msg/RobotStatus."""
    peers = reporter.node.get_publishers_info_by_topic(TOPIC)
    there = sorted({peer.topic_type for peer in peers})
    wanted = f"{contract.INTERFACES}/msg/RobotStatus"
    offered = sorted(
        topic
        for topic, _ in reporter.node.get_topic_names_and_types()
        if topic not in (BATTERY, JOINTS, "/rosout", "/parameter_events", "/clock")
    )
    expect(bool(there), f"Nobody publishes on /robot_status; the node publishes on {', '.join(offered) or 'no topic'}.")
    expect(there == [wanted], f"/robot_status carries {', '.join(there)}, it should carry {wanted}.")
    names = reporter.nodes()
    said = f"The graph holds {', '.join(names) or 'no node'}, but no status_publisher."
    expect(f"/{contract.STATUS}" in names, said, fraction=0.5)


@check(points=1, covers="status-topic", needs=NEEDS, after=AFTER, doc=contract.QOS)
@hint("STATUS_QOS is defined above the class; use it instead of a number.")
def test_status_for_late_joiners(reporter: Reporter) -> None:
    """Its quality of service keeps the last status for whoever joins late."""
    peers = reporter.node.get_publishers_info_by_topic(TOPIC)
    expect(bool(peers), "Nobody publishes on /robot_status.")
    for peer in peers:
        durable = peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        reliable = peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        expect(durable, "A watcher that joins late gets nothing: the publisher's durability is volatile.")
        expect(reliable, "The publisher sends best effort; a status should arrive.")
    if reporter.time == LOCKSTEP:  # elsewhere it publishes while one joins
        reporter.run(2.2)  # so that there are several that it could keep
        kept = late_joiner.kept_messages(reporter.node, TOPIC, reporter.types.robot_status)
        expect(kept == 1, f"A watcher that joins late got {kept} messages, not the last one alone.", fraction=0.5)


@check(points=1, covers=("status-topic", "status-period", "newest"), needs=NEEDS, after=AFTER)
@hint("create_timer(period, self.publish_status), with the period that read_parameters() returns.")
def test_status_rate(reporter: Reporter, tuned_reporter: Reporter) -> None:
    """It publishes once a second, and at another rate when status_period says so."""
    began = reporter.seconds
    for _ in range(10):
        reporter.publish_battery(0.5)
        reporter.publish_joints([0.5])
        reporter.run(0.1)
    spoken = reporter.seconds
    seen = _messages(reporter, SILENCE)
    paced = message_period.is_paced(seen, PERIOD, reporter.time)
    expect(paced, f"Statuses came {message_period.describe_pace(seen)}, instead of every second.")
    count = len(reporter.messages(TOPIC, since=began, until=spoken))
    said = f"While the sensors spoke ten times a second, {count} statuses came in a second, instead of 1."
    expect(count <= 3, said, fraction=0.5)
    heard = [received.message for received in reporter.messages(TOPIC, since=spoken)]
    first, last = ((status.battery_level, list(status.joint_positions)) for status in (heard[0], heard[-1]))
    said = f"Within {SILENCE} s after the last message of each sensor, level and joints went from {first} to {last}."
    expect(first == last, f"{said} The newest message counts, however old it is.", fraction=0.5)
    seen = _messages(tuned_reporter, TUNED_SECONDS)
    paced = message_period.is_paced(seen, TUNED_PERIOD, tuned_reporter.time)
    expect(
        paced, f"With status_period {TUNED_PERIOD} s, statuses came {message_period.describe_pace(seen)}.", fraction=0.5
    )


@check(
    points=1,
    covers="status-stamp",
    needs=NEEDS,
    after=AFTER,
    doc="https://docs.ros.org/en/jazzy/p/std_msgs/msg/Header.html",
)
@hint("msg.header.stamp = self.get_clock().now().to_msg(), in publish_status.")
def test_status_stamp(hasty_reporter: Reporter) -> None:
    """Each status carries the time at which it was put together, by the node's clock."""
    hasty_reporter.publish_battery(0.5)
    hasty_reporter.publish_joints([0.5])
    hasty_reporter.run(0.5)  # so that the time at which a sensor was heard is another one, too
    stamp = hasty_reporter.status().header.stamp
    newest = hasty_reporter.messages(TOPIC)[-1].seconds
    age = hasty_reporter.now_ns / 1e9 - (hasty_reporter.seconds - newest) - (stamp.sec + stamp.nanosec / 1e9)
    expect(stamp.sec != 0, "header.stamp is 0: it was never set.")
    fraction = 0.5 if abs(age) < 1.0 else 0.0  # a stamp without its nanoseconds
    than = f"{abs(age):.1f} s {'older' if age > 0 else 'newer'} than the message"
    expect(abs(age) <= 0.2, f"header.stamp is {than}.", fraction=fraction)


@check(points=2, covers="unknown", needs=NEEDS, after=AFTER, doc=contract.BATTERY)
@hint("No message is not an empty battery: start with self.battery = None, and say BATTERY_UNKNOWN.")
def test_status_unknown(silent_reporter: Reporter) -> None:
    """Before any sensor has spoken the battery is unknown, not charging, and there are no joints."""
    status = silent_reporter.status()
    expect(status.battery_level == UNKNOWN, f"battery_level is {status.battery_level}, it should be {UNKNOWN}.")
    expect(not status.is_charging, "is_charging is true, and nothing has said so.")
    expect(len(status.joint_positions) == 0, f"There are {len(status.joint_positions)} joints, from nowhere.")


@check(points=1, covers="status-name", needs=NEEDS, after=AFTER)
@hint("self.robot_name comes from read_parameters(); put it into each message.")
def test_status_name(tuned_reporter: Reporter, tuned_name: str) -> None:
    """The status carries the name that the parameter robot_name holds."""
    tuned_reporter.until(lambda: bool(tuned_reporter.messages(TOPIC)), SOME_SECONDS)
    heard = tuned_reporter.messages(TOPIC)
    expect(bool(heard), f"No message came on robot_status for {SOME_SECONDS:.0f} s.")
    said = heard[-1].message.robot_name
    expect(said == tuned_name, f"With robot_name {tuned_name!r} the status says {said!r}.")


@check(points=2, covers=("battery-topic", "percent", "newest"), needs=NEEDS, after=AFTER, doc=contract.BATTERY)
@hint("percentage goes from 0.0 to 1.0; 0.855 is 86 percent.")
@hint("math.floor(percentage * 100.0 + 0.5) rounds halves up; int() would cut.")
def test_status_battery(reporter: Reporter, draw: random.Random) -> None:
    """battery_level is the newest battery state in whole percent."""
    levels = [0, 100, *(draw.randrange(1, 100) for _ in range(CASES))]
    for number, level in enumerate(levels):
        offset = (-0.47, 0.47)[number % 2] if 0 < level < 100 else 0.0
        reporter.publish_battery(draw.random())
        reporter.publish_battery((level + offset) / 100.0)
        said = reporter.status().battery_level
        expect(
            said == level, f"At percentage {(level + offset) / 100.0:.3f} battery_level is {said}, instead of {level}."
        )
    expect_heard(reporter.node, BATTERY)
    for half in (0.125, 0.625):  # exactly halfway between two percents, also as a float32
        reporter.publish_battery(half)
        said, up = reporter.status().battery_level, math.ceil(half * 100.0)
        expect(said == up, f"At percentage {half} battery_level is {said}, instead of {up}: halves go up.")


@check(points=1, covers="percent-unknown", needs=NEEDS, after=AFTER, doc=contract.BATTERY)
@hint("A driver says nan when it does not know; nan is not between 0.0 and 1.0.")
def test_status_bad_battery(reporter: Reporter, draw: random.Random) -> None:
    """A percentage that is nan or outside 0 to 1 is unknown."""
    near, far = draw.uniform(0.001, 0.004), draw.uniform(0.02, 0.09)  # a percentage that is near would round into it
    for percentage in (math.nan, 1.0 + far, -far, 1.0 + near, -near, 85.0, math.inf):
        reporter.publish_battery(0.5)
        reporter.run(0.1)
        reporter.publish_battery(percentage)
        said = reporter.status().battery_level
        sentence = f"At percentage {percentage:.4f} battery_level is {said}, instead of {UNKNOWN}."
        expect(said == UNKNOWN, sentence, fraction=0.5 if percentage > 2.0 else 0.0)


@check(points=1, covers="charging", needs=NEEDS, after=AFTER, doc=contract.BATTERY)
@hint("Compare power_supply_status with BatteryState.POWER_SUPPLY_STATUS_CHARGING.")
def test_status_charging(reporter: Reporter) -> None:
    """is_charging follows the battery's power_supply_status."""
    for name in ("CHARGING", "DISCHARGING", "FULL", "NOT_CHARGING"):
        reporter.publish_battery(0.5, status=getattr(BatteryState, f"POWER_SUPPLY_STATUS_{name}"))
        said = reporter.status().is_charging
        expect(said is (name == "CHARGING"), f"is_charging is {said} while power_supply_status is {name}.")
    reporter.publish_battery(math.nan, status=BatteryState.POWER_SUPPLY_STATUS_CHARGING)
    said = reporter.status().is_charging
    expect(said, "is_charging is False while the battery is charging, and does not say its level.", fraction=0.5)


@check(points=1, covers=("joint-topic", "newest"), needs=NEEDS, after=AFTER)
@hint("msg.joint_positions = list(self.joints.position), when there are joints.")
def test_status_joints(reporter: Reporter, draw: random.Random) -> None:
    """joint_positions are the newest joint state's positions, as many as there are."""
    for count in (draw.randrange(2, 6), draw.randrange(6, 12), 0):
        positions = [draw.uniform(-3.0, 3.0) for _ in range(count)]
        reporter.publish_joints(positions)
        said = list(reporter.status().joint_positions)
        right = len(said) == count and all(map(same, said, positions))
        expect(right, f"Of {count} positions, joint_positions holds {_some(said)} instead of {_some(positions)}.")
    expect_heard(reporter.node, JOINTS)


def _messages(reporter: Reporter, seconds: float) -> list[ReceivedMessage]:
    """Return what the reporter publishes in the next `seconds`."""
    began = reporter.seconds
    reporter.run(seconds)
    return reporter.messages(TOPIC, since=began)


def _some(numbers: list[float]) -> str:
    return "[" + ", ".join(f"{number:.3f}" for number in numbers[:4]) + (", …]" if len(numbers) > 4 else "]")
