"""What this machine has of what the course needs, what is missing, and the one command that mends each lack.

`examine()` looks, `render()` shows, `healthy()` decides. Every look at the machine goes through a `System`.
"""

from autograder.doctor.examination import examine
from autograder.doctor.finding import Finding, Status, healthy, render
from autograder.doctor.system import Ran, System, this_system

__all__ = ["Finding", "Ran", "Status", "System", "examine", "healthy", "render", "this_system"]
