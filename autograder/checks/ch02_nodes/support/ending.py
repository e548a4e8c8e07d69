"""A program's clean end, after Ctrl-C and after a launch system's SIGTERM."""

from __future__ import annotations

import signal

from geometry_msgs.msg import Twist

from autograder.checks import expect
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, PACKAGE
from autograder.harness import RealTimeHarness, Workspace
from autograder.lockstep.failures import tail

START_SECONDS = 30.0  # of real time
COMPUTING = 10.0  # s of processor time; a node that is to publish needs one of them
QUIET = 0.05  # s after a command: half a period later, a node at 10 Hz waits for work, as it does most of the time
TRIALS = 3
STOP_SECONDS = 15.0  # of real time; a node that ends cleanly needs 0.2
HINTS = (
    "except (KeyboardInterrupt, ExternalShutdownException): pass, around rclpy.spin(node).",
    "In finally: node.destroy_node() and rclpy.try_shutdown(); rclpy.shutdown() raises once the context is down.",
)


def expect_clean_end(workspace: Workspace, number: signal.Signals) -> None:
    """Fail the check unless the node, sent this signal while it spins, ends with exit status 0."""
    for _ in range(TRIALS):
        status, output = _end(workspace, number)
        if not _interrupted_rclpy(status, output):
            break
    expect(status is not None, f"{STOP_SECONDS:.0f} s after {number.name} it was still running, and had to be killed.")
    expect(status == 0, f"After {number.name} it ended with exit status {status}: {tail(output, 1)}")


def _end(workspace: Workspace, number: signal.Signals) -> tuple[int | None, str]:
    """Start the program, send it a signal while it spins; return its exit status, None if it stays, and its output."""
    with RealTimeHarness(workspace, PACKAGE, EXECUTABLE, listens={"/cmd_vel": Twist}) as harness:
        # A node may be seen while its __init__ still runs; a command shows that it spins.
        harness.until(
            lambda: bool(harness.messages("/cmd_vel")) or harness.processes[0].cpu_seconds() > COMPUTING, START_SECONDS
        )
        spoke = bool(harness.messages("/cmd_vel"))
        expect(spoke, "Started as ros2 run does, it published no command: without a scan, it has to publish zeros.")
        harness.run(QUIET)
        return harness.stop(number, STOP_SECONDS), harness.output


def _interrupted_rclpy(status: int | None, output: str) -> bool:
    """Say whether the signal fell into the moment in which rclpy itself raises, whatever the program does.

    Between asking whether its context is valid and building its wait set, rclpy's executor does not expect the context
    to go. It is a matter of microseconds, and says nothing about the program.
    """
    frames = [line for line in output.splitlines() if line.startswith("  File ")]
    in_executor = bool(frames) and "rclpy/executors.py" in frames[-1]
    return status == 1 and in_executor and "context" in tail(output, 1)
