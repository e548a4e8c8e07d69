"""`score` rates how well a drive reached the goal of its world, and shows a table of the student's drives."""

from __future__ import annotations

import html
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from autograder.exceptions import UsageError
from autograder.notebook.driving import DriveReport
from autograder.notebook.notices import Notice
from autograder.notebook.simulator_session import SimulatorSession
from autograder.result.model import write_json
from sim import Recording

FILE = Path("scores.json")  # in the notebook's folder; only this module uses it
COLUMNS = ("", "run", "goal", "driven", "nearest thing")


@dataclass(frozen=True)
class Score:
    """The score of a drive.

    Attributes:
        world: the world's name.
        run: the student's name for the run.
        arrived: the time in seconds at which the robot's centre reached the goal; None if it did not.
        left: the smallest distance to the goal in metres; 0 if the robot arrived.
        metres: the distance that the robot drove until it arrived or the drive ended.
        margin: the smallest distance in metres between the robot's edge and an obstacle up to then.
    """

    world: str
    run: str
    arrived: float | None
    left: float
    metres: float
    margin: float

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """The sort key, smallest first: arrival, then no collision, then the time or the remaining distance."""
        touched = self.margin <= 0.0
        return (True, touched, self.left) if self.arrived is None else (False, touched, self.arrived)

    @property
    def cells(self) -> tuple[str, str, str, str]:
        goal = f"{self.left:.1f} m away" if self.arrived is None else f"after {self.arrived:.1f} s"
        margin = "touched" if self.margin <= 0.0 else f"{self.margin:.2f} m"
        return self.run, goal, f"{self.metres:.1f} m", margin


@dataclass(frozen=True)
class ScoreTable:
    """The scores of the student's drives in a world, best first, and the newest score."""

    scores: tuple[Score, ...]
    newest: Score

    def __repr__(self) -> str:
        rows = [COLUMNS, *self._rows()]
        widths = [max(len(row[column]) for row in rows) for column in range(len(COLUMNS))]
        return "\n".join("  ".join(map(str.ljust, row, widths)).rstrip() for row in rows)

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in COLUMNS)
        rows = "".join(f"<tr>{''.join(f'<td>{html.escape(cell)}</td>' for cell in row)}</tr>" for row in self._rows())
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"

    def _rows(self) -> list[tuple[str, ...]]:
        numbers = [
            f"{number}." + (" ← this run" if score is self.newest else "")
            for number, score in enumerate(self.scores, 1)
        ]
        return [(number, *score.cells) for number, score in zip(numbers, self.scores, strict=True)]


def score(drive: DriveReport | SimulatorSession | Notice, run: str = "") -> ScoreTable | Notice:
    """Add a drive to the table of drives in its world, and show the table.

    Args:
        drive: a result of `drive(...)`, or a recording of `simulator(...)`, in a world with a goal.
        run: a name for the run. The default is "run 3" and so on.

    Returns:
        The table, or the notice if `drive` is one.

    Raises:
        UsageError: the world has no goal, or the file does not contain scores.
    """
    if isinstance(drive, Notice):
        return drive
    if drive.recording is None:
        return Notice("Nothing was recorded, so the run has no score.")
    scores = _read_scores()
    newest = score_of(drive.recording, run or f"run {len(scores) + 1}")
    scores.append(newest)
    write_json(FILE, [asdict(entry) for entry in scores])
    return ScoreTable(
        tuple(sorted((entry for entry in scores if entry.world == newest.world), key=lambda s: s.rank)), newest
    )


def score_of(recording: Recording, run: str) -> Score:
    """Return the score of the robot with the best rank, for the world's first goal.

    Raises UsageError if the world has no goal.
    """
    world = recording.simulation.world
    if not world.goals:
        raise UsageError(f"the world {world.name!r} has no goal: use another one, such as 'maze'")
    return min(
        (_score_of_robot(recording, run, robot) for robot in range(recording.poses.shape[1])), key=lambda s: s.rank
    )


def _score_of_robot(recording: Recording, run: str, robot: int) -> Score:
    world = recording.simulation.world
    goal, track = world.goals[0], recording.poses[:, robot, :2]
    gaps = np.hypot(*(track - (goal.x, goal.y)).T) - goal.radius
    in_goal = gaps <= 0.0
    last_step = int(np.argmax(in_goal)) if in_goal.any() else len(track) - 1
    return Score(
        world=world.name,
        run=run,
        arrived=round(float(recording.times[last_step]), 2) if in_goal.any() else None,
        left=round(max(0.0, float(gaps.min())), 2),
        metres=round(float(np.hypot(*np.diff(track[: last_step + 1], axis=0).T).sum()), 2),
        margin=0.0
        if recording.collided[: last_step + 1, robot].any()
        else round(float(recording.clearances[: last_step + 1, robot].min()), 3),
    )


def _read_scores() -> list[Score]:
    if not FILE.exists():
        return []
    try:
        return [Score(**entry) for entry in json.loads(FILE.read_text(encoding="utf-8"))]
    except (ValueError, TypeError) as error:
        raise UsageError(f"{FILE} does not contain scores ({error}): delete the file to start a new table") from None
