"""The feedback page of a student, opened in a real browser."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from autograder.report import feedback
from autograder.report.export import write
from autograder.result.artifacts import Artifacts
from autograder.result.model import Artifact, CheckResult, Result
from autograder.suite import Check, Outcome
from tests.browser.looks import Screenshots, check_accessibility
from tests.browser.wall_run import save_run

pytestmark = pytest.mark.browser


@pytest.fixture
def browser_messages(page: Page) -> list[str]:
    """The browser's errors, warnings and failed requests while the page is open."""
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("requestfailed", lambda request: messages.append(request.url))
    return messages


@pytest.fixture
def flawed_page(make_result: Callable[..., Result], track: Callable[..., Artifact], tmp_path: Path) -> Path:
    """The feedback page of a flawed submission with a picture."""
    return feedback.write(make_result(artifacts=(track(tmp_path),)), tmp_path)


def test_the_track_is_shown_and_hints_unfold(
    page: Page, flawed_page: Path, browser_messages: list[str], screenshots: Screenshots
) -> None:
    page.goto(flawed_page.as_uri())
    expect(page.get_by_role("heading", level=1)).to_have_text("alice")
    picture = page.get_by_role("img", name="The robot's track: it touches the north wall at t = 12.4 s.")
    expect(picture).to_be_visible()
    assert picture.evaluate("image => image.naturalWidth") > 0

    first, second = page.get_by_text("Where is 0 rad in a scan?"), page.get_by_text("Compare the smallest forward")
    expect(first).to_be_hidden()
    page.get_by_text("Hint", exact=True).click()
    expect(first).to_be_visible()
    expect(second).to_be_hidden()
    page.get_by_text("Second hint", exact=True).click()
    expect(second).to_be_visible()

    screenshots(page, "feedback", full_page=True)
    assert browser_messages == []


def test_consequences_unfold_below_their_cause(
    page: Page,
    make_result: Callable[..., Result],
    make_check: Callable[..., Check],
    tmp_path: Path,
    browser_messages: list[str],
    screenshots: Screenshots,
) -> None:
    first = make_check("first", "It drives where the way is clear.", 1.0, "graph")
    consequences = [
        make_check(f"also_{n}", f"It does another thing, number {n}.", 2.0, "graph", after=("first",)) for n in range(3)
    ]
    blind = make_check("blind", "It stands still where it is blind.", 3.0, "safety", needs=("first",))
    checks = (
        *(CheckResult.of(check, Outcome.FAILED, "it stood still at 0.0 m/s") for check in (first, *consequences)),
        CheckResult.of(blind, Outcome.NOT_CHECKED, "not checked"),
    )
    page.goto(feedback.write(make_result(checks=checks), tmp_path).as_uri())
    also = page.get_by_text("It does another thing, number 2.")
    expect(also).to_be_hidden()
    expect(page.get_by_text("Not checked: It stands still where it is blind.")).to_be_visible()
    screenshots(page, "feedback-folded", full_page=True)
    page.get_by_text("These also failed. Fix the one above first, then run again: 3").click()
    expect(also).to_be_visible()
    page.get_by_text("1 check did not pass with").get_by_role("link").click()
    expect(page.locator("#check-first")).to_be_in_viewport()
    screenshots(page, "feedback-unfolded", full_page=True)
    assert browser_messages == []


@pytest.mark.promise(
    "you can play its run and jump to the moment at which it broke a rule",
    "a failed check includes a recording of the run",
    "with its track and the moment at which it failed",
    "in the same player",
)
def test_the_run_of_a_failed_check_plays(
    page: Page,
    make_result: Callable[..., Result],
    tmp_path: Path,
    browser_messages: list[str],
    screenshots: Screenshots,
) -> None:
    artifacts = Artifacts(tmp_path)
    for check in ("starts", "turns"):
        save_run(artifacts, check)
    path = feedback.write(make_result(artifacts=tuple(artifacts.saved)), tmp_path)
    page.goto(f"{path.as_uri()}#t=2.5")
    player = page.locator("#run-turns-track")
    expect(player.locator("output")).to_have_text("2.50 s")  # of the failed check, not of the one that passed
    player.get_by_role("button", name="broken at").click()
    expect(player.locator(".run-hit")).to_contain_text("met")
    expect(player.locator("canvas")).to_be_visible()
    expect(player.get_by_role("img", name="The run of turns.")).to_have_count(1)
    page.goto(f"{path.as_uri()}#run=run-starts-track&t=1.0")
    expect(page.locator("#run-starts-track output")).to_have_text("1.00 s")
    expect(page.locator("#run-starts-track canvas")).to_be_visible()  # the link has opened its details
    screenshots(page, "feedback-run", full_page=True)
    page.emulate_media(media="print")
    expect(player.locator("img")).to_be_visible()
    expect(player.locator("canvas")).to_be_hidden()
    assert browser_messages == []


def test_the_page_fits_a_phone(page: Page, flawed_page: Path, browser_messages: list[str]) -> None:
    page.set_viewport_size({"width": 360, "height": 740})
    page.goto(flawed_page.as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert browser_messages == []


def test_the_page_is_dark_if_the_browser_prefers_dark(
    page: Page, flawed_page: Path, browser_messages: list[str]
) -> None:
    page.goto(flawed_page.as_uri())
    colour = "getComputedStyle(document.body).backgroundColor"
    light = page.evaluate(colour)
    page.emulate_media(color_scheme="dark")
    assert page.evaluate(colour) != light
    assert browser_messages == []


def test_a_script_from_the_student_does_not_run(
    page: Page, make_result: Callable[..., Result], tmp_path: Path, browser_messages: list[str]
) -> None:
    attack = "<script>document.title = 'owned'</script><img src=x onerror=\"document.title='owned'\">"
    page.goto(feedback.write(make_result(attack), tmp_path).as_uri())
    expect(page.get_by_role("heading", level=1)).to_have_text(attack)
    assert "owned" not in page.title().replace(attack, "")
    assert browser_messages == []


def test_the_class_table_links_to_each_page(
    page: Page,
    make_result: Callable[..., Result],
    broken_result: Result,
    ungraded_result: Result,
    track: Callable[..., Artifact],
    tmp_path: Path,
    browser_messages: list[str],
    screenshots: Screenshots,
) -> None:
    results = [make_result("anna é%?#", artifacts=(track(tmp_path / "anna é%?#"),)), broken_result, ungraded_result]
    for result in results:
        feedback.write(result, tmp_path / result.student)
    page.goto(feedback.write_summary(results, tmp_path).as_uri())
    screenshots(page, "class", full_page=True)
    for result in results:
        page.get_by_role("link", name=result.student).click()
        expect(page.get_by_role("heading", level=1)).to_have_text(result.student)
        screenshots(page, f"feedback-{result.status.value}-{len(result.checks)}", full_page=True)
        page.go_back()
    assert browser_messages == []


def test_axe_finds_no_violation_in_the_page_of_other_answers(
    page: Page,
    make_result: Callable[..., Result],
    tmp_path: Path,
    browser_messages: list[str],
    screenshots: Screenshots,
) -> None:
    checks = tuple(replace(check, points=check.max_points) for check in make_result().checks)
    out = write([make_result(checks=checks)], "other_answers", tmp_path)
    page.goto((out / "alice" / "other_answers.html").as_uri())
    page.locator("summary").first.click()
    expect(page.locator("pre").first).to_be_visible()
    screenshots(page, "other-answers", full_page=True)
    check_accessibility(page)
    assert browser_messages == []
