"""All findings, in the order in which they are worth mending."""

from __future__ import annotations

from autograder.doctor import machine, ros
from autograder.doctor.finding import Finding
from autograder.doctor.system import System, this_system


def examine(system: System | None = None) -> tuple[Finding, ...]:
    """Look at everything the course stands on; takes about a second.

    Args:
        system: what to look at, this machine by default.
    """
    system = system or this_system()
    return (
        machine.python(system),
        machine.environment(system),
        *ros.examine(system),
        machine.compiler(system),
        machine.build_tools(system),
        machine.versions(system),
        machine.notebooks(system),
        machine.isolation(system),
        machine.space(system),
        machine.browser(system),
    )
