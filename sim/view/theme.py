"""The colours and fonts of all pictures: a light and a dark `Theme`.

The hues are those of Okabe and Ito (2008), which people with any common kind of colour blindness can tell apart. No
meaning depends only on colour: a goal is a ring, a collision a cross, and the robot has a nose. Lines and letters are
large enough for a projector.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.colors import LinearSegmentedColormap, to_hex, to_rgb


@dataclass(frozen=True)
class Theme:
    """The colours of a picture, as hexadecimal strings."""

    name: str
    paper: str
    outside: str
    floor: str
    solid: str
    grid: str
    wall: str
    ink: str
    muted: str
    robot: str
    beam: str
    hit: str
    start: str
    goal: str
    alarm: str
    mover: str
    near_far: tuple[str, str, str]

    def time_colours(self, index: int) -> LinearSegmentedColormap:
        """Return the colours of a robot's track from early to late. They share a hue, and lightness represents time."""
        return LinearSegmentedColormap.from_list(f"{self.name}-time-{index}", list(self.time_hues(index)))

    def time_hues(self, index: int) -> tuple[str, str, str]:
        """Return the colours of a robot's track at its start, middle and end."""
        own = self.robot_colour(index)
        early, late = (_mix(own, end, 0.6) for end in (self.paper, self.ink))
        return early, own, late

    @cached_property
    def named(self) -> dict[str, str]:
        """The colours by their names: this theme's fields, and `early`, `own` and `late` for each robot colour."""
        colours = {field.name: getattr(self, field.name) for field in fields(self) if field.type == "str"}
        del colours["name"]
        for index in range(1 + len(self.other_colours)):
            colours |= zip((f"early{index}", f"own{index}", f"late{index}"), self.time_hues(index), strict=True)
        return colours

    @cached_property
    def clearance_colours(self) -> LinearSegmentedColormap:
        """The colours from near to far, vermilion to blue."""
        return LinearSegmentedColormap.from_list(f"{self.name}-clearance", list(self.near_far))

    @cached_property
    def other_colours(self) -> tuple[str, ...]:
        """The colours of the second and further robots."""
        return ("#CC79A7", "#009E73", "#E69F00", "#56B4E9")

    def robot_colour(self, index: int) -> str:
        """Return the colour of the robot with this index in the simulation."""
        return self.robot if index == 0 else self.other_colours[(index - 1) % len(self.other_colours)]


def _mix(colour: str, other: str, share: float) -> str:
    """Mix `colour` with a `share` of the colour `other`; return a hexadecimal string."""
    red, green, blue = (1 - share) * np.array(to_rgb(colour)) + share * np.array(to_rgb(other))
    return to_hex((red, green, blue))


LIGHT = Theme(
    name="light",
    paper="#FFFFFF",
    outside="#F5F6F4",
    floor="#FFFFFF",
    solid="#E7E9E7",
    grid="#EAEBE9",
    wall="#26313B",
    ink="#26313B",
    muted="#5C6872",
    robot="#0072B2",
    beam="#E69F00",
    hit="#D55E00",
    start="#5C6872",
    goal="#00805E",
    alarm="#C8401A",
    mover="#8C5A86",
    near_far=("#D55E00", "#C9B79C", "#0072B2"),
)

DARK = Theme(
    name="dark",
    paper="#11161B",
    outside="#161C22",
    floor="#11161B",
    solid="#2A333C",
    grid="#212931",
    wall="#DDE3E8",
    ink="#DDE3E8",
    muted="#93A0AB",
    robot="#56B4E9",
    beam="#E69F00",
    hit="#FFB25A",
    start="#93A0AB",
    goal="#2CC99B",
    alarm="#FF7A4D",
    mover="#D79BCF",
    near_far=("#FF7A4D", "#8C8373", "#56B4E9"),
)

THEMES: Mapping[str, Theme] = {"light": LIGHT, "dark": DARK}

STYLE: Mapping[str, Any] = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so letters are the same on every machine
    "font.size": 10.0,
    "svg.hashsalt": "sim",
    "svg.fonttype": "path",
    "path.simplify": True,
    "lines.solid_capstyle": "round",
}


def theme_named(name: str | Theme) -> Theme:
    """Return the theme with the name "light" or "dark". A Theme is returned unchanged."""
    if isinstance(name, Theme):
        return name
    if name not in THEMES:
        raise ValueError(f"there is no theme {name!r}: choose one of {', '.join(THEMES)}")
    return THEMES[name]
