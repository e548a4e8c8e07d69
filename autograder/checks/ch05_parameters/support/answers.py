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

    Each request names one distance, which fits the other one. Other checks test whether the node accepts such requests.
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
    tested_answers: Collection[bool] = BOTH,
    count: int = 8,
) -> None:
    """Fail the check unless the node accepts requests that fit, refuses the others, and ends with the correct values.

    Args:
        robot: the node.
        dialogues: the requests.
        draw: the check's random generator.
        fraction: the fraction of the points that remains after a failure.
        tested_answers: the answers that the check tests: True for requests that fit, False for those that do not.
        count: how many dialogues are drawn; in real time, there are fewer.
    """
    foreign_values = robot.parameters.values(FOREIGN)  # unchanged, because the harness's clock depends on it

    def judge(dialogue: Dialogue) -> None:
        current = bring_to(robot, *dialogue.present)
        expected = dict(current)
        request_texts: list[str] = []
        for request in dialogue.requests:
            allowed_request = _allowed_part(robot, request, foreign_values)
            should_accept = fits({**current, **allowed_request})
            if not allowed_request or should_accept not in tested_answers:
                continue
            answer = robot.change(allowed_request)
            prefix = f"It was asked for {'; then for '.join(request_texts)}. Then, with" if request_texts else "With"
            verb = "accepted" if answer.accepted else "refused"
            observation = f"{prefix} {values_text(current)}, it {verb} {values_text(allowed_request)}"
            reason = f": “{answer.reason}”" if should_accept else ""
            expectation = f"although the distances then {'fit' if should_accept else 'do not fit'}{reason}"
            expect(answer.accepted == should_accept, f"{observation}, {expectation}.", fraction=fraction)
            request_texts.append(values_text(allowed_request))
            if should_accept:
                expected |= parameters.as_declared(allowed_request, robot.initial)
            current = {name: expected[name] for name in current}
        differences = parameters.differences(robot.parameters.values(*expected), expected)
        message = f"After requests for {'; then for '.join(request_texts)}, {'; '.join(differences)}."
        expect(not differences, message, fraction=fraction)

    expect_each(dialogues, judge, draw, count=count if robot.time == LOCKSTEP else 3)


def allowed_start(robot: Robot, start: Request) -> dict[str, parameters.Value]:
    """Return start values, with numbers that the node's types and steps allow."""
    numbers = {name: value for name, value in start if isinstance(value, int | float)}
    allowed_numbers = {name: robot.allowed(name, value, up=name == SLOW) for name, value in numbers.items()}
    return parameters.as_declared(allowed_numbers, robot.initial)


def start_sort_key(values: Values) -> tuple[bool, int]:
    """Return a key that sorts starts by their number of values, and those with equal distances to the end."""
    return distance(values, SAFETY) == distance(values, SLOW), len(values)


def expect_start(values: Values, start: bench.StartOutcome) -> None:
    """Fail the check unless contradiction and declare_configuration judge these values of a start correctly."""
    situation = f"Started with {values_text(values)}" if values else "Started with its defaults"
    contradiction, declaration = start.contradiction, start.declaration
    sentence, error = parameters.shortened(str(contradiction.value)), parameters.shortened(declaration.message)
    answer = f"raised {contradiction.raised}" if contradiction.raised else f"returned “{sentence}”"
    answer_text = f"{situation}, contradiction {answer}"
    error_text = f"{situation}, declare_configuration raised {declaration.raised or 'nothing'}"
    if fits(values):
        expect(contradiction.value == "", f"{answer_text}, instead of returning ''.", fraction=0.5)
        expect(not declaration.raised, f"{error_text}: {error}. But the distances fit.", fraction=0.5)
        return
    distances = {name: distance(values, name) for name in DISTANCES}
    has_equal_distances, _ = start_sort_key(values)
    fraction = 0.75 if has_equal_distances else 0.5
    expect(bool(declaration.raised), f"{error_text}, although the distances do not fit.", fraction=fraction)
    expect("ValueError" in declaration.kinds, f"{error_text}, which is not a ValueError.", fraction=0.5)
    missing = ", ".join(missing_from(sentence, distances))
    expect(not missing, f"{answer_text}, which does not name {missing}.", fraction=0.5)
    message = f"{error_text} with “{error}”, without the sentence of contradiction: “{sentence}”."
    expect(sentence[:100] in error, message, fraction=0.75)


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
