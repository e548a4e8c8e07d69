"""Creates the outputs of an autograded notebook: the student's own outputs, and the scores with their feedback.

nbgrader reads the points of a cell from its outputs (`determine_grade`). An error or text on stderr means 0, a number
as `execute_result` means that many points, and no output means full marks. A grade cell therefore gets exactly one
`execute_result`, a float. The feedback is `display_data`, which nbgrader ignores.
"""

from __future__ import annotations

import base64
import binascii
import re
from collections.abc import Iterable
from typing import Any

from nbformat import NotebookNode
from nbformat.v4 import new_output

from autograder.plain_text import clean
from autograder.report.feedback.model import CheckView, GroupView, PageView
from autograder.report.feedback.pages import environment
from autograder.report.feedback.text import number
from autograder.result.causes import FAILED_AS_WELL

PICTURES = ("image/png", "image/jpeg")
# Limit for colour codes in a text. nbconvert's run time is quadratic in their number, and in the length of each.
MAX_COLOURS = 1000
_TERMINAL_CODE = re.compile(r"\[(?:(?P<colour>[0-9;]{0,30}m)|[0-?]{0,30}[ -/]{0,3}[@-~])")


def grade_outputs(points: float, page: PageView, group: GroupView, *, first: bool) -> list[NotebookNode]:
    """Return the outputs of a locked grade cell.

    Args:
        points: the points that nbgrader records.
        page: content of the feedback page.
        group: the checks that count towards the cell.
        first: whether this is the notebook's first grade cell, which also gets the diagnosis.
    """
    html = environment().get_template("group.html.j2").render(page=page, group=group, first=first)
    lines = [line for check in group.checks for line in _lines(check)]
    lines += [f"{other.count} did not pass with: {other.cause.title}" for other in group.elsewhere]
    outputs = [
        new_output("execute_result", {"text/plain": str(float(points))}, execution_count=1),
        new_output("display_data", {"text/html": html, "text/plain": clean("\n".join(lines)) or number(points)}),
    ]
    for picture in group.pictures:
        if picture.uri is not None:
            data = {"image/png": picture.uri.partition(",")[2], "text/plain": clean(picture.caption)}
            outputs.append(new_output("display_data", data, metadata={"image/png": {"alt": clean(picture.caption)}}))
    return outputs


def _lines(check: CheckView) -> list[str]:
    """Return a check, and the checks that failed with it, as lines of text."""
    lines = [f"[{check.result.outcome.text}] {check.result.title} {check.message}".strip()]
    if check.also_failed:
        lines += [FAILED_AS_WELL, *(line for other in check.also_failed for line in _lines(other))]
    return lines + ([check.not_checked] if check.not_checked else [])


def sanitized_outputs(outputs: Iterable[Any]) -> list[NotebookNode]:
    """Return the text and pictures of a student's outputs.

    HTML, SVG, scripts, widgets and metadata are removed, because feedback and formgrader would not escape them.
    """
    safe = []
    for output in outputs:
        kind = output.get("output_type")
        if kind == "stream":
            name = "stderr" if output.get("name") == "stderr" else "stdout"
            safe.append(new_output("stream", name=name, text=_text(output.get("text"))))
        elif kind == "error":
            traceback = output.get("traceback")
            lines = traceback if isinstance(traceback, list) else []
            names = {name: _text(output.get(name)) for name in ("ename", "evalue")}
            safe.append(new_output("error", **names, traceback=[_text(line) for line in lines]))
        elif kind in ("display_data", "execute_result") and isinstance(output.get("data"), dict):
            data = _safe_data(output["data"])
            if data:
                safe.append(new_output("display_data", data))
    return safe


def _safe_data(bundle: dict[str, Any]) -> dict[str, str]:
    safe = {media: data for media in PICTURES if (data := _picture(bundle.get(media))) is not None}
    if "text/plain" in bundle:
        safe["text/plain"] = _text(bundle["text/plain"])
    return safe


def _picture(value: object) -> str | None:
    """Return Base64 data in canonical form, or None if `value` is not valid."""
    if isinstance(value, list):
        value = "".join(part for part in value if isinstance(part, str))
    if not isinstance(value, str):
        return None
    try:
        return base64.b64encode(base64.b64decode("".join(value.split()), validate=True)).decode("ascii")
    except (binascii.Error, ValueError):
        return None


def _text(value: object) -> str:
    """Return cleaned text with terminal colours, which pages render, or an empty string for other types."""
    if isinstance(value, list):
        value = "".join(part for part in value if isinstance(part, str))
    if not isinstance(value, str):
        return ""
    first, *parts = value.split("\x1b")
    keeps_colours = len(parts) <= MAX_COLOURS
    return clean(first) + "".join(_after_escape(part, keeps_colours) for part in parts)


def _after_escape(part: str, keeps_colours: bool) -> str:
    """Return the cleaned text after an escape character. Only colour codes are kept, if `keeps_colours` is set."""
    code = _TERMINAL_CODE.match(part)
    if code is None:
        return clean(part)
    text = clean(part[code.end() :])
    return f"\x1b{code[0]}{text}" if keeps_colours and code["colour"] is not None else text
