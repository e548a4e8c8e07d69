"""A job: one submission to grade, as data that crosses process boundaries."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path

from autograder.grade.apart import Digests, read_digests
from autograder.result.model import structure
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import GRADING_WORKER
from autograder.suite import suites
from autograder.suite.suites import Suite


@dataclass(frozen=True)
class Options:
    """How a suite is run. Anything except the defaults is for verification and replay, which give no marks."""

    only: tuple[str, ...] = ()  # the checks to run; all of them when empty
    first_loss: bool = False  # whether to stop at the first check that does not pass
    pictures: bool = True  # whether checks leave pictures
    recordings: bool = False  # whether they leave whole recordings, too
    built: str = ""  # a built workspace of other sources, which takes the place of a build; see `building.prebuilt`


WHOLE_SUITE = Options()


@dataclass(frozen=True)
class Job:
    """One submission to grade."""

    path: Path  # the submission: an assignment's folder, an archive of one, a notebook, or a source tree
    assignment: str  # the assignment
    student: str  # whose it is; used only in the result
    seed: int  # every hidden input is drawn from it; the same seed gives the same inputs
    # The folder that gets `result.json`, `notebook.ipynb` and the pictures; `grader.log` if the grader failed.
    out: Path
    isolation: Isolation = Isolation.BUBBLEWRAP  # how the submission is isolated
    options: Options = WHOLE_SUITE  # how the suite is run
    seconds: float = GRADING_WORKER.wall_seconds  # real time for all tries; a second try gets the rest
    # The process that starts the worker sets the rest.
    scratch: Path = Path()  # a file system of the worker sandbox, which ends with it
    # Whether no other try follows: an error that may be a program's or the machine's is then the program's.
    last: bool = False

    @property
    def suite(self) -> Suite:
        """The hidden checks of its assignment. Raises UsageError if there are none."""
        return suites.hidden(self.assignment)

    @cached_property
    def digests(self) -> Digests | None:
        """The digests of the submission, or None if it cannot be read. Its content is not kept."""
        return read_digests(self.path, self.assignment, self.isolation)

    def to_json(self) -> str:
        """Return the job as one line of JSON."""
        return json.dumps(asdict(self), default=str)

    @classmethod
    def from_json(cls, text: str) -> Job:
        """Read a job from its JSON."""
        job: Job = structure(cls, json.loads(text))
        return job
