"""Checks of the service check_trip: its answers for a battery, legs and a reserve."""

from __future__ import annotations

import math
import random
from dataclasses import replace

from hypothesis import strategies as st

from autograder.checking import LOCKSTEP, REAL, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checks.ch03_interfaces.hidden.trips import (
    FULL_LEGS,
    INVALID_PERCENTAGES,
    Trip,
    answers,
    any_trips,
    long_legs,
    reserves,
    short_trips,
    wrong_legs,
)
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import MAX_REASON, METRES_PER_PERCENT, RESERVE, UNKNOWN
from autograder.checks.ch03_interfaces.support.reporter import PERIOD, SERVICE, Reporter

check = group("service", doc=contract.SERVICE)
MIN_REASON = 3  # characters: a shorter text is not a reason
SERVICE_CHECK = ("trip_answers",)
MIN_SHOWN_LEVEL = 50  # percent: from this level on, trips are tested with the level that the status shows
REASON_FRACTION = 0.8  # of the points, if only the reason is missing
DISCOVERY_SECONDS = 5.0  # s of real time until a service is in the graph
# s to deliver a message; in lockstep, long before the next status.
DELIVERY_SECONDS = {LOCKSTEP: 0.1, REAL: PERIOD + 0.2}
WITH_ZERO = Trip(80, (12.5, 0.0, 30.0, 0.3), excess=0.4)  # a leg may be 0 m long
PLAIN_TRIPS = Trip(50, (5.0,), RESERVE), Trip(50, (500.0,), RESERVE)  # possible, and not possible
# The battery lasts, but less than the reserve is left; many legs that are too long; many legs, and one is negative.
REFUSED_TRIPS = Trip(50, (200.0,), RESERVE), Trip(50, FULL_LEGS, RESERVE), Trip(50, (*FULL_LEGS[1:], -1.0), RESERVE)
# Legs in m, which leave 0.8 or 0.0 of a percent, and by how many percent the reserve exceeds the whole percents left.
ROUNDED_DOWN, EXACTLY_ENOUGH = ((50.0, 51.0), 1), ((50.0, 50.0), 0)
RULE = "battery_at_end = floor(level - sum(legs) / METRES_PER_PERCENT). possible is True if that is at least reserve."


@check(points=1, covers="trip-service", needs=("status_starts", "check_trip"))
@hint("self.create_service(CheckTrip, 'check_trip', self.check_trip) in __init__.")
@hint("check_trip(self, request, response) must return the response.")
def test_trip_answers(reporter: Reporter) -> None:
    """It serves check_trip with the type my_robot_interfaces/srv/CheckTrip, and answers."""
    services: dict[str, list[str]] = {}

    def is_served() -> bool:
        services.update(reporter.node.get_service_names_and_types())
        return SERVICE in services

    reporter.wait_for(is_served, DISCOVERY_SECONDS)
    names = sorted(name for name, kinds in services.items() if kinds[0].startswith(f"{contract.INTERFACES}/"))
    expect(
        SERVICE in services,
        f"There is no service {SERVICE}. Services of {contract.INTERFACES}: {', '.join(names) or 'none'}.",
    )
    expected = f"{contract.INTERFACES}/srv/CheckTrip"
    expect(
        services[SERVICE] == [expected],
        f"{SERVICE} has the type {', '.join(services[SERVICE])} instead of {expected}.",
    )
    reporter.ask([])


@check(points=2, covers=("trip-unknown", "trip-reason", "newest"), needs=SERVICE_CHECK, after=("status_unknown",))
@hint("If the battery's level is unknown, leave possible False, which is its default.")
def test_trip_unknown_battery(silent_reporter: Reporter, reporter: Reporter, draw: random.Random) -> None:
    """While the battery's level is unknown, no trip is possible, and battery_at_end is -1."""
    _expect_answer(silent_reporter, Trip(UNKNOWN, (10.0,)), "While the battery's level is unknown")
    reporter.set_battery(60)

    def judge(percentage: float) -> None:
        reporter.publish_battery(percentage)
        reporter.run(DELIVERY_SECONDS[reporter.time])
        situation = f"With a percentage of {percentage:.7g}, which is not between 0 and 1"
        _expect_answer(reporter, Trip(UNKNOWN, (10.0,)), situation, fraction=0.75)

    expect_each(INVALID_PERCENTAGES, judge, draw, count=_case_count(reporter, 4))


@check(points=2, covers="trip-rule", needs=SERVICE_CHECK, after=("status_battery",))
@hint(RULE)
def test_trip_level(reporter: Reporter, draw: random.Random) -> None:
    """battery_at_end is the level that the legs leave, rounded down."""

    def judge(trip: Trip) -> None:
        level = _charge(reporter, trip.level, trip.excess)
        actual = reporter.ask(trip.legs, 0).battery_at_end
        expected = {at_end for _, at_end in answers(level, trip.legs, 0)}
        situation = _describe_trip(replace(trip, level=level))
        message = f"{situation}, battery_at_end is {actual}, instead of {' or '.join(map(str, expected))}."
        expect(actual in expected, message)

    judge(WITH_ZERO)
    expect_each(short_trips(), judge, draw, count=_case_count(reporter, 12))


