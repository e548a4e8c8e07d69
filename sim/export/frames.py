"""Draws the frames of a recording, for a GIF or a video."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from sim.export.exceptions import ExportError
from sim.recording import Recording
from sim.rows import newest_scan, state_at
from sim.view.renderer import Renderer
from sim.view.session import TRAIL, Frame
from sim.view.theme import LIGHT


def require_pace(recording: Recording, path: Path, speed: float, fps: float, *, max_frames: int) -> None:
    """Raise an ExportError if the speed or the frame rate is invalid, or if there are more than `max_frames` frames."""
    if not (0.0 < speed <= 1000.0 and 0.0 < fps <= 50.0):
        raise ExportError(
            f"a speed of {speed} at {fps} frames/s makes no sense: give a speed above 0, up to 50 frames/s"
        )
    count = _count_frames(recording, speed, fps)
    if count > max_frames:
        format_name = path.suffix.lstrip(".").upper()
        article = "an" if format_name == "MP4" else "a"
        raise ExportError(
            f"{path}: {count} frames are too many for {article} {format_name}: raise 'speed', or lower 'fps'"
        )


def frames_of(recording: Recording, speed: float, fps: float, *, dpi: int) -> Iterator[Image.Image]:
    """Yield the frames as RGB images of the same size, the first at the start of the run."""
    renderer = Renderer(recording.simulation, LIGHT, dpi=dpi)
    start_ns = int(recording.times_ns[0])
    for number in range(_count_frames(recording, speed, fps)):
        yield _draw(renderer, recording, start_ns + round(number * speed / fps * 1e9))


def _count_frames(recording: Recording, speed: float, fps: float) -> int:
    start_ns, end_ns = recording.times_ns[[0, -1]].tolist()
    return 1 + int((end_ns - start_ns) * 1e-9 / speed * fps)


def _draw(renderer: Renderer, recording: Recording, time_ns: int) -> Image.Image:
    """Draw the last row that is not later than `time_ns`."""
    row = max(0, int(np.searchsorted(recording.times_ns, time_ns, side="right")) - 1)
    scans = tuple(newest_scan(recording, index, row) for index in range(len(recording.scans)))
    trail = recording.poses[: row + 1 : 1 + row // TRAIL, 0, :2]
    return renderer.draw(Frame(state_at(recording, row), scans), trail)
