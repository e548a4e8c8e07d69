"""The player of a run in a real browser: it plays, shows any instant, obeys keys, and a link leads to an instant."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from sim import Command, Recording, RobotSpec, Simulation, load_world, run
from sim.export import to_html
from sim.view import Margin
from sim.view.player import page as page_of

pytestmark = pytest.mark.browser

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120_000.0  # milliseconds: a deadline, not an expectation
MAX_BYTES = 300_000

COUNT_FRAMES = """seconds => new Promise(resolve => {
    let frames = 0;
    const begin = performance.now();
    const count = now => {
        frames += 1;
        if (now - begin < 1000 * seconds) requestAnimationFrame(count); else resolve(1000 * frames / (now - begin));
    };
    requestAnimationFrame(count);
})"""


def drive(world: str, seconds: float) -> Recording:
    simulation = Simulation(load_world(ROOT / "assets" / "worlds" / f"{world}.yaml"), (RobotSpec(radius=0.18),))
    return run(simulation, lambda state, scans: Command(0.4, 0.2), seconds)


@pytest.fixture
def complaints(page: Page) -> list[str]:
    heard: list[str] = []
    page.on("pageerror", lambda error: heard.append(str(error)))
    page.on("console", lambda message: heard.append(message.text))
    page.on("requestfailed", lambda request: heard.append(request.url))
    return heard


@pytest.fixture
def opened(page: Page, complaints: list[str], tmp_path: Path) -> Path:
    """The page of a run of two seconds, open."""
    path = to_html(drive("moving_obstacle", 2.0), tmp_path / "run.html")
    page.goto(path.as_uri())
    return path


def drawn(page: Page) -> str:
    """What the canvas shows."""
    return str(page.locator(".run-player canvas").evaluate("canvas => canvas.toDataURL()"))


def test_the_player_plays_to_the_end_of_the_run_and_stops(
    page: Page, opened: Path, complaints: list[str], screenshots: Path
) -> None:
    clock = page.locator(".run-player output")
    expect(clock).to_have_text("0.00 s")
    before = drawn(page)
    page.get_by_role("button", name="Play").click()
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(clock).to_have_text("2.00 s", timeout=PATIENCE)
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert drawn(page) != before
    page.screenshot(path=screenshots / "run-page.png")
    assert complaints == []


@pytest.mark.promise("Press Play, drag the time line, or use the space bar and the arrow keys.")
def test_the_slider_and_the_keys_show_any_instant(page: Page, opened: Path, complaints: list[str]) -> None:
    clock, first = page.locator(".run-player output"), drawn(page)
    page.get_by_label("Time in seconds").fill("1.5")
    expect(clock).to_have_text("1.50 s")
    expect(page.locator(".run-said")).to_contain_text("moves +0.40 m/s, +0.20 rad/s · commanded +0.40 m/s, +0.20 rad/s")
    assert drawn(page) != first
    for key, time in (("ArrowLeft", "1.40"), ("Shift+ArrowLeft", "0.40"), ("End", "2.00"), ("Home", "0.00")):
        page.keyboard.press(key)
        expect(clock).to_have_text(f"{time} s")
    page.get_by_role("img", name="Track of robot").focus()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert complaints == []


def test_a_link_with_an_instant_opens_the_run_at_that_instant(page: Page, opened: Path, complaints: list[str]) -> None:
    page.goto("about:blank")
    page.goto(f"{opened.as_uri()}#t=1.3")
    expect(page.locator(".run-player output")).to_have_text("1.30 s")
    page.get_by_label("Time in seconds").fill("0.7")
    link = page.get_by_role("link", name="Link to this instant")
    expect(link).to_have_attribute("href", "#t=0.70")
    page.get_by_label("Time in seconds").fill("0")
    page.evaluate("location.hash = 't=0.70'")
    expect(page.locator(".run-player output")).to_have_text("0.70 s")
    assert complaints == []


def test_the_player_is_dark_if_the_browser_prefers_dark(page: Page, opened: Path) -> None:
    def background() -> str:
        return str(page.evaluate("getComputedStyle(document.body).backgroundColor"))

    page.emulate_media(color_scheme="light")
    assert background() == "rgb(255, 255, 255)"
    light = drawn(page)
    page.emulate_media(color_scheme="dark")
    assert background() == "rgb(17, 22, 27)"
    page.wait_for_function("light => document.querySelector('canvas').toDataURL() !== light", arg=light)


def test_a_broken_rule_shows_its_instant_and_a_click_jumps_to_it(
    page: Page, complaints: list[str], tmp_path: Path, screenshots: Path
) -> None:
    recording = drive("lab", 60.0)
    gaps, times = recording.clearances[:, 0], recording.times
    broken = float(times[int(recording.collided[:, 0].argmax())])
    path = tmp_path / "run.html"
    path.write_text(page_of(recording, [Margin("the gap in m", times.tolist(), (gaps - 0.01).tolist(), broken)]))
    size = path.stat().st_size
    assert size <= MAX_BYTES
    page.goto(path.as_uri())
    page.get_by_role("button", name=f"broken at t = {broken:.1f} s").click()
    expect(page.locator(".run-player output")).to_have_text(f"{broken:.2f} s")
    expect(page.locator(".run-hit")).to_contain_text("met")
    row = int((times <= broken + 1e-6).sum()) - 1
    expect(page.locator(".run-margin")).to_contain_text(f"{abs(gaps[row] - 0.01):.2f}")
    page.locator(".run-margin svg").click(position={"x": 0, "y": 30})
    expect(page.locator(".run-player output")).to_have_text("0.00 s")
    page.screenshot(path=screenshots / "run-page-rule.png")
    page.get_by_role("button", name="Play").click()
    print(f"a minute: {size} bytes, {page.evaluate(COUNT_FRAMES, 2.0):.0f} frames/s")
    assert complaints == []


def test_lines_of_programs_are_shown_as_text_with_their_instants(
    page: Page, complaints: list[str], tmp_path: Path, screenshots: Path
) -> None:
    attack = "<script>document.title = 'owned'</script><img src=x onerror=\"document.title='owned'\">"
    flood = tuple((0.5 + number / 1000, f"[INFO] [loop]: {number}") for number in range(1000))
    recording = replace(drive("lab", 3.0), said=((0.3, attack), *flood, (2.0, "the last one")))
    page.goto(to_html(recording, tmp_path / "run.html").as_uri())
    lines, clock = page.locator(".run-log li"), page.locator(".run-player output")
    expect(lines).to_have_count(1002)
    expect(lines.first).to_have_text(f"0.3 s{attack}")
    expect(page.locator(".run-log [aria-current]")).to_have_count(0)
    lines.first.click()
    expect(clock).to_have_text("0.30 s")
    expect(page.locator(".run-log [aria-current]")).to_have_text(f"0.3 s{attack}")
    page.locator(".run-log").scroll_into_view_if_needed()
    page.keyboard.press("End")
    expect(page.locator(".run-log [aria-current]")).to_have_text("2.0 sthe last one")
    expect(lines.last).to_be_in_viewport()
    for key, time in (("Shift+L", "2.00"), ("Shift+L", "1.50"), ("Home", "0.00"), ("l", "0.30")):
        page.keyboard.press(key)
        expect(clock).to_have_text(f"{time} s")
    page.screenshot(path=screenshots / "run-page-log.png", full_page=True)
    assert page.title() == "the lab: 3.0 s"
    assert complaints == []