@check(points=2, covers=("trip-rule", "trip-enough"), needs=SERVICE_CHECK, after=("trip_level",))
@hint(RULE, "If exactly the reserve is left, that is enough: at least means >=.")
def test_trip_possible(reporter: Reporter, draw: random.Random) -> None:
    """A trip is possible if at least the reserve is left, and not if less is left."""
    level = _charge(reporter, draw.randint(60, 100))

    def judge(drawn: tuple[tuple[float, ...], int]) -> None:
        legs, reserve_excess = drawn
        at_end = reporter.ask(legs, 0).battery_at_end  # `trip_level` tests whether this is correct
        reserve = at_end + reserve_excess
        answer = reporter.ask(legs, reserve)
        situation = f"At {level} %, with {at_end} % left and a reserve of {reserve} %"
        expected = reserve_excess <= 0
        expect(answer.possible is expected, f"{situation}, possible is {answer.possible} instead of {expected}.")

    for case in ROUNDED_DOWN, EXACTLY_ENOUGH:
        judge(case)
    expect_each(reserves(), judge, draw, count=_case_count(reporter, 14))
    answer = reporter.ask([level * METRES_PER_PERCENT], 0)
    message = f"With a reserve of 0, possible is False for a trip that takes all {level} %."
    expect(answer.possible, message, fraction=0.75)


@check(points=1, covers=("trip-far", "trip-reason"), needs=SERVICE_CHECK, after=("trip_level",))
@hint("An empty battery is at 0, not below: use max(0, …).", "-1 means an unknown level, but here the level is known.")
def test_trip_too_far(reporter: Reporter, draw: random.Random) -> None:
    """A trip that takes more charge than the battery has is not possible, and battery_at_end is 0."""
    level = _charge(reporter, draw.randrange(10, 40))
    trips = st.builds(Trip, st.just(level), long_legs(level), st.sampled_from((0, 5, 20, -200)))
    expect_each(
        trips, lambda trip: _expect_answer(reporter, trip, _describe_trip(trip)), draw, count=_case_count(reporter, 12)
    )
    reporter.set_battery(0)
    at_end = reporter.ask([], 0).battery_at_end
    expect(at_end == 0, f"At a known level of 0 %, without legs, battery_at_end is {at_end}, not 0.", fraction=0.5)


@check(points=2, covers=("trip-unknown", "trip-reason"), needs=SERVICE_CHECK)
@hint("A leg is a distance: at least 0, and finite. nan is not at least 0.")
@hint("0.0 <= leg < math.inf is True only for a distance.")
def test_trip_bad_legs(reporter: Reporter, draw: random.Random) -> None:
    """With a leg that is negative, nan or infinite, no trip is possible, and battery_at_end is -1."""
    level = draw.randrange(60, 101)
    reporter.set_battery(level)
    for leg in (-0.5, math.nan, math.inf):
        trip = Trip(level, (5.0, leg))
        _expect_answer(reporter, trip, _describe_trip(trip))
    trips = st.builds(Trip, st.just(level), wrong_legs())
    expect_each(
        trips, lambda trip: _expect_answer(reporter, trip, _describe_trip(trip)), draw, count=_case_count(reporter, 12)
    )


@check(points=1, covers="trip-reason", needs=SERVICE_CHECK, after=("trip_possible",))
@hint("Set response.reason wherever possible stays False, and nowhere else; 80 characters at most.")
def test_trip_reason(reporter: Reporter, draw: random.Random) -> None:
    """The reason says why a trip is not possible. It is empty if the trip is possible."""
    reporter.set_battery(50)
    for trip in PLAIN_TRIPS:
        _expect_reason(reporter, trip, fraction=0.0)
    for trip in REFUSED_TRIPS:
        _expect_reason(reporter, trip, fraction=0.5)
    expect_each(any_trips(50), lambda trip: _expect_reason(reporter, trip, 0.5), draw, count=_case_count(reporter, 12))


def _case_count(reporter: Reporter, count: int) -> int:
    """Return how many drawn cases a check can afford: fewer in real time."""
    return count if reporter.time == LOCKSTEP else 4


def _describe_trip(trip: Trip) -> str:
    """Describe a trip, as the beginning of a sentence."""
    return f"A{repr(trip)[1:]}"


def _expect_reason(reporter: Reporter, trip: Trip, fraction: float) -> None:
    """Fail the check unless the reason fits the rest of the answer for a trip; other checks test the rest."""
    answer = reporter.ask(trip.legs, trip.reserve)
    length = len(answer.reason.strip())
    if answer.possible:
        message = f"{_describe_trip(trip)}, possible is True, but the reason is {answer.reason!r} instead of ''."
        expect(answer.reason == "", message, fraction=fraction)
    else:
        message = f"{_describe_trip(trip)}, possible is False, but the reason is {answer.reason!r}."
        expect(length >= MIN_REASON, message, fraction=fraction)
    message = (
        f"{_describe_trip(trip)}, the reason has {len(answer.reason)} characters, instead of at most {MAX_REASON}."
    )
    expect(len(answer.reason) <= MAX_REASON, message, fraction=0.5)


def _expect_answer(reporter: Reporter, trip: Trip, situation: str, fraction: float = 0.0) -> None:
    """Fail the check unless the answer for a trip that is not possible is correct."""
    answer = reporter.ask(trip.legs, trip.reserve)
    ((_, expected),) = answers(trip.level, trip.legs, trip.reserve)
    expect(not answer.possible, f"{situation}, possible is True instead of False.", fraction=fraction)
    message = f"{situation}, battery_at_end is {answer.battery_at_end} instead of {expected}."
    expect(answer.battery_at_end == expected, message, fraction=fraction)
    message = f"{situation}, the trip is not possible, but the reason is {answer.reason!r}."
    expect(len(answer.reason.strip()) >= MIN_REASON, message, fraction=max(REASON_FRACTION, fraction))


def _charge(reporter: Reporter, percent: int, excess: float = 0.25) -> int:
    """Charge the battery; return the level with which trips are tested, in percent.

    This is the level that the status shows, so a level that is rounded down costs no points here. If the status shows
    far less, `percent` is returned.
    """
    shown_level = reporter.set_battery(percent, excess)
    return shown_level if min(percent, MIN_SHOWN_LEVEL) <= shown_level <= 100 else percent
