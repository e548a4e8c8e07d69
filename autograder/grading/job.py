"""What the grader asks of a worker: one submission's grading, as data that crosses a process boundary."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from autograder.sandbox import Tier


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
        only: the checks to run, for the proof; all of them when empty.
        pictures: whether checks leave pictures; the proof looks at none.
    """

    path: Path
    assignment: str
    student: str
    seed: int
    out: Path
    scratch: Path
    tier: Tier
    only: tuple[str, ...] = ()
    pictures: bool = True

    def to_json(self) -> str:
        """Return the job as one line of JSON."""
        return json.dumps(asdict(self), default=str)

    @classmethod
    def from_json(cls, text: str) -> Job:
        """Read a job from its JSON."""
        data = json.loads(text)
        paths = {name: Path(data[name]) for name in ("path", "out", "scratch")}
        return cls(**{**data, **paths, "tier": Tier(data["tier"]), "only": tuple(data["only"])})
