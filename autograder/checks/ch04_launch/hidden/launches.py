"""Launches and their declared arguments, which several checks share."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack

from std_msgs.msg import String

from autograder.checking import LaunchHarness, Workspace
from autograder.checking.probes import launch_arguments, launch_probe, short_lived
from autograder.checks.ch04_launch.hidden import included
from autograder.checks.ch04_launch.hidden.given_files import given_parameters, given_programs
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

# launch always shows standard error. It shows standard output only with output='screen'.
ON_STDOUT = {"RCUTILS_LOGGING_USE_STDOUT": "1", "RCUTILS_LOGGING_BUFFERED_STREAM": "0"}
ON_STDERR = {**ON_STDOUT, "RCUTILS_LOGGING_USE_STDOUT": "0"}  # where nodes log by default
# Self-tests that end with neither exit status 0 nor 1.
UNUSUAL_SELF_TESTS = {"by a signal": "#!/bin/sh\nkill -KILL $$\n", "with exit status 3": "#!/bin/sh\nexit 3\n"}
# Stand-ins for the three programs: the self-test takes 3 s, the reporter ends every 0.1 s, the driver ends on SIGTERM.
SCRIPTS = {
    "self_test": "#!/bin/sh\nsleep 3\nexit 0\n",  # without exec, so that the process keeps the name self_test
    "reporter": "#!/bin/sh\nexec sleep 0.1\n",
    "driver": "#!/bin/sh\ntrap 'exit 3' TERM\nwhile sleep 0.2; do :; done\n",
}
# For a check of the reporter alone; a script starts faster than a node.
STILL = {"driver": "#!/bin/sh\nexec sleep 600\n"}
PROGRAMS = {
    "scripts": SCRIPTS,
    "still": STILL,
    **{ending: {"self_test": text} for ending, text in UNUSUAL_SELF_TESTS.items()},
}
# Arguments for two_robots.launch.py. Only one check tests whether they are its defaults.
DEFAULTS = {"first": FIRST, "second": SECOND, "speed": SPEED}
INCLUDED_FILES = {"like": included.LIKE_THE_REFERENCE, "wheels": included.WITH_ONE_NODE}


class Launches:
    """Starts each launch once, when a check first uses it, and ends all of them in `close`.

    Every launch starts the given programs, and reads the given parameters file with other numbers. For one robot, the
    file also sets another parameter. Launches of two robots include a robot.launch.py of the grader, so that a mistake
    in the student's file counts once. Only `own_fleet` includes the student's file.
    """

    def __init__(self, workspace: Workspace, inputs: Inputs) -> None:
        self._workspace, self._inputs = workspace, inputs
        self._stack = ExitStack()
        self._harnesses: dict[str, LaunchHarness] = {}
        self._copies: dict[str, Workspace] = {}
        self._early_launches: set[LaunchHarness] = set()
        self._arguments: dict[str, dict[str, launch_arguments.Argument]] = {}

    def robot(self, **arguments: object) -> LaunchHarness:
        """Return a launch of robot.launch.py with these arguments; with `report`, its nodes log on standard error."""
        return self._harness(ROBOT, arguments, {}, environment=ON_STDERR if "report" in arguments else ON_STDOUT)

    def quoted_robot(self) -> LaunchHarness:
        """Return a launch of robot.launch.py with quotation marks in the robot's name and a driver that sleeps."""
        return self._harness(ROBOT, {"robot_name": self._inputs.quoted_name}, {}, programs="still")

    def robot_arguments(self) -> dict[str, launch_arguments.Argument]:
        """Return the arguments that the student's robot.launch.py declares; raises as `declared_arguments` does."""
        return self._declared_arguments(ROBOT)

    def fleet(self, **arguments: object) -> LaunchHarness:
        """Return a launch of two_robots.launch.py with these arguments."""
        return self._harness(FLEET, arguments, {SHARED: String}, robot="like")

    def fleet_workspace(self) -> Workspace:
        """Return the workspace in which two_robots.launch.py runs."""
        return self._copy(FLEET, "like")

    def renamed_fleet(self) -> LaunchHarness:
        """Return a launch of two_robots.launch.py with a robot.launch.py whose only node is called wheels."""
        return self._harness(FLEET, DEFAULTS, {}, robot="wheels")

    def own_fleet(self) -> LaunchHarness:
        """Return a launch of two_robots.launch.py with the drawn speed and the student's robot.launch.py."""
        return self._harness(FLEET, {**DEFAULTS, "speed": self._inputs.speed}, {})

    def lone_robot(self) -> LaunchHarness:
        """Return a launch of the student's robot.launch.py with the speed and the files of `own_fleet`."""
        return self._harness(ROBOT, {"speed": self._inputs.speed}, {}, files_of=FLEET)

    def safe(self, **arguments: object) -> LaunchHarness:
        """Return a launch of safe_start.launch.py with these arguments."""
        return self._harness(SAFE, arguments, {}, short_lived_program="self_test")

    def unusual_start(self, ending: str) -> LaunchHarness:
        """Return a launch of safe_start.launch.py with one of `UNUSUAL_SELF_TESTS` and a sufficient battery level."""
        return self._harness(SAFE, {"battery": self._inputs.sufficient_battery}, {}, programs=ending)

    def scripted_start(self) -> LaunchHarness:
        """Return a launch of safe_start.launch.py with the programs `SCRIPTS`."""
        return self._harness(
            SAFE, {"battery": self._inputs.sufficient_battery}, {}, programs="scripts", short_lived_program="self_test"
        )

    def is_early(self, harness: LaunchHarness) -> bool:
        """Return whether the driver ran during the self-test, in a launch of `safe` or `scripted_start`."""
        return harness in self._early_launches

    def safe_arguments(self) -> dict[str, launch_arguments.Argument]:
        """Return the arguments that safe_start.launch.py declares; raises as `declared_arguments` does."""
        return self._declared_arguments(SAFE)

    def close(self) -> None:
        """End all launches."""
        self._stack.close()

    def _declared_arguments(self, file: str) -> dict[str, launch_arguments.Argument]:
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
        short_lived_program: str = "",
        files_of: str = "",
    ) -> LaunchHarness:
        """Return a running launch; if its program `short_lived_program` hangs, return another launch like it.

        The launch uses the files that were prepared for the launch file `files_of`, by default for its own.
        """
        key = f"{file} {robot} {programs} {sorted(arguments.items())} {files_of}"
        if key not in self._harnesses:
            argument_texts = {name: str(value) for name, value in arguments.items()}
            copy = self._copy(files_of or file, robot, programs)
            harness = LaunchHarness(copy, PACKAGE, file, argument_texts, subscribes=subscribes, environment=environment)
            self._harnesses[key] = self._stack.enter_context(harness)
            if short_lived_program and short_lived.ran_together(harness, short_lived_program, "driver"):
                self._early_launches.add(harness)
            if short_lived_program and short_lived.hangs(harness, short_lived_program):
                self._harnesses[key] = self._stack.enter_context(harness.another())
        return self._harnesses[key]

    def _copy(self, file: str, robot: str | None, programs: str | None = None) -> Workspace:
        name = robot or (programs or file).partition(".")[0].replace(" ", "_")
        if name not in self._copies:
            files = {} if robot is None else {f"launch/{ROBOT}": INCLUDED_FILES[robot]}
            config = self._workspace.install / PACKAGE / "share" / PACKAGE / CONFIG
            if config.is_file():
                text = with_values(given_parameters(), self._inputs.file_values)
                files[CONFIG] = with_sim_time(text) if file == ROBOT else text
            programs_by_name = {**given_programs(), **(PROGRAMS[programs] if programs else {})}
            self._copies[name] = launch_probe.with_files(self._workspace, name, PACKAGE, files, programs_by_name)
        return self._copies[name]
