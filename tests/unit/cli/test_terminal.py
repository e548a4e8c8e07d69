"""A student's text cannot control the grader's terminal, whichever verb prints it."""

from __future__ import annotations

import ast
import unicodedata
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from autograder import cli
from autograder.cli.text_tables import table
from autograder.course_paths import ROOT
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.notebook.checking import CheckReport
from autograder.plain_text import visible
from autograder.result.model import Result, write_json
from autograder.suite import Outcome

# A window title, the clipboard, a cursor movement, C1 controls, marks that reverse a line or are invisible, ends of
# lines, and half of a surrogate pair.
HOSTILE = "a\x1b]0;t\x07\x1b]52;c;eA==\x07\x1b[2A\x9b1m\u202eb\u2066\u200f\u200b\ufeff\u2028\x85\r\x00\x7f\udc80z"
MakeResult = Callable[..., Result]


MARKS = "\u200b\u200f\ufeff"  # allowed on a page: some languages need them, and they do not reverse text


def expect_harmless(text: str, allowed: str = "") -> None:
    controls = {char for char in text if unicodedata.category(char) in ("Cc", "Cf", "Cs", "Zl", "Zp")}
    assert not controls - {"\n", "\t", *allowed}, sorted(map(ascii, controls))


@pytest.fixture
def hostile_result(make_result: MakeResult) -> Result:
    result = make_result("b" + HOSTILE.replace("\x00", ""))
    checks = tuple(
        replace(check, message=HOSTILE + check.message) if check.outcome is Outcome.FAILED else check
        for check in result.checks
    )
    return replace(result, checks=checks)


def run(*arguments: str) -> str:
    completed = CliRunner().invoke(cli.group, arguments)
    assert completed.exception is None or isinstance(completed.exception, SystemExit), completed.output
    expect_harmless(completed.output)
    return completed.output


def test_grading_escapes_control_characters_in_names_and_messages(
    tmp_path: Path, hostile_result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = replace(
        hostile_result, student="c\nd", diagnosis=Diagnosis(Kind.BUILD_FAILED, HOSTILE), build=None, checks=()
    )

    def grade_all(entries: object, assignment: str, *, on_result: Callable[[Result], None], **_: Any) -> list[Result]:
        on_result(hostile_result)
        return [hostile_result, broken]

    monkeypatch.setattr(import_module("autograder.cli.grade"), "grade_all", grade_all)
    (tmp_path / "x" / "src").mkdir(parents=True)
    output = run("grade", str(tmp_path / "x"), "--assignment", "02_nodes", "--out", str(tmp_path / "out"))
    assert r"\x1b]52;c;eA==\x07" in output
    assert r"\u202eb" in output
    assert not any(line.startswith("d") for line in output.splitlines())  # a name has one line


@pytest.mark.parametrize("form", ["csv", "markdown", "junit"])
def test_exporting_escapes_control_characters_in_names_and_messages(
    tmp_path: Path, hostile_result: Result, form: str
) -> None:
    write_json(tmp_path / "all" / "results.json", [hostile_result.to_json()])
    run("export", str(tmp_path / "all"), "--format", form, "--out", str(tmp_path / "marks"))
    expect_harmless((tmp_path / "marks").read_bytes().decode().replace("\r\n", "\n"), MARKS)


def test_a_formula_is_text_in_a_spreadsheet(tmp_path: Path, make_result: MakeResult) -> None:
    for begin in ("=", "+", "-", "@", "\t=", "\x1b[1m=", "\u200b=", "\x00@"):
        write_json(tmp_path / "all" / "results.json", [make_result(f"{begin}HYPERLINK(1)").to_json()])
        run("export", str(tmp_path / "all"), "--format", "csv", "--out", str(tmp_path / "marks.csv"))
        cell = (tmp_path / "marks.csv").read_text(encoding="utf-8").splitlines()[1].split(",")[1]
        assert not cell.startswith(("=", "+", "-", "@")), begin


def test_comparing_and_replaying_escape_control_characters_in_names(tmp_path: Path, hostile_result: Result) -> None:
    for folder, score in (("old", 1.0), ("new", 0.0)):
        checks = (replace(hostile_result.checks[0], points=score), *hostile_result.checks[1:])
        write_json(tmp_path / folder / "result.json", replace(hostile_result, checks=checks).to_json())
    assert r"\x1b]0;t\x07" in run("compare", str(tmp_path / "old"), str(tmp_path / "new"))
    run("replay", str(tmp_path / "new"), "--check", hostile_result.checks[0].id, "--no-open")


def test_checking_escapes_control_characters_in_messages(
    tmp_path: Path, hostile_result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed = [check for check in hostile_result.checks if check.outcome is Outcome.FAILED]

    def checked(assignment: str, workspace: Path, **options: object) -> CheckReport:
        return CheckReport(assignment, tuple(failed))

    monkeypatch.setattr(import_module("autograder.cli.check"), "run_checks", checked)
    assert "52;c" in run("check", "02_nodes", str(tmp_path))


def test_similar_escapes_control_characters_in_names(tmp_path: Path) -> None:
    names = [f"{name}\x1b[2A\u202e\n{name}" for name in ("alice", "bob")]
    for name in names:
        (tmp_path / "class" / name / "src").mkdir(parents=True)
        text = "\n".join(f"def f{n}(a, b):\n    return [a * {n} + b, a]  # \u202e" for n in range(20))
        (tmp_path / "class" / name / "src" / "node.py").write_text(text)
    output = run("similar", str(tmp_path / "class"), "--assignment", "02_nodes", "--out", str(tmp_path / "out"))
    assert r"alice\x1b[2A\u202e\nalice and bob" in output
    expect_harmless((tmp_path / "out" / "index.html").read_text(encoding="utf-8"), MARKS)


def test_errors_escape_control_characters_in_file_names(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for error in (UsageError(HOSTILE), RuntimeError(HOSTILE)):

        def fail(*_: object, error: Exception = error, **__: object) -> None:
            raise error

        monkeypatch.setattr(cli.group, "main", fail)
        with pytest.raises(SystemExit):
            cli.main(["doctor"])
        output = capfd.readouterr().err
        assert r"\x1b]52" in output
        expect_harmless(output)
    monkeypatch.undo()
    assert "no such option" in run("grade", "--no\x1b[2A\u202e").lower()
    assert "does not exist" in run("export", ".", "--format", "canvas", "--out", "x", "--roster", "no\x1b[2A\u202e")


def test_a_name_with_line_breaks_makes_one_row() -> None:
    output = table([("a\nb  100/100", "1", "x\ny")], ("submission", "marks", "why"))
    assert [line.split("  ")[0] for line in output.splitlines()] == ["submission", output.splitlines()[1], r"a\nb"]


def test_names_of_people_are_unchanged() -> None:
    for name in ("José Núñez", "山田\u3000太郎", "Ægir 🙂", "محمد"):
        assert visible(name, line=True) == name


def test_all_output_of_a_verb_goes_through_one_function() -> None:
    for path in sorted((ROOT / "autograder" / "cli").glob("*.py")):
        if path.name in ("terminal.py", "ros.py"):  # ros prints lines for a shell, of the machine's own paths
            continue
        calls = [ast.unparse(node.func) for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
        assert not {"click.echo", "click.secho", "print", "sys.stdout.write", "sys.stderr.write"} & set(calls), path
