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
TYPE_HINT = "ParameterValue(LaunchConfiguration(...), value_type=...) says which type the text becomes."


@check(points=2, covers=("robot-name", "speed", "report", "described"), doc=contract.SUBSTITUTIONS)
@hint("ros2 launch -s my_robot_bringup robot.launch.py shows what you have declared.")
@hint("DeclareLaunchArgument('speed', default_value='0.2', description='...') stands in the list, before the nodes.")
def test_arguments(launches: Launches) -> None:
    """robot.launch.py declares robot_name, speed and report, each with its default and a description."""
    arguments = launches.robot_arguments()
    for name, default in (("robot_name", contract.ROBOT_NAME), ("speed", str(contract.SPEED)), ("report", "true")):
        launch_probe.expect_argument(arguments, name, default)


@check(points=2, covers="report", after=("arguments",), doc=contract.SUBSTITUTIONS)
@hint("DeclareLaunchArgument takes choices=[...], a list of texts.")
@hint("A value that is none of the choices ends the launch before anything is started.")
def test_choices(workspace: Workspace, launches: Launches, inputs: Inputs) -> None:
    """Report can be true or false, and nothing else."""
    argument = launches.robot_arguments().get("report")
    expect(argument is not None, "The launch file declares no argument report.")
    choices = argument.choices if argument else ()
    message = f"The argument report takes {', '.join(choices)}, instead of true and false."
    expect(sorted(choices) in ([], ["false", "true"]), message)
    # A launch file without choices may refuse a value by other means, so only a launch shows whether it does.
    for value in inputs.refused[:1] if choices else inputs.refused:
        with LaunchHarness(workspace, PACKAGE, ROBOT, {"report": value}) as harness:
            harness.wait_for(partial(_has_ended, harness), REFUSE_SECONDS)
            expect(
                harness.status not in (None, 0), f"With report:={value}, the launch goes on as if nothing were wrong."
            )


@check(points=2, covers=("driver", "reporter", "given"), doc=contract.LAUNCH)
@hint("Run the launch file in the notebook and read its first lines that say ERROR.")
@hint("Node(package='my_robot_bringup', executable='driver', name='driver', ...), and the same for the reporter.")
def test_starts(workspace: Workspace, launches: Launches) -> None:
    """robot.launch.py starts driver and reporter, which are as they were given, and nothing else."""
    launch_probe.expect_nodes(launches.robot(), [DRIVER, REPORTER])
    changed_names = " and ".join(changed_files(workspace)[:3])
    message = f"{changed_names} is not as it was given. The checks started it as it was."
    expect(not changed_names, message, fraction=0.75)


@check(points=1, covers=("argument-wins", "robot-name", "speed", "screen"), after=("starts",))
@hint("The arguments' defaults are robot1 and 0.2, and they win over the file.", TYPE_HINT)
@hint("output='screen' is an argument of each Node.")
def test_defaults(launches: Launches) -> None:
    """Without arguments, it is robot1 at 0.2 m/s, whatever the parameters file says, and both nodes are on screen."""
    driver, reporter = _driver_and_reporter(launches.robot())
    launch_probe.expect_parameters(launches.robot(), driver, {"speed": contract.SPEED})
    launch_probe.expect_parameters(launches.robot(), reporter, {"robot_name": contract.ROBOT_NAME})
    for node, line in ((DRIVER, "Driving at"), (REPORTER, "Reporting for")):
        _expect_on_screen(launches.robot(), node, line)


@check(points=2, covers=("file", "driver", "reporter"), after=("starts",), doc=contract.LARGE)
@hint("config is the path of config/robot.yaml below get_package_share_directory('my_robot_bringup').")
@hint("parameters=[config, {...}] is a list: first the file, then what has to win over it.")
def test_parameters_file(launches: Launches, inputs: Inputs) -> None:
    """Both nodes get the parameters of config/robot.yaml."""
    driver, reporter = _driver_and_reporter(launches.robot())
    launch_probe.expect_parameters(launches.robot(), driver, {"turn_rate": inputs.file["turn_rate"]})
    launch_probe.expect_parameters(launches.robot(), reporter, {"report_period": inputs.file["report_period"]})
    for node in (driver, reporter):
        value = (launches.robot().parameters(node, ["use_sim_time"]) or {}).get("use_sim_time")
        message = (
            f"The checks add use_sim_time: true to the file; {node} has use_sim_time = {value!r}, instead of True."
        )
        expect(value is True, message, fraction=0.75)


