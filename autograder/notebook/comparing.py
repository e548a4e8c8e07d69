"""`side_by_side`: several drives in one picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from autograder.notebook.driving import DriveReport
from autograder.notebook.notices import Notice

if TYPE_CHECKING:
    from sim.view import Picture

WIDTH, HEIGHT = 6.0, 4.9  # inches a drive


def side_by_side(drives: Mapping[str, DriveReport | Notice]) -> Picture | Notice:
    """Show the tracks of drives next to each other, each under its title; or the first notice among them.

    Args:
        drives: what `drive` returned, by title; at least one.
    """
    from matplotlib.figure import Figure

    from sim.view import LIGHT, Picture, plot

    reports: dict[str, DriveReport] = {}
    for title, report in drives.items():
        if isinstance(report, Notice):
            return report
        reports[title] = report
    figure = Figure(figsize=(WIDTH * len(reports), HEIGHT), facecolor=LIGHT.paper, layout="constrained")
    axes = figure.subplots(1, len(reports), squeeze=False)[0]
    alts = [
        f"{title}: {plot(report.recording, ax=ax, title=title).alt}"
        for ax, (title, report) in zip(axes, reports.items(), strict=True)
    ]
    return Picture(figure, " ".join(alts))
