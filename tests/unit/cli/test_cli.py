"""The output and exit status of the command line."""

from __future__ import annotations

import importlib
import json
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from autograder import cli
from autograder.cli.grade import grade as grade_verb
from autograder.cli.text_tables import table
from autograder.exceptions import GraderError, UsageError
from autograder.grade import DEFAULT_SEED
from autograder.grade.isolated_reader import read_digests
from autograder.notebook.checking import CheckReport
from autograder.result import model as result
from autograder.run.sandbox import Isolation
from autograder.suite import Check, Outcome, Visibility, suites

MakeResult = Callable[..., result.Result]


def _run(*arguments: str) -> Result:
    return CliRunner().invoke(cli.group, arguments)


def _submission(folder: Path) -> Path:
    (folder / "src").mkdir(parents=True)
    return folder


@pytest.fixture
def replace_grade(monkeypatch: pytest.MonkeyPatch) -> Callable[..., dict[str, Any]]:
    """Return a function that makes `grade` return given results. It returns the options that `grade` is called with."""

    def give(*results: result.Result) -> dict[str, Any]:
        options_used: dict[str, Any] = {}

        def grade_all(entries: object, assignment: str, **options: Any) -> tuple[result.Result, ...]:
            options_used.update(options, entries=entries, assignment=assignment)
            for stored in results:
                options["on_result"](stored)
            return results

        monkeypatch.setattr(sys.modules["autograder.cli.grade"], "grade_all", grade_all)
        return options_used

    return give


def test_every_verb_has_help() -> None:
    overview = _run("--help")
    assert overview.exit_code == 0
    for verb in cli.VERBS:
        assert f"\n  {verb} " in overview.output
        completed = _run(verb, "--help")
        assert completed.exit_code == 0
        assert "Usage:" in completed.output


def test_a_module_that_only_helps_a_verb_is_not_listed_as_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("__init__.py", "check.py", "rows.py", "update.py"):
        (tmp_path / name).touch()
    monkeypatch.setattr(cli, "__file__", str(tmp_path / "__init__.py"))
    overview = _run("--help")
    assert (overview.exit_code, re.findall(r"\n  ([a-z]+) ", overview.output)) == (0, ["check", "update"])


@pytest.mark.promise("autograder grade submissions/ --assignment 02_nodes --out results -j 4")
def test_grading_prints_a_line_and_a_row_for_each_submission_and_exits_0(
    tmp_path: Path, make_result: MakeResult, replace_grade: Callable[..., dict[str, Any]]
) -> None:
    options = replace_grade(make_result("alice"))
    out, stored = tmp_path / "out", tmp_path / "all.json"
    completed = _run(
        *("grade", str(_submission(tmp_path / "alice")), "--assignment", "02_nodes", "--out", str(out)),
        *("--seed", "5", "-j", "3", "--json", str(stored)),
    )
    assert completed.exit_code == 0, completed.output
    assert "[1/1] alice: 4/10 = 40 %" in completed.output
    assert "it kept driving: 0.08 m from the north wall" in completed.output
    assert (options["seed"], options["jobs"], options["isolation"].value, options["resume"]) == (
        5,
        3,
        "bubblewrap",
        False,
    )
    assert json.loads(stored.read_text())[0]["student"] == "alice"
    assert (out / "index.html").is_file()


@pytest.mark.promise(
    "autograder grade submissions/ --assignment 02_nodes --out results --resume -j 4",
    "lists the marks that differ",
    "At the end, the command lists each student whose mark has changed, by how much, and because of which checks.",
)
def test_regrading_with_resume_lists_the_students_whose_mark_changed(
    tmp_path: Path, make_result: MakeResult, replace_grade: Callable[..., dict[str, Any]]
) -> None:
    for name in ("alice", "bob", "carol"):
        _submission(tmp_path / "class" / name)
    alice, bob, carol = make_result("alice"), make_result("bob"), make_result("carol")
    for stored in (alice, bob):  # carol is not graded yet
        result.write_json(tmp_path / "out" / stored.student / "result.json", stored.to_json())
    regraded = replace(alice, checks=(*alice.checks[:2], replace(alice.checks[2], points=4.0), *alice.checks[3:]))
    replace_grade(regraded, bob, carol)
    command = ("grade", str(tmp_path / "class"), "--assignment", "02_nodes", "--out", str(tmp_path / "out"))
    output = _run(*command, "--resume").output
    heading = "Marks that changed because of the suite or the submission:\n"
    assert output.endswith(heading + "alice (02_nodes): 4 -> 7\n    turns: 1 -> 4\n")
    assert "Marks that changed" not in _run(*command).output


