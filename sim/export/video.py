"""Writes an MP4 of the frames of a run, which the program ffmpeg encodes."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from sim.export.exceptions import ExportError
from sim.export.frames import frames_of, require_pace
from sim.recording import Recording

MAX_FRAMES = 100_000


def write_video(recording: Recording, path: Path, speed: float, fps: float) -> Path:
    """Write the frames of `recording`; see `sim.export.to_mp4`."""
    require_pace(recording, path, speed, fps, max_frames=MAX_FRAMES)
    program = shutil.which("ffmpeg")
    if program is None:
        raise ExportError(f"{path}: an MP4 needs the program ffmpeg: install it, or export a .gif or .html")
    path.parent.mkdir(parents=True, exist_ok=True)
    images = frames_of(recording, speed, fps, dpi=100)
    first = next(images)
    # Players on telephones and in slides need H.264 with even sides and halved colour resolution.
    command = [program, "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{first.width}x{first.height}", "-r", f"{fps:g}", "-i", "-"]
    command += ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-pix_fmt", "yuv420p"]
    command += ["-movflags", "+faststart", str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as encoder:
        assert encoder.stdin is not None
        assert encoder.stderr is not None
        try:
            for image in (first, *images):
                encoder.stdin.write(image.tobytes())
            encoder.stdin.close()
        except BrokenPipeError:
            pass  # ffmpeg has ended; its error output explains why
        reason = encoder.stderr.read().decode(errors="replace").strip()
    if encoder.returncode != 0:
        raise ExportError(f"{path}: ffmpeg ended with status {encoder.returncode}: {reason}")
    return path
