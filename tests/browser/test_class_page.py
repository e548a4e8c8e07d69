"""The table of a class's page sorts and filters in a browser, and is a list of cards on a phone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from autograder.report import feedback
from autograder.result.model import CheckResult, Result
from autograder.suite import Check, Outcome
from tests.browser.looks import PHONE, Screenshots, check_accessibility

pytestmark = pytest.mark.browser


@pytest.fixture
def class_page(
    make_result: Callable[..., Result],
    make_check: Callable[..., Check],
    broken_result: Result,
    ungraded_result: Result,
    tmp_path: Path,
) -> Path:
    """The page of five submissions, with 40, 0, no, 85 and 95 per cent."""
    check = make_check("moves", "It moves.", 20.0, "graph")

    def moves(student: str, fraction: float) -> Result:
        checks = (CheckResult.of(check, Outcome.FAILED, f"{student} stood still", fraction=fraction),)
        return make_result(student, checks=checks, max_score=20.0)

    results = [make_result(), broken_result, ungraded_result, moves("Zoë Müller", 0.85), moves("dave", 0.95)]
    for result in results:
        feedback.write(result, tmp_path / result.student)
    return feedback.write_summary(results, tmp_path)


@pytest.fixture
def table(page: Page, class_page: Path) -> Locator:
    """The table, on the open page."""
    page.goto(class_page.as_uri())
    return page.get_by_role("region", name="Submissions").get_by_role("table")


def names(table: Locator) -> list[str]:
    """Return the students of the visible rows, from top to bottom."""
    return table.get_by_role("rowheader").all_inner_texts()


@pytest.mark.promise("sorts by name and by score")
def test_the_table_sorts_by_a_click_on_a_header(page: Page, table: Locator) -> None:
    assert names(table) == ["alice", "bob", "carol", "dave", "Zoë Müller"]
    by_score = ["carol", "bob", "alice", "Zoë Müller", "dave"]  # students without a mark come first
    for direction, order in (("ascending", by_score), ("descending", by_score[::-1])):
        table.get_by_role("button", name="Score").click()
        assert names(table) == order
        expect(table.get_by_role("columnheader", name="Score")).to_have_attribute("aria-sort", direction)
    expect(table.get_by_role("columnheader", name="Submission")).not_to_have_attribute("aria-sort", "ascending")
    table.get_by_role("button", name="Submission").press("Enter")
    assert names(table)[0] == "alice"


@pytest.mark.promise("its filter shows the students who failed a check")
def test_the_table_keeps_its_filter_after_visiting_a_page(page: Page, table: Locator) -> None:
    page.get_by_label("Find").fill("muller still")
    assert names(table) == ["Zoë Müller"]
    expect(page.get_by_role("status")).to_have_text("1 of 5")
    page.get_by_label("Find").fill("")
    for choice, students in (
        ("Not graded (1)", ["carol"]),
        ("Less than half (2)", ["alice", "bob"]),
        ("It moves. (2)", ["dave", "Zoë Müller"]),
    ):
        page.get_by_label("Show").select_option(choice)
        assert names(table) == students
    table.get_by_role("button", name="Submission").click()
    page.get_by_role("link", name="dave").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("dave")
    page.go_back()
    assert names(table) == ["Zoë Müller", "dave"]


def test_a_class_of_a_hundred_is_a_list_of_cards_on_a_phone(
    page: Page, make_result: Callable[..., Result], tmp_path: Path, screenshots: Screenshots
) -> None:
    page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
    results = [make_result(f"van-der-meer_{number}_assignsubmission") for number in range(100)]
    page.goto(feedback.write_summary(results, tmp_path).as_uri())
    heights = page.locator("table.class tbody tr").evaluate_all("rows => rows.map(row => row.offsetHeight)")
    assert len(heights) == 100
    assert max(heights) < 100
    narrow = "cells => cells.filter(cell => cell.offsetWidth < 200).length"
    assert page.locator("table.class th[scope=row], td.why").evaluate_all(narrow) == 0
    assert page.evaluate("document.documentElement.scrollHeight") < 10_000
    page.get_by_label("Sort").select_option("Names from Z")
    assert names(page.get_by_role("table").first)[0] == "van-der-meer_99_assignsubmission"
    screenshots(page, "class-of-a-hundred")
    check_accessibility(page)


def test_without_javascript_the_table_is_complete_and_has_no_controls(chromium: Browser, class_page: Path) -> None:
    context = chromium.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(class_page.as_uri())
    assert names(page.get_by_role("region", name="Submissions")) == ["alice", "bob", "carol", "Zoë Müller", "dave"]
    expect(page.get_by_label("Find")).to_be_hidden()
    expect(page.get_by_role("button")).to_have_count(0)
    context.close()
