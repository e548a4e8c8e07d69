"""How a page looks to its readers: on a desktop and on a phone, in light and in dark."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

DESKTOP, PHONE = (1280, 800), (390, 844)  # width and height of the window, in pixels
PATIENCE = 120_000.0  # milliseconds: a deadline, not an expectation
SCHEMES: tuple[Literal["light"], Literal["dark"]] = ("light", "dark")
RULES = {"runOnly": {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]}}
# A canvas is drawn again in the frame after a change.
DRAWN = "() => new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(drawn)))"


def looks(page: Page) -> Iterator[str]:
    """Show an open page in each of the four looks and yield its name, such as "390-dark". Then restore the page."""
    for frame in page.frames:
        expect(frame.locator(".run-player:not(.run-ready)")).to_have_count(0, timeout=PATIENCE)
    size_before = page.viewport_size
    assert size_before is not None
    for width, height in (DESKTOP, PHONE):
        page.set_viewport_size({"width": width, "height": height})
        for scheme in SCHEMES:
            page.emulate_media(color_scheme=scheme)
            page.evaluate(DRAWN)
            yield f"{width}-{scheme}"
    page.set_viewport_size(size_before)
    page.emulate_media(color_scheme="null")


def check_accessibility(page: Page) -> None:
    """Fail if axe-core finds a violation of WCAG 2.1, level AA, in any look of the page."""
    for look in looks(page):
        report = Axe().run(page, options=RULES)
        assert report.violations_count == 0, f"{look}: {report.generate_report()}"


@dataclass(frozen=True)
class Screenshots:
    """Takes the screenshots of a page, which people inspect, and fails if the page is wider than its window.

    Attributes:
        folder: the folder of the screenshots.
    """

    folder: Path

    def __call__(self, page: Page, name: str, *, full_page: bool = False) -> None:
        """Take a screenshot of each look, such as `NAME-390-dark.png`, of the window or of the full page."""
        for look in looks(page):
            assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), f"{name}-{look}"
            page.screenshot(path=self.folder / f"{name}-{look}.png", full_page=full_page, animations="disabled")
