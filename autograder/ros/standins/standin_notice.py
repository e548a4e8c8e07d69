"""The error that stand-ins raise for names that they do not cover."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from typing import NoReturn

REAL_PACKAGE_ADVICE = (
    "run `make real-launch` (needs GitHub), or use a shell in which an installation of ROS 2 is sourced"
)


class NotInStandInError(ImportError):
    """A name of the real package that its stand-in does not cover.

    It is an ImportError, because only this type keeps its message in ``from launch.actions import Name``.
    """


def not_covered(name: str, *, standin: str, reason: str = "", near: str = "") -> NotInStandInError:
    """Return the error for `name`, which the stand-in does not cover; `near` is a similar name that it has."""
    suggestion = f" (did you mean '{near}'?)" if near else ""
    explanation = f" {reason}." if reason else ""
    return NotInStandInError(
        f"'{name}' is not covered{suggestion}: this is the course's stand-in for {standin}, used because the real one "
        f"is not installed.{explanation} To use '{name}', {REAL_PACKAGE_ADVICE}."
    )


def make_getattr(module: str, reasons: Mapping[str, str] | None = None) -> Callable[[str], NoReturn]:
    """Return a module-level ``__getattr__`` that raises that error for every uncovered name of `module`.

    `reasons` has an additional sentence for some names. For any other name, the error suggests a similar one of the
    module. Private names raise an AttributeError, because Python and its tools look up many of them and expect it.
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
