"""`score`: how well a drive found the goal of its world, and the table of one's own drives so far."""

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

FILE = Path("scores.json")  # nobody else reads it
COLUMNS = ("", "run", "goal", "driven", "nearest thing")


@dataclass(frozen=True)
class Score:
    """What a drive achieved.

    Attributes:
        world: the world's name.
        run: what the student calls the run.
        arrived: when the robot's centre reached the goal, in seconds; None if it did not.
        left: how far it was from the goal when it was nearest, in metres; 0 if it arrived.
        metres: how far it drove, until it arrived or the drive was over.
        margin: the smallest gap between its edge and anything, in metres, until then.
    """

    world: str
    run: str
    arrived: float | None
    left: float
    metres: float
    margin: float

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """The sort key, smallest first: arrival, then no collision, then the time or the distance that is left."""
        touched = self.margin <= 0.0
        return (True, touched, self.left) if self.arrived is None else (False, touched, self.arrived)

    @property
    def cells(self) -> tuple[str, str, str, str]:
        """The score in words."""
        goal = f"{self.left:.1f} m away" if self.arrived is None else f"after {self.arrived:.1f} s"
        margin = "touched" if self.margin <= 0.0 else f"{self.margin:.2f} m"
        return self.run, goal, f"{self.metres:.1f} m", margin


@dataclass(frozen=True)
class ScoreTable:
    """One's own drives in a world, the best one first, and the newest of them."""

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
        places = [
            f"{number}." + (" ← this run" if score is self.newest else "")
            for number, score in enumerate(self.scores, 1)
        ]
        return [(place, *score.cells) for place, score in zip(places, self.scores, strict=True)]


def score(drive: DriveReport | SimulatorSession | Notice, run: str = "") -> ScoreTable | Notice:
    """Add a drive to the table of one's own drives in that world, and show the table.

    Args:
        drive: what `drive(...)` returned, or what `simulator(...)` has recorded, in a world with a goal.
        run: a name for the run; "run 3" and so on by default.

    Returns:
        The table, or the notice that came instead of a drive.

    Raises:
        UsageError: the world has no goal, or the file holds no scores.
    """
    if isinstance(drive, Notice):
        return drive
    if drive.recording is None:
        return Notice("There is no run to score.")
    kept = _read()
    newest = score_of(drive.recording, run or f"run {len(kept) + 1}")
    kept.append(newest)
    write_json(FILE, [asdict(each) for each in kept])
    return ScoreTable(
        tuple(sorted((each for each in kept if each.world == newest.world), key=lambda s: s.rank)), newest
    )


def score_of(recording: Recording, run: str) -> Score:
    """Return the score of the way to the first goal, of that robot which did best.

    Raises UsageError if the world has no goal.
    """
    world = recording.simulation.world
    if not world.goals:
        raise UsageError(f"the world {world.name!r} has no goal: drive in another one, such as 'maze'")
    return min((_of_robot(recording, run, robot) for robot in range(recording.poses.shape[1])), key=lambda s: s.rank)


def _of_robot(recording: Recording, run: str, robot: int) -> Score:
    world = recording.simulation.world
    goal, track = world.goals[0], recording.poses[:, robot, :2]
    gaps = np.hypot(*(track - (goal.x, goal.y)).T) - goal.radius
    there = gaps <= 0.0
    end = int(np.argmax(there)) if there.any() else len(track) - 1
    return Score(
        world=world.name,
        run=run,
        arrived=round(float(recording.times[end]), 2) if there.any() else None,
        left=round(max(0.0, float(gaps.min())), 2),
        metres=round(float(np.hypot(*np.diff(track[: end + 1], axis=0).T).sum()), 2),
        margin=0.0
        if recording.collided[: end + 1, robot].any()
        else round(float(recording.clearances[: end + 1, robot].min()), 3),
    )


def _read() -> list[Score]:
    if not FILE.exists():
        return []
    try:
        return [Score(**entry) for entry in json.loads(FILE.read_text(encoding="utf-8"))]
    except (ValueError, TypeError) as error:
        raise UsageError(f"{FILE}: holds no scores ({error}); remove the file to begin a new table") from None
