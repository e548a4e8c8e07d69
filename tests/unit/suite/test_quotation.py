"""Feedback quotes the sentences of the contract whole, as students read them in the rendered notebook."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from markdown_it import MarkdownIt

from autograder import course_paths
from autograder.suite.contract import contract
from autograder.suite.quotation import quote

TABLE = r"""The **node** is called `guard`. *Stop* is a `Twist()` of zeros. `out` is 0, 1, 2, ... and
not `in`; the file, `x.py`, stays. `speed` follows (in m/s).

| node | speed | |
|---|---|---|
| `guard`, or none | above 0, \|`turn`\| below `a \| b` | `*` |
| | *up* to `<limit>` | |
| otherwise | | all &lt; 0 |

- It ends with
  exit status 0. It says so.
"""
CODE = """%%writefile x.py
def f():
    '''Do it.

    It uses `x`, and
    *more*. kwargs stay: so.
    '''
    # It ends here,
    # with 0.
"""


def markdown(source: str) -> dict[str, Any]:
    return {"cell_type": "markdown", "source": source}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The **node** is called `guard`.", "The node is called guard."),
        ("*Stop* is a `Twist()`", "Stop is a Twist() of zeros."),
        ("`out` is 0, 1, 2, ...", "out is 0, 1, 2, ... and not in; the file, x.py, stays."),
        ("the file, `x.py`, stays", "out is 0, 1, 2, ... and not in; the file, x.py, stays."),
        ("`speed` follows", "speed follows (in m/s)."),
        ("- It ends with exit status 0. It says so.", "It ends with exit status 0. It says so."),
        ("exit status 0.", "It ends with exit status 0."),
        (
            r"| `guard`, or none | above 0, \|`turn`\| below `a \| b` | `*` |",
            "guard, or none: speed above 0, |turn| below a | b, *",
        ),
        (
            r"| `guard`, or none | above 0, \|`turn`\| below `a \| b` | `*`",
            "guard, or none: speed above 0, |turn| below a | b, *",
        ),
        ("| | *up* to `<limit>` | |", "guard, or none: speed up to <limit>"),
        ("| otherwise | | all &lt; 0 |", "otherwise: all < 0"),
        ("up* to", None),
        ("| guard | 0 | 0 |", None),
        ("It flies.", None),
    ],
)
def test_a_row_or_a_sentence_is_quoted_whole_and_without_markup(text: str, expected: str | None) -> None:
    assert quote(markdown(TABLE), text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("It uses `x`", "It uses `x`, and *more*. kwargs stay: so."),
        ("kwargs stay: so.", "kwargs stay: so."),
        ("It ends here", "It ends here, with 0."),
    ],
)
def test_code_is_quoted_verbatim(text: str, expected: str) -> None:
    assert quote({"cell_type": "code", "source": CODE}, text) == expected


def rendered(source: str) -> Iterator[list[str]]:
    """Yield Markdown as another parser renders it: the cells of each row, or the text of any other block."""
    tokens, row = MarkdownIt("commonmark").enable("table").parse(source), list[str]()
    in_row = False
    for token in tokens:
        if token.type in ("tr_open", "tr_close"):
            if in_row:
                yield row
            row, in_row = [], not in_row
        elif token.type == "inline":
            text = "".join(" " if child.type == "softbreak" else child.content for child in token.children or ())
            if in_row:
                row.append(" ".join(text.split()))
            else:
                yield [" ".join(text.split())]


def cells(assignment: str) -> list[dict[str, Any]]:
    all_cells: list[dict[str, Any]] = json.loads(course_paths.source_notebook(assignment).read_text(encoding="utf-8"))[
        "cells"
    ]
    return [cell for cell in all_cells if cell["metadata"].get("course", {}).get("contract")]


@pytest.mark.parametrize("assignment", course_paths.assignments())
def test_each_sentence_of_a_contract_is_whole_and_as_another_parser_renders_it(assignment: str) -> None:
    requirements, seen_names = contract(assignment), set[str]()
    for cell in cells(assignment):
        blocks = list(rendered("".join(cell["source"])))
        code = " ".join(re.sub(r"^\s*# ?", "", "".join(cell["source"]), flags=re.MULTILINE).split())
        for name, texts in cell["metadata"]["course"]["contract"].items():
            for text in [texts] if isinstance(texts, str) else texts:
                quoted = quote(cell, text)
                assert quoted, f"{name}: {text}"
                if name not in seen_names:
                    assert quoted in requirements[name].text
                if cell["cell_type"] == "code":
                    assert quoted in code
                else:
                    assert any(contains(block, quoted) for block in blocks), quoted
        seen_names.update(cell["metadata"]["course"]["contract"])


def contains(block: list[str], quoted: str) -> bool:
    """Return whether a text is a rendered row, cell by cell in its order, or whole sentences of a rendered block."""
    if len(block) > 1:
        filled = [re.escape(column) for column in block if column]
        return re.search(".*".join(filled), quoted) is not None and len(filled) > 1
    before, match, after = block[0].partition(quoted)
    is_whole = (not before or before.rstrip()[-1] in ".?!)") and (not after or quoted[-1] in ".?!)")
    return bool(match) and is_whole
