"""Exports a recording as a GIF or MP4 for slides, an HTML page for a browser, or a rosbag2 (mcap) for ROS tools.

    >>> from sim.export import to_gif, to_html, to_mcap, to_mp4
    >>> to_html(recording, "run.html")

`to_mcap` needs the extra `export`, and `to_mp4` the program ffmpeg. All except `to_mp4` write the same bytes for the
same run.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sim.export.exceptions import ExportError
from sim.recording import Recording

__all__ = ["ExportError", "export", "to_gif", "to_html", "to_mcap", "to_mp4"]


def to_gif(recording: Recording, path: str | Path, *, speed: float = 1.0, fps: float = 10.0) -> Path:
    """Write an animated GIF of the frames of a run; return the path.

    Args:
        recording: the run.
        path: the path of the GIF.
        speed: simulated seconds per second.
        fps: frames per second.

    Raises:
        ExportError: the speed or the frame rate is invalid, or a GIF would have too many frames.
    """
    from sim.export.gif import write_gif

    return write_gif(recording, Path(path), speed, fps)


def to_mp4(recording: Recording, path: str | Path, *, speed: float = 1.0, fps: float = 25.0) -> Path:
    """Write the frames of a run as an MP4; return the path.

    Args:
        recording: the run.
        path: the path of the MP4.
        speed: simulated seconds per second.
        fps: frames per second.

    Raises:
        ExportError: ffmpeg is not installed or fails, or the speed or the frame rate is invalid.
    """
    from sim.export.video import write_video

    return write_video(recording, Path(path), speed, fps)


def to_html(recording: Recording, path: str | Path) -> Path:
    """Write a self-contained HTML file that plays the run; return the path."""
    from sim.export.page import write_page

    return write_page(recording, Path(path))


def to_mcap(recording: Recording, path: str | Path) -> Path:
    """Write a rosbag2 folder with /scan, /odom, /cmd_vel and /clock in one mcap file; return the path.

    Raises:
        ExportError: `rosbags` is not installed, or `path` already exists.
    """
    from sim.export.bag import write_bag

    return write_bag(recording, Path(path))


def export(recording: Recording, path: str | Path, **options: float) -> Path:
    """Write `recording` in the format of the suffix of `path`: .gif, .mp4, .html, or .mcap for a rosbag2 folder.

    Args:
        recording: the run.
        path: the path of the export. The name of a rosbag2 folder does not include the suffix.
        options: `speed` and `fps` of a GIF or an MP4.

    Raises:
        ExportError: the suffix is unknown, or the format does not have the options.
    """
    videos: dict[str, Callable[..., Path]] = {".gif": to_gif, ".mp4": to_mp4}
    writers: dict[str, Callable[..., Path]] = {**videos, ".html": to_html, ".mcap": to_mcap}
    path = Path(path)
    write = writers.get(path.suffix.lower())
    if write is None:
        suffix = repr(path.suffix) if path.suffix else "a name without a suffix"
        raise ExportError(f"{path}: can't export to {suffix}: use .gif, .mp4, .html or .mcap")
    if options and path.suffix.lower() not in videos:
        raise ExportError(f"{path}: only a .gif or .mp4 has {' and '.join(sorted(options))}: leave it out")
    return write(recording, path, **options)
