"""Checks of two_robots.launch.py: namespaces, an include and a shared topic."""

from __future__ import annotations

from contextlib import suppress
from functools import partial

from autograder.checking import CheckFailed, LaunchHarness, StudentError, expect, group, hint
from autograder.checking.probes import launch_probe, parameters
from autograder.checks.ch04_launch.hidden.inputs import Inputs
from autograder.checks.ch04_launch.hidden.launches import Launches
from autograder.checks.ch04_launch.support import contract
from autograder.checks.ch04_launch.support.contract import (
    DRIVER,
    FIRST,
    FLEET,
    PACKAGE,
    REPORTER,
    SECOND,
    SHARED,
    nodes_in_namespaces,
)
from autograder.checks.ch04_launch.support.status import REPORT_SECONDS

check = group("fleet")
MATCH_SECONDS = 5.0  # s of real time from a node's discovery to that of its topics
GROUP_HINT = "GroupAction([PushRosNamespace(name), SetRemap(...), IncludeLaunchDescription(...)]) for each robot."


@check(points=3, covers=("first", "second", "included"), doc=contract.LARGE)
@hint("A namespace set in a GroupAction ends with it. Without a group, it applies to all that follows.", GROUP_HINT)
def test_two_robots(launches: Launches) -> None:
    """two_robots.launch.py starts driver and reporter in /robot1 and in /robot2, and nothing else."""
    launch_probe.expect_nodes(launches.fleet(), nodes_in_namespaces(FIRST, SECOND))


@check(points=2, covers="included", after=("two_robots",), doc=contract.LARGE)
@hint("IncludeLaunchDescription(PythonLaunchDescriptionSource(path), launch_arguments=...)")
@hint("path is the path of launch/robot.launch.py in the package's share folder.")
@hint("Pass robot_name and speed on; report keeps the default that robot.launch.py declares.")
def test_includes(launches: Launches) -> None:
    """two_robots.launch.py includes robot.launch.py, so that a change there changes both robots."""
    expected = [f"/{FIRST}/wheels", f"/{SECOND}/wheels"]
    nodes = launch_probe.settle(launches.renamed_fleet(), expected)
    wheel_nodes = [name for name in nodes if name.endswith("/wheels")]  # other checks test the namespaces
    message = (
        "The checks replaced robot.launch.py: the new one starts the node wheels if report has its default, false. "
        f"Your file started {', '.join(nodes) or 'nothing'} instead of {' and '.join(expected)}."
    )
    expect(len(wheel_nodes) == len(nodes) == 2, message, fraction=0.5 if nodes and wheel_nodes == nodes else 0.0)


@check(points=1, covers=("first", "second", "fleet-speed", "fleet-described"), doc=contract.SUBSTITUTIONS)
@hint("ros2 launch -s my_robot_bringup two_robots.launch.py shows what you have declared.")
@hint("DeclareLaunchArgument('first', default_value='robot1', description='...')")
def test_fleet_arguments(launches: Launches) -> None:
    """two_robots.launch.py declares first, second and speed, each with its default and a description."""
    # These include the arguments that the included file declares.
    arguments = launch_probe.declared_arguments(launches.fleet_workspace(), PACKAGE, FLEET)
    for name, default in (("first", FIRST), ("second", SECOND), ("speed", str(contract.SPEED))):
        launch_probe.expect_argument(arguments, name, default)


@check(points=2, covers=("first", "second"), after=("two_robots",), doc=contract.SUBSTITUTIONS)
@hint("PushRosNamespace takes a substitution: PushRosNamespace(LaunchConfiguration('first')).", GROUP_HINT)
def test_spaces(launches: Launches, inputs: Inputs) -> None:
    """The arguments first and second name the two namespaces."""
    launch_probe.expect_nodes(_drawn_fleet(launches, inputs), nodes_in_namespaces(*inputs.names))


