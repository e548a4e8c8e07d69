"""What each stand-in says of itself, and the error it raises for what it does not cover."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NoReturn

HOW_TO_GET_THE_REAL_ONE = (
    "run `make real-launch` (needs GitHub), or use a shell in which an installation of ROS 2 Jazzy is sourced"
)


class NotInStandInError(ImportError):
    """A name of the real package that its stand-in does not cover.

    It is an ImportError, because only that keeps its text in ``from launch.actions import Name``.
    """


def not_covered(name: str, *, standin: str, reason: str = "") -> NotInStandInError:
    """Return the error for `name`, which the real package has and the stand-in has not."""
    because = f" {reason}." if reason else ""
    return NotInStandInError(
        f"'{name}' is not covered: this is the course's stand-in for {standin}, used because the real one is "
        f"not installed.{because} To use '{name}', {HOW_TO_GET_THE_REAL_ONE}."
    )


def guard(module: str, reasons: Mapping[str, str] | None = None) -> Callable[[str], NoReturn]:
    """Return a module-level ``__getattr__`` that answers every uncovered name of `module` with that error.

    `reasons` adds a sentence for names that deserve one. Private names stay an AttributeError, because
    Python and its tools ask modules for many of them and expect to be refused that way.
    """

    def missing(name: str) -> NoReturn:
        if name.startswith("_"):
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        raise not_covered(f"{module}.{name}", standin=module.partition(".")[0], reason=(reasons or {}).get(name, ""))

    return missing
