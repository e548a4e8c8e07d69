"""The live view as a student uses it: JupyterLab in a real browser, a notebook's cells, the buttons."""

from __future__ import annotations

from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Locator, Page, expect

from sim.view import LIGHT
from tests.browser.canvas import KEEP_TIMES, count, missing
from tests.browser.jupyter import PATIENCE, Lab, lab
from tests.browser.looks import DRAWN, RULES, Screenshots, looks

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


TWO = """
from sim import Command, RobotSpec, Simulation, load_world
from sim.view import live
world = load_world({world!r})
view = live(Simulation(world, (RobotSpec("ann"), RobotSpec("bob"))), theme={theme!r}, play=False)
view
"""


def picture(canvas: Locator) -> str:
    """Return the picture on a canvas, as a data URL, after the page has drawn what it received."""
    canvas.page.evaluate(DRAWN)
    return str(canvas.evaluate("canvas => canvas.toDataURL()"))


def wait_until_moved(canvas: Locator, before: str) -> None:
    """Wait until the picture on a canvas differs from `before`."""
    canvas.page.wait_for_function(
        "([canvas, before]) => canvas.toDataURL() !== before",
        arg=[canvas.element_handle(), before],
        timeout=PATIENCE * 1000,
    )


def open_view(page: Page, lab: Lab, name: str, cells: list[str]) -> Locator:
    """Run the cells of a notebook, of which one shows a live view; return the view."""
    lab.open(page, name, cells)
    view = page.locator(".run-player.run-ready")
    expect(view.locator("canvas").first).to_be_visible(timeout=PATIENCE * 1000)
    view.locator("canvas").first.scroll_into_view_if_needed()
    return view


@pytest.fixture
def two_robots(page: Page, lab: Lab, request: pytest.FixtureRequest) -> Locator:
    """A paused live view of two robots without a callback, in a kernel of its own. The notebook has the focus."""
    world = str(ROOT / "assets/worlds/lab.yaml")
    view = open_view(page, lab, f"{request.node.name}.ipynb", [TWO.format(world=world, theme="light")])
    page.locator(".jp-Cell .jp-InputPrompt").first.click()  # command mode, in which the notebook has keys of its own
    view.locator("canvas").first.scroll_into_view_if_needed()
    return view


def test_the_robot_moves_pauses_and_follows_the_pad(page: Page, lab: Lab, screenshots: Screenshots) -> None:
    view = open_view(page, lab, "drive.ipynb", [DRIVE.format(world=str(ROOT / "assets/worlds/lab.yaml"))])
    canvas, clock = view.locator("canvas").first, view.locator("output").first
    wait_until_moved(canvas, picture(canvas))
    expect(view.get_by_text("your code drives")).to_be_visible()
    page.screenshot(path=screenshots.folder / "live-view-playing.png")

    view.get_by_role("button", name="Pause").click()
    expect(view.get_by_role("button", name="Play")).to_be_visible(timeout=PATIENCE * 1000)
    paused = picture(canvas)
    assert picture(canvas) == paused

    view.get_by_role("button", name="Forward").click()
    expect(view.get_by_text("+0.22 m/s +0.00 rad/s").first).to_be_visible(timeout=PATIENCE * 1000)
    for _ in range(5):
        view.get_by_role("button", name="Step by 0.1 s").click()
    wait_until_moved(canvas, paused)
    page.screenshot(path=screenshots.folder / "live-view-pad.png")

    view.get_by_role("button", name="Reset to the start").click()
    expect(clock).to_have_text("0.00 s", timeout=PATIENCE * 1000)
    start = picture(canvas)
    view.get_by_role("button", name="Play").click()
    wait_until_moved(canvas, start)
    view.get_by_label("Time in seconds").fill("0")
    expect(clock).to_have_text("0.00 s", timeout=PATIENCE * 1000)
    expect(view.get_by_role("button", name="Play")).to_be_visible()