@pytest.mark.promise("With `--resume`, it also says which stored results would stay and which would be replaced.")
def test_a_dry_run_of_grading_says_which_stored_results_are_kept_or_replaced(
    tmp_path: Path, make_result: MakeResult
) -> None:
    for name in ("alice", "bob", "carol"):
        node = tmp_path / "class" / name / "src" / "node.py"
        node.parent.mkdir(parents=True)
        node.write_text(f"print({name!r})")
    command = (
        "grade",
        str(tmp_path / "class"),
        "--assignment",
        "02_nodes",
        "--out",
        str(tmp_path / "out"),
        "--dry-run",
    )
    suite = suites.hidden("02_nodes")
    digests = read_digests(tmp_path / "class" / "alice", "02_nodes", Isolation.BUBBLEWRAP)
    assert digests is not None
    current = make_result("alice", submission_sha256=digests.sha256, suite_version=suite.version, seed=DEFAULT_SEED)
    for stored in (current, make_result("bob")):
        result.write_json(tmp_path / "out" / stored.student / "result.json", stored.to_json())
    before = {path: path.read_bytes() for path in (tmp_path / "out").rglob("*.json")}
    for options, action in (((), "replaces"), (("--resume",), "keeps")):
        output = " ".join(_run(*command, *options).output.split())
        assert f"alice {action} 4/10 = 40 %" in output
        assert "bob replaces 4/10 = 40 %" in output
        assert "carol new" in output
        assert "Nothing was graded or written." in output
    assert {path: path.read_bytes() for path in (tmp_path / "out").rglob("*") if path.is_file()} == before


def test_a_submission_that_was_not_graded_exits_1_and_shows_no_zero(
    tmp_path: Path, ungraded_result: result.Result, replace_grade: Callable[..., dict[str, Any]]
) -> None:
    replace_grade(ungraded_result)
    completed = _run(
        "grade", str(_submission(tmp_path / "carol")), "--assignment", "02_nodes", "--out", str(tmp_path / "out")
    )
    assert completed.exit_code == 1
    assert "carol       not graded" in completed.output
    assert "0/10" not in completed.output


@pytest.mark.parametrize(
    "arguments",
    [
        ("grade",),
        ("grade", "x"),
        ("grade", "x", "--assignment", "02_nodes", "--seed", "-1"),
        ("grade", "x", "--assignment", "02_nodes", "-j", "0"),
        ("grade", "x", "--assignment", "02_nodes", "--isolation", "none"),
        ("check",),
        ("fly",),
    ],
)
def test_a_wrong_call_exits_2(arguments: tuple[str, ...]) -> None:
    assert _run(*arguments).exit_code == 2


