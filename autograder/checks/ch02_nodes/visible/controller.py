"""Checks of the student's robot controller: its reactions to a few scans, and how it ends."""

from __future__ import annotations

import math
import signal

from autograder.checking import Workspace, expect, group, hint
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.contract import BLOCKED_SECONDS, MIN_WARNINGS
from autograder.checks.ch02_nodes.support.robot import (
    WRITTEN_SECONDS,
    Robot,
    expect_forward,
    expect_stop,
    expect_turn,
    qos_mismatch,
)
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch02_nodes.support.shutdown import HINTS, expect_clean_end

check = group("controller")


@check(points=1, covers="node-name", doc=contract.NODES)
@hint("The sentence above names the error. The lines below it show where it is.")
@hint("The check needs the whole file: forward_clearance, the class and main.")
def test_starts(robot: Robot) -> None:
    """The package builds, and its program robot_controller starts and spins."""
    expect(bool(robot.nodes()), "The program runs, but there is no node in the graph.")


@check(points=1, covers=("node-name", "scan", "status", "cmd-vel"), needs=("starts",), doc=contract.NODES)
@hint("__init__ needs three calls: create_publisher once, and create_subscription twice.")
@hint("The type of 'cmd_vel' is Twist, the type of 'scan' is LaserScan, and the type of 'status' is String.")
def test_topics(robot: Robot) -> None:
    """Its node is called robot_controller, subscribes to scan and status, and publishes cmd_vel."""
    names = robot.nodes()
    expect(
        contract.NODE in names, f"There is no node {contract.NODE}. Nodes in the graph: {', '.join(names) or 'none'}."
    )
    missing = [topic for topic in ("/scan", "/status") if not robot.takes(topic)]
    missing += [] if robot.node.get_publishers_info_by_topic("/cmd_vel") else ["/cmd_vel"]
    expect(not missing, f"There is no publisher or subscription of the correct type on {', '.join(missing)}.")


@check(points=1, covers="scan", needs=("starts",), after=("topics",), doc=contract.QOS)
@hint("A lidar publishes best-effort; a reliable subscription never matches it.")
@hint("Give create_subscription qos_profile_sensor_data instead of 10.")
def test_qos(robot: Robot) -> None:
    """Its scan subscription receives scans from a best-effort lidar."""
    reason = qos_mismatch(robot) if robot.takes("/scan") else "there is no subscription to scan"
    expect(not reason, f"It would receive no scan: {reason}.")


@check(points=1, covers="no-scan", needs=("starts",), after=("topics",))
@hint(contract.RULE_STOP, "Start with last_scan = None, and let None mean stop.")
def test_waits(fresh_robot: Robot) -> None:
    """It stands still until the first scan arrives."""
    expect_stop(fresh_robot.leave_alone(1.0), "Before the first scan")


@check(points=1, covers="clear", needs=("starts",), after=("topics",))
@hint(contract.RULE_FORWARD)
def test_drives(robot: Robot) -> None:
    """It drives straight on while the way is clear."""
    expect_forward(robot.see(scan(fill=2.0)), "With 2 m of free space all around")


@check(points=1, covers=("near", "sector"), needs=("starts",), after=("topics",), doc=contract.LASER_SCAN)
@hint(contract.RULE_TURN, "A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi].")
def test_turns(robot: Robot) -> None:
    """It turns left when a wall is 0.6 m ahead, and only when it is ahead."""
    expect_turn(robot.see(scan(Part(-10.0, 10.0, 0.6))), "With a wall 0.6 m ahead")
    expect_turn(robot.see(scan(Part(-22.0, -18.0, 0.6))), "With a post 0.6 m ahead, 20° to the right")
    expect_forward(robot.see(scan(Part(150.0, 180.0, 0.6))), "With a wall 0.6 m behind")


@check(points=1, covers="bearings", needs=("starts",), after=("turns",), doc=contract.LASER_SCAN)
@hint("Take angle_min and angle_increment from the message: a beam's number is not its bearing in degrees.")
def test_other_lidar(robot: Robot) -> None:
    """With a lidar of 480 beams from -120° to 120°, it turns for a wall ahead, and not for one on its left."""
    for first, expect_reaction in ((-8.0, expect_turn), (70.0, expect_forward)):
        message = scan(Part(first, first + 16.0, 0.7), beams=480, first_bearing=-120.0, last_bearing=120.0)
        expect_reaction(robot.see(message), f"With a wall 0.7 m away, from {first:.0f}° to {first + 16.0:.0f}°")


