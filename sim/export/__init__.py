"""A recording for others: a GIF for a slide, an HTML page for a browser, a rosbag2 (mcap) for ROS tools.

    >>> from sim.export import to_gif, to_html, to_mcap
    >>> to_html(recording, "run.html")

`to_mcap` needs the extra `export`. All three give the same bytes for the same recording.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sim.export.exceptions import ExportError
from sim.recording import Recording

__all__ = ["ExportError", "export", "to_gif", "to_html", "to_mcap"]


def to_gif(recording: Recording, path: str | Path, *, speed: float = 1.0, fps: float = 10.0) -> Path:
    """Write an animated GIF of the live view's frames; return the path.

    Args:
        recording: the run.
        path: of the GIF.
        speed: simulated seconds in a second.
        fps: frames a second.

    Raises:
        ExportError: the speed or the frame rate makes no sense, or there are more frames than a GIF should have.
    """
    from sim.export.gif import write_gif

    return write_gif(recording, Path(path), speed, fps)


def to_html(recording: Recording, path: str | Path) -> Path:
    """Write one HTML file, with nothing to load from elsewhere, that plays the run; return the path."""
    from sim.export.page import write_page

    return write_page(recording, Path(path))


def to_mcap(recording: Recording, path: str | Path) -> Path:
    """Write a rosbag2 folder with /scan, /odom, /cmd_vel and /clock in one mcap file; return the path.

    Raises:
        ExportError: if `rosbags` is not installed, or there is something at `path` already.
    """
    from sim.export.bag import write_bag

    return write_bag(recording, Path(path))


def export(recording: Recording, path: str | Path) -> Path:
    """Write `recording` as the ending of `path` says: .gif, .html, or .mcap for a rosbag2 folder without that ending.

    Raises:
        ExportError: for another ending.
    """
    kinds: dict[str, Callable[[Recording, Path], Path]] = {".gif": to_gif, ".html": to_html, ".mcap": to_mcap}
    path = Path(path)
    write = kinds.get(path.suffix.lower())
    if write is None:
        ending = path.suffix or "a name without an ending"
        raise ExportError(f"{path}: can't export to {ending!r}: use .gif, .html or .mcap")
    return write(recording, path)
