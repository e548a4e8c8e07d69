"""Lockstep: a student's unmodified node, stepped through ROS time by the grader.

`lockstep_host` runs in the sandbox and carries the student's `main()`; `stepper.py` is the trusted end of its two
pipes. `protocol.py` says what they tell each other. A step is over when the node has taken every message that was sent
to it and has run every timer that is due, so a run is faster than real time and the same every time.
"""

from autograder.lockstep.exceptions import UnsteppableError
from autograder.lockstep.protocol import Crash, Description, Reply
from autograder.lockstep.stepper import Stepper

__all__ = ["Crash", "Description", "Reply", "Stepper", "UnsteppableError"]
