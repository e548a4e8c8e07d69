"""The strongest isolation level of a machine is found, or the reason why it is not supported."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.exceptions import IsolationError
from autograder.run.sandbox import Isolation, best_isolation, isolation, launcher, require


@pytest.fixture
def tools(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder as the whole PATH. Cached probes are cleared before and after the test."""

    def clear_caches() -> None:
        isolation.best_isolation.cache_clear()
        isolation.namespaces_failure.cache_clear()
        isolation._root_failure.cache_clear()

    monkeypatch.setenv("PATH", str(tmp_path))
    clear_caches()
    yield tmp_path
    clear_caches()


def _bwrap(folder: Path, script: str) -> None:
    path = folder / "bwrap"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def test_without_bubblewrap_the_strong_isolation_level_is_refused_with_the_remedy(tools: Path) -> None:
    with pytest.raises(IsolationError) as excinfo:
        require(Isolation.BUBBLEWRAP)
    sentence = str(excinfo.value)
    assert "bubblewrap is not installed" in sentence
    assert "`autograder doctor` says how to fix it" in sentence
    assert "`--isolation process`" in sentence


def test_the_weak_isolation_level_is_only_used_if_requested(tools: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert require(Isolation.PROCESS) is Isolation.PROCESS
    assert best_isolation() is Isolation.PROCESS


@pytest.mark.skipif(os.geteuid() != 0, reason="only root changes to another user")
def test_root_that_cannot_change_its_user_is_also_refused_the_weak_isolation_level(tools: Path) -> None:
    with pytest.raises(IsolationError, match=r"`--isolation process` root's .*setpriv is not installed.*ordinary user"):
        require(Isolation.PROCESS)


def test_a_kernel_that_forbids_namespaces_is_quoted(tools: Path) -> None:
    _bwrap(tools, "echo 'bwrap: setting up uid map: Permission denied' >&2; exit 1")
    with pytest.raises(IsolationError, match="setting up uid map: Permission denied"):
        require(Isolation.BUBBLEWRAP)


def test_a_bubblewrap_that_fails_without_a_message_is_named(tools: Path) -> None:
    _bwrap(tools, "exit 7")
    with pytest.raises(IsolationError, match="bwrap ended with status 7"):
        require(Isolation.BUBBLEWRAP)


def test_outside_a_worker_sandbox_the_isolation_level_is_the_weak_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(launcher.ISOLATION_VARIABLE, raising=False)
    assert launcher.current_isolation() is Isolation.PROCESS
    monkeypatch.setenv(launcher.ISOLATION_VARIABLE, "bubblewrap")
    assert launcher.current_isolation() is Isolation.BUBBLEWRAP


def test_this_machine_supports_the_strong_isolation_level() -> None:
    assert best_isolation() is Isolation.BUBBLEWRAP, f"{isolation.namespaces_failure()}; PATH is {os.environ['PATH']}"
