"""What this machine has of what the course needs, what is missing, and the one command that fixes each lack.

`examine()` looks, `render()` shows, `healthy()` decides. Every look at the machine goes through a `System`.
"""

from autograder.doctor import machine, ros
from autograder.doctor.finding import Finding, Status, healthy, render
from autograder.doctor.system import CommandResult, System

__all__ = ["CommandResult", "Finding", "Status", "System", "examine", "healthy", "render"]


def examine(system: System) -> tuple[Finding, ...]:
    """Return all findings, in the order in which to fix them; takes about a second."""
    return (
        machine.python(system),
        machine.environment(system),
        *machine.other_users(system),
        *ros.examine(system),
        machine.compiler(system),
        machine.build_tools(system),
        machine.versions(system),
        machine.notebooks(system),
        machine.isolation(system),
        machine.space(system),
        machine.browser(system),
        *machine.release(system),
    )
