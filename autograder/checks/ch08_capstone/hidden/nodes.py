"""Step 2, the nodes: what they hear, what they say, and how they look in the graph."""

from __future__ import annotations

import math
import random

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from std_srvs.srv import SetBool

from autograder.checks import CheckFailed, expect, group, hint
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, Part, scan
from autograder.checks.ch08_capstone.hidden.edges import (
    OPEN,
    expect_exact_limits,
    newest_clearance,
    said_of_edge,
    said_of_empty,
    said_of_limits,
)
from autograder.checks.ch08_capstone.hidden.graph import expect_endpoints, names_of
from autograder.checks.ch08_capstone.hidden.standstill import beside, expect_turn_kept
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    CONTROLLER,
    MONITOR,
    PARAMETERS,
    PROCESSOR,
    PROGRAMS,
    TOLERANCE,
)
from autograder.checks.ch08_capstone.support.system import (
    SharedSystem,
    System,
    expect_driving,
    expect_still,
    expect_turning,
)
from autograder.harness import Workspace
from autograder.probes.message_period import is_paced, mean_period
from autograder.probes.namespaces import missing_in_namespace
from autograder.time_record import LOCKSTEP

check = group("step_2")
BUILT = ("build", "clearance_message", "interface_package")
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN = PARAMETERS[CONTROLLER]["turn_speed"].default
NEAR = PARAMETERS[CONTROLLER]["safety_distance"].default
STALE = PARAMETERS[CONTROLLER]["data_timeout"].default
MARGIN = 0.09  # s around a time-out, a little less than the time between two commands
REAL_MARGIN = 0.25  # s, where time is real
AHEAD = 1.0  # s, more than a time-out
EDGE = 0.03  # m around the safety distance, a twentieth of it
BLIND = scan(Part(-35.0, 35.0, math.nan))
ENDS = (
    "Start the node in a terminal and look: ros2 node info /navigation_controller.",
    "Relative names, without a slash: create_publisher(Twist, 'cmd_vel', 10).",
)


@check(points=1, holds="processor-name", depends=BUILT, doc=contract.NODES_DOC)
@hint(*ENDS)
def test_processor(shared_system: SharedSystem) -> None:
    """The node sensor_processor has its name, and its topics with their types."""
    expect_endpoints(shared_system.get(PROCESSOR).harness.node, PROCESSOR)


@check(points=1, holds="controller-name", depends=BUILT, doc=contract.NODES_DOC)
@hint(*ENDS)
def test_controller(shared_system: SharedSystem) -> None:
    """The node navigation_controller has its name, and its topics and its service with their types."""
    expect_endpoints(shared_system.get(CONTROLLER).harness.node, CONTROLLER)


@check(points=1, holds="monitor-name", depends=(*BUILT, "health_message"), doc=contract.NODES_DOC)
@hint(*ENDS)
def test_monitor(shared_system: SharedSystem) -> None:
    """The node status_monitor has its name, and its topics with their types."""
    expect_endpoints(shared_system.get(MONITOR).harness.node, MONITOR)


@check(points=1, holds="relative", depends=("processor", "controller", "monitor"), doc=contract.NODES_DOC)
@hint("A name that begins with a slash is the same in every namespace: two robots would share it.")
@hint("'scan' is relative, '/scan' is not.")
def test_relative(workspace: Workspace) -> None:
    """All names are relative: in a namespace, each node takes its topics and its service with it."""
    left = [
        said for name in PROGRAMS if (said := missing_in_namespace(workspace, contract.PACKAGE, name, names_of(name)))
    ]
    expect(not left, " ".join(left))


@check(points=2, holds=("processor", "late-joiner"), depends=("processor", "monitor"), doc=contract.QOS_DOC)
@hint("A lidar publishes best-effort: whoever subscribes to scan takes qos_profile_sensor_data.")
@hint("QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) keeps the last report for late joiners.")
def test_qos(shared_system: SharedSystem) -> None:
    """A best-effort lidar reaches its two listeners, and a late joiner gets the last report of health."""
    graph = shared_system.get(PROCESSOR, MONITOR).harness.node
    for peer in graph.get_subscriptions_info_by_topic("/scan"):
        reliable = peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        expect(not reliable, f"{peer.node_name} asks for reliable scans: it would get none from a lidar.", fraction=0.5)
    for peer in graph.get_publishers_info_by_topic("/health"):
        durable = peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        expect(durable, f"{peer.node_name} keeps no report of health: its durability is volatile.", fraction=0.5)


