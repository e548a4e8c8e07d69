"""The pictures of checks are saved with their fingerprints, unless saving is disabled."""

from __future__ import annotations

import json
from pathlib import Path

from autograder.result.artifacts import Artifacts
from sim import Command, Simulation, World, box, run

RECORDING = run(Simulation(World.from_segments(box(4.0, 3.0))), lambda state, scans: Command(linear=0.2), seconds=0.5)


def test_a_picture_is_saved_under_the_check_with_the_fingerprint_of_the_run(tmp_path: Path) -> None:
    artifacts = Artifacts(tmp_path / "out")
    artifacts.of("touches_nothing").track("track", RECORDING, "The robot drives on.")
    (artifact,) = artifacts.saved
    assert (artifact.check, artifact.sha256) == ("touches_nothing", RECORDING.sha256())
    assert (tmp_path / "out" / artifact.name).read_bytes().startswith(b"\x89PNG")
    run = json.loads((tmp_path / "out" / artifact.run).read_text(encoding="utf-8"))
    assert run["alt"] == artifact.caption
    assert len(list((tmp_path / "out").iterdir())) == 2


def test_disabled_artifacts_write_no_picture(tmp_path: Path) -> None:
    artifacts = Artifacts(tmp_path / "out", disabled=True)
    artifacts.of("touches_nothing").track("track", RECORDING, "The robot drives on.")
    assert artifacts.saved == []
    assert not (tmp_path / "out").exists()
