"""Reads a map's picture, PGM or PNG, as shades between 0 (black) and 1 (white).

This module decodes PGM, which takes a dozen lines and allows precise error messages. Pillow decodes PNG, and no other
format. The size is checked before anything is decoded.
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
"""A map of 4000 x 4000 pixels, 200 m a side at 5 cm. Larger pictures are rejected before they are decoded."""

MAX_BYTES = 64_000_000

_PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
# Each alternative starts with a different byte, so that the match never backtracks.
_PGM_HEADER = re.compile(rb"P[25]" + 3 * rb"(?:\s|#[^\n]*\n)+(\d{1,9})" + rb"\s")


@dataclass(frozen=True)
class Shades:
    """A picture: `shade` (H, W) float64 in 0..1 and `known` (H, W), False where it is transparent. Row 0 is the top."""

    shade: npt.NDArray[np.float64]
    known: npt.NDArray[np.bool_]


def read_image(path: Path) -> Shades:
    """Read a .pgm (P2 or P5) or .png picture.

    Raises:
        WorldError: the picture cannot be read.
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
    width, height, max_value = (int(number) for number in header.groups())
    if not 1 <= max_value <= 65535:
        raise _error(path, f"the PGM's largest value is {max_value}", "Give one between 1 and 65535")
    _check_size(path, width, height)
    if data.startswith(b"P2"):
        values = _plain_values(path, data[header.end() - 1 :], width * height)
    else:
        sample = np.dtype(np.uint8 if max_value < 256 else ">u2")
        body, size = data[header.end() :], width * height * sample.itemsize
        if len(body) < size:
            raise _error(
                path, f"the PGM is cut short: it needs {size} bytes of pixels, but has {len(body)}", _SAVE_AGAIN
            )
        values = np.frombuffer(body, dtype=sample, count=width * height).astype(np.float64)
    if values.max() > max_value:
        raise _error(path, f"a pixel is {values.max():.0f}, above the PGM's largest value {max_value}", _SAVE_AGAIN)
    return (values / max_value).reshape(height, width)


def _plain_values(path: Path, body: bytes, count: int) -> npt.NDArray[np.float64]:
    tokens = re.sub(rb"#[^\n]*", b"", body).split()
    if len(tokens) < count:
        raise _error(path, f"the PGM is cut short: it needs {count} pixels, but has {len(tokens)}", _SAVE_AGAIN)
    for token in tokens[:count]:
        if not (token.isdigit() and len(token) < 7):
            raise _error(
                path, f"{token[:20].decode('latin-1')!r} is not a pixel of a P2 file", "Use whole numbers only"
            )
    return np.array(tokens[:count], dtype=np.float64)


def _read_png(path: Path, data: bytes) -> Shades:
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # `MAX_PIXELS` is lower than Pillow's limit
            with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
                _check_size(path, *image.size)
                is_16_bit = image.mode.startswith("I")
                colours = np.asarray(image if is_16_bit else image.convert("RGBA"), dtype=np.float64)
    except WorldError:
        raise
    except Exception as error:  # for a damaged file, Pillow's decoders raise various exceptions
        raise _error(path, f"the PNG is broken ({error})", _SAVE_AGAIN) from None
    if is_16_bit:  # 16-bit grey
        return Shades(colours / 65535.0, np.ones(colours.shape, dtype=np.bool_))
    return Shades(colours[..., :3].mean(axis=2) / 255.0, colours[..., 3] == 255.0)


def _check_size(path: Path, width: int, height: int) -> None:
    if width < 1 or height < 1:
        raise _error(path, f"the picture is {width} x {height} pixels", "Give it at least one")
    if width * height > MAX_PIXELS:
        raise _error(path, f"{width} x {height} pixels are more than {MAX_PIXELS:,}", "Crop it or scale it down")


_SAVE_AGAIN = "Save the picture again"


def _error(path: Path, problem: str, remedy: str) -> WorldError:
    return WorldError(problem, remedy, path=str(path))
