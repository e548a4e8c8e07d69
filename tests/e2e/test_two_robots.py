"""Two robots from one launch file, as chapter 4 starts them: all nodes are found, and both robots drive."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.course import chapters
from tests.e2e.conftest import Terminal

NODES = ["/robot1/driver", "/robot1/reporter", "/robot2/driver", "/robot2/reporter", "/simulator"]
RUNS = [pytest.param(False, id="idle")]
RUNS += [
    pytest.param(busy, id=f"{number}-{busy}", marks=pytest.mark.nightly)
    for number in range(10)
    for busy in (False, True)
]
DISPLAY = "from IPython.display import display"
AFTER = "\nfor run in robots.recording.poses.transpose(1, 0, 2):\n    print('moved', max(abs(run[:, 2] - run[0, 2])))\n"


def _compute() -> None:
    while True:
        pass


@pytest.fixture
def busy(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep both cores busy meanwhile, where it is asked for."""
    others = [multiprocessing.get_context("spawn").Process(target=_compute, daemon=True) for _ in range(2)]
    for other in others if request.param else []:
        other.start()
    yield
    for other in others if request.param else []:
        other.kill()
        other.join()


@pytest.mark.slow
@pytest.mark.parametrize("busy", RUNS, indirect=True)
def test_all_nodes_are_found_and_both_robots_drive(busy: None, reference: Terminal, tmp_path: Path) -> None:
    (chapter,) = (chapter for chapter in chapters() if chapter.assignment == "04_launch")
    cells = {cell.id: cell.source for cell in chapter.read().cells}
    script = tmp_path / "cell.py"
    script.write_text("\n".join([DISPLAY, cells["setup"], cells["try-fleet-run"].replace("shell(BUILD)\n", ""), AFTER]))
    (tmp_path / "ws").symlink_to(reference.root)
    told = subprocess.run(
        [sys.executable, str(script)],
        cwd=tmp_path,
        env=reference.variables,
        text=True,
        capture_output=True,
        timeout=200,
    )
    lines = told.stdout.splitlines()
    assert told.returncode == 0, told.stderr
    assert [line for line in lines if line.startswith("/") and "->" not in line] == NODES, told.stdout
    assert f"5 nodes: {', '.join(NODES)}" in lines, told.stdout  # the drawn graph, in words
    assert "/robot2/reporter -> /fleet/status" in lines
    moved = [float(line.split()[1]) for line in lines if line.startswith("moved")]
    assert len(moved) == 2
    assert min(moved) > 0.5, told.stdout
    assert {f"data: {name} drives at 0.12 m/s" for name in ("robot1", "robot2")} <= set(lines)
