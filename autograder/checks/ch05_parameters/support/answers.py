"""Compares the node's answers to drawn requests with those of the contract."""

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
    """Set both distances, and return those that the node then has.

    Each request names one distance, which fits the other one. Other checks test whether the node takes such requests.
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
    """Fail the check unless the node takes requests that fit, refuses the others, and ends with the right values.

    Args:
        robot: the node.
        dialogues: the requests.
        draw: the check's random generator.
        fraction: the fraction of the points that remains after a failure.
        judged: the answers that the check tests: True for requests that fit, False for those that do not.
        count: how many dialogues are drawn; in real time, there are fewer.
    """
    foreign_values = robot.parameters.values(FOREIGN)  # unchanged, because the harness's clock depends on it

    def judge(dialogue: Dialogue) -> None:
        present = bring_to(robot, *dialogue.present)
        expected = dict(present)
        request_texts: list[str] = []
        for request in dialogue.requests:
            allowed_request = _allowed_part(robot, request, foreign_values)
            is_right = fits({**present, **allowed_request})
            if not allowed_request or is_right not in judged:
                continue
            answer = robot.change(allowed_request)
            before = f"It was asked for {'; then for '.join(request_texts)}. Then, with" if request_texts else "With"
            verb = "took" if answer.accepted else "refused"
            situation = f"{before} {values_text(present)}, it {verb} {values_text(allowed_request)}"
            reason = f": “{answer.reason}”" if is_right else ""
            expectation = f"although the distances then {'fit' if is_right else 'do not fit'}{reason}"
            expect(answer.accepted == is_right, f"{situation}, {expectation}.", fraction=fraction)
            request_texts.append(values_text(allowed_request))
            if is_right:
                expected |= parameters.as_declared(allowed_request, robot.initial)
            present = {name: expected[name] for name in present}
        wrong = parameters.differences(robot.parameters.values(*expected), expected)
        expect(
            not wrong, f"After requests for {'; then for '.join(request_texts)}, {'; '.join(wrong)}.", fraction=fraction
        )

    expect_each(dialogues, judge, draw, count=count if robot.time == LOCKSTEP else 3)


def allowed_start(robot: Robot, start: Request) -> dict[str, parameters.Value]:
    """Return start values, with numbers that the node's types and steps allow."""
    numbers = {name: value for name, value in start if isinstance(value, int | float)}
    allowed_numbers = {name: robot.allowed(name, value, up=name == SLOW) for name, value in numbers.items()}
    return parameters.as_declared(allowed_numbers, robot.initial)


def subtlety(values: Values) -> tuple[bool, int]:
    """Return a key that sorts starts: by the number of values, but those with equal distances last."""
    return distance(values, SAFETY) == distance(values, SLOW), len(values)


def expect_start(values: Values, start: bench.Start) -> None:
    """Fail the check unless contradiction and declare_configuration judge these values of a start correctly."""
    situation = f"Started with {values_text(values)}" if values else "Started with its defaults"
    sentence, message = parameters.shortened(str(start.sentence.value)), parameters.shortened(start.declared.message)
    answer_text = (
        f"contradiction {f'raised {start.sentence.raised}' if start.sentence.raised else f'says “{sentence}”'}"
    )
    error_text = f"{situation}, declare_configuration raised {start.declared.raised or 'nothing'}"
    if fits(values):
        expect(start.sentence.value == "", f"{situation}, {answer_text}, instead of returning ''.", fraction=0.5)
        expect(not start.declared.raised, f"{error_text}: {message}. But the distances fit.", fraction=0.5)
        return
    distances = {name: distance(values, name) for name in DISTANCES}
    fraction = 0.75 if subtlety(values)[0] else 0.5
    expect(bool(start.declared.raised), f"{error_text}, although the distances do not fit.", fraction=fraction)
    expect("ValueError" in start.declared.kinds, f"{error_text}, which is no ValueError.", fraction=0.5)
    missing = ", ".join(missing_from(sentence, distances))
    expect(not missing, f"{situation}, {answer_text}: it does not name {missing}.", fraction=0.5)
    expect(sentence[:100] in message, f"{error_text} with “{message}”; {answer_text}.", fraction=0.75)


def _allowed_part(robot: Robot, request: Request, foreign_values: Values) -> dict[str, parameters.Value]:
    """Return the part of a request that the node allows, with allowed numbers; other checks test what it allows."""
    numbers = {
        name: robot.allowed(name, value, up=name == SLOW)
        for name, value in request
        if isinstance(value, int | float) and name in robot.initial
    }
    known_values = robot.without_read_only(numbers)
    return {
        name: foreign_values[name] if name in foreign_values else known_values[name]
        for name, _ in request
        if name in foreign_values or name in known_values
    }
