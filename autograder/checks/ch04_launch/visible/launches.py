"""Checks of the nodes that the three launch files start, and of how the launches end."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass

import pytest
from std_msgs.msg import String

from autograder.checking import LaunchHarness, Workspace, check, expect, hint
from autograder.checking.probes import launch_probe
from autograder.checks.ch04_launch.support import contract
from autograder.checks.ch04_launch.support.contract import DRIVER, FLEET, PACKAGE, REPORTER, ROBOT, SAFE, SHARED
from autograder.checks.ch04_launch.support.respawn import expect_respawn
from autograder.checks.ch04_launch.support.status import REPORT_SECONDS, reporting_robots

NAMES = ("tram", "lorry")  # the names of the two robots


@dataclass(frozen=True)
class Launches:
    """The launches that the checks share: two of one robot, one of two robots, and two with a self-test."""

    robot: LaunchHarness
    without_reporter: LaunchHarness
    fleet: LaunchHarness
    full_battery: LaunchHarness
    empty_battery: LaunchHarness


@pytest.fixture(scope="module")
def launches(workspace: Workspace) -> Iterator[Launches]:
    """Start all launches at the first check. Together they need half the time, and the student is waiting."""
    with ExitStack() as stack:

        def start(file: str, arguments: dict[str, str], subscribes: dict[str, type] | None = None) -> LaunchHarness:
            return stack.enter_context(LaunchHarness(workspace, PACKAGE, file, arguments, subscribes=subscribes))

        yield Launches(
            robot=start(ROBOT, {"speed": "1", "robot_name": "42"}),
            without_reporter=start(ROBOT, {"report": "false"}),
            fleet=start(FLEET, {"speed": "0.31", "first": NAMES[0], "second": NAMES[1]}, {SHARED: String}),
            full_battery=start(SAFE, {"battery": "90"}),
            empty_battery=start(SAFE, {"battery": "5"}),
        )


@check(points=1, covers=("robot-name", "speed", "report"), group="robot", doc=contract.SUBSTITUTIONS)
@hint("DeclareLaunchArgument('speed', default_value='0.2', description='...') belongs in the list, before the nodes.")
@hint("The names are robot_name, speed and report.")
def test_arguments(workspace: Workspace) -> None:
    """robot.launch.py declares robot_name, speed and report."""
    arguments = launch_probe.declared_arguments(workspace, PACKAGE, ROBOT)
    for name, default in (("robot_name", contract.ROBOT_NAME), ("speed", str(contract.SPEED)), ("report", "true")):
        launch_probe.expect_argument(arguments, name, default)


@check(
    points=1,
    covers=("driver", "reporter", "speed", "robot-name", "file", "ctrl-c"),
    group="robot",
    after=("arguments",),
    doc=contract.LAUNCH,
)
@hint("An argument is a text; give it a type: ParameterValue(LaunchConfiguration('speed'), value_type=float).")
@hint("In parameters=[config, {'speed': speed}], the later values win.")
def test_robot(launches: Launches) -> None:
    """robot.launch.py starts driver and reporter with the arguments and the parameters file; Ctrl-C ends both."""
    launch_probe.expect_nodes(launches.robot, [DRIVER, REPORTER])
    launch_probe.expect_parameters(launches.robot, DRIVER, {"speed": 1.0, "turn_rate": 0.4})
    launch_probe.expect_parameters(launches.robot, REPORTER, {"robot_name": "42", "report_period": 0.5})
    launch_probe.expect_clean_stop(launches.robot)


@check(points=1, covers="report", group="robot", after=("robot",), doc=contract.SUBSTITUTIONS)
@hint("condition=IfCondition(LaunchConfiguration('report')) is an argument of the reporter's Node.")
def test_quiet(launches: Launches) -> None:
    """With report:=false, robot.launch.py starts only the driver."""
    launch_probe.expect_nodes(launches.without_reporter, [DRIVER])


@check(points=1, covers=("included", "first", "second", "fleet-status"), group="fleet", doc=contract.LARGE)
@hint("GroupAction([PushRosNamespace(name), SetRemap('status', '/fleet/status'), IncludeLaunchDescription(...)])")
@hint("Put SetRemap before the include, with launch_arguments={'robot_name': name, 'speed': speed}.items().")
def test_two_robots(launches: Launches) -> None:
    """two_robots.launch.py starts two robots with the given names and speed; both report on /fleet/status."""
    harness = launches.fleet
    launch_probe.expect_nodes(harness, contract.nodes_in_namespaces(*NAMES))
    for name in NAMES:
        launch_probe.expect_parameters(harness, f"/{name}{DRIVER}", {"speed": 0.31})
        launch_probe.expect_parameters(harness, f"/{name}{REPORTER}", {"robot_name": name})
    harness.wait_for(lambda: len(reporting_robots(harness)) == 2, REPORT_SECONDS)
    robot_names = ", ".join(sorted(reporting_robots(harness))) or "No robot"
    message = f"{robot_names} reported on {SHARED}; {' and '.join(NAMES)} should."
    expect(len(reporting_robots(harness)) == 2, message)


@check(points=1, covers=("self-test", "battery"), group="safe_start", doc=contract.EVENTS)
@hint("Put the driver only into the list that after_self_test returns.")
@hint("event.returncode is the exit status of the process that has ended; 0 is success.")
def test_safe_start(launches: Launches) -> None:
    """safe_start.launch.py starts the driver if the battery is full, and ends without the driver if it is empty."""
    launch_probe.expect_nodes(launches.full_battery, [DRIVER, REPORTER])
    harness = launches.empty_battery
    has_ended = harness.wait_for(lambda: harness.status is not None, launch_probe.START_SECONDS)
    expect("driver" not in launch_probe.started(harness.output), "With the battery at 5 %, the driver was started.")
    expect(has_ended, "With the battery at 5 %, the launch did not end by itself.")


@check(points=1, covers="safe-reporter", group="safe_start", after=("safe_start",), doc=contract.LAUNCH)
@hint("Node(..., respawn=True, respawn_delay=0.5)", "You need no event handler: respawn is an argument of Node.")
def test_respawn(launches: Launches) -> None:
    """A reporter that dies is started again."""
    expect_respawn(launches.full_battery)


@check(points=1, covers="safe-driver", group="safe_start", after=("respawn",), doc=contract.EVENTS)
@hint("RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[Shutdown(reason='...')]))")
def test_driver_stops(launches: Launches) -> None:
    """When the driver gets SIGTERM and ends, everything shuts down."""
    harness = launches.full_battery
    expect(harness.kill("driver", signal.SIGTERM) == 1, "There should be exactly one driver to stop.")
    has_ended = harness.wait_for(lambda: harness.status is not None, launch_probe.START_SECONDS)
    expect(has_ended, "The driver ended, but the launch goes on without it.")
