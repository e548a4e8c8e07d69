"""Checks of safe_start.launch.py: the order of the programs, and what happens when one ends."""

from __future__ import annotations

import signal

from autograder.checking import LaunchHarness, expect, group, hint
from autograder.checking.probes import launch_probe
from autograder.checks.ch04_launch.hidden.inputs import Inputs
from autograder.checks.ch04_launch.hidden.launches import UNUSUAL_SELF_TESTS, Launches
from autograder.checks.ch04_launch.support import contract
from autograder.checks.ch04_launch.support.contract import DRIVER, REPORTER
from autograder.checks.ch04_launch.support.respawn import expect_respawn

check = group("safe_start")
# Seconds of real time until everything has ended: a node that gets SIGINT while it starts may need SIGTERM 5 s later.
END_SECONDS = 12.0
END_COUNT = 6  # how often the scripted reporter ends before the check trusts that it is always restarted
WAIT_HINT = "RegisterEventHandler(OnProcessExit(target_action=self_test, on_exit=after_self_test))"
SHUTDOWN_HINT = "RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[Shutdown(reason='...')]))"


@check(points=3, covers=("self-test", "safe-driver"), doc=contract.EVENTS)
@hint("Put the driver only into the list that after_self_test returns.", WAIT_HINT)
def test_order(launches: Launches, inputs: Inputs) -> None:
    """The driver starts once the self-test has passed, and not before."""
    harness = launches.safe(battery=inputs.sufficient_battery)
    nodes = launch_probe.settle(harness, [DRIVER, REPORTER])
    started_programs = launch_probe.started(harness.output)
    expect(
        "self_test" in started_programs,
        f"The self-test was not started; the launch started {', '.join(started_programs) or 'nothing'}.",
    )
    count = started_programs.count("self_test")  # more than 1 if the launch file itself prints such lines
    expect(count == 1, f"According to the output, the self-test was started {count} times, instead of once.")
    expect(
        DRIVER in nodes,
        f"With the battery at {inputs.sufficient_battery} %, the driver does not run. "
        f"{launch_probe.failure(harness.output)}",
    )
    before = harness.output.partition("[driver-")[0]
    is_in_order = "self_test" in launch_probe.ended(before) and not launches.is_early(harness)
    expect(is_in_order, "The driver was started before the self-test had ended.")


@check(points=2, covers="safe-reporter", after=("order",), doc=contract.EVENTS)
@hint("The reporter does not wait: put it into the LaunchDescription itself.")
@hint("launch starts everything in the list immediately, without waiting.")
def test_reporter_first(launches: Launches, inputs: Inputs) -> None:
    """The reporter starts immediately, while the self-test still runs."""
    harness = launches.safe(battery=inputs.sufficient_battery)
    expect(REPORTER in harness.nodes(), "The reporter does not run.")
    launch_probe.expect_parameters(harness, REPORTER, contract.NODE_DEFAULTS[REPORTER])
    before = harness.output.partition("process has finished cleanly")[0]
    expect("reporter" in launch_probe.started(before), "The reporter was started only after the self-test had ended.")


@check(points=2, covers="self-test", doc=contract.EVENTS)
@hint("event.returncode is the exit status of the process that has ended; 0 is success.")
@hint("return [Shutdown(reason='...')] if it is not 0.")
def test_fails_safe(launches: Launches, inputs: Inputs) -> None:
    """When the self-test fails, the driver is never started and everything ends."""
    _expect_refusal(launches.safe(battery=inputs.low_battery), f"With the battery at {inputs.low_battery} %,")


@check(points=1, covers="self-test", after=("fails_safe",), doc=contract.EVENTS)
@hint("If a signal killed the process, event.returncode is negative: -9 for SIGKILL.")
@hint("Only 0 is success: event.returncode == 0.")
def test_killed(launches: Launches) -> None:
    """If the node self_test is killed, or ends with exit status 3, everything ends without the driver."""
    for ending in UNUSUAL_SELF_TESTS:
        harness = launches.unusual_start(ending)
        _expect_refusal(harness, f"When the self-test ended {ending},")
        other_names = launch_probe.node_names(harness.output, "self_test") - {"self_test"}
        expect(not other_names, f"The self-test's node is called {', '.join(other_names)}, not self_test.")


@check(points=1, covers="battery", after=("order",))
@hint("YAML reads 80 as an integer, but the self-test's battery is a float, so the self-test ends with an error.")
@hint("ParameterValue(LaunchConfiguration('battery'), value_type=float)")
def test_whole_battery(launches: Launches, inputs: Inputs) -> None:
    """The argument battery accepts a value without a decimal point, and its default is 80."""
    harness = launches.safe(battery=inputs.whole_battery)
    nodes = launch_probe.settle(harness, [DRIVER, REPORTER])
    message = f"With battery:={inputs.whole_battery}, the driver does not run."
    expect(DRIVER in nodes, f"{message} {launch_probe.failure(harness.output)}".strip())
    argument = launches.safe_arguments().get("battery")
    expect(argument is not None, "safe_start.launch.py does not declare the argument battery.", fraction=0.5)
    default = "80" if argument and argument.is_computed else argument.default if argument else None
    default_text = "no default" if default is None else f"the default {default!r}"
    expect(default == "80", f"The argument battery has {default_text}, instead of '80'.", fraction=0.5)


