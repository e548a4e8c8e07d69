"""A clean end: Ctrl-C and a launch system's SIGTERM."""

from __future__ import annotations

import signal

from geometry_msgs.msg import Twist

from autograder.checks import check, expect
from autograder.lab import RealtimeLab, Workspace
from autograder.lockstep.failures import tail
from autograder.visible.ch02_nodes.contract import EXECUTABLE, PACKAGE

GROUP = "lifecycle"
START_SECONDS = 30.0  # of real time
STOP_SECONDS = 15.0  # of real time; a node that ends cleanly needs 0.2
HINTS = (
    "except (KeyboardInterrupt, ExternalShutdownException): pass, around rclpy.spin(node).",
    "In finally: node.destroy_node() and rclpy.try_shutdown(); rclpy.shutdown() raises once the context is down.",
)


@check(points=2, group=GROUP, depends=("publishes_cmd_vel",), hints=HINTS)
def test_sigint(workspace: Workspace) -> None:
    """It ends with exit status 0, without a traceback, on Ctrl-C (SIGINT)."""
    _expect_clean_end(workspace, signal.SIGINT)


@check(points=2, group=GROUP, depends=("publishes_cmd_vel",), hints=HINTS)
def test_sigterm(workspace: Workspace) -> None:
    """It ends with exit status 0, without a traceback, when a launch system stops it (SIGTERM)."""
    _expect_clean_end(workspace, signal.SIGTERM)


def _expect_clean_end(workspace: Workspace, number: signal.Signals) -> None:
    with RealtimeLab(workspace, PACKAGE, EXECUTABLE, listens={"/cmd_vel": Twist}) as lab:
        # A node may be seen while its __init__ still runs; a command shows that it spins.
        expect(
            lab.wait_for(lambda: bool(lab.messages("/cmd_vel")), START_SECONDS),
            f"Started as ros2 run does, it published no command within {START_SECONDS:.0f} s.",
        )
        status = lab.stop(number, STOP_SECONDS)
        last = tail(lab.output, 1)
    expect(status is not None, f"{STOP_SECONDS:.0f} s after {number.name} it was still running, and had to be killed.")
    expect(status == 0, f"After {number.name} it ended with exit status {status}: {last}")
