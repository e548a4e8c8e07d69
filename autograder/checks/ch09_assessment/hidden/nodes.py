"""Question 3: the three nodes' behaviour, with parameters and temperatures drawn from the seed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from random import Random

from autograder.checking import LOCKSTEP, CheckFailed, Workspace, expect, group, hint
from autograder.checking.probes import namespaces
from autograder.checks.ch09_assessment.hidden.drawn_temperatures import (
    UNKNOWN,
    around_thresholds,
    expect_series,
    expect_switching,
    series,
)
from autograder.checks.ch09_assessment.hidden.expectations import (
    expect_averages,
    expect_decisions,
    expect_fresh_readings,
    expect_full_averages,
    expect_measured,
    expect_passed_on,
    expect_separate_windows,
    student_reading,
)
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.contract import (
    COOL,
    GUARD,
    HOT,
    PERIOD,
    SMOOTHER,
    THERMOMETER,
    WINDOW,
    reading,
)
from autograder.checks.ch09_assessment.support.robot import Start, Types, near, refuses

check = group("nodes")
BUILD_CHECKS = ("installs",)
BETWEEN = (COOL + 1.0, HOT - 1.0)  # degrees Celsius: the limits of temperatures that leave the fan as it is
UNSUBSCRIBED_SECONDS = 2.2  # s after the start of a node before anything subscribes to it
MARGIN = 0.002  # degrees from a threshold: rounded to hundredths, such a temperature is the threshold
HUGE = 1e20  # degrees: added to a running sum, it erases all other numbers
SILENCE = 2.5  # s without an average, which must not change the state of the fan
STAMP = (1_700_000_000, 123_456_789)  # s and ns of a realistic time, which a float of seconds cannot represent
QUEUE = 10  # how many messages a queue should hold
SLOW = 0.25  # s that the machine's clocks count in a second of ROS time


@check(
    points=2,
    covers=("reading", "formula", "period", "mean-swing", "thermometer-topics"),
    after=BUILD_CHECKS,
    doc=contract.NODES_DOC,
)
@hint("create_timer(period, self.timer_callback), and a counter in self.", "math.sin takes radians.")
def test_readings(start: Start) -> None:
    """Thermometer publishes two readings a second, and they follow the formula of the contract."""
    with start(THERMOMETER) as harness:
        harness.expect_in_graph()
        harness.expect_readings(30)


@check(points=2, covers=("period", "mean-swing", "at-start"), after=("readings",), doc=contract.PARAMETERS_DOC)
@hint("self.declare_parameter('mean', 50.0).value, and use it.", "create_timer takes the parameter period.")
def test_thermometer_parameters(start: Start, draw: Random) -> None:
    """Thermometer uses its parameters period, mean and swing."""
    period, mean, swing = draw_wave(draw)
    try:
        expect_measured(start, period, mean, swing, reading)
    except CheckFailed:  # another check tests the formula
        expect_measured(start, period, mean, swing, student_reading(start))


@check(points=1, covers=("reading", "formula"), after=("readings",), doc=contract.NODES_DOC)
@hint("stamp=self.get_clock().now().to_msg()", "time.time() does not return ROS time.")
@hint("Create the timer in __init__. Its callback should not check for subscribers.")
def test_stamps(start: Start) -> None:
    """Thermometer publishes each period, even without subscribers, and stamps readings with the node's clock."""
    with start(THERMOMETER) as harness:
        readings = expect_fresh_readings(harness)
        harness.run(UNSUBSCRIBED_SECONDS)
        expected_readings = [received.message.celsius for received in harness.published()]
    in_lockstep = harness.time == LOCKSTEP  # in real time, the grader does not know when the node started
    period = readings[1].seconds - readings[0].seconds if len(readings) > 1 else PERIOD
    if in_lockstep:
        first = readings[0].seconds
        message = (
            f"The first reading was published {first:.2f} s after the start instead of {period:.2f} s, the period."
        )
        expect(abs(first - period) < period / 2, message, fraction=0.5)
    with start(THERMOMETER, clock_rate=SLOW, is_subscribed=False) as harness:
        harness.run(UNSUBSCRIBED_SECONDS)
        harness.subscribe_late()
        readings = expect_fresh_readings(harness)
    for received in readings if in_lockstep else ():
        number, celsius = round(received.seconds / period) - 1, received.message.celsius
        expected = expected_readings[number] if number < len(expected_readings) else celsius
        observation = (
            f"After {UNSUBSCRIBED_SECONDS} s without subscribers, "
            f"the reading {received.seconds:.2f} s after the start was {celsius:.2f} °C"
        )
        expectation = (
            f"With a subscriber from the start, it was {expected:.2f} °C: subscribers must not change the readings."
        )
        expect(near(celsius, expected), f"{observation}. {expectation}", fraction=0.5)


