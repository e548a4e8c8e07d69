"""Checks of robot.launch.py: arguments, parameters, a condition and a clean end."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from autograder.checking import LaunchHarness, Workspace, expect, group, hint
from autograder.checking.probes import launch_probe
from autograder.checks.ch04_launch.hidden.given_files import changed_files
from autograder.checks.ch04_launch.hidden.inputs import Inputs
from autograder.checks.ch04_launch.hidden.launches import Launches
from autograder.checks.ch04_launch.support import contract
from autograder.checks.ch04_launch.support.contract import DRIVER, PACKAGE, REPORTER, ROBOT

check = group("robot")
SHOWN_SECONDS = 5.0  # s of real time until a running node's line is shown
REFUSE_SECONDS = 15.0  # s of real time until a launch that refuses an argument has ended
TYPE_HINT = "ParameterValue(LaunchConfiguration(...), value_type=...) gives the text a type."


@check(points=2, covers=("robot-name", "speed", "report", "described"), doc=contract.SUBSTITUTIONS)
@hint("ros2 launch -s my_robot_bringup robot.launch.py shows what you have declared.")
@hint("DeclareLaunchArgument('speed', default_value='0.2', description='...') belongs in the list, before the nodes.")
def test_arguments(launches: Launches) -> None:
    """robot.launch.py declares robot_name, speed and report, each with its default and a description."""
    arguments = launches.robot_arguments()
    for name, default in (("robot_name", contract.ROBOT_NAME), ("speed", str(contract.SPEED)), ("report", "true")):
        launch_probe.expect_argument(arguments, name, default)


@check(points=2, covers="report", after=("arguments",), doc=contract.SUBSTITUTIONS)
@hint("DeclareLaunchArgument takes choices=[...], a list of texts.")
@hint("A value outside the choices ends the launch before anything is started.")
def test_choices(workspace: Workspace, launches: Launches, inputs: Inputs) -> None:
    """The argument report can be true or false, and nothing else."""
    argument = launches.robot_arguments().get("report")
    expect(argument is not None, "The launch file declares no argument report.")
    choices = argument.choices if argument else ()
    message = f"The argument report accepts {', '.join(choices)}, instead of true and false."
    expect(sorted(choices) in ([], ["false", "true"]), message)
    # A launch file without choices may refuse a value by other means, so only a launch shows whether it does.
    for value in inputs.invalid_reports[:1] if choices else inputs.invalid_reports:
        with LaunchHarness(workspace, PACKAGE, ROBOT, {"report": value}) as harness:
            harness.wait_for(partial(_has_ended, harness), REFUSE_SECONDS)
            message = f"With report:={value}, the launch does not end with an error."
            expect(harness.status not in (None, 0), message)


@check(points=2, covers=("driver", "reporter", "given"), doc=contract.LAUNCH)
@hint("Run the launch file in the notebook, and read the first lines that contain ERROR.")
@hint("Node(package='my_robot_bringup', executable='driver', name='driver', ...), and the same for the reporter.")
def test_starts(workspace: Workspace, launches: Launches) -> None:
    """robot.launch.py starts driver and reporter, and nothing else; the given files are unchanged."""
    launch_probe.expect_nodes(launches.robot(), [DRIVER, REPORTER])
    changed_names = " and ".join(changed_files(workspace)[:3])
    message = f"These given files were changed or deleted: {changed_names}. The checks use the given versions."
    expect(not changed_names, message, fraction=0.75)


@check(points=1, covers=("argument-wins", "robot-name", "speed", "screen"), after=("starts",))
@hint("The arguments' defaults are robot1 and 0.2, and they override the file.", TYPE_HINT)
@hint("output='screen' is an argument of each Node.")
def test_defaults(launches: Launches) -> None:
    """Without arguments, robot_name is robot1 and speed is 0.2, whatever the file says; both nodes are on screen."""
    driver, reporter = _driver_and_reporter(launches.robot())
    launch_probe.expect_parameters(launches.robot(), driver, {"speed": contract.SPEED})
    launch_probe.expect_parameters(launches.robot(), reporter, {"robot_name": contract.ROBOT_NAME})
    for node, line in ((DRIVER, "Driving at"), (REPORTER, "Reporting for")):
        _expect_on_screen(launches.robot(), node, line)


@check(points=2, covers=("file", "driver", "reporter"), after=("starts",), doc=contract.LARGE)
@hint("config is the path of config/robot.yaml below get_package_share_directory('my_robot_bringup').")
@hint("parameters=[config, {...}] is a list: first the file, then the values that override it.")
def test_parameters_file(launches: Launches, inputs: Inputs) -> None:
    """Both nodes get the parameters of config/robot.yaml."""
    driver, reporter = _driver_and_reporter(launches.robot())
    launch_probe.expect_parameters(launches.robot(), driver, {"turn_rate": inputs.file_values["turn_rate"]})
    launch_probe.expect_parameters(launches.robot(), reporter, {"report_period": inputs.file_values["report_period"]})
    for node in (driver, reporter):
        value = (launches.robot().parameters(node, ["use_sim_time"]) or {}).get("use_sim_time")
        message = (
            f"The checks add use_sim_time: true to the file; {node} has use_sim_time = {value!r}, instead of True."
        )
        expect(value is True, message, fraction=0.75)


@check(points=2, covers=("speed", "driver"), after=("starts",), doc=contract.SUBSTITUTIONS)
@hint("LaunchConfiguration('speed') is replaced by a text when the launch runs, not when the file is read.", TYPE_HINT)
def test_speed(launches: Launches, inputs: Inputs) -> None:
    """The argument speed reaches the driver."""
    harness = launches.robot(speed=inputs.speed, robot_name=inputs.number_name)
    driver, _ = _driver_and_reporter(harness)
    launch_probe.expect_parameters(harness, driver, {"speed": inputs.speed})


@check(points=2, covers=("robot-name", "reporter"), after=("starts",), doc=contract.SUBSTITUTIONS)
@hint("YAML reads 42 as an integer, but the reporter's robot_name is a string.", TYPE_HINT)
@hint("Quotation marks that you add by hand fail if the text contains some; value_type=str works for every text.")
def test_name(launches: Launches, inputs: Inputs) -> None:
    """The argument robot_name reaches the reporter unchanged, even a number or a text with quotation marks."""
    harness = launches.robot(speed=inputs.speed, robot_name=inputs.number_name)
    _, reporter = _driver_and_reporter(harness)
    expect(
        reporter in harness.nodes(),
        f"With robot_name:={inputs.number_name}, the reporter does not run. {launch_probe.failure(harness.output)}",
    )
    launch_probe.expect_parameters(harness, reporter, {"robot_name": inputs.number_name})
    harness = launches.quoted_robot()
    launch_probe.settle(harness, [reporter])
    value = (harness.parameters(reporter, ["robot_name"]) or {}).get("robot_name")
    value_text = "not set" if value is None else repr(value)
    message = f"With robot_name:={inputs.quoted_name}, robot_name of {REPORTER} is {value_text}, instead of that text."
    expect(value == inputs.quoted_name, f"{message} {launch_probe.failure(harness.output)}".strip(), fraction=0.75)


@check(points=2, covers=("report", "reporter", "driver"), after=("starts",), doc=contract.SUBSTITUTIONS)
@hint("condition=IfCondition(LaunchConfiguration('report')) is an argument of the reporter's Node.")
@hint("UnlessCondition does the opposite.")
def test_quiet(launches: Launches, inputs: Inputs) -> None:
    """With report:=false, the reporter is not started."""
    harness = launches.robot(report="false", speed=inputs.whole_speed)
    nodes, programs = launch_probe.settle(harness, [DRIVER]), launch_probe.started(harness.output)
    expect(
        REPORTER not in nodes and "reporter" not in programs,
        "With report:=false, the reporter was started.",
    )
    # Other checks test whether the driver keeps running. If its speed stops it, it is in the graph only by chance.
    expect(bool(programs), f"With report:=false, nothing was started. {launch_probe.failure(harness.output)}".strip())
    expect(len(nodes) < 2, f"With report:=false, {', '.join(nodes)} run, instead of only {DRIVER}.", fraction=0.75)


@check(points=1, covers=("speed", "screen"), after=("speed",))
@hint("Without a type, 1 is an integer. The driver's speed is a float, so the driver ends with an error.", TYPE_HINT)
def test_whole_speed(launches: Launches, inputs: Inputs) -> None:
    """robot.launch.py accepts speed:=1, without a decimal point."""
    harness = launches.robot(report="false", speed=inputs.whole_speed)
    driver, _ = _driver_and_reporter(harness, [DRIVER])
    expect(
        driver in harness.nodes(),
        f"With speed:={inputs.whole_speed}, the driver does not run. {launch_probe.failure(harness.output)}",
    )
    launch_probe.expect_parameters(harness, driver, {"speed": float(inputs.whole_speed)})
    _expect_on_screen(harness, driver, "Driving at")


@check(points=2, covers="ctrl-c", after=("starts",))
@hint("The launch ends every program that Node(...) starts.")
@hint("A program that the launch file starts by other means, such as subprocess, may outlive the launch.")
def test_clean_stop(launches: Launches) -> None:
    """Ctrl-C ends both nodes cleanly and leaves nothing behind."""
    nodes = launch_probe.settle(launches.robot(), [DRIVER, REPORTER])
    expect(bool(nodes), f"No node is running. {launch_probe.failure(launches.robot().output)}".strip())
    launch_probe.expect_clean_stop(launches.robot())


def _has_ended(harness: LaunchHarness) -> bool:
    return harness.status is not None


def _driver_and_reporter(harness: LaunchHarness, expected: Sequence[str] = (DRIVER, REPORTER)) -> tuple[str, str]:
    """Return the names of driver and reporter in a launch, even if one of them has another name."""
    nodes = launch_probe.settle(harness, expected)
    other_nodes = [name for name in nodes if name not in (DRIVER, REPORTER)]
    driver, reporter = (
        name if name in nodes or len(other_nodes) != 1 else other_nodes[0] for name in (DRIVER, REPORTER)
    )
    return driver, reporter


def _expect_on_screen(harness: LaunchHarness, node: str, line: str) -> None:
    """Fail the check unless the stream on which the nodes log is shown; see `Launches.robot`."""
    is_shown = harness.wait_for(lambda: line in harness.output, SHOWN_SECONDS)
    expect(is_shown, f"The output of {node} is not on the screen: its Node needs output='screen'.", fraction=0.5)