def test_keys_play_and_drive_while_the_mouse_is_over_the_view(page: Page, two_robots: Locator) -> None:
    clock, lines = two_robots.locator("output").first, two_robots.locator(".run-said p")
    cells = page.locator(".jp-Notebook .jp-Cell").count()
    two_robots.locator("canvas").first.hover()
    page.keyboard.press("Space")
    expect(two_robots.get_by_role("button", name="Pause")).to_be_visible(timeout=PATIENCE * 1000)
    for key, motion in (
        ("ArrowUp", "moves +0.22 m/s, +0.00 rad/s"),
        ("ArrowLeft", "moves +0.00 m/s, +0.90 rad/s"),
        ("ArrowRight", "moves +0.00 m/s, \u22120.90 rad/s"),
        ("ArrowDown", "moves \u22120.22 m/s, +0.00 rad/s"),
        ("s", "moves +0.00 m/s, +0.00 rad/s"),
    ):
        page.keyboard.press(key)
        expect(lines.first).to_contain_text(motion, timeout=PATIENCE * 1000)
    page.keyboard.press("Space")
    expect(two_robots.get_by_role("button", name="Play")).to_be_visible(timeout=PATIENCE * 1000)
    time = float(clock.inner_text().removesuffix(" s"))
    page.keyboard.press(".")
    expect(clock).to_have_text(f"{time + 0.1:.2f} s", timeout=PATIENCE * 1000)
    expect(page.locator(".jp-Notebook .jp-Cell")).to_have_count(cells)


def test_keys_belong_to_the_notebook_while_the_mouse_is_elsewhere(page: Page, two_robots: Locator) -> None:
    driver, editor = two_robots.locator(".run-driver"), page.locator(".cm-content").first
    page.locator(".jp-Cell .jp-InputPrompt").first.hover()
    page.keyboard.press("b")  # adds a cell below
    expect(page.locator(".jp-Notebook .jp-Cell")).to_have_count(2)
    page.keyboard.press("ArrowUp")
    editor.click()
    two_robots.locator("canvas").first.hover()
    page.keyboard.press("Home")
    page.keyboard.type("f s ")
    expect(editor).to_contain_text("f s ")
    expect(two_robots.get_by_role("button", name="Follow")).to_have_attribute("aria-pressed", "false")
    expect(driver).to_have_text("ann: drive with the arrows")


def test_the_view_zooms_and_moves_by_key_wheel_and_drag(page: Page, two_robots: Locator) -> None:
    canvas = two_robots.locator("canvas").first
    whole = picture(canvas)
    canvas.hover()
    page.keyboard.press("+")
    zoomed = picture(canvas)
    assert zoomed != whole
    box = canvas.bounding_box()
    assert box is not None
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2 + 60, box["y"] + box["height"] / 2 + 40)
    page.mouse.up()
    assert picture(canvas) not in (whole, zoomed)
    page.keyboard.press("0")
    assert picture(canvas) == whole
    page.keyboard.down("Control")
    page.mouse.wheel(0, -200)
    page.keyboard.up("Control")
    wait_until_moved(canvas, whole)
    page.keyboard.press("-")
    page.keyboard.press("-")
    page.keyboard.press("-")
    assert picture(canvas) == whole
    two_robots.get_by_role("button", name="Zoom in").click()
    assert picture(canvas) == zoomed


