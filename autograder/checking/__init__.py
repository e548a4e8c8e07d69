"""The public interface for authors of checks. A chapter's checks import this package, `sim`, and their own modules.

    from autograder.checking import AutoHarness, Workspace, expect, group, hint
    from autograder.checking.probes import parameters

`probes` has modules that inspect a package or a running program, `drawn_cases` tests a rule with cases that Hypothesis
draws, `temporal` evaluates temporal rules, and `attacks` has the classes and payloads for a chapter's `attacks.py`. The
other parts of the autograder may change without notice.
"""

from autograder.building.interfaces import load_interfaces
from autograder.course_paths import solution_path, world_path
from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.harness import (
    AutoHarness,
    Goal,
    Harness,
    Program,
    RealTimeHarness,
    ReceivedMessage,
    Shared,
    SteppedHarness,
    Workspace,
    drive,
)
from autograder.harness.drive import COMMAND_TOPICS, SCAN_SECONDS, SENSOR_TOPICS
from autograder.harness.launch import LaunchHarness, RunningProgram
from autograder.plain_text import nearest
from autograder.result.artifacts import Artifacts
from autograder.run.sandbox import Process
from autograder.run.time_record import LOCKSTEP, REAL
from autograder.submission.exercise_stubs import STILL_TO_BE_WRITTEN, explain
from autograder.submission.packages import find_packages
from autograder.submission.reading import reading
from autograder.suite import CheckFailed, CheckRow, check, check_each_row, check_of, expect, group, hint

__all__ = [
    "COMMAND_TOPICS",
    "LOCKSTEP",
    "OK",
    "REAL",
    "SCAN_SECONDS",
    "SENSOR_TOPICS",
    "STILL_TO_BE_WRITTEN",
    "Artifacts",
    "AutoHarness",
    "CheckFailed",
    "CheckRow",
    "Diagnosis",
    "Goal",
    "GraderError",
    "Harness",
    "Kind",
    "LaunchHarness",
    "Process",
    "Program",
    "RealTimeHarness",
    "ReceivedMessage",
    "RunningProgram",
    "Shared",
    "SteppedHarness",
    "StudentError",
    "Workspace",
    "check",
    "check_each_row",
    "check_of",
    "drive",
    "expect",
    "explain",
    "find_packages",
    "group",
    "hint",
    "load_interfaces",
    "nearest",
    "reading",
    "solution_path",
    "world_path",
]
