"""A job for a worker: one submission to grade, as data that crosses a process boundary."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from autograder.result import structure
from autograder.sandbox import Tier


@dataclass(frozen=True)
class Scope:
    """How much of a suite is run. Anything but all of it is for the proof and for a replay, where nobody gets marks.

    Attributes:
        only: the checks to run; all of them when empty.
        first_loss: whether to stop at the first check that does not pass.
        pictures: whether checks leave pictures.
        recordings: whether they leave whole recordings, too.
    """

    only: tuple[str, ...] = ()
    first_loss: bool = False
    pictures: bool = True
    recordings: bool = False


ALL = Scope()


@dataclass(frozen=True)
class Job:
    """One submission to grade.

    Attributes:
        path: what was handed in.
        assignment: which assignment it answers.
        student: whose it is.
        seed: every hidden input is drawn from it.
        out: the folder that gets `result.json`, `notebook.ipynb` and the pictures.
        scratch: the cell's own file system; nothing in it outlives the cell.
        tier: how the submission is isolated.
        scope: how much of the suite is run.
    """

    path: Path
    assignment: str
    student: str
    seed: int
    out: Path
    scratch: Path
    tier: Tier
    scope: Scope = ALL

    def to_json(self) -> str:
        """Return the job as one line of JSON."""
        return json.dumps(asdict(self), default=str)

    @classmethod
    def from_json(cls, text: str) -> Job:
        """Read a job from its JSON."""
        job: Job = structure(cls, json.loads(text))
        return job
