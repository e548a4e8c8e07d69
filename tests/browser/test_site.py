"""The site builds without warnings, and its pages are accessible on a phone, in dark mode and by keyboard."""

from __future__ import annotations

import re
import runpy
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote, urlsplit

import nbformat
import pytest
from playwright.sync_api import Browser, Page, expect

from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import chapters
from autograder.author.verification.mutants import mutants, write_mutant
from autograder.course_paths import ROOT
from autograder.diagnosis import Kind
from autograder.grade import DEFAULT_SEED
from autograder.grade.batch import grade_all
from autograder.report import feedback
from autograder.result.model import CheckResult
from autograder.suite import Outcome, suites
from tests.browser.looks import Screenshots, check_accessibility

pytestmark = [pytest.mark.browser, pytest.mark.timeout(900)]

ASSIGNMENT = "02_nodes"
STUDENTS = "amal bao chloe dario elif femi greta hugo ines jonas kaya lars mina noor omar pia quentin rosa sami tuva"
BUILD_SITE = runpy.run_path(str(ROOT / "docs" / "build_site.py"))
# A test whose id contains a chapter's name runs on another worker, which would build the site again.
CHAPTER = pytest.param(f"chapters/{ASSIGNMENT}", id="a chapter")
GUIDES = ("students", "instructors", "authors", "first_check", "first_launch_check", "simulator", "trust")
PAGES = ("index", *GUIDES, "glossary", CHAPTER, "api/sim")
LONG_PAGE = "api/autograder"  # made like api/sim, but axe takes three times as long
LINK = re.compile(r'<(?:a|img|iframe|link|script)[^>]+(?:href|src)="([^"]+)"')

SIZE = """address => new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve([image.naturalWidth, image.naturalHeight]);
    image.onerror = reject;
    image.src = address;
})"""


@pytest.fixture(scope="module")
def graded_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A class's folder: a graded robot with a flaw, and other students whose failures are those of recorded mutants."""
    folder, answer = (tmp_path_factory.mktemp(name) for name in ("graded", "answer"))
    flaws = {mutant.id: mutant for mutant in mutants(ASSIGNMENT)}
    write_mutant(flaws["brakes_too_late"], suites.hidden(ASSIGNMENT).sources, answer)
    (alice,) = grade_all({"alice": answer}, ASSIGNMENT, seed=DEFAULT_SEED, out=folder, jobs=1)
    others = [frozenset(), *(mutant.fails for mutant in flaws.values() if mutant.diagnosis is Kind.OK)]
    results = [alice]
    for name, fails in zip(STUDENTS.split(), others, strict=False):
        outcomes = {
            check: Outcome.FAILED if check.id in fails else Outcome.PASSED for check in suites.hidden(ASSIGNMENT).checks
        }
        checks = tuple(CheckResult.of(check, outcome) for check, outcome in outcomes.items())
        results.append(replace(alice, student=name, checks=checks, artifacts=()))
    for result in results:
        feedback.write(result, folder / result.student)
    feedback.write_summary(results, folder)
    return folder


@pytest.fixture(scope="module")
def pictures(chromium: Browser, graded_folder: Path) -> Path:
    """The screenshots of the instructors' guide: a page of feedback, a run in it, and the page of a class."""
    page = chromium.new_page(viewport={"width": 1100, "height": 800})
    folder = graded_folder / "screenshots"
    for name, path in (("class", "index.html"), ("alice", "alice/feedback.html")):
        page.goto((graded_folder / path).as_uri())
        page.screenshot(path=folder / f"{name}.png")
    page.goto(f"{page.url}#run=run-room-track&t=0")  # a link to a run unfolds it
    room = page.locator("#check-room")
    room.get_by_role("button", name="broken at").click()
    expect(room.locator("output")).not_to_have_text("0.00 s")
    room.screenshot(path=folder / "run.png")
    page.close()
    return folder


@pytest.fixture(scope="module")
def site(pictures: Path) -> Path:
    """The folder of the built site."""
    assert BUILD_SITE["build"](pictures).stderr == ""
    return Path(BUILD_SITE["HTML"])


@pytest.mark.parametrize("name", [*PAGES, pytest.param(LONG_PAGE, marks=pytest.mark.nightly)])
def test_axe_finds_no_violation_on_a_page_of_the_site(
    site: Path, page: Page, name: str, screenshots: Screenshots
) -> None:
    page.goto((site / f"{name}.html").as_uri())
    screenshots(page, f"site-{name.replace('/', '-')}")
    check_accessibility(page)


