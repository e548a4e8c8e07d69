"""Writes an animated GIF of the frames of a run, with one palette for all frames."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

from sim.export.frames import frames_of, require_pace
from sim.recording import Recording

MAX_FRAMES = 2000


def write_gif(recording: Recording, path: Path, speed: float, fps: float) -> Path:
    """Write the frames of `recording`; see `sim.export.to_gif`."""
    require_pace(recording, path, speed, fps, max_frames=MAX_FRAMES)
    images = list(frames_of(recording, speed, fps, dpi=72))
    palette = images[-1].quantize(64, dither=Image.Dither.NONE)
    frames = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    path.parent.mkdir(parents=True, exist_ok=True)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=round(1000 / fps), loop=0, optimize=False)
    return path
