"""Writes an HTML file in which the player of `sim.view` shows a run.

The page loads nothing, so that it can be opened from a disk or an e-mail. The run does not start to play by itself.
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
