"""Fixtures of the suite: the system in the harness."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from autograder.checks.ch08_capstone.support.contract import PROGRAMS
from autograder.checks.ch08_capstone.support.messages import load_messages, types
from autograder.checks.ch08_capstone.support.system import System
from autograder.harness import Workspace


class Stable:
    """Keeps one system for several checks, and starts it anew once one of its programs has ended."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._stack = ExitStack()
        self._system: System | None = None

    def system(self, *needed: str) -> System:
        """Return a system in which these programs run; that others fail is no matter then."""
        if self._system is None or not self._system.serves(needed):
            self.close()
            system = System(self._workspace, types(load_messages(self._workspace)), needed)
            self._system = self._stack.enter_context(system)
        self._system.need(needed)
        return self._system

    def close(self) -> None:
        """Let the present system go."""
        self._system = None
        self._stack.close()


@pytest.fixture(scope="session")
def stable(workspace: Workspace) -> Iterator[Stable]:
    """The place where the shared system runs."""
    place = Stable(workspace)
    yield place
    place.close()


@pytest.fixture
def system(stable: Stable) -> System:
    """The system, which has seen other scans before; each check shows it an open space first, if that matters."""
    return stable.system(*PROGRAMS)
