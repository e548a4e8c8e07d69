"""A problem in a notebook, with the place where its author finds it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """A problem in a notebook: what is wrong and what to do. `cell` is None if it concerns no single cell."""

    notebook: str
    cell: str | None
    message: str

    def __str__(self) -> str:
        where = self.notebook if self.cell is None else f"{self.notebook}, cell {self.cell!r}"
        return f"{where}: {self.message}"


# A finding with what corrects it in place, or None where the author has to.
Difference = tuple[Finding, Callable[[], None] | None]
