"""A job: one submission to grade, as data that is passed between processes."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path

from autograder.grade.isolated_reader import Digests, read_digests
from autograder.result.model import structure
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import GRADING_WORKER
from autograder.suite import suites
from autograder.suite.suites import Suite


@dataclass(frozen=True)
class Options:
    """How a suite is run. Only verification and replay, which give no marks, change the defaults."""

    only: tuple[str, ...] = ()  # the checks to run; all if empty
    exit_first: bool = False  # whether to stop at the first check that does not pass
    pictures: bool = True  # whether checks save pictures
    recordings: bool = False  # whether checks also save whole recordings
    prebuilt: str = ""  # path of a built workspace that is copied instead of a build; see `building.prebuilt`


WHOLE_SUITE = Options()


@dataclass(frozen=True)
class Job:
    """One submission to grade."""

    path: Path  # the submission: the folder of an assignment or an archive of it, a notebook, or a source tree
    assignment: str
    student: str  # used only in the result
    seed: int  # the number from which every hidden input is drawn
    # The folder for `result.json`, `notebook.ipynb` and the pictures, and for `grader.log` if the grader failed.
    out: Path
    isolation: Isolation = Isolation.BUBBLEWRAP  # how the submission is isolated
    options: Options = WHOLE_SUITE  # how the suite is run
    seconds: float = GRADING_WORKER.wall_seconds  # real time for both tries: the second gets the remaining time
    # The process that starts the worker sets the following fields.
    scratch: Path = Path()  # a file system in the worker sandbox, removed together with it
    # In the last try, an error that the program or the machine may have caused counts as an error of the program.
    is_last_try: bool = False

    @property
    def suite(self) -> Suite:
        """The hidden checks of the assignment. Raises a UsageError if there are none."""
        return suites.hidden(self.assignment)

    @cached_property
    def digests(self) -> Digests | None:
        """The digests of the submission, or None if it cannot be read. Its content is not kept in memory."""
        return read_digests(self.path, self.assignment, self.isolation)

    def to_json(self) -> str:
        """Return the job as one line of JSON."""
        return json.dumps(asdict(self), default=str)

    @classmethod
    def from_json(cls, text: str) -> Job:
        """Read a job from its JSON."""
        job: Job = structure(cls, json.loads(text))
        return job
