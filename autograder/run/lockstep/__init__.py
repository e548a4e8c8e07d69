"""Lockstep: the grader steps a student's unmodified node through ROS time.

`lockstep_host` runs in the sandbox and calls the student's `main()`. `stepper` is the trusted side of its two pipes,
and `protocol` defines their messages. A step is over when the node has taken every message that was sent to it and has
run every timer that is due. So runs are faster than real time, and all the same. `autograder.harness.steps` defines the
length of a step.
"""

from autograder.run.lockstep.protocol import Crash, Description, Reply
from autograder.run.lockstep.stepper import Stepper, UnsteppableError

__all__ = ["Crash", "Description", "Reply", "Stepper", "UnsteppableError"]
