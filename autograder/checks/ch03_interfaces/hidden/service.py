"""Checks of the service check_trip: its answers for a battery, legs and a reserve."""

from __future__ import annotations

import random
from typing import Any

from autograder.checking import LOCKSTEP, REAL, expect, group, hint
from autograder.checks.ch03_interfaces.hidden.trips import draw_bad_legs, draw_reserves, draw_too_far, draw_trips
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import MAX_REASON, METRES_PER_PERCENT, UNKNOWN
from autograder.checks.ch03_interfaces.support.reporter import PERIOD, SERVICE, Reporter

check = group("service", doc=contract.SERVICE)
MIN_REASON = 3  # characters: a shorter text is not a reason
SERVICE_CHECK = ("trip_answers",)
MIN_SHOWN_LEVEL = 50  # percent: from here on, trips are tested with the level that the status shows
REASON_FRACTION = 0.8  # of the points, if only the reason is missing
DISCOVERY_SECONDS = 5.0  # s of real time until a service is in the graph
DELIVERY_SECONDS = {LOCKSTEP: 0.1, REAL: PERIOD + 0.2}  # in lockstep, long before the next status
RULE = "battery_at_end = floor(level - sum(legs) / METRES_PER_PERCENT), and possible when that is at least reserve."


@check(points=1, covers="trip-service", needs=("status_starts", "check_trip"))
@hint("self.create_service(CheckTrip, 'check_trip', self.check_trip) in __init__.")
@hint("check_trip(self, request, response) returns the response.")
def test_trip_answers(reporter: Reporter) -> None:
    """It serves check_trip as my_robot_interfaces/srv/CheckTrip, and answers."""
    services: dict[str, list[str]] = {}

    def is_served() -> bool:
        services.update(reporter.node.get_service_names_and_types())
        return SERVICE in services

    reporter.wait_for(is_served, DISCOVERY_SECONDS)
    names = sorted(name for name, kinds in services.items() if kinds[0].startswith(f"{contract.INTERFACES}/"))
    expect(
        SERVICE in services,
        f"There is no service {SERVICE}; the node serves {', '.join(names) or 'nothing of its own'}.",
    )
    expected = f"{contract.INTERFACES}/srv/CheckTrip"
    expect(
        services[SERVICE] == [expected],
        f"{SERVICE} has the type {', '.join(services[SERVICE])}, it should be {expected}.",
    )
    reporter.ask([])


@check(points=2, covers=("trip-unknown", "trip-reason", "newest"), needs=SERVICE_CHECK, after=("status_unknown",))
@hint("An unknown battery makes no trip possible; start with possible = False.")
def test_trip_unknown_battery(silent_reporter: Reporter, reporter: Reporter) -> None:
    """While the battery is unknown no trip is possible, and battery_at_end is -1."""
    _expect_impossible(silent_reporter.ask([10.0], 0), UNKNOWN, "With an unknown battery")
    reporter.set_battery(60)
    reporter.publish_battery(1.5)  # which is not a level
    reporter.run(DELIVERY_SECONDS[reporter.time])
    situation = f"{DELIVERY_SECONDS[reporter.time]:.1f} s after the percentage went from 0.6 to 1.5, which is unknown"
    _expect_impossible(reporter.ask([10.0], 0), UNKNOWN, situation, fraction=0.75)


@check(points=2, covers="trip-rule", needs=SERVICE_CHECK, after=("status_battery",))
@hint(RULE)
def test_trip_level(reporter: Reporter, draw: random.Random) -> None:
    """battery_at_end is what the legs leave of the battery, rounded down."""
    for trip in draw_trips(draw):
        level = _charge(reporter, trip.level, trip.excess)
        reported, expected = reporter.ask(trip.legs, 0).battery_at_end, trip.level_at_end(level)
        situation = f"At {level} % and {len(trip.legs)} legs of {sum(trip.legs):.1f} m in all"
        expect(reported == expected, f"{situation}, battery_at_end is {reported}, not {expected}.")


