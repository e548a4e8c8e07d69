"""Deductions for late submissions: deadlines, extensions, the grace period, penalties and the floor, in this order."""

from __future__ import annotations

import csv
import json
import time
from collections.abc import Callable
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest
from click.testing import CliRunner
from click.testing import Result as Ran

from autograder.cli import group
from autograder.exceptions import UsageError
from autograder.lms.lateness import Delivery, Extension, Lateness, LatePolicy, parse_time
from autograder.result.model import Result, write_json

MakeResult = Callable[..., Result]
DUE = datetime(2026, 5, 4, 18, tzinfo=timezone.utc)
HOUR, DAY = timedelta(hours=1), timedelta(days=1)
DAILY = LatePolicy(per_day=10, floor=40, grace=HOUR, due=DUE)


def delivered(after: timedelta) -> Delivery:
    return Delivery(time=DUE + after)


@pytest.mark.parametrize(
    ("after", "days", "share"),
    [
        (-DAY, 0, 1.0),
        (timedelta(), 0, 1.0),
        (HOUR, 0, 1.0),
        (HOUR + timedelta(seconds=1), 1, 0.9),
        (DAY, 1, 0.9),
        (DAY + timedelta(seconds=1), 2, 0.8),
        (6 * DAY, 6, 0.4),
        (7 * DAY, 7, 0.4),
        (99 * DAY, 99, 0.4),
    ],
)
def test_a_day_that_has_begun_counts_from_the_deadline_and_the_floor_stays(
    after: timedelta, days: int, share: float
) -> None:
    lateness = DAILY.lateness_of("ada", delivered(after))
    assert lateness == Lateness(lateness.kept_share, days)
    assert lateness.kept_share == pytest.approx(share)


def test_a_flat_penalty_is_the_same_for_each_delay_and_no_penalty_exceeds_the_mark() -> None:
    policy = LatePolicy(flat=20, due=DUE)
    assert [policy.lateness_of("ada", delivered(after)).kept_share for after in (HOUR, 9 * DAY)] == [0.8, 0.8]
    assert LatePolicy(per_day=30, due=DUE).lateness_of("ada", delivered(9 * DAY)).kept_share == 0.0


@pytest.mark.promise(
    "A student's deadline is `until` in their row of `--extensions`.",
    "Without it, it is `--due` and the `days` in their row.",
)
@pytest.mark.parametrize(
    ("extension", "days"),
    [
        (Extension(), 3),
        (Extension(days=2 * DAY), 1),
        (Extension(days=3 * DAY), 0),
        (Extension(until=DUE + 2 * DAY), 1),
        (Extension(until=DUE - 2 * DAY), 5),  # a deadline may also be an earlier one
        (Extension(submitted=DUE + 2 * HOUR), 1),  # a person's entry overrides the system's time
        (Extension(days=DAY, submitted=DUE + DAY), 0),
    ],
)
def test_a_row_of_the_table_overrides_the_due_time_and_the_systems_time(extension: Extension, days: int) -> None:
    policy = LatePolicy(per_day=10, due=DUE, extensions={"ada": extension})
    assert policy.lateness_of("ada", delivered(3 * DAY)).days == days
    assert policy.lateness_of("bob", delivered(3 * DAY)).days == 3


def test_moodles_delay_counts_without_a_due_time_and_extension_days_are_subtracted_from_it() -> None:
    policy = LatePolicy(per_day=10, extensions={"ada": Extension(days=DAY), "eve": Extension(until=DUE)})
    moodle_delivery = Delivery(late=True, late_by=DAY + 2 * HOUR)
    assert [policy.lateness_of(name, moodle_delivery).days for name in ("ada", "bob")] == [1, 2]
    assert policy.lateness_of("eve", moodle_delivery).unclear == "it is late, but by how much is unknown: give --due"
    policy_with_deadlines = LatePolicy(per_day=10, due=DUE, extensions={"eve": Extension(until=DUE + DAY)})
    assert policy_with_deadlines.lateness_of("eve", moodle_delivery).days == 1


