"""Checks that the tests of the node are isolated, and fail if speed_guard breaks its contract."""

from __future__ import annotations

from autograder.checking import check_each_row, expect, group, hint
from autograder.checks.ch06_testing.hidden.examination import BACKWARDS, Examination, Line
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.assertions import expect_passed
from autograder.checks.ch06_testing.support.contract import GUARD

check = group("node")
RIGHT_CHECK = ("guard_right",)


@check(points=2, covers="guard-pass", doc=contract.PYTEST)
@hint("Run them: colcon test, or python -m pytest test/test_guard.py in the package's folder.", contract.SPIN)
def test_guard_pass(examination: Examination) -> None:
    """At least five tests in test_guard.py run, and all pass on the package as it is."""
    expect_passed(GUARD, examination.trial.get(GUARD))


@check(points=1, covers=("guard-pass", "over-topics"), after=("guard_pass",), doc=contract.PYTEST)
@hint("Ask over topics, as another robot would. Another correct node may have other attributes.")
@hint("Each test starts its own guard and leaves nothing behind.")
def test_guard_right(examination: Examination) -> None:
    """The tests in test_guard.py pass on every correct speed_guard, in any order."""
    examination.expect_passed_on_correct_versions(GUARD, BACKWARDS)


@check(points=2, covers="own-domain", after=RIGHT_CHECK, doc=contract.DOMAIN)
@hint("A context without a domain of its own uses the default domain, where other robots may be.")
@hint("rclpy.init(context=context, domain_id=...), with a number that no other test process uses.")
def test_alone(examination: Examination) -> None:
    """The tests in test_guard.py run in a domain of their own: none of their nodes appears in the default domain."""
    examination.expect_usable(GUARD)
    expect(
        not examination.trial[GUARD].joined_domain,
        f"While the tests in {GUARD} ran, one of their nodes was in the default domain, where other robots may be.",
    )


@check(points=1, covers="guard-pass", after=RIGHT_CHECK, doc=contract.FIXTURES)
@hint("The code after yield in a fixture always runs, even if the test fails.")
@hint("Destroy each node, then call rclpy.try_shutdown(context=context).")
def test_nothing_left(examination: Examination) -> None:
    """The tests in test_guard.py leave no node and no context behind."""
    examination.expect_usable(GUARD)
    trial = examination.trial[GUARD]
    message = f"After the last test in {GUARD}, {trial.open_sockets} network sockets of ROS contexts were still open."
    expect(trial.open_sockets == 0, message)
    # A context that is garbage-collected without a shutdown closes its sockets, but not the log file.
    message = f"After the last test in {GUARD}, ROS's log file was still open: a context was not shut down."
    expect(not trial.is_logging, message)


LINES = (
    Line(
        id="name",
        covers=("name", "node-lines"),
        title="A test fails when the node has another name.",
        promise="the node is called speed_guard.",
        points=1,
        hints=(
            "get_node_names_and_namespaces() of your own node lists all nodes that it has found.",
            "Compare the whole name: a node called my_speed_guard is another node.",
            contract.MUTATE,
        ),
        doc=contract.PARAMETERS,
    ),
    Line(
        id="first_distance",
        covers=("first-distance", "node-lines"),
        title="A test fails when, before the first distance arrives, the robot drives forward or cannot drive back.",
        promise="without a distance, a forward speed becomes 0.0; a backward speed stays as it is.",
        points=1,
        hints=(
            "Ask before the sensor publishes any distance, for a speed ahead and for one back.",
            contract.MUTATE,
        ),
    ),
    Line(
        id="newest",
        covers=("newest", "node-lines"),
        title="A test fails when an earlier distance decides instead of the newest one.",
        promise="linear.x becomes the safe_speed for the newest distance.",
        points=2,
        hints=(
            "One distance is not enough to see that the newest one counts.",
            "Publish several distances in one test, farther and nearer in turn, and ask after each.",
        ),
    ),
    Line(
        id="turn",
        covers=("turn", "node-lines"),
        title="A test fails when a turn, or another field than linear.x, is changed.",
        promise="all fields but linear.x stay as they are.",
        points=1,
        hints=(
            "A Twist has other fields than linear.x: ask with a turn and a sideways speed, and look at both.",
            "On a clear way nothing is changed. Ask with a turn where the guard brakes, too.",
        ),
        doc=contract.TWIST,
    ),
    Line(
        id="one_answer",
        covers=("one-answer", "node-lines"),
        title="A test fails when a command is answered more than once.",
        promise="each command is answered with exactly one command.",
        points=1,
        hints=(
            "A correct answer may still be published twice.",
            "Ask several times, spin a little longer, and count the answers.",
        ),
    ),
    Line(
        id="parameters",
        covers=("parameters", "defaults", "node-lines"),
        title="A test fails when a parameter has no effect, or a wrong default.",
        promise="stop_distance (0.5 m), slow_distance (1.5 m) and timeout (0.5 s) are parameters of the node.",
        points=2,
        hints=(
            "parameter_overrides=[Parameter('stop_distance', value=1.0)] starts a node with other parameters.",
            "Choose two other distances, and ask at a distance where the defaults lead to another answer.",
            "node.get_parameter('timeout').value is the default if the parameter was not set.",
        ),
        doc=contract.PARAMETERS,
    ),
    Line(
        id="sensor_qos",
        covers="node-lines",
        title="A test fails when the node receives nothing from a sensor that publishes best-effort.",
        promise="distance is subscribed to with qos_profile_sensor_data.",
        points=1,
        hints=(
            "A real sensor publishes best-effort. Does yours?",
            "Publish distances with qos_profile_sensor_data, and require an answer within a deadline.",
        ),
        doc=contract.QOS,
    ),
    Line(
        id="stale",
        covers=("stale", "commands-come", "node-lines"),
        title="A test fails when the node still uses an old distance.",
        promise="a distance that arrived more than timeout seconds ago is not known.",
        points=2,
        hints=(
            "Publish a distance, spin the executor for some time, and ask.",
            "Start the guard with a short timeout, Parameter('timeout', value=0.2): then the test need not wait long.",
            "Ask when little more than timeout has passed: a guard that forgets a distance much later is broken, too.",
        ),
    ),
    Line(
        id="watchdog",
        covers=("watchdog", "node-lines"),
        title="A test fails when the node does not stop the motors, exactly once, after the planner falls silent.",
        promise="after timeout seconds without a command, exactly one command of zeros is published, "
        "and none before the first command.",
        points=3,
        hints=(
            "Test four things: nothing before the first command, zeros after the last, only once, "
            "and once more after the next command.",
            "To see that nothing is published, spin for some time, and count afterwards.",
        ),
    ),
)


@check_each_row(group("node", after=RIGHT_CHECK), LINES)
def expect_detection(line: Line, examination: Examination) -> None:
    """Fail the check unless the tests of the file fail on every version that breaks the line."""
    examination.expect_detection(line.id, line.promise)
