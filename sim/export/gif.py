"""An animated GIF: the live view's frames, one palette for all of them."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

from sim.export.exceptions import ExportError
from sim.recording import Recording
from sim.view.renderer import Renderer
from sim.view.session import Replay
from sim.view.theme import LIGHT

MAX_FRAMES = 2000


def write_gif(recording: Recording, path: Path, speed: float, fps: float) -> Path:
    """Write the frames of `recording`; see `sim.export.to_gif`."""
    if not (0.0 < speed <= 1000.0 and 0.0 < fps <= 50.0):
        raise ExportError(
            f"a speed of {speed} at {fps} frames/s makes no sense: give a speed above 0, up to 50 frames/s"
        )
    replay = Replay(recording)
    start_ns, length_ns = int(recording.times_ns[0]), replay.end_ns - int(recording.times_ns[0])
    count = 1 + int(length_ns * 1e-9 / speed * fps)
    if count > MAX_FRAMES:
        raise ExportError(f"{path}: {count} frames are too many for a GIF: raise 'speed', or lower 'fps'")
    renderer = Renderer(recording.simulation, LIGHT, dpi=72)
    instants = [start_ns + round(number * speed / fps * 1e9) for number in range(count)]
    images = [renderer.draw(replay.at(instant), replay.trail(instant)) for instant in instants]
    palette = images[-1].quantize(64, dither=Image.Dither.NONE)
    frames = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    path.parent.mkdir(parents=True, exist_ok=True)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=round(1000 / fps), loop=0, optimize=False)
    return path
