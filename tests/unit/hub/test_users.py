"""A trial changes only users that it has created, and explains why it cannot create any."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from autograder.exceptions import UsageError
from autograder.lms.hub import trial
from autograder.lms.hub.users import remove_users


def test_a_user_who_was_not_made_by_a_trial_is_not_removed() -> None:
    with pytest.raises(UsageError, match="this machine has another user root, not made by make hub"):
        remove_users({"a-group-that-is-not-there": ["root"]})


def test_users_other_than_root_are_told_how_to_start_a_hub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    with pytest.raises(UsageError, match="run this with sudo or as root"), trial.serving(tmp_path, tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []
