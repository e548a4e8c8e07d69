"""The player of a recorded run: self-contained HTML with the run, a style sheet and a script.

The same player is used in notebooks, exported pages and the autograder's feedback. Without its script, for example on
paper or in a notebook that is not trusted, it shows a picture.
"""

from __future__ import annotations

import html
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sim.recording import Recording
from sim.view.figures import plot
from sim.view.marks import to_json
from sim.view.picture import DPI, Picture
from sim.view.run_data import Margin, encode
from sim.view.theme import DARK, LIGHT, Theme

_HERE = Path(__file__).parent


def script_of(*parts: str) -> str:
    """Return the script of the drawing, followed by the JavaScript files `parts` of this folder, without a suffix."""
    shared = ("player_data", "player_drawing", "player_view", "player_lists", "player_panel")
    texts = ((_HERE / f"{part}.js").read_text(encoding="utf-8") for part in (*shared, *parts))
    return "\n".join([f"const LOOK = {to_json()};", *texts])


SCRIPT = f'(() => {{\n"use strict";\n{script_of("player")}\n}})();'
"""The script that makes every `div.run-player` above it interactive."""


class Player:
    """A player for a recorded run, in a notebook or in a page."""

    def __init__(
        self,
        recording: Recording,
        *,
        margins: Sequence[Margin] = (),
        still: Picture | None = None,
        theme: str = "light",
        speed: float = 1.0,
        play: bool = False,
        note: str = "",
    ) -> None:
        """Encode the run.

        Args:
            recording: the run.
            margins: the rules for the run, each shown as a time line.
            still: the picture that is shown where the player cannot run, by default the track.
            theme: "light", "dark", or "auto" to follow the reader's settings.
            speed: the initial number of simulated seconds per second: 0.25, 0.5, 1, 2 or 4.
            play: whether the run plays once when it becomes visible. If it broke a rule, that instant is shown instead.
            note: the text for the instant at which a rule was broken.
        """
        self.recording = recording
        self._still = still or plot(recording)
        self._data = encode(recording, self._still.alt, margins, note=note)
        self._options = {"data-theme": theme, "data-speed": f"{speed:g}", **({"data-play": "yes"} if play else {})}

    def __repr__(self) -> str:
        return self._still.alt

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return HTML, and PNG for viewers without HTML."""
        bundle, metadata = self._still._repr_mimebundle_()
        player = markup(self._data, _image(self._still), **self._options)
        bundle["text/html"] = f"<style>{style()}</style>{player}<script>{SCRIPT}</script>"
        return bundle, metadata


def markup(data: str, still: str = "", **attributes: str) -> str:
    """Return the HTML of a player, for a page that has `style()` and, below all players, `SCRIPT`.

    Args:
        data: the result of `encode`.
        still: the HTML of the picture for paper, with the class "run-still".
        attributes: the attributes of the element: its `id`, the options of a `Player`, `data-first` for the player to
            which a link without a run refers, and `data-alone` for a player that handles all keys of its page.
    """
    attribute_text = "".join(f' {name}="{html.escape(value, quote=True)}"' for name, value in attributes.items())
    name = "run-player run-still-there" if still else "run-player"
    return (
        f'<div class="{name}" data-lm-suppress-shortcuts="true"{attribute_text}>{still}'
        f'<script type="application/json">{data}</script></div>'
    )


def style() -> str:
    """Return the style sheet of players, with the themes' colours."""
    light, dark = _variables(LIGHT), _variables(DARK)
    return (
        f".run-player {{ {light} }}\n"
        f'@media (prefers-color-scheme: dark) {{ .run-player:not([data-theme="light"]) {{ {dark} }} }}\n'
        f'.run-player[data-theme="dark"] {{ {dark} }}\n'
    ) + sheet()


def sheet() -> str:
    """Return the style sheet of players, without colours."""
    return (_HERE / "player.css").read_text(encoding="utf-8")


def page(recording: Recording, margins: Sequence[Margin] = ()) -> str:
    """Return a page that plays a run, light or dark as in the reader's settings."""
    title = html.escape(f"{recording.simulation.world.name}: {recording.times[-1]:.1f} s")
    still = plot(recording)
    options = {"data-theme": "auto", "data-alone": "yes"}
    player = markup(encode(recording, still.alt, margins), _image(still, dpi=96), **options)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n<title>{title}</title>\n'
        f"<style>\n{style()}:root {{ color-scheme: light dark; {_variables(LIGHT)} }}\n"
        f"@media (prefers-color-scheme: dark) {{ :root {{ {_variables(DARK)} }} }}\n"
        "body { margin: 0; background: var(--run-paper); color: var(--run-ink); }\n"
        "body { font: 15px/1.5 system-ui, sans-serif; }\n"
        "main { max-width: 70rem; margin: 0 auto; padding: .5rem; }\n"
        "h1 { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }\n"
        f"</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n{player}\n</main>\n<script>{SCRIPT}</script>\n"
        "</body>\n</html>\n"
    )


def _image(still: Picture, dpi: int = DPI) -> str:
    """Return the HTML of the picture that is shown where the player cannot run."""
    return still.html(dpi).replace("<img ", '<img class="run-still" ', 1)


def _variables(theme: Theme) -> str:
    return "".join(f"--run-{name}:{colour};" for name, colour in theme.named.items())
