"""The exception that exports raise: a SimError, so that one `except` catches all exceptions of the simulator."""

from sim.exceptions import SimError


class ExportError(SimError):
    """A recording cannot be exported as requested. The message says what to do."""
