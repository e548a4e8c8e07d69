"""Saves pictures of checks, and the runs that they show, for the feedback."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from autograder.result.model import Artifact
from sim import Recording

if TYPE_CHECKING:
    from autograder.suite.temporal import Verdict  # not imported at run time, because rtamt is slow to import

DPI = 96


@dataclass(frozen=True)
class Artifacts:
    """Saves the pictures of one check."""

    folder: Path  # folder that gets the pictures
    check: str = ""  # id of the check, the first part of the file names
    disabled: bool = False  # whether nothing is saved
    recordings: bool = False  # whether whole recordings are also saved
    # Records of the pictures that were saved. The artifacts of all checks share this list.
    saved: list[Artifact] = field(default_factory=list)

    def of(self, check: str) -> Artifacts:
        """Return the artifacts of another check, in the same folder."""
        return replace(self, check=check)

    def track(
        self,
        name: str,
        recording: Recording,
        caption: str,
        *,
        mark: float | None = None,
        note: str = "",
        rules: Mapping[str, Verdict] | None = None,
    ) -> None:
        """Save a picture of a robot's track, and its run for the player. The digest in the record is that of the run.

        Args:
            name: name of the picture, unique in the check.
            recording: the run.
            caption: alternative text of the picture.
            mark: the time to mark on the track, in seconds since the start of the run.
            note: text beside the mark.
            rules: the verdict on each rule, by the rule in words. Its times are in seconds since the start of the run.
        """
        if self.disabled:
            return
        import sim.view  # matplotlib is slow to import, and most checks have no picture

        stem = f"{self.check}-{name}"
        self.folder.mkdir(parents=True, exist_ok=True)
        picture = sim.view.plot(recording, mark=mark, note=note)
        picture.save(self.folder / f"{stem}.png", dpi=DPI)
        margins = [
            sim.view.Margin(rule, verdict.times, verdict.values, verdict.violated_at)
            for rule, verdict in (rules or {}).items()
        ]
        if self.recordings:
            recording.save(self.folder / f"{stem}.npz")
        run, data = f"{stem}.run.json", sim.view.encode(recording, caption, margins, mark=mark, note=note)
        (self.folder / run).write_text(data, encoding="utf-8")
        self.saved.append(Artifact(f"{stem}.png", "track", recording.sha256(), self.check, caption, run))
