"""Step 4: one command starts the three nodes, with the parameters and the clock that it is given."""

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
    Bounded,
    name_of,
)

check = group("step_4", doc=contract.LAUNCH_DOC)
SHARED = ("shares",)
STARTS = ("executables", "shares", "interface_package")
OTHER_CONFIG = "config/of_another_robot.yaml"
MAX_SCRIPT = 64 * 1024  # bytes; setuptools writes about a thousand
SHOWN_SECONDS = 5.0  # real time until a line of a program that runs is shown
# What includes the launch file below a namespace, above programs that show what they are given.
SPACE, INCLUDING = "robot7", "of_one_robot.launch.py"
INCLUDING_TEXT = f"""from pathlib import Path

from launch import LaunchDescription
from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import PushRosNamespace


def generate_launch_description():
    file = Path(__file__).with_name('{LAUNCH_FILE}')
    include = IncludeLaunchDescription(PythonLaunchDescriptionSource(str(file)))
    return LaunchDescription([GroupAction([PushRosNamespace('{SPACE}'), include])])
"""
SHOWS_ARGUMENTS = '#!/bin/sh\necho "${0##*/} got: $*" >&2\nexec sleep 600\n'  # launch shows standard error in any case
_GOT = re.compile(r"\b(?P<program>\w+) got: (?P<words>.*)")
_ABSOLUTE = re.compile(r"(?:-r|--remap) (?P<name>\S+?):=(?P<to>/\S*)")
HINTS = (
    "Node(package='robot_navigation_tutorial', executable=name, name=name, output='screen', parameters=[...])",
    "parameters=[LaunchConfiguration('params_file'), {'use_sim_time': LaunchConfiguration('use_sim_time')}]",
)


@dataclass(frozen=True)
class Launched:
    """The launch file as it runs with a parameters file of the grader's own, and with simulated time.

    Attributes:
        harness: where it runs.
        values: what the parameters file says, by node.
        lines: what a program prints first, by its name.
    """

    harness: LaunchHarness
    values: Mapping[str, Mapping[str, float]]
    lines: Mapping[str, str]

    def unseen(self) -> list[str]:
        """Return the programs whose lines are not on the screen."""
        return [name for name, line in self.lines.items() if line not in self.harness.output]


def draw_values(seed: int) -> dict[str, dict[str, float]]:
    """Return a value for each parameter of each node."""
    draw = Random(f"{seed}:launch")
    return {
        node: {name: _between(draw, parameter) for name, parameter in parameters.items()}
        for node, parameters in PARAMETERS.items()
    }


@pytest.fixture(scope="module")
def launched(workspace: Workspace, seed: int) -> Iterator[Launched]:
    """One launch, for all checks of this module."""
    values = draw_values(seed)
    text = yaml.safe_dump({node: {"ros__parameters": dict(own)} for node, own in values.items()})
    lines = {name: f"{name} begins" for name in PROGRAMS}
    scripts = {name: script for name, line in lines.items() if (script := _printing(workspace, name, line))}
    copy = launch_probe.with_files(workspace, "launched", PACKAGE, {OTHER_CONFIG: text}, scripts)
    arguments = {"params_file": str(copy.install / PACKAGE / "share" / PACKAGE / OTHER_CONFIG), "use_sim_time": "true"}
    with LaunchHarness(copy, PACKAGE, LAUNCH_FILE, arguments) as harness:
        yield Launched(harness, values, {name: lines[name] for name in scripts})


@check(points=1, covers="launch-arguments", needs=("build",), after=SHARED)
@hint("ros2 launch -s robot_navigation_tutorial navigation.launch.py shows what you have declared.")
@hint("DeclareLaunchArgument('use_sim_time', default_value='false', description='...'), and params_file likewise.")
def test_launch_arguments(workspace: Workspace) -> None:
    """The launch file declares params_file, by default the package's own, and use_sim_time, by default false."""
    arguments = launch_probe.shown_arguments(workspace, PACKAGE, LAUNCH_FILE)
    launch_probe.expect_argument(arguments, "use_sim_time", "false")
    there = ", ".join(arguments)
    expect("params_file" in arguments, f"The launch file declares no argument params_file; it declares: {there}.")
    found = arguments["params_file"]
    if found.default is None:
        _expect_starts_without(workspace, "params_file")
    else:  # a default that is put together when the launch runs is not shown as a text
        installed = workspace.install / PACKAGE / "share" / PACKAGE / CONFIG
        said = f"The argument params_file has the default {found.default!r}, instead of"
        is_installed = Path(found.default).resolve() == installed.resolve()
        expect(is_installed, f"{said} the whole path of the installed {CONFIG}.", fraction=0.5)
    expect(bool(found.description), "The argument params_file has no description.", fraction=0.5)


