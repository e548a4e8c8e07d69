"""What goes wrong when a recording is exported: a SimError, so that one `except` catches all of the simulator's."""

from sim.exceptions import SimError


class ExportError(SimError):
    """A recording that can't be written as asked. The message says what to do."""
