"""Examines whether this machine meets the course's needs, and names the command that fixes each problem.

`examine()` collects findings, `render()` formats them, and `healthy()` decides whether they suffice. All access to the
machine goes through a `System`.
"""

from autograder.doctor import machine, ros
from autograder.doctor.finding import Finding, Status, healthy, render
from autograder.doctor.system import CommandResult, System

__all__ = ["CommandResult", "Finding", "Status", "System", "examine", "healthy", "render"]


def examine(system: System) -> tuple[Finding, ...]:
    """Return all findings, in the order in which to fix them. This takes about a second."""
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
