"""Finds the sentence in a notebook's cell that contains a given text, and renders it as a student reads it.

Authors quote the Markdown of a requirement, or a part of it. `quote` returns the text as it is on the page: the whole
row of the table, or the whole sentence, without markup.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import mistune

MARK = "\ue000"  # marks the start of code or emphasis, which may begin a sentence in lower case
_SENTENCE_END = r"[.!?][)\"'”]*(?<!\.\.)"  # end of a sentence, not an ellipsis
_AT_SENTENCE_END = re.compile(rf"{_SENTENCE_END}$")
_SENTENCE_GAP = re.compile(rf"{_SENTENCE_END}\s+(?![a-z])")  # the gap between two sentences
_BAR = re.compile(r"(?<!\\)\|")

Token = Mapping[str, Any]
_markdown = mistune.create_markdown(renderer=None, plugins=["table", "strikethrough"])


@dataclass(frozen=True)
class Row:
    """A row of a table.

    Attributes:
        head: the names of the columns in the head of the table.
        cells: its text in each column, with marks.
        label: the first cell; if it is empty, the label of the row above.
    """

    head: tuple[str, ...]
    cells: tuple[str, ...]
    label: str

    @property
    def text(self) -> str:
        """The row in words: its label and the other cells. If there are several, their columns' names precede them."""
        heads = self.head[1:] if len(self.cells) > 2 else ("",)
        values = (f"{head} {cell}".strip() for head, cell in zip(heads, self.cells[1:], strict=False) if cell)
        return _without_marks(": ".join(part for part in (self.label, ", ".join(values)) if part))


def quote(cell: Mapping[str, Any], text: str) -> str | None:
    """Return the row or the sentence of a notebook's cell that contains `text`, as the page shows it, or None.

    Args:
        cell: the cell. Markdown is rendered, code is not.
        text: a part of the cell's source: a row with its bars, a bullet, or a sentence or a part of one.
    """
    source = "".join(cell["source"])
    pieces: Iterable[str | Row]
    if cell["cell_type"] != "markdown":
        query, pieces = " ".join(text.split()), _code_pieces(source)
    elif text.startswith("|"):
        columns = [
            _without_marks(_inline(column)) for column in _BAR.split(text.strip().removeprefix("|").removesuffix("|"))
        ]
        rows = (piece for piece in _pieces(source) if isinstance(piece, Row))
        return next((row.text for row in rows if [_without_marks(column) for column in row.cells] == columns), None)
    else:
        query, pieces = _without_marks(_inline(text.removeprefix("- "))), _pieces(source)
    return next((quoted for piece in pieces if (quoted := _quote_of(piece, query)) is not None), None)


def _quote_of(piece: str | Row, query: str) -> str | None:
    """Return the text of a row, or the sentences of a paragraph, that contain `query`; None if it does not occur."""
    if isinstance(piece, Row):
        return piece.text if any(query in _without_marks(cell) for cell in piece.cells) else None
    plain = _without_marks(piece)
    start = plain.find(query)
    if start < 0:
        return None
    end = start + len(query)
    boundaries = [
        0,
        *(len(_without_marks(piece[: match.end()])) for match in _SENTENCE_GAP.finditer(piece)),
        len(plain),
    ]
    if not _AT_SENTENCE_END.search(plain[:start].rstrip()):
        start = max(boundary for boundary in boundaries if boundary <= start)
    if not _AT_SENTENCE_END.search(query):
        end = min(boundary for boundary in boundaries if boundary >= end)
    return plain[start:end].strip()


@cache
def _pieces(source: str) -> tuple[str | Row, ...]:
    """Return the paragraphs, bullets and rows of a Markdown text, with marks."""
    tokens, _ = _markdown.parse(source)
    return tuple(_blocks(tokens))  # type: ignore[arg-type]


def _blocks(tokens: Iterable[Token]) -> Iterator[str | Row]:
    for token in tokens:
        if token["type"] == "table":
            yield from _rows(token)
        elif token["type"] in ("paragraph", "block_text", "heading"):
            yield _text(token["children"])
        else:
            yield from _blocks(token.get("children", ()))


def _rows(table: Token) -> Iterator[Row]:
    head, *bodies = table["children"]
    head_cells, label = tuple(_without_marks(name) for name in _cells(head)), ""
    for row in (row for body in bodies for row in body["children"]):
        cells = _cells(row)
        label = cells[0] or label
        yield Row(head_cells, cells, label)


def _cells(row: Token) -> tuple[str, ...]:
    # In a table, bars are escaped even inside code.
    return tuple(_text(cell["children"]).replace("\\|", "|") for cell in row["children"])


def _inline(source: str) -> str:
    """Return the text of a part of a Markdown paragraph, with marks."""
    state = _markdown.inline.state_cls({})
    state.src = source.strip()
    return _text(_markdown.inline.parse(state)).replace("\\|", "|")


def _text(tokens: Sequence[Token]) -> str:
    """Return the text of the tokens of a paragraph, with marks."""
    return " ".join("".join(_raw(token) for token in tokens).split())


def _raw(token: Token) -> str:
    kind = token["type"]
    if kind in ("softbreak", "linebreak"):
        return " "
    if kind == "codespan":
        return MARK + str(token["raw"])
    if "children" in token:
        mark = MARK if kind in ("strong", "emphasis") else ""
        return mark + "".join(_raw(child) for child in token["children"])
    return html.unescape(token["raw"]) if kind == "text" else ""


def _code_pieces(source: str) -> list[str]:
    """Return the paragraphs of a cell's docstrings and comments, and its blocks of code."""
    blocks = re.split(r'"""|\'\'\'|\n\s*\n', re.sub(r"^\s*# ?", "", source, flags=re.MULTILINE))
    return [" ".join(block.split()) for block in blocks]


def _without_marks(text: str) -> str:
    return text.replace(MARK, "")
