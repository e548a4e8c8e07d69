"""The live view for JupyterLab: a widget that draws frames, and a task in the kernel's event loop.

It is a task and not a thread, so that the student's callback runs in the same thread as the cells, and never while one
of them runs. So variables do not change during a cell, and no lock is needed. While a long cell runs, simulated time
waits, so that nothing is missed. The task returns to the loop after each frame.

Under a grader (the environment variable AUTOGRADER_GRADING is set) `live` starts nothing and returns a picture.
"""

from __future__ import annotations

import asyncio
import time
import traceback
from collections import deque
from pathlib import Path
from typing import TYPE_CHECKING, Any

import anywidget

from sim.grading import grading
from sim.pose import Command
from sim.recording import Recording
from sim.simulation import Simulation, start
from sim.view.controls import Controls
from sim.view.figures import plot, show
from sim.view.live_data import describe, frame_data
from sim.view.picture import Picture
from sim.view.player import Player
from sim.view.session import Controller, Session, Source
from sim.view.theme import Theme, theme_named
from sim.view.watch import Watch
from sim.world import World

if TYPE_CHECKING:
    from sim.bridge.background import Bridge

FPS = 40.0
"""The intended number of frames a second."""

MAX_FRAME_SECONDS = 0.1
"""The most real time that one frame accounts for, in s, so that simulated time waits while a long cell runs."""

_PACKAGE = Path(__file__).parents[1]


def live(
    source: World | Simulation | Recording | Bridge,
    controller: Controller | None = None,
    *,
    speed: float = 1.0,
    theme: str | Theme = "light",
    names: bool = False,
    play: bool = True,
) -> LiveView | Player | Picture:
    """Show a moving world, simulation, recording or ROS bridge, with buttons to play, pause, seek and drive.

    A recording is played by the page itself, even while the kernel is busy, and in an exported notebook.

    `controller` is called with each new scan of the first robot, and returns a `Command`, or None to keep the last one.
    Without a controller, the pad drives the robot. `speed` is in simulated seconds per second. If `controller` raises
    an exception, the view pauses and prints it. Without a running event loop, as in a plain script, the view does not
    move.

    Raises:
        ValueError: the speed or the theme is invalid, or the source does not accept a callback.
    """
    if not 0.0 < speed <= 100.0:
        raise ValueError(f"a speed of {speed} makes no sense: give a factor above 0 and up to 100; 1 is real time")
    colours = theme_named(theme)
    if grading():
        return _still_picture(source, colours)
    if isinstance(source, Recording):
        if controller is not None:
            raise ValueError("a callback can't drive a recording: give live() a world or a simulation")
        return Player(source, theme=colours.name, speed=speed, play=play)
    view = LiveView(_source_of(source, controller), colours, speed=speed, names=names)
    if play:
        view.play()
    return view


class LiveView:
    """The result of `live`, which a notebook displays. Its methods have the same effects as its buttons."""

    def __init__(self, source: Source, theme: Theme, *, speed: float = 1.0, names: bool = False) -> None:
        self._source = source
        self._speed = speed
        self._now_ns = 0
        self._task: asyncio.Task[None] | None = None
        self._frame_times: deque[float] = deque(maxlen=60)
        self._controls = Controls(self, describe(source, theme, names=names), frame_data(source, 0), speed)

    @property
    def widget(self) -> anywidget.AnyWidget:
        """The widget with everything in it."""
        return self._controls

    @property
    def playing(self) -> bool:
        """Whether time advances."""
        return self._task is not None and not self._task.done()

    @property
    def time(self) -> float:
        """The displayed simulated time, in seconds."""
        return self._now_ns / 1e9

    @property
    def fps(self) -> float:
        """The frame rate over the last sixty frames, or 0 if there are fewer than two."""
        if len(self._frame_times) < 2:
            return 0.0
        return (len(self._frame_times) - 1) / max(1e-9, self._frame_times[-1] - self._frame_times[0])

    @property
    def recording(self) -> Recording:
        """The recording of the run, which can be plotted, saved or replayed."""
        return self._source.recording()

    def play(self) -> None:
        """Let time advance from the displayed instant."""
        if self.playing:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:  # in a script without a loop, no second frame can be shown
            self._controls.playing = False
            return
        self._frame_times.clear()
        self._source.set_paused(False)
        self._task = loop.create_task(self._run())
        self._controls.playing = True

    def pause(self) -> None:
        """Stop time."""
        if self._task is not None:
            self._task.cancel()
            self._task = None
        self._source.set_paused(True)
        if not self._source.paced:  # the source has advanced until now
            self._now_ns = self._source.end_ns
        self._controls.playing = False
        self._render()

    def step(self, seconds: float = 0.1) -> None:
        """Pause, and simulate `seconds`."""
        self.pause()
        self._advance(round(seconds * 1e9))

    def seek(self, seconds: float) -> None:
        """Show the instant `seconds`, at most the end of the run."""
        self._now_ns = min(max(0, round(seconds * 1e9)), self._source.end_ns)
        self._render()

    def reset(self) -> None:
        """Return to the start of the run, and drop its recording."""
        self.pause()
        self._source.reset()
        self._controls.error = ""
        self._now_ns = 0
        self._render()

    def drive(self, command: Command) -> None:
        """Drive the first robot manually. `command` is valid until the next one."""
        self._source.drive(command)
        self._controls.set_command(command)

    def automatic(self) -> None:
        """Return control of the robot to the callback, or to the node that drives it over ROS."""
        self._source.drive(None)
        self._controls.set_command(None)

    def set_speed(self, speed: float) -> None:
        """Set the number of simulated seconds per second."""
        self._speed = self._controls.speed = speed

    async def _run(self) -> None:
        period, last = 1.0 / FPS, time.perf_counter()
        while True:
            await asyncio.sleep(max(0.0, last + period - time.perf_counter()))
            now = time.perf_counter()
            elapsed, last = min(now - last, MAX_FRAME_SECONDS), now
            if not self._advance(round(elapsed * self._speed * 1e9)):
                self._task = None
                self._controls.playing = False
                return

    def _advance(self, duration_ns: int) -> bool:
        """Advance the displayed instant by `duration_ns`; return whether it can advance further."""
        try:
            self._now_ns = self._source.advance(self._now_ns + duration_ns)
        except Exception as error:  # the student's callback may raise any exception, which is shown to the student
            self._now_ns = self._source.end_ns
            self._render()
            self._controls.error = _callback_traceback(error)
            return False
        self._render()
        return self._source.growing or self._now_ns < self._source.end_ns

    def _render(self) -> None:
        self._controls.frame = frame_data(self._source, self._now_ns)
        self._frame_times.append(time.perf_counter())

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        bundle: Any = self._controls._repr_mimebundle_(**kwargs)
        return {**bundle[0], "text/plain": repr(self)}, bundle[1]

    def __repr__(self) -> str:
        world = self._source.simulation.world.name
        return f"<live view of {world!r} at {self.time:.2f} s, {'playing' if self.playing else 'paused'}>"


def _source_of(source: World | Simulation | Bridge, controller: Controller | None) -> Source:
    if isinstance(source, Simulation):
        return Session(source, controller)
    if isinstance(source, World):
        return Session(Simulation(source), controller)
    if controller is not None:
        raise ValueError("a callback can't drive a ROS bridge: give live() a world or a simulation")
    return Watch(source)


def _still_picture(source: World | Simulation | Recording | Bridge, theme: Theme) -> Picture:
    if isinstance(source, Recording):
        return plot(source, theme=theme)
    if isinstance(source, World):
        return show(source, theme=theme)
    if isinstance(source, Simulation):
        return show(source, start(source), theme=theme)
    return show(source.simulation, source.driver.state, theme=theme)


def _callback_traceback(error: BaseException) -> str:
    """Return the traceback of the student's code, without the frames of this package."""
    frames = traceback.extract_tb(error.__traceback__)
    student_frames = [frame for frame in frames if _PACKAGE not in Path(frame.filename).parents]
    lines = ["Traceback (most recent call last):\n", *traceback.format_list(student_frames)] if student_frames else []
    return "".join([*lines, *traceback.format_exception_only(type(error), error)])
