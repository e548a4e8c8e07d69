"""Keeps one harness for several checks. A program is started again only if it can no longer be used."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from typing import Any, Generic, Protocol, TypeVar

from autograder.exceptions import StudentError
from autograder.run.sandbox import Process


class Programs(AbstractContextManager[Any], Protocol):
    """Programs in a harness, or in something built on one. They run inside its `with` block."""

    @property
    def processes(self) -> tuple[Process, ...]:
        """The sandboxed programs."""


P = TypeVar("P", bound=Programs)


class Shared(ExitStack, Generic[P]):
    """Keeps one harness for several checks, and replaces it once one of its programs has ended.

    Programs that did not start are not started again: each further check gets the same error at once. It is a context
    manager, whose end also ends the programs.

    Args:
        make: creates a harness, not yet entered.
        usable: whether a harness whose programs run can be used for the next check. Otherwise, it is replaced.
    """

    def __init__(self, make: Callable[[], P], usable: Callable[[P], bool] = lambda _: True) -> None:
        super().__init__()
        self._make, self._usable = make, usable
        self._current: P | None = None
        self._error: StudentError | None = None  # why the programs did not start

    def get(self) -> P:
        """Return a harness whose programs run. Raises the errors of creating and entering one."""
        if self._error is not None:
            raise self._error
        current = self._current
        if current is None or any(process.exit_reason for process in current.processes) or not self._usable(current):
            self.close()
            try:
                current = self.enter_context(self._make())
            except StudentError as error:
                self._error = error
                raise
            self._current = current
        return current

    def close(self) -> None:
        """End the current harness. The next check gets a new one."""
        self._current = None
        super().close()
