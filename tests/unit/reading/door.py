"""What a door is: a way by which data of a student's enter the worker."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hypothesis import strategies as st


@dataclass(frozen=True)
class Door:
    """A way by which data of a student's enter the worker.

    Attributes:
        read: reads a value as the worker does, and makes the use of it that every caller makes; gets an empty folder.
        made_up: values to try it with.
        known: values that once made a submission "not graded", or are of their kind.
        refuses: what it may raise besides: its one caller turns these into the student's fault.
    """

    read: Callable[[Any, Path], object]
    made_up: st.SearchStrategy[Any]
    known: tuple[Any, ...] = ()
    refuses: tuple[type[Exception], ...] = ()
