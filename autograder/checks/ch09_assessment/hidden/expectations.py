"""Expectations about the readings, averages and decisions of the three nodes."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import Any

from autograder.checking import CheckFailed, ReceivedMessage, Workspace, expect
from autograder.checking.probes import calls, node_callbacks
from autograder.checks.ch09_assessment.support.contract import (
    COOL,
    HOT,
    INTERFACES,
    MEAN,
    PACKAGE,
    PERIOD,
    SMOOTHER,
    SWING,
    THERMOMETER,
    averages,
    decisions,
)
from autograder.checks.ch09_assessment.support.robot import MESSAGE_SECONDS, NodeHarness, Start, near

READING_COUNT = 12  # readings in a series
RECORDING_SECONDS = 2.2  # s for which readings are received: more than four default periods
FLOAT32 = 1e-6  # the precision of a number in a message
MAX_AGE = 0.1  # s between the stamp of a reading and its arrival


def expect_measured(start: Start, period: float, mean: float, swing: float, reading: Callable[..., float]) -> None:
    """Fail the check unless a thermometer uses these parameters, even after other values were set."""
    with start(THERMOMETER, period=period, mean=mean, swing=swing) as harness:
        harness.expect_readings(READING_COUNT, period, mean, swing, reading=reading)
        harness.try_to_set(period=2 * period, mean=mean + 10.0, swing=swing + 5.0)
        try:
            harness.expect_readings(READING_COUNT, period, mean, swing, reading=reading)
        except CheckFailed as error:
            raise CheckFailed(f"After other parameters were set: {error.message}", fraction=0.5) from error


def student_reading(start: Start) -> Callable[[int, float, float], float]:
    """Return a formula for the student's readings with other parameters, derived from those with the defaults."""
    with start(THERMOMETER) as harness:
        harness.run((2 * READING_COUNT + 2) * PERIOD)
        shares = [(received.message.celsius - MEAN) / SWING for received in harness.published()]
    return lambda number, mean, swing: mean + swing * shares[number] if number < len(shares) else math.nan


def expect_fresh_readings(harness: NodeHarness) -> list[ReceivedMessage]:
    """Return the thermometer's next readings; fail the check unless each was stamped when it was published."""
    start = harness.seconds
    harness.run(RECORDING_SECONDS)
    now_ns, now, readings = harness.now_ns, harness.seconds, harness.published(start)
    arrivals = [now_ns - round((now - received.seconds) * 1e9) for received in readings]
    stamps = [received.message.stamp for received in readings]
    ages = [
        round((arrival - stamp.sec * 10**9 - stamp.nanosec) / 1e9, 3)
        for arrival, stamp in zip(arrivals, stamps, strict=True)
    ]
    are_fresh = bool(ages) and all(abs(age) < MAX_AGE for age in ages)
    observation = f"By their stamps, its readings were {ages} s old when they arrived"
    expect(are_fresh, f"{observation}: publish each reading immediately, with the time of the node's clock.")
    return readings


def expect_averages(
    actual: list[float], readings: list[float], window: int, prefix: str = "", *, fraction: float = 0.0
) -> None:
    """Fail the check unless these are the averages of the readings."""
    count = f"{prefix}{len(readings)} readings led to {len(actual)} averages."
    expect(len(actual) == len(readings), count, fraction=fraction)
    expected = averages(readings, window)
    index = next((i for i in range(len(readings)) if not near(actual[i], expected[i])), 0)
    newest = ", ".join(map(str, readings[: index + 1][-window:]))
    is_correct = near(actual[index], expected[index])
    message = f"With the window {window}, the average of {newest} °C was {actual[index]:.2f} °C."
    expect(is_correct, f"{prefix}{message}", fraction=fraction)


