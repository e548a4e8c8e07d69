"""The tier of isolation that a machine can give is found, or the reason why it cannot give one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.exceptions import IsolationError
from autograder.run.sandbox import Tier, best_tier, launcher, require, tiers


@pytest.fixture
def tools(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder that is the whole PATH; what was found before is forgotten, and afterwards again."""

    def forget() -> None:
        tiers.best_tier.cache_clear()
        tiers.namespaces_failure.cache_clear()
        tiers._root_failure.cache_clear()

    monkeypatch.setenv("PATH", str(tmp_path))
    forget()
    yield tmp_path
    forget()


def _bwrap(folder: Path, script: str) -> None:
    path = folder / "bwrap"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def test_without_bubblewrap_the_strong_isolation_level_is_refused_with_the_remedy(tools: Path) -> None:
    with pytest.raises(IsolationError) as caught:
        require(Tier.BUBBLEWRAP)
    sentence = str(caught.value)
    assert "bubblewrap is not installed" in sentence
    assert "`autograder doctor` says how to fix it" in sentence
    assert "`--isolation process`" in sentence


def test_the_weak_isolation_level_is_only_used_if_requested(tools: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert require(Tier.PROCESS) is Tier.PROCESS
    assert best_tier() is Tier.PROCESS


@pytest.mark.skipif(os.geteuid() != 0, reason="only root has to become somebody else")
def test_root_that_cannot_change_its_user_is_also_refused_the_weak_isolation_level(tools: Path) -> None:
    with pytest.raises(IsolationError, match=r"`--isolation process` root's .*setpriv is not installed.*ordinary user"):
        require(Tier.PROCESS)


def test_a_kernel_that_forbids_namespaces_is_quoted(tools: Path) -> None:
    _bwrap(tools, "echo 'bwrap: setting up uid map: Permission denied' >&2; exit 1")
    with pytest.raises(IsolationError, match="setting up uid map: Permission denied"):
        require(Tier.BUBBLEWRAP)


def test_a_bubblewrap_that_fails_without_a_message_is_named(tools: Path) -> None:
    _bwrap(tools, "exit 7")
    with pytest.raises(IsolationError, match="bwrap ended with status 7"):
        require(Tier.BUBBLEWRAP)


def test_outside_a_worker_sandbox_the_isolation_level_is_the_weak_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(launcher.TIER_VARIABLE, raising=False)
    assert launcher.current_tier() is Tier.PROCESS
    monkeypatch.setenv(launcher.TIER_VARIABLE, "bubblewrap")
    assert launcher.current_tier() is Tier.BUBBLEWRAP


def test_this_machine_supports_the_strong_isolation_level() -> None:
    assert best_tier() is Tier.BUBBLEWRAP, f"{tiers.namespaces_failure()}; PATH is {os.environ['PATH']}"