def test_a_time_overrides_the_systems_late_flag_which_alone_suffices_only_for_a_flat_penalty() -> None:
    late_flag = Delivery(late=True)
    assert LatePolicy(flat=25).lateness_of("ada", late_flag) == Lateness(0.75, None)
    assert LatePolicy(flat=25, due=DUE).lateness_of("ada", Delivery(late=True, time=DUE)) == Lateness()
    for policy in (
        LatePolicy(per_day=10, due=DUE),
        LatePolicy(flat=10, grace=HOUR),
        LatePolicy(flat=10, due=DUE, extensions={"ada": Extension(days=DAY)}),
    ):
        assert "'submitted'" in policy.lateness_of("ada", late_flag).unclear
        assert policy.lateness_of("ada", Delivery()) == Lateness()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2026-05-04T18:00+02:00", "2026-05-04T18:00:00+02:00"),
        ("2026-05-04 18:00", "2026-05-04T18:00:00+00:00"),
        ("2026-05-04T18:00:00Z", "2026-05-04T18:00:00+00:00"),
        ("2026-05-04", "2026-05-04T23:59:59.999999+00:00"),
    ],
)
def test_a_time_without_a_zone_gets_the_given_one_and_a_day_means_its_end(text: str, expected: str) -> None:
    assert parse_time(text, timezone.utc).isoformat() == expected


def test_a_time_without_any_zone_is_in_the_machines_time_zone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TZ", "HERE-5")  # POSIX: five hours before UTC
    time.tzset()
    try:
        assert parse_time("2026-05-04 18:00", None).isoformat() == "2026-05-04T18:00:00+05:00"
    finally:
        monkeypatch.undo()
        time.tzset()


CANVAS = """Student,ID,SIS Login ID,Section,02 Nodes (55)
    Points Possible,,,,10
"Doe, Jane",7001,jane,A,
"Müller, Zoë",7002,zoe,A,
"Roe, Bob",7003,bob,A,
"""


@pytest.fixture
def results_folder(tmp_path: Path, make_result: MakeResult) -> Path:
    """Write results with 4 of 10 points each, and the known times of their submissions."""
    for student in ("jane", "zoe", "bob"):
        write_json(tmp_path / "results" / student / "result.json", make_result(student).to_json())
    handed_in = {"late": ["jane"], "times": {"zoe": "2026-05-06 17:00:00", "bob": "2026-05-04 15:00:00+00:00"}}
    write_json(tmp_path / "results" / "handed_in.json", handed_in)
    (tmp_path / "roster.csv").write_text(CANVAS, encoding="utf-8")
    return tmp_path


def export(folder: Path, *options: str, form: str = "canvas") -> Ran:
    command = ["export", str(folder / "results"), "--format", form, "--out", str(folder / "out.csv")]
    return CliRunner().invoke(group, [*command, "--roster", str(folder / "roster.csv"), *options])


def cells(folder: Path, key: str, name: str) -> dict[str, str]:
    with (folder / "out.csv").open(encoding="utf-8", newline="") as file:
        return {row[key]: row[name] for row in csv.DictReader(file) if row[key]}


@pytest.mark.promise(
    "autograder export results --format canvas --roster gradebook.csv --due 2026-05-04T18:00+02:00",
    "`--late-per-day 10` deducts a tenth of the marks for each day that has begun",
    "`--grace 1` lets an hour pass",
    "A time without a time zone is in that of `--due`",
    "`--late-floor 40` leaves 40 % in any case",
    "If nothing says how late a submission is, it has no mark, is listed, and the exit status is 1.",
)
def test_export_applies_the_table_of_extensions_and_names_students_without_a_known_time(results_folder: Path) -> None:
    options = ("--due", "2026-05-04T18:00+02:00", "--late-per-day", "10", "--grace", "1", "--late-floor", "40")
    completed = export(results_folder, *options)
    assert completed.exit_code == 1
    assert "Left out: jane: it is late, but by how much is unknown" in completed.output
    # zoe's time has no zone, so it is that of --due: 1 day and 23 hours late. bob came in time, in another zone.
    assert cells(results_folder, "SIS Login ID", "02 Nodes (55)") == {"jane": "", "zoe": "3.20", "bob": "4.00"}

    (results_folder / "extensions.csv").write_text(
        'student,days,until,submitted\nzoe,1,,\njane,,2026-05-08,2026-05-09 12:00\n"Roe, Bob",,2026-05-01T12:00Z,\n'
    )
    completed = export(results_folder, *options, "--extensions", str(results_folder / "extensions.csv"))
    assert completed.exit_code == 0, completed.output
    assert cells(results_folder, "SIS Login ID", "02 Nodes (55)") == {"jane": "3.60", "zoe": "3.60", "bob": "2.40"}


