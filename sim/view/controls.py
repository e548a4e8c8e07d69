"""The widgets of the live view: the buttons, and the methods of the view that they call."""

from __future__ import annotations

from typing import Any, Protocol

import ipywidgets as widgets

from sim.pose import Command
from sim.view.session import Source

LINEAR, ANGULAR = 0.22, 0.9
"""The speeds that an arrow of the pad commands, in m/s and rad/s."""

SPEEDS = (0.25, 0.5, 1.0, 2.0, 5.0)

_CODE_DRIVES = "your code drives"


class Player(Protocol):
    """The interface of the view that the buttons control, such as `sim.view.LiveView`."""

    @property
    def playing(self) -> bool:
        """Whether time advances."""

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


class Controls:
    """An output for errors and, as in the player of a run, an image, a row of time controls and a pad to drive."""

    def __init__(self, view: Player, source: Source, speed: float, width: int) -> None:
        """Create the widgets of `view`, with an image of `width` pixels."""
        self._view = view
        self._is_updating = False
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
        time_box = widgets.HBox(time_row, layout={"max_width": f"{width}px", "align_items": "center"})
        rows: list[Any] = [self._output, self._image, time_box]
        if source.growing:
            rows.append(self._pad(source.can_be_released))
        self.box = widgets.VBox(rows)

    def show(self, jpeg: bytes, now: float, end: float) -> None:
        """Show a frame and move the slider, without reacting to the slider's change."""
        self._is_updating = True
        self._image.value = jpeg
        # A slider that moves forty times a second cannot be grabbed. So it moves only four times a second, and can be
        # dragged only while time is stopped.
        if not self._view.playing or abs(now - self._slider.value) >= 0.25 * self._speed.value:
            if end > self._slider.max:
                self._slider.max = max(end, 1.5 * self._slider.max)
            self._slider.value = now
        self._is_updating = False

    def set_playing(self, playing: bool) -> None:
        """Label the button with the action that a click would start."""
        self._is_updating = True
        self._play.value = playing
        self._play.description = self._play.tooltip = "Pause" if playing else "Play"
        self._slider.disabled = playing
        self._is_updating = False

    def set_command(self, command: Command | None) -> None:
        """Show a manual command or, if it is None, that the callback drives."""
        if command is None:
            self._driver_label.value = _CODE_DRIVES
        else:
            self._driver_label.value = f"{command.linear:+.2f} m/s  {command.angular:+.2f} rad/s"

    def show_error(self, text: str) -> None:
        """Print an exception of the callback above the picture, where it cannot be overlooked."""
        self._output.outputs = ({"output_type": "stream", "name": "stderr", "text": text},)

    def clear_error(self) -> None:
        """Remove the error."""
        self._output.outputs = ()

    def _pad(self, can_be_released: bool) -> widgets.Widget:
        self._driver_label = widgets.Label(value=_CODE_DRIVES if can_be_released else "drive with the arrows")
        drive = self._view.drive
        buttons = [
            self._button("rotate-left", "Turn left", lambda: drive(Command(0.0, ANGULAR))),
            self._button("arrow-up", "Forward", lambda: drive(Command(LINEAR, 0.0))),
            self._button("arrow-down", "Backward", lambda: drive(Command(-LINEAR, 0.0))),
            self._button("rotate-right", "Turn right", lambda: drive(Command(0.0, -ANGULAR))),
            self._button("stop", "Stop the robot", lambda: drive(Command())),
        ]
        if can_be_released:
            buttons.append(self._button("magic", "Let your code drive", self._view.automatic))
        return widgets.HBox([*buttons, self._driver_label], layout={"align_items": "center"})

    def _button(self, icon: str, tooltip: str, action: Any) -> widgets.Button:
        button = widgets.Button(icon=icon, tooltip=tooltip, layout={"width": "44px"})
        button.on_click(lambda _: action())
        return button

    def _on_play(self, change: Any) -> None:
        if not self._is_updating:
            if change["new"]:
                self._view.play()
            else:
                self._view.pause()

    def _on_slider(self, change: Any) -> None:
        if not self._is_updating and not self._view.playing:
            self._view.seek(change["new"])