def _main(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(list(arguments))
    code = exit_info.value.code
    assert isinstance(code, int)
    return code


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("grade", "/no/where", "--assignment", "02_nodes"), "/no/where: there is no such file or folder"),
        (("grade", "/tmp", "--assignment", "77_none"), "there are no hidden checks for '77_none'; there are for: "),
        (("check", "77_none", "/tmp"), "'77_none' has no visible checks"),
        (("check", "02_nodes", "/no/where"), "the folder /no/where/src does not exist"),
    ],
)
def test_an_unknown_name_is_reported_in_one_sentence_and_exits_2(
    arguments: tuple[str, ...], message: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _main(monkeypatch, *arguments) == 2
    errors = capsys.readouterr().err
    assert message in errors
    assert "Traceback" not in errors


@pytest.mark.parametrize(("error", "status"), [(UsageError("wrong"), 2), (GraderError("broken"), 1)])
def test_a_known_error_is_reported_in_a_sentence(
    error: Exception, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def fail(*arguments: object, **options: object) -> None:
        raise error

    monkeypatch.setattr(sys.modules["autograder.cli.check"], "run_checks", fail)
    assert _main(monkeypatch, "check", "02_nodes", str(tmp_path)) == status
    assert capsys.readouterr().err == f"autograder: {error}\n"


@pytest.mark.promise("In a terminal, `autograder check 02_nodes` does the same.")
@pytest.mark.parametrize("folder", ["ws", "02_nodes/ws", "chapters/02_nodes/ws"])
def test_checking_finds_the_workspace_from_the_chapter_and_from_the_course(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / folder).mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    calls: list[tuple[str, Path]] = []

    def run_checks(assignment: str, workspace: Path, **options: object) -> CheckReport:
        calls.append((assignment, workspace))
        return CheckReport(assignment, ())

    monkeypatch.setattr(importlib.import_module("autograder.cli.check"), "run_checks", run_checks)
    _run("check", "02_nodes")
    assert calls == [("02_nodes", Path(folder))]


@pytest.mark.promise("`fresh=True` in the notebook, or `--fresh` in a terminal, runs the checks anyway.")
def test_the_options_of_check_are_passed_to_the_checks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[dict[str, object]] = []

    def run_checks(assignment: str, workspace: Path, **options: object) -> CheckReport:
        calls.append({name: value for name, value in options.items() if value})
        return CheckReport(assignment, ())

    monkeypatch.setattr(sys.modules["autograder.cli.check"], "run_checks", run_checks)
    _run("check", "08_capstone", str(tmp_path), "--step", "2", "--fresh")
    _run("check", "09_assessment", str(tmp_path), "--question", "3")
    _run("check", "04_launch", str(tmp_path), "--exercise", "1")
    assert calls == [{"step": 2, "fresh": True}, {"question": 3}, {"exercise": 1}]


@pytest.mark.parametrize(("outcome", "status"), [(Outcome.PASSED, 0), (Outcome.FAILED, 1), (Outcome.NOT_CHECKED, 1)])
def test_checking_exits_0_only_when_every_check_passed(
    outcome: Outcome, status: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    turns = Check("turns", "It turns.", 2.0, "graph", Visibility.VISIBLE, ("look left",), None, ())
    report = CheckReport("02_nodes", (result.CheckResult.of(turns, outcome, "it did not"),))
    monkeypatch.setattr(sys.modules["autograder.cli.check"], "run_checks", lambda *arguments, **options: report)
    completed = _run("check", "02_nodes", str(tmp_path), "--json", str(tmp_path / "report.json"))
    assert completed.exit_code == status
    assert "It turns." in completed.output
    assert json.loads((tmp_path / "report.json").read_text())["lines"][0]["outcome"] == outcome.value


def test_a_long_reason_is_wrapped_below_its_column() -> None:
    text = table([("alice", "3/4", "word " * 60), ("bob", "4/4", "")], ("submission", "marks", "why"))
    lines = text.splitlines()
    assert lines[0].startswith("submission")
    assert all(line.startswith(" " * 15) for line in lines[3:-1])
    assert lines[-1] == "bob           4/4"


def test_a_table_has_as_many_columns_as_its_headings() -> None:
    text = table([("alice", "3/4", "61 s", "it turns"), ("bob", "4/4", "9 s", "")], ("who", "marks", "time", "why"))
    assert text.splitlines()[2:] == ["alice    3/4  61 s  it turns", "bob      4/4   9 s"]


def test_the_installed_command_works_and_reports_errors() -> None:
    command = [str(Path(sys.executable).with_name("autograder")), "grade", "/no/where", "--assignment", "02_nodes"]
    completed = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (completed.returncode, completed.stderr) == (2, "autograder: /no/where: there is no such file or folder\n")
    assert grade_verb.callback is not None