@check(points=2, covers=("trip-rule", "trip-enough"), needs=SERVICE_CHECK, after=("trip_level",))
@hint(RULE, "Exactly the reserve left is enough: at least means >=.")
def test_trip_possible(reporter: Reporter, draw: random.Random) -> None:
    """A trip is possible when at least the reserve is left, and not when less is."""
    for drawn in draw_reserves(draw):
        level = _charge(reporter, drawn.level)
        for legs in drawn.trips:
            at_end = reporter.ask(legs, drawn.reserve).battery_at_end  # `trip_level` tests whether that is right
            expect(at_end > 0, f"At {level} %, legs of {sum(legs):.1f} m are said to leave {at_end} %.")
            for reserve in (at_end, at_end + 1, drawn.reserve):
                answer = reporter.ask(legs, reserve)
                answer_text = "possible" if answer.possible else "not possible"
                situation = f"At {level} %, with {at_end} % left, of which {reserve} % is the reserve"
                expect(answer.possible is (at_end >= reserve), f"{situation}, the trip is said to be {answer_text}.")
        answer = reporter.ask([level * METRES_PER_PERCENT], 0)
        message = f"With a reserve of 0, a trip that takes all {level} % is said to be not possible."
        expect(answer.possible, message, fraction=0.75)


@check(points=1, covers=("trip-far", "trip-reason"), needs=SERVICE_CHECK, after=("trip_level",))
@hint("An empty battery is 0, not below: max(0, …).", "-1 says that the level is unknown, which it is not.")
def test_trip_too_far(reporter: Reporter, draw: random.Random) -> None:
    """A trip that is longer than the battery lasts leaves 0 percent, never less, and is not possible."""
    level = _charge(reporter, draw.randrange(10, 40))
    for reserve in (5, 0, -200):
        far, slightly_too_far = draw_too_far(draw, level)
        answer = reporter.ask(far, reserve)
        _expect_impossible(answer, 0, f"After a trip far too long, with a reserve of {reserve} %")
    _expect_impossible(
        reporter.ask(slightly_too_far, 0),
        0,
        "After a trip that takes less than one percent more than there is, with a reserve of 0 %",
    )
    reporter.set_battery(0)
    at_end = reporter.ask([], 0).battery_at_end
    expect(at_end == 0, f"At 0 %, which is known, and without legs, battery_at_end is {at_end}, not 0.", fraction=0.5)


@check(points=2, covers=("trip-unknown", "trip-reason"), needs=SERVICE_CHECK)
@hint("A leg is a distance: at least 0, and finite. nan is not at least 0.")
@hint("0.0 <= leg < math.inf holds for distances alone.")
def test_trip_bad_legs(reporter: Reporter, draw: random.Random) -> None:
    """With a leg that is negative, nan or infinite no trip is possible, and battery_at_end is -1."""
    reporter.set_battery(draw.randrange(60, 101))
    for bad, legs in draw_bad_legs(draw):
        _expect_impossible(reporter.ask(legs, 0), UNKNOWN, f"With a leg of {bad:.1f} m")


@check(points=1, covers="trip-reason", needs=SERVICE_CHECK, after=("trip_possible",))
@hint("Set response.reason wherever possible stays False, and nowhere else; 80 characters at most.")
def test_trip_reason(reporter: Reporter) -> None:
    """The reason says why a trip is not possible, and is empty when it is."""
    reporter.set_battery(50)
    good, bad = reporter.ask([5.0]), reporter.ask([500.0])
    expect(good.reason == "", f"The trip is possible, and yet the reason is {good.reason!r}.")
    expect(len(bad.reason.strip()) >= MIN_REASON, f"The trip is not possible, and the reason is {bad.reason!r}.")
    for last in (-100.125, 100.125):  # a reason that lists all legs is longer than 80 characters
        answer = reporter.ask([100.125] * 7 + [last])
        fits = len(answer.reason.strip()) >= MIN_REASON and len(answer.reason) <= MAX_REASON
        message = (
            f"With eight legs, the reason has {len(answer.reason)} characters, instead of {MIN_REASON} to {MAX_REASON}."
        )
        expect(fits, message, fraction=0.5)


def _expect_impossible(answer: Any, level: int, situation: str, fraction: float = 0.0) -> None:
    """Fail the check unless a trip is impossible and ends at this level; `fraction` is for the cases before."""
    at_end = answer.battery_at_end
    expect(not answer.possible, f"{situation}, the trip is said to be possible.", fraction=fraction)
    expect(at_end == level, f"{situation}, battery_at_end is {at_end}, it should be {level}.", fraction=fraction)
    message = f"{situation}, the reason is {answer.reason!r}."
    expect(len(answer.reason.strip()) >= MIN_REASON, message, fraction=max(REASON_FRACTION, fraction))


def _charge(reporter: Reporter, percent: int, excess: float = 0.25) -> int:
    """Charge the battery; return the level with which trips are tested, in percent.

    It is the level that the status shows, so a level that is rounded down costs no points here. If the status shows
    far less, it is `percent`.
    """
    shown_level = reporter.set_battery(percent, excess)
    return shown_level if min(percent, MIN_SHOWN_LEVEL) <= shown_level <= 100 else percent
