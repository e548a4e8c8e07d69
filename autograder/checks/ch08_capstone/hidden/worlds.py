"""Step 2, the whole system: the robot's drives through hidden worlds, tested by temporal logic over its track."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from autograder.checking import LOCKSTEP, Artifacts, CheckFailed, expect, group, hint, temporal
from autograder.checks.ch02_nodes.hidden import blindness
from autograder.checks.ch02_nodes.support.robot import describe_command
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden import tracks
from autograder.checks.ch08_capstone.hidden.drives import BLOCKED, DEAD, DriveResult, Drives
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, TOLERANCE
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_still
from autograder.checks.ch08_capstone.support.system import System
from sim import clearance
from sim.rows import row_at, state_at

check = group("step_2")
SAFE = "gap > 0.01"  # m between the footprint and the nearest thing
STEADY = "changes < 3.5"  # turns that followed a turn to the other side, in the last WINDOW seconds
WINDOW = 6.0  # s in which changes of direction are counted
STOPPING_DISTANCE = 0.3  # m at 0.3 m/s: 0.5 s until data are stale, and delays of the nodes at 10 Hz and of the motor
BLOCKED_STOPPING_DISTANCE = 0.15  # m: the scans of a blocked lidar are invalid immediately
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
STILL = 0.01  # m/s: a slower robot counts as standing still
ROOM_SHARE = 1 / 3  # of the distance that the robot could drive at its speed: it also has to turn
MIN_DISTANCE_SHARE = 0.1  # of the distance at the contract's speed: a robot that covers less does not drive
STOP_SECONDS = 1.5  # s: 0.5 s until the data are stale, and time to brake
OBSTACLE_DISTANCE = 1.0  # m: the robot turns if a thing is within 0.6 m, until 0.7 m ahead are clear
RESTART_SECONDS = 2.0  # s within which the robot drives again
SIDE_DISTANCE = 0.15  # m, little more than range_min
SECTOR_HALF_WIDTH = 35.0  # degrees to each side of a sector's middle, a little more than half_angle
PICTURE_HINT = ("Look at the picture: what did the lidar see at the marked time, and at which bearing?",)


@check(points=3, covers=("turn", "starts-turn"), needs=("build",), after=("drives", "turns"))
@hint(*PICTURE_HINT)
def test_touches_nothing(drives: Drives, driving_system: System, artifacts: Artifacts) -> None:
    """The robot drives through a furnished room for twenty seconds and touches nothing."""
    result = drives.room
    recording = result.recording
    verdict = temporal.always(SAFE, recording.times.tolist(), {"gap": recording.clearances[:, 0].tolist()})
    rules = {"the gap to the nearest thing, in m, is above 0.01": verdict}
    if verdict.violated_at is not None:
        touch_time = verdict.violated_at
        obstacle = clearance(recording.simulation, state_at(recording, row_at(recording, touch_time))).name
        sentence = f"The robot touched {obstacle} at t = {touch_time:.1f} s."
        share = (
            touch_time / result.seconds
            if blindness.turns_at_obstacles(recording, OBSTACLE_DISTANCE, until=touch_time)
            else 0.0
        )
        _fail(artifacts, result, sentence, touch_time, "touches", share, rules)
    driven_distance = float(blindness.driven_distances(recording)[-1])
    _save_track(
        artifacts, result, f"{driven_distance:.1f} m in {result.seconds:.0f} s, and nothing was touched.", rules
    )
    speeds = tracks.speeds(recording)
    moving_speeds = speeds[speeds > STILL]
    pace = min(SPEED, float(moving_speeds.mean())) if moving_speeds.size else 0.0
    message = (
        f"The robot touched nothing, but drove only {driven_distance:.1f} m in {result.seconds:.0f} s, "
        f"at {pace:.2f} m/s on average while it moved."
    )
    expect(pace > 0.0 and driven_distance >= ROOM_SHARE * pace * result.seconds, message)
    turns = blindness.turns_at_obstacles(recording, OBSTACLE_DISTANCE)
    expect(
        turns,
        f"The robot touched nothing, but hardly turned where something was within {OBSTACLE_DISTANCE:.1f} m ahead.",
    )
    _expect_no_touch(driving_system)


@check(points=2, covers=("more-room", "ends-turn"), needs=("build",), after=("drives", "turns"))
@hint("A turn that has begun keeps its direction until the way is clear.")
@hint("self.turn remembers the direction. Compare the sides only when a turn begins.")
def test_keeps_its_mind(drives: Drives, artifacts: Artifacts) -> None:
    """The robot does not swing back and forth between left and right."""
    has_turned = False
    for result in (drives.room, drives.corridor):
        times = [command.seconds - result.start for command in result.commands]
        rates = [command.message.angular.z for command in result.commands]
        turns = blindness.turns_at_obstacles(result.recording, OBSTACLE_DISTANCE)
        has_turned = has_turned or turns
        verdict = temporal.always(STEADY, times, {"changes": tracks.changes_of_direction(times, rates, WINDOW)})
        if verdict.violated_at is not None:
            violation_time, rules = (
                verdict.violated_at,
                {f"at most three changes of direction in {WINDOW:.0f} s": verdict},
            )
            sentence = (
                f"The robot changed its turning direction more than three times in {WINDOW:.0f} s, "
                f"up to t = {violation_time:.1f} s."
            )
            _fail(
                artifacts,
                result,
                sentence,
                violation_time,
                "back and forth",
                violation_time / result.seconds if turns else 0.0,
                rules,
            )
    expect(has_turned, "The robot never turned at an obstacle, either in the room or in the corridor with the bend.")


@check(points=3, covers=("drive", "more-room"), needs=("build",), after=("drives", "turns"))
@hint("At the bend it has to turn towards the side with more room, and then drive on.")
@hint("A robot that turns too far drives back to its start: a turn ends when the way is clear.")
def test_gets_on(drives: Drives, driving_system: System, artifacts: Artifacts) -> None:
    """The robot finds its way round the bend of a corridor."""
    result = drives.corridor
    share = drives.share_of_corridor(result.recording)
    caption = f"{100 * share:.0f} % of the way to the far end of the corridor in {result.seconds:.0f} s."
    if share < 1.0:
        turns = blindness.turns_at_obstacles(result.recording, OBSTACLE_DISTANCE)
        _fail(
            artifacts, result, f"The robot drove {caption}", result.seconds, "no further", 0.9 * share if turns else 0.0
        )
    _save_track(artifacts, result, caption)
    _expect_drive_past_things(driving_system)


@check(points=3, covers="untrusted", needs=("build",), after=("drives", "stops"))
@hint("The robot must stop when its data are older than data_timeout: how far does it drive until it notices this?")
@hint("The robot must stop at once when a clearance is not valid.")
def test_stops_in_time(drives: Drives, driving_system: System, artifacts: Artifacts) -> None:
    """When the lidar dies or is blocked, the robot stops within 0.3 m and stays where it is."""
    result, rules = drives.faulty_lidar, {}
    driven_distance = float(np.interp(DEAD.start, result.recording.times, blindness.driven_distances(result.recording)))
    message = (
        f"In the {DEAD.start:.0f} s before the lidar died, the robot drove only {driven_distance:.2f} m: "
        "a stop counts only for a robot that drives."
    )
    expect(driven_distance >= MIN_DISTANCE_SHARE * SPEED * DEAD.start, message)
    times, speed = result.recording.times, tracks.speeds(result.recording)
    for fault, max_distance in ((DEAD, STOPPING_DISTANCE), (BLOCKED, BLOCKED_STOPPING_DISTANCE)):
        is_faulty = (times >= fault.start) & (times < fault.end)
        distances = tracks.driven_since(result.recording, fault.start)[is_faulty].tolist()
        verdict = temporal.always(f"distance < {max_distance}", times[is_faulty].tolist(), {"distance": distances})
        rules[f"the distance driven since the lidar was {fault.name}, in m, is below {max_distance:.2f}"] = verdict
        if verdict.violated_at is not None:
            sentence = (
                f"The lidar was {fault.name} from t = {fault.start:.0f} s on; at t = {verdict.violated_at:.1f} s "
                f"the robot had driven {max_distance:.2f} m since then and had not stopped."
            )
            fraction = 0.0 if fault is DEAD else 0.5
            _fail(artifacts, result, sentence, verdict.violated_at, "still drives", fraction, rules)
        late_times = times[_should_stand(fault, times) & (speed > STILL)]
        if late_times.size:
            beginning = f"The lidar was {fault.name} from t = {fault.start:.0f} s on"
            sentence = f"{beginning}; at t = {late_times[0]:.1f} s the robot was still driving."
            _fail(
                artifacts, result, sentence, float(late_times[0]), "still drives", 0.0 if fault is DEAD else 0.5, rules
            )
    caption = "the lidar was dead for a while, then blocked for a while, and the robot stood still both times."
    _save_track(artifacts, result, caption, rules)
    _expect_half_blind_stop(driving_system)


@check(points=2, covers="drive", needs=("build",), after=("drives", "stops_in_time"))
@hint("Look at the newest clearance every time: the robot must not stay stopped when the lidar works again.")
def test_drives_again(drives: Drives, artifacts: Artifacts) -> None:
    """Within 2 s of the lidar's return, the robot drives again."""
    result = drives.faulty_lidar
    times, speed = result.recording.times, tracks.speeds(result.recording)
    stood_still = any((speed[_should_stand(fault, times)] <= STILL).all() for fault in (DEAD, BLOCKED))
    expect(
        stood_still,
        "The robot did not stand still while the lidar was dead or blocked, so it could not start again.",
    )
    for fault in (DEAD, BLOCKED):
        is_after = (times >= fault.end) & (times <= fault.end + RESTART_SECONDS)
        moves = bool((speed[is_after] > STILL).any())
        if not moves:
            sentence = (
                f"The lidar was {fault.name} until t = {fault.end:.0f} s; "
                f"{RESTART_SECONDS:.0f} s later the robot was still standing."
            )
            _fail(artifacts, result, sentence, fault.end, "could drive", 0.0 if fault is DEAD else 0.5)


