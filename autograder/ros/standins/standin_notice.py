"""What each stand-in says of itself, and the error it raises for what it does not cover."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from typing import NoReturn

HOW_TO_GET_THE_REAL_ONE = (
    "run `make real-launch` (needs GitHub), or use a shell in which an installation of ROS 2 is sourced"
)


class NotInStandInError(ImportError):
    """A name of the real package that its stand-in does not cover.

    It is an ImportError, because only that keeps its text in ``from launch.actions import Name``.
    """


def not_covered(name: str, *, standin: str, reason: str = "", near: str = "") -> NotInStandInError:
    """Return the error for `name`, which the stand-in has not; `near` is a name that was perhaps meant."""
    meant = f" (did you mean '{near}'?)" if near else ""
    because = f" {reason}." if reason else ""
    return NotInStandInError(
        f"'{name}' is not covered{meant}: this is the course's stand-in for {standin}, used because the real one is "
        f"not installed.{because} To use '{name}', {HOW_TO_GET_THE_REAL_ONE}."
    )


def guard(module: str, reasons: Mapping[str, str] | None = None) -> Callable[[str], NoReturn]:
    """Return a module-level ``__getattr__`` that answers every uncovered name of `module` with that error.

    `reasons` adds a sentence for names that deserve one; a name that is nearly one of the module's is taken for a
    typing error first. Private names stay an AttributeError, because
    Python and its tools ask modules for many of them and expect to be refused that way.
    """

    def missing(name: str) -> NoReturn:
        if name.startswith("_"):
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        reason = (reasons or {}).get(name, "")
        near = [] if reason else get_close_matches(name, vars(sys.modules[module]), n=1, cutoff=0.8)
        raise not_covered(f"{module}.{name}", standin=module.partition(".")[0], reason=reason, near="".join(near))

    # Python looks for submodules of a module only if it has a path.
    vars(sys.modules[module]).setdefault("__path__", [])
    return missing
