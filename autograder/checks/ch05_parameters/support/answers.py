"""Compares the node's answers to drawn requests with the contract's."""

from __future__ import annotations

import random
from collections.abc import Collection

from hypothesis.strategies import SearchStrategy

from autograder.checking import LOCKSTEP, expect
from autograder.checking.drawn_cases import expect_each
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import bench
from autograder.checks.ch05_parameters.support.drawn_requests import (
    DISTANCES,
    FOREIGN,
    SAFETY,
    SLOW,
    Dialogue,
    Request,
    Values,
    distance,
    fits,
    values_text,
)
from autograder.checks.ch05_parameters.support.robot import Robot, missing_from

BOTH = frozenset((True, False))


def bring_to(robot: Robot, safety: float, slow: float) -> dict[str, parameters.Value]:
    """Set both distances, and return the present ones.

    Each request names one distance, and fits the other one. Other checks test whether the node takes such requests.
    """
    for name, value in ((SLOW, 3.0), (SAFETY, safety), (SLOW, slow)):
        robot.change({name: robot.allowed(name, value, up=name == SLOW)})
    return robot.parameters.values(*DISTANCES)


def expect_answers(
    robot: Robot,
    dialogues: SearchStrategy[Dialogue],
    draw: random.Random,
    *,
    fraction: float,
    judged: Collection[bool] = BOTH,
    count: int = 8,
) -> None:
    """Fail the check unless the node takes what fits and refuses the rest, and then has the values that this gives.

    Args:
        robot: the node.
        dialogues: the requests.
        draw: the check's random generator.
        fraction: the fraction of the points after a failure.
        judged: the answers that the check tests: True for requests that fit, False for those that do not.
        count: how many dialogues there are. In real time, there are fewer.
    """
    foreign = robot.parameters.values(FOREIGN)  # unchanged, because the harness sets the clock by it

    def judge(dialogue: Dialogue) -> None:
        present = bring_to(robot, *dialogue.present)
        expected = dict(present)
        asked: list[str] = []
        for request in dialogue.requests:
            sent = _sent(robot, request, foreign)
            is_right = fits({**present, **sent})
            if not sent or is_right not in judged:
                continue
            answer = robot.change(sent)
            before = f"It was asked for {'; then for '.join(asked)}. Then, with" if asked else "With"
            verb = "took" if answer.accepted else "refused"
            situation = f"{before} {values_text(present)}, it {verb} {values_text(sent)}"
            reason = f": “{answer.reason}”" if is_right else ""
            expectation = f"although the distances then {'fit' if is_right else 'do not fit'}{reason}"
            expect(answer.accepted == is_right, f"{situation}, {expectation}.", fraction=fraction)
            asked.append(values_text(sent))
            if is_right:
                expected |= parameters.as_declared(sent, robot.initial)
            present = {name: expected[name] for name in present}
        wrong = parameters.differences(robot.parameters.values(*expected), expected)
        expect(not wrong, f"After requests for {'; then for '.join(asked)}, {'; '.join(wrong)}.", fraction=fraction)

    expect_each(dialogues, judge, draw, count=count if robot.time == LOCKSTEP else 3)


def allowed_start(robot: Robot, start: Request) -> dict[str, parameters.Value]:
    """Return the values of a start, with numbers that the node's types and steps allow."""
    numbers = {name: value for name, value in start if isinstance(value, int | float)}
    allowed = {name: robot.allowed(name, value, up=name == SLOW) for name, value in numbers.items()}
    return parameters.as_declared(allowed, robot.initial)


def subtlety(values: Values) -> tuple[bool, int]:
    """Return a key that sorts starts: those with equal distances last, and before them by the number of values."""
    return distance(values, SAFETY) == distance(values, SLOW), len(values)


def expect_start(values: Values, start: bench.Start) -> None:
    """Fail the check unless contradiction and declare_configuration judge these values of a start as they should."""
    situation = f"Started with {values_text(values)}" if values else "Started with its defaults"
    sentence, message = parameters.shortened(str(start.sentence.value)), parameters.shortened(start.declared.message)
    says = f"contradiction {f'raised {start.sentence.raised}' if start.sentence.raised else f'says “{sentence}”'}"
    raised = f"{situation}, declare_configuration raised {start.declared.raised or 'nothing'}"
    if fits(values):
        expect(start.sentence.value == "", f"{situation}, {says}, instead of returning ''.", fraction=0.5)
        expect(not start.declared.raised, f"{raised}: {message}. But the distances fit.", fraction=0.5)
        return
    distances = {name: distance(values, name) for name in DISTANCES}
    fraction = 0.75 if subtlety(values)[0] else 0.5
    expect(bool(start.declared.raised), f"{raised}, although the distances do not fit.", fraction=fraction)
    expect("ValueError" in start.declared.kinds, f"{raised}, which is no ValueError.", fraction=0.5)
    missing = ", ".join(missing_from(sentence, distances))
    expect(not missing, f"{situation}, {says}: it does not name {missing}.", fraction=0.5)
    expect(sentence[:100] in message, f"{raised} with “{message}”; {says}.", fraction=0.75)


def _sent(robot: Robot, request: Request, foreign: Values) -> dict[str, parameters.Value]:
    """Return a request with the numbers and names that the node allows; other checks test which ones these are."""
    numbers = {
        name: robot.allowed(name, value, up=name == SLOW)
        for name, value in request
        if isinstance(value, int | float) and name in robot.initial
    }
    known = robot.without_read_only(numbers)
    return {
        name: foreign[name] if name in foreign else known[name]
        for name, _ in request
        if name in foreign or name in known
    }