def _expect_starts_without(workspace: Workspace, name: str) -> None:
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, {}) as harness:
        harness.wait_for(
            lambda: bool(launch_probe.started(harness.output)) or harness.status is not None, launch_probe.START_SECONDS
        )
        why = launch_probe.failure(harness.output)
        begun = bool(launch_probe.started(harness.output))
    expect(begun, f"Without {name}:=..., the launch starts nothing: the argument has no default. {why}", fraction=0.5)


@check(points=2, covers="launches", needs=("build",), after=STARTS)
@hint(*HINTS)
def test_launch_starts(launched: Launched) -> None:
    """The launch file starts the three nodes under their names, and nothing else."""
    launch_probe.expect_nodes(launched.harness, [name_of(name) for name in PROGRAMS])
    # Two nodes of one name may look like one in the graph.
    programs = launch_probe.started(launched.harness.output)
    said = f"The launch starts {len(programs)} programs: {', '.join(programs)}."
    expect(len(programs) <= len(PROGRAMS), said, fraction=0.5)


@check(points=2, covers=("launch-arguments", "launches", "relative"), needs=("build",), after=("launch_starts",))
@hint(*HINTS)
@hint("A robot in a namespace has topics of its own: no remapping to a name with a slash in front, no namespace='/'.")
def test_launch_configures(launched: Launched, workspace: Workspace) -> None:
    """What params_file and use_sim_time say reaches all three nodes, and all names stay in their namespace."""
    there = {node: values for node, values in launched.values.items() if name_of(node) in launched.harness.nodes()}
    expect(bool(there), "None of the three nodes runs under its name.")
    for node, values in there.items():
        launch_probe.expect_parameters(launched.harness, name_of(node), {"use_sim_time": True})
        declared = launched.harness.parameters(name_of(node), list(values)) or {}
        # Which parameters a node declares is judged by itself: here it counts that the file's values arrive.
        known = {name: value for name, value in values.items() if declared.get(name) is not None}
        launch_probe.expect_parameters(launched.harness, name_of(node), known)
    launched.harness.wait_for(lambda: not launched.unseen(), SHOWN_SECONDS)
    unseen = ", ".join(launched.unseen())
    expect(not unseen, f"What {unseen} prints is not on the screen: output='screen' is missing.", fraction=0.75)
    absolute = _absolute_names(workspace)
    said = f"Included in the namespace /{SPACE}, the launch file gives {absolute}: a relative name has no slash."
    expect(not absolute, said, fraction=0.75)


@check(points=2, covers="launch-ctrl-c", needs=("build",), after=("launch_starts",))
@hint("Each program's main goes through run(...), which ends without a traceback.")
@hint("except (KeyboardInterrupt, ExternalShutdownException): pass, and rclpy.try_shutdown() in finally.")
def test_launch_stops(launched: Launched) -> None:
    """Ctrl-C ends the launch and each of its nodes cleanly."""
    expect(bool(launched.harness.nodes()), "No node runs that Ctrl-C could end.")
    launch_probe.expect_clean_stop(launched.harness)


def _absolute_names(workspace: Workspace) -> str:
    """Return which name the launch file takes out of a namespace in which it is included, and to which program."""
    scripts = dict.fromkeys(PROGRAMS, SHOWS_ARGUMENTS)
    copy = launch_probe.with_files(workspace, "included", PACKAGE, {f"launch/{INCLUDING}": INCLUDING_TEXT}, scripts)
    with LaunchHarness(copy, PACKAGE, INCLUDING) as harness:
        harness.wait_for(lambda: len(_GOT.findall(harness.output)) >= len(PROGRAMS), launch_probe.START_SECONDS)
        output = harness.output
    return next(
        (
            f"{got['program']} the rule {rule['name']}:={rule['to']}"
            for got in _GOT.finditer(output)
            for rule in _ABSOLUTE.finditer(got["words"])
            if not f"{rule['to']}/".startswith(f"/{SPACE}/")
        ),
        "",
    )


def _printing(workspace: Workspace, name: str, line: str) -> str:
    """Return an installed program that prints a line before anything else; empty if it is no script that can."""
    data = files.read_plain(workspace.executable(PACKAGE, name), MAX_SCRIPT) or b""
    first, _, rest = data.decode(errors="replace").partition("\n")
    can = "python" in first and "__future__" not in rest  # such an import has to come first
    return f"{first}\nprint({line!r}, flush=True)\n{rest}" if can else ""


def _between(draw: Random, parameter: Bounded) -> float:
    return round(draw.uniform(parameter.lowest, parameter.highest), 3)
