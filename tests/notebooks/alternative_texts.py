"""Find images without alternative text in executed notebooks."""

from __future__ import annotations

import re

from nbformat import NotebookNode

_IMG = re.compile(r"<img\b[^>]*>", re.IGNORECASE)
_ALT = re.compile(r"""\balt=(["'])\s*[^"'\s]""", re.IGNORECASE)


def images_without_alt(executed: NotebookNode) -> list[str]:
    """Return the ids of the cells of an executed notebook that show an image without alternative text."""
    return [
        cell.id for cell in executed.cells if any(_lacks_alternative_text(output) for output in cell.get("outputs", []))
    ]


def _lacks_alternative_text(output: NotebookNode) -> bool:
    data, metadata = output.get("data", {}), output.get("metadata", {})
    html = "".join(data.get("text/html", ""))
    if any(not _ALT.search(tag) for tag in _IMG.findall(html)):
        return True
    images = [kind for kind in data if kind.startswith("image/")]
    # JupyterLab shows the HTML if there is any. Otherwise the metadata hold the alternative text of an image.
    return not html and any(not str(metadata.get(kind, {}).get("alt", "")).strip() for kind in images)