def _should_stand(fault: tracks.LidarFault, times: tracks.Floats) -> NDArray[np.bool_]:
    """Return a mask of the times at which the robot should stand still because of a lidar fault."""
    mask: NDArray[np.bool_] = (times >= fault.start + STOP_SECONDS) & (times < fault.end)
    return mask


def _expect_no_touch(system: System) -> None:
    """Fail the check if the robot drives towards something too near to measure. The room contains no such thing."""
    system.publish_scans(OPEN)
    commands = system.publish_scans(
        scan(Part(-SECTOR_HALF_WIDTH, SECTOR_HALF_WIDTH, -math.inf), fill=math.inf)
    ).commands
    system.publish_scans(OPEN, 0.2)  # ends the turn, so that the next drive starts without one
    wrong_command = next((command.message for command in commands if command.message.linear.x > TOLERANCE), None)
    action = "" if wrong_command is None else describe_command(wrong_command)
    situation = "With -inf from every beam ahead (something is too near to measure)"
    expect(wrong_command is None, f"{situation}, the robot {action}: it should turn on the spot.", fraction=0.85)


def _expect_half_blind_stop(system: System) -> None:
    """Fail the check unless the robot stands still when one side is blocked, in lockstep from the first command on."""
    for side, middle in (("left", 90.0), ("right", -90.0)):
        system.publish_scans(OPEN)
        start = system.seconds
        commands = system.publish_scans(
            scan(Part(middle - SECTOR_HALF_WIDTH, middle + SECTOR_HALF_WIDTH, math.nan), fill=math.inf)
        ).commands
        if system.harness.time == LOCKSTEP:
            commands = system.messages(start).commands
        expect_still(commands, f"With nan from every beam on the {side}, and the way ahead clear", fraction=0.85)


