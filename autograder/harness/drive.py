"""Lets a student's programs steer the simulated robot with ROS messages."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.harness.base import Harness
from autograder.harness.goals import ReceivedMessage
from autograder.plain_text import clean
from autograder.run.sandbox import Process
from sim import Command, Recorder, Recording, Scan, Simulation, State, observe, start, step
from sim.bridge.messages import odom_to_msg, scan_to_msg, twist_to_command

SENSOR_TOPICS = {"/scan": LaserScan, "/odom": Odometry}
COMMAND_TOPICS = {"/cmd_vel": Twist}
# Simulated time between two rows of the recording: a multiple of the simulator's 20 ms, and 18 mm of travel at 0.3 m/s.
PHYSICS_NS = 60_000_000
SCAN_NS = 100_000_000  # simulated time between two scans
SCAN_SECONDS = SCAN_NS / 1e9  # the same in s

# ROS's log lines contain the machine's time, which differs from run to run.
_LOG_TIME = re.compile(r"^(\[\w+\]) \[\d+\.\d+\] (?=\[)")

ScanFilter = Callable[[Scan, float], Scan | None]
"""Called with a scan and the seconds since the start. Returns the scan to send, or None to drop it."""


@dataclass(frozen=True)
class Drive:
    """A robot's run: the recording (with the programs' log), the messages on /cmd_vel, and the programs' output."""

    recording: Recording
    commands: tuple[ReceivedMessage, ...]
    output: str


def drive(
    harness: Harness,
    simulation: Simulation,
    seconds: float,
    *,
    alter_scan: ScanFilter | None = None,
    until: Callable[[State], bool] = lambda state: False,
) -> Drive:
    """Let the programs in a harness steer the only robot of a simulation.

    Scans and odometry are sent at 10 Hz. Simulated time starts at 0, but the messages are stamped with the programs'
    ROS time.

    Args:
        harness: a harness that publishes `SENSOR_TOPICS` and subscribes to `COMMAND_TOPICS`.
        simulation: the world and the robot.
        seconds: the maximum duration, in ROS time.
        alter_scan: may change or drop each scan before it is sent.
        until: ends the drive at the first state for which it returns True.

    Raises:
        StudentError: the program published a command that no robot can execute.
    """
    state = start(simulation)
    recorder = Recorder(simulation, state)
    origin_ns = harness.now_ns
    command: Command | None = None
    end_ns = round(seconds * 1e9)
    recorded_bytes: dict[Process, int] = {}
    if harness.seconds > 0.0:  # earlier output belongs to another run
        _record_output(harness, 0.0, Recorder(simulation, state), recorded_bytes)
    while state.time_ns < end_ns and not until(state):
        target_ns = min(state.time_ns + harness.tick_ns, end_ns)
        state = _move(simulation, state, command, target_ns, recorder)
        if target_ns % SCAN_NS == 0:
            _sense(harness, simulation, state, origin_ns, recorder, alter_scan)
        count = len(harness.messages("/cmd_vel"))
        harness.step(target_ns - (harness.now_ns - origin_ns))
        _record_output(harness, target_ns / 1e9, recorder, recorded_bytes)
        new_messages = harness.messages("/cmd_vel")[count:]
        command = _command(new_messages[-1]) if new_messages else None
    return Drive(recorder.recording(), tuple(harness.messages("/cmd_vel")), harness.output)


def _record_output(harness: Harness, seconds: float, recorder: Recorder, recorded_bytes: dict[Process, int]) -> None:
    """Record the complete lines that the programs have printed since the last call.

    `recorded_bytes` counts the bytes of each program's output that have been recorded, and is updated.
    """
    for process in harness.processes:
        text = process.output_from(recorded_bytes.get(process, 0))
        end = text.rfind(b"\n") + 1
        recorded_bytes[process] = recorded_bytes.get(process, 0) + end
        for line in clean(text[:end].decode("utf-8", errors="replace")).split("\n"):
            recorder.log.add(seconds, _LOG_TIME.sub(r"\1 ", line))


def _command(received: ReceivedMessage) -> Command:
    try:
        return twist_to_command(received.message)
    except ValueError as error:
        sentence = f"At t = {received.seconds:.1f} s your node published a command that no motor can execute: {error}."
        raise StudentError(Diagnosis(Kind.UNUSABLE_COMMAND, sentence)) from None


def _move(simulation: Simulation, state: State, command: Command | None, target_ns: int, recorder: Recorder) -> State:
    """Step the physics to `target_ns`. Only the first step gets the command; the robot's watchdog keeps or drops it."""
    while state.time_ns < target_ns:
        dt_ns = min(PHYSICS_NS, target_ns - state.time_ns)
        state = step(simulation, state, command, dt_ns / 1e9)
        recorder.append(state, command)
        command = None
    return state


def _sense(
    harness: Harness,
    simulation: Simulation,
    state: State,
    origin_ns: int,
    recorder: Recorder,
    alter_scan: ScanFilter | None,
) -> None:
    scan = observe(simulation, state)
    if scan is not None and alter_scan is not None:
        scan = alter_scan(scan, state.time_ns / 1e9)
    recorder.scan(scan)
    if scan is not None:
        message = scan_to_msg(scan)
        _shift(message.header.stamp, origin_ns)
        harness.publish("/scan", message)
    odometry = odom_to_msg(state.robots[0], state.time_ns)
    _shift(odometry.header.stamp, origin_ns)
    harness.publish("/odom", odometry)


def _shift(stamp: object, origin_ns: int) -> None:
    """Move a stamp of simulated time to the program's ROS time, in place."""
    total = stamp.sec * 1_000_000_000 + stamp.nanosec + origin_ns  # type: ignore[attr-defined]
    stamp.sec, stamp.nanosec = divmod(total, 1_000_000_000)  # type: ignore[attr-defined]
