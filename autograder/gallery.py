"""Pictures that checks leave for the feedback."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from autograder.result import Artifact
from sim import Recording

DPI = 96


@dataclass(frozen=True)
class Gallery:
    """Saves what a check wants to show, or nothing if closed. Frozen but for the shared list of what was saved."""

    folder: Path
    check: str = ""
    closed: bool = False
    artifacts: list[Artifact] = field(default_factory=list)

    def of(self, check: str) -> Gallery:
        """Return the same gallery, saving under another check's name."""
        return replace(self, check=check)

    def track(
        self, name: str, recording: Recording, caption: str, *, mark: float | None = None, note: str = ""
    ) -> None:
        """Save a picture of a robot's track; its record carries the hash of the run, the behaviour's fingerprint.

        Args:
            name: a short name, unique in the check.
            recording: the run.
            caption: the picture in words, its alternative text.
            mark: the instant to point out, in seconds.
            note: what happened then.
        """
        if self.closed:
            return
        import sim.view  # matplotlib is slow to import, and most checks have no picture

        stem = f"{self.check}-{name}"
        self.folder.mkdir(parents=True, exist_ok=True)
        picture = sim.view.plot(recording, mark=mark, note=note)
        picture.save(self.folder / f"{stem}.png", dpi=DPI)
        self.artifacts.append(Artifact(f"{stem}.png", "track", recording.sha256(), self.check, caption))
