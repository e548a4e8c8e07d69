"""Lines of programs are kept with their times. Of a flood, only the first and the last lines are kept."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from sim import Command, Simulation, World, box, load_recording, run
from sim.log import MAX_CHARACTERS, MAX_LINES, OMISSION, Log

RUN = run(Simulation(World.from_segments(box(4.0, 3.0))), lambda state, scans: Command(linear=0.2), seconds=0.5)


def test_lines_are_kept_in_order_and_empty_lines_are_left_out() -> None:
    log = Log()
    for seconds, text in ((0.1, "first"), (0.2, "  "), (0.30004, "second")):
        log.add(seconds, text)
    assert log.lines() == ((0.1, "first"), (0.3, "second"))


def test_the_first_and_the_last_lines_of_a_flood_are_kept() -> None:
    log = Log()
    for number in range(50_000):
        log.add(number / 1000, f"{number} {'x' * 1000}")
    lines = log.lines()
    assert len(lines) == 2 * MAX_LINES + 1
    assert lines[MAX_LINES][1] == OMISSION
    assert (lines[MAX_LINES - 1][0], lines[-1][0]) == (0.999, 49.999)
    assert max(len(text) for _, text in lines) == MAX_CHARACTERS


def test_a_log_of_at_most_the_kept_number_of_lines_is_complete() -> None:
    log = Log()
    for number in range(2 * MAX_LINES):
        log.add(0.0, str(number))
    assert [text for _, text in log.lines()] == [str(number) for number in range(2 * MAX_LINES)]


def test_a_saved_run_keeps_its_lines_and_its_hash_does_not_depend_on_them(tmp_path: Path) -> None:
    talking = replace(RUN, log_lines=((0.2, "<b>näher</b>"),))
    talking.save(tmp_path / "run.npz")
    assert load_recording(tmp_path / "run.npz").log_lines == talking.log_lines
    assert talking.sha256() == RUN.sha256()
