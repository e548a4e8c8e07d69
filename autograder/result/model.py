"""The result of grading a submission, as the trusted process records it, and its JSON form.

`result.schema.json` beside this module describes the JSON form. Fields are only added to it.
"""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from threading import Lock
from types import UnionType
from typing import TYPE_CHECKING, Any, get_args, get_origin, get_type_hints

from autograder.diagnosis import MAX_DETAIL, MAX_SENTENCE, OK, Diagnosis
from autograder.exceptions import UsageError
from autograder.plain_text import shorten
from autograder.run.exchanges import Exchange
from autograder.suite import Check, Outcome, Visibility

if TYPE_CHECKING:
    from jsonschema.protocols import Validator

SCHEMA = "autograder-result/1"
UNFINISHED = ".unfinished"  # in the folder of a result: the folder of a grading that will replace the result
MAX_HARMLESS_DELAY = 0.1  # s, one period at 10 Hz; a shorter delay of a program makes no check fail


class Status(str, Enum):
    """Whether the grader reached a result. A submission that cannot be read, or contains two answers, is unclear."""

    GRADED = "graded"
    NOT_GRADED = "not_graded"
    UNCLEAR = "unclear"

    @property
    def words(self) -> str:
        """The status in words, for people."""
        return self.value.replace("_", " ")


@dataclass(frozen=True)
class CheckResult:
    """The result of one check."""

    id: str
    title: str
    group: str
    points: float  # points that the check earned, of `max_points`
    max_points: float
    outcome: Outcome
    message: str  # why it failed, or an empty string
    hints: tuple[str, ...]
    doc: str | None  # address of a page to read, or None
    visibility: Visibility
    seconds: float  # wall time of the check
    holds: tuple[str, ...] = ()  # ids of the requirements that it covers
    after: tuple[str, ...] = ()  # ids of the checks that explain its failure if they did not pass either
    talk: tuple[Exchange, ...] = ()  # requests to the nodes, and their answers

    @classmethod
    def of(
        cls,
        check: Check,
        outcome: Outcome,
        message: str = "",
        *,
        fraction: float = 0.0,
        seconds: float = 0.0,
        hints: tuple[str, ...] | None = None,
    ) -> CheckResult:
        """Return the result of a check, which took `seconds` of wall time.

        If it failed, it earns the share `fraction` of its points, 0 to 1. If it was not checked, it earns none. The
        hints are those of the check, unless `hints` contains more specific ones.
        """
        share = {Outcome.PASSED: 1.0, Outcome.FAILED: fraction, Outcome.NOT_CHECKED: 0.0}[outcome]
        if hints is None or outcome is Outcome.PASSED:
            hints = () if outcome is Outcome.PASSED else check.hints
        return cls(
            id=check.id,
            title=check.title,
            group=check.group,
            points=round(check.points * share, 4),
            max_points=check.points,
            outcome=outcome,
            message=shorten(message, MAX_SENTENCE),
            hints=tuple(shorten(hint, MAX_SENTENCE) for hint in hints),
            doc=check.doc,
            visibility=check.visibility,
            seconds=round(seconds, 3),
            holds=check.covers,
            after=check.dependencies,
        )

    @classmethod
    def not_checked(cls, check: Check, reason: str, *, seconds: float = 0.0) -> CheckResult:
        """Return the result of a check that did not run to its end."""
        return cls.of(check, Outcome.NOT_CHECKED, f"not checked: {reason}", seconds=seconds)


@dataclass(frozen=True)
class Build:
    """The result of building the student's packages. `log` is the end of colcon's output about packages that failed."""

    ok: bool
    seconds: float
    packages: tuple[str, ...] = ()
    log: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "log", shorten(self.log, MAX_DETAIL))


@dataclass(frozen=True)
class Artifact:
    """A file beside the result, such as the picture of a track."""

    name: str  # path of the file, below the folder of the result
    kind: str  # kind of the artifact, such as "track"
    # Digest of the file. For a track, it is that of the recording, as the bytes of its picture may vary.
    sha256: str
    check: str  # id of the check that saved it
    caption: str = ""  # alternative text of the picture
    run: str = ""  # path of the file with the run that the picture shows, for the player, or an empty string