def test_a_csv_file_has_the_late_days_and_the_mark_beside_the_score(results_folder: Path) -> None:
    completed = export(results_folder, "--due", "2026-05-04T18:00+00:00", "--late-per-day", "10", form="csv")
    assert completed.exit_code == 1
    assert cells(results_folder, "student", "late_days") == {"bob": "0", "jane": "", "zoe": "2"}
    assert cells(results_folder, "student", "mark") == {"bob": "4.0", "jane": "", "zoe": "3.2"}
    assert set(cells(results_folder, "student", "score").values()) == {"4.0"}
    assert export(results_folder, form="csv").exit_code == 0
    assert "late_days" not in (results_folder / "out.csv").read_text()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("student,day\nzoe,1\n", "extensions.csv, line 1: it needs one of the columns days, until, submitted"),
        ("days\n1\n", "extensions.csv, line 1: the column 'student' is missing"),
        ("student,days\neve,1\n", "extensions.csv, line 2: 'eve' matches no student or several"),
        ("student,days\nzoe,-1\n", "extensions.csv, line 2: '-1' is not a number of days from 0 to 3660"),
        ("student,days\nzoe,nan\n", "extensions.csv, line 2: 'nan' is not a number of days"),
        ("student,days\nzoe,1e99\n", "extensions.csv, line 2: '1e99' is not a number of days"),
        ("student,until\nzoe,4 May\n", "extensions.csv, line 2: '4 May' is not a time in ISO 8601"),
        ("student,days,until\nzoe,1,2026-05-08\n", "extensions.csv, line 2: it has both days and until"),
        ("student,days\nzoe,1\nzoe,2\n", "extensions.csv, line 3: zoe is also in .*, line 2: remove"),
    ],
)
def test_a_wrong_table_of_extensions_is_an_error_that_names_the_line(
    results_folder: Path, text: str, reason: str
) -> None:
    (results_folder / "extensions.csv").write_text(text)
    completed = export(results_folder, "--extensions", str(results_folder / "extensions.csv"))
    with pytest.raises(UsageError, match=reason):
        raise completed.exception or AssertionError(completed.output)
    assert not (results_folder / "out.csv").exists()


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--late-penalty", "10", "--late-per-day", "10"), "give one of the two"),
        (("--due", "tomorrow"), "--due: 'tomorrow' is not a time in ISO 8601"),
    ],
)
def test_options_that_contradict_each_other_are_an_error(
    results_folder: Path, options: tuple[str, ...], reason: str
) -> None:
    assert reason in str(export(results_folder, *options).exception)


def test_late_options_are_an_error_where_no_mark_would_change(results_folder: Path) -> None:
    assert "--format csv, canvas, moodle, not junit" in str(
        export(results_folder, "--grace", "1", form="junit").exception
    )


def test_a_dry_run_shows_the_marks_of_late_submissions(results_folder: Path) -> None:
    completed = export(results_folder, "--due", "2026-05-04T18:00+02:00", "--late-per-day", "10", "--dry-run")
    assert ["zoe", "3.20"] in [line.split() for line in completed.output.splitlines()]
    assert not (results_folder / "out.csv").exists()
    assert json.loads((results_folder / "results" / "handed_in.json").read_text())["late"] == ["jane"]