@pytest.mark.parametrize("name", ["alice/feedback.html", "index.html"])
def test_axe_finds_no_violation_in_feedback(
    pictures: Path, graded_folder: Path, page: Page, name: str, screenshots: Screenshots
) -> None:
    page.goto((graded_folder / name).as_uri())
    screenshots(page, f"graded-{name.replace('/', '-').removesuffix('.html')}", full_page=True)
    check_accessibility(page)


@pytest.mark.parametrize("name", [*PAGES, LONG_PAGE])
def test_a_page_fits_a_phone(site: Path, page: Page, name: str) -> None:
    page.set_viewport_size({"width": 360, "height": 740})
    page.goto((site / f"{name}.html").as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= 360


@pytest.mark.promise("Press Play, drag the time line, or use the space bar and the arrow keys.")
def test_the_run_on_the_start_page_plays_by_keyboard(site: Path, page: Page) -> None:
    page.goto((site / "index.html").as_uri())
    run = page.frame_locator("iframe")
    play, clock = run.get_by_role("button", name="Play"), run.locator("output").first
    expect(clock).to_have_text("40.00 s")
    play.focus()
    page.keyboard.press("Enter")
    expect(run.get_by_role("button", name="Pause")).to_be_visible()
    expect(clock).not_to_have_text("40.00 s")


def test_a_chapter_has_its_number_and_its_notebook_to_download(site: Path, page: Page) -> None:
    page.goto((site / "chapters" / f"{ASSIGNMENT}.html").as_uri())
    expect(page.get_by_role("heading", level=1)).to_contain_text("2. From a node to a robot")
    expect(page.get_by_role("link", name="9. What can you do now?")).to_be_visible()
    link = page.get_by_role("link", name="Download the notebook")
    expect(link).to_have_attribute("download", "")
    downloaded = Path(unquote(urlsplit(link.evaluate("link => link.href")).path))
    assert downloaded.name == f"{ASSIGNMENT}.ipynb"
    (chapter,) = chapters((ASSIGNMENT,))
    released = in_form(chapter.read(), Form.RELEASED)
    assert nbformat.read(downloaded, as_version=4).cells == released.cells


def test_a_button_copies_commands_without_their_prompts(site: Path, page: Page) -> None:
    page.goto((site / "students.html").as_uri())
    button = page.locator(".highlight-console button").first
    button.focus()
    page.keyboard.press("Enter")
    field = page.get_by_placeholder("Search")
    field.focus()
    page.keyboard.press("Control+V")
    expect(field).to_have_value(re.compile("^make "))


def test_a_page_has_an_icon_a_summary_and_a_picture_for_links_to_it(site: Path, page: Page) -> None:
    page.goto((site / "index.html").as_uri())
    for meta, text in (("og:description", "A ROS 2 course"), ("og:image:alt", "lidar"), ("og:image", "preview.png")):
        expect(page.locator(f'meta[property="{meta}"]')).to_have_attribute("content", re.compile(text))
    icon = page.locator('link[rel~="icon"]').evaluate("link => link.href")
    for address, size in ((icon, [64, 64]), ((site / "preview.png").as_uri(), [1200, 630])):
        assert page.evaluate(SIZE, address) == size


@pytest.mark.parametrize("name", ["sim", "autograder"])
def test_a_page_of_the_api_begins_with_a_guide_and_has_no_fields_for_types(site: Path, page: Page, name: str) -> None:
    page.goto((site / "api" / f"{name}.html").as_uri())
    guide = page.locator("section > section").first
    expect(guide.locator(".highlight-python").first).to_be_visible()
    expect(guide.locator("dl.py")).to_have_count(0)
    assert page.locator("dt", has_text=re.compile("^Type")).all_inner_texts() == []


def test_each_glossary_term_is_linked_at_most_once_in_a_chapter(site: Path) -> None:
    for chapter in chapters():  # not parametrized, for the reason at CHAPTER
        text = (site / "chapters" / f"{chapter.assignment}.html").read_text(encoding="utf-8")
        terms = re.findall(r'href="\.\./glossary\.html#(term-[^"]+)"', text)
        assert len(terms) >= 5, chapter.assignment
        assert len(terms) == len(set(terms)), chapter.assignment


@pytest.mark.promise(
    "`make docs` writes this page from",
    "`make docs` builds the site: guides, chapters with their outputs, and the simulator's API reference.",
)
def test_each_internal_link_of_the_site_has_a_target(site: Path) -> None:
    """Sphinx checks links between pages, but not those in raw HTML and in notebooks' outputs."""
    for path in site.rglob("*.html"):
        for link in LINK.findall(path.read_text(encoding="utf-8")):
            target = urlsplit(link)
            if not target.scheme and target.path:
                assert (path.parent / unquote(target.path)).exists(), f"{path.relative_to(site)} links to {link}"
