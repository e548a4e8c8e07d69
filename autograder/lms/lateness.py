"""Determines how late a submission is, and what share of its marks it keeps.

The deadline is `until` in the student's row of the table of extensions, or the due time plus `days` in that row.

The submission time is `submitted` in that row, the time in the download, or the due time plus the delay in Moodle's
table, whichever is known first. Without a time, a submission is late if the system marks it as late.

Within the grace period, no marks are deducted. After it, the delay is counted from the deadline, and a started day
counts as a whole day. The floor is applied last.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date, datetime, time, timedelta, tzinfo
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.lms.tables import FindStudent, Row, read_rows

DAY = timedelta(days=1)
MAX_DAYS = 3660  # the longest extension
DAYS, UNTIL, SUBMITTED = "days", "until", "submitted"


@dataclass(frozen=True)
class Extension:
    """A student's extension, as days or a deadline, and the submission time if the instructor gives it."""

    days: timedelta = timedelta()
    until: datetime | None = None
    submitted: datetime | None = None


@dataclass(frozen=True)
class Delivery:
    """A system's information about a submission: whether it is late, by how much, and its time; None if unknown."""

    late: bool = False
    late_by: timedelta | None = None
    time: datetime | None = None


@dataclass(frozen=True)
class Lateness:
    """The effect of lateness on a submission.

    Attributes:
        kept_share: the share of its marks that it keeps, 0 to 1.
        days: the number of late days, or None if the system only reports that it is late.
        unclear: a sentence with the reason if the effect cannot be determined, or an empty string.
    """

    kept_share: float = 1.0
    days: int | None = 0
    unclear: str = ""


@dataclass(frozen=True)
class LatePolicy:
    """The rules for late submissions.

    Attributes:
        flat: the percentage of its marks that a late submission loses, whatever its delay.
        per_day: the percentage that it loses for each started day; one of the two is 0.
        floor: the percentage that it always keeps.
        grace: the longest delay without a deduction.
        due: when the assignment was due, or None to rely on the system alone.
        zone: the time zone of times without one; None means this machine's.
        extensions: extensions of individual students.
    """

    flat: float = 0.0
    per_day: float = 0.0
    floor: float = 0.0
    grace: timedelta = timedelta()
    due: datetime | None = None
    zone: tzinfo | None = None
    extensions: Mapping[str, Extension] = field(default_factory=dict)

    def lateness_of(self, student: str, delivery: Delivery) -> Lateness:
        """Return the lateness of a student's submission."""
        extension = self.extensions.get(student, Extension())
        deadline = extension.until or (None if self.due is None else self.due + extension.days)
        submitted = extension.submitted or delivery.time
        if submitted is None and self.due is not None and delivery.late_by is not None:
            submitted = self.due + delivery.late_by
        if submitted is not None and deadline is not None:
            return self._late_by(submitted - deadline)
        if delivery.late_by is not None and extension.until is None:
            return self._late_by(delivery.late_by - extension.days)
        if not delivery.late:
            return Lateness()
        if self.per_day or self.grace or student in self.extensions:
            is_timed = submitted is not None or delivery.late_by is not None
            missing = "--due" if is_timed else f"the time in the column {SUBMITTED!r} of --extensions"
            return Lateness(unclear=f"it is late, but by how much is unknown: give {missing}")
        return self._deduct(self.flat, None)

    def _late_by(self, delay: timedelta) -> Lateness:
        if delay <= max(self.grace, timedelta()):
            return Lateness()
        days = math.ceil(delay / DAY)
        return self._deduct(self.flat + self.per_day * days, days)

    def _deduct(self, lost_percent: float, days: int | None) -> Lateness:
        return Lateness(max(self.floor, 100.0 - lost_percent, 0.0) / 100, days)


def read_extensions(path: Path, find_student: FindStudent, zone: tzinfo | None) -> dict[str, Extension]:
    """Read the extensions of students: a CSV file with the columns `student`, and `days`, `until` or both.

    The column `submitted` gives a submission time that the system does not know. Raises UsageError, with the line, if
    all of these columns are missing, a row has both days and a deadline, or a cell is not a number of days or a time.
    """
    rows = read_rows(path, (), find_student, one_of=(DAYS, UNTIL, SUBMITTED))
    return {row.student: _extension(row, zone) for row in rows}


def _extension(row: Row, zone: tzinfo | None) -> Extension:
    days, until, submitted = (row.cells.get(name, "") for name in (DAYS, UNTIL, SUBMITTED))
    if days and until:
        raise row.error(f"it has both {DAYS} and {UNTIL}: remove one")
    try:
        extra_days = timedelta(days=float(days or 0))
    except (ValueError, OverflowError):
        extra_days = timedelta(days=-1)
    if not timedelta() <= extra_days <= MAX_DAYS * DAY:
        raise row.error(f"{days!r} is not a number of days from 0 to {MAX_DAYS}")
    try:
        deadline = parse_time(until, zone) if until else None
        return Extension(extra_days, deadline, parse_time(submitted, zone) if submitted else None)
    except UsageError as error:
        raise row.error(str(error)) from None


def parse_time(text: str, zone: tzinfo | None) -> datetime:
    """Return the time of an ISO 8601 text. A day without a time means its end.

    Args:
        text: such as `2026-05-04`, `2026-05-04 18:00` or `2026-05-04T18:00+02:00`.
        zone: the time zone of a time without one; None means this machine's.

    Raises:
        UsageError: the text is not such a time.
    """
    parsed = _parse(text)
    if parsed.tzinfo is not None:
        return parsed
    return parsed.astimezone() if zone is None else parsed.replace(tzinfo=zone)


def zone_of(text: str) -> tzinfo | None:
    """Return the time zone in an ISO 8601 time, or None. Raises UsageError like `parse_time`."""
    return _parse(text).tzinfo


def _parse(text: str) -> datetime:
    try:
        return datetime.combine(date.fromisoformat(text), time.max)
    except ValueError:
        pass
    try:
        return datetime.fromisoformat(f"{text[:-1]}+00:00" if text.endswith("Z") else text)
    except ValueError:
        example = "2026-05-04 18:00 or 2026-05-04T18:00+02:00"
        raise UsageError(f"{text!r} is not a time in ISO 8601, such as {example}") from None