@check(points=2, covers="safe-reporter", after=("reporter_first",), doc=contract.LAUNCH)
@hint("Node(..., respawn=True, respawn_delay=0.5)", "You need no event handler: respawn is an argument of Node.")
def test_respawns(launches: Launches, inputs: Inputs) -> None:
    """A reporter that dies is started again."""
    expect_respawn(launches.safe(battery=inputs.sufficient_battery))
    harness = launches.scripted_start()
    is_restarted = harness.wait_for(
        lambda: _count_reporter_starts(harness.output) > END_COUNT, launch_probe.START_SECONDS
    )
    count = _count_reporter_starts(harness.output)
    message = f"A reporter that ends by itself, with exit status 0, was started {count} times, and then not again."
    expect(is_restarted, message, fraction=0.75)


@check(points=2, covers="safe-driver", after=("order",), doc=contract.EVENTS)
@hint("The handler's target_action is the same Node object that is started.", SHUTDOWN_HINT)
def test_driver_crash(launches: Launches, inputs: Inputs) -> None:
    """When the driver crashes, everything ends."""
    _expect_end(launches.safe(battery=inputs.sufficient_battery), signal.SIGKILL, "The driver was killed")
    harness = launches.scripted_start()
    is_ready = harness.wait_for(lambda: _is_driver_ready(harness), launch_probe.START_SECONDS)
    expect(
        is_ready,
        f"After a self-test of 3 s, the driver does not run. {launch_probe.failure(harness.output)}",
        fraction=0.75,
    )
    before = harness.output.partition("[driver-")[0]
    message = "The driver was started before a self-test of 3 s had ended."
    is_in_order = "self_test" in launch_probe.ended(before) and not launches.is_early(harness)
    expect(is_in_order, message, fraction=0.75)
    _expect_end(harness, signal.SIGTERM, "The driver ended with exit status 3", fraction=0.75)
    # A reporter may be starting when the driver ends. One that is restarted for another 2 s starts more often.
    count = _count_reporter_starts(harness.output.partition("exit code 3,")[2])
    late_message = (
        f"After the driver had ended, the reporter was started {count} more times before everything shut down."
    )
    expect(count <= 2, late_message, fraction=0.75)


@check(points=1, covers=("safe-driver", "battery"), after=("whole_battery",), doc=contract.EVENTS)
@hint("It does not matter how the driver ends: do not use event.returncode here.", SHUTDOWN_HINT)
def test_driver_end(launches: Launches, inputs: Inputs) -> None:
    """The driver has its default parameters. When it ends by itself, with exit status 0, everything ends, too."""
    harness = launches.safe(battery=inputs.whole_battery)
    if DRIVER not in harness.nodes():  # `whole_battery` reports this; here, the battery has a decimal point
        harness = launches.safe(battery=f"{inputs.sufficient_battery:.3f}")
        launch_probe.settle(harness, [DRIVER, REPORTER])
    launch_probe.expect_parameters(harness, DRIVER, contract.NODE_DEFAULTS[DRIVER])
    _expect_end(harness, signal.SIGINT, "The driver ended with exit status 0")
    other_arguments = ", ".join(sorted(launches.safe_arguments().keys() - {"battery"}))
    message = f"safe_start.launch.py also declares {other_arguments}; battery should be its only argument."
    expect(not other_arguments, message, fraction=0.5)


def _expect_refusal(harness: LaunchHarness, situation: str) -> None:
    harness.wait_for(lambda: "self_test" in launch_probe.ended(harness.output), launch_probe.START_SECONDS)
    has_ended = harness.wait_for(lambda: harness.status is not None, END_SECONDS)
    launch_probe.require_written(harness.output)
    started_programs = launch_probe.started(harness.output)
    expect(
        "self_test" in started_programs,
        f"The self-test was not started. {launch_probe.failure(harness.output)}".strip(),
    )
    expect("driver" not in started_programs, f"{situation} the driver was started.")
    expect(has_ended, f"{situation} the driver was not started, but the launch goes on.", fraction=0.5)
    expect(not harness.left(), f"The launch ended, but left a process running: {', '.join(harness.left())[:200]}.")


def _expect_end(harness: LaunchHarness, stop_signal: signal.Signals, situation: str, fraction: float = 0.0) -> None:
    missing = f"There should be exactly one driver to stop. {launch_probe.failure(harness.output)}".strip()
    expect(harness.kill("driver", stop_signal) == 1, missing, fraction=fraction)
    has_ended = harness.wait_for(lambda: harness.status is not None, END_SECONDS)
    expect(has_ended, f"{situation}, but the launch goes on without it.", fraction=fraction)
    left_message = (
        f"{situation} and the launch ended, but these processes still run: {', '.join(harness.left())[:200]}."
    )
    expect(not harness.left(), left_message, fraction=fraction)


def _count_reporter_starts(output: str) -> int:
    """Return how many times the reporter was started, according to a launch's output."""
    return launch_probe.started(output).count("reporter")


def _is_driver_ready(harness: LaunchHarness) -> bool:
    """Return whether the scripted driver has reached its loop, in which it handles SIGTERM."""
    return any(program.has_children for program in harness.programs() if program.name == "driver")
