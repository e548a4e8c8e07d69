"""Draw the parts of the autograder and a submission's path through them: `python assets/figures/parts.py`.

`parts.yaml` contains the parts. The same text gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import yaml

HERE = Path(__file__).parent
SOURCE, PICTURE = HERE / "parts.yaml", HERE / "parts.svg"

# In pixels: the distance between the corners of neighbouring boxes, and the size of a box.
COLUMN, ROW = 192, 92
WIDTH, HEIGHT = 164, 64
MARGIN = 14
STEP = 9  # the radius of a step's number
HEAD = f"""<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d" font-family="sans-serif">
<title>The parts of the autograder and a submission's path through them</title>
<style>
text {{ font-size: 11px; fill: #222 }} .name {{ font-size: 13px; font-weight: bold }}
.sandbox {{ font-size: 10px; fill: #a33b00; font-style: italic }}
.step {{ fill: #005a8c }} .number {{ fill: #fff; font-weight: bold; text-anchor: middle }}
.box {{ fill: #eef3f7; stroke: #5b7a91 }} .arrow {{ stroke: #5b7a91; fill: none; marker-end: url(#head) }}
</style>
<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="{STEP}" markerHeight="{STEP}" orient="auto">
<path d="M0,0 L8,4 L0,8 z" fill="#5b7a91"/></marker></defs>
<rect width="100%%" height="100%%" fill="#fff"/>"""


def svg(source: Mapping[str, Any]) -> str:
    """Return the picture of `source`, the content of `parts.yaml`."""
    packages, steps = source["packages"], source["way"]
    columns, rows = (1 + max(part["at"][axis] for part in packages.values()) for axis in (0, 1))
    bottom = MARGIN + rows * ROW
    width, height = columns * COLUMN + 3 * MARGIN, bottom + 22 + 20 * -(-len(source["modules"]) // 3) + MARGIN
    lines = [HEAD % (width, height, width, height)]
    lines += [_arrow(*(packages[name]["at"] for name in arrow.split(" -> "))) for arrow in source["arrows"]]
    for name, part in packages.items():
        lines += _box(name, part)
    x, y = _corner((columns - 1, 2))  # the last column has no boxes from its third row on
    lines.append(_text(x, y + 14, "A submission's steps", "name"))
    for number, step in enumerate(steps, start=1):
        y += 44
        lines += _step(x + STEP, y - 4, number)
        lines += [_text(x + 24, y, step["step"], "name"), _text(x + 24, y + 15, step["does"])]
    lines.append(_text(x, y + 48, "in italics: runs in the sandbox", "sandbox"))
    lines.append(_text(MARGIN, bottom + 8, "Single modules", "name"))
    numbers = {step["module"]: number for number, step in enumerate(steps, start=1) if "module" in step}
    for index, (name, description) in enumerate(source["modules"].items()):
        x, y = MARGIN + 20 + index % 3 * 310, bottom + 30 + index // 3 * 20
        lines.append(f'<text x="{x}" y="{y}"><tspan class="name">{name}</tspan>  {escape(description)}</text>')
        lines += _step(x - 12, y - 4, numbers[name]) if name in numbers else []
    return "\n".join([*lines, "</svg>", ""])


def _corner(at: tuple[int, int]) -> tuple[int, int]:
    return MARGIN + at[0] * COLUMN, MARGIN + at[1] * ROW


def _box(name: str, part: Mapping[str, Any]) -> Iterator[str]:
    x, y = _corner(part["at"])
    yield f'<rect class="box" x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="6"/>'
    yield _text(x + 9, y + 17, name, "name")
    sandbox = ", ".join(part.get("sandbox", ()))
    for number, line in enumerate(part["does"].split("|")):
        yield _text(x + 9, y + 32 + 12 * number, line)
    if sandbox:
        yield _text(x + 9, y + 58, sandbox, "sandbox")
    for index, number in enumerate(reversed(part.get("steps", ()))):
        yield from _step(x + WIDTH - 12 - 2 * index * (STEP + 1), y + 12, number)


def _arrow(start: tuple[int, int], end: tuple[int, int]) -> str:
    (x1, y1), (x2, y2) = _corner(start), _corner(end)
    if start[1] == end[1]:  # from side to side
        rightward = start[0] < end[0]
        y1, y2 = y1 + HEIGHT // 2, y2 + HEIGHT // 2
        x1, x2 = x1 + WIDTH * rightward, x2 + WIDTH * (not rightward)
        return f'<path class="arrow" d="M{x1},{y1} L{x2},{y2}"/>'
    x1, y1, x2 = x1 + WIDTH // 2, y1 + HEIGHT, x2 + WIDTH // 2
    x1 += (x2 > x1) * 24 - (x2 < x1) * 24
    half = (ROW - HEIGHT) // 2 + 6
    return f'<path class="arrow" d="M{x1},{y1} C{x1},{y1 + half} {x2},{y2 - half} {x2},{y2}"/>'


def _step(x: int, y: int, number: int) -> Iterator[str]:
    yield f'<circle class="step" cx="{x}" cy="{y}" r="{STEP}"/>'
    yield _text(x, y + 4, str(number), "number")


def _text(x: int, y: int, text: str, kind: str = "") -> str:
    attribute = f' class="{kind}"' if kind else ""
    return f'<text x="{x}" y="{y}"{attribute}>{escape(text)}</text>'


def main() -> None:
    """Write the picture."""
    PICTURE.write_text(svg(yaml.safe_load(SOURCE.read_text(encoding="utf-8"))), encoding="utf-8")
    print(PICTURE)


if __name__ == "__main__":
    main()