@check(points=2, covers=("smoother", "window", "smoother-topics"), after=BUILD_CHECKS, doc=contract.NODES_DOC)
@hint("sum(...) / len(...) of the readings in the window. At the start, it holds fewer.", "Publish for each reading.")
def test_average(workspace: Workspace, start: Start, draw: Random) -> None:
    """Smoother publishes, for each reading, the average of the newest five, with the stamp of the newest."""
    readings = [round(draw.uniform(20.0, 80.0), 1) for _ in range(12)]
    with start(SMOOTHER) as harness:
        harness.expect_in_graph()
        first, nanoseconds = STAMP
        averages = harness.send(readings, first, nanoseconds=nanoseconds)
        expect_averages([message.celsius for message in averages], readings, WINDOW)
        stamps = [(message.stamp.sec, message.stamp.nanosec) for message in averages]
        are_correct = stamps == [(second, nanoseconds) for second in range(first, first + len(readings))]
        expect(are_correct, "The stamp of an average is not that of the newest reading.", fraction=0.66)
        expect_series(harness, series(), WINDOW, draw, readings, fraction=0.5)
        count = len(harness.send([readings[0]] * QUEUE, apart=0.0))
    message = f"Of {QUEUE} readings that arrived at once, {count} got an average: a queue of {QUEUE} holds them all."
    expect(count == QUEUE, message, fraction=0.75)
    expect_separate_windows(workspace)


@check(points=2, covers=("smoother", "window", "at-start"), after=("average",), doc=contract.PARAMETERS_DOC)
@hint("deque(maxlen=window)", "IntegerRange(from_value=1, to_value=100) in the descriptor.")
def test_window(workspace: Workspace, types: Types, start: Start, draw: Random) -> None:
    """The parameter window sets how many readings count. Smoother refuses to start with 0, 101 or 2.5."""
    window, readings = draw.randint(2, 4), [round(draw.uniform(20.0, 80.0), 1) for _ in range(8)]
    with start(SMOOTHER, window=window) as harness:
        averages = harness.send(readings)
        expect_full_averages([message.celsius for message in averages], readings, window)
        harness.try_to_set(window=1)
        averages += harness.send(readings)
        prefix = "After another window was set: "
        expect_full_averages([message.celsius for message in averages], readings * 2, window, prefix, fraction=0.5)
    for value, is_valid in ((0, False), (1, True), (100, True), (101, False), (2.5, False)):
        has_started = not refuses(workspace, types, SMOOTHER, window=value)
        message = f"smoother {'started' if has_started else 'did not start'} with window {value}."
        expect(has_started is is_valid, message, fraction=0.5)
    with start(SMOOTHER, window=1) as harness:
        expect_series(harness, series(0.0, low=-80.0), 1, draw, [], fraction=0.75)


@check(points=2, covers=("not-finite", "window"), after=("average",))
@hint("math.isfinite(reading.celsius)", "A reading that does not count gets no average either.")
def test_no_number(start: Start, draw: Random) -> None:
    """Smoother ignores a reading that is nan or infinite, and publishes nothing for it."""
    first, second = round(draw.uniform(30.0, 40.0), 1), round(draw.uniform(50.0, 60.0), 1)
    with start(SMOOTHER, window=2) as harness:  # an ignored reading takes no place in the window
        averages = harness.send([first, *UNKNOWN, second])
        actual = [round(message.celsius, 2) for message in averages]
        observation = f"{first}, nan, inf, -inf, {second} °C became {actual}"
        expected = (first + second) / 2
        is_last_correct = bool(actual) and abs(actual[-1] - expected) <= 0.01
        expect(is_last_correct, f"{observation}: the last average should have been {expected:.2f}.")
        expect(len(actual) <= 2, f"{observation}: there are averages for readings that are not finite.", fraction=0.5)
        readings = [first, second]
        expect_series(harness, series(*UNKNOWN), 2, draw, readings, fraction=0.5)
        expect_series(harness, series(HUGE, -HUGE), 2, draw, readings, fraction=0.75)


