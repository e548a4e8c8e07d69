"""The turns of programs in lockstep: their order, and which of them can run at once."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from autograder.harness.base import Program
from autograder.harness.turns import Place, SteppedProgram, Turn, batches, flow, turns_of
from autograder.run.lockstep.protocol import Description

NO_STEPPER: Any = None  # no program runs here
SCAN, WORD = "/scan T reliable volatile", "/word T reliable volatile"
ASK = "/ask T request"
GRADER = Place()
AT = (199, 200)  # the instants of a step's phases


def _program(
    *inbox: tuple[Place, dict[str, int]], number: int = 0, due: int | None = None, **description: Any
) -> SteppedProgram:
    program = SteppedProgram(number, Program("pkg", f"{number}"), NO_STEPPER, Description(**description), due=due)
    program.inbox = [(place, Counter(messages)) for place, messages in inbox]
    return program


def _turns(program: SteppedProgram, *, alone: bool = False) -> list[tuple[int, dict[str, int]]]:
    turns = turns_of(program, AT, alone=alone)
    assert [turn.place for turn in turns] == sorted(turn.place for turn in turns)
    return [(turn.instant, dict(turn.messages)) for turn in turns]


@pytest.mark.parametrize(
    ("due", "alone", "instants"),
    [
        (None, False, []),
        (201, False, []),
        (200, False, [200]),
        (199, False, [200]),
        (199, True, [199, 200]),
        (200, True, [200]),
        (0, False, [200]),
    ],
    ids=["never", "later", "at the end", "before it", "before it, alone", "at the end, alone", "at every instant"],
)
def test_a_program_without_messages_has_turns_if_something_is_due(
    due: int | None, alone: bool, instants: list[int]
) -> None:
    assert _turns(_program(due=due), alone=alone) == [(instant, {}) for instant in instants]


def test_after_messages_a_program_has_another_turn_at_the_end_of_the_step() -> None:
    assert _turns(_program((GRADER, {SCAN: 2}))) == [(199, {SCAN: 2}), (200, {})]


def test_messages_of_earlier_programs_are_taken_in_the_same_round_and_those_of_later_ones_in_the_next() -> None:
    earlier, later = (Place(0, 0, 0), {SCAN: 1}), (Place(0, 0, 2), {WORD: 1})
    assert _turns(_program(earlier, later, number=1)) == [(199, {SCAN: 1}), (199, {WORD: 1}), (200, {})]


def test_messages_sent_at_the_end_of_a_step_are_taken_in_that_step() -> None:
    at_its_end = (Place(1, 0, 0), {WORD: 1})
    assert _turns(_program((GRADER, {SCAN: 1}), at_its_end, number=1)) == [(199, {SCAN: 1}), (200, {WORD: 1})]


def test_a_program_runs_at_once_for_turns_with_messages_of_different_topics() -> None:
    best_effort = SCAN.replace("reliable", "best-effort")
    messages_per_turn = [{SCAN: 1}, {WORD: 1}, {}, {best_effort: 1}, {}]
    turns = [Turn(Place(0, round_), 199, messages) for round_, messages in enumerate(messages_per_turn)]
    assert [[turn.messages for turn in batch] for batch in batches(turns)] == [
        messages_per_turn[:3],
        messages_per_turn[3:],
    ]
    assert batches([]) == []


def test_programs_are_in_an_order_in_which_each_gets_its_messages_from_earlier_ones() -> None:
    listener = _program(readers=(((WORD,), 1),))
    relay = _program(number=1, readers=(((SCAN,), 1),), writers=((WORD, 1),))
    source = _program(number=2, writers=((SCAN, 1),))
    assert flow([listener, relay, source]) == [source, relay, listener]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ({"writers": ((WORD, 1),), "readers": (((SCAN,), 1),)}, {"writers": ((SCAN, 1),), "readers": (((WORD,), 1),)}),
        ({"clients": ((ASK, True),), "prefix": "0a"}, {"servers": (ASK,)}),
        ({"writers": ((WORD, 1),)}, {"writers": ((WORD.replace("volatile", "transient_local"), 1),)}),
    ],
    ids=["they answer each other", "one serves the other", "both publish on one topic"],
)
def test_programs_have_no_such_order_if_messages_come_back_or_meet(
    first: dict[str, Any], second: dict[str, Any]
) -> None:
    assert flow([_program(**first), _program(number=1, **second)]) is None


def test_a_program_that_reads_parameter_events_comes_after_the_others() -> None:
    events = "/parameter_events rcl_interfaces/msg/ParameterEvent reliable volatile"
    reader, other = _program(readers=(((events,), 2),)), _program(number=1)
    assert flow([reader, other]) == [other, reader]
