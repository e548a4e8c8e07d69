"""A finished figure, which a notebook displays and which can be converted to PNG, SVG or HTML.

It uses `matplotlib.figure.Figure` without pyplot: nothing is registered, no backend is chosen, and the result is the
same in a notebook, in a test and in the grader. The same drawing gives the same bytes.
"""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import matplotlib
from matplotlib.figure import Figure

from sim.view.theme import STYLE

DPI = 144


@dataclass(frozen=True)
class Picture:
    """A figure with its alternative text."""

    figure: Figure
    alt: str

    def png(self, dpi: int = DPI) -> bytes:
        """Return the picture as PNG bytes."""
        return self._bytes("png", dpi, {"Software": None, "Description": self.alt})

    def svg(self) -> bytes:
        """Return the picture as SVG bytes, with letters as outlines."""
        return self._bytes("svg", DPI, {"Date": None, "Creator": None, "Description": self.alt})

    def save(self, path: str | Path, dpi: int = DPI) -> Path:
        """Write the picture to `path`, whose name ends in .png or .svg, and return the path.

        Raises:
            ValueError: the name has another suffix.
        """
        path = Path(path)
        kind = path.suffix.lower()
        if kind not in (".png", ".svg"):
            suffix = repr(kind) if kind else "without a suffix"
            raise ValueError(f"{path}: a picture is saved as .png or .svg, not {suffix}")
        path.write_bytes(self.png(dpi) if kind == ".png" else self.svg())
        return path

    def _bytes(self, kind: str, dpi: int, metadata: Mapping[str, str | None]) -> bytes:
        stream = io.BytesIO()
        with matplotlib.rc_context(cast(Any, STYLE)):
            self.figure.savefig(stream, format=kind, dpi=dpi, metadata=dict(metadata))
        return stream.getvalue()

    def _repr_png_(self) -> bytes:
        return self.png()

    def html(self, dpi: int = DPI) -> str:
        """Return the picture as an HTML element, with its alternative text."""
        encoded_png = base64.b64encode(self.png(dpi)).decode("ascii")
        width = round(self.figure.get_figwidth() * 96)
        text = html.escape(self.alt, quote=True)
        return f'<img alt="{text}" width="{width}" style="max-width:100%" src="data:image/png;base64,{encoded_png}">'

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return HTML, which contains the alternative text, and PNG for viewers that remove images from HTML."""
        encoded_png = base64.b64encode(self.png()).decode("ascii")
        width = round(self.figure.get_figwidth() * 96)
        bundle = {"text/html": self.html(), "image/png": encoded_png, "text/plain": self.alt}
        return bundle, {"image/png": {"alt": self.alt, "width": width}}
