"""Saves pictures of checks for the feedback."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from autograder.result import Artifact
from sim import Recording

DPI = 96


@dataclass(frozen=True)
class Gallery:
    """Saves the pictures of one check.

    Attributes:
        folder: folder that gets the pictures.
        check: id of the check, the first part of the file names.
        closed: whether nothing is saved.
        artifacts: records of the pictures that were saved. The galleries of all checks share this list.
    """

    folder: Path
    check: str = ""
    closed: bool = False
    artifacts: list[Artifact] = field(default_factory=list)

    def of(self, check: str) -> Gallery:
        """Return a gallery for another check, in the same folder."""
        return replace(self, check=check)

    def track(
        self, name: str, recording: Recording, caption: str, *, mark: float | None = None, note: str = ""
    ) -> None:
        """Save a picture of a robot's track. The digest of its record is that of the run.

        Args:
            name: name of the picture, unique in the check.
            recording: the run.
            caption: alternative text of the picture.
            mark: the time to mark on the track, in seconds since the start of the run.
            note: text beside the mark.
        """
        if self.closed:
            return
        import sim.view  # matplotlib is slow to import, and most checks have no picture

        stem = f"{self.check}-{name}"
        self.folder.mkdir(parents=True, exist_ok=True)
        picture = sim.view.plot(recording, mark=mark, note=note)
        picture.save(self.folder / f"{stem}.png", dpi=DPI)
        self.artifacts.append(Artifact(f"{stem}.png", "track", recording.sha256(), self.check, caption))
