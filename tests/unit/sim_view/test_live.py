"""The live view without a browser: its methods, on an event loop like a kernel's."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from sim import Command, Recording, Scan, Simulation, World
from sim.view import LiveView, Picture, Player, live, plot
from sim.view.session import MAX_NS, Session

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


def state_of(view: LiveView) -> Any:
    """Return the widget, whose traits are what the page shows."""
    return view.widget


def ask(view: LiveView, action: str, **more: Any) -> None:
    """Send a message to the view, as its page does."""
    state_of(view)._handle_custom_msg({"action": action, **more}, [])


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
    newest = state_of(view).frame
    view.seek(0.5)
    assert view.time == 0.5
    assert (state_of(view).frame["time"], state_of(view).frame["end"]) == (0.5, 2.0)
    assert state_of(view).frame["robots"][0]["pose"] != newest["robots"][0]["pose"]
    view.step(0.1)
    assert view.time == pytest.approx(0.6)
    assert view.recording.times[-1] == pytest.approx(2.0)
    view.seek(99.0)
    assert view.time == pytest.approx(2.0)


def test_reset_discards_the_run(world: World) -> None:
    view = paused_view(world, drive_forward)
    first = state_of(view).frame
    view.step(2.0)
    ask(view, "reset")
    assert (view.time, len(view.recording)) == (0.0, 1)
    assert state_of(view).frame == first


def test_the_page_drives_until_the_robot_is_given_back_to_the_callback(world: World) -> None:
    view = paused_view(world, drive_forward)
    view.step(1.0)
    ask(view, "drive", forward=0, left=1)
    assert state_of(view).driver == "+0.00 m/s  +0.90 rad/s"
    view.step(1.0)
    assert view.recording.velocities[-1, 0].tolist() == pytest.approx([0.0, 0.9])
    ask(view, "drive", forward=0, left=0)
    view.step(1.0)
    assert view.recording.velocities[-1, 0].tolist() == [0.0, 0.0]
    ask(view, "release")
    assert state_of(view).driver == "your code drives"
    view.step(1.0)
    assert view.recording.velocities[-1, 0].tolist() == pytest.approx([0.3, 0.0])


def test_the_page_plays_pauses_steps_and_sets_the_speed(world: World) -> None:
    async def control() -> None:
        view = paused_view(world, drive_forward)
        ask(view, "step")
        assert view.time == pytest.approx(0.1)
        ask(view, "speed", factor=4.0)
        ask(view, "play")
        assert view.playing
        assert state_of(view).playing
        await wait_until(lambda: view.time > 0.5)
        ask(view, "pause")
        assert not view.playing
        assert not state_of(view).playing
        ask(view, "unknown")

    in_other_thread(asyncio.run, control())


def test_a_seek_of_the_page_pauses(world: World) -> None:
    async def seek() -> None:
        view = paused_view(world, drive_forward)
        view.step(2.0)
        view.play()
        ask(view, "seek", time=1.0)
        assert (view.playing, view.time) == (False, 1.0)

    in_other_thread(asyncio.run, seek())


def test_the_speed_of_the_view_is_that_of_the_page(world: World) -> None:
    view = live(world, speed=3.0, play=False)
    assert isinstance(view, LiveView)
    assert state_of(view).speed == 3.0
    view.set_speed(0.5)
    assert state_of(view).speed == 0.5


def test_without_a_callback_the_robot_cannot_be_given_back(world: World) -> None:
    state = state_of(paused_view(world))
    assert not state.run["releasable"]
    assert state.driver == "drive with the arrows"


def test_the_driven_robot_is_named_if_there_are_several(recording: Recording) -> None:
    view = paused_view(recording.simulation)
    assert state_of(view).driver == "one: drive with the arrows"
    ask(view, "drive", forward=1, left=0)
    assert state_of(view).driver == "one: +0.22 m/s  +0.00 rad/s"


def test_a_page_without_widgets_shows_what_the_view_is(world: World) -> None:
    view = paused_view(world)
    bundle, _ = view._repr_mimebundle_()
    assert bundle["text/plain"] == repr(view)
    assert bundle["application/vnd.jupyter.widget-view+json"]["model_id"] == state_of(view).model_id


def test_an_exception_of_the_callback_stops_time_and_is_shown_without_internal_frames(world: World) -> None:
    def broken(scan: Scan) -> Command:
        raise LookupError("no such wall")

    view = paused_view(world, broken)
    view.step(1.0)
    error = state_of(view).error
    assert "LookupError: no such wall" in error
    assert "in broken" in error
    assert "session.py" not in error
    assert view.time == 0.0
    view.reset()
    assert state_of(view).error == ""


def test_a_callback_that_returns_another_type_is_an_error_with_the_right_type(world: World) -> None:
    view = paused_view(world, lambda scan: 0.3)
    view.step(1.0)
    assert "must return a Command or None, not float" in state_of(view).error


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
