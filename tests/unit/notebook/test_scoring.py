"""Scores of drives to a goal: their order, and the table that is kept."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.exceptions import UsageError
from autograder.notebook import score
from autograder.notebook.driving import DriveReport
from autograder.notebook.notices import Notice
from autograder.notebook.scoring import FILE, Score, ScoreTable, score_of
from autograder.notebook.simulator_session import SimulatorSession
from sim import Command, Goal, Pose, RobotSpec, Simulation, World, box, run

ROOM = World.from_segments(
    box(6.0, 2.0).tolist(), name="a room", starts=[Pose(-2.0, 0.0, 0.0)], goals=[Goal(1.0, 0.0, 0.5)]
)


@pytest.fixture(autouse=True)
def _separate_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def drive(speed: float, world: World = ROOM) -> DriveReport:
    simulation = Simulation(world, (RobotSpec(radius=0.18),))
    return DriveReport(run(simulation, lambda state, scans: Command(linear=speed), 10.0), "", ())


def test_the_first_arrival_at_the_goal_and_the_distance_until_then_count() -> None:
    fast = score_of(drive(0.5).recording, "fast")  # 2.5 m to the circle; it ends at the wall, which no longer counts
    assert fast.arrived == pytest.approx(2.5 / 0.5, abs=0.6)  # it speeds up first
    assert fast.left == 0.0
    assert fast.metres == pytest.approx(2.5, abs=0.06)
    assert fast.margin == pytest.approx(0.82, abs=0.01)  # to the side walls
    slow = score_of(drive(0.1).recording, "slow")
    assert slow.arrived is None
    assert slow.left == pytest.approx(2.5 - slow.metres, abs=0.02)


def test_the_best_of_several_robots_counts_for_the_score() -> None:
    hall = World.from_segments(
        box(6.0, 4.0).tolist(),
        name="a hall",
        starts=[Pose(-2.0, 1.0, 0.0), Pose(-2.0, -1.0, 0.0)],
        goals=[Goal(1.0, -1.0, 0.5)],
    )
    robots = Simulation(hall, (RobotSpec(name="one"), RobotSpec(name="two")))
    session = SimulatorSession()
    assert isinstance(score(session), Notice)
    session.recording = run(robots, lambda state, scans: {"two": Command(linear=0.5)}, 10.0)
    table = score(session, "both")
    assert isinstance(table, ScoreTable)
    assert table.newest.arrived == pytest.approx(2.5 / 0.5, abs=0.6)


def test_the_table_of_a_world_is_kept_and_the_best_run_comes_first() -> None:
    for speed, name in ((0.1, "slow"), (0.3, ""), (0.5, "fast")):
        table = score(drive(speed), name)
    assert isinstance(table, ScoreTable)
    assert [entry.run for entry in table.scores] == ["fast", "run 2", "slow"]
    assert repr(table).splitlines()[1].startswith("1. ← this run  fast   after")
    assert "<td>fast</td>" in table._repr_html_()


def test_arrival_counts_more_than_no_collision_and_no_collision_more_than_time() -> None:
    def rank(arrived_at: float | None, margin: float, remaining: float = 0.0) -> tuple[bool, bool, float]:
        return Score("maze", "", arrived_at, remaining, 1.0, margin).rank

    ranks = [rank(50.0, 0.1), rank(60.0, 0.1), rank(40.0, 0.0), rank(None, 0.1, 1.0), rank(None, 0.0, 0.5)]
    assert ranks == sorted(ranks)


def test_scoring_without_a_drive_a_goal_or_a_valid_table_is_reported() -> None:
    notice = Notice("It did not start.")
    assert score(notice) is notice
    with pytest.raises(UsageError, match="the world 'an empty hall' has no goal: use another one, such as 'maze'"):
        score(drive(0.1, World.from_segments(box(4.0, 4.0).tolist(), name="an empty hall")))
    FILE.write_text('[{"world": 3}]')
    with pytest.raises(
        UsageError, match=r"scores\.json does not contain scores .*: delete the file to start a new table"
    ):
        score(drive(0.1))
