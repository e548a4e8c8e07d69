"""`autograder replay`: a page with one check of a stored result and its run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from autograder import cli
from autograder.exceptions import UsageError
from autograder.result.artifacts import Artifacts
from autograder.result.model import Result, write_json
from sim import Command, Simulation, World, box, run

RECORDING = run(Simulation(World.from_segments(box(4.0, 3.0))), lambda state, scans: Command(linear=0.2), seconds=0.5)


@pytest.fixture
def stored_result(make_result: Callable[..., Result], tmp_path: Path) -> Path:
    """The folder of a result with runs of two checks."""
    artifacts = Artifacts(tmp_path)
    for check in ("starts", "turns"):
        artifacts.of(check).track("track", RECORDING, f"The run of {check}.")
    write_json(tmp_path / "result.json", make_result(artifacts=tuple(artifacts.saved)).to_json())
    return tmp_path


@pytest.mark.promise("autograder replay results/alice --check room")
def test_the_stored_run_of_a_check_is_shown_on_its_own(stored_result: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(variable, raising=False)
    for path in (stored_result, stored_result / "result.json"):  # the first run's page is not a second result
        completed = CliRunner().invoke(cli.group, ["replay", str(path), "--check", "turns"])
        assert completed.exit_code == 0, completed.output
        page = stored_result / "replay" / "turns" / "feedback.html"
        assert completed.output == f"The run of 'turns': {page}\n"
    text = page.read_text(encoding="utf-8")
    assert 'id="run-turns-track"' in text
    assert 'id="run-starts-track"' not in text


def test_the_option_to_open_a_browser_opens_the_page(stored_result: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    for option in ("--open", "--no-open"):
        assert CliRunner().invoke(cli.group, ["replay", str(stored_result), "--check", "turns", option]).exit_code == 0
    assert opened == [(stored_result / "replay" / "turns" / "feedback.html").as_uri()]


def test_a_wrong_call_of_replay_is_reported_with_the_right_one(stored_result: Path) -> None:
    for options, sentence in (
        (["--check", "flies"], "the result has no check 'flies'; it has: starts, listens, turns"),
        (["--check", "turns", "--mcap"], "--mcap needs --submission PATH"),
    ):
        error = CliRunner().invoke(cli.group, ["replay", str(stored_result), *options]).exception
        assert isinstance(error, UsageError)
        assert sentence in str(error)
    write_json(stored_result / "more" / "result.json", {})
    error = CliRunner().invoke(cli.group, ["replay", str(stored_result), "--check", "turns"]).exception
    assert isinstance(error, UsageError)
