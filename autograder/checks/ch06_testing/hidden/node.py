"""Checks that tests of the node fail if speed_guard breaks its contract, and that they are isolated."""

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
@hint("Ask over topics, as another robot would; attributes of the node may have other names tomorrow.")
@hint("Each test starts its own guard and leaves nothing behind.")
def test_guard_right(examination: Examination) -> None:
    """They pass on every right speed_guard, in any order."""
    examination.expect_right(GUARD, BACKWARDS)


@check(points=2, covers="own-domain", after=RIGHT_CHECK, doc=contract.DOMAIN)
@hint("Without a domain of its own, a context listens to whoever is in the default one.")
@hint("rclpy.init(context=context, domain_id=...): a number that another test process does not use.")
def test_alone(examination: Examination) -> None:
    """They meet in a domain of their own, where no other robot takes part."""
    examination.expect_usable(GUARD)
    expect(
        not examination.trial[GUARD].joined_domain,
        f"While the tests in {GUARD} ran, a node of theirs appeared in the default domain, in which other robots are.",
    )


@check(points=1, covers="guard-pass", after=RIGHT_CHECK, doc=contract.FIXTURES)
@hint("What stands after yield in a fixture is done in any case, also when the test fails.")
@hint("Destroy each node, then rclpy.try_shutdown(context=context).")
def test_nothing_left(examination: Examination) -> None:
    """They leave no node and no context behind."""
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
            "get_node_names_and_namespaces() of your own node lists all nodes that it sees.",
            "Compare the whole name: a node called my_speed_guard is another one.",
            contract.MUTATE,
        ),
        doc=contract.PARAMETERS,
    ),
    Line(
        id="first_distance",
        covers=("first-distance", "node-lines"),
        title="A test fails when the robot drives before the first distance has come, or may not drive back then.",
        promise="a distance is not known before the first one has come, and the way back is free all the same.",
        points=1,
        hints=(
            "Ask before you show it any distance, for a speed ahead and for one back.",
            contract.MUTATE,
        ),
    ),
    Line(
        id="newest",
        covers=("newest", "node-lines"),
        title="A test fails when an earlier distance decides.",
        promise="linear.x becomes the safe_speed for the newest distance.",
        points=2,
        hints=(
            "One distance is not enough to see that the newest one counts.",
            "Show it several in one test, farther and nearer in turn, and ask after each.",
        ),
    ),
    Line(
        id="turn",
        covers=("turn", "node-lines"),
        title="A test fails when a turn, or another field, does not come out as it went in.",
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
            "An answer that is right may still come twice.",
            "Ask some times, spin a little longer, and count what has come.",
        ),
    ),
    Line(
        id="parameters",
        covers=("parameters", "defaults", "node-lines"),
        title="A test fails when a parameter has no effect, or another default.",
        promise="stop_distance (0.5 m), slow_distance (1.5 m) and timeout (0.5 s) are parameters of the node.",
        points=2,
        hints=(
            "parameter_overrides=[Parameter('stop_distance', value=1.0)] starts a node with other parameters.",
            "Choose both distances anew, and ask at a distance at which the defaults would answer otherwise.",
            "node.get_parameter('timeout').value is the default where nothing was chosen.",
        ),
        doc=contract.PARAMETERS,
    ),
    Line(
        id="sensor_qos",
        covers="node-lines",
        title="A test fails when the node cannot hear a sensor that publishes best-effort.",
        promise="distance is subscribed to with qos_profile_sensor_data.",
        points=1,
        hints=(
            "A real sensor publishes best-effort. Does yours?",
            "Publish distances with qos_profile_sensor_data, and count on an answer within a deadline.",
        ),
        doc=contract.QOS,
    ),
    Line(
        id="stale",
        covers=("stale", "commands-come", "node-lines"),
        title="A test fails when an old distance is still believed.",
        promise="a distance that came more than timeout seconds ago is not known.",
        points=2,
        hints=(
            "Show it a distance, let time pass with the executor spinning, and ask.",
            "Start it with a short timeout: Parameter('timeout', value=0.2), and the test need not wait long.",
            "Ask when little more than timeout has passed: a guard that forgets only much later is broken, too.",
        ),
    ),
    Line(
        id="watchdog",
        covers=("watchdog", "node-lines"),
        title="A test fails when the motors are not stopped, just once, after the planner has fallen silent.",
        promise="after timeout seconds without a command, one command of zeros is published, "
        "and none before the first.",
        points=3,
        hints=(
            "There are four things to see: nothing before the first command, zeros after the last, only once, "
            "and once more after the next command.",
            "That nothing comes can only be seen by spinning for some time, and counting afterwards.",
        ),
    ),
)


@check_each_row(group("node", after=RIGHT_CHECK), LINES)
def expect_objection(line: Line, examination: Examination) -> None:
    """Fail the check unless the tests of the file fail on every version that breaks the line."""
    examination.expect_objection(line.id, line.promise)
