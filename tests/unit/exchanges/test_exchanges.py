"""Requests and responses are kept for one check, in a bounded number of rows."""

from __future__ import annotations

from autograder.run.exchanges import MAX_CHARACTERS, MAX_ROWS, Exchange, ExchangeLog


def test_exchanges_are_returned_once() -> None:
    log = ExchangeLog()
    log.add(0.12345, "asked", "/enable", "data: True")
    assert log.take() == (Exchange(0.123, "asked", "/enable", "data: True"),)
    assert log.take() == ()


def test_the_first_and_last_of_too_many_rows_are_kept_and_texts_are_cut_and_cleaned() -> None:
    log = ExchangeLog()
    for number in range(1000):
        log.add(number, "feedback", "/drive" * 1000, f"{number} \x1b[2J\u202e" + "x" * 100_000)
    rows = log.take()
    assert [row.seconds for row in rows] == [*range(MAX_ROWS), *range(1000 - MAX_ROWS, 1000)]
    assert max(len(row.text) for row in rows) == max(len(row.name) for row in rows) == MAX_CHARACTERS
    assert rows[0].text.startswith("0 \ufffdx")
