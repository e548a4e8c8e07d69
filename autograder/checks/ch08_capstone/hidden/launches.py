"""Step 4: one command starts the three nodes, with a parameters file and use_sim_time as arguments."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random

import pytest
import yaml

from autograder.checking import LaunchHarness, Workspace, expect, group, hint
from autograder.checking.probes import files, launch_probe
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    CONFIG,
    LAUNCH_FILE,
    PACKAGE,
    PARAMETERS,
    PROGRAMS,
    BoundedParameter,
    name_of,
)

check = group("step_4", doc=contract.LAUNCH_DOC)
INSTALL_CHECKS = ("shares",)
START_CHECKS = ("executables", "shares", "interface_package")
OTHER_CONFIG = "config/of_another_robot.yaml"
MAX_SCRIPT = 64 * 1024  # bytes; scripts that setuptools writes have about a thousand
SHOWN_SECONDS = 5.0  # s of real time in which the line of a running program must appear on the screen
# A launch file that includes the student's launch file in a namespace. Its programs print their arguments.
NAMESPACE, INCLUDING_FILE = "robot7", "of_one_robot.launch.py"
INCLUDING_TEXT = f"""from pathlib import Path

from launch import LaunchDescription
from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import PushRosNamespace


def generate_launch_description():
    file = Path(__file__).with_name('{LAUNCH_FILE}')
    include = IncludeLaunchDescription(PythonLaunchDescriptionSource(str(file)))
    return LaunchDescription([GroupAction([PushRosNamespace('{NAMESPACE}'), include])])
