"""Launches, and what they declare, that several checks look at."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack

from std_msgs.msg import String

from autograder.checking import LaunchHarness, Workspace
from autograder.checking.probes import launch_arguments, launch_probe, short_lived
from autograder.checks.ch04_launch.hidden import included
from autograder.checks.ch04_launch.hidden.given import given_parameters, given_programs
from autograder.checks.ch04_launch.hidden.inputs import Inputs, with_sim_time, with_values
from autograder.checks.ch04_launch.support.contract import (
    CONFIG,
    FIRST,
    FLEET,
    PACKAGE,
    ROBOT,
    SAFE,
    SECOND,
    SHARED,
    SPEED,
)

# launch shows standard error in any case, and standard output where it is told to.
ON_STDOUT = {"RCUTILS_LOGGING_USE_STDOUT": "1", "RCUTILS_LOGGING_BUFFERED_STREAM": "0"}
ON_STDERR = {**ON_STDOUT, "RCUTILS_LOGGING_USE_STDOUT": "0"}  # as nodes log by themselves
# Self-tests that end otherwise than with the exit status 0 or 1.
UNUSUAL = {"by a signal": "#!/bin/sh\nkill -KILL $$\n", "with exit status 3": "#!/bin/sh\nexit 3\n"}
# Stand-ins for all three: the self-test takes a while, the reporter ends again and again, the driver when it is told.
SCRIPTS = {
    "self_test": "#!/bin/sh\nsleep 3\nexit 0\n",  # no exec: the system shows by its name that it runs
    "reporter": "#!/bin/sh\nexec sleep 0.1\n",
    "driver": "#!/bin/sh\ntrap 'exit 3' TERM\nwhile sleep 0.2; do :; done\n",
}
STILL = {"driver": "#!/bin/sh\nexec sleep 600\n"}  # for a check of the reporter: it saves the start of a node
PROGRAMS = {"scripts": SCRIPTS, "still": STILL, **{ending: {"self_test": text} for ending, text in UNUSUAL.items()}}
# Of two_robots.launch.py, given to it: whether it has them by itself is asked once.
DEFAULTS = {"first": FIRST, "second": SECOND, "speed": SPEED}
INCLUDED = {"like": included.LIKE_THE_REFERENCE, "wheels": included.WITH_ONE_NODE}


class Launches:
    """Starts each launch once, when it is first asked for, and ends all at the end.

    Each starts the programs as they were given, and reads the parameters file as it was given but for its numbers.
    One robot is launched with other numbers and one parameter more in its parameters file. Two robots include a
    robot.launch.py of the grader's own, so that a mistake in the student's counts once; `own_fleet` includes that one.
    """

    def __init__(self, workspace: Workspace, inputs: Inputs) -> None:
        self._workspace, self._inputs = workspace, inputs
        self._stack = ExitStack()
        self._harnesses: dict[str, LaunchHarness] = {}
        self._copies: dict[str, Workspace] = {}
        self._early: set[LaunchHarness] = set()
        self._arguments: dict[str, dict[str, launch_arguments.Argument]] = {}

    def robot(self, **arguments: object) -> LaunchHarness:
        """Return robot.launch.py as it runs with these arguments; with `report`, its nodes log on standard error."""
        return self._harness(ROBOT, arguments, {}, environment=ON_STDERR if "report" in arguments else ON_STDOUT)

    def quoted(self) -> LaunchHarness:
        """Return robot.launch.py as it runs with quotation marks in the robot's name, above a driver that sleeps."""
        return self._harness(ROBOT, {"robot_name": self._inputs.quoted_name}, {}, programs="still")

    def robot_arguments(self) -> dict[str, launch_arguments.Argument]:
        """Return the arguments that the student's robot.launch.py declares; raises as `declared_arguments` does."""
        return self._shown(ROBOT)

    def fleet(self, **arguments: object) -> LaunchHarness:
        """Return two_robots.launch.py as it runs with these arguments."""
        return self._harness(FLEET, arguments, {SHARED: String}, robot="like")

    def fleet_workspace(self) -> Workspace:
        """Return the workspace in which two_robots.launch.py runs."""
        return self._copy(FLEET, "like")

    def renamed_fleet(self) -> LaunchHarness:
        """Return two_robots.launch.py, above a robot.launch.py whose one node is called wheels."""
        return self._harness(FLEET, DEFAULTS, {}, robot="wheels")

    def own_fleet(self) -> LaunchHarness:
        """Return two_robots.launch.py with a speed, above the student's robot.launch.py."""
        return self._harness(FLEET, {**DEFAULTS, "speed": self._inputs.speed}, {})

    def alone(self) -> LaunchHarness:
        """Return the student's robot.launch.py, with the speed and the files of `own_fleet`."""
        return self._harness(ROBOT, {"speed": self._inputs.speed}, {}, beside=FLEET)

    def safe(self, **arguments: object) -> LaunchHarness:
        """Return safe_start.launch.py as it runs with these arguments."""
        return self._harness(SAFE, arguments, {}, finishes="self_test")

    def unusual(self, ending: str) -> LaunchHarness:
        """Return safe_start.launch.py above a self-test of `UNUSUAL`; its battery is given, and good enough."""
        return self._harness(SAFE, {"battery": self._inputs.enough}, {}, programs=ending)

    def scripted(self) -> LaunchHarness:
        """Return safe_start.launch.py above `SCRIPTS`."""
        return self._harness(SAFE, {"battery": self._inputs.enough}, {}, programs="scripts", finishes="self_test")

    def is_early(self, harness: LaunchHarness) -> bool:
        """Return whether in a launch of `safe` or `scripted` the driver ran beside the self-test."""
        return harness in self._early

    def safe_arguments(self) -> dict[str, launch_arguments.Argument]:
        """Return the arguments that safe_start.launch.py declares; raises as `declared_arguments` does."""
        return self._shown(SAFE)

    def close(self) -> None:
        """End what still runs."""
        self._stack.close()

    def _shown(self, file: str) -> dict[str, launch_arguments.Argument]:
        if file not in self._arguments:
            self._arguments[file] = launch_probe.declared_arguments(self._workspace, PACKAGE, file)
        return self._arguments[file]

    def _harness(
        self,
        file: str,
        arguments: Mapping[str, object],
        subscribes: Mapping[str, type],
        robot: str | None = None,
        programs: str | None = None,
        environment: Mapping[str, str] = ON_STDOUT,
        finishes: str = "",
        beside: str = "",
    ) -> LaunchHarness:
        """Return a running launch; if its program `finishes` hangs, a second launch of the same.

        It has the files of the launch file `beside`, or its own if there is none.
        """
        key = f"{file} {robot} {programs} {sorted(arguments.items())} {beside}"
        if key not in self._harnesses:
            words = {name: str(value) for name, value in arguments.items()}
            copy = self._copy(beside or file, robot, programs)
            harness = LaunchHarness(copy, PACKAGE, file, words, subscribes=subscribes, environment=environment)
            self._harnesses[key] = self._stack.enter_context(harness)
            if finishes and short_lived.ran_together(harness, finishes, "driver"):
                self._early.add(harness)
            if finishes and short_lived.hangs(harness, finishes):
                self._harnesses[key] = self._stack.enter_context(harness.another())
        return self._harnesses[key]

    def _copy(self, file: str, robot: str | None, programs: str | None = None) -> Workspace:
        name = robot or (programs or file).partition(".")[0].replace(" ", "_")
        if name not in self._copies:
            files = {} if robot is None else {f"launch/{ROBOT}": INCLUDED[robot]}
            config = self._workspace.install / PACKAGE / "share" / PACKAGE / CONFIG
            if config.is_file():
                text = with_values(given_parameters(), self._inputs.file)
                files[CONFIG] = with_sim_time(text) if file == ROBOT else text
            texts = {**given_programs(), **(PROGRAMS[programs] if programs else {})}
            self._copies[name] = launch_probe.with_files(self._workspace, name, PACKAGE, files, texts)
        return self._copies[name]
