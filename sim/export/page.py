"""One HTML file that plays a run: the player of `sim.view`, on a page of its own.

It loads nothing, so that it opens from a disk or an e-mail. It stands still until it is asked to play.
"""

from __future__ import annotations

from pathlib import Path

from sim.recording import Recording
from sim.view.player import page


def write_page(recording: Recording, path: Path) -> Path:
    """Write `recording`; see `sim.export.to_html`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page(recording), encoding="utf-8")
    return path
