"""The drawn requests of 05 find typical mistakes with every seed, and no correct node fails with them."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest

from autograder.checking import LOCKSTEP
from autograder.checks.ch05_parameters.support import answers
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, SPECIFICATIONS
from autograder.checks.ch05_parameters.support.drawn_requests import (
    ACCEPTED,
    ANY_VALUES,
    DISTANCES,
    FOREIGN,
    REFUSED,
    SAFETY,
    SLOW,
    WITHOUT_DISTANCES,
    dialogues,
    fits,
    starts,
)
from autograder.probes.parameters import SetParametersReply
from autograder.suite import CheckFailed
from autograder.suite.drawn_cases import expect_each

SEEDS = range(4)
Validate = Callable[["Node", dict[str, Any]], bool]
KINDS: dict[str, tuple[Any, dict[str, Any]]] = {
    "contradiction": (dialogues(REFUSED), {"tested_answers": (False,)}),
    "together": (dialogues(ACCEPTED), {"tested_answers": (True,)}),
    "no_side_effects": (dialogues(WITHOUT_DISTANCES, ACCEPTED, REFUSED, first=REFUSED, is_clear=True), {}),
    "passes": (dialogues(WITHOUT_DISTANCES, other_parameters=ANY_VALUES), {"tested_answers": (True,)}),
    "beside_others": (dialogues(REFUSED, ACCEPTED, WITHOUT_DISTANCES, is_clear=True, names_foreign=True), {}),
}


class Node:
    """A node in the place of the student's; `validate` judges each request."""

    time = LOCKSTEP

    def __init__(self, validate: Validate) -> None:
        self.initial, self.stored, self.memory = dict(DEFAULTS), {**DEFAULTS, FOREIGN: True}, dict[str, Any]()
        self.parameters, self._validate = self, validate

    def values(self, *names: str) -> dict[str, Any]:
        return {name: self.stored[name] for name in names}

    def change(self, request: dict[str, Any]) -> SetParametersReply:
        accepted = self._validate(self, request)
        self.stored |= request if accepted else {}
        return SetParametersReply(accepted)

    @staticmethod
    def allowed(_name: str, number: float, *, up: bool = False) -> float:
        del up
        return number

    @staticmethod
    def without_read_only(values: dict[str, Any]) -> dict[str, Any]:
        return values


def _right(node: Node, request: dict[str, Any]) -> bool:
    return fits({**node.stored, **request})


def _remembers(node: Node, request: dict[str, Any]) -> bool:
    node.memory |= request
    return fits({**node.stored, **node.memory})


def _one_after_the_other(node: Node, request: dict[str, Any]) -> bool:
    names = list(request)
    return all(fits({**node.stored, **{name: request[name] for name in names[: i + 1]}}) for i in range(len(names)))


WRONG: dict[str, tuple[str, Validate]] = {
    "equal distances": (
        "contradiction",
        lambda node, new: not fits({SAFETY: (v := {**node.stored, **new})[SLOW], SLOW: v[SAFETY]}),
    ),
    "by the first name": ("contradiction", lambda node, new: next(iter(new)) not in DISTANCES or _right(node, new)),
    "by the last name": ("contradiction", lambda node, new: [*new][-1] not in DISTANCES or _right(node, new)),
    "both alone": ("contradiction", lambda node, new: not set(DISTANCES) <= set(new) or _right(node, new)),
    "one alone": ("contradiction", lambda node, new: set(DISTANCES) <= set(new) or _right(node, new)),
    "in the order of the request": ("together", _one_after_the_other),
    "a gap": ("together", lambda node, new: (v := {**node.stored, **new})[SLOW] - v[SAFETY] > 0.1),
    "within the limits": ("together", lambda node, new: _right(node, new) and not {0.2, 3.0} & {*new.values()}),
    "two names at most": ("together", lambda node, new: _right(node, new) and len(new) < 3),
    "what was refused": ("no_side_effects", _remembers),
    "zero": ("passes", lambda node, new: _right(node, new) and all(value != 0 for value in new.values())),
    "no strangers": ("passes", lambda node, new: FOREIGN not in new and _right(node, new)),
    "strangers": ("beside_others", lambda node, new: FOREIGN in new or _right(node, new)),
}


def _passes(kind: str, validate: Validate, seed: int) -> bool:
    strategy, options = KINDS[kind]
    try:
        answers.expect_answers(Node(validate), strategy, random.Random(seed), fraction=0.5, **options)  # type: ignore[arg-type]
    except CheckFailed:
        return False
    return True


@pytest.mark.parametrize("kind", KINDS)
def test_a_right_node_answers_all_requests_as_it_should(kind: str) -> None:
    assert all(_passes(kind, _right, seed) for seed in SEEDS)


WRONG_RULES: dict[str, Validate] = {
    "equal distances": WRONG["equal distances"][1],
    "the present distances": lambda node, new: all(fits({**node.stored, name: new[name]}) for name in new),
    "the defaults": lambda node, new: fits(new) or not {*DISTANCES} & {*new},
    "safety distance alone": lambda node, new: SAFETY not in new or _right(node, new),
    "slow distance alone": lambda node, new: SLOW not in new or _right(node, new),
}


@pytest.mark.parametrize("kind", ["no_side_effects", "beside_others"])
@pytest.mark.parametrize("rule", WRONG_RULES)
def test_a_wrong_rule_for_the_distances_is_the_fault_of_other_checks(rule: str, kind: str) -> None:
    assert all(_passes(kind, WRONG_RULES[rule], seed) for seed in SEEDS)


@pytest.mark.parametrize("mistake", WRONG)
def test_requests_find_a_mistake_with_every_seed(mistake: str) -> None:
    kind, validate = WRONG[mistake]
    assert not any(_passes(kind, validate, seed) for seed in SEEDS)


def test_asks_for_values_within_the_limits() -> None:
    requests: list[tuple[tuple[str, Any], ...]] = []
    for strategy, _ in KINDS.values():
        expect_each(strategy, lambda dialogue: requests.extend(dialogue.requests), random.Random(1), count=30)
    for kind in (REFUSED, ACCEPTED):
        expect_each(starts(kind), requests.append, random.Random(1), count=30)
    for name, value in (pair for request in requests for pair in request if pair[0] != FOREIGN):
        specification = SPECIFICATIONS[name]
        assert specification.low is not None
        assert specification.high is not None
        assert specification.low <= value <= specification.high
        assert type(value) is type(specification.default)