@dataclass(frozen=True)
class Result:
    """Everything that is recorded about one graded submission."""

    assignment: str
    student: str
    submission_sha256: str
    suite_version: str
    seed: int
    isolation: str
    checks: tuple[CheckResult, ...]
    max_score: float
    started: str  # start of the grading, in ISO 8601
    seconds: float  # wall time of the grading
    status: Status = Status.GRADED
    diagnosis: Diagnosis = OK
    build: Build | None = None
    artifacts: tuple[Artifact, ...] = ()
    phases: Mapping[str, float] = dataclasses.field(default_factory=dict)  # wall time of each phase, in seconds
    time: str = "lockstep"  # "lockstep", or "real" if a program's time could not be stepped
    time_note: str = ""  # the sentence that names that program and the reason
    unjudged: tuple[str, ...] = ()  # ids of checks in which the student's data caused an error
    notices: tuple[str, ...] = ()  # sentences for the student about the graded files
    unused: tuple[str, ...] = ()  # paths of submitted files that do not count, or sentences about skipped files
    held_up: float = 0.0  # the longest time, in seconds, for which a busy machine delayed that program or the grader
    files_digest: str = ""  # digest of every file that the grading read, even if `suite_version` ignores it
    launch: str = ""  # versions of the real launch, launch_ros and ros2cli, or "stand-ins"
    # The folder of its artifacts. It is not part of the JSON form; the reader of a file sets it.
    folder: Path = dataclasses.field(default=Path(), compare=False)

    @property
    def score(self) -> float:
        """The points earned. It is 0 if the submission was not graded; see `status`."""
        return round(math.fsum(check.points for check in self.checks), 4)

    @property
    def percent(self) -> float:
        """The score as a percentage of the maximum."""
        return 100.0 * self.score / self.max_score if self.max_score else 0.0

    @property
    def in_doubt(self) -> bool:
        """Whether points may have been lost because the machine was busy."""
        has_lost_points = any(check.outcome is Outcome.FAILED for check in self.checks)
        return self.time == "real" and self.held_up > MAX_HARMLESS_DELAY and has_lost_points

    def group(self, name: str) -> tuple[CheckResult, ...]:
        """Return the checks that count for one locked grade cell."""
        return tuple(check for check in self.checks if check.group == name)

    def only(self, check: str) -> Result:
        """Return a copy of the result that contains only one check."""
        (selected,) = (result for result in self.checks if result.id == check)
        artifacts = tuple(artifact for artifact in self.artifacts if artifact.check == check)
        return dataclasses.replace(self, checks=(selected,), max_score=selected.max_points, artifacts=artifacts)

    def to_json(self) -> dict[str, Any]:
        """Return the JSON form."""
        plain = {"schema": SCHEMA, **dataclasses.asdict(self), "score": self.score}
        del plain["folder"]
        return json.loads(json.dumps(plain, default=_enum_value))  # type: ignore[no-any-return]


def _enum_value(value: object) -> object:
    if isinstance(value, Enum):
        return value.value
    raise TypeError(f"{type(value).__name__} has no JSON form")


_import_lock = Lock()  # jsonschema cannot be imported in two threads at once: its modules import each other


@cache
def schema() -> dict[str, Any]:
    """Return the JSON Schema of the JSON form."""
    return json.loads(Path(__file__).with_name("result.schema.json").read_text(encoding="utf-8"))  # type: ignore[no-any-return]


@cache
def _validator() -> Validator:
    """Return the schema's validator."""
    from jsonschema.validators import validator_for

    return validator_for(schema())(schema())


def from_json(data: Any, *, source: str = "result", folder: Path = Path()) -> Result:
    """Return the result that a JSON form describes; `source` names its file in an error.

    Raises:
        UsageError: `data` does not match the schema, or has more points than possible. The message names `source`.
    """
    with _import_lock:
        from jsonschema.exceptions import best_match  # slow to import, and workers do not need it

        validator = _validator()
    error = best_match(validator.iter_errors(data))
    if error is not None:
        field = ".".join(str(part) for part in error.absolute_path) or "the top level"
        raise UsageError(f"{source}: not a grading result: {field}: {error.message}")
    try:
        result: Result = dataclasses.replace(structure(Result, data), folder=folder)
    except ValueError as error:
        raise UsageError(f"{source}: not a grading result of this version: {error}") from None
    if not result.score <= result.max_score < math.inf:
        raise UsageError(f"{source}: not a grading result: {result.score:g} points of {result.max_score:g}")
    return result


def structure(kind: Any, data: Any) -> Any:
    """Return the value of type `kind` from its JSON form, and ignore fields that this version does not know."""
    if dataclasses.is_dataclass(kind):
        known = get_type_hints(kind)
        return kind(**{name: structure(known[name], value) for name, value in data.items() if name in known})  # type: ignore[operator]
    if get_origin(kind) is UnionType:  # an optional value
        return None if data is None else structure(get_args(kind)[0], data)
    if get_origin(kind) is tuple:
        return tuple(structure(get_args(kind)[0], item) for item in data)
    return kind(data) if isinstance(kind, type) and issubclass(kind, (Enum, Path)) else data


def write_json(path: Path, data: object) -> None:
    """Write JSON atomically."""
    text = json.dumps(data, indent=2, ensure_ascii=False, default=_enum_value) + "\n"
    # A file name that is not UTF-8 contains lone surrogates. They are written as JSON escapes.
    write_atomically(path, text.encode("utf-8", "backslashreplace"))


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file beside `path`, and rename it to `path`. Its folder is created if it does not exist."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    temporary.write_bytes(data)
    temporary.replace(path)
