"""Tests whether a program ends cleanly after Ctrl-C and after a launch system's SIGTERM."""

from __future__ import annotations

import re
import signal
import time

from geometry_msgs.msg import Twist
from rcl_interfaces.srv import GetParameters

from autograder.checking import RealTimeHarness, Workspace, expect
from autograder.checking.probes import rclpy_races
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, NODE, PACKAGE

START_SECONDS = 30.0  # s of real time within which the program must start
COMMAND_TYPE = "geometry_msgs/msg/Twist"
ANSWER_SECONDS = 10.0  # s of real time to wait for an answer
MAX_CPU_SECONDS = 10.0  # s of processor time until the first command; a node that works needs about 1 s
QUIET_SECONDS = 0.05  # s after a command: half a period at 10 Hz, so the node is waiting for its timer
TRIALS = 3  # attempts, if rclpy itself fails
# A line that the node logs.
LOG_LINE = re.compile(rf"^\[[A-Z]+\] \[(?P<seconds>\d+\.\d+)\] \[{NODE[1:]}\]: .*", re.MULTILINE)
STOP_SECONDS = 15.0  # s of real time; a node that ends cleanly needs 0.2 s
HINTS = (
    "Call rclpy.spin(node) in a `try` with `except (KeyboardInterrupt, ExternalShutdownException): pass`.",
    "In `finally`, call node.destroy_node() and rclpy.try_shutdown(). rclpy.shutdown() raises an error after a signal.",
)


def expect_clean_end(workspace: Workspace, stop_signal: signal.Signals) -> None:
    """Fail the check unless the node, sent this signal while it spins, ends with exit status 0."""
    for _ in range(TRIALS):
        status, output, late_lines = _stop_while_spinning(workspace, stop_signal)
        if not rclpy_races.crashed(status) and (status != 1 or not rclpy_races.lost_a_race(output)):
            break
    expect(
        status is not None, f"{STOP_SECONDS:.0f} s after {stop_signal.name} it was still running, and had to be killed."
    )
    expect(status == 0, f"After {stop_signal.name} it ended with exit status {status}: {last_line(output)}")
    message = f"After {stop_signal.name}, its context was shut down, but it still logged: {''.join(late_lines[:1])}"
    expect(not late_lines, message, fraction=0.5)


def last_line(output: str) -> str:
    """Return the last line of an output, or an empty string."""
    return "".join(output.strip().splitlines()[-1:])


def _publishes_commands(harness: RealTimeHarness) -> bool:
    """Return whether the program publishes on cmd_vel; other checks test whether it should."""
    return any(peer.topic_type == COMMAND_TYPE for peer in harness.node.get_publishers_info_by_topic("/cmd_vel"))


def _answers_requests(harness: RealTimeHarness) -> bool:
    """Return whether a node of the program answers a request for its parameters, as every node that spins does."""
    request = GetParameters.Request(names=["use_sim_time"])
    return any(
        harness.call(GetParameters, f"{node}/get_parameters", request, ANSWER_SECONDS) for node in harness.nodes()
    )


def _stop_while_spinning(workspace: Workspace, stop_signal: signal.Signals) -> tuple[int | None, str, list[str]]:
    """Start the program, and send it a signal while it spins.

    Returns:
        The program's exit status, or None if it does not end; its output; the lines that it logged after the signal.
    """
    with RealTimeHarness(workspace, PACKAGE, EXECUTABLE, subscribes={"/cmd_vel": Twist}) as harness:
        # A node is in the graph before its __init__ has returned. A command or an answer shows that it spins.
        harness.until(
            lambda: bool(harness.messages("/cmd_vel")) or harness.processes[0].cpu_seconds() > MAX_CPU_SECONDS,
            START_SECONDS if _publishes_commands(harness) else 0.0,
        )
        is_spinning = bool(harness.messages("/cmd_vel")) or _answers_requests(harness)
        expect(
            is_spinning, "Started as by ros2 run, it published no command and answered no request: it does not spin."
        )
        harness.run(QUIET_SECONDS)
        signal_time = time.time()
        status = harness.stop(stop_signal, STOP_SECONDS)
    late_lines = [line[0] for line in LOG_LINE.finditer(harness.output) if float(line["seconds"]) > signal_time]
    return status, harness.output, late_lines
