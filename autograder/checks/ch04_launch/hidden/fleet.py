"""Two robots from one file: namespaces, an include, one shared topic."""

from __future__ import annotations

from contextlib import suppress

from autograder.checks import expect, group, hint
from autograder.checks.ch04_launch.hidden.inputs import Inputs
from autograder.checks.ch04_launch.hidden.launches import Launches
from autograder.checks.ch04_launch.support import contract
from autograder.checks.ch04_launch.support.contract import FIRST, FLEET, PACKAGE, SECOND, SHARED, in_spaces
from autograder.checks.ch04_launch.support.status import HEAR_SECONDS, reporting_robots
from autograder.exceptions import StudentError
from autograder.harness.launch import LaunchHarness
from autograder.probes import launch_probe

check = group("fleet")
MATCH_SECONDS = 5.0  # real time for a node's topics to be seen, once the node is
GROUPED = "GroupAction([PushRosNamespace(name), SetRemap(...), IncludeLaunchDescription(...)]), once a robot."


@check(points=3, holds=("first", "second", "included"), doc=contract.LARGE)
@hint("What is pushed in a GroupAction holds to its end; without a group it holds for all that follows.", GROUPED)
def test_two_robots(launches: Launches) -> None:
    """two_robots.launch.py starts driver and reporter in /robot1 and in /robot2, and nothing else."""
    launch_probe.expect_nodes(launches.fleet(), in_spaces(FIRST, SECOND))


@check(points=2, holds="included", needs=("two_robots",), doc=contract.LARGE)
@hint("IncludeLaunchDescription(PythonLaunchDescriptionSource(path), launch_arguments=...)")
@hint("path leads to launch/robot.launch.py in the package's share folder.")
@hint("robot_name and speed are handed on; report keeps the default that robot.launch.py declares.")
def test_includes(launches: Launches) -> None:
    """It includes robot.launch.py, so that what is changed there is changed for both robots."""
    wanted = [f"/{FIRST}/wheels", f"/{SECOND}/wheels"]
    nodes = launch_probe.settle(launches.renamed_fleet(), wanted)
    expect(
        nodes == wanted,
        "The checks put a robot.launch.py with one node, wheels, and report:=false beside your file; it started "
        f"{', '.join(nodes) or 'nothing'} instead of {' and '.join(wanted)}.",
    )


@check(points=1, holds=("first", "second", "fleet-speed", "fleet-described"), doc=contract.SUBSTITUTIONS)
@hint("ros2 launch -s my_robot_bringup two_robots.launch.py shows what you have declared.")
@hint("DeclareLaunchArgument('first', default_value='robot1', description='...')")
def test_fleet_arguments(launches: Launches) -> None:
    """two_robots.launch.py declares first, second and speed, each with its default and a description."""
    arguments = launch_probe.shown_arguments(
        launches.fleet_workspace(), PACKAGE, FLEET
    )  # those of what it includes, too
    for name, default in (("first", FIRST), ("second", SECOND), ("speed", str(contract.SPEED))):
        launch_probe.expect_argument(arguments, name, default)


@check(points=2, holds=("first", "second"), needs=("two_robots",), doc=contract.SUBSTITUTIONS)
@hint("PushRosNamespace takes a substitution: PushRosNamespace(LaunchConfiguration('first')).", GROUPED)
def test_spaces(launches: Launches, inputs: Inputs) -> None:
    """First and second name the two namespaces."""
    launch_probe.expect_nodes(_renamed(launches, inputs), in_spaces(*inputs.names))


@check(points=2, holds=("first", "second"), needs=("spaces",), doc=contract.LARGE)
@hint("launch_arguments={'robot_name': name, 'speed': speed}.items() hands arguments on to the included file.")
@hint("A robot's robot_name is its own namespace's name.")
def test_robot_names(launches: Launches, inputs: Inputs) -> None:
    """Each robot reports under its own name."""
    harness = _renamed(launches, inputs)
    for name in inputs.names:
        launch_probe.expect_parameters(harness, f"/{name}/reporter", {"robot_name": name})


@check(points=2, holds="fleet-speed", needs=("spaces",), doc=contract.LARGE)
@hint("The included file has an argument of its own called speed: hand yours on to it.")
@hint("launch_arguments={..., 'speed': LaunchConfiguration('speed')}.items()")
def test_fleet_speed(launches: Launches, inputs: Inputs) -> None:
    """The argument speed reaches both drivers."""
    harness = _renamed(launches, inputs)
    for name in inputs.names:
        launch_probe.expect_parameters(harness, f"/{name}/driver", {"speed": inputs.speed})