@check(points=2, covers=("speed", "driver"), after=("starts",), doc=contract.SUBSTITUTIONS)
@hint("{'speed': LaunchConfiguration('speed')} is read when the launch runs, not when the file is.", TYPE_HINT)
def test_speed(launches: Launches, inputs: Inputs) -> None:
    """The argument speed reaches the driver."""
    harness = launches.robot(speed=inputs.speed, robot_name=inputs.number_name)
    driver, _ = _driver_and_reporter(harness)
    launch_probe.expect_parameters(harness, driver, {"speed": inputs.speed})


@check(points=2, covers=("robot-name", "reporter"), after=("starts",), doc=contract.SUBSTITUTIONS)
@hint("42 is a number for YAML, and the reporter's robot_name is a text.", TYPE_HINT)
@hint("Quotation marks put around a text by hand end at the first one inside it; value_type=str takes any text.")
def test_name(launches: Launches, inputs: Inputs) -> None:
    """The argument robot_name reaches the reporter as it was given, like a number or with quotation marks."""
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
    value_text = "not there" if value is None else repr(value)
    message = f"With robot_name:={inputs.quoted_name}, robot_name of {REPORTER} is {value_text}, instead of that text."
    expect(value == inputs.quoted_name, f"{message} {launch_probe.failure(harness.output)}".strip(), fraction=0.75)


@check(points=2, covers=("report", "reporter", "driver"), after=("starts",), doc=contract.SUBSTITUTIONS)
@hint("condition=IfCondition(LaunchConfiguration('report')) is an argument of the reporter's Node.")
@hint("UnlessCondition is the other way round.")
def test_quiet(launches: Launches, inputs: Inputs) -> None:
    """With report:=false, the reporter is not started."""
    harness = launches.robot(report="false", speed=inputs.whole_speed)
    nodes, programs = launch_probe.settle(harness, [DRIVER]), launch_probe.started(harness.output)
    expect(
        REPORTER not in nodes and "reporter" not in programs,
        "With report:=false, the reporter is started all the same.",
    )
    # Other checks test whether the driver keeps running: if it dies of its speed, it is in the graph only by chance.
    expect(bool(programs), f"With report:=false, nothing is started. {launch_probe.failure(harness.output)}".strip())
    expect(len(nodes) < 2, f"With report:=false, {', '.join(nodes)} run, instead of {DRIVER} alone.", fraction=0.75)


@check(points=1, covers=("speed", "screen"), after=("speed",))
@hint("Without a type, 1 is an integer, and the driver's speed is a float: the driver dies.", TYPE_HINT)
def test_whole_speed(launches: Launches, inputs: Inputs) -> None:
    """speed:=1, without a point, is a speed too."""
    harness = launches.robot(report="false", speed=inputs.whole_speed)
    driver, _ = _driver_and_reporter(harness, [DRIVER])
    expect(
        driver in harness.nodes(),
        f"With speed:={inputs.whole_speed}, the driver does not run. {launch_probe.failure(harness.output)}",
    )
    launch_probe.expect_parameters(harness, driver, {"speed": float(inputs.whole_speed)})
    _expect_on_screen(harness, driver, "Driving at")


@check(points=2, covers="ctrl-c", after=("starts",))
@hint("What a launch file starts with Node(...) ends with the launch.")
@hint("A program that the launch file starts by other means, such as subprocess, is nobody's child in the end.")
def test_clean_stop(launches: Launches) -> None:
    """Ctrl-C ends both nodes cleanly and leaves nothing behind."""
    nodes = launch_probe.settle(launches.robot(), [DRIVER, REPORTER])
    expect(bool(nodes), f"No node is up. {launch_probe.failure(launches.robot().output)}".strip())
    launch_probe.expect_clean_stop(launches.robot())


def _has_ended(harness: LaunchHarness) -> bool:
    return harness.status is not None


def _driver_and_reporter(harness: LaunchHarness, expected: Sequence[str] = (DRIVER, REPORTER)) -> tuple[str, str]:
    """Return the names of driver and reporter in a launch, even if one of them has another name."""
    nodes = launch_probe.settle(harness, expected)
    strangers = [name for name in nodes if name not in (DRIVER, REPORTER)]
    driver, reporter = (name if name in nodes or len(strangers) != 1 else strangers[0] for name in (DRIVER, REPORTER))
    return driver, reporter


def _expect_on_screen(harness: LaunchHarness, node: str, line: str) -> None:
    """Fail the check unless the stream on which the nodes log is shown; see `Launches.robot`."""
    is_shown = harness.wait_for(lambda: line in harness.output, SHOWN_SECONDS)
    expect(is_shown, f"What {node} prints is not on the screen: it lacks output='screen'.", fraction=0.5)