"""
ARGUMENTS_SCRIPT = '#!/bin/sh\necho "${0##*/} got: $*" >&2\nexec sleep 600\n'  # launch always shows standard error
_ARGUMENTS = re.compile(r"\b(?P<program>\w+) got: (?P<arguments>.*)")
_ABSOLUTE_REMAPPING = re.compile(r"(?:-r|--remap) (?P<name>\S+?):=(?P<target>/\S*)")
HINTS = (
    "Node(package='robot_navigation_tutorial', executable=name, name=name, output='screen', parameters=[...])",
    "parameters=[LaunchConfiguration('params_file'), {'use_sim_time': LaunchConfiguration('use_sim_time')}]",
)


@dataclass(frozen=True)
class RunningLaunch:
    """The student's launch file, running with the grader's parameters file and with simulated time.

    Attributes:
        harness: the harness in which it runs.
        values: the parameters in the file, by node.
        lines: the first line that a program prints, by the program's name.
    """

    harness: LaunchHarness
    values: Mapping[str, Mapping[str, float]]
    lines: Mapping[str, str]

    def silent_programs(self) -> list[str]:
        """Return the programs whose lines are not yet on the screen."""
        return [name for name, line in self.lines.items() if line not in self.harness.output]


def draw_values(seed: int) -> dict[str, dict[str, float]]:
    """Draw a value for each parameter of each node."""
    draw = Random(f"{seed}:launch")
    return {
        node: {name: _draw_value(draw, parameter) for name, parameter in parameters.items()}
        for node, parameters in PARAMETERS.items()
    }


@pytest.fixture(scope="module")
def running_launch(workspace: Workspace, seed: int) -> Iterator[RunningLaunch]:
    """A launch that all checks of this module share."""
    values = draw_values(seed)
    text = yaml.safe_dump({node: {"ros__parameters": dict(parameters)} for node, parameters in values.items()})
    lines = {name: f"{name} begins" for name in PROGRAMS}
    scripts = {name: script for name, line in lines.items() if (script := _script_with_line(workspace, name, line))}
    copy = launch_probe.with_files(workspace, "launched", PACKAGE, {OTHER_CONFIG: text}, scripts)
    arguments = {"params_file": str(copy.install / PACKAGE / "share" / PACKAGE / OTHER_CONFIG), "use_sim_time": "true"}
    with LaunchHarness(copy, PACKAGE, LAUNCH_FILE, arguments) as harness:
        yield RunningLaunch(harness, values, {name: lines[name] for name in scripts})


@check(points=1, covers="launch-arguments", needs=("build",), after=INSTALL_CHECKS)
@hint("ros2 launch -s robot_navigation_tutorial navigation.launch.py lists the arguments that you have declared.")
@hint("DeclareLaunchArgument('use_sim_time', default_value='false', description='...'), and the same for params_file.")
def test_launch_arguments(workspace: Workspace) -> None:
    """The launch file declares params_file (default: the installed file) and use_sim_time (default: false)."""
    arguments = launch_probe.declared_arguments(workspace, PACKAGE, LAUNCH_FILE)
    launch_probe.expect_argument(arguments, "use_sim_time", "false")
    declared_names = ", ".join(arguments)
    expect(
        "params_file" in arguments, f"The launch file declares no argument params_file; it declares: {declared_names}."
    )
    argument = arguments["params_file"]
    if argument.default is None:
        _expect_starts_without(workspace, "params_file")
    else:  # launch does not show a default that is computed when it runs
        installed_config = workspace.install / PACKAGE / "share" / PACKAGE / CONFIG
        message = f"The argument params_file has the default {argument.default!r}, instead of"
        is_installed = Path(argument.default).resolve() == installed_config.resolve()
        expect(is_installed, f"{message} the full path of the installed {CONFIG}.", fraction=0.5)
    expect(bool(argument.description), "The argument params_file has no description.", fraction=0.5)


def _expect_starts_without(workspace: Workspace, name: str) -> None:
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, {}) as harness:
        harness.wait_for(
            lambda: bool(launch_probe.started(harness.output)) or harness.status is not None, launch_probe.START_SECONDS
        )
        reason = launch_probe.failure(harness.output)
        is_started = bool(launch_probe.started(harness.output))
    expect(
        is_started,
        f"Without {name}:=..., the launch starts nothing: the argument has no default. {reason}",
        fraction=0.5,
    )


@check(points=2, covers="launches", needs=("build",), after=START_CHECKS)
@hint(*HINTS)
def test_launch_starts(running_launch: RunningLaunch) -> None:
    """The launch file starts the three nodes under their names, and nothing else."""
    launch_probe.expect_nodes(running_launch.harness, [name_of(name) for name in PROGRAMS])
    # Two nodes with the same name may look like one in the graph.
    programs = launch_probe.started(running_launch.harness.output)
    message = f"The launch starts {len(programs)} programs, instead of {len(PROGRAMS)}: {', '.join(programs)}."
    expect(len(programs) <= len(PROGRAMS), message, fraction=0.5)


@check(points=2, covers=("launch-arguments", "launches", "relative"), needs=("build",), after=("launch_starts",))
@hint(*HINTS)
@hint("In a namespace, a robot has its own topics: no remapping to a name with a leading slash, and no namespace='/'.")
def test_launch_configures(running_launch: RunningLaunch, workspace: Workspace) -> None:
    """All three nodes get params_file and use_sim_time, and all names stay in the namespace of the launch file."""
    running_nodes = {
        node: values
        for node, values in running_launch.values.items()
        if name_of(node) in running_launch.harness.nodes()
    }
    expect(bool(running_nodes), "None of the three nodes runs under its name.")
    for node, values in running_nodes.items():
        launch_probe.expect_parameters(running_launch.harness, name_of(node), {"use_sim_time": True})
        actual = running_launch.harness.parameters(name_of(node), list(values)) or {}
        # Another check tests which parameters a node declares.
        expected = {name: value for name, value in values.items() if actual.get(name) is not None}
        launch_probe.expect_parameters(running_launch.harness, name_of(node), expected)
    running_launch.harness.wait_for(lambda: not running_launch.silent_programs(), SHOWN_SECONDS)
    silent_programs = ", ".join(running_launch.silent_programs())
    expect(
        not silent_programs,
        f"The output of {silent_programs} is not on the screen: output='screen' is missing.",
        fraction=0.75,
    )
    remapping = _absolute_remapping(workspace)
    message = (
        f"In the namespace /{NAMESPACE}, the launch file starts {remapping}: a relative name has no leading slash."
    )
    expect(not remapping, message, fraction=0.75)


@check(points=2, covers="launch-ctrl-c", needs=("build",), after=("launch_starts",))
@hint("Each program's main calls run(...), which ends without a traceback.")
@hint("except (KeyboardInterrupt, ExternalShutdownException): pass, and rclpy.try_shutdown() in finally.")
def test_launch_stops(running_launch: RunningLaunch) -> None:
    """Ctrl-C ends the launch and each of its nodes cleanly."""
    expect(bool(running_launch.harness.nodes()), "No node is running, so Ctrl-C has nothing to end.")
    launch_probe.expect_clean_stop(running_launch.harness)


def _absolute_remapping(workspace: Workspace) -> str:
    """Describe the first remapping to a name outside of the namespace in which the launch file is included."""
    scripts = dict.fromkeys(PROGRAMS, ARGUMENTS_SCRIPT)
    copy = launch_probe.with_files(
        workspace, "included", PACKAGE, {f"launch/{INCLUDING_FILE}": INCLUDING_TEXT}, scripts
    )
    with LaunchHarness(copy, PACKAGE, INCLUDING_FILE) as harness:
        harness.wait_for(lambda: len(_ARGUMENTS.findall(harness.output)) >= len(PROGRAMS), launch_probe.START_SECONDS)
        output = harness.output
    return next(
        (
            f"{match['program']} with the remapping {remapping['name']}:={remapping['target']}"
            for match in _ARGUMENTS.finditer(output)
            for remapping in _ABSOLUTE_REMAPPING.finditer(match["arguments"])
            if not f"{remapping['target']}/".startswith(f"/{NAMESPACE}/")
        ),
        "",
    )


def _script_with_line(workspace: Workspace, name: str, line: str) -> str:
    """Return an installed program's script with a first statement that prints a line, or "" if that is impossible."""
    data = files.read_limited(workspace.executable(PACKAGE, name), MAX_SCRIPT, f"The installed program {name}")
    first, _, remaining = data.decode(errors="replace").partition("\n")
    # A __future__ import has to be the first statement.
    is_suitable = "python" in first and "__future__" not in remaining
    return f"{first}\nprint({line!r}, flush=True)\n{remaining}" if is_suitable else ""


def _draw_value(draw: Random, parameter: BoundedParameter) -> float:
    return round(draw.uniform(parameter.lowest, parameter.highest), 3)