@check(points=4, covers=("hysteresis", "guard-topics"), after=BUILD_CHECKS, doc=contract.NODES_DOC)
@hint("Two thresholds, and a decision that is remembered.", "True at hot or more; elif at cool or less, False.")
def test_hysteresis(start: Start, draw: Random) -> None:
    """Guard switches the fan on when it is hot, off when it is cool, and leaves it as it was between the two."""
    between, cold, warm = (round(draw.uniform(*limits), 1) for limits in (BETWEEN, (10.0, 40.0), (70.0, 90.0)))
    with start(GUARD) as harness:
        harness.expect_in_graph()
        first_decisions = [bool(message.cooling) for message in harness.send([between])]
        expect_decisions(harness, [cold, warm, cold], "")
        expect_decisions(harness, [warm, between, cold, between], "Between the thresholds: ", fraction=0.5)
        expect_decisions(harness, [HOT, COOL, HOT - 0.1, HOT, COOL + 0.1], "At the thresholds: ", fraction=0.75)
        edges = around_thresholds(HOT, COOL, HOT - 0.1, COOL + 0.1)
        expect_switching(harness, edges, draw, "At the thresholds: ", fraction=0.75)
        expect(
            first_decisions == [False],
            f"At first, at {between} °C, cooling was {first_decisions} instead of [False]: the fan is off.",
            fraction=0.75,
        )


@check(points=2, covers=("hot-cool", "hysteresis", "at-start"), after=("hysteresis",), doc=contract.PARAMETERS_DOC)
@hint("self.declare_parameter('hot', 60.0).value, and cool likewise.", "raise ValueError(...) in __init__.")
@hint("Read the parameters once, in __init__, and not in a callback.")
def test_thresholds(workspace: Workspace, types: Types, start: Start, draw: Random) -> None:
    """Guard uses the values of hot and cool at its start, and refuses to start unless cool is less than hot."""
    hot, cool = draw_thresholds(draw)
    with start(GUARD, hot=hot, cool=cool) as harness:
        prefix = f"With hot {hot} and cool {cool}: "
        expect_decisions(harness, [cool - 1.0, hot + 1.0, cool - 1.0], prefix, hot=hot, cool=cool)
        between = [cool + 1.0, hot + 1.0, cool + 1.0, cool - 1.0, hot - 1.0]
        expect_decisions(harness, between, prefix, hot=hot, cool=cool, fraction=0.5)
        edges = around_thresholds(hot - MARGIN, cool + MARGIN, hot=hot, cool=cool)
        expect_switching(harness, edges, draw, prefix, fraction=0.75, hot=hot, cool=cool)
        expect_decisions(harness, [cool - 1.0], prefix, hot=hot, cool=cool, fraction=0.75)
        harness.run(SILENCE)
        silence_prefix = f"{prefix}after {SILENCE} s without an average, "
        expect_decisions(harness, [cool + 1.0], silence_prefix, hot=hot, cool=cool, fraction=0.75)
        harness.try_to_set(hot=hot + 5.0, cool=cool - 5.0)
        prefix = f"Started with hot {hot} and cool {cool}, which were then set 5 °C further apart: "
        expect_decisions(harness, [hot + 1.0, cool - 1.0], prefix, hot=hot, cool=cool, fraction=0.5)
    for hot_of_two, cool_of_two in ((0.0, -20.0), (20.0, 0.0)):
        thresholds = {"hot": hot_of_two, "cool": cool_of_two}
        temperatures = [hot_of_two + 1.0, cool_of_two + 1.0, cool_of_two - 1.0, hot_of_two - 1.0]
        with start(GUARD, **thresholds) as harness:
            expect_decisions(harness, temperatures, f"With {_values_text(thresholds)}: ", fraction=0.75, **thresholds)
    for invalid_values in (
        {"hot": hot, "cool": hot},
        {"hot": COOL - MARGIN},
        {"cool": HOT + 5.0},
        {"cool": math.nan},
        {"hot": math.nan},
    ):
        is_refused = refuses(workspace, types, GUARD, **invalid_values)
        expect(is_refused, f"guard started with {_values_text(invalid_values)}.", fraction=0.5)