@check(points=2, covers=("first", "second"), after=("spaces",), doc=contract.LARGE)
@hint("launch_arguments={'robot_name': name, 'speed': speed}.items() passes the arguments on to the included file.")
@hint("Each robot's robot_name is the name of its namespace.")
def test_robot_names(launches: Launches, inputs: Inputs) -> None:
    """Each robot reports under its own name."""
    harness = _drawn_fleet(launches, inputs)
    reporters = _both_nodes(harness, inputs.names, REPORTER)
    actual = {node: (harness.parameters(node, ["robot_name"]) or {}).get("robot_name") for node in reporters}
    expected = {f"/{name}{REPORTER}": name for name in inputs.names}
    is_correct = (
        actual == expected
        if actual.keys() == expected.keys()
        else sorted(map(str, actual.values())) == sorted(inputs.names)
    )
    message = "; ".join(f"{node} has robot_name = {name!r}" for node, name in actual.items())
    situation = f"With first:={inputs.names[0]} and second:={inputs.names[1]}"
    expect(is_correct, f"{situation}, {message}. Each robot_name should be the name of the robot's namespace.")


@check(points=2, covers="fleet-speed", after=("spaces",), doc=contract.LARGE)
@hint("The included file has its own argument speed: pass yours on to it.")
@hint("launch_arguments={..., 'speed': LaunchConfiguration('speed')}.items()")
def test_fleet_speed(launches: Launches, inputs: Inputs) -> None:
    """The argument speed reaches both drivers."""
    harness = _drawn_fleet(launches, inputs)
    for node in _both_nodes(harness, inputs.names, DRIVER):
        launch_probe.expect_parameters(harness, node, {"speed": inputs.speed})
    own_fleet = launches.own_fleet()
    for node in (f"/{FIRST}{DRIVER}", f"/{SECOND}{DRIVER}") if _starts_robots(own_fleet, FIRST, SECOND) else ():
        speed = _speed(own_fleet, node)
        if not parameters.same(speed, inputs.speed) and parameters.same(
            _speed(launches.lone_robot(), DRIVER), inputs.speed
        ):
            message = f"With your robot.launch.py and speed:={inputs.speed}, {node} has speed = {speed!r}"
            raise CheckFailed(
                f"{message}; started alone, without a namespace, the driver has {inputs.speed!r}.", fraction=0.5
            )


@check(points=3, covers="fleet-status", after=("two_robots",), doc=contract.LARGE)
@hint("Put SetRemap('status', '/fleet/status') before the include: it is valid for what follows it in the group.")
@hint("A name that begins with a slash is the same for all robots. Any other name is in each robot's namespace.")
def test_status(launches: Launches, inputs: Inputs) -> None:
    """Both robots report on /fleet/status."""
    for names, harness, fraction in (
        ((FIRST, SECOND), launches.fleet(), 0.0),
        (inputs.names, _drawn_fleet(launches, inputs), 0.8),
    ):
        expected = _both_nodes(harness, names, REPORTER)
        harness.wait_for(partial(_are_publishers, harness, expected), MATCH_SECONDS)
        topics = (SHARED, *(f"/{name}/status" for name in names), "/status")
        publishers = {topic: harness.publishers(topic) for topic in topics}
        publishers_text = " and ".join(
            f"{topic} (by {', '.join(nodes)})" for topic, nodes in publishers.items() if nodes
        )
        share = len(set(expected) & set(publishers[SHARED])) / 2
        message = (
            f"The robots {' and '.join(names)} report on {publishers_text or 'no topic'}, instead of on {SHARED} (by "
            f"{', '.join(expected)})."
        )
        expect(publishers[SHARED] == expected, message, fraction=max(fraction, min(share, 0.5)))
        has_messages = harness.wait_for(partial(_has_messages, harness), REPORT_SECONDS)
        message = f"On {SHARED}, no message was received within {REPORT_SECONDS:.0f} s."
        expect(has_messages, message, fraction=max(fraction, 0.5))


