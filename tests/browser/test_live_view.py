"""The live view as a student uses it: JupyterLab in a real browser, a notebook's cells, the buttons."""

from __future__ import annotations

import io
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.browser.canvas import KEEP_TIMES, missing
from tests.browser.jupyter import PATIENCE, Lab, lab
from tests.browser.looks import DRAWN, Screenshots

__all__ = ["lab"]

pytestmark = pytest.mark.browser

ROOT = Path(__file__).resolve().parents[2]

DRIVE = """
from pathlib import Path
from sim import Command, RobotSpec, Simulation, load_world
from sim.view import live
world = load_world({world!r})
def drive(scan):
    return Command(linear=0.3, angular=0.4)
view = live(Simulation(world), drive)
view
"""

BREAK = """
def broken(scan):
    return Command(linear=1.0 / 0.0)
live(world, broken)
"""


REPLAY = """
from autograder.notebook.driving import DriveReport
from sim import run
room = Simulation(world, (RobotSpec(radius=0.18),))
recording = run(room, lambda state, scans: Command(linear=0.3, angular=0.5), 5.0)
DriveReport(recording, "", ())
"""


def pixels(image: Locator) -> Any:
    """Return the part of the live image that shows the world, without the clock above it, as (H, W, 3) numbers."""
    picture = np.asarray(Image.open(io.BytesIO(image.screenshot())).convert("RGB"), dtype=np.int16)
    height, width, _ = picture.shape
    return picture[int(0.1 * height) :, : int(0.62 * width)]


def changed_pixels(before: Any, after: Any) -> int:
    """Return how many pixels have clearly changed."""
    return int((np.abs(before - after).max(axis=2) > 60).sum())


def wait_until_moved(image: Locator, before: Any, least: int = 40) -> int:
    """Wait until the world's picture differs from `before`; return the number of changed pixels."""
    deadline, difference = time.monotonic() + PATIENCE, 0
    while time.monotonic() < deadline:
        difference = changed_pixels(before, pixels(image))
        if difference >= least:
            return difference
    pytest.fail(f"the picture did not change: {difference} pixels")


def wait_until_still(page: Page, image: Locator) -> None:
    """Wait until the image has been the same five times in succession."""
    page.wait_for_function(
        """image => {
            image.looks = image.src === image.last ? (image.looks || 0) + 1 : 0;
            image.last = image.src;
            return image.looks >= 5;
        }""",
        arg=image.element_handle(),
        polling=200,
        timeout=PATIENCE * 1000,
    )


def test_the_robot_moves_pauses_and_follows_the_pad(page: Page, lab: Lab, screenshots: Screenshots) -> None:
    lab.open(page, "drive.ipynb", [DRIVE.format(world=str(ROOT / "assets/worlds/lab.yaml"))])
    image = page.locator(".jp-OutputArea-output img").first
    expect(image).to_be_visible(timeout=PATIENCE * 1000)
    wait_until_moved(image, pixels(image))
    page.screenshot(path=screenshots.folder / "live-view-playing.png")

    page.get_by_title("Pause", exact=True).click()
    expect(page.get_by_title("Play", exact=True)).to_be_visible(timeout=PATIENCE * 1000)
    wait_until_still(page, image)
    paused = pixels(image)
    assert changed_pixels(paused, pixels(image)) == 0

    page.get_by_title("Forward", exact=True).click()
    expect(page.get_by_text("+0.22 m/s +0.00 rad/s")).to_be_visible(timeout=PATIENCE * 1000)
    for _ in range(5):
        page.get_by_title("One step of 0.1 s").click()
    wait_until_moved(image, paused, least=10)
    page.screenshot(path=screenshots.folder / "live-view-pad.png")

    page.get_by_title("Back to the start").click()
    wait_until_moved(image, paused)
    wait_until_still(page, image)
    start = pixels(image)
    page.get_by_title("Play", exact=True).click()
    wait_until_moved(image, start)


