"""A reader: code of the worker that reads a student's data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hypothesis import strategies as st


@dataclass(frozen=True)
class Reader:
    """Code of the worker that reads a student's data.

    Attributes:
        read: reads a value as the worker does, and uses it as every caller does; gets an empty folder.
        values: generated values to try it with.
        known: values that once made a submission "not graded", or similar ones.
        refuses: other errors that it may raise; its only caller attributes them to the student.
    """

    read: Callable[[Any, Path], object]
    values: st.SearchStrategy[Any]
    known: tuple[Any, ...] = ()
    refuses: tuple[type[Exception], ...] = ()
