"""Tests of the node: do they notice when speed_guard breaks its contract, and do they keep to themselves?"""

from __future__ import annotations

from autograder.checks import expect, group, hint
from autograder.checks.ch06_testing.hidden.examination import BACKWARDS, SECOND, Examination
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.contract import GUARD
from autograder.checks.ch06_testing.support.verdicts import expect_passed

check = group("node")
RIGHT = ("guard_right",)


@check(points=2, doc=contract.PYTEST)
@hint("Run them: colcon test, or python -m pytest test/test_guard.py in the package's folder.", contract.SPIN)
def test_guard_pass(examination: Examination) -> None:
    """At least five tests in test_guard.py run, and all pass on the package as it is."""
    expect_passed(GUARD, examination.trial.get(GUARD))


@check(points=1, depends=("guard_pass",), doc=contract.PYTEST)
@hint("Ask over topics, as another robot would; attributes of the node may have other names tomorrow.")
@hint("Each test starts its own guard and leaves nothing behind.")
def test_guard_right(examination: Examination) -> None:
    """They pass on every right speed_guard, in any order."""
    examination.expect_right(GUARD, SECOND, BACKWARDS)


@check(points=2, depends=RIGHT, doc=contract.DOMAIN)
@hint("Without a domain of its own, a context listens to whoever is in the default one.")
@hint("rclpy.init(context=context, domain_id=...): a number that another test process does not use.")
def test_alone(examination: Examination) -> None:
    """They meet in a domain of their own, where no other robot takes part."""
    expect(
        not examination.trial[GUARD].joined_domain,
        f"While the tests in {GUARD} ran, a node of theirs appeared in the default domain, in which other robots are.",
    )


@check(points=1, depends=RIGHT, doc=contract.FIXTURES)
@hint("What stands after yield in a fixture is done in any case, also when the test fails.")
@hint("Destroy each node, then rclpy.try_shutdown(context=context).")
def test_nothing_left(examination: Examination) -> None:
    """They leave no node and no context behind."""
    left = examination.trial[GUARD].left
    expect(left == 0, f"After the last test in {GUARD}, {left} network sockets of ROS contexts were still open.")


@check(points=1, depends=RIGHT, doc=contract.PARAMETERS)
@hint("get_node_names_and_namespaces() of your own node lists all nodes that it sees.", contract.MUTATE)
def test_name(examination: Examination) -> None:
    """A test fails when the node has another name."""
    examination.expect_objection("name", "the node is called speed_guard.")


@check(points=1, depends=RIGHT, doc=contract.PYTEST)
@hint("Ask before you show it any distance.", contract.MUTATE)
def test_first_distance(examination: Examination) -> None:
    """A test fails when the robot drives before the first distance has come."""
    examination.expect_objection("first_distance", "a distance is not known before the first one has come.")


@check(points=2, depends=RIGHT, doc=contract.PYTEST)
@hint("One distance is not enough to see that the newest one counts.")
@hint("Show it several in one test, farther and nearer in turn, and ask after each.")
def test_newest(examination: Examination) -> None:
    """A test fails when an earlier distance decides."""
    examination.expect_objection("newest", "linear.x becomes the safe_speed for the newest distance.")


@check(points=1, depends=RIGHT, doc=contract.TWIST)
@hint("A Twist has other fields than linear.x.", "Ask with a turn, and look at angular.z of the answer.")
def test_turn(examination: Examination) -> None:
    """A test fails when a turn is lost on the way."""
    examination.expect_objection("turn", "all fields but linear.x stay as they are.")


@check(points=1, depends=RIGHT, doc=contract.PYTEST)
@hint("An answer that is right may still come twice.", "Ask some times, spin a little longer, and count what has come.")
def test_one_answer(examination: Examination) -> None:
    """A test fails when a command is answered more than once."""
    examination.expect_objection("one_answer", "each command is answered with exactly one command.")


@check(points=2, depends=RIGHT, doc=contract.PARAMETERS)
@hint("parameter_overrides=[Parameter('stop_distance', value=1.0)] starts a node with other parameters.")
@hint("Choose both anew, and ask at a distance at which the defaults would answer otherwise.")
def test_parameters(examination: Examination) -> None:
    """A test fails when the parameters stop_distance and slow_distance have no effect."""
    examination.expect_objection("parameters", "stop_distance and slow_distance are parameters of the node.")


@check(points=1, depends=RIGHT, doc=contract.QOS)
@hint("A real sensor publishes best-effort. Does yours?")
@hint("Publish distances with qos_profile_sensor_data, and count on an answer within a deadline.")
def test_sensor_qos(examination: Examination) -> None:
    """A test fails when the node cannot hear a sensor that publishes best-effort."""
    examination.expect_objection("sensor_qos", "distance is subscribed to with qos_profile_sensor_data.")


@check(points=2, depends=RIGHT, doc=contract.PYTEST)
@hint("Show it a distance, let time pass with the executor spinning, and ask.")
@hint("Start it with a short timeout: Parameter('timeout', value=0.2), and the test need not wait long.")
def test_stale(examination: Examination) -> None:
    """A test fails when an old distance is still believed."""
    examination.expect_objection("stale", "a distance that came more than timeout seconds ago is not known.")


@check(points=3, depends=RIGHT, doc=contract.PYTEST)
@hint("There are three things to see: nothing before the first command, zeros after the last, and only once.")
@hint("That nothing comes can only be seen by spinning for some time, and counting afterwards.")
def test_watchdog(examination: Examination) -> None:
    """A test fails when the motors are not stopped, just once, after the planner has fallen silent."""
    promise = "after timeout seconds without a command, one command of zeros is published, and none before the first."
    examination.expect_objection("watchdog", promise)
