"""An exported run, opened from a disk: it stands still, plays when asked, and can be searched through."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from sim import Command, Simulation, load_world, run
from sim.export import to_html

pytestmark = pytest.mark.browser

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120_000.0  # milliseconds: a deadline, not an expectation


@pytest.fixture
def opened(page: Page, tmp_path: Path) -> list[str]:
    """The page of a run of two seconds, open; what the browser complained about."""
    world = load_world(ROOT / "assets" / "worlds" / "moving_obstacle.yaml")
    recording = run(Simulation(world), lambda state, scans: Command(0.4, 0.2), 2.0)
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda message: complaints.append(message.text))
    page.on("requestfailed", lambda request: complaints.append(request.url))
    page.goto(to_html(recording, tmp_path / "run.html").as_uri())
    return complaints


def test_it_plays_to_its_end_and_stops(page: Page, opened: list[str], screenshots: Path) -> None:
    body = page.locator("path.body")
    before = body.get_attribute("d")
    expect(page.locator("#clock")).to_have_text("0.00 s")
    page.get_by_role("button", name="Play").click()
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(page.locator("#clock")).to_have_text("2.00 s", timeout=PATIENCE)
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert body.get_attribute("d") != before
    page.screenshot(path=screenshots / "run-page.png")
    assert opened == []


def test_the_slider_shows_any_instant(page: Page, opened: list[str]) -> None:
    mover = page.locator("circle.mover").first
    first = mover.get_attribute("cy")
    page.get_by_label("Time in seconds").fill("1.5")
    expect(page.locator("#clock")).to_have_text("1.50 s")
    assert mover.get_attribute("cy") != first
    assert page.locator("path.hits").get_attribute("d")
    assert opened == []


def test_it_is_dark_where_the_reader_likes_it_dark(page: Page, opened: list[str]) -> None:
    def background() -> str:
        return str(page.evaluate("getComputedStyle(document.body).backgroundColor"))

    page.emulate_media(color_scheme="light")
    assert background() == "rgb(255, 255, 255)"
    page.emulate_media(color_scheme="dark")
    assert background() == "rgb(17, 22, 27)"
