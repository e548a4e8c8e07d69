"""A job for a worker: one submission to grade, as data that crosses a process boundary."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from autograder.result.model import structure
from autograder.run.sandbox import Tier
from autograder.run.sandbox.limits import GRADING_CELL


@dataclass(frozen=True)
class Scope:
    """How much of a suite is run. Anything but all of it is for the proof and for a replay, where nobody gets marks."""

    only: tuple[str, ...] = ()  # the checks to run; all of them when empty
    first_loss: bool = False  # whether to stop at the first check that does not pass
    pictures: bool = True  # whether checks leave pictures
    recordings: bool = False  # whether they leave whole recordings, too
    built: str = ""  # a built workspace of other sources, which takes the place of a build; see `building.prebuilt`


ALL = Scope()


@dataclass(frozen=True)
class Job:
    """One submission to grade."""

    path: Path  # what was handed in
    assignment: str  # which assignment it answers
    student: str  # whose it is
    seed: int  # every hidden input is drawn from it
    tier: Tier  # how the submission is isolated
    scope: Scope = ALL  # how much of the suite is run
    # Who starts the worker sets the rest.
    out: Path = Path()  # the folder that gets `result.json`, `notebook.ipynb` and the pictures
    scratch: Path = Path()  # the cell's own file system; nothing in it outlives the cell
    seconds: float = GRADING_CELL.wall_seconds  # real time for all of it
    # Whether no other try follows: an error that may be a program's or the machine's is then the program's.
    last: bool = False

    def to_json(self) -> str:
        """Return the job as one line of JSON."""
        return json.dumps(asdict(self), default=str)

    @classmethod
    def from_json(cls, text: str) -> Job:
        """Read a job from its JSON."""
        job: Job = structure(cls, json.loads(text))
        return job
