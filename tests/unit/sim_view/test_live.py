"""The live view without a browser: its methods, on an event loop like a kernel's."""

from __future__ import annotations

import asyncio
import io
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from sim import Command, Recording, RobotSpec, Scan, Simulation, World, box, load_world
from sim.view import LiveView, Picture, Player, live, plot
from sim.view.renderer import Renderer
from sim.view.session import MAX_NS, Session
from sim.view.theme import DARK, LIGHT

ROOT = Path(__file__).resolve().parents[3]
SECOND = 1_000_000_000
PATIENCE = 60.0


@pytest.fixture(autouse=True)
def outside_of_grading(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("AUTOGRADER_GRADING", raising=False)


def drive_forward(scan: Scan) -> Command:
    return Command(0.3, 0.0)


def paused_view(source: Any, controller: Any = None) -> LiveView:
    view = live(source, controller, play=False)
    assert isinstance(view, LiveView)
    return view


async def wait_until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, "the condition never held"
        await asyncio.sleep(0)


def in_other_thread(function: Callable[..., Any], *arguments: Any) -> Any:
    """Call in another thread, because an earlier browser test leaves its loop running in the main thread."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(function, *arguments).result()


def widgets_of(view: LiveView) -> dict[str, Any]:
    """Return the view's widgets by tooltip, and those without a tooltip by class."""
    widgets: dict[str, Any] = {}

    def visit(widget: Any) -> None:
        widgets[getattr(widget, "tooltip", None) or type(widget).__name__] = widget
        for child in getattr(widget, "children", ()):
            visit(child)

    visit(view.widget)
    return widgets


def test_the_view_plays_on_the_event_loop_without_blocking_it(world: World) -> None:
    async def play() -> None:
        view = live(world, drive_forward)
        assert isinstance(view, LiveView)
        ticks = 0

        async def other() -> None:
            nonlocal ticks
            while True:
                ticks += 1
                await asyncio.sleep(0)

        task = asyncio.get_running_loop().create_task(other())
        await wait_until(lambda: view.time > 0.5)
        assert view.playing
        assert view.fps > 0.0
        assert ticks > 10
        view.pause()
        task.cancel()
        assert not view.playing
        assert view.recording.poses[-1, 0, 0] > world.starts[0].x

    in_other_thread(asyncio.run, play())


def test_steps_are_exact(world: World) -> None:
    view = paused_view(world, drive_forward)
    view.step(0.1)
    view.step(0.5)
    assert view.time == pytest.approx(0.6)
    assert len(view.recording) == 31


def test_a_view_can_seek_to_the_past_and_continue_from_there(world: World) -> None:
    view = paused_view(world, drive_forward)
    view.step(2.0)
    newest = widgets_of(view)["Image"].value
    view.seek(0.5)
    assert view.time == 0.5
    assert widgets_of(view)["Image"].value != newest
    view.step(0.1)
    assert view.time == pytest.approx(0.6)
    assert view.recording.times[-1] == pytest.approx(2.0)
    view.seek(99.0)
    assert view.time == pytest.approx(2.0)


def test_reset_discards_the_run(world: World) -> None:
    view = paused_view(world, drive_forward)
    first = widgets_of(view)["Image"].value
    view.step(2.0)
    view.reset()
    assert (view.time, len(view.recording)) == (0.0, 1)
    assert widgets_of(view)["Image"].value == first


def test_the_pad_drives_until_the_robot_is_given_back_to_the_callback(world: World) -> None:
    view = paused_view(world, drive_forward)
    view.step(1.0)
    pad = widgets_of(view)
    pad["Turn left"].click()
    view.step(1.0)
    assert view.recording.velocities[-1, 0].tolist() == pytest.approx([0.0, 0.9])
    pad["Stop the robot"].click()
    view.step(1.0)
    assert view.recording.velocities[-1, 0].tolist() == [0.0, 0.0]
    pad["Let your code drive"].click()
    view.step(1.0)
    assert view.recording.velocities[-1, 0].tolist() == pytest.approx([0.3, 0.0])


def test_without_a_callback_the_robot_cannot_be_given_back(world: World) -> None:
    assert "Let your code drive" not in widgets_of(paused_view(world))


def test_an_exception_of_the_callback_stops_time_and_is_shown_without_internal_frames(world: World) -> None:
    def broken(scan: Scan) -> Command:
        raise LookupError("no such wall")

    view = paused_view(world, broken)
    view.step(1.0)
    (output,) = widgets_of(view)["Output"].outputs
    assert output["name"] == "stderr"
    assert "LookupError: no such wall" in output["text"]
    assert "in broken" in output["text"]
    assert "session.py" not in output["text"]
    assert view.time == 0.0
    view.reset()
    assert widgets_of(view)["Output"].outputs == ()


def test_a_callback_that_returns_another_type_is_an_error_with_the_right_type(world: World) -> None:
    view = paused_view(world, lambda scan: 0.3)
    view.step(1.0)
    assert "must return a Command or None, not float" in widgets_of(view)["Output"].outputs[0]["text"]


def test_a_callback_gets_each_scan_once(world: World) -> None:
    stamps: list[int] = []
    view = paused_view(world, lambda scan: stamps.append(scan.stamp_ns))
    view.step(1.0)
    view.step(0.1)
    assert stamps == [0, SECOND // 5, 2 * SECOND // 5, 3 * SECOND // 5, 4 * SECOND // 5, SECOND]


def test_a_recording_is_played_without_other_files(recording: Recording) -> None:
    view = live(recording, speed=2.0, theme="dark")
    assert isinstance(view, Player)
    bundle = view._repr_mimebundle_()[0]
    assert 'data-theme="dark" data-speed="2" data-play="yes"' in bundle["text/html"]
    assert bundle["text/plain"] == repr(view) == plot(recording).alt
    assert bundle["image/png"]


def test_the_slider_seeks_while_time_is_paused(world: World) -> None:
    view = paused_view(world, drive_forward)
    view.step(2.0)
    slider = widgets_of(view)["FloatSlider"]
    assert slider.value == pytest.approx(2.0)
    slider.value = 1.0
    assert view.time == 1.0


def test_the_view_is_a_picture_while_a_notebook_is_graded(
    world: World, recording: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AUTOGRADER_GRADING", "1")

    async def make() -> list[Any]:
        views = [live(source, drive_forward) for source in (world, Simulation(world), recording)]
        assert len(asyncio.all_tasks()) == 1  # this one
        return views

    assert all(isinstance(view, Picture) for view in in_other_thread(asyncio.run, make()))


def test_without_an_event_loop_the_view_does_not_play(world: World) -> None:
    view = in_other_thread(live, world, drive_forward)
    assert isinstance(view, LiveView)
    assert not view.playing
    assert repr(view) == "<live view of 'the lab' at 0.00 s, paused>"


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), 1000.0])
def test_an_invalid_speed_is_refused(world: World, speed: float) -> None:
    with pytest.raises(ValueError, match="makes no sense"):
        live(world, speed=speed)