@check(
    points=2,
    holds=("sector", "processor", "clearance-header", "front", "left", "right"),
    depends=("processor",),
    doc=contract.SCAN_DOC,
)
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi]; left is positive.")
@hint("The middles are 0, pi/2 and -pi/2; a beam within half_angle of one belongs to its sector, any other to none.")
def test_sectors(seeing: System, draw: random.Random) -> None:
    """Each scan becomes one clearance: the nearest thing ahead, on the left and on the right, and the scan's header."""
    for beams, first in ((360, 0.0), (draw.randrange(500, 700), -180.0)):
        distances = {name: round(draw.uniform(0.7, 2.0), 2) for name in ("front", "left", "right")}
        places = {"front": draw.uniform(-24, 20), "left": draw.uniform(66, 110), "right": draw.uniform(-114, -70)}
        parts = [Part(places[name], places[name] + 4.0, distance) for name, distance in distances.items()]
        shown = scan(*parts, Part(130.0, 170.0, 0.4), Part(35.0, 55.0, 0.4), beams=beams, first_bearing=first)
        shown.header.frame_id = draw.choice(("laser", "base_scan", "lidar_top"))
        said = seeing.see(shown).clearances
        expect(bool(said), "No clearance came while scans did.")
        newest = said[-1].message
        for name, wanted in distances.items():
            given = getattr(newest, name)
            expect(
                abs(given - wanted) <= TOLERANCE,
                f"With the nearest thing {wanted:.2f} m away at {places[name] + 2:.0f}°, in a scan that starts at "
                f"{first:.0f}°, {name} was {given:.2f}.",
                fraction=0.25,
            )
        expect(bool(newest.valid), "With a reading from every beam, valid was false.", fraction=0.5)
        frame = newest.header.frame_id
        expect(
            frame == shown.header.frame_id and newest.header.stamp.sec > 0,
            f"The header is not the scan's own: frame {frame!r}, stamp {newest.header.stamp.sec} s.",
            fraction=0.5,
        )
    began = seeing.seconds
    seeing.see(OPEN, 1.0)
    count = len(seeing.messages(began).clearances)
    expect(9 <= count <= 11, f"10 scans became {count} clearances.", fraction=0.5)


@check(points=3, holds=("readings", "no-reading", "valid-field", "sector"), depends=("sectors",), doc=contract.REP_117)
@hint("min([nan, 0.5]) is nan: leave nan out first. Finite readings count from range_min to range_max only.")
@hint("min(readings, default=math.nan): a sector without a reading that counts is nan, and valid is false then.")
def test_readings(seeing: System, draw: random.Random) -> None:
    """Readings count by REP 117, and a sector without one that counts makes the clearance invalid."""
    bearing, wall = draw.uniform(-20.0, 10.0), draw.uniform(0.8, 1.6)
    hole = (bearing, bearing + 4.0)
    cases = (
        ("a few nan beams before a wall", (*hole, math.nan), wall),
        ("a few readings of 0.0 before a wall", (*hole, 0.0), wall),
        ("a few readings below range_min before a wall", (*hole, 0.05), wall),
        ("a few readings above range_max before a wall", (*hole, RANGE_MAX + 1.0), wall),
        ("+inf from a few beams before a wall", (*hole, math.inf), wall),
        ("-inf from a few beams", (*hole, -math.inf), -math.inf),
    )
    wrong = []
    for number, (what, (first, last, reading), wanted) in enumerate(cases):
        aside = (3.0, math.inf)[number % 2]
        newest = newest_clearance(seeing, scan(Part(-25.0, 25.0, wall), Part(first, last, reading), fill=aside))
        if not (newest.valid and (newest.front == wanted or abs(newest.front - wanted) <= TOLERANCE)):
            wrong.append(f"With {what} at {wall:.2f} m, front was {newest.front:.2f} and valid {newest.valid}.")
    blind = (("ahead", (-35.0, 35.0)), ("on the left", (55.0, 125.0)), ("on the right", (-125.0, -55.0)))
    phantoms = draw.sample((math.nan, 0.0, RANGE_MAX + 1.0), len(blind))
    for (where, (first, last)), reading in zip(blind, phantoms, strict=True):
        newest = newest_clearance(seeing, scan(Part(first, last, reading)))
        if newest.valid:
            wrong.append(f"With nothing but {reading:g} {where}, which does not count, valid was true.")
    edges = ((28.0, 1.0), (31.0, 3.0), (-29.0, 1.0), (-32.0, 3.0))  # half_angle is 29.8°
    for first, wanted in edges:
        front = newest_clearance(seeing, scan(Part(first, first + 1.0, 1.0))).front
        if abs(front - wanted) > TOLERANCE:
            wrong.append(f"With something 1.00 m away at {first:.0f}° to {first + 1.0:.0f}°, front was {front:.2f}.")
    wrong += said_of_edge(seeing) + said_of_limits(seeing) + said_of_empty(seeing)
    if wrong:
        total = len(cases) + len(blind) + len(edges) + 4
        raise CheckFailed(" ".join(wrong[:2]), fraction=round(max(0.0, 1.0 - len(wrong) / total), 2) * 0.9)


@check(points=2, holds=("drive", "ten-hertz", "stand-or-go"), depends=("sectors", "controller"), doc=contract.NODES_DOC)
@hint("The way is clear: linear.x is forward_speed.")
@hint("The timer calls control ten times a second, and control publishes once each time, whatever happens.")
def test_drives(driving: System, draw: random.Random) -> None:
    """It drives forward while the way is clear, with ten commands a second."""
    distance = draw.uniform(0.9, 3.0)
    began = driving.seconds
    said = driving.see(scan(fill=distance), 2.0)
    expect_driving(said.commands, f"With {distance:.2f} m of free space all around", SPEED)
    rate = driving.harness.rate("/cmd_vel", began)
    expect(9.0 <= rate <= 11.0, f"It published {rate:.1f} commands a second, instead of 10.", fraction=0.5)


@check(points=3, holds=("turn", "more-room", "keeps-turn", "starts-turn", "ends-turn"), depends=("drives",))
@hint("Compare left with right when the turn begins, and remember the choice.")
@hint("The remembered turn ends when the way is clear again, not when the sides look different.")
def test_turns(driving: System, draw: random.Random) -> None:
    """In front of an obstacle it turns towards the side with more room, and keeps the direction until it is clear."""
    for side, sign in (("left", 1.0), ("right", -1.0)):
        driving.see(OPEN)
        near, tight = draw.uniform(0.25, NEAR - 0.1), draw.uniform(0.7, 1.2)
        obstacle = Part(-10.0, 10.0, near)
        narrow, other = beside(-sign, tight), beside(sign, tight - 0.4)
        situation = f"With something {near:.2f} m ahead and less room on the {'right' if sign > 0 else 'left'}"
        expect_turning(driving.see(scan(obstacle, narrow)).commands, situation, side, TURN)
        later = f"{situation}, once it turns and the sides have changed,"
        expect_turning(driving.see(scan(obstacle, narrow, other)).commands, later, side, TURN, fraction=0.5)
        expect_driving(driving.see(OPEN).commands, "When the way is clear again", SPEED, fraction=0.5)
    for near in (NEAR + EDGE, NEAR - EDGE):
        driving.see(OPEN)
        said = driving.see(scan(Part(-10.0, 10.0, near), fill=math.inf)).commands  # the same room on both sides
        situation = f"With something {near:.2f} m ahead, and a safety distance of {NEAR:.2f} m"
        if near > NEAR:
            expect_driving(said, situation, SPEED, fraction=0.5)
        else:
            expect_turning(said, situation, "left", TURN, fraction=0.5)
    expect_exact_limits(driving)
    expect_turn_kept(driving, lambda: driving.see(BLIND), "When it saw again after nan from every beam ahead")


