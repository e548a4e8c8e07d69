"""What a canvas of the player shows, in numbers of pixels."""

from __future__ import annotations

from matplotlib.colors import to_hex
from playwright.sync_api import Locator

from sim.view import LIGHT

COUNT = """(canvas, wanted) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
    const counts = wanted.map(() => 0);
    for (let place = 0; place < data.length; place += 4)
        wanted.forEach((colour, index) => {
            if (colour.every((part, channel) => Math.abs(data[place + channel] - part) <= 8)) counts[index] += 1;
        });
    return counts;
}"""

LATE = to_hex(LIGHT.time_colours(0)(0.75))
"""The colour of a track before its end, which is below the robot."""

DRAWN = {
    "the start of the track": LIGHT.time_hues(0)[0],
    "a late piece of the track": LATE,
    "the robot": LIGHT.robot,
    "hits of the lidar": LIGHT.hit,
    "the start pose, and numbers beside the axes": LIGHT.muted,
    "walls, and the closest place": LIGHT.ink,
}
"""What is on the canvas of a run at its end, by its colour in the light theme."""


def count(canvas: Locator, *colours: str) -> list[int]:
    """Return for each colour, as #RRGGBB, how many pixels of the canvas have it, or nearly."""
    wanted = [[int(colour[place : place + 2], 16) for place in (1, 3, 5)] for colour in colours]
    return [int(number) for number in canvas.evaluate(COUNT, wanted)]


def missing(canvas: Locator) -> list[str]:
    """Return which things of `DRAWN` have fewer than five pixels on the canvas."""
    counts = count(canvas, *DRAWN.values())
    return [name for name, number in zip(DRAWN, counts, strict=True) if number < 5]
