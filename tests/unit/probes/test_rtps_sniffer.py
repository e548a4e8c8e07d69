"""Ears in DDS domains."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from autograder.exceptions import GraderError
from autograder.probes import rtps_sniffer
from autograder.probes.rtps_sniffer import Ear


@pytest.fixture
def ear() -> Iterator[Ear]:
    with Ear() as ear:
        yield ear


def say(word: bytes, address: str, port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        mouth.sendto(word, (address, port))


def test_an_announcement_is_heard_once(ear: Ear) -> None:
    assert not ear.heard()
    say(b"RTPS and more", "127.0.0.1", 7400 + 250 * ear.domain + 10)
    assert ear.heard()
    assert not ear.heard()


def test_what_is_no_announcement_is_not_heard(ear: Ear) -> None:
    say(b"hello", "127.0.0.1", 7400 + 250 * ear.domain + 10)
    assert not ear.heard()


def test_two_ears_listen_in_different_domains(ear: Ear) -> None:
    with Ear() as other:
        assert other.domain != ear.domain
        say(b"RTPS", "127.0.0.1", 7400 + 250 * other.domain + 10)
        assert not ear.heard()
        assert other.heard()


def test_an_ear_finds_no_room_where_all_domains_are_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rtps_sniffer, "DOMAINS", range(228, 230))
    with ExitStack() as stack:
        for _ in rtps_sniffer.DOMAINS:
            stack.enter_context(Ear())
        with pytest.raises(GraderError, match="participants in all DDS domains from 228 to 229"):
            Ear()
