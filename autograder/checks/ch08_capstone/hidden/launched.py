"""Repeats the given integration test from outside: the grader sends scans to the launched system and reads messages.

The given test runs in a process with the student's launch file, messages and other tests, each of which can make it
pass. Here, the student's code runs only in the sandbox.
"""

from __future__ import annotations

import time

from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from autograder.checking import SCAN_SECONDS, LaunchHarness, Workspace, expect
from autograder.checking.probes import launch_probe
from autograder.checks.ch08_capstone.support.contract import LAUNCH_FILE, OK, PACKAGE
from autograder.checks.ch08_capstone.support.messages import load_messages, message_types

STOP_SECONDS = 20.0  # real time until the robot has to stand still; correct nodes need 2 s, the given test waits 10 s
SCAN, CMD_VEL, HEALTH = "/scan", "/cmd_vel", "/health"


def expect_reaction_to_scans(workspace: Workspace) -> None:
    """Fail the check unless the launched robot drives while scans arrive, and stops after the last one.

    Its health is OK only in the first case. Other checks test which level is reported in the second.
    """
    subscribes = {CMD_VEL: Twist, HEALTH: message_types(load_messages(workspace)).health}
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, subscribes=subscribes, publishes={SCAN: LaserScan}) as harness:
        due = time.monotonic()

        def drives_with_scans() -> bool:
            nonlocal due
            if time.monotonic() >= due:
                due += SCAN_SECONDS
                harness.publish(SCAN, _scan())
            return _is_driving(harness) and _is_healthy(harness)

        is_driving = harness.wait_for(drives_with_scans, launch_probe.START_SECONDS)
        reason = launch_probe.failure(harness.output)
        message = f"The launched programs got scans of an open space, but {_describe(harness)}. {reason}"
        expect(is_driving, message.strip())
        has_stopped = harness.wait_for(lambda: not _is_driving(harness) and not _is_healthy(harness), STOP_SECONDS)
        expect(has_stopped, f"{STOP_SECONDS:.0f} s after the last scan, {_describe(harness)}.")


def _scan() -> LaserScan:
    """Return the scan of the given test, with the present time: 2 m of space all around."""
    scan = LaserScan(range_min=0.1, range_max=10.0, angle_increment=0.01, ranges=[2.0] * 628)
    seconds, nanoseconds = divmod(time.time_ns(), 10**9)
    scan.header.stamp.sec, scan.header.stamp.nanosec = seconds, nanoseconds
    return scan


def _is_driving(harness: LaunchHarness) -> bool:
    commands = harness.messages(CMD_VEL)
    return bool(commands) and bool(commands[-1].linear.x > 0.0)


def _is_healthy(harness: LaunchHarness) -> bool:
    reports = harness.messages(HEALTH)
    return bool(reports) and bool(reports[-1].level == OK)


def _describe(harness: LaunchHarness) -> str:
    movement = "drives forward" if _is_driving(harness) else "does not drive forward"
    health = "OK" if _is_healthy(harness) else "not OK" if harness.messages(HEALTH) else "not reported"
    return f"the robot {movement}, and its health is {health}"
