"""Keeps one harness for several checks, and starts its programs again only if they can no longer be used."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from typing import Any, Generic, Protocol, TypeVar

from autograder.exceptions import StudentError
from autograder.run.sandbox import Process


class Programs(AbstractContextManager[Any], Protocol):
    """Programs in a harness, or in an object that is based on a harness. They run inside its `with` block."""

    @property
    def processes(self) -> tuple[Process, ...]:
        """The sandboxed programs."""


P = TypeVar("P", bound=Programs)


class Shared(ExitStack, Generic[P]):
    """Keeps one harness for several checks, and replaces it once one of its programs has ended.

    Programs that did not start are not started again: each further check gets the same error at once. `Shared` is a
    context manager. Its exit ends the programs.

    Args:
        make: creates a harness, not yet entered.
        usable: returns whether a harness with running programs can be used for the next check. If not, it is replaced.
    """

    def __init__(self, make: Callable[[], P], usable: Callable[[P], bool] = lambda _: True) -> None:
        super().__init__()
        self._make, self._usable = make, usable
        self._current: P | None = None
        self._error: StudentError | None = None  # why the programs did not start

    def get(self) -> P:
        """Return a harness whose programs are running. Raise the error if it cannot be created or entered."""
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
