"""Every process of a launch can write to the pipe for the launch's exit status."""

from __future__ import annotations

import os

import pytest

from autograder.exceptions import StudentError
from autograder.harness.launch import MAX_STATUS, LaunchHarness


def test_a_flood_instead_of_an_exit_status_is_not_kept() -> None:
    ours, theirs = os.pipe()
    os.set_blocking(ours, False)
    harness = LaunchHarness.__new__(LaunchHarness)
    harness._status_pipe, harness._status_text = ours, b""
    try:
        for part in (b"1" * 40, b"1" * 20_000):
            assert harness.status is None
            os.write(theirs, part)
        for _ in range(3):
            with pytest.raises(StudentError, match=r"exit status of the launch cannot be read"):
                assert harness.status
        assert len(harness._status_text) == MAX_STATUS
        assert len(os.read(ours, 1 << 16)) == 20_040 - MAX_STATUS
    finally:
        os.close(ours)
        os.close(theirs)