@check(points=1, covers="plus-inf", needs=("starts",), after=("drives",), doc=contract.REP_117)
@hint("+inf means that nothing is there. It counts, as a very large distance.")
def test_open_door(robot: Robot) -> None:
    """It drives on when every beam ahead reads +inf and there are walls on both sides."""
    expect_forward(robot.see(scan(Part(-40.0, 40.0, math.inf), fill=0.65)), "With +inf ahead and walls on both sides")


@check(points=1, covers="blind", needs=("starts",), after=("drives",))
@hint("What is your minimum when no reading is left? It must not mean that the way is clear.")
def test_dirty_window(robot: Robot) -> None:
    """It stands still when every beam ahead reads nan."""
    expect_stop(robot.see(scan(Part(-50.0, 50.0, math.nan), fill=1.5)), "With nan from every beam ahead")


@check(points=1, covers="nan", needs=("starts",), after=("drives", "turns"), doc=contract.REP_117)
@hint("min([nan, 0.5]) is nan, and nan < 1.0 is False.", "Leave nan out before you take the minimum.")
def test_nan(robot: Robot) -> None:
    """A nan among the readings does not hide a wall."""
    wall = scan(Part(-10.0, 10.0, 0.6), Part(0.0, 0.0, math.nan))
    expect_turn(robot.see(wall), "With a wall 0.6 m ahead and one beam that reads nan")


@check(points=1, covers="minus-inf", needs=("starts",), after=("drives", "turns"), doc=contract.REP_117)
@hint("-inf means that something is nearer than range_min.", "Do not discard -inf together with invalid readings.")
def test_too_near(robot: Robot) -> None:
    """It turns when a reading straight ahead is -inf."""
    expect_turn(robot.see(scan(Part(-2.0, 2.0, -math.inf))), "With -inf straight ahead")


@check(points=1, covers="phantom", needs=("starts",), after=("drives", "turns"), doc=contract.REP_117)
@hint("A finite reading counts only from range_min to range_max of the message.")
def test_phantom(robot: Robot) -> None:
    """It does not mistake a reading of 0.0 straight ahead for a wall."""
    expect_forward(robot.see(scan(Part(-2.0, 2.0, 0.0))), "With 0.0 straight ahead")


@check(points=1, covers="stale", needs=("starts",), after=("drives",))
@hint("Remember the time at which the last scan arrived: self.get_clock().now().")
@hint("In control_loop, compare that time with now. If the scan is older than 0.5 s, stop.")
def test_dead_lidar(robot: Robot) -> None:
    """It stands still one second after the last scan."""
    robot.see(scan(fill=2.0))
    start = robot.seconds
    robot.leave_alone(2.0)
    expect_stop(robot.messages("/cmd_vel", since=start + 1.0), "A second after the last scan")


@check(points=1, covers="cmd-vel", needs=("starts",), after=("topics",))
@hint("create_timer(0.1, self.control_loop) calls control_loop ten times a second.")
def test_rate(robot: Robot) -> None:
    """It publishes ten commands a second."""
    start = robot.seconds
    robot.see(scan(), 2.0)
    rate = robot.rate("/cmd_vel", since=start)
    expect(9.0 <= rate <= 11.0, f"It published {rate:.1f} commands a second, instead of 10.")


@check(points=1, covers="warns", needs=("starts",), after=("turns",))
@hint("Call self.get_logger().warning(text, throttle_duration_sec=1.0).")
@hint("It warns while it is blocked, and does not warn while it drives.")
def test_warns(robot: Robot) -> None:
    """In front of a wall, it warns once a second."""
    robot.see(scan(fill=2.0))
    warnings_before = robot.output.count("[WARN]")
    robot.see(scan(Part(-15.0, 15.0, 0.7)), BLOCKED_SECONDS)
    robot.wait_for(lambda: robot.output.count("[WARN]") - warnings_before >= MIN_WARNINGS, WRITTEN_SECONDS)
    warnings = robot.output.count("[WARN]") - warnings_before
    message = f"In front of a wall for {BLOCKED_SECONDS:.0f} s it warned {warnings} times, instead of once a second."
    expect(MIN_WARNINGS <= warnings <= 2 * MIN_WARNINGS, message)


@check(points=1, covers="ends", needs=("starts",), after=("topics",))
@hint(*HINTS)
def test_ends(workspace: Workspace) -> None:
    """Ctrl-C and SIGTERM end it with exit status 0."""
    for stop_signal in (signal.SIGINT, signal.SIGTERM):
        expect_clean_end(workspace, stop_signal)
