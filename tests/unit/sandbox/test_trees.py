"""Root's copy of a submission contains nothing that a student swaps in while it is copied."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder.run.sandbox.worker_sandbox import copy_submission


@pytest.fixture
def submission(tmp_path: Path) -> Path:
    """Return a submission with a folder `own`, beside a folder `others` with a secret."""
    (tmp_path / "others").mkdir()
    (tmp_path / "others" / "secret").write_text("secret")
    (tmp_path / "home" / "sub" / "own").mkdir(parents=True)
    (tmp_path / "home" / "sub" / "own" / "mine").write_text("mine")
    (tmp_path / "home" / "sub" / "zzz").write_text("last")
    return tmp_path / "home" / "sub"


def change_after_lookup(monkeypatch: pytest.MonkeyPatch, looked_up: str, change: Callable[[], object]) -> None:
    """Make a change right after a name of the submission has been looked up."""
    real = os.stat

    def stat(path: str, *, dir_fd: int | None = None, follow_symlinks: bool = True) -> os.stat_result:
        info = real(path, dir_fd=dir_fd, follow_symlinks=follow_symlinks)
        if path == looked_up and dir_fd is not None:
            change()
        return info

    monkeypatch.setattr(os, "stat", stat)


@pytest.mark.parametrize("name", ["own", "own/mine"])
def test_a_link_that_replaced_a_listed_file_is_not_followed(
    submission: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    listed = submission / name
    target = tmp_path / "others" / ("secret" if listed.is_file() else "")

    def swap() -> None:
        listed.rename(tmp_path / "away")
        listed.symlink_to(target)

    change_after_lookup(monkeypatch, listed.name, swap)
    copy_submission(submission, tmp_path / "copy")
    assert (tmp_path / "copy" / "zzz").read_text() == "last"
    assert not [path for path in (tmp_path / "copy").rglob("*") if path.is_file() and "secret" in path.read_text()]


def test_a_folder_above_that_has_become_a_link_is_not_followed(submission: Path, tmp_path: Path) -> None:
    (tmp_path / "home").rename(tmp_path / "away")
    (tmp_path / "home").symlink_to(tmp_path / "away")
    copy_submission(submission, tmp_path / "copy")
    assert not (tmp_path / "copy").exists()
