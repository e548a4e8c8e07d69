"""The display of a player: the pixels of each colour on its canvas, and the times on its clock."""

from __future__ import annotations

from matplotlib.colors import to_hex
from playwright.sync_api import Locator

from sim.view import LIGHT

COUNT = """(canvas, colours) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
    const counts = colours.map(() => 0);
    for (let offset = 0; offset < data.length; offset += 4)
        colours.forEach((colour, index) => {
            if (colour.every((part, channel) => Math.abs(data[offset + channel] - part) <= 8)) counts[index] += 1;
        });
    return counts;
}"""

KEEP_TIMES = """
window.times = [];
new MutationObserver(() => {
    const clock = document.querySelector(".run-player output");
    if (clock && times.at(-1) !== clock.textContent) times.push(clock.textContent);
}).observe(document, {childList: true, characterData: true, subtree: true});
"""
"""A script for a page that is not yet open. It keeps all times of the first player's clock in `times`."""

LATE = to_hex(LIGHT.time_colours(0)(0.75))
"""The colour of a track shortly before its end, which the robot covers."""

DRAWN = {
    "the start of the track": LIGHT.time_hues(0)[0],
    "a late piece of the track": LATE,
    "the robot": LIGHT.robot,
    "hits of the lidar": LIGHT.hit,
    "the start pose, and numbers beside the axes": LIGHT.muted,
    "walls, and the closest point": LIGHT.ink,
}
"""The things on the canvas at the end of a run, and their colours in the light theme."""


def count(canvas: Locator, *colours: str) -> list[int]:
    """Return how many pixels of the canvas have each colour (#RRGGBB), or nearly."""
    channels = [[int(colour[start : start + 2], 16) for start in (1, 3, 5)] for colour in colours]
    return [int(number) for number in canvas.evaluate(COUNT, channels)]


def missing(canvas: Locator) -> list[str]:
    """Return the things in `DRAWN` that have fewer than five pixels on the canvas."""
    counts = count(canvas, *DRAWN.values())
    return [name for name, number in zip(DRAWN, counts, strict=True) if number < 5]
