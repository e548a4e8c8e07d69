"""The order of turns: each answer is served once, and no waiting student is overtaken twice by the same one."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from datetime import datetime, timezone

from hypothesis import given
from hypothesis import strategies as st

from autograder.lms.serve.hand_in import HandIn
from autograder.lms.serve.queue import ahead_of, in_order, next_turn

AT = datetime(2026, 10, 5, tzinfo=timezone.utc)
STUDENTS = st.sampled_from("abcde")
# Events at the service: a student hands in, or (None) the next turn is served.
EVENTS = st.lists(st.one_of(STUDENTS, st.none()), max_size=60)


def waiting(number: int, student: str) -> HandIn:
    return HandIn(number, student, "02_nodes", AT)


def hand_ins_of(students: str) -> list[HandIn]:
    return [waiting(number, student) for number, student in enumerate(students, 1)]


def order(students: str, turns: dict[str, int] | None = None, busy: str = "") -> str:
    return "".join(hand_in.student for hand_in in in_order(hand_ins_of(students), turns or {}, busy))


@dataclass
class Desk:
    """A queue that serves one answer after another."""

    waiting: list[HandIn] = field(default_factory=list)
    turns: dict[str, int] = field(default_factory=dict)
    served: list[HandIn] = field(default_factory=list)
    count: int = 0

    def receive(self, student: str) -> None:
        self.count += 1
        self.waiting.append(waiting(self.count, student))

    def serve(self) -> None:
        if (turn := next_turn(self.waiting, self.turns, ())) is not None:
            self.waiting.remove(turn)
            self.served.append(turn)
            self.turns[turn.student] = len(self.served)

    def follow(self, events: list[str | None]) -> None:
        for event in events:
            if event is None:
                self.serve()
            else:
                self.receive(event)


def test_students_take_turns() -> None:
    assert order("aaabbc") == "abcaba"


def test_the_student_whose_last_turn_was_longest_ago_is_next() -> None:
    assert order("abc", {"a": 3, "b": 1, "c": 2}) == "bca"


def test_students_without_a_turn_come_before_all_others() -> None:
    assert order("abc", {"a": 1, "b": 2}) == "cab"


def test_a_student_who_is_being_graded_comes_after_all_others() -> None:
    assert order("aabc", {"b": 9}, busy="a") == "cbaa"


def test_a_student_has_one_answer_graded_at_a_time() -> None:
    assert next_turn(hand_ins_of("aab"), {}, ("a",)) == waiting(3, "b")
    assert next_turn(hand_ins_of("aa"), {}, ("a",)) is None


def test_the_number_of_answers_ahead_is_the_position_in_the_order() -> None:
    assert [ahead_of(number, hand_ins_of("aab"), {}, ()) for number in (1, 2, 3)] == [0, 2, 1]


@given(st.text("abcde", max_size=40), st.dictionaries(STUDENTS, st.integers(1, 99)), st.sets(STUDENTS))
def test_each_answer_has_one_turn_and_those_of_a_student_keep_their_order(
    students: str, turns: dict[str, int], busy: set[str]
) -> None:
    waiting = hand_ins_of(students)
    served = list(in_order(reversed(waiting), turns, busy))
    assert sorted(served, key=lambda hand_in: hand_in.number) == waiting
    for student in set(students):
        numbers = [hand_in.number for hand_in in served if hand_in.student == student]
        assert numbers == sorted(numbers)


@given(EVENTS)
def test_no_waiting_student_is_overtaken_twice_by_the_same_one(events: list[str | None]) -> None:
    desk = Desk()
    overtaken: dict[str, Counter[str]] = {}  # for each waiting student: by whom, since the last turn or arrival
    for event in events:
        if event is not None:
            desk.receive(event)
            overtaken.setdefault(event, Counter())
            continue
        before = len(desk.served)
        desk.serve()
        for turn in desk.served[before:]:
            del overtaken[turn.student]
            for student in {hand_in.student for hand_in in desk.waiting}:
                overtaken.setdefault(student, Counter())[turn.student] += student != turn.student
            assert max((count for counts in overtaken.values() for count in counts.values()), default=0) <= 1


@given(EVENTS)
def test_each_answer_is_served_once_whenever_it_arrives(events: list[str | None]) -> None:
    desk = Desk()
    desk.follow(events)
    while desk.waiting:
        desk.serve()
    assert sorted(hand_in.number for hand_in in desk.served) == list(range(1, desk.count + 1))


@given(EVENTS)
def test_the_announced_order_is_kept_if_no_answer_arrives(events: list[str | None]) -> None:
    desk = Desk()
    desk.follow(events)
    expected_order, served_count = list(in_order(desk.waiting, desk.turns)), len(desk.served)
    while desk.waiting:
        desk.serve()
    assert desk.served[served_count:] == expected_order