def test_the_view_follows_a_robot_while_it_drives(page: Page, two_robots: Locator, screenshots: Screenshots) -> None:
    canvas, scan = two_robots.locator("canvas").all()
    canvas.hover()
    whole, of_ann = picture(canvas), picture(scan)
    page.keyboard.press("f")
    expect(two_robots.get_by_role("button", name="Follow: ann")).to_have_attribute("aria-pressed", "true")
    assert picture(canvas) != whole
    assert count(canvas, LIGHT.robot)[0] > 50
    page.keyboard.press("ArrowUp")
    for _ in range(20):
        page.keyboard.press(".")
    expect(two_robots.locator("output").first).to_have_text("2.00 s", timeout=PATIENCE * 1000)
    assert count(canvas, LIGHT.robot)[0] > 50
    screenshots(page, "live-view-follow")
    canvas.hover()  # the page has scrolled
    page.keyboard.press("f")
    expect(two_robots.get_by_role("button", name="Follow: bob")).to_be_visible()
    assert picture(scan) != of_ann
    assert count(canvas, LIGHT.other_colours[0])[0] > 50
    page.keyboard.press("f")
    expect(two_robots.get_by_role("button", name="Follow")).to_have_attribute("aria-pressed", "false")


def test_two_robots_are_named(two_robots: Locator) -> None:
    lines = two_robots.locator(".run-said p")
    expect(lines).to_have_count(2)
    expect(lines.first).to_contain_text("ann: moves")
    expect(lines.last).to_contain_text("bob: moves")
    expect(two_robots.locator(".run-driver")).to_have_text("ann: drive with the arrows")
    expect(two_robots.get_by_role("img", name="The scan of ann in its own frame, with x up")).to_be_visible()


def test_the_view_can_be_zoomed_while_the_kernel_is_busy(page: Page, lab: Lab) -> None:
    drive = DRIVE.format(world=str(ROOT / "assets/worlds/lab.yaml"))
    wait = "from pathlib import Path\nimport time\nwhile not Path('go').exists():\n    time.sleep(0.05)"
    view = open_view(page, lab, "busy.ipynb", [drive, wait])
    canvas, clock = view.locator("canvas").first, view.locator("output").first
    whole, time = picture(canvas), clock.inner_text()
    canvas.hover()
    page.keyboard.press("+")
    assert picture(canvas) != whole
    page.keyboard.press("0")
    assert picture(canvas) == whole
    assert clock.inner_text() == time
    (lab.folder / "go").touch()
    wait_until_moved(canvas, whole)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_view_has_no_empty_band_and_axe_finds_no_violation(
    page: Page, lab: Lab, screenshots: Screenshots, theme: str
) -> None:
    world = str(ROOT / "assets/worlds/moving_obstacle.yaml")
    view = open_view(page, lab, f"{theme}.ipynb", [TWO.format(world=world, theme=theme)])
    background = {"light": "rgb(255, 255, 255)", "dark": "rgb(17, 22, 27)"}[theme]
    expect(view).to_have_css("background-color", background)
    for look in looks(page):
        view.scroll_into_view_if_needed()
        above = max(bottom(canvas) for canvas in view.locator("canvas").all())
        row = view.get_by_role("button", name="Play").bounding_box()
        assert row is not None
        assert 0 < row["y"] - above < 30, look
        assert 0 < bottom(view) - bottom(view.locator("details")) < 30, look
        report = Axe().run(page, context=".run-player", options=RULES)
        assert report.violations_count == 0, f"{look}: {report.generate_report()}"
        view.screenshot(path=screenshots.folder / f"live-view-{theme}-{look}.png")


def bottom(part: Locator) -> float:
    """Return the lower edge of a part of the page, in pixels."""
    box = part.bounding_box()
    assert box is not None
    return box["y"] + box["height"]


def test_an_error_of_the_callback_is_shown_in_the_cell(page: Page, lab: Lab, screenshots: Screenshots) -> None:
    first = DRIVE.format(world=str(ROOT / "assets/worlds/empty_room.yaml")).replace("\nview\n", "\nview.pause()\n")
    view = open_view(page, lab, "break.ipynb", [first, BREAK])
    error = view.get_by_role("alert")
    expect(error).to_contain_text("ZeroDivisionError: float division by zero", timeout=PATIENCE * 1000)
    expect(error).to_contain_text("in broken")
    expect(view.get_by_role("button", name="Play")).to_be_visible()
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
