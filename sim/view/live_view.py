"""The live view for JupyterLab: one image, a row of buttons, and a task on the kernel's own event loop.

A task, not a thread: the student's callback then runs where the rest of their code runs, between cells and never in the
middle of one, so that their variables can't change under their hands and no lock is needed. A cell that runs long makes
the picture wait, and the simulated time with it: nothing is missed. Each frame the task gives the loop back.

Under a grader (the environment variable AUTOGRADER_GRADING is set) `live` starts nothing and returns a picture.
"""

from __future__ import annotations

import asyncio
import time
import traceback
from collections import deque
from pathlib import Path
from typing import TYPE_CHECKING, Any

import ipywidgets as widgets

from sim.grading import grading
from sim.pose import Command
from sim.recording import Recording
from sim.simulation import Simulation, start
from sim.view.controls import Controls
from sim.view.figures import plot, show
from sim.view.picture import Picture
from sim.view.player import Player
from sim.view.renderer import Renderer
from sim.view.session import Controller, Session, Source
from sim.view.theme import Theme, theme_named
from sim.view.watch import Watch
from sim.world import World

if TYPE_CHECKING:
    from sim.bridge.background import Bridge

FPS = 40.0
"""Frames a second that the view aims at."""

LONGEST_LEAP = 0.1
"""Seconds that a frame may add at most: while a cell runs long, simulated time waits with the picture."""

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
    """Show a world, a simulation, a recording or a ROS bridge that moves, with buttons to play, pause, seek and drive.

    A recording is played by the page alone: it plays on when the kernel is busy, and in an exported notebook.

    `controller` gets each new scan of the first robot and returns a `Command` (or None: as before); without one the
    robot obeys the pad. `speed` is simulated seconds a second. Whatever `controller` raises pauses the view and is
    printed above it. Without a running event loop (a plain script) the view is there, but stands still.

    Raises:
        ValueError: for a speed that is not above zero, an unknown theme, or a callback where something else drives.
    """
    if not 0.0 < speed <= 100.0:
        raise ValueError(f"a speed of {speed} makes no sense: give a factor above 0 and up to 100, 1 is real time")
    colours = theme_named(theme)
    if grading():
        return _still(source, colours)
    if isinstance(source, Recording):
        if controller is not None:
            raise ValueError("a callback can't drive a recording: give live() a world or a simulation")
        return Player(source, theme=colours.name, speed=speed, play=play)
    view = LiveView(_playable(source, controller), colours, speed=speed, names=names)
    if play:
        view.play()
    return view


