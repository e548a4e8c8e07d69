"""The errors of the launch stand-in, which the real package defines in several modules."""

from __future__ import annotations

from collections.abc import Sequence


class SubstitutionFailure(RuntimeError):
    """A substitution could not be performed."""


class InvalidConditionExpressionError(ValueError):
    """The text of a condition is not true, false, 1 or 0."""


class InvalidPythonLaunchFileError(ValueError):
    """A Python launch file lacks `generate_launch_description`, or returns something else from it."""


class InvalidLaunchFileError(Exception):
    """A launch file could not be loaded; the message lists the errors."""

    def __init__(self, extension: str = "", *, likely_errors: Sequence[Exception] = ()) -> None:
        if not extension or not likely_errors:
            text = "The launch file may have a syntax error, or its format is unknown"
        else:
            count = "multiple exceptions" if len(likely_errors) > 1 else "exception"
            lines = [f"Caught {count} when trying to load file of format [{extension}]:"]
            lines += [f" - {type(error).__name__}: {error}" for error in likely_errors]
            text = "\n".join(lines)
            self.__cause__ = likely_errors[0]
        super().__init__(text)
