"""The widget of the live view: what the page shows, and the requests of its buttons and keys.

The page is written in JavaScript, with the drawing of the player (`live.js`). It can zoom, pan and follow a robot while
the kernel is busy. Everything else is a message to the kernel, which answers with a new frame.
"""

from __future__ import annotations

from typing import Any, Protocol

import anywidget
import traitlets

from sim.pose import Command
from sim.view.player import script_of, sheet

LINEAR, ANGULAR = 0.22, 0.9
"""The speeds that an arrow of the pad commands, in m/s and rad/s."""


class Actions(Protocol):
    """The interface of the view that the page controls, such as `sim.view.LiveView`."""

    def play(self) -> None:
        """Let time advance."""

    def pause(self) -> None:
        """Stop time."""

    def step(self) -> None:
        """Pause, and simulate 0.1 s."""

    def seek(self, seconds: float) -> None:
        """Show the instant `seconds`."""

    def reset(self) -> None:
        """Return to the start of the run."""

    def drive(self, command: Command) -> None:
        """Give the first robot a manual command."""

    def automatic(self) -> None:
        """Return control of the first robot to the callback or to the node that drives it."""

    def set_speed(self, speed: float) -> None:
        """Set the number of simulated seconds per second."""


class Controls(anywidget.AnyWidget):
    """What the page shows, as traits, and a handler for its messages.

    `run` and `frame` are the results of `sim.view.live_data`. `driver` tells what drives the first robot, and `error`
    is the text of the callback's exception, or "".
    """

    _esm = script_of("live_scan", "live")
    _css = sheet()
    run = traitlets.Dict().tag(sync=True)
    frame = traitlets.Dict().tag(sync=True)
    playing = traitlets.Bool(False).tag(sync=True)
    speed = traitlets.Float(1.0).tag(sync=True)
    driver = traitlets.Unicode("").tag(sync=True)
    error = traitlets.Unicode("").tag(sync=True)

    def __init__(self, actions: Actions, run: dict[str, Any], frame: dict[str, Any], speed: float) -> None:
        super().__init__(run=run, frame=frame, speed=speed)
        self._actions = actions
        self.set_command(None)
        self.on_msg(lambda _widget, message, _buffers: self.handle(message))

    def set_command(self, command: Command | None) -> None:
        """Show a manual command or, if it is None, that the callback drives."""
        names = [robot["name"] for robot in self.run["robots"]]
        if command is not None:
            text = f"{command.linear:+.2f} m/s  {command.angular:+.2f} rad/s"
        else:
            text = "your code drives" if self.run["releasable"] else "drive with the arrows"
        self.driver = text if len(names) == 1 else f"{names[0]}: {text}"

    def handle(self, message: dict[str, Any]) -> None:
        """Execute a request of the page. `forward` and `left` are -1, 0 or 1."""
        actions = self._actions
        match message:
            case {"action": "play"}:
                actions.play()
            case {"action": "pause"}:
                actions.pause()
            case {"action": "step"}:
                actions.step()
            case {"action": "seek", "time": time}:
                actions.pause()
                actions.seek(time)
            case {"action": "reset"}:
                actions.reset()
            case {"action": "drive", "forward": forward, "left": left}:
                actions.drive(Command(LINEAR * forward, ANGULAR * left))
            case {"action": "release"}:
                actions.automatic()
            case {"action": "speed", "factor": factor}:
                actions.set_speed(factor)
