"""The errors of the launch stand-in; the real package keeps each beside its own subject."""

from __future__ import annotations

from collections.abc import Sequence


class SubstitutionFailure(RuntimeError):
    """A substitution could not be performed."""


class InvalidConditionExpressionError(ValueError):
    """A condition did not come out as true, false, 1 or 0."""


class InvalidPythonLaunchFileError(ValueError):
    """A Python launch file lacks `generate_launch_description`, or returns something else from it."""


class InvalidLaunchFileError(Exception):
    """A launch file could not be loaded; the text lists what went wrong."""

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
