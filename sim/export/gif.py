"""An animated GIF: the live view's frames, one palette for all of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from sim.export.exceptions import ExportError
from sim.recording import Recording
from sim.rows import newest_scan, state_at
from sim.view.renderer import Renderer
from sim.view.session import TRAIL, Frame
from sim.view.theme import LIGHT

MAX_FRAMES = 2000


def write_gif(recording: Recording, path: Path, speed: float, fps: float) -> Path:
    """Write the frames of `recording`; see `sim.export.to_gif`."""
    if not (0.0 < speed <= 1000.0 and 0.0 < fps <= 50.0):
        raise ExportError(
            f"a speed of {speed} at {fps} frames/s makes no sense: give a speed above 0, up to 50 frames/s"
        )
    start_ns, end_ns = recording.times_ns[[0, -1]].tolist()
    count = 1 + int((end_ns - start_ns) * 1e-9 / speed * fps)
    if count > MAX_FRAMES:
        raise ExportError(f"{path}: {count} frames are too many for a GIF: raise 'speed', or lower 'fps'")
    renderer = Renderer(recording.simulation, LIGHT, dpi=72)
    instants = [start_ns + round(number * speed / fps * 1e9) for number in range(count)]
    images = [_draw(renderer, recording, instant) for instant in instants]
    palette = images[-1].quantize(64, dither=Image.Dither.NONE)
    frames = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    path.parent.mkdir(parents=True, exist_ok=True)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=round(1000 / fps), loop=0, optimize=False)
    return path


def _draw(renderer: Renderer, recording: Recording, time_ns: int) -> Image.Image:
    """Return the picture of the last row that is not later than `time_ns`."""
    row = max(0, int(np.searchsorted(recording.times_ns, time_ns, side="right")) - 1)
    scans = tuple(newest_scan(recording, index, row) for index in range(len(recording.scans)))
    trail = recording.poses[: row + 1 : 1 + row // TRAIL, 0, :2]
    return renderer.draw(Frame(state_at(recording, row), scans), trail)