@check(points=2, covers="fleet-status", after=("two_robots", "spaces"), doc=contract.LARGE)
@hint("Remap only status: cmd_vel stays relative, so it is in each robot's namespace.")
@hint("ros2 topic info -v /robot1/cmd_vel lists the publishers and subscribers.")
def test_own_commands(launches: Launches, inputs: Inputs) -> None:
    """Each robot has its own cmd_vel, which leads from its driver to its reporter."""
    checked_count = 0
    for harness, names, prefix in (
        (launches.fleet(), (FIRST, SECOND), ""),
        (_drawn_fleet(launches, inputs), inputs.names, "With other robot names, "),
        (launches.own_fleet(), (FIRST, SECOND), "With your robot.launch.py, "),
    ):
        for name in names if _starts_robots(harness, *names) else ():
            _expect_own_commands(harness, name, prefix, fraction=0.75 if checked_count else 0.0)
            checked_count += name == names[-1]
    expect(checked_count > 0, "No launch started two robots, each with driver and reporter in its namespace.")


@check(points=1, covers="fleet-ctrl-c", after=("two_robots",))
@hint("The launch ends every program that Node(...) starts.")
def test_fleet_stop(launches: Launches) -> None:
    """Ctrl-C ends all four nodes cleanly and leaves nothing behind."""
    launch_probe.settle(launches.fleet(), nodes_in_namespaces(FIRST, SECOND))
    programs = launches.fleet().programs()
    expect(bool(programs), f"No node is running. {launch_probe.failure(launches.fleet().output)}".strip())
    launch_probe.expect_clean_stop(launches.fleet())


def _expect_own_commands(harness: LaunchHarness, name: str, prefix: str, fraction: float = 0.0) -> None:
    """Fail the check unless only a robot's driver publishes on its cmd_vel, and only its reporter subscribes."""
    expected = [f"/{name}/driver"], [f"/{name}/reporter"]
    is_correct = harness.wait_for(lambda: _endpoints(harness, name) == expected, MATCH_SECONDS)
    endpoints = " to ".join(", ".join(nodes) or "no node" for nodes in _endpoints(harness, name))
    message = f"{prefix}/{name}/cmd_vel leads from {endpoints}, instead of from /{name}/driver to /{name}/reporter."
    expect(is_correct, message, fraction=fraction)


def _endpoints(harness: LaunchHarness, name: str) -> tuple[list[str], list[str]]:
    return harness.publishers(f"/{name}/cmd_vel"), harness.subscribers(f"/{name}/cmd_vel")


def _starts_robots(harness: LaunchHarness, *names: str) -> bool:
    """Return whether a launch starts these robots and nothing else; other checks report a launch that does not."""
    with suppress(StudentError):
        return launch_probe.settle(harness, nodes_in_namespaces(*names)) == nodes_in_namespaces(*names)
    return False


def _speed(harness: LaunchHarness, node: str) -> parameters.Value | None:
    return (harness.parameters(node, ["speed"]) or {}).get("speed")


def _both_nodes(harness: LaunchHarness, names: tuple[str, str], suffix: str) -> list[str]:
    """Return the names of both drivers or both reporters, in any namespace; fail the check unless there are two.

    Other checks test the namespaces.
    """
    nodes = launch_probe.settle(harness, nodes_in_namespaces(*names))
    matching_nodes = sorted(name for name in nodes if name.endswith(suffix))
    message = f"There should be two nodes called {suffix[1:]}; the graph contains {', '.join(nodes) or 'no node'}."
    expect(len(matching_nodes) == 2, f"{message} {launch_probe.failure(harness.output)}".strip())
    return matching_nodes


def _are_publishers(harness: LaunchHarness, nodes: list[str]) -> bool:
    """Return whether exactly these nodes publish on the topic that the robots share."""
    return harness.publishers(SHARED) == nodes


def _has_messages(harness: LaunchHarness) -> bool:
    return bool(harness.messages(SHARED))


def _drawn_fleet(launches: Launches, inputs: Inputs) -> LaunchHarness:
    first, second = inputs.names
    return launches.fleet(first=first, second=second, speed=inputs.speed)
