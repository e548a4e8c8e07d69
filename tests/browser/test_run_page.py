"""The player of a run in a browser draws, plays, zooms and reacts to keys, and a link leads to an instant."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from sim import Command, Recording, RobotSpec, Simulation, load_world, run
from sim.export import to_html
from sim.view import LIGHT, Margin, Player
from sim.view.player import page as page_of
from tests.browser.canvas import KEEP_TIMES, LATE, count, missing
from tests.browser.looks import Screenshots, check_accessibility

pytestmark = pytest.mark.browser

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120_000.0  # milliseconds: a deadline, not an expectation
MAX_BYTES = 300_000
STORED = re.compile(r'<script type="application/json">(.*?)</script>', re.DOTALL)
AHEAD, ROUND = Command(0.4, 0.2), Command(0.3, 0.5)

COUNT_FRAMES = """seconds => new Promise(resolve => {
    let frames = 0;
    const start = performance.now();
    const count = now => {
        frames += 1;
        if (now - start < 1000 * seconds) requestAnimationFrame(count); else resolve(1000 * frames / (now - start));
    };
    requestAnimationFrame(count);
})"""


def drive(world: str, seconds: float, command: Command = AHEAD) -> Recording:
    simulation = Simulation(load_world(ROOT / "assets" / "worlds" / f"{world}.yaml"), (RobotSpec(radius=0.18),))
    return run(simulation, lambda state, scans: command, seconds)


@pytest.fixture
def browser_messages(page: Page) -> list[str]:
    messages: list[str] = []
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("console", lambda message: messages.append(message.text))
    page.on("requestfailed", lambda request: messages.append(request.url))
    return messages


@pytest.fixture
def run_page(page: Page, browser_messages: list[str], tmp_path: Path) -> Path:
    """The open page of a run of two seconds."""
    path = to_html(drive("moving_obstacle", 2.0), tmp_path / "run.html")
    page.goto(path.as_uri())
    expect(page.locator(".run-player.run-ready")).to_be_visible(timeout=PATIENCE)
    return path


def canvas_picture(page: Page) -> str:
    """Return the picture on the canvas, as a data URL."""
    return str(page.locator(".run-player canvas").evaluate("canvas => canvas.toDataURL()"))


@pytest.mark.parametrize("width", [1280, 390])
def test_a_run_opens_at_its_end_with_everything_that_its_picture_shows(
    page: Page, browser_messages: list[str], tmp_path: Path, width: int
) -> None:
    page.set_viewport_size({"width": width, "height": 800})
    page.goto(to_html(drive("smile", 6.0, ROUND), tmp_path / "run.html").as_uri())
    expect(page.locator(".run-player output")).to_have_text("6.00 s", timeout=PATIENCE)
    canvas = page.locator(".run-player canvas")
    assert missing(canvas) == []
    expect(page.locator(".run-title")).to_contain_text("Smile")
    expect(page.locator(".run-title")).to_contain_text("never nearer than")
    page.keyboard.press("Home")
    late, robot = count(canvas, LATE, LIGHT.robot)
    assert late < 5  # the future path is thin, in the robot's colour
    assert robot > 5
    assert browser_messages == []


def test_a_run_of_an_earlier_version_is_drawn(page: Page, browser_messages: list[str], tmp_path: Path) -> None:
    text = page_of(drive("lab", 6.0))
    (stored,) = STORED.findall(text)
    data = json.loads(stored)
    for name in ("title", "summary", "moment"):
        del data[name]
    for name in ("inside", "routes"):
        del data["world"][name]
    data["collisions"] = [event[:4] for event in data["collisions"]]
    path = tmp_path / "run.html"
    path.write_text(text.replace(stored, json.dumps(data)), encoding="utf-8")
    page.goto(path.as_uri())
    expect(page.locator(".run-hit")).to_contain_text("met", timeout=PATIENCE)
    expect(page.locator(".run-title")).to_have_text("the lab")
    assert missing(page.locator(".run-player canvas")) in ([], ["the start of the track"])  # which is short
    assert browser_messages == []


def test_a_run_is_a_picture_without_javascript(chromium: Browser, tmp_path: Path) -> None:
    context = chromium.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(to_html(drive("smile", 3.0), tmp_path / "run.html").as_uri())
    picture = page.get_by_alt_text("Track of robot through “smile”", exact=False)
    expect(picture).to_be_visible()
    assert picture.bounding_box()["width"] > 300  # type: ignore[index]
    context.close()


def test_the_player_plays_to_the_end_of_the_run_and_stops(
    page: Page, run_page: Path, browser_messages: list[str]
) -> None:
    clock = page.locator(".run-player output")
    page.keyboard.press("Home")
    expect(clock).to_have_text("0.00 s")
    before = canvas_picture(page)
    page.get_by_role("button", name="Play").click()
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(clock).to_have_text("2.00 s", timeout=PATIENCE)
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert canvas_picture(page) != before
    assert browser_messages == []


@pytest.mark.parametrize("broken", [False, True])
def test_a_run_plays_once_when_it_becomes_visible_unless_it_broke_a_rule(
    page: Page, browser_messages: list[str], tmp_path: Path, broken: bool
) -> None:
    margins = [Margin("the gap in m", (0.0, 2.0), (1.0, -1.0), 1.0)] if broken else []
    player = Player(drive("smile", 2.0), margins=margins, play=True)
    page.emulate_media(reduced_motion="no-preference")
    page.add_init_script(KEEP_TIMES)
    path = tmp_path / "run.html"
    path.write_text(f'<meta charset="utf-8">{player._repr_mimebundle_()[0]["text/html"]}', encoding="utf-8")
    page.goto(path.as_uri())
    if not broken:
        page.wait_for_function("times.length > 2 && times.at(-1) === '2.00 s'", timeout=PATIENCE)
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    times = page.evaluate("times")
    assert times == ["1.00 s"] if broken else times[:2] == ["2.00 s", "0.00 s"] and times.count("0.00 s") == 1
    assert browser_messages == []


@pytest.mark.promise("Press Play, drag the time line, or use the space bar and the arrow keys.")
def test_the_slider_and_the_keys_show_any_instant(page: Page, run_page: Path, browser_messages: list[str]) -> None:
    clock, first = page.locator(".run-player output"), canvas_picture(page)
    page.get_by_label("Time in seconds").fill("1.5")
    expect(clock).to_have_text("1.50 s")
    expect(page.locator(".run-said")).to_contain_text("moves +0.40 m/s, +0.20 rad/s · commanded +0.40 m/s, +0.20 rad/s")
    assert canvas_picture(page) != first
    for key, time in (("ArrowLeft", "1.40"), ("Shift+ArrowLeft", "0.40"), ("End", "2.00"), ("Home", "0.00")):
        page.keyboard.press(key)
        expect(clock).to_have_text(f"{time} s")
    page.get_by_role("img", name="Track of robot").focus()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert browser_messages == []


def test_keys_control_the_player_under_the_mouse_unless_a_field_has_the_focus(page: Page, run_page: Path) -> None:
    clocks = page.locator(".run-player output")
    page.evaluate("""() => {
        document.querySelector("main").insertAdjacentHTML("beforeend", "<input id=field>");
        const other = document.querySelector(".run-player").cloneNode(true);
        other.className = "run-player";
        delete other.dataset.alone;
        other.querySelector(".run-stage").remove();
        document.querySelector("main").append(other);
        const script = document.createElement("script");
        script.textContent = [...document.scripts].at(-1).textContent;
        document.body.append(script);
    }""")
    expect(clocks).to_have_text(["2.00 s", "2.00 s"])
    page.locator(".run-player canvas").last.hover()
    page.keyboard.press("Home")
    expect(clocks).to_have_text(["2.00 s", "0.00 s"])
    page.locator(".run-player canvas").first.hover()
    page.keyboard.press("ArrowLeft")
    expect(clocks).to_have_text(["1.90 s", "0.00 s"])
    page.locator("#field").focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.type("b l")
    expect(clocks).to_have_text(["1.90 s", "0.00 s"])
    expect(page.locator("#field")).to_have_value("b l")


def test_the_picture_zooms_moves_and_follows_the_robot(
    page: Page, run_page: Path, browser_messages: list[str], screenshots: Screenshots
) -> None:
    canvas, whole = page.locator(".run-player canvas"), canvas_picture(page)
    canvas.hover()
    page.keyboard.press("+")
    zoomed = canvas_picture(page)
    assert zoomed != whole
    page.mouse.down()
    page.mouse.move(300, 300)
    page.mouse.up()
    assert canvas_picture(page) not in (whole, zoomed)
    page.get_by_role("button", name="Show the whole world").click()
    assert canvas_picture(page) == whole
    canvas.hover()
    page.keyboard.down("Control")
    page.mouse.wheel(0, -200)
    page.keyboard.up("Control")
    page.wait_for_function("whole => document.querySelector('canvas').toDataURL() !== whole", arg=whole)
    page.keyboard.press("0")
    follow = page.get_by_role("button", name="Follow")
    follow.click()
    expect(follow).to_have_attribute("aria-pressed", "true")
    assert count(canvas, LIGHT.robot) > count(canvas, LIGHT.alarm)
    screenshots(page, "run-page-follow")
    follow.click()
    expect(follow).to_have_attribute("aria-pressed", "false")
    assert browser_messages == []


def test_several_robots_are_named(
    page: Page, browser_messages: list[str], tmp_path: Path, screenshots: Screenshots
) -> None:
    robots = (RobotSpec(name="one", radius=0.18), RobotSpec(name="two", radius=0.18))
    world = load_world(ROOT / "assets" / "worlds" / "moving_obstacle.yaml")
    commands = {"one": Command(0.3, 0.2), "two": Command(0.2, -0.3)}
    recording = run(Simulation(world, robots), lambda state, scans: commands, 4.0)
    page.goto(to_html(recording, tmp_path / "run.html").as_uri())
    lines = page.locator(".run-said p")
    expect(lines).to_have_count(2, timeout=PATIENCE)
    expect(lines.first).to_contain_text("one: moves +0.30 m/s")
    expect(lines.last).to_contain_text("two: moves +0.20 m/s")
    page.get_by_role("button", name="Follow").click()
    page.get_by_role("button", name="Follow: one").click()
    expect(page.get_by_role("button", name="Follow: two")).to_be_visible()
    screenshots(page, "run-page-robots")
    assert browser_messages == []


def test_axe_finds_no_violation_in_the_player(page: Page, run_page: Path, screenshots: Screenshots) -> None:
    screenshots(page, "run-page")
    check_accessibility(page)


def test_a_link_with_an_instant_opens_the_run_at_that_instant(
    page: Page, run_page: Path, browser_messages: list[str]
) -> None:
    page.goto("about:blank")
    page.goto(f"{run_page.as_uri()}#t=1.3")
    expect(page.locator(".run-player output")).to_have_text("1.30 s")
    page.get_by_label("Time in seconds").fill("0.7")
    link = page.get_by_role("link", name="Link to this instant")
    expect(link).to_have_attribute("href", "#t=0.70")
    page.get_by_label("Time in seconds").fill("0")
    page.evaluate("location.hash = 't=0.70'")
    expect(page.locator(".run-player output")).to_have_text("0.70 s")
    assert browser_messages == []


def test_the_player_is_dark_if_the_browser_prefers_dark(page: Page, run_page: Path) -> None:
    def background() -> str:
        return str(page.evaluate("getComputedStyle(document.body).backgroundColor"))

    page.emulate_media(color_scheme="light")
    assert background() == "rgb(255, 255, 255)"
    light = canvas_picture(page)
    page.emulate_media(color_scheme="dark")
    assert background() == "rgb(17, 22, 27)"
    page.wait_for_function("light => document.querySelector('canvas').toDataURL() !== light", arg=light)


def test_a_broken_rule_shows_its_instant_and_a_click_jumps_to_it(
    page: Page, browser_messages: list[str], tmp_path: Path, screenshots: Screenshots
) -> None:
    recording = drive("lab", 60.0)
    gaps, times = recording.clearances[:, 0], recording.times
    broken = float(times[int(recording.collided[:, 0].argmax())])
    path = tmp_path / "run.html"
    path.write_text(page_of(recording, [Margin("the gap in m", times.tolist(), (gaps - 0.01).tolist(), broken)]))
    size = path.stat().st_size
    assert size <= MAX_BYTES
    page.goto(path.as_uri())
    # The player opens at the instant of the failure.
    expect(page.locator(".run-player output")).to_have_text(f"{broken:.2f} s", timeout=PATIENCE)
    assert count(page.locator(".run-player canvas"), LIGHT.alarm)[0] > 20
    page.keyboard.press("End")
    page.get_by_role("button", name=f"broken at t = {broken:.1f} s").click()
    expect(page.locator(".run-player output")).to_have_text(f"{broken:.2f} s")
    expect(page.locator(".run-hit")).to_contain_text("met")
    row = int((times <= broken + 1e-6).sum()) - 1
    expect(page.locator(".run-margin")).to_contain_text(f"{abs(gaps[row] - 0.01):.2f}")
    page.locator(".run-margin svg").click(position={"x": 0, "y": 30})
    expect(page.locator(".run-player output")).to_have_text("0.00 s")
    screenshots(page, "run-page-rule", full_page=True)
    page.get_by_role("button", name="Play").click()
    print(f"a minute: {size} bytes, {page.evaluate(COUNT_FRAMES, 2.0):.0f} frames/s")
    assert browser_messages == []


def test_lines_of_programs_are_shown_as_text_with_their_instants(
    page: Page, browser_messages: list[str], tmp_path: Path, screenshots: Screenshots
) -> None:
    attack = "<script>document.title = 'owned'</script><img src=x onerror=\"document.title='owned'\">"
    flood = tuple((0.5 + number / 1000, f"[INFO] [loop]: {number}") for number in range(1000))
    recording = replace(drive("lab", 3.0), log_lines=((0.3, attack), *flood, (2.0, "the last one")))
    page.goto(to_html(recording, tmp_path / "run.html").as_uri())
    lines, clock = page.locator(".run-log li"), page.locator(".run-player output")
    expect(lines).to_have_count(1002, timeout=PATIENCE)
    expect(lines.first).to_have_text(f"0.3 s{attack}")
    page.keyboard.press("Home")
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
    screenshots(page, "run-page-log", full_page=True)
    assert page.title() == "the lab: 3.0 s"
    assert browser_messages == []
