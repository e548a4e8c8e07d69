"""Writes and reads the executed notebook beside a result. Its size is limited, and its content is untrusted."""

from __future__ import annotations

import json
from typing import Any

from nbformat import NotebookNode

from autograder.grade.bounded_json import NOTEBOOK_VALUES, read_json

MAX_BYTES = 48 * 1024 * 1024


def encode(notebook: NotebookNode) -> bytes:
    """Return the bytes of an executed notebook, without outputs if they make it too large.

    Each text is one string, because a list of its lines, as nbformat writes it, could have millions of values.
    """
    data = _to_json(notebook)
    if len(data) <= MAX_BYTES:
        return data
    cells = [{**cell, "outputs": []} if cell.cell_type == "code" else cell for cell in notebook.cells]
    return _to_json({**notebook, "cells": cells})


def decode(data: bytes) -> list[NotebookNode]:
    """Return the code cells of an executed notebook, each with a text and with outputs that are objects.

    Nothing else is checked, because a validation of the notebook's format can take a minute.

    Raises:
        ValueError: `data` is not a notebook, or exceeds a limit.
        RecursionError: `data` is nested too deeply.
    """
    notebook = read_json(data, NOTEBOOK_VALUES, is_strict=False)
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    if not isinstance(cells, list) or not all(isinstance(cell, dict) for cell in cells):
        raise ValueError("it is not a notebook")
    return [_code_cell(cell) for cell in cells if cell.get("cell_type") == "code"]


def _to_json(notebook: Any) -> bytes:
    # A lone surrogate in a cell or its output cannot be encoded as UTF-8.
    return json.dumps(notebook, ensure_ascii=False, sort_keys=True).encode("utf-8", errors="replace")


def _code_cell(cell: dict[str, Any]) -> NotebookNode:
    source, outputs, metadata = cell.get("source"), cell.get("outputs"), cell.get("metadata", {})
    if isinstance(source, list) and all(isinstance(line, str) for line in source):  # written by an earlier version
        source = "".join(source)
    if not isinstance(source, str) or not isinstance(outputs, list) or not isinstance(metadata, dict):
        raise ValueError("it has a cell without a text or outputs")
    if not all(isinstance(output, dict) for output in outputs):
        raise ValueError("it has outputs that are not objects")
    return NotebookNode({**cell, "source": source, "metadata": NotebookNode(metadata)})
