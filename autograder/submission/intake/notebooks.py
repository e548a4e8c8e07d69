"""Reads the cells of a notebook that any tool may have saved.

JupyterLab opens more than nbformat's schema allows: cell ids before 4.5, outputs without a name, code cells without
outputs, unknown keys. Only the type, the source, the metadata and the id of a cell are read.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from itertools import chain, count
from typing import Any

from autograder.submission.json_size import exceeds, outside_strings

CELL_TYPES = ("code", "markdown", "raw")
# Limits for a notebook whose outputs are dropped. They bound the number of values that a parser creates.
MAX_STRINGS = 1_000_000
MAX_STRUCTURE = 8 * 1024 * 1024  # bytes outside of strings
MAX_VALUES = 2_000_000  # commas and brackets outside of strings; three bytes of JSON can take up sixty in memory
MAX_CELLS = 20_000
MAX_METADATA = 10_000  # characters of a cell's metadata as JSON; longer metadata is left out
_RELEVANT_METADATA = ("nbgrader", "course")
_ID = re.compile(r"[a-zA-Z0-9_-]{1,64}")

Cell = dict[str, Any]


def read_cells(data: bytes) -> list[Cell]:
    """Return the cells of a notebook, each with `cell_type`, `source`, `metadata` and a unique `id`.

    Raises:
        ValueError: the bytes are not a notebook of a known format.
    """
    notebook = _parse(data)
    version = notebook.get("nbformat")
    if version not in (3, 4):
        raise ValueError(f"its nbformat is {str(version)[:20]}, but this tool reads 4")
    cells = _cells_of_worksheets(notebook) if version == 3 else notebook.get("cells")
    if not isinstance(cells, list):
        raise ValueError("it has no list of cells")
    if len(cells) > MAX_CELLS:
        raise ValueError(f"it has more than {MAX_CELLS:,} cells")
    if version == 3:
        cells = [_upgraded(cell) for cell in cells]
    ids: set[str] = set()
    # They are shared by all cells, so that the search for a free one takes time proportional to their number.
    spare_ids = (f"cell-{number}" for number in count(len(cells)))
    return [_cell(cell, number, ids, spare_ids) for number, cell in enumerate(cells)]


def without_outputs(data: bytes) -> bytes:
    """Return a notebook's bytes without its outputs, or the same bytes if they are not a notebook."""
    if not _is_simple(data):
        return data
    try:
        notebook = _parse(data)
        for cell in notebook["cells"]:
            cell.pop("outputs", None)
        return json.dumps(notebook, ensure_ascii=True).encode()
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return data


def _is_simple(data: bytes) -> bool:
    """Return whether parsing a JSON text can only create a limited number of values."""
    structure = outside_strings(data, 2 * MAX_STRINGS)
    return structure is not None and len(structure) <= MAX_STRUCTURE


def _parse(data: bytes) -> Cell:
    try:
        text = data.decode(json.detect_encoding(data)).removeprefix("\ufeff")
        if exceeds(text.encode("utf-8", "surrogatepass"), MAX_VALUES, 2 * MAX_VALUES):
            raise ValueError(f"it holds more than {MAX_VALUES:,} values: clear its outputs")
        notebook = json.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(notebook, dict):
        raise ValueError("it is not a JSON object")
    return notebook


def _cells_of_worksheets(notebook: Cell) -> list[Any] | None:
    """Return the cells of a notebook of format 3, from 2014 or earlier, or None if it has no list of them."""
    worksheets = notebook.get("worksheets")
    if not isinstance(worksheets, list):
        return None
    cells: list[Any] = []
    for sheet in worksheets:
        if not isinstance(sheet, dict) or not isinstance(sheet.get("cells"), list):
            return None
        cells += sheet["cells"]
    return cells


def _upgraded(cell: object) -> object:
    """Return a cell of format 3 in format 4. nbformat would also validate it, which takes 0.2 ms."""
    kind = cell.get("cell_type") if isinstance(cell, dict) else None
    if not isinstance(cell, dict) or kind not in ("code", "heading", "html"):
        return cell
    if kind == "code":
        return {**cell, "source": cell.get("input", "")}
    source = _source(cell)
    if kind == "heading" and source is not None:
        level = cell.get("level")
        marks = "#" * level if isinstance(level, int) and 1 <= level <= 6 else "#"
        source = f"{marks} {' '.join(source.splitlines())}"
    return {**cell, "cell_type": "markdown", "source": source}


def _source(cell: Cell) -> str | None:
    """Return the source of a cell, or None if it is not text."""
    source = cell.get("source", "")
    if isinstance(source, list) and all(isinstance(line, str) for line in source):
        source = "".join(source)
    return source if isinstance(source, str) else None


def _cell(cell: object, number: int, ids: set[str], spare_ids: Iterator[str]) -> Cell:
    if not isinstance(cell, dict) or cell.get("cell_type") not in CELL_TYPES:
        raise ValueError(f"cell {number} is not a code, Markdown or raw cell")
    source = _source(cell)
    if source is None:
        raise ValueError(f"the source of cell {number} is not text")
    id = cell.get("id")
    if not isinstance(id, str) or not _ID.fullmatch(id) or id in ids:
        id = next(name for name in chain((f"cell-{number}",), spare_ids) if name not in ids)
    ids.add(id)
    return {
        "cell_type": cell["cell_type"],
        "id": id,
        "metadata": _metadata(cell.get("metadata")),
        "source": source.replace("\r\n", "\n"),
    }


def _metadata(metadata: object) -> dict[str, Any]:
    """Return the relevant metadata of a cell. Other tools' metadata would only take up memory."""
    if not isinstance(metadata, dict):
        return {}
    relevant = {name: metadata[name] for name in _RELEVANT_METADATA if name in metadata}
    return relevant if len(json.dumps(relevant)) <= MAX_METADATA else {}
