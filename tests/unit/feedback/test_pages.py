"""Feedback pages: their contents, and the escaping of all text."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.report import feedback
from autograder.report.feedback.text import NOT_GRADED
from autograder.result.model import Artifact, Build, CheckResult, Result, from_json
from autograder.ros.distribution import DISTRIBUTION
from autograder.run.exchanges import Exchange
from autograder.suite import Check, Outcome
from autograder.suite.contract import contract

MakeResult = Callable[..., Result]


class Page(HTMLParser):
    """A parsed page: its text, tags and attributes."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.pieces: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))
        self.text = re.sub(r"\s+", " ", " ".join(self.pieces))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]

    def handle_data(self, data: str) -> None:
        if self.tags[-1:] != ["style"]:
            self.pieces.append(data)

    def all(self, attribute: str) -> list[str]:
        return [value for name, value in self.attributes if name == attribute]


def test_the_page_shows_the_score_each_check_and_the_reason(make_result: MakeResult, tmp_path: Path) -> None:
    page = Page(feedback.write(make_result(), tmp_path))
    assert "4 of 10 points, 40 %" in page.text
    for words in ("Graph 3 / 3", "Reaction 1 / 4", "it kept driving: 0.08 m from the north wall", "1 / 4"):
        assert words in page.text
    assert page.all("aria-label") == ["passed", "passed", "failed", "not checked", "failed"]


@pytest.mark.promise("runs in real time, and the result says so.")
def test_only_a_result_with_a_program_in_real_time_has_the_note_on_real_time(
    make_result: MakeResult, tmp_path: Path
) -> None:
    note = "robot_controller ran in real time, because it uses rclpy in threads of its own."
    page = Page(feedback.write(make_result(time="real", time_note=note), tmp_path))
    assert note in page.text
    assert "The machine was too busy" not in page.text
    page = Page(feedback.write(make_result(time="real", time_note=note, held_up=0.62), tmp_path))
    assert f"{note} The machine was too busy to run it for up to 0.6 s, in both attempts" in page.text
    assert "real time" not in Page(feedback.write(make_result(), tmp_path)).text