@check(points=3, holds="fleet-status", needs=("two_robots",), doc=contract.LARGE)
@hint("SetRemap('status', '/fleet/status') must stand before the include: it holds for what follows it in its group.")
@hint("With the slash in front the name is the same for everybody; without it, it is in each robot's namespace.")
def test_status(launches: Launches, inputs: Inputs) -> None:
    """Both robots report on /fleet/status."""
    harness = launches.fleet()
    wanted = [f"/{FIRST}/reporter", f"/{SECOND}/reporter"]
    harness.wait_for(lambda: harness.publishers(SHARED) == wanted, MATCH_SECONDS)
    on = {topic: harness.publishers(topic) for topic in (SHARED, f"/{FIRST}/status", f"/{SECOND}/status", "/status")}
    seen = "; ".join(f"{topic}: {', '.join(names)}" for topic, names in on.items() if names)
    share = len(set(wanted) & set(on[SHARED])) / 2
    expect(on[SHARED] == wanted, f"Reports are published on {seen or 'no topic'}.", fraction=min(share, 0.5))
    harness.wait_for(lambda: len(reporting_robots(harness)) == 2, HEAR_SECONDS)
    heard = sorted(reporting_robots(harness))
    said = f"On {SHARED}, {' and '.join(heard) or 'nobody'} was heard within {HEAR_SECONDS:.0f} s."
    expect(len(heard) == 2, said, fraction=0.5)
    renamed = _renamed(launches, inputs)
    if _starts(renamed, *inputs.names):
        wanted = sorted(f"/{name}/reporter" for name in inputs.names)
        alike = renamed.wait_for(lambda: renamed.publishers(SHARED) == wanted, MATCH_SECONDS)
        said = f"{', '.join(renamed.publishers(SHARED)) or 'nobody'}, instead of {' and '.join(wanted)}"
        expect(alike, f"With other names of the robots, reports on {SHARED} come from {said}.", fraction=0.8)


@check(points=2, holds="fleet-status", needs=("two_robots",), doc=contract.LARGE)
@hint("Only status is remapped; cmd_vel stays relative, and so in each robot's namespace.")
@hint("ros2 topic info -v /robot1/cmd_vel names who is at which end.")
def test_own_commands(launches: Launches, inputs: Inputs) -> None:
    """Each robot has a cmd_vel of its own, from its driver to its reporter."""
    for name in (FIRST, SECOND):
        _expect_own_commands(launches.fleet(), name, "")
    for harness, names, where in (
        (_renamed(launches, inputs), inputs.names, "With other names of the robots, "),
        (launches.own_fleet(), (FIRST, SECOND), "With your robot.launch.py, "),
    ):
        for name in names if _starts(harness, *names) else ():
            _expect_own_commands(harness, name, where, fraction=0.75)


@check(points=1, holds="fleet-ctrl-c", needs=("two_robots",))
@hint("What Node(...) starts, the launch ends.")
def test_fleet_stop(launches: Launches) -> None:
    """Ctrl-C ends all four nodes cleanly and leaves nothing behind."""
    launch_probe.expect_clean_stop(launches.fleet())


def _expect_own_commands(harness: LaunchHarness, name: str, where: str, fraction: float = 0.0) -> None:
    """Fail the check unless a robot's driver alone commands its reporter alone."""
    wanted = [f"/{name}/driver"], [f"/{name}/reporter"]
    seen = harness.wait_for(lambda: _ends(harness, name) == wanted, MATCH_SECONDS)
    way = " to ".join(", ".join(end) or "nobody" for end in _ends(harness, name))
    expect(seen, f"{where}/{name}/cmd_vel goes from {way}.", fraction=fraction)


def _ends(harness: LaunchHarness, name: str) -> tuple[list[str], list[str]]:
    return harness.publishers(f"/{name}/cmd_vel"), harness.subscribers(f"/{name}/cmd_vel")


def _starts(harness: LaunchHarness, *names: str) -> bool:
    """Return whether a launch starts these robots and nothing else; if it does not, other checks say so."""
    with suppress(StudentError):
        return launch_probe.settle(harness, in_spaces(*names)) == in_spaces(*names)
    return False


def _renamed(launches: Launches, inputs: Inputs) -> LaunchHarness:
    first, second = inputs.names
    return launches.fleet(first=first, second=second, speed=inputs.speed)
