"""Chapter 4's two robots, run as by a student: the cell's output matches the text above it.

The variable `RUNS` sets the number of nightly runs, half of them beside two programs that keep two cores busy.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from nbformat.v4 import new_code_cell

from autograder.author.course.execute import execute, working_copy
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter, chapters
from autograder.ros.domains import Domain
from tests.notebooks.outputs import text_of

NODES = ["/robot1/driver", "/robot1/reporter", "/robot2/driver", "/robot2/reporter", "/simulator"]
CELLS = ["setup", "build", "robot-launch", "two-robots-launch", "try-fleet-run"]
WATCHDOG = "{0}: watchdog, {0} had no new command for 0.5 s and stops"  # after the end of its driver
TURNS = """import numpy
for run in robots.recording.poses.transpose(1, 0, 2):
    print('turned', abs(numpy.unwrap(run[:, 2])[-1] - run[0, 2]) / (2 * numpy.pi))
"""
RUNS = [pytest.param(False, id="once")]
RUNS += [
    pytest.param(number % 2 == 1, id=f"{number}-{'busy' if number % 2 else 'idle'}", marks=pytest.mark.nightly)
    for number in range(int(os.environ.get("RUNS", "20")))
]


def _compute() -> None:
    while True:
        pass


@pytest.fixture
def busy(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep two cores busy during the test if the parameter says so."""
    programs = [multiprocessing.get_context("spawn").Process(target=_compute, daemon=True) for _ in range(2)]
    for program in programs if request.param else []:
        program.start()
    yield
    for program in programs if request.param else []:
        program.kill()
        program.join()


@pytest.fixture(scope="module")
def folder() -> Iterator[Path]:
    """The chapter's folder, which all runs use, one after another."""
    with working_copy(_chapter().folder) as copy:
        yield copy


def _chapter() -> Chapter:
    return next(chapter for chapter in chapters() if chapter.assignment == "04_launch")


@pytest.mark.slow
@pytest.mark.parametrize("busy", RUNS, indirect=True)
def test_all_nodes_are_found_and_both_robots_drive_a_circle(busy: None, folder: Path) -> None:
    notebook = in_form(_chapter().read(), Form.SOLVED)
    cells = {cell.id: cell for cell in notebook.cells}
    notebook.cells = [*(cells[name] for name in CELLS), new_code_cell(TURNS)]
    with Domain() as domain:
        failure = execute(notebook, folder, 400, domain.number)
    assert failure is None, failure
    output = text_of(notebook.cells[-2:])
    lines = output.splitlines()
    assert [line for line in lines if line.startswith("/") and "->" not in line] == NODES, output
    assert f"5 nodes: {', '.join(NODES)}" in lines, output  # the text of the drawn graph
    assert {f"/{robot}/reporter -> /fleet/status" for robot in ("robot1", "robot2")} <= set(lines), output
    assert {f"data: {robot} drives at 0.12 m/s" for robot in ("robot1", "robot2")} <= set(lines), output
    turned = [float(line.split()[1]) for line in lines if line.startswith("turned")]
    assert len(turned) == 2, output
    assert min(turned) >= 1.0, output
    warnings = [line.partition("[simulator]: ")[2] for line in lines if line.startswith("[WARN]")]
    assert sorted(warnings[-2:]) == [WATCHDOG.format(robot) for robot in ("robot1", "robot2")], output
