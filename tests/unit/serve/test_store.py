"""The store of hand-ins keeps received answers over a restart, and selects the answer that counts."""

from __future__ import annotations

import multiprocessing
import stat
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest

from autograder.exceptions import UsageError
from autograder.lms.serve.hand_in import HandIn, Mark, counted_hand_in
from autograder.lms.serve.store import Store
from autograder.result.model import Status

NOW = datetime(2026, 10, 5, 12, 0, tzinfo=timezone.utc)
FULL, HALF = Mark(Status.GRADED, 53.0, 53.0), Mark(Status.GRADED, 26.5, 53.0)
STRANGE = "../../ada\n<b>\u202e'; DROP TABLE hand_in"


def hand_in(number: int, mark: Mark | None) -> HandIn:
    return HandIn(number, "ada", "02_nodes", NOW, mark)


def test_a_received_answer_survives_a_restart(tmp_path: Path) -> None:
    store = Store(tmp_path)
    received = store.receive(STRANGE, "02_nodes", "key", b"\0answer", NOW)
    store.close()
    reopened = Store(tmp_path)
    assert reopened.with_number(received.number) == received
    assert received == HandIn(1, STRANGE, "02_nodes", NOW)
    assert reopened.begin(1) == b"\0answer"
    assert {path.name for path in tmp_path.rglob("*")} <= {
        "hand-ins.sqlite3", "hand-ins.sqlite3-wal", "hand-ins.sqlite3-shm", "gradings"
    }  # fmt: skip
    reopened.close()


def test_the_same_key_keeps_the_first_answer(tmp_path: Path) -> None:
    store = Store(tmp_path)
    first_hand_in = store.receive("ada", "02_nodes", "key", b"first", NOW)
    assert store.receive("ada", "02_nodes", "key", b"second", NOW + timedelta(hours=1)) == first_hand_in
    assert store.receive("bob", "02_nodes", "key", b"bob's", NOW).number != first_hand_in.number
    assert store.begin(first_hand_in.number) == b"first"
    assert len(store.of_assignment("02_nodes")) == 2
    store.close()


def test_an_interrupted_grading_waits_again_and_costs_no_turn(tmp_path: Path) -> None:
    store = Store(tmp_path)
    for student in ("ada", "bob"):
        store.receive(student, "02_nodes", student, b"", NOW)
    store.begin(1)
    assert store.turns() == {"ada": 1}
    store.close()
    reopened = Store(tmp_path)
    assert reopened.waiting() == [HandIn(1, "ada", "02_nodes", NOW), HandIn(2, "bob", "02_nodes", NOW)]
    assert reopened.turns() == {}
    reopened.close()


def test_a_graded_answer_no_longer_waits(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.receive("ada", "02_nodes", "key", b"", NOW)
    store.begin(1)
    store.folder(1).mkdir()
    (store.folder(1) / "result.json").write_text("{}")
    store.finish(1, HALF)
    store.close()
    reopened = Store(tmp_path)
    assert reopened.waiting() == []
    assert reopened.turns() == {"ada": 1}
    assert reopened.of_student("ada") == [hand_in(1, HALF)]
    reopened.close()


def test_other_users_cannot_read_the_folder(tmp_path: Path) -> None:
    Store(tmp_path / "data").close()
    assert stat.S_IMODE((tmp_path / "data").stat().st_mode) == 0o700


def _open(folder: Path, errors: multiprocessing.SimpleQueue[str]) -> None:
    try:
        Store(folder)
    except UsageError as error:
        errors.put(str(error))


def test_two_processes_cannot_work_on_one_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("autograder.lms.serve.store.LOCK_TIMEOUT", 0.1)
    store = Store(tmp_path)
    processes = multiprocessing.get_context("fork")
    errors = processes.SimpleQueue()
    other = processes.Process(target=_open, args=(tmp_path, errors))
    other.start()
    other.join()
    assert not errors.empty()
    assert f"{tmp_path}: the hand-ins cannot be opened (database is locked)" in errors.get()
    store.close()


@pytest.mark.parametrize("content", [b"not a data base", b"SQLite format 3\0" + bytes(100)])
def test_a_file_that_is_not_a_store_is_named(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "hand-ins.sqlite3").write_bytes(content)
    with pytest.raises(UsageError, match=f"{tmp_path}: the hand-ins cannot be opened"):
        Store(tmp_path)


def test_the_last_or_the_best_answer_counts() -> None:
    hand_ins = [hand_in(1, HALF), hand_in(2, FULL), hand_in(3, HALF), hand_in(4, None)]
    assert counted_hand_in(hand_ins, best=False) == hand_ins[2]
    assert counted_hand_in(hand_ins, best=True) == hand_ins[1]
    assert counted_hand_in(hand_ins[3:], best=True) is None


def test_the_later_of_two_equal_answers_counts() -> None:
    hand_ins = [hand_in(1, HALF), hand_in(2, HALF)]
    assert counted_hand_in(hand_ins, best=True) == hand_ins[1]


def test_an_ungraded_answer_does_not_count_and_costs_no_try_if_the_grader_failed() -> None:
    failed, unclear = (hand_in(1, Mark(status, 0.0, 53.0)) for status in (Status.NOT_GRADED, Status.UNCLEAR))
    assert counted_hand_in([failed, unclear], best=True) is None
    assert (failed.costs_a_try, unclear.costs_a_try, hand_in(1, None).costs_a_try) == (False, True, True)