@check(points=1, covers="unknown", after=("hysteresis",))
@hint("nan >= 60.0 is False, and so is nan <= 50.0.", "Check math.isfinite first.")
def test_unknown(start: Start, draw: Random) -> None:
    """If the temperature is not a finite number, it is unknown, and the fan runs."""
    with start(GUARD) as harness:
        expect_decisions(harness, [20.0, math.nan, 20.0, -math.inf, 20.0, math.inf, 20.0, 70.0, -math.inf, 20.0], "")
        expect_switching(harness, around_thresholds(*UNKNOWN), draw, fraction=0.5)


@check(points=1, covers=("guard", "guard-topics"), after=("hysteresis",))
@hint("stamp=average.stamp", "A node that reads a decision needs to know its time and its temperature.")
def test_passes_on(start: Start, draw: Random) -> None:
    """Guard publishes a decision for each average, with the average's stamp and temperature."""
    temperatures = [draw.uniform(70.0, 90.0), draw.uniform(*BETWEEN), draw.uniform(20.0, 40.0)]
    first, nanoseconds = STAMP[0] + draw.randint(100, 999), STAMP[1]
    with start(GUARD) as harness:
        expect_passed_on(temperatures, harness.send(temperatures, first, nanoseconds=nanoseconds), (first, nanoseconds))
        unusual_temperatures = [*UNKNOWN, -temperatures[0], HUGE]
        decisions = harness.send(unusual_temperatures, first, nanoseconds=nanoseconds)
        if len(decisions) == len(unusual_temperatures):  # `unknown` tests whether each average gets a decision
            expect_passed_on(unusual_temperatures, decisions, (first, nanoseconds), fraction=0.5)
        count = len(harness.send(temperatures[:1] * QUEUE, apart=0.0))
    observation = (
        f"Of {QUEUE} averages that arrived at once, {count} got a decision: a queue of {QUEUE} holds them all."
    )
    expect(count == QUEUE, observation, fraction=0.5)


@check(points=1, covers="relative", after=("installs", "readings", "average", "hysteresis"), doc=contract.NODES_DOC)
@hint("A name that begins with a slash is the same in every namespace: two robots would share it.")
@hint("'temperature' is relative, '/temperature' is not.")
def test_relative(workspace: Workspace) -> None:
    """The topics have the default QoS and relative names: in the namespace /a, temperature is /a/temperature."""
    topics = {
        THERMOMETER: ("temperature",),
        SMOOTHER: ("temperature", "smoothed"),
        GUARD: ("smoothed", "decision"),
    }
    messages = [
        message
        for name, names in topics.items()
        if (message := namespaces.missing_in_namespace(workspace, contract.PACKAGE, name, names, plain=True))
    ]
    expect(not messages, " ".join(messages))


def _values_text(values: Mapping[str, float]) -> str:
    return " and ".join(f"{name} {value}" for name, value in values.items())


def draw_wave(draw: Random) -> tuple[float, float, float]:
    """Draw a period in s, a mean below 0 and a swing in degrees Celsius; the default mean is above 0."""
    period = draw.choice((0.1, 0.2, 0.8))
    return period, -round(draw.uniform(20.0, 40.0), 1), round(draw.uniform(3.0, 9.0), 1)


def draw_thresholds(draw: Random) -> tuple[float, float]:
    """Draw the temperatures hot and cool in degrees Celsius."""
    cool = round(draw.uniform(20.0, 30.0), 1)
    return round(cool + draw.uniform(5.0, 10.0), 1), cool
