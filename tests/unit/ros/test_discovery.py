"""Frequent announcements: a Fast DDS profile that is set while rclpy starts, and removed afterwards."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from autograder.ros.discovery import PROFILES_VARIABLE, fast_discovery


def test_the_profile_is_set_in_the_block_and_removed_after_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(PROFILES_VARIABLE, raising=False)
    with fast_discovery():
        path = Path(os.environ[PROFILES_VARIABLE])
        tags = [element.tag.rpartition("}")[2] for element in ET.fromstring(path.read_bytes()).iter()]
        assert "leaseAnnouncement" in tags
    assert PROFILES_VARIABLE not in os.environ


def test_profiles_that_the_user_has_chosen_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PROFILES_VARIABLE, "/etc/mine.xml")
    with fast_discovery():
        assert os.environ[PROFILES_VARIABLE] == "/etc/mine.xml"
    assert os.environ[PROFILES_VARIABLE] == "/etc/mine.xml"