class LiveView:
    """What `live` returns: shows itself in a notebook; its methods do what its buttons do."""

    def __init__(self, source: Source, theme: Theme, *, speed: float = 1.0, names: bool = False) -> None:
        self._source = source
        self._renderer = Renderer(source.simulation, theme, names=names)
        self._speed = speed
        self._now_ns = 0
        self._task: asyncio.Task[None] | None = None
        self._shown: deque[float] = deque(maxlen=60)
        self._controls = Controls(self, source, speed, self._renderer.width)
        self._render()

    @property
    def widget(self) -> widgets.Widget:
        """The ipywidgets box with everything in it."""
        return self._controls.box

    @property
    def playing(self) -> bool:
        """Whether time goes on."""
        return self._task is not None and not self._task.done()

    @property
    def time(self) -> float:
        """The simulated time on show, in seconds."""
        return self._now_ns / 1e9

    @property
    def fps(self) -> float:
        """Frames a second over the last sixty shown; 0 before there are two."""
        if len(self._shown) < 2:
            return 0.0
        return (len(self._shown) - 1) / max(1e-9, self._shown[-1] - self._shown[0])

    @property
    def recording(self) -> Recording:
        """The run so far, to be plotted, saved or replayed."""
        return self._source.recording()

    def play(self) -> None:
        """Let time go on, from the instant on show."""
        if self.playing:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:  # a script without a loop: there is nothing that could show a second frame
            self._controls.set_playing(False)
            return
        self._shown.clear()
        self._source.hold(False)
        self._task = loop.create_task(self._run())
        self._controls.set_playing(True)

    def pause(self) -> None:
        """Stop time."""
        if self._task is not None:
            self._task.cancel()
            self._task = None
        self._source.hold(True)
        if not self._source.paced:  # it went on until it heard
            self._now_ns = self._source.end_ns
        self._controls.set_playing(False)
        self._render()

    def step(self, seconds: float = 0.1) -> None:
        """Pause, and go on by `seconds` of simulated time."""
        self.pause()
        self._advance(round(seconds * 1e9))

    def seek(self, seconds: float) -> None:
        """Show the instant `seconds`, within what has been run so far."""
        self._now_ns = min(max(0, round(seconds * 1e9)), self._source.end_ns)
        self._render()

    def reset(self) -> None:
        """Go back to the start of the run and forget what came after."""
        self.pause()
        self._source.reset()
        self._controls.clear_error()
        self._now_ns = 0
        self._render()

    def drive(self, command: Command) -> None:
        """Take the first robot over by hand; `command` holds until the next one."""
        self._source.drive(command)
        self._controls.set_command(command)

    def automatic(self) -> None:
        """Give the robot back to the callback, or to the node that drives it over ROS."""
        self._source.drive(None)
        self._controls.set_command(None)

    def set_speed(self, speed: float) -> None:
        """Set how many simulated seconds pass in a second."""
        self._speed = speed

    async def _run(self) -> None:
        period, last = 1.0 / FPS, time.perf_counter()
        while True:
            await asyncio.sleep(max(0.0, last + period - time.perf_counter()))
            now = time.perf_counter()
            passed, last = min(now - last, LONGEST_LEAP), now
            if not self._advance(round(passed * self._speed * 1e9)):
                self._task = None
                self._controls.set_playing(False)
                return

    def _advance(self, by_ns: int) -> bool:
        """Move the instant on show by `by_ns`; say whether there is more to come."""
        wanted = self._now_ns + by_ns
        try:
            self._now_ns = self._source.advance(wanted)
        except Exception as error:  # the student's callback may raise anything; it belongs in the cell
            self._now_ns = self._source.end_ns
            self._render()
            self._controls.show_error(_callback_traceback(error))
            return False
        self._render()
        return self._source.growing or self._now_ns < self._source.end_ns

    def _render(self) -> None:
        frame, trail = self._source.at(self._now_ns), self._source.trail(self._now_ns)
        self._controls.show(self._renderer.jpeg(frame, trail), self._now_ns / 1e9, self._source.end_ns / 1e9)
        self._shown.append(time.perf_counter())

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        return self._controls.box._repr_mimebundle_(**kwargs)

    def __repr__(self) -> str:
        world = self._source.simulation.world.name
        return f"<live view of {world!r} at {self.time:.2f} s, {'playing' if self.playing else 'paused'}>"


def _playable(source: World | Simulation | Bridge, controller: Controller | None) -> Source:
    if isinstance(source, Simulation):
        return Session(source, controller)
    if isinstance(source, World):
        return Session(Simulation(source), controller)
    if controller is not None:
        raise ValueError("a callback can't drive a ROS bridge: give live() a world or a simulation")
    return Watch(source)


def _still(source: World | Simulation | Recording | Bridge, theme: Theme) -> Picture:
    if isinstance(source, Recording):
        return plot(source, theme=theme)
    if isinstance(source, World):
        return show(source, theme=theme)
    if isinstance(source, Simulation):
        return show(source, start(source), theme=theme)
    return show(source.simulation, source.driver.state, theme=theme)


def _callback_traceback(error: BaseException) -> str:
    """Return the traceback without the frames of this package: the student's own lines and the error."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if _PACKAGE not in Path(frame.filename).parents]
    lines = ["Traceback (most recent call last):\n", *traceback.format_list(own)] if own else []
    return "".join([*lines, *traceback.format_exception_only(type(error), error)])
