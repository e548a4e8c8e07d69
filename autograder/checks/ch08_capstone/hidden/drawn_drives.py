"""Drives of all kinds that the contract of navigation_controller allows, and the commands that it requires."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from hypothesis import strategies as st
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool

from autograder.checking import LOCKSTEP, REAL, SCAN_SECONDS, expect
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN
from autograder.checks.ch08_capstone.hidden.drawn_scans import distance_text
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_still, expect_turning
from autograder.checks.ch08_capstone.support.system import System

DEFAULTS = {name: bounds.default for name, bounds in PARAMETERS[CONTROLLER].items()}
TURN_MARGIN = 0.1  # m beyond the safety distance: where a turn ends
AGE_MARGIN = {LOCKSTEP: 0.06, REAL: 0.25}  # s around data_timeout, in which the robot may drive or stand still
MIN_SCANS = {LOCKSTEP: 1, REAL: 7}  # the minimum number of scans with the same view
SETTLING_SCANS = {LOCKSTEP: 0, REAL: 4}  # the number of scans in which commands are not judged yet
STILL, DRIVE, LEFT, RIGHT = "still", "drive", "left", "right"


@dataclass(frozen=True)
class View:
    """The nearest things ahead, on the left and on the right, in metres."""

    front: float
    left: float
    right: float

    @property
    def is_valid(self) -> bool:
        """Whether each sector has a reading that counts."""
        return not any(map(math.isnan, (self.front, self.left, self.right)))

    def scan(self) -> LaserScan:
        """Return a scan with one beam in each sector."""
        scan = LaserScan(angle_min=-math.pi / 2, angle_max=math.pi / 2, angle_increment=math.pi / 2)
        scan.range_min, scan.range_max = RANGE_MIN, RANGE_MAX
        scan.ranges = [self.right, self.front, self.left]
        return scan


CLEAR = View(math.inf, math.inf, math.inf)


@dataclass(frozen=True)
class Moment:
    """A part of a drive.

    Attributes:
        view: what the scans show; if it is None, no scans are published.
        scans: how many scans are published, or are missing, one every 0.1 s.
        age: the age of each scan when it arrives, in seconds; below 0 if its stamp is ahead of the clock.
        enable: the value with which the service enable is called before the scans; None if it is not called.
    """

    view: View | None
    scans: int = 0
    age: float = 0.0
    enable: bool | None = None

    def __repr__(self) -> str:
        call_text = "" if self.enable is None else f"enable is called with {str(self.enable).lower()} and "
        if self.view is None:
            return f"{call_text}no scan arrives for {self.scans * SCAN_SECONDS:.1f} s"
        age = f", in scans that are {self.age:.1f} s old" if self.age > 0.0 else ""
        age = f", in scans whose stamp is {-self.age:.1f} s ahead of the clock" if self.age < 0.0 else age
        front, left, right = map(distance_text, (self.view.front, self.view.left, self.view.right))
        return f"{call_text}the robot sees {front} ahead, {left} on the left and {right} on the right{age}"


Drive = tuple[Moment, ...]


class Rule:
    """Computes the commands that the contract requires: the first row of its table that fits, and choose_turn."""

    def __init__(self, safety_distance: float, data_timeout: float, age_margin: float) -> None:
        self._safety_distance, self._data_timeout, self._age_margin = safety_distance, data_timeout, age_margin
        self._view, self._scan_time, self._latest_scan_time = View(math.nan, math.nan, math.nan), -math.inf, -math.inf
        self._turn = DRIVE
        self.enabled = True

    def see(self, view: View, scan_time: float) -> None:
        """Remember the newest clearance, and when its scan was taken."""
        self._view, self._scan_time, self._latest_scan_time = view, scan_time, max(scan_time, self._latest_scan_time)

    def command(self, now: float) -> str | None:
        """Return the correct kind of command at this time, or None if more than one kind is correct.

        The newest clearance may be the one that arrived last or the one with the latest stamp.
        """
        excess = now - self._scan_time - self._data_timeout
        if (
            self._scan_time < self._latest_scan_time
            and now - self._latest_scan_time - self._data_timeout < self._age_margin
        ):
            return None
        if not self.enabled or not self._view.is_valid or excess > self._age_margin:
            return STILL
        if excess >= -self._age_margin:
            return None
        view, limit = self._view, self._safety_distance
        if self._turn == DRIVE and view.front < limit:
            self._turn = LEFT if view.left >= view.right else RIGHT
        elif self._turn != DRIVE and view.front >= limit + TURN_MARGIN:
            self._turn = DRIVE
        return self._turn


def expect_drive(
    system: System, drive: Drive, *judged_kinds: str, fraction: float = 0.0, parameters: Mapping[str, float] = DEFAULTS
) -> None:
    """Fail the check unless the robot behaves in a drive as the contract requires.

    Args:
        system: the system; at first, the robot is enabled, and its way is clear.
        drive: the drive.
        judged_kinds: the kinds of commands that the check judges; it ignores the others.
        fraction: the fraction of the points if the robot behaves otherwise.
        parameters: the parameters of the controller.
    """
    time = system.harness.time
    rule = Rule(parameters["safety_distance"], parameters["data_timeout"], AGE_MARGIN[time])
    drive_start = system.seconds
    for number, moment in enumerate((Moment(CLEAR), *drive)):
        situation = (
            f"At first, {'; then '.join(map(repr, drive[:number]))}. In this situation"
            if number
            else "With a clear way"
        )
        if moment.enable is not None:
            expect_enabled(system, moment.enable, fraction)
            rule.enabled = moment.enable
        for count in range(max(moment.scans, MIN_SCANS[time])):
            start = system.seconds
            if moment.view is not None:
                system.send("/scan", moment.view.scan(), moment.age)
                rule.see(moment.view, start + SCAN_SECONDS - moment.age)
            system.harness.run(SCAN_SECONDS)
            commands, kind = system.messages(start).commands, rule.command(system.seconds)
            if not number or kind not in judged_kinds or count < SETTLING_SCANS[time] or not commands:
                continue
            if kind == STILL:
                expect_still(commands, situation, fraction=fraction)
            elif kind == DRIVE:
                expect_driving(commands, situation, parameters["forward_speed"], fraction=fraction, always=True)
            else:
                expect_turning(commands, situation, str(kind), parameters["turn_speed"], fraction=fraction)
    if not rule.enabled:
        expect_enabled(system, True, fraction)
    expect(bool(system.messages(drive_start).commands), "Scans were published, but no command on cmd_vel.")


def expect_enabled(system: System, data: bool, fraction: float = 0.0) -> None:
    """Call the service enable; fail the check unless its answer is success."""
    response = system.call(SetBool, "/enable", SetBool.Request(data=data))
    message = f"Called with data: {str(data).lower()}, enable answered with success false, instead of true."
    expect(response.success, message, fraction=fraction)


NEAR_AND_FAR = (1.0, 2.0), (0.5, 0.51), (1.0, math.inf), (-math.inf, 1.0), (-math.inf, math.inf)  # m, at the sides
SIDES = [pair for near, far in NEAR_AND_FAR for pair in ((near, far), (far, near))]
SIDES += [(side, side) for side in (1.0, math.inf, -math.inf)]


def views(*fronts: float, sides: Sequence[tuple[float, float]]) -> st.SearchStrategy[View]:
    """Draw a view with one of these distances ahead, and one of these pairs of distances on the left and right."""
    # A single choice, because with several, Hypothesis often draws the same value again.
    return st.sampled_from([View(front, left, right) for front in fronts for left, right in sides])


@st.composite
def turns(draw: st.DrawFn, limit: float = DEFAULTS["safety_distance"]) -> Drive:
    """Draw a drive with things at about the safety distance, in which one side is sometimes blind."""
    offsets = -limit / 2, -0.01, 0.01, 0.05, TURN_MARGIN - 0.01, TURN_MARGIN + 0.01
    around = views(*(limit + offset for offset in offsets), 3.0, math.inf, -math.inf, sides=SIDES)
    drive: list[Moment] = []
    for view in draw(st.lists(around, min_size=2, max_size=6)):
        drive.append(Moment(view))
        if draw(st.integers(0, 3)) == 0:
            drive.append(Moment(replace(view, **{draw(st.sampled_from(("left", "right"))): math.nan})))
    return tuple(drive)


@st.composite
def stops(draw: st.DrawFn, timeout: float = DEFAULTS["data_timeout"]) -> Drive:
    """Draw a drive along a clear path, with blind sectors, stale scans and silences."""
    readings = st.sampled_from((math.nan, math.inf, 1.0))
    sides = readings | st.just(-math.inf)
    ages = st.sampled_from((0.0, 0.0, timeout - 0.3, timeout - 0.1, timeout + 0.1, timeout + 0.5, 5.0))
    drive: list[Moment] = []
    for age in draw(st.lists(ages, min_size=1, max_size=3)):
        # Late scans are published until the previous clearance is certainly too old.
        scans = round(timeout / SCAN_SECONDS) + 3 if age > timeout else 0
        view = draw(st.just(CLEAR) | st.builds(View, readings, sides, sides))
        drive.append(Moment(view, scans, max(0.0, age)))
        if draw(st.booleans()):
            drive.append(Moment(None, draw(st.integers(2, round(timeout / SCAN_SECONDS) + 3))))
    return tuple(drive)


@st.composite
def calls(draw: st.DrawFn) -> Drive:
    """Draw a drive with calls of enable; while the robot is held still, it sees the same as before, or a clear way."""
    drive: list[Moment] = []
    next_enable: bool | None = None
    for view in draw(st.lists(views(0.3, 0.65, 0.3, 3.0, sides=SIDES[:4]), min_size=2, max_size=5)):
        drive.append(Moment(view, enable=next_enable or draw(st.sampled_from((None, True)))))
        held_count = draw(st.integers(0, 2))
        drive += [Moment(draw(st.sampled_from((view, CLEAR))), enable=False)] * held_count
        next_enable = True if held_count else None
        if held_count and draw(st.booleans()):  # the robot must not wait for another scan
            drive.append(Moment(None, 1, enable=True))
    return tuple(drive)