def expect_full_averages(
    actual: list[float], readings: list[float], window: int, prefix: str = "", *, fraction: float = 0.0
) -> None:
    """Fail the check unless the averages of full windows are correct. Another check tests the averages before them."""
    expected = averages(readings, window)[window - 1 :]
    newest = actual[-len(expected) :]
    count = f"{prefix}{len(readings)} readings led to {len(actual)} averages."
    expect(len(newest) == len(expected) and len(actual) <= len(readings), count, fraction=fraction)
    index = next((i for i in range(len(expected)) if not near(newest[i], expected[i])), None)
    numbers = ", ".join(map(str, readings[index : index + window])) if index is not None else ""
    message = f"With the window {window}, the average of {numbers} °C was {newest[index or 0]:.2f} °C."
    expect(index is None, f"{prefix}{message}", fraction=fraction)


def expect_decisions(
    harness: NodeHarness,
    temperatures: Sequence[float],
    prefix: str,
    *,
    hot: float = HOT,
    cool: float = COOL,
    fraction: float = 0.0,
    apart: float = MESSAGE_SECONDS,
) -> None:
    """Fail the check unless the guard makes the correct decisions on these temperatures, sent `apart` s apart."""
    actual = [bool(message.cooling) for message in harness.send(temperatures, apart=apart)]
    count = f"{len(temperatures)} averages led to {len(actual)} decisions."
    expect(len(actual) == len(temperatures), count, fraction=fraction)
    allowed_states = decisions(temperatures, hot, cool)
    numbers = ", ".join(f"{celsius:g}" for celsius in temperatures)
    index = next((i for i, decision in enumerate(actual) if decision not in allowed_states[i]), None)
    message = f"{prefix}at {numbers} °C, cooling was {actual}. Decision {(index or 0) + 1} is wrong."
    expect(index is None, message[:1].upper() + message[1:], fraction=fraction)


def expect_passed_on(
    temperatures: Sequence[float], decisions: Sequence[Any], stamp: tuple[int, int], *, fraction: float = 0.0
) -> None:
    """Fail the check unless these decisions have the temperatures and stamps of their averages.

    The averages' stamps start with `stamp`, in s and ns, and are a second apart.
    """
    expect(len(decisions) == len(temperatures), f"{len(temperatures)} averages led to {len(decisions)} decisions.")
    first, nanoseconds = stamp
    for second, (celsius, decision) in enumerate(zip(temperatures, decisions, strict=True), first):
        actual = decision.stamp
        is_correct = (actual.sec, actual.nanosec) == (second, nanoseconds)
        observation = f"The stamp of a decision is {actual.sec} s and {actual.nanosec} ns"
        expectation = f"The stamp of its average, {celsius:.1f} °C, was {second} s and {nanoseconds} ns."
        is_partly_correct = second > first or actual.sec == second
        expect(is_correct, f"{observation}. {expectation}", fraction=0.5 if is_partly_correct else fraction)
        is_same = math.isclose(decision.celsius, celsius, rel_tol=FLOAT32) or str(decision.celsius) == str(celsius)
        expect(
            is_same, f"The decision on {celsius:.5f} °C has the temperature {decision.celsius:.5f} °C.", fraction=0.5
        )


def expect_separate_windows(workspace: Workspace) -> None:
    """Fail the check if two smoothers in one process share their window."""
    node = calls.call("Smoother")
    cold, warm = (calls.call("Temperature", module=f"{INTERFACES}.msg", celsius=celsius) for celsius in (20.0, 40.0))
    turns = [(number, "temperature_callback", message) for number, message in ((0, cold), (1, warm), (0, cold))]
    texts = node_callbacks.published(workspace, f"{PACKAGE}.{SMOOTHER}", [node, node], turns)
    averages_of_calls = [re.findall(r"celsius=(-?\d{1,40}(?:\.\d{1,40})?)[,)]", text) for text in texts]
    if not all(len(averages_of_call) == 1 for averages_of_call in averages_of_calls):
        return  # the smoother does not publish in its callback, which is allowed
    actual = [float(average) for (average,) in averages_of_calls]
    situation = "Two smoothers in one process received readings of 20 °C and of 40 °C."
    message = f"{situation} The second one published {actual[1]:.1f} °C: each should average its own readings."
    expect(all(map(near, actual, (20.0, 40.0, 20.0))), message, fraction=0.5)
