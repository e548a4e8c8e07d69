"""A program's clean end, after Ctrl-C and after a launch system's SIGTERM."""

from __future__ import annotations

import re
import signal
import time

from geometry_msgs.msg import Twist
from rcl_interfaces.srv import GetParameters

from autograder.checking import RealTimeHarness, Workspace, expect
from autograder.checking.probes import rclpy_races
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, NODE, PACKAGE

START_SECONDS = 30.0  # of real time
COMMAND = "geometry_msgs/msg/Twist"
ANSWER_SECONDS = 10.0  # of real time
COMPUTING = 10.0  # s of processor time; a node that is to publish needs one of them
QUIET = 0.05  # s after a command: half a period later, a node at 10 Hz waits for work, as it does most of the time
TRIALS = 3
LOGGED = re.compile(rf"^\[[A-Z]+\] \[(?P<seconds>\d+\.\d+)\] \[{NODE[1:]}\]: .*", re.MULTILINE)  # what the node logs
STOP_SECONDS = 15.0  # of real time; a node that ends cleanly needs 0.2
HINTS = (
    "except (KeyboardInterrupt, ExternalShutdownException): pass, around rclpy.spin(node).",
    "In finally: node.destroy_node() and rclpy.try_shutdown(); rclpy.shutdown() raises once the context is down.",
)


def expect_clean_end(workspace: Workspace, number: signal.Signals) -> None:
    """Fail the check unless the node, sent this signal while it spins, ends with exit status 0."""
    for _ in range(TRIALS):
        status, output, late = _end(workspace, number)
        if not rclpy_races.crashed(status) and (status != 1 or not rclpy_races.lost_a_race(output)):
            break
    expect(status is not None, f"{STOP_SECONDS:.0f} s after {number.name} it was still running, and had to be killed.")
    expect(status == 0, f"After {number.name} it ended with exit status {status}: {last_line(output)}")
    said = f"After {number.name}, when its context was gone, it still logged: {''.join(late[:1])}"
    expect(not late, said, fraction=0.5)


def last_line(output: str) -> str:
    """Return the last line of an output, or an empty string."""
    return "".join(output.strip().splitlines()[-1:])


def _commands(harness: RealTimeHarness) -> bool:
    """Return whether the program publishes commands; whether it should is for other checks."""
    return any(peer.topic_type == COMMAND for peer in harness.node.get_publishers_info_by_topic("/cmd_vel"))


def _answers(harness: RealTimeHarness) -> bool:
    """Return whether a node of the program answers when it is asked for its parameters, as each one does that spins."""
    asked = GetParameters.Request(names=["use_sim_time"])
    return any(harness.call(GetParameters, f"{node}/get_parameters", asked, ANSWER_SECONDS) for node in harness.nodes())


def _end(workspace: Workspace, number: signal.Signals) -> tuple[int | None, str, list[str]]:
    """Start the program, and send it a signal while it spins.

    Returns:
        Its exit status, None if it stays; its output; the lines that it logged after the signal.
    """
    with RealTimeHarness(workspace, PACKAGE, EXECUTABLE, subscribes={"/cmd_vel": Twist}) as harness:
        # A node may be seen while its __init__ still runs; a command shows that it spins, or an answer.
        harness.until(
            lambda: bool(harness.messages("/cmd_vel")) or harness.processes[0].cpu_seconds() > COMPUTING,
            START_SECONDS if _commands(harness) else 0.0,
        )
        spins = bool(harness.messages("/cmd_vel")) or _answers(harness)
        expect(spins, "Started as ros2 run does, it published no command, and did not answer: it does not spin.")
        harness.run(QUIET)
        signalled = time.time()
        status = harness.stop(number, STOP_SECONDS)
    late = [line[0] for line in LOGGED.finditer(harness.output) if float(line["seconds"]) > signalled]
    return status, harness.output, late
