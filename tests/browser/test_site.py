"""The site: it builds without a warning, and its pages can be read on a phone, in the dark, by keyboard and aloud."""

from __future__ import annotations

import re
import runpy
from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect

from autograder.author.course.sync import chapters
from autograder.layout import ROOT
from autograder.report import feedback
from autograder.result.artifacts import Gallery
from autograder.result.model import Artifact, Result
from tests.browser.wall_run import keep_run

pytestmark = pytest.mark.browser

MADE = runpy.run_path(str(ROOT / "docs" / "build_site.py"))
CHAPTER = pytest.param("chapters/02_nodes", id="a chapter")  # tests that name one would be built for on another worker
READ = ("index", "students", "instructors", "trust", "glossary", CHAPTER, "api/sim")
RULES = {"runOnly": {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]}}
LINK = re.compile(r'<(?:a|img|iframe|link|script)[^>]+(?:href|src)="([^"]+)"')


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the results of the pictures lie."""
    return tmp_path_factory.mktemp("graded")


@pytest.fixture(scope="module")
def pictures(
    chromium: Browser,
    graded: Path,
    make_result: Callable[..., Result],
    broken_result: Result,
    track: Callable[..., Artifact],
) -> Path:
    """The pictures of the instructors' guide: a page of feedback, a run in it, and the page of a class."""
    alice = make_result(artifacts=(track(graded / "alice"),))
    gallery = Gallery(graded / "carol")
    keep_run(gallery, "turns")
    carol = make_result("carol", artifacts=tuple(gallery.artifacts))
    results = [alice, broken_result, carol]
    shots = {result.student: feedback.write(result, graded / result.student) for result in results}
    shots["class"] = feedback.write_summary(results, graded)
    page = chromium.new_page(viewport={"width": 1100, "height": 800})
    for name in ("alice", "class", "carol"):
        page.goto(f"{shots[name].as_uri()}#t=2.5")
        if name == "carol":
            page.locator("canvas").scroll_into_view_if_needed()
            expect(page.locator("canvas")).to_be_in_viewport()
        page.screenshot(path=graded / "screenshots" / f"{name}.png")
    page.close()
    return graded / "screenshots"


@pytest.fixture(scope="module")
def site(pictures: Path) -> Path:
    """The folder of the built site."""
    assert MADE["build"](pictures).stderr == ""
    return Path(MADE["HTML"])


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", READ)
def test_axe_finds_nothing_wrong_with_a_page_of_the_site(
    site: Path, page: Page, name: str, scheme: str, screenshots: Path
) -> None:
    page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
    page.goto((site / f"{name}.html").as_uri())
    page.screenshot(path=screenshots / f"site-{name.replace('/', '-')}-{scheme}.png")
    found = Axe().run(page, options=RULES)
    assert found.violations_count == 0, found.generate_report()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", ["alice/feedback.html", "carol/feedback.html", "index.html"])
def test_axe_finds_nothing_wrong_with_feedback(
    pictures: Path, graded: Path, page: Page, name: str, scheme: str
) -> None:
    page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
    page.goto((graded / name).as_uri())
    found = Axe().run(page, options=RULES)
    assert found.violations_count == 0, found.generate_report()


@pytest.mark.parametrize("name", READ)
def test_a_page_fits_a_phone(site: Path, page: Page, name: str) -> None:
    page.set_viewport_size({"width": 360, "height": 740})
    page.goto((site / f"{name}.html").as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= 360


@pytest.mark.promise("Press Play, drag the time line, or use the space bar and the arrow keys.")
def test_the_run_on_the_start_page_plays_by_keyboard(site: Path, page: Page) -> None:
    page.goto((site / "index.html").as_uri())
    run = page.frame_locator("iframe")
    play = run.get_by_role("button", name="Play")
    play.focus()
    page.keyboard.press("Enter")
    expect(run.get_by_role("button", name="Pause")).to_be_visible()
    expect(run.locator("output").first).not_to_have_text("0.00 s")


def test_each_glossary_term_is_linked_at_most_once_in_a_chapter(site: Path) -> None:
    for chapter in chapters():  # no parameter: see CHAPTER
        text = (site / "chapters" / f"{chapter.assignment}.html").read_text(encoding="utf-8")
        words = re.findall(r'href="\.\./glossary\.html#(term-[^"]+)"', text)
        assert len(words) >= 5, chapter.assignment
        assert len(words) == len(set(words)), chapter.assignment


@pytest.mark.promise(
    "`make docs` writes this page from",
    "`make docs` builds the site: guides, chapters with their outputs, and the simulator's API reference.",
)
def test_each_internal_link_of_the_site_has_a_target(site: Path) -> None:
    """Sphinx checks links from page to page. It does not check those of raw HTML and of notebook outputs."""
    for path in site.rglob("*.html"):
        for link in LINK.findall(path.read_text(encoding="utf-8")):
            target = urlsplit(link)
            if not target.scheme and target.path:
                assert (path.parent / unquote(target.path)).exists(), f"{path.relative_to(site)} links to {link}"
