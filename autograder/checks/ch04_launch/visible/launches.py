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
    """The launches that the checks share."""

    robot: LaunchHarness
    quiet: LaunchHarness
    fleet: LaunchHarness
    full: LaunchHarness
    empty: LaunchHarness


@pytest.fixture(scope="module")
def launches(workspace: Workspace) -> Iterator[Launches]:
    """Start all launches with the first check: together, they need half the time, and the student is waiting."""
    with ExitStack() as stack:

        def start(file: str, arguments: dict[str, str], subscribes: dict[str, type] | None = None) -> LaunchHarness:
            return stack.enter_context(LaunchHarness(workspace, PACKAGE, file, arguments, subscribes=subscribes))

        yield Launches(
            robot=start(ROBOT, {"speed": "1", "robot_name": "42"}),
            quiet=start(ROBOT, {"report": "false"}),
            fleet=start(FLEET, {"speed": "0.31", "first": NAMES[0], "second": NAMES[1]}, {SHARED: String}),
            full=start(SAFE, {"battery": "90"}),
            empty=start(SAFE, {"battery": "5"}),
        )


@check(points=1, covers=("robot-name", "speed", "report"), group="robot", doc=contract.SUBSTITUTIONS)
@hint("DeclareLaunchArgument('speed', default_value='0.2', description='...') stands in the list, before the nodes.")
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
@hint("Each parameter's text needs its type: ParameterValue(LaunchConfiguration('speed'), value_type=float).")
@hint("parameters=[config, {'speed': speed}]: what stands later wins.")
def test_robot(launches: Launches) -> None:
    """robot.launch.py starts driver and reporter with arguments and parameters file, and Ctrl-C ends both."""
    launch_probe.expect_nodes(launches.robot, [DRIVER, REPORTER])
    launch_probe.expect_parameters(launches.robot, DRIVER, {"speed": 1.0, "turn_rate": 0.4})
    launch_probe.expect_parameters(launches.robot, REPORTER, {"robot_name": "42", "report_period": 0.5})
    launch_probe.expect_clean_stop(launches.robot)


@check(points=1, covers="report", group="robot", after=("robot",), doc=contract.SUBSTITUTIONS)
@hint("condition=IfCondition(LaunchConfiguration('report')) is an argument of the reporter's Node.")
def test_quiet(launches: Launches) -> None:
    """With report:=false, robot.launch.py starts the driver alone."""
    launch_probe.expect_nodes(launches.quiet, [DRIVER])


@check(points=1, covers=("included", "first", "second", "fleet-status"), group="fleet", doc=contract.LARGE)
@hint("GroupAction([PushRosNamespace(name), SetRemap('status', '/fleet/status'), IncludeLaunchDescription(...)])")
@hint("SetRemap stands before the include; launch_arguments={'robot_name': name, 'speed': speed}.items() in it.")
def test_two_robots(launches: Launches) -> None:
    """two_robots.launch.py starts two robots with given names and speed; both report on /fleet/status."""
    harness = launches.fleet
    launch_probe.expect_nodes(harness, contract.nodes_in_namespaces(*NAMES))
    for name in NAMES:
        launch_probe.expect_parameters(harness, f"/{name}{DRIVER}", {"speed": 0.31})
        launch_probe.expect_parameters(harness, f"/{name}{REPORTER}", {"robot_name": name})
    harness.wait_for(lambda: len(reporting_robots(harness)) == 2, REPORT_SECONDS)
    expect(
        len(reporting_robots(harness)) == 2,
        f"On {SHARED}, {', '.join(sorted(reporting_robots(harness))) or 'nobody'} was heard.",
    )


@check(points=1, covers=("self-test", "battery"), group="safe_start", doc=contract.EVENTS)
@hint("The driver is in no list but the one that after_self_test returns.")
@hint("event.returncode is the exit status of the process that has ended; 0 is success.")
def test_safe_start(launches: Launches) -> None:
    """safe_start.launch.py starts the driver with a full battery, and ends without it when the battery is empty."""
    launch_probe.expect_nodes(launches.full, [DRIVER, REPORTER])
    harness = launches.empty
    has_ended = harness.wait_for(lambda: harness.status is not None, launch_probe.START_SECONDS)
    expect("driver" not in launch_probe.started(harness.output), "With the battery at 5 %, the driver was started.")
    expect(has_ended, "With the battery at 5 %, the launch did not end by itself.")


@check(points=1, covers="safe-reporter", group="safe_start", after=("safe_start",), doc=contract.LAUNCH)
@hint("Node(..., respawn=True, respawn_delay=0.5)", "Nothing has to be handled: respawn is the node's own.")
def test_respawn(launches: Launches) -> None:
    """A reporter that dies is started again."""
    expect_respawn(launches.full)


@check(points=1, covers="safe-driver", group="safe_start", after=("respawn",), doc=contract.EVENTS)
@hint("RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[Shutdown(reason='...')]))")
def test_driver_stops(launches: Launches) -> None:
    """When the driver gets SIGTERM and ends, everything shuts down."""
    harness = launches.full
    expect(harness.kill("driver", signal.SIGTERM) == 1, "There is not one driver.")
    has_ended = harness.wait_for(lambda: harness.status is not None, launch_probe.START_SECONDS)
    expect(has_ended, "The driver ended, and the launch goes on without it.")
