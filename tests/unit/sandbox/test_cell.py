"""Folders of cells that a killed grader left are removed, and no others."""

from __future__ import annotations

import fcntl
import os
import sys
import tempfile
from pathlib import Path

import pytest

from autograder.run.sandbox import Tier
from autograder.run.sandbox.cell import run_in_cell


def test_only_folders_of_cells_without_a_lock_are_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in (tmp_path, *list(tmp_path.parents)[:2]):  # root's cell becomes another user, who comes from here
        folder.chmod(0o711)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    left, held, young, other = (
        tmp_path / f"{name}" for name in ("autograder-cell-1", "autograder-cell-2", "autograder-cell-3", "other")
    )
    for folder in (left, held, young, other):
        (folder / "ws").mkdir(parents=True)
        if folder != young:
            os.utime(folder, (0, 0))
    link = tmp_path / "autograder-cell-4"
    link.symlink_to(other)
    descriptor = os.open(held, os.O_RDONLY)
    fcntl.flock(descriptor, fcntl.LOCK_EX)
    try:
        report = run_in_cell(lambda scratch: [sys.executable, "-c", f"print({str(scratch)!r})"], Tier.PROCESS)
    finally:
        os.close(descriptor)
    assert Path(report.output.strip()).parent == tmp_path
    assert {*tmp_path.iterdir()} == {held, young, other, link}
    assert (other / "ws").is_dir()


def test_a_worker_imports_nothing_from_the_folder_that_the_grader_was_started_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("json", "yaml", "numpy"):
        (tmp_path / f"{module}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\n")
    monkeypatch.chdir(tmp_path)
    for tier in (Tier.PROCESS, Tier.BUBBLEWRAP):
        report = run_in_cell(lambda scratch: [sys.executable, "-m", "autograder.grade.worker", "{}"], tier)
        assert "JSON" not in report.output
        assert "TypeError" in report.output  # it came as far as reading its job
    assert not (tmp_path / "ran").exists()
