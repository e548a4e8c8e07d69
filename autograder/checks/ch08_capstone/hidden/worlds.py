"""Step 2, the whole: the robot in hidden worlds, judged by temporal logic over its track."""

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
from autograder.checks.ch08_capstone.hidden.drives import BLOCKED, DARK, Driven, Drives
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, TOLERANCE
from autograder.checks.ch08_capstone.support.system import System, expect_driving, expect_still
from sim import clearance
from sim.rows import row_at, state_at

check = group("step_2")
SAFE = "gap > 0.01"  # m between the footprint and the nearest thing
STEADY = "changes < 3.5"  # turns that followed one to the other side, in the newest MEMORY seconds
MEMORY = 6.0  # s
STOPPING = 0.3  # m: 0.5 s until the data are stale, and what a chain at 10 Hz and a motor add, at 0.3 m/s
BLIND_STOPPING = 0.15  # m: a blocked lidar says so at once
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
STANDS = 0.01  # m/s
ROOM_SHARE = 1 / 3  # of the way that it could drive at its speed: it turns, too
DROVE = 0.1  # of the way that the contract's speed allows: who has not come so far did not drive
STANDS_AFTER = 1.5  # s: 0.5 s until the data are stale, and time to brake
AHEAD = 1.0  # m: it turns for what is within 0.6 m, and until 0.7 m are clear
BACK_WITHIN = 2.0  # s
BESIDE = 0.15  # m, little more than range_min
SECTOR = 35.0  # degrees to each side of a middle, a little more than half_angle
PICTURE = ("Look at the picture: what did the lidar see at the marked instant, and at which bearing?",)


@check(points=3, covers=("turn", "starts-turn"), needs=("build",), after=("drives", "turns"))
@hint(*PICTURE)
def test_touches_nothing(drives: Drives, driving: System, artifacts: Artifacts) -> None:
    """It drives through a furnished room for twenty seconds and touches nothing."""
    driven = drives.room
    recording = driven.recording
    verdict = temporal.always(SAFE, recording.times.tolist(), {"gap": recording.clearances[:, 0].tolist()})
    rules = {"the gap to the nearest thing, in m, is above 0.01": verdict}
    if verdict.violated_at is not None:
        when = verdict.violated_at
        what = clearance(recording.simulation, state_at(recording, row_at(recording, when))).what
        sentence = f"It touched {what} at t = {when:.1f} s."
        share = when / driven.seconds if blindness.turns_at_things(recording, AHEAD, until=when) else 0.0
        _fail(artifacts, driven, sentence, when, "touches", share, rules)
    metres = float(blindness.path(recording)[-1])
    _keep(artifacts, driven, f"{metres:.1f} m in {driven.seconds:.0f} s, nothing touched.", rules)
    speeds = tracks.speeds(recording)
    moving = speeds[speeds > STANDS]
    pace = min(SPEED, float(moving.mean())) if moving.size else 0.0
    said = f"It touched nothing, but drove only {metres:.1f} m in {driven.seconds:.0f} s, at {pace:.2f} m/s on average."
    expect(pace > 0.0 and metres >= ROOM_SHARE * pace * driven.seconds, said)
    turns = blindness.turns_at_things(recording, AHEAD)
    expect(turns, f"It touched nothing, but hardly turned where something was within {AHEAD:.1f} m ahead.")
    _expect_no_touch(driving)


