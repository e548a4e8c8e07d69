"""A sniffer listens in a DDS domain and returns the announcements of participants."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from autograder.exceptions import GraderError
from autograder.probes import rtps_sniffer
from autograder.probes.rtps_sniffer import RtpsSniffer


@pytest.fixture
def sniffer() -> Iterator[RtpsSniffer]:
    with RtpsSniffer() as sniffer:
        yield sniffer


def send_packet(data: bytes, address: str, port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(data, (address, port))


def test_the_sniffer_returns_an_announcement_once(sniffer: RtpsSniffer) -> None:
    assert not sniffer.take_announcements()
    send_packet(b"RTPS and more", "127.0.0.1", 7400 + 250 * sniffer.domain + 10)
    assert sniffer.take_announcements()
    assert not sniffer.take_announcements()


def test_the_sniffer_ignores_a_packet_that_is_not_an_announcement(sniffer: RtpsSniffer) -> None:
    send_packet(b"hello", "127.0.0.1", 7400 + 250 * sniffer.domain + 10)
    assert not sniffer.take_announcements()


def test_two_sniffers_listen_in_different_domains(sniffer: RtpsSniffer) -> None:
    with RtpsSniffer() as other:
        assert other.domain != sniffer.domain
        send_packet(b"RTPS", "127.0.0.1", 7400 + 250 * other.domain + 10)
        assert not sniffer.take_announcements()
        assert other.take_announcements()


def test_a_sniffer_raises_when_every_domain_has_participants(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rtps_sniffer, "DOMAINS", range(228, 230))
    with ExitStack() as stack:
        for _ in rtps_sniffer.DOMAINS:
            stack.enter_context(RtpsSniffer())
        with pytest.raises(GraderError, match="All DDS domains from 228 to 229 are in use"):
            RtpsSniffer()
