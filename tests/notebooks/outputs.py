"""The text that cells of an executed notebook show."""

from __future__ import annotations

from collections.abc import Iterable

from nbformat import NotebookNode


def text_of(cells: Iterable[NotebookNode]) -> str:
    """Return all text that executed cells show."""
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    return "\n".join(output.get("text") or output.get("data", {}).get("text/plain", "") for output in outputs)