@check(points=2, covers=("more-room", "ends-turn"), needs=("build",), after=("drives", "turns"))
@hint("A turn that has begun keeps its direction until the way is clear.")
@hint("self.turn remembers it; the sides are compared only when a turn begins.")
def test_keeps_its_mind(drives: Drives, artifacts: Artifacts) -> None:
    """It does not swing to and fro between left and right."""
    turned = False
    for driven in (drives.room, drives.corridor):
        times = [command.seconds - driven.began for command in driven.commands]
        rates = [command.message.angular.z for command in driven.commands]
        turns = blindness.turns_at_things(driven.recording, AHEAD)
        turned = turned or turns
        verdict = temporal.always(STEADY, times, {"changes": tracks.changes_of_mind(times, rates, MEMORY)})
        if verdict.violated_at is not None:
            when, rules = verdict.violated_at, {f"at most three changes of mind in {MEMORY:.0f} s": verdict}
            sentence = f"It changed its mind more than three times in {MEMORY:.0f} s, up to t = {when:.1f} s."
            _fail(artifacts, driven, sentence, when, "to and fro", when / driven.seconds if turns else 0.0, rules)
    expect(turned, "It never turned for something ahead, neither in a room nor in a corridor with a bend.")


@check(points=3, covers=("drive", "more-room"), needs=("build",), after=("drives", "turns"))
@hint("At the bend it has to turn towards the side with more room, and then drive on.")
@hint("A robot that turns too far looks back to where it came from: a turn ends when the way is clear.")
def test_gets_on(drives: Drives, driving: System, artifacts: Artifacts) -> None:
    """It finds its way round the bend of a corridor."""
    driven = drives.corridor
    share = drives.share_of_corridor(driven.recording)
    caption = f"{100 * share:.0f} % of the way to the far end of the corridor in {driven.seconds:.0f} s."
    if share < 1.0:
        turns = blindness.turns_at_things(driven.recording, AHEAD)
        _fail(artifacts, driven, f"It came {caption}", driven.seconds, "no further", 0.9 * share if turns else 0.0)
    _keep(artifacts, driven, caption)
    _expect_drive_between(driving)


@check(points=3, covers="untrusted", needs=("build",), after=("drives", "stops"))
@hint("Data older than data_timeout mean stop: how far does the robot get until it sees that they are old?")
@hint("A clearance that is not valid means stop at once.")
def test_stops_in_time(drives: Drives, driving: System, artifacts: Artifacts) -> None:
    """When its lidar dies, or is blocked, it stands within 0.3 m, and stays where it is."""
    driven, rules = drives.faulty, {}
    metres = float(np.interp(DARK.start, driven.recording.times, blindness.path(driven.recording)))
    said = f"In the {DARK.start:.0f} s before its lidar died it drove {metres:.2f} m: who stops has driven before."
    expect(metres >= DROVE * SPEED * DARK.start, said)
    times, speed = driven.recording.times, tracks.speeds(driven.recording)
    for trouble, most in ((DARK, STOPPING), (BLOCKED, BLIND_STOPPING)):
        there = (times >= trouble.start) & (times < trouble.end)
        metres = tracks.driven_since(driven.recording, trouble.start)[there].tolist()
        verdict = temporal.always(f"metres < {most}", times[there].tolist(), {"metres": metres})
        rules[f"the way since the lidar was {trouble.name}, in m, is below {most:.2f}"] = verdict
        if verdict.violated_at is not None:
            sentence = (
                f"The lidar was {trouble.name} from t = {trouble.start:.0f} s on; at t = {verdict.violated_at:.1f} s "
                f"the robot had driven {most:.2f} m since then and had not stopped."
            )
            fraction = 0.0 if trouble is DARK else 0.5
            _fail(artifacts, driven, sentence, verdict.violated_at, "still drives", fraction, rules)
        late = times[_stands_in(trouble, times) & (speed > STANDS)]
        if late.size:
            since = f"The lidar was {trouble.name} from t = {trouble.start:.0f} s on"
            sentence = f"{since}; at t = {late[0]:.1f} s the robot still drove."
            _fail(artifacts, driven, sentence, float(late[0]), "still drives", 0.0 if trouble is DARK else 0.5, rules)
    caption = "the lidar died and came back, was blocked and came free; the robot stood still meanwhile."
    _keep(artifacts, driven, caption, rules)
    _expect_half_blind_stop(driving)


