"""One thing after another: what happens when a process ends."""

from __future__ import annotations

import signal

from autograder.checks import check, expect
from autograder.lab.launching import LaunchLab
from autograder.probes import launching
from autograder.suites.ch04_launch.inputs import Inputs
from autograder.suites.ch04_launch.shared import Shared
from autograder.visible.ch04_launch import contract
from autograder.visible.ch04_launch.contract import DRIVER, REPORTER

GROUP = "safe_start"
RESPAWN_SECONDS = 10.0  # real time; half a second is asked for
END_SECONDS = 12.0  # real time; a node that is asked while it starts may need SIGTERM after 5 s
WAITS = "RegisterEventHandler(OnProcessExit(target_action=self_test, on_exit=after_self_test))"
FOLLOWS = "RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[Shutdown(reason='...')]))"


@check(
    points=3,
    group=GROUP,
    hints=("The driver is in no list but the one that after_self_test returns.", WAITS),
    doc=contract.EVENTS,
)
def test_order(shared: Shared, inputs: Inputs) -> None:
    """The driver starts once the self-test has passed, and not before."""
    lab = shared.safe(battery=inputs.enough)
    nodes = launching.settle(lab, [DRIVER, REPORTER])
    started = launching.started(lab.output)
    expect("self_test" in started, f"The self-test was not started; {', '.join(started) or 'nothing'} was.")
    expect(
        DRIVER in nodes,
        f"With the battery at {inputs.enough} %, the driver does not run. {launching.trouble(lab.output)}",
    )
    before = lab.output.partition("[driver-")[0]
    expect("self_test" in launching.ended(before), "The driver was started before the self-test had ended.")


@check(
    points=2,
    group=GROUP,
    depends=("order",),
    hints=(
        "The reporter waits for nobody: it stands in the LaunchDescription itself.",
        "What stands in the list is started at once, one thing after the other, without waiting.",
    ),
    doc=contract.EVENTS,
)
def test_reporter_first(shared: Shared, inputs: Inputs) -> None:
    """The reporter starts at once, while the self-test still runs."""
    lab = shared.safe(battery=inputs.enough)
    expect(REPORTER in lab.nodes(), "The reporter does not run.")
    before = lab.output.partition("process has finished cleanly")[0]
    expect("reporter" in launching.started(before), "The reporter was started only after the self-test had ended.")


@check(
    points=3,
    group=GROUP,
    hints=(
        "event.returncode is the exit status of the process that has ended; 0 is success.",
        "return [Shutdown(reason='...')] where it is not 0.",
    ),
    doc=contract.EVENTS,
)
def test_fails_safe(shared: Shared, inputs: Inputs) -> None:
    """When the self-test fails, the driver is never started and everything ends."""
    lab = shared.safe(battery=inputs.empty)
    lab.wait_for(lambda: "self_test" in launching.ended(lab.output), launching.START_SECONDS)
    over = lab.wait_for(lambda: lab.status is not None, END_SECONDS)
    launching.require_written(lab.output)
    started = launching.started(lab.output)
    expect("self_test" in started, f"The self-test was not started. {launching.trouble(lab.output)}".strip())
    what = f"With the battery at {inputs.empty} %,"
    expect("driver" not in started, f"{what} the driver was started.")
    expect(over, f"{what} the driver was not started, but the launch goes on.", fraction=0.5)
    expect(not lab.left(), f"The launch ended, but left a process running: {', '.join(lab.left())[:200]}.")


@check(
    points=1,
    group=GROUP,
    depends=("order",),
    hints=(
        "80 is an integer for YAML, and the self-test's battery is a float: the self-test dies, as if it had failed.",
        "ParameterValue(LaunchConfiguration('battery'), value_type=float)",
    ),
)
def test_whole_battery(shared: Shared) -> None:
    """The default, 80 without a point, is a battery too."""
    lab = shared.safe()
    nodes = launching.settle(lab, [DRIVER, REPORTER])
    expect(DRIVER in nodes, f"Without an argument, the driver does not run. {launching.trouble(lab.output)}".strip())


@check(
    points=2,
    group=GROUP,
    depends=("reporter_first",),
    hints=("Node(..., respawn=True, respawn_delay=0.5)", "Nothing has to be handled: respawn is the node's own."),
    doc=contract.LAUNCH,
)
def test_respawns(shared: Shared, inputs: Inputs) -> None:
    """A reporter that dies is started again."""
    lab = shared.safe(battery=inputs.enough)
    before = _pids(lab, "reporter")
    lab.kill("reporter")
    back = lab.wait_for(lambda: bool(_pids(lab, "reporter") - before), RESPAWN_SECONDS)
    expect(back, "The reporter was killed, and stayed away.")
    expect(lab.status is None, "The reporter was killed, and the launch ended with it.")


@check(
    points=2,
    group=GROUP,
    depends=("order",),
    hints=("The handler's target_action is the very Node that is started.", FOLLOWS),
    doc=contract.EVENTS,
)
def test_driver_crash(shared: Shared, inputs: Inputs) -> None:
    """When the driver crashes, everything ends."""
    _expect_end(shared.safe(battery=inputs.enough), signal.SIGKILL, "The driver was killed")


@check(
    points=1,
    group=GROUP,
    depends=("whole_battery",),
    hints=("It does not matter how the driver ends: no look at event.returncode here.", FOLLOWS),
    doc=contract.EVENTS,
)
def test_driver_end(shared: Shared) -> None:
    """When the driver ends by itself, with exit status 0, everything ends too."""
    _expect_end(shared.safe(), signal.SIGINT, "The driver ended with exit status 0")


def _expect_end(lab: LaunchLab, number: signal.Signals, what: str) -> None:
    expect(lab.kill("driver", number) == 1, f"There is not one driver. {launching.trouble(lab.output)}".strip())
    over = lab.wait_for(lambda: lab.status is not None, END_SECONDS)
    expect(over, f"{what}, and the launch goes on without it.")
    expect(not lab.left(), f"{what} and the launch with it, but this still runs: {', '.join(lab.left())[:200]}.")


def _pids(lab: LaunchLab, name: str) -> set[int]:
    return {program.pid for program in lab.programs() if program.name == name}