def _expect_drive_past_things(system: System) -> None:
    """Fail the check unless the robot drives while the way ahead is clear, even with things close beside it."""
    system.publish_scans(OPEN)
    for position, middles, reading in (
        ("on the left", (90.0,), -math.inf),
        ("on the right", (-90.0,), -math.inf),
        ("on both sides", (90.0, -90.0), SIDE_DISTANCE),
    ):
        parts = [Part(middle - SECTOR_HALF_WIDTH, middle + SECTOR_HALF_WIDTH, reading) for middle in middles]
        commands = system.publish_scans(scan(*parts, fill=math.inf)).commands
        situation = f"With {reading:g} from every beam {position}, and the way ahead clear"
        expect_driving(commands, situation, SPEED, fraction=0.85)


Rules = Mapping[str, temporal.Verdict]


def _save_track(artifacts: Artifacts, result: DriveResult, caption: str, rules: Rules | None = None) -> None:
    world = result.recording.simulation.world.name
    artifacts.track("track", result.recording, f"The robot's track in {world}: {caption}", rules=rules)


def _fail(
    artifacts: Artifacts,
    result: DriveResult,
    sentence: str,
    seconds: float,
    note: str,
    fraction: float,
    rules: Rules | None = None,
) -> None:
    world = result.recording.simulation.world.name
    artifacts.track(
        "track",
        result.recording,
        f"The robot's track in {world}. {sentence}",
        mark=min(seconds, result.seconds),
        note=note,
        rules=rules,
    )
    raise CheckFailed(sentence, fraction=round(min(max(fraction, 0.0), 0.95), 2))
