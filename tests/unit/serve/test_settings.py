"""The settings of the hub's service, and the errors that wrong settings cause."""

from __future__ import annotations

from datetime import datetime, timedelta, timezone
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from autograder.exceptions import UsageError
from autograder.lms.serve.settings import AssignmentSettings, Settings, ShownParts, read_settings

WHOLE = """
instructors: [grace, alan]
timezone: Europe/Berlin
exchange: /srv/exchange/ros2-python/inbound
assignments:
  02_nodes:
    due: 2026-10-12 23:59
    tries_a_day: 3
    shown: points
    counts: best
    extensions: {ada: 2026-10-19 23:59}
  01_package_structure:
"""
BERLIN = ZoneInfo("Europe/Berlin")
DUE = datetime(2026, 10, 12, 23, 59, tzinfo=BERLIN)
MINUTE = timedelta(minutes=1)


def read(tmp_path: Path, text: str) -> Settings:
    path = tmp_path / "serve.yaml"
    path.write_text(text)
    return read_settings(path)


def test_every_setting_is_read(tmp_path: Path) -> None:
    settings = read(tmp_path, WHOLE)
    later = DUE + timedelta(days=7)
    assert settings.instructors == {"grace", "alan"}
    assert settings.zone == BERLIN
    assert settings.exchange == Path("/srv/exchange/ros2-python/inbound")
    assert settings.assignments == {
        "02_nodes": AssignmentSettings(DUE, 3, ShownParts.POINTS, best_counts=True, extensions={"ada": later}),
        "01_package_structure": AssignmentSettings(),
    }


@pytest.mark.parametrize(
    ("line", "replacement", "message"),
    [
        ("inbound", "outbound", "3: exchange is '/srv/exchange/ros2-python/outbound'. Give the course's folder in it"),
        (
            "/srv/exchange/",
            "exchange/",
            "3: exchange is 'exchange/ros2-python/inbound'. Give the course's folder in it",
        ),
        ("due: 2026-10-12 23:59", "due: tomorrow", "6: due is 'tomorrow'. Give a time such as 2026-10-12 23:59"),
        ("due: 2026-10-12 23:59", "due: 2026-10-12", "6: due has no time of day. Write 2026-10-12 23:59"),
        ("due: 2026-10-12 23:59", "due:", "6: due is blank"),
        ("tries_a_day: 3", "tries_a_day: 0", "7: tries_a_day is 0. Give a whole number from 1 to 1000"),
        ("tries_a_day: 3", "tries_a_day: many", "7: tries_a_day is 'many'. Give a number"),
        ("tries_a_day: 3", "trys_a_day: 3", "7: 02_nodes has no field 'trys_a_day'. Did you mean 'tries_a_day'?"),
        ("shown: points", "shown: all", "8: shown is 'all'. Give everything or visible or points or nothing"),
        ("counts: best", "counts: mean", "9: counts is 'mean'. Give best or last"),
        ("extensions: {ada: 2026-10-19 23:59}", "extensions: [ada]", "10: extensions are not a mapping"),
        ("ada: 2026-10-19 23:59", "ada: later", "10: the extension of ada is 'later'"),
        ("  02_nodes:", "  02_node:", "5: assignments has no field '02_node'. Did you mean '02_nodes'?"),
        ("  01_package_structure:", "  02_nodes:", "11: assignments has the field '02_nodes' twice"),
        ("Europe/Berlin", "Europe/Atlantis", "2: unknown time zone 'Europe/Atlantis'"),
        ("Europe/Berlin", "../../etc/passwd", "2: unknown time zone"),
        ("[grace, alan]", "grace", "1: instructors is 'grace'. Give a list"),
        ("timezone", "timezones", "2: the file has no field 'timezones'"),
        ("assignments:", "assignments: [", ": this is not YAML"),
        ("instructors: [grace, alan]", "- instructors", ": this is not YAML"),
        ("    due: 2026-10-12 23:59\n", "", "9: 02_nodes has extensions and is never due"),
    ],
)
def test_a_mistake_is_named_with_its_line(tmp_path: Path, line: str, replacement: str, message: str) -> None:
    text = WHOLE.lstrip()
    assert line in text
    with pytest.raises(UsageError) as excinfo:
        read(tmp_path, text.replace(line, replacement))
    assert f"{tmp_path / 'serve.yaml'}:" in str(excinfo.value)
    assert message in str(excinfo.value)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "the settings are a mapping"),
        (b"- a\n- b\n", "the settings are a mapping"),
        (b"assignments: {}\n", "no assignment is configured"),
        (b"instructors: [a]\n", "the file lacks 'assignments'"),
        (b"\xff\xfe", "not UTF-8"),
        (b"[" * 100_000, "YAML"),
        (b"#" * 1_100_000, "larger than 1 MiB"),
    ],
)
def test_a_file_that_is_not_a_settings_file_is_named(tmp_path: Path, data: bytes, message: str) -> None:
    path = tmp_path / "serve.yaml"
    path.write_bytes(data)
    with pytest.raises(UsageError, match=message) as excinfo:
        read_settings(path)
    assert str(path) in str(excinfo.value)


def test_a_missing_settings_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="No such file"):
        read_settings(tmp_path / "serve.yaml")


def test_the_shown_feedback_changes_at_each_students_due_time(tmp_path: Path) -> None:
    assignment = read(tmp_path, WHOLE).assignments["02_nodes"]
    assert [assignment.shown_to("bob", DUE + after) for after in (-MINUTE, MINUTE)] == [
        ShownParts.POINTS,
        ShownParts.EVERYTHING,
    ]
    assert assignment.shown_to("ada", DUE + MINUTE) is ShownParts.POINTS
    assert [assignment.is_open("bob", DUE + after) for after in (-MINUTE, 0 * MINUTE, MINUTE)] == [True, True, False]
    assert assignment.is_open("ada", DUE + MINUTE)
    assert AssignmentSettings().is_open("bob", DUE + MINUTE)


def test_tries_are_counted_by_the_day_of_the_time_zone(tmp_path: Path) -> None:
    settings = read(tmp_path, WHOLE)
    now = datetime(2026, 10, 5, 22, 30, tzinfo=timezone.utc)  # half past midnight in Berlin
    earlier = [now - timedelta(minutes=minutes) for minutes in (10, 20, 40)]
    assert settings.tries_left("02_nodes", earlier, now) == 1
    assert settings.tries_left("02_nodes", earlier * 2, now) == 0
    assert settings.tries_left("02_nodes", [], now) == 3