def test_an_error_of_the_callback_is_shown_in_the_cell(page: Page, lab: Lab, screenshots: Screenshots) -> None:
    first = DRIVE.format(world=str(ROOT / "assets/worlds/empty_room.yaml")).replace("\nview\n", "\nview.pause()\n")
    lab.open(page, "break.ipynb", [first, BREAK])
    error = page.get_by_text("ZeroDivisionError: float division by zero").first
    expect(error).to_be_visible(timeout=PATIENCE * 1000)
    expect(page.get_by_text("in broken")).to_be_visible()
    expect(page.get_by_title("Play", exact=True)).to_be_visible()
    page.screenshot(path=screenshots.folder / "live-view-error.png")


def test_a_drive_plays_in_the_notebook_which_gets_none_of_its_keys(
    page: Page, lab: Lab, screenshots: Screenshots
) -> None:
    first = DRIVE.format(world=str(ROOT / "assets/worlds/smile.yaml")).replace("\nview\n", "\nview.pause()\n")
    lab.open(page, "replay.ipynb", [first, REPLAY])
    player = page.locator(".run-player")
    canvas, clock = player.locator("canvas"), player.locator("output")
    expect(canvas).to_be_visible(timeout=PATIENCE * 1000)
    expect(player.locator("img")).to_be_hidden()
    expect(clock).to_have_text("5.00 s")
    assert missing(canvas) == []
    canvas.scroll_into_view_if_needed()
    page.screenshot(path=screenshots.folder / "drive-in-notebook.png")
    page.locator(".jp-Cell .jp-InputPrompt").first.click()  # command mode, in which b adds a cell
    canvas.hover()
    cells = page.locator(".jp-Notebook .jp-Cell").count()
    for key, seconds in (("ArrowLeft", "4.90"), ("b", "4.90"), ("Home", "0.00")):
        page.keyboard.press(key)
        expect(clock).to_have_text(f"{seconds} s")
    player.get_by_label("Time in seconds").fill("2")
    page.keyboard.press("b")
    assert page.locator(".jp-Notebook .jp-Cell").count() == cells
    player.get_by_role("button", name="Play").click()
    expect(clock).to_have_text("5.00 s", timeout=PATIENCE * 1000)
    page.screenshot(path=screenshots.folder / "replay-in-notebook.png")


def test_a_drive_plays_once_by_itself_and_rests_at_its_end(page: Page, lab: Lab, screenshots: Screenshots) -> None:
    page.emulate_media(reduced_motion="no-preference")
    page.add_init_script(KEEP_TIMES)
    world = str(ROOT / "assets/worlds/smile.yaml")
    first = f"from sim import Command, RobotSpec, Simulation, load_world\nworld = load_world({world!r})"
    lab.open(page, "autoplay.ipynb", [first, REPLAY, *["print()"] * 40])
    player = page.locator(".run-player")
    canvas, play = player.locator("canvas"), player.get_by_role("button", name="Play")
    expect(canvas).to_be_visible(timeout=PATIENCE * 1000)
    canvas.scroll_into_view_if_needed()
    page.wait_for_function("times.length > 2 && times.at(-1) === '5.00 s'", timeout=PATIENCE * 1000)
    expect(play).to_be_visible()
    times = page.evaluate("times")
    assert times[:2] == ["5.00 s", "0.00 s"]
    assert missing(canvas) == []
    page.screenshot(path=screenshots.folder / "autoplay-in-notebook.png")
    page.locator(".jp-Cell").last.scroll_into_view_if_needed()
    expect(canvas).not_to_be_in_viewport()
    canvas.scroll_into_view_if_needed()
    expect(canvas).to_be_in_viewport()
    page.evaluate(DRAWN)
    expect(play).to_be_visible()
    assert page.evaluate("times") == times


def test_a_static_picture_is_shown_in_the_notebook_with_its_alternative_text(
    page: Page, lab: Lab, screenshots: Screenshots
) -> None:
    world = str(ROOT / "assets/worlds/maze.yaml")
    lab.open(
        page, "show.ipynb", [f"from sim import load_world\nfrom sim.view import show\nshow(load_world({world!r}))"]
    )
    picture = page.get_by_alt_text("Map of the world “maze”", exact=False)
    expect(picture).to_be_visible(timeout=PATIENCE * 1000)
    assert picture.evaluate("image => image.naturalWidth") > 500
    page.screenshot(path=screenshots.folder / "show-world.png")
