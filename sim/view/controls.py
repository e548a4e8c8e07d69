"""The widgets of the live view: what the buttons look like and which method of the view each one calls."""

from __future__ import annotations

from typing import Any, Protocol

import ipywidgets as widgets

from sim.pose import Command
from sim.view.session import Source

LINEAR, ANGULAR = 0.22, 0.9
"""What an arrow of the pad asks for, in m/s and rad/s."""

SPEEDS = (0.25, 0.5, 1.0, 2.0, 5.0)

_SOMEBODY = "your code drives"


class Player(Protocol):
    """What the buttons control; `sim.view.LiveView` is one."""

    @property
    def playing(self) -> bool:
        """Whether time goes on."""

    def play(self) -> None:
        """Let time go on."""

    def pause(self) -> None:
        """Stop time."""

    def step(self) -> None:
        """Pause, and go on by 0.1 s of simulated time."""

    def seek(self, seconds: float) -> None:
        """Show the instant `seconds`."""

    def reset(self) -> None:
        """Go back to the start of the run."""

    def drive(self, command: Command) -> None:
        """Give the first robot a command by hand."""

    def automatic(self) -> None:
        """Give the first robot back to the callback or to the node that drives it."""

    def set_speed(self, speed: float) -> None:
        """Set how many simulated seconds pass in a second."""


class Controls:
    """A place for errors, and below it as in the player of a run: an image, a row to play with time, a pad to drive."""

    def __init__(self, view: Player, source: Source, speed: float, width: int) -> None:
        """Make the widgets of `view`, whose image is `width` pixels wide."""
        self._view = view
        self._quiet = False
        self._image = widgets.Image(format="jpeg", layout={"width": "100%", "max_width": f"{width}px", "margin": "0"})
        self._play = widgets.ToggleButton(value=False, description="Play", tooltip="Play", layout={"width": "80px"})
        self._slider = widgets.FloatSlider(
            min=0.0,
            max=10.0,
            step=0.02,
            readout_format=".2f",
            description="t [s]",
            style={"description_width": "36px"},
            layout={"flex": "1 1 auto"},
        )
        choices = sorted({*SPEEDS, speed})
        self._speed = widgets.Dropdown(
            options=[(f"{factor:g}×", factor) for factor in choices],  # noqa: RUF001 (a multiplication sign)
            value=speed,
            tooltip="Simulated seconds a second",
            layout={"width": "78px"},
        )
        self._output = widgets.Output()
        self._play.observe(self._on_play, "value")
        self._slider.observe(self._on_slider, "value")
        self._speed.observe(lambda change: view.set_speed(change["new"]), "value")
        step = self._button("step-forward", "One step of 0.1 s", lambda: view.step())
        reset = self._button("fast-backward", "Back to the start", view.reset)
        time_row = [self._play, step, *([reset] if source.growing else []), self._slider]
        if source.paced:
            time_row.append(self._speed)
        timing = widgets.HBox(time_row, layout={"max_width": f"{width}px", "align_items": "center"})
        rows: list[Any] = [self._output, self._image, timing]
        if source.growing:
            rows.append(self._pad(source.can_be_released))
        self.box = widgets.VBox(rows)

    def show(self, jpeg: bytes, now: float, end: float) -> None:
        """Put a frame on show and move the slider, without taking that for a hand on the slider."""
        self._quiet = True
        self._image.value = jpeg
        # A slider that is moved forty times a second can't be grabbed: it follows four times a second, and obeys a hand
        # only while time stands still.
        if not self._view.playing or abs(now - self._slider.value) >= 0.25 * self._speed.value:
            if end > self._slider.max:
                self._slider.max = max(end, 1.5 * self._slider.max)
            self._slider.value = now
        self._quiet = False

    def set_playing(self, playing: bool) -> None:
        """Make the button say what pressing it would do."""
        self._quiet = True
        self._play.value = playing
        self._play.description = self._play.tooltip = "Pause" if playing else "Play"
        self._slider.disabled = playing
        self._quiet = False

    def set_command(self, command: Command | None) -> None:
        """Say who drives: a command given by hand, or None for the callback."""
        if command is None:
            self._who.value = _SOMEBODY
        else:
            self._who.value = f"{command.linear:+.2f} m/s  {command.angular:+.2f} rad/s"

    def show_error(self, text: str) -> None:
        """Print what the callback raised above the picture, where it can't be overlooked."""
        self._output.outputs = ({"output_type": "stream", "name": "stderr", "text": text},)

    def clear_error(self) -> None:
        """Take the error away."""
        self._output.outputs = ()

    def _pad(self, releases: bool) -> widgets.Widget:
        self._who = widgets.Label(value=_SOMEBODY if releases else "drive with the arrows")
        drive = self._view.drive
        buttons = [
            self._button("rotate-left", "Turn left", lambda: drive(Command(0.0, ANGULAR))),
            self._button("arrow-up", "Forward", lambda: drive(Command(LINEAR, 0.0))),
            self._button("arrow-down", "Backward", lambda: drive(Command(-LINEAR, 0.0))),
            self._button("rotate-right", "Turn right", lambda: drive(Command(0.0, -ANGULAR))),
            self._button("stop", "Stop the robot", lambda: drive(Command())),
        ]
        if releases:
            buttons.append(self._button("magic", "Let your code drive", self._view.automatic))
        return widgets.HBox([*buttons, self._who], layout={"align_items": "center"})

    def _button(self, icon: str, tooltip: str, action: Any) -> widgets.Button:
        button = widgets.Button(icon=icon, tooltip=tooltip, layout={"width": "44px"})
        button.on_click(lambda _: action())
        return button

    def _on_play(self, change: Any) -> None:
        if not self._quiet:
            if change["new"]:
                self._view.play()
            else:
                self._view.pause()

    def _on_slider(self, change: Any) -> None:
        if not self._quiet and not self._view.playing:
            self._view.seek(change["new"])
