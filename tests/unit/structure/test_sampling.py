"""A commit's tests take one of the long files of a row, and the runs of several commits take all."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.sampling import ROOT, ROWS, files_left_out

FILES = [file for row in ROWS for file in row]


def test_each_file_is_there_and_stands_once() -> None:
    assert [file for file in FILES if not (ROOT / file).is_file()] == []
    assert len(set(FILES)) == len(FILES)


def test_a_draw_takes_one_file_of_each_row_and_many_draws_take_all() -> None:
    taken = [set(FILES) - files_left_out(str(number)) for number in range(120)]
    assert all([len(files & set(row)) for row in ROWS] == [1] * len(ROWS) for files in taken)
    assert set.union(*taken) == set(FILES)
    assert files_left_out("all") == set()


def collected(*arguments: str, draw: str) -> set[str]:
    """Return the files of which pytest collects a test that is not for the night."""
    command = [sys.executable, "-m", "pytest", "-q", "--collect-only", "-m", "not nightly", *arguments]
    variables = {**os.environ, "DRAW": draw}
    done = subprocess.run(command, cwd=ROOT, env=variables, capture_output=True, text=True, check=False)
    return {line.partition("::")[0] for line in done.stdout.splitlines() if "::" in line}


@pytest.mark.slow
def test_pytest_leaves_out_what_is_not_drawn_unless_the_command_line_names_it() -> None:
    browser = {file for file in FILES if file.startswith("tests/browser/")}
    draw = next(draw for draw in map(str, range(40)) if browser - files_left_out(draw))
    left_out = browser & files_left_out(draw)
    assert collected("tests/browser", draw=draw) & browser == browser - left_out
    assert collected("tests/browser", draw="all") & browser == browser
    assert collected(min(left_out), draw=draw) == {min(left_out)}