@check(points=2, covers="drive", needs=("build",), after=("drives", "stops_in_time"))
@hint("Look at the newest clearance every time: a stop is no state to be stuck in.")
def test_drives_again(drives: Drives, artifacts: Artifacts) -> None:
    """Within 2 s of its lidar's return it drives again."""
    driven = drives.faulty
    times, speed = driven.recording.times, tracks.speeds(driven.recording)
    stood = any((speed[_stands_in(trouble, times)] <= STANDS).all() for trouble in (DARK, BLOCKED))
    expect(stood, "It did not stand still while its lidar was dead or blocked: who never stops cannot drive again.")
    for trouble in (DARK, BLOCKED):
        after = (times >= trouble.end) & (times <= trouble.end + BACK_WITHIN)
        moves = bool((speed[after] > STANDS).any())
        if not moves:
            sentence = (
                f"The lidar was {trouble.name} until t = {trouble.end:.0f} s; {BACK_WITHIN:.0f} s later it still stood."
            )
            _fail(artifacts, driven, sentence, trouble.end, "could drive", 0.0 if trouble is DARK else 0.5)


def _stands_in(trouble: tracks.LidarFault, times: tracks.Floats) -> NDArray[np.bool_]:
    """Return at which of the times the robot should stand still because of a trouble."""
    found: NDArray[np.bool_] = (times >= trouble.start + STANDS_AFTER) & (times < trouble.end)
    return found


def _expect_no_touch(system: System) -> None:
    """Fail the check if the robot drives towards something that is too near to measure: in the room nothing is."""
    system.see(OPEN)
    said = system.see(scan(Part(-SECTOR, SECTOR, -math.inf), fill=math.inf)).commands
    system.see(OPEN, 0.2)  # the next drive begins without a turn
    bad = next((command.message for command in said if command.message.linear.x > TOLERANCE), None)
    did = "" if bad is None else describe_command(bad)
    near = "With -inf from every beam ahead, something too near to measure"
    expect(bad is None, f"{near}, the robot {did}: it should turn on the spot.", fraction=0.85)


def _expect_half_blind_stop(system: System) -> None:
    """Fail the check unless the robot stands still when one side is blocked; in lockstep from the first command on."""
    for side, middle in (("left", 90.0), ("right", -90.0)):
        system.see(OPEN)
        began = system.seconds
        said = system.see(scan(Part(middle - SECTOR, middle + SECTOR, math.nan), fill=math.inf)).commands
        if system.harness.time == LOCKSTEP:
            said = system.messages(began).commands
        expect_still(said, f"With nan from every beam on the {side}, and the way ahead clear", fraction=0.85)


def _expect_drive_between(system: System) -> None:
    """Fail the check unless the robot drives on where the way is clear, however near things are beside it."""
    system.see(OPEN)
    for where, middles, reading in (
        ("on the left", (90.0,), -math.inf),
        ("on the right", (-90.0,), -math.inf),
        ("on both sides", (90.0, -90.0), BESIDE),
    ):
        parts = [Part(middle - SECTOR, middle + SECTOR, reading) for middle in middles]
        said = system.see(scan(*parts, fill=math.inf)).commands
        situation = f"With {reading:g} from every beam {where}, and the way ahead clear"
        expect_driving(said, situation, SPEED, fraction=0.85)


Rules = Mapping[str, temporal.Verdict]


def _keep(artifacts: Artifacts, driven: Driven, caption: str, rules: Rules | None = None) -> None:
    world = driven.recording.simulation.world.name
    artifacts.track("track", driven.recording, f"The robot's track in {world}: {caption}", rules=rules)


def _fail(
    artifacts: Artifacts,
    driven: Driven,
    sentence: str,
    when: float,
    note: str,
    fraction: float,
    rules: Rules | None = None,
) -> None:
    world = driven.recording.simulation.world.name
    artifacts.track(
        "track",
        driven.recording,
        f"The robot's track in {world}. {sentence}",
        mark=min(when, driven.seconds),
        note=note,
        rules=rules,
    )
    raise CheckFailed(sentence, fraction=round(min(max(fraction, 0.0), 0.95), 2))