@check(points=3, holds=("untrusted", "newest"), depends=("drives",))
@hint("No clearance yet, one that is not valid, one that is too old: publish Twist() as it is.")
@hint("Its age is self.get_clock().now() - Time.from_msg(clearance.header.stamp), however late it came.")
def test_stops(driving: System, slow_system: SharedSystem) -> None:
    """It stands still before the first scan, with an invalid clearance, and with one that is too old."""
    expect_still(driving.first.commands, "Before the first scan")
    driving.see(OPEN)
    expect_still(driving.see(BLIND).commands, "With nan from every beam ahead", fraction=0.25)
    driving.see(OPEN)
    margin = MARGIN if driving.harness.time == LOCKSTEP else REAL_MARGIN
    began = driving.seconds
    driving.wait(2.0)
    fresh = driving.messages(began, began + STALE - margin).commands
    expect_driving(fresh, f"Less than {STALE} s after the last scan", SPEED, fraction=0.5)
    late = driving.messages(began + STALE + margin).commands
    expect_still(late, f"More than {STALE} s after the last scan", fraction=0.5)
    driving.see(OPEN)
    old = driving.see(OPEN, 1.5, age=1.0).commands
    expect_still(old[-5:], "With scans that come late, 1.0 s after they were taken,", fraction=0.75)
    if driving.harness.time == LOCKSTEP:  # elsewhere the machine's clocks are as they are
        slow = slow_system.get(PROCESSOR, CONTROLLER)
        slow.see(OPEN)
        slow.wait(STALE + margin)
        still = slow.wait(1.0).commands
        expect_still(still, f"More than {STALE} s of ROS time after the last scan", fraction=0.75)


@check(points=1, holds="untrusted", depends=("stops",))
@hint("The lidar's computer has a clock of its own. A stamp that is ahead of yours gives an age below 0.")
@hint("An age below 0 is not more than data_timeout: no abs().")
def test_stamp_ahead(driving: System) -> None:
    """It trusts a clearance whose stamp is ahead of its clock: that is not old."""
    said = driving.see(OPEN, 1.5, age=-AHEAD).commands
    expect_driving(said, f"With scans whose stamp is {AHEAD} s ahead of the clock", SPEED)


@check(points=2, holds=("enable", "disabled", "keeps-turn", "ten-hertz"), depends=("drives",), doc=contract.SERVICE_DOC)
@hint("self.create_service(SetBool, 'enable', self.enable_callback)")
@hint("The callback remembers request.data and returns the response with success = True.")
@hint("Held still, the robot does not choose a turn anew, and does not forget the one that it has begun.")
def test_enable(driving: System, shared_system: SharedSystem) -> None:
    """The service enable holds the robot still, and lets it go again."""
    try:
        _hold_and_release(driving)
    except CheckFailed:
        shared_system.close()  # a robot that is still held would fail what follows
        raise


def _hold_and_release(system: System) -> None:
    system.see(OPEN)
    answer = system.call(SetBool, "/enable", SetBool.Request(data=True))
    expect(answer.success, "Asked to drive while it drove, it answered success = false.", fraction=0.5)
    answer = system.call(SetBool, "/enable", SetBool.Request(data=False))
    expect(answer.success, "Asked to hold still, it answered success = false.")
    held = system.see(OPEN, 1.7).commands
    expect_still(held, "After enable with data: false")
    period = mean_period(held)
    said = f"Held still, it published a command every {period:.3f} s, instead of ten a second."
    expect(is_paced(period, 0.1, system.harness.time), said, fraction=0.75)
    answer = system.call(SetBool, "/enable", SetBool.Request(data=True))
    expect(answer.success, "Asked to drive again, it answered success = false.", fraction=0.5)
    expect_driving(system.see(OPEN).commands, "After enable with data: true", SPEED, fraction=0.5)
    expect_turn_kept(system, lambda: _hold(system), "Let go after it was held still")


def _hold(system: System) -> None:
    """Hold the robot still for a moment, and let it go."""
    system.call(SetBool, "/enable", SetBool.Request(data=False))
    system.see(OPEN)  # the way is clear for a moment, and no turn ends while it stands still
    system.call(SetBool, "/enable", SetBool.Request(data=True))
