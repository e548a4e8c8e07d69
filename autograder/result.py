"""A graded submission as data: what the trusted process recorded, and nothing else.

The JSON form is published in `result.schema.json` beside this module; fields are only ever added to it.
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
from typing import Any

from autograder.checks import Check, Outcome, Visibility
from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.exceptions import UsageError

SCHEMA = "autograder-result/1"
HARMLESS = 0.1  # s, one period at 10 Hz: no check minds if what it meets in real time is held up for that long


class Status(str, Enum):
    """Whether the grader reached a verdict at all."""

    GRADED = "graded"
    NOT_GRADED = "not_graded"


@dataclass(frozen=True)
class CheckResult:
    """What became of one check; `points` is what it earned."""

    id: str
    title: str
    group: str
    points: float
    max_points: float
    outcome: Outcome
    message: str
    hints: tuple[str, ...]
    doc: str | None
    visibility: Visibility
    seconds: float

    @classmethod
    def of(
        cls, check: Check, outcome: Outcome, message: str = "", *, fraction: float = 0.0, seconds: float = 0.0
    ) -> CheckResult:
        """Make the record of `check`: full points when passed, the fraction when failed, else none."""
        share = {Outcome.PASSED: 1.0, Outcome.FAILED: fraction, Outcome.NOT_CHECKED: 0.0}[outcome]
        hints = () if outcome is Outcome.PASSED else check.hints
        return cls(
            id=check.id,
            title=check.title,
            group=check.group,
            points=round(check.points * share, 4),
            max_points=check.points,
            outcome=outcome,
            message=message,
            hints=hints,
            doc=check.doc,
            visibility=check.visibility,
            seconds=round(seconds, 3),
        )


@dataclass(frozen=True)
class Build:
    """How building the student's packages went; `log` is the end of colcon's output."""

    ok: bool
    seconds: float
    packages: tuple[str, ...] = ()
    log: str = ""


@dataclass(frozen=True)
class Artifact:
    """A file that grading left beside the result: a track's recording or picture.

    Attributes:
        name: its path below the result's folder.
        sha256: of the file, or of the behaviour that it records when the bytes may differ from run to run.
        check: the check that it belongs to.
        caption: what the picture shows, in words.
    """

    name: str
    kind: str
    sha256: str
    check: str
    caption: str = ""


@dataclass(frozen=True)
class Result:
    """Everything that is known about one graded submission.

    `time` is "real" when a program's time could not be stepped; `time_note` says which and why, in a sentence.
    `held_up` is for how many seconds at a time, at most, a busy machine then kept it, or the grader, from running.
    """

    assignment: str
    student: str
    submission_sha256: str
    suite_version: str
    seed: int
    isolation: str
    checks: tuple[CheckResult, ...]
    max_score: float
    started: str
    seconds: float
    status: Status = Status.GRADED
    diagnosis: Diagnosis = OK
    build: Build | None = None
    artifacts: tuple[Artifact, ...] = ()
    phases: Mapping[str, float] = dataclasses.field(default_factory=dict)
    time: str = "lockstep"
    time_note: str = ""
    held_up: float = 0.0

    @property
    def score(self) -> float:
        """The points earned; 0 when not graded, which `status` tells apart from a zero."""
        return round(math.fsum(check.points for check in self.checks), 4)

    @property
    def percent(self) -> float:
        """The score as a percentage of the maximum."""
        return 100.0 * self.score / self.max_score if self.max_score else 0.0

    @property
    def in_doubt(self) -> bool:
        """Whether points that were lost in real time may be the busy machine's fault."""
        lost = any(check.outcome is Outcome.FAILED for check in self.checks)
        return self.time == "real" and self.held_up > HARMLESS and lost

    def group(self, name: str) -> tuple[CheckResult, ...]:
        """Return the checks that count for one locked grade cell."""
        return tuple(check for check in self.checks if check.group == name)

    def to_json(self) -> dict[str, Any]:
        """Return the published JSON form."""
        plain = {"schema": SCHEMA, **dataclasses.asdict(self), "score": self.score}
        return json.loads(json.dumps(plain, default=_enum_value))  # type: ignore[no-any-return]


def _enum_value(value: object) -> object:
    if isinstance(value, Enum):
        return value.value
    raise TypeError(f"{type(value).__name__} has no JSON form")


@cache
def schema() -> dict[str, Any]:
    """Return the JSON Schema of a result."""
    return json.loads(Path(__file__).with_name("result.schema.json").read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def from_json(data: object, *, source: str = "result") -> Result:
    """Rebuild a result from its JSON form.

    Raises:
        UsageError: `data` does not follow the published schema; names `source` and the field.
    """
    import jsonschema  # takes a second to import, which workers need not spend

    try:
        jsonschema.validate(data, schema())
    except jsonschema.ValidationError as error:
        field = ".".join(str(part) for part in error.absolute_path) or "the top level"
        raise UsageError(f"{source}: not a grading result: {field}: {error.message}") from None
    assert isinstance(data, dict)
    fields = _known(Result, data)
    fields["status"] = Status(fields["status"])
    diagnosis = _known(Diagnosis, fields["diagnosis"])
    try:
        fields["diagnosis"] = Diagnosis(**{**diagnosis, "kind": Kind(diagnosis["kind"])})
    except ValueError as error:
        raise UsageError(f"{source}: not a grading result of this version: diagnosis.kind: {error}") from None
    fields["checks"] = tuple(_check_from_json(item) for item in fields["checks"])
    if fields["build"] is not None:
        fields["build"] = Build(**{**_known(Build, fields["build"]), "packages": tuple(fields["build"]["packages"])})
    fields["artifacts"] = tuple(Artifact(**_known(Artifact, item)) for item in fields["artifacts"])
    return Result(**fields)


def _known(kind: type, item: dict[str, Any]) -> dict[str, Any]:
    """Keep what this version knows; a later one may have added fields."""
    names = {field.name for field in dataclasses.fields(kind)}
    return {name: value for name, value in item.items() if name in names}


def _check_from_json(item: dict[str, Any]) -> CheckResult:
    return CheckResult(
        **{
            **_known(CheckResult, item),
            "outcome": Outcome(item["outcome"]),
            "visibility": Visibility(item["visibility"]),
            "hints": tuple(item["hints"]),
        }
    )


def write_json(path: Path, data: object) -> None:
    """Write JSON whole or not at all: to a file beside `path` first, then renamed over it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(f".{path.name}.{os.getpid()}")
    text = json.dumps(data, indent=2, ensure_ascii=False, default=_enum_value) + "\n"
    # Half a surrogate pair (a file name that is no UTF-8) becomes the JSON escape that it came from.
    fresh.write_bytes(text.encode("utf-8", "backslashreplace"))
    fresh.replace(path)
