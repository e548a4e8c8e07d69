"""Read a map's picture, PGM or PNG, into shades between 0 (black) and 1 (white).

PGM is read here (it is a dozen lines, and its faults can be named by byte or number); PNG by Pillow, asked for that
format alone. A size cap is looked at before anything is decoded.
"""

from __future__ import annotations

import io
import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from sim.exceptions import WorldError

MAX_PIXELS = 16_000_000
"""A 4000 x 4000 map: 200 m a side at 5 cm. Larger pictures are refused unread."""

MAX_BYTES = 64_000_000

_PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
# Each alternative starts with another byte, so that no file makes the match backtrack.
_PGM_HEADER = re.compile(rb"P[25]" + 3 * rb"(?:\s|#[^\n]*\n)+(\d{1,9})" + rb"\s")


@dataclass(frozen=True)
class Shades:
    """A picture: `shade` (H, W) float64 in 0..1 and `known` (H, W), False where it is transparent. Row 0 on top."""

    shade: npt.NDArray[np.float64]
    known: npt.NDArray[np.bool_]


def read_image(path: Path) -> Shades:
    """Read a .pgm (P2 or P5) or .png picture.

    Raises:
        WorldError: naming the file, what is wrong with it and what to do.
    """
    try:
        if not path.is_file():
            raise _error(path, "there is no such picture", "Put it beside the map's YAML, or correct 'image:' there")
        if path.stat().st_size > MAX_BYTES:
            raise _error(path, f"the picture is larger than {MAX_BYTES // 1_000_000} MB", "Crop it or scale it down")
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise _error(path, f"the picture can't be read ({error})", "Correct the name or the permissions") from None
    if data.startswith(_PNG_SIGNATURE):
        return _read_png(path, data)
    if data[:2] in (b"P2", b"P5"):
        shade = _read_pgm(path, data)
        return Shades(shade, np.ones(shade.shape, dtype=np.bool_))
    raise _error(path, f"neither PGM (P2, P5) nor PNG: it starts with {data[:4]!r}", "Save it as PGM or PNG")


def _read_pgm(path: Path, data: bytes) -> npt.NDArray[np.float64]:
    header = _PGM_HEADER.match(data)
    if header is None:
        raise _error(path, "the PGM's header is broken", "Write P2 or P5, then width, height and the largest value")
    width, height, largest = (int(number) for number in header.groups())
    if not 1 <= largest <= 65535:
        raise _error(path, f"the PGM's largest value is {largest}", "Give one between 1 and 65535")
    _check_size(path, width, height)
    if data.startswith(b"P2"):
        values = _plain_values(path, data[header.end() - 1 :], width * height)
    else:
        sample = np.dtype(np.uint8 if largest < 256 else ">u2")
        body, size = data[header.end() :], width * height * sample.itemsize
        if len(body) < size:
            raise _error(path, f"the PGM is cut short: it needs {size} bytes of pixels, it has {len(body)}", _AGAIN)
        values = np.frombuffer(body, dtype=sample, count=width * height).astype(np.float64)
    if values.max() > largest:
        raise _error(path, f"a pixel is {values.max():.0f}, above the PGM's largest value {largest}", _AGAIN)
    return (values / largest).reshape(height, width)


def _plain_values(path: Path, body: bytes, count: int) -> npt.NDArray[np.float64]:
    words = re.sub(rb"#[^\n]*", b"", body).split()
    if len(words) < count:
        raise _error(path, f"the PGM is cut short: {count} pixels announced, {len(words)} there", _AGAIN)
    for word in words[:count]:
        if not (word.isdigit() and len(word) < 7):
            raise _error(path, f"{word[:20].decode('latin-1')!r} is not a pixel of a P2 file", "Use whole numbers only")
    return np.array(words[:count], dtype=np.float64)


def _read_png(path: Path, data: bytes) -> Shades:
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # our own cap is lower
            with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
                _check_size(path, *image.size)
                deep = image.mode.startswith("I")
                colours = np.asarray(image if deep else image.convert("RGBA"), dtype=np.float64)
    except WorldError:
        raise
    except Exception as error:  # Pillow raises whatever its decoders meet in a damaged file
        raise _error(path, f"the PNG is broken ({error})", _AGAIN) from None
    if deep:  # 16-bit grey
        return Shades(colours / 65535.0, np.ones(colours.shape, dtype=np.bool_))
    return Shades(colours[..., :3].mean(axis=2) / 255.0, colours[..., 3] == 255.0)


def _check_size(path: Path, width: int, height: int) -> None:
    if width < 1 or height < 1:
        raise _error(path, f"the picture is {width} x {height} pixels", "Give it at least one")
    if width * height > MAX_PIXELS:
        raise _error(path, f"{width} x {height} pixels are more than {MAX_PIXELS:,}", "Crop it or scale it down")


_AGAIN = "Save the picture again"


def _error(path: Path, problem: str, remedy: str) -> WorldError:
    return WorldError(problem, remedy, path=str(path))