def test_the_page_suggests_starting_with_the_failed_check_that_costs_most(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    cheap, costly = (make_check(id, f"It is {id}.", points, "graph") for id, points in (("cheap", 1.0), ("dear", 4.0)))
    failed = tuple(CheckResult.of(check, Outcome.FAILED, fraction=0.25) for check in (cheap, costly))
    page = Page(feedback.write(make_result(checks=failed), tmp_path))
    assert "Start here It is dear." in page.text


def test_the_page_links_the_check_to_start_with(make_result: MakeResult, tmp_path: Path) -> None:
    page = Page(feedback.write(make_result(), tmp_path))
    assert "Start here The robot turns when something" in page.text
    assert "#check-turns" in page.all("href")
    assert "check-turns" in page.all("id")


def test_consequences_are_folded_under_their_cause_and_named_once_in_their_own_group(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    cause = make_check("first", "It drives.", 1.0, "graph")
    in_same_group = make_check("same", "It turns.", 2.0, "graph", after=("first",), hints=("Look.",), covers=("stale",))
    in_other_group = make_check("other", "It stops.", 3.0, "safety", after=("first",))
    unchecked = make_check("blind", "It sees.", 4.0, "safety", needs=("other",))
    checks = (
        CheckResult.of(cause, Outcome.FAILED, "it stood"),
        CheckResult.of(in_same_group, Outcome.FAILED, "it turned right"),
        CheckResult.of(in_other_group, Outcome.FAILED, "it went on"),
        CheckResult.of(unchecked, Outcome.NOT_CHECKED, 'not checked: first "It stops." has to pass'),
    )
    page = Page(feedback.write(make_result(checks=checks), tmp_path))
    assert page.all("aria-label") == ["failed", "failed", "failed", "not checked"]
    heading = "These also failed. Fix the one above first, then run again:"
    folded = f"It drives. 0 / 1 it stood {heading} 2 It turns. 0 / 2 it turned"
    assert folded in page.text
    assert "Not checked: It sees. Safety 0 / 7 2 checks did not pass with It drives. (7 points)" in page.text
    assert "has to pass" not in page.text
    assert page.all("href").count("#check-first") == 2  # to start with, and from the other group
    assert page.tags.count("details") == 2  # what failed as well, and a hint in it


def test_many_checks_that_could_not_run_are_a_line_that_unfolds(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    cause = make_check("first", "It starts.", 1.0, "graph")
    dependents = [make_check(f"c{number}", f"It does {number}.", 1.0, "graph", needs=("first",)) for number in range(9)]
    checks = (
        CheckResult.of(cause, Outcome.FAILED),
        *(CheckResult.of(check, Outcome.NOT_CHECKED) for check in dependents),
    )
    page = Page(feedback.write(make_result(checks=checks), tmp_path))
    assert page.all("aria-label") == ["failed", "not checked"]
    assert "Not checked: 9 more checks. It does 0. It does 1." in page.text
    assert page.tags.count("details") == 1


@pytest.mark.promise("The second hint says more than the first.")
def test_hints_are_folded_one_inside_the_other_and_the_page_to_read_is_linked(
    make_result: MakeResult, tmp_path: Path
) -> None:
    path = feedback.write(make_result(), tmp_path)
    html, page = path.read_text(encoding="utf-8"), Page(path)
    assert re.search(r"<details[^>]*><summary>Hint</summary>.*<details[^>]*><summary>Second hint</summary>", html, re.S)
    assert "open" not in page.all("class")
    assert f"{DISTRIBUTION.docs}/p/sensor_msgs/" in page.all("href")


@pytest.mark.promise("Feedback quotes them.", "which requirement in the notebook it did not meet")
def test_a_failed_check_quotes_its_sentence_of_the_contract(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    stops = make_check("stops", "It stops.", 1, "graph", covers=("stale", "no-such-sentence"))
    page = Page(feedback.write(make_result(checks=(CheckResult.of(stops, Outcome.FAILED, "it drove"),)), tmp_path))
    assert f"Requirement: {contract('02_nodes')['stale'].text}" in page.text
    passed = make_result(checks=(CheckResult.of(stops, Outcome.PASSED),))
    crash = Diagnosis(Kind.CRASHED_LATER, "It crashed.")
    crashed = make_result(checks=(CheckResult.of(stops, Outcome.FAILED, "It crashed."),), diagnosis=crash)
    for result in (passed, crashed):
        assert "Requirement:" not in Page(feedback.write(result, tmp_path)).text


def test_a_sentence_of_the_contract_is_quoted_once_for_failures_with_one_cause(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    cause = make_check("first", "It stops.", 1, "graph", covers=("stale",))
    consequences = [make_check(id, "It turns.", 1, "graph", covers=("stale", "near"), after=("first",)) for id in "ab"]
    checks = tuple(CheckResult.of(check, Outcome.FAILED, "it drove") for check in (cause, *consequences))
    text = Page(feedback.write(make_result(checks=checks), tmp_path)).text
    assert [text.count(f"Requirement: {contract('02_nodes')[name].text}") for name in ("stale", "near")] == [1, 1]


def test_a_link_that_is_not_a_web_address_is_not_followed(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    check = make_check("bad", "A check.", 1, "graph", doc="javascript:alert(1)")
    result = make_result(checks=(CheckResult.of(check, Outcome.FAILED, "why"),))
    assert "javascript:alert(1)" not in feedback.write(result, tmp_path).read_text(encoding="utf-8")


def test_the_picture_is_part_of_the_page(
    make_result: MakeResult, track: Callable[..., Artifact], tmp_path: Path
) -> None:
    page = Page(feedback.write(make_result(artifacts=(track(tmp_path),)), tmp_path))
    sources = page.all("src")
    data = base64.b64encode((tmp_path / "turns.png").read_bytes()).decode()
    assert sources == [f"data:image/png;base64,{data}"]
    assert page.all("alt") == ["The robot's track: it touches the north wall at t = 12.4 s."]


def test_a_picture_without_a_check_is_also_shown(
    make_result: MakeResult, track: Callable[..., Artifact], tmp_path: Path
) -> None:
    page = Page(feedback.write(make_result(artifacts=(track(tmp_path, check=""),)), tmp_path))
    assert page.tags.count("img") == 1


def test_a_missing_picture_is_reported_as_missing(make_result: MakeResult, tmp_path: Path) -> None:
    artifact = Artifact("lost.png", "track", "0" * 64, "turns", "The robot's track.")
    page = Page(feedback.write(make_result(artifacts=(artifact,)), tmp_path))
    assert "img" not in page.tags
    assert "The robot's track. (The picture is not available.)" in page.text


def test_an_artifact_that_is_not_a_picture_is_ignored(make_result: MakeResult, tmp_path: Path) -> None:
    (tmp_path / "turns.json").write_text("{}")
    record = Artifact("turns.json", "recording", "0" * 64, "turns", "the recording")
    assert "the recording" not in Page(feedback.write(make_result(artifacts=(record,)), tmp_path)).text


def test_an_artifact_outside_the_folder_is_refused(make_result: MakeResult, tmp_path: Path) -> None:
    secret = Artifact("../secret.png", "track", "0" * 64, "turns", "")
    with pytest.raises(UsageError, match=r"'\.\./secret\.png' is outside the result's folder"):
        feedback.write(make_result(artifacts=(secret,)), tmp_path)


def test_the_same_reason_for_several_checks_is_shown_once(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    reasons = ("first A has to pass", "first A has to pass", "first B has to pass")
    checks = tuple(
        CheckResult.of(make_check(f"c{index}", f"Check {index}.", 1, "graph"), Outcome.NOT_CHECKED, reason)
        for index, reason in enumerate(reasons)
    )
    text = Page(feedback.write(make_result(checks=checks), tmp_path)).text
    assert text.count("first A has to pass") == 1
    assert text.index("Check 0.") < text.index("first A") < text.index("Check 1.") < text.index("first B")


def test_a_failed_build_shows_its_log_and_the_diagnosis_on_top(broken_result: Result, tmp_path: Path) -> None:
    page = Page(feedback.write(broken_result, tmp_path))
    assert "Failed <<< my_robot_package" in page.text
    assert "SyntaxError: oops" in page.text
    assert page.text.index("does not build: setup.py line 3") < page.text.index("Graph")
    assert "Start here" not in page.text


def test_an_ungraded_result_shows_no_score_and_says_that_it_is_not_a_zero(
    ungraded_result: Result, tmp_path: Path
) -> None:
    page = Page(feedback.write(ungraded_result, tmp_path))
    assert "Not graded" in page.text
    assert NOT_GRADED in page.text
    assert "points" not in page.text
    assert "works" not in page.text


def test_full_marks_are_stated_in_a_sentence(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    check = make_check("a", "It works.", 10, "graph")
    result = make_result(checks=(CheckResult.of(check, Outcome.PASSED),))
    page = Page(feedback.write(result, tmp_path))
    assert "10 of 10 points, 100 %" in page.text
    assert "Everything that was checked works." in page.text


ATTACK = "</pre><script>alert(1)</script><img src=x onerror=alert(1)>\"'{{7*7}}"


def test_no_text_of_a_student_becomes_markup(
    make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path
) -> None:
    check = make_check("c", ATTACK, 1, ATTACK, hints=(ATTACK, ATTACK))
    hostile = make_result(
        ATTACK.replace("/", ""),
        checks=(CheckResult.of(check, Outcome.FAILED, ATTACK),),
        diagnosis=Diagnosis(Kind.CRASHED_LATER, ATTACK, ATTACK),
        build=Build(False, 1.0, (ATTACK,), ATTACK),
        artifacts=(Artifact("x.png", "track", "", "c", ATTACK),),
    )
    (tmp_path / "x.png").write_bytes(b"\x89PNG")
    for path, scripts in ((feedback.write(hostile, tmp_path), 0), (feedback.write_summary([hostile], tmp_path), 1)):
        page = Page(path)
        assert page.tags.count("script") == scripts  # the table's own
        assert "onerror" not in [name for name, _ in page.attributes]
        assert set(page.all("src")) <= {"data:image/png;base64,iVBORw=="}
        assert "{{7*7}}" in page.text


def test_control_characters_and_lone_surrogates_do_not_reach_the_page(make_result: MakeResult, tmp_path: Path) -> None:
    text_with_controls = "\x1b[31mred\x1b[0m \x00 \udcff \u202eevil"
    result = make_result(diagnosis=Diagnosis(Kind.CRASHED_LATER, "It crashed.", text_with_controls))
    text = Page(feedback.write(result, tmp_path)).text
    assert "red \ufffd \ufffd \ufffdevil" in text


@pytest.mark.promise("`feedback.html` is one file that opens in any browser.")
def test_a_page_loads_nothing_from_the_network(
    make_result: MakeResult, track: Callable[..., Artifact], tmp_path: Path
) -> None:
    page = Page(feedback.write(make_result(artifacts=(track(tmp_path),)), tmp_path))
    assert all(source.startswith("data:") for source in page.all("src"))
    assert "default-src 'none'" in " ".join(page.all("content"))
    assert [href for href in page.all("href") if "://" in href] == [f"{DISTRIBUTION.docs}/p/sensor_msgs/"]


@pytest.mark.promise("give every student a feedback page")
def test_the_table_links_each_page_and_shows_totals(
    make_result: MakeResult, broken_result: Result, ungraded_result: Result, tmp_path: Path
) -> None:
    alice = make_result()
    feedback.write(alice, tmp_path / "alice")
    page = Page(feedback.write_summary([alice, broken_result, ungraded_result], tmp_path))
    assert [link for link in page.all("href") if link.endswith("feedback.html")] == ["alice/feedback.html"]
    for words in (
        "3 submissions",
        "Mean 20 %. Not graded: 1.",
        "alice 4 / 10 40 % it kept driving",
        "bob 0 / 10 0 % The package does not build",
        f"carol not graded {NOT_GRADED}",
    ):
        assert words in page.text
    assert page.text.index("The robot stops when") < page.text.index("0 of 1")


def test_the_table_of_no_submissions_is_still_a_page(tmp_path: Path) -> None:
    assert "0 submissions" in Page(feedback.write_summary([], tmp_path)).text


def test_a_student_whose_name_is_a_path_gets_no_link(make_result: MakeResult, tmp_path: Path) -> None:
    (tmp_path / "feedback.html").write_text("other")
    (tmp_path / "class").mkdir()
    page = Page(feedback.write_summary([make_result("..")], tmp_path / "class"))
    assert [link for link in page.all("href") if "feedback" in link] == []


def test_requests_to_a_node_and_its_responses_are_shown_as_text_in_a_table(
    make_result: MakeResult, tmp_path: Path
) -> None:
    attack = "message: '</td><script>alert(1)</script>\u202e'"
    exchanges = (Exchange(1.25, "asked", "/<b>/enable", "data: True"), Exchange(1.3, "answered", "/enable", attack))
    result = make_result()
    result = replace(result, checks=(replace(result.checks[0], talk=exchanges), *result.checks[1:]))
    page = Page(feedback.write(from_json(result.to_json()), tmp_path))
    assert "1.25 asked /<b>/enable data: True" in page.text
    assert "1.30 answered /enable message: '</td><script>alert(1)</script>\ufffd'" in page.text
    assert not {"script", "b"} & set(page.tags)
    assert page.tags.count("table") == 1