def test_a_recording_does_not_accept_a_callback(recording: Recording) -> None:
    with pytest.raises(ValueError, match="a callback can't drive a recording"):
        live(recording, drive_forward)


def test_a_session_stops_growing_at_its_longest_time() -> None:
    session = Session(Simulation(World(), tick=1.0))
    session.advance(MAX_NS + 5 * SECOND)
    assert session.end_ns == MAX_NS
    assert not session.growing


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_a_blitted_frame_is_the_same_as_a_fresh_one(world: World, theme: Any) -> None:
    session = Session(Simulation(world), drive_forward)
    session.advance(3 * SECOND)
    used = Renderer(session.simulation, theme)
    for frame in session.frames[::20]:
        used.draw(frame, session.trail(frame.state.time_ns))
    last = session.frames[-1]
    reused = used.draw(last, session.trail(last.state.time_ns))
    fresh = Renderer(session.simulation, theme).draw(last, session.trail(last.state.time_ns))
    assert np.array_equal(np.asarray(reused), np.asarray(fresh))


def test_frames_are_jpeg_or_png_of_one_size(world: World) -> None:
    session = Session(Simulation(world))
    renderer = Renderer(session.simulation, LIGHT)
    jpeg, png = (Image.open(io.BytesIO(data)) for data in (renderer.jpeg(session.at(0)), renderer.png(session.at(0))))
    assert (jpeg.format, png.format) == ("JPEG", "PNG")
    assert jpeg.size == png.size
    assert jpeg.width == renderer.width


@pytest.mark.parametrize("size", [(12.0, 8.0), (8.0, 2.0), (2.0, 8.0), (3.0, 3.0)])
def test_a_frame_has_no_empty_band_beside_or_below_the_world(size: tuple[float, float]) -> None:
    session = Session(Simulation(World.from_segments(box(*size))))
    picture = np.asarray(Renderer(session.simulation, LIGHT).draw(session.at(0))).astype(int)
    is_drawn = np.abs(picture - 255).max(axis=2) > 4
    rows, columns = np.flatnonzero(is_drawn.any(axis=1)), np.flatnonzero(is_drawn.any(axis=0))
    assert picture.shape[0] - rows[-1] < 40
    assert picture.shape[1] - columns[-1] < 40


def test_a_frame_names_robots_if_there_are_several(recording: Recording) -> None:
    def frame(*names: str) -> Any:
        session = Session(replace(recording.simulation, robots=tuple(RobotSpec(name=name) for name in names)))
        return np.asarray(Renderer(session.simulation, LIGHT).draw(session.at(0))).astype(int)

    difference = np.abs(frame("one", "two") - frame("one", "else")).max(axis=2) > 60
    assert difference.sum() > 20


def test_a_moving_obstacle_moves_in_the_picture() -> None:
    world = load_world(ROOT / "assets" / "worlds" / "moving_obstacle.yaml")
    session = Session(Simulation(world))
    session.advance(2 * SECOND)
    renderer = Renderer(session.simulation, LIGHT)
    first, last = (np.asarray(renderer.draw(session.at(instant))) for instant in (0, 2 * SECOND))
    assert (np.abs(first[60:, :600].astype(int) - last[60:, :600]).max(axis=2) > 60).sum() > 200
