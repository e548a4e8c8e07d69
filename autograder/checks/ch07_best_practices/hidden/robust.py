"""Checks of the robust node: its status and its log while its sensor fails, and afterwards."""

from __future__ import annotations

import itertools
import math
import random
import re
from typing import Any

from rclpy.qos import DurabilityPolicy
from std_msgs.msg import String

from autograder.checking import LOCKSTEP, Kind, StudentError, Workspace, expect, group, hint
from autograder.checking.probes import calls, late_joiner, namespaces, node_callbacks, parameters
from autograder.checks.ch07_best_practices.hidden.bugs import BUGS, PLAIN_BUGS, call_with_bugs
from autograder.checks.ch07_best_practices.support.contract import (
    ERRORS,
    LOGGING,
    PACKAGE,
    QOS,
    RANDOM,
    ROBUST,
    RULE_STATUS,
)
from autograder.checks.ch07_best_practices.support.drawn_readings import draw_cases
from autograder.checks.ch07_best_practices.support.robot import STATUS, Robust, count_logged
from autograder.checks.ch07_best_practices.support.sensor_run import SensorRun, numbers_and_probabilities

check = group("robust")
DEFAULTS: dict[str, parameters.Value] = {"failure_probability": 0.1, "seed": 0, "max_errors": 10}
ERROR_SECONDS = 5.0  # s: the shortest time between two errors in the log
SLACK = 0.6  # s by which a time may differ in real time, where a reading takes 1 s
LOG = "rclpy.impl.rcutils_logger._rclpy.rclpy_logging_rcutils_log"  # the function through which rclpy logs
# The ranges of the parameters.
LIMITS = {"failure_probability": (0.0, 1.0), "seed": (0, 2**31 - 1), "max_errors": (1, 1000)}


@check(points=1, covers=("once-a-second", "ok"))
@hint("create_timer(PERIOD, self.timer_callback) in __init__.", "Publish once in each call of timer_callback.")
def test_once_a_second(workspace: Workspace) -> None:
    """robust_node publishes a status once a second. With a sensor that never fails, it is always ok."""
    with Robust(workspace, failure_probability=0.0) as harness:
        statuses = harness.advance(10)
        rate = harness.rate(STATUS, 0.0)
    expect(len(statuses) == 10, f"In 10 s, it published {len(statuses)} statuses instead of 10.")
    expect(abs(rate - 1.0) < 0.1, f"It published {rate:.1f} statuses a second instead of one.")
    expect(set(statuses) == {"ok"}, f"Without failures, it published {sorted(set(statuses))} instead of ok.")


@check(points=2, covers=("once-a-second", "robust-relative"), after=("once_a_second",), doc=QOS)
@hint("QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) for the publisher.", "STATUS_QOS, not 10.")
@hint("'status' is relative, '/status' is not.")
def test_late_joiners(workspace: Workspace) -> None:
    """A node that joins late receives the last status immediately, in any namespace: status is transient local."""
    with Robust(workspace) as harness:
        harness.receive(3)
        publishers = harness.node.get_publishers_info_by_topic(STATUS)
        # In real time, the node continues to publish while a subscriber joins.
        count = late_joiner.count_kept_messages(harness.node, STATUS, String) if harness.time == LOCKSTEP else 1
    are_durable = [peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in publishers]
    expect(
        bool(are_durable) and all(are_durable),
        "status is not transient local: a display that joins late shows nothing.",
    )
    expect(count == 1, f"A late display received {count} messages instead of only the last one.", fraction=0.5)
    message = namespaces.missing_in_namespace(workspace, PACKAGE, "robust_node", ("status",))
    expect(not message, message, fraction=0.5)


@check(points=3, covers=("failed", "ok", "generator", "read-sensor"), after=("once_a_second",))
@hint(RULE_STATUS, "A success sets the count back to 0.")
def test_counts(workspace: Workspace, flaky_run: SensorRun, draw: random.Random) -> None:
    """robust_node counts failures in a row, and starts again after a success."""
    # Another check tests from which failure on the node is unstable.
    actual, expected = (
        [each.replace("unstable", "failed") for each in texts] for texts in (flaky_run.statuses, flaky_run.expected)
    )
    wrong = flaky_run.first_wrong(lambda number: actual[number] == expected[number])
    message = f"{flaky_run.situation}, reading {(wrong or 0) + 1} led to the status {actual[wrong or 0]!r}"
    expect(wrong is None, f"{message} instead of {expected[wrong or 0]!r}.")
    _expect_one_random_number(workspace, draw)
    _expect_separate_counts(workspace)


def _expect_one_random_number(workspace: Workspace, draw: random.Random) -> None:
    """Fail the check unless read_sensor calls random() once, and fails only for a number below the probability."""
    cases = [(0.5, 0.0), (0.0, 0.0), (0.5, 1.0), *draw_cases(numbers_and_probabilities(), draw, 15)]
    plan, read_steps = calls.Plan(), []
    for number, probability in cases:
        returns: dict[str, Any] = {"random.return_value": number}
        generator = plan.add(calls.call("Mock", module="unittest.mock", **returns))
        read_steps.append(plan.add(calls.call("read_sensor", calls.result_of(generator), probability)))
        plan.add(calls.attribute("call_count", on=plan.add(calls.attribute("random", on=generator))))
    outcomes = calls.run_steps(workspace, ROBUST, *plan.steps)
    for (number, probability), step in zip(cases, read_steps, strict=True):
        result, _, count = outcomes[step : step + 3]
        is_correct = "SensorError" in result.kinds if number < probability else result.value == "Success"
        sentence = f"With the number {number} from the generator and failure_probability {probability}, read_sensor"
        result_text = f"raised {result.raised}" if result.raised else f"returned {result.value!r}"
        message = f"{sentence} {result_text}. It should fail only if the number is below the probability."
        expect(is_correct, message, fraction=0.5)
        message = f"{sentence} called generator.random() {count.value} times instead of once."
        expect(count.value == 1, message, fraction=0.5)


def _expect_separate_counts(workspace: Workspace) -> None:
    """Fail the check if one of two nodes in a process counts the failures of the other."""
    arguments = ["--ros-args", *parameters.override_arguments({"failure_probability": 1.0})]
    node = calls.call("RobustNode", cli_args=arguments)
    turns = [(number, "timer_callback", None) for number in (0, 0, 1)]
    texts = node_callbacks.published(workspace, ROBUST, [node, node], turns)
    statuses_of_calls = [re.findall(r"data='([^']+)'", text) for text in texts]
    if not all(len(statuses) == 1 for statuses in statuses_of_calls):
        return  # another check tests what a callback publishes
    status = statuses_of_calls[2][0]
    count = re.search(r"\d+", status)
    # A node that ignores its arguments does not always fail. `bugs_are_seen` tests the arguments.
    sentence = "In one process, a robust node failed twice. Then another one failed once, and published"
    expect(count is None or int(count[0]) == 1, f"{sentence} {status!r}: each counts its own failures.", fraction=0.5)


@check(points=1, covers=("seed", "generator"), after=("once_a_second",), doc=RANDOM)
@hint("random.Random() without a seed takes one from the operating system.", "seed 0: random.Random().")
def test_no_seed(workspace: Workspace, draw: random.Random) -> None:
    """Without a seed, two runs of robust_node differ. The node has a random generator of its own."""
    runs = []
    for _ in range(2):
        with Robust(workspace, failure_probability=0.5) as harness:
            runs.append(harness.receive(50))
    expect(all(runs), "It published nothing on status.")
    expect(runs[0] != runs[1], "Two runs without a seed failed at exactly the same readings.")
    seed = draw.randrange(10**6)
    *_, shared_number = calls.run_steps(
        workspace,
        ROBUST,
        calls.call("init", module="rclpy"),
        calls.call("seed", seed, module="random"),
        calls.call("RobustNode"),
        calls.call("RobustNode", cli_args=["--ros-args", *parameters.override_arguments({"seed": seed + 1})]),
        calls.call("random", module="random"),
        network=True,
    )
    is_unchanged = shared_number.value == random.Random(seed).random()
    message = "Creating a RobustNode changed the shared generator of the module random"
    expect(is_unchanged, f"{message}: the node should have a random.Random of its own.", fraction=0.5)


@check(points=2, covers=("unstable", "max-errors"), after=("once_a_second",))
@hint(RULE_STATUS, "unstable means more than max_errors failures in a row, not exactly max_errors.")
def test_unstable(dead_run: SensorRun, flaky_run: SensorRun) -> None:
    """robust_node is unstable after more than max_errors failures in a row, and not one failure earlier."""
    shown_count = dead_run.max_errors + 3
    message = f"With max_errors {dead_run.max_errors} and a dead sensor, it published {dead_run.statuses[:shown_count]}"
    expect(dead_run.statuses == dead_run.expected, f"{message} instead of {dead_run.expected[:shown_count]}.")
    wrong = flaky_run.first_wrong(lambda number: flaky_run.statuses[number] == flaky_run.expected[number])
    message = f"{flaky_run.situation}, reading {(wrong or 0) + 1} led to the status {flaky_run.statuses[wrong or 0]!r}"
    expect(wrong is None, f"{message} instead of {flaky_run.expected[wrong or 0]!r}.", fraction=0.5)


@check(points=1, covers="error-log", after=("once_a_second",), doc=LOGGING)
@hint("error(..., throttle_duration_sec=5.0).", "A dead sensor fails every second. One line in 5 s is enough.")
def test_errors_throttled(workspace: Workspace, dead_run: SensorRun, flaky_run: SensorRun) -> None:
    """robust_node logs failures as errors, at most one line in 5 s."""
    count = sum(reading.count("ERROR") for reading in dead_run.readings)
    expect(count > 0, f"Its sensor failed for {len(dead_run.readings)} s, and it logged nothing at level ERROR.")
    for run in (dead_run, flaky_run):
        last_error_seconds = -math.inf
        for reading, failures in zip(run.readings, run.failures, strict=True):
            count = reading.count("ERROR")
            errors = ("no error", "an error")[count] if count < 2 else f"{count} errors"
            sentence = f"{run.situation}, it logged {errors} {reading.seconds:.0f} s after its start"
            expect(count == 0 or failures > 0, f"{sentence}, although the reading did not fail.", fraction=0.5)
            is_too_soon = count > 1 or (count == 1 and reading.seconds - last_error_seconds < ERROR_SECONDS - SLACK)
            message = f"{sentence}, only {reading.seconds - last_error_seconds:.0f} s after the error before."
            expect(not is_too_soon, message if count == 1 else f"{sentence}.", fraction=0.5)
            is_overdue = count == 0 and failures > 0 and reading.seconds - last_error_seconds > 2 * ERROR_SECONDS
            message = f"{sentence}, although a reading failed, and none in the {2 * ERROR_SECONDS:.0f} s before."
            expect(not is_overdue, message, fraction=0.5)
            last_error_seconds = reading.seconds if count else last_error_seconds
    _expect_unstable_error(workspace)


def _expect_unstable_error(workspace: Workspace) -> None:
    """Fail the check if the failure that makes a node unstable is not logged as an error although one is due."""
    plan = calls.Plan()
    plan.add(calls.call("init", module="rclpy"))
    log = plan.add(calls.call("start", on=plan.add(calls.call("patch", LOG, module="unittest.mock"))))
    returns: dict[str, Any] = {"random.return_value": 0.0}
    generator = plan.add(calls.call("Mock", module="unittest.mock", **returns))
    arguments = ["--ros-args", *parameters.override_arguments({"max_errors": 1})]
    node = plan.add(calls.call("RobustNode", generator=calls.result_of(generator), cli_args=arguments))
    texts = []
    for seconds in (0.0, ERROR_SECONDS + 1.5):
        plan.add(calls.call("sleep", seconds, module="time"))
        plan.add(calls.callback("timer_callback", on=node))
        records = plan.add(calls.attribute("call_args_list", on=log))
        texts.append(plan.add(calls.call("repr", calls.result_of(records), module="builtins")))
    outcomes = calls.run_steps(workspace, ROBUST, *plan.steps, network=True)
    first, both = (str(outcomes[text].value).count("LoggingSeverity.ERROR") for text in texts)
    sentence = "The failure that made it unstable occurred more than 5 s after the last logged error"
    expect(first != 1 or both == 2, f"{sentence}, and was not logged as an error.", fraction=0.5)


@check(points=1, covers="fatal-log", after=("once_a_second", "counts"), doc=LOGGING)
@hint("Log fatal only if the count is exactly max_errors + 1.", "In a series of failures, it becomes unstable once.")
def test_fatal_once(dead_run: SensorRun, flaky_run: SensorRun) -> None:
    """robust_node logs the failure that makes it unstable as fatal, once in each series of failures."""
    for run, fraction in ((dead_run, 0.0), (flaky_run, 0.5)):
        expected = [int(failures == run.max_errors + 1) for failures in run.failures]
        actual = [reading.count("FATAL") for reading in run.readings]
        wrong = next((number for number in range(len(actual)) if actual[number] != expected[number]), 0)
        sentence = f"{run.situation}, after {run.failures[wrong]} failures in a row"
        message = f"{sentence} it logged {actual[wrong]} fatal messages instead of {expected[wrong]}."
        expect(actual == expected, message, fraction=fraction)


@check(points=1, covers="recovery-log", after=("counts",))
@hint("Log before the count is set back to 0.", "Only if there were errors: if self.error_count:")
def test_recovery_logged(flaky_run: SensorRun) -> None:
    """robust_node logs each recovery, with the number of errors before it."""
    counts = [before if now == 0 else 0 for before, now in itertools.pairwise([0, *flaky_run.failures])]
    expected = [[f"{count} errors"] if count else [] for count in counts]
    actual = [reading.recoveries for reading in flaky_run.readings]
    pairs = zip(counts, expected, strict=True)
    without_unstable = [[] if count > flaky_run.max_errors else texts for count, texts in pairs]
    wrong = flaky_run.first_wrong(lambda number: actual[number] == expected[number]) or 0
    logs = f"{' and '.join(actual[wrong]) or 'none'}. Expected: {' and '.join(expected[wrong]) or 'none'}"
    message = f"{flaky_run.situation}, at reading {wrong + 1}, it logged recoveries after: {logs}."
    expect(actual == expected, message, fraction=0.5 if actual == without_unstable else 0.0)
    lines = [line for reading in flaky_run.readings for line in reading.log.splitlines() if "Recovered after " in line]
    infos = count_logged("\n".join(lines), "INFO")
    expect(infos == len(lines), f"It logged {infos} of {len(lines)} recoveries at level INFO.", fraction=0.5)


@check(points=2, covers=("catch", "handed-on", "generator"), after=("once_a_second",), doc=ERRORS)
@hint("except SensorError, not except Exception.", "Catch only what you expect: a bug has to be seen.")
def test_bugs_are_seen(workspace: Workspace) -> None:
    """robust_node catches SensorError and nothing else: a bug ends the node with a traceback."""
    results = call_with_bugs(workspace)
    creation = results.creation
    expect(not creation.raised, f"RobustNode(generator=...) raised {creation.raised}: {creation.message}")
    for bug, result in results.callbacks.items():
        fraction = 0.0 if bug in PLAIN_BUGS else 0.75
        expect(bool(result.raised), f"A bug in timer_callback raised {bug}, which was swallowed.", fraction=fraction)
        message = f"A bug in timer_callback raised {result.raised} instead of the {bug} itself."
        expect(result.raised == bug, message, fraction=fraction)
    message = f"RobustNode(namespace='hall') is in {results.namespace.value}: pass its kwargs on to Node."
    expect(results.namespace.value == "/hall", message, fraction=0.5)
    message = "With the parameter seed 5, a RobustNode did not use the generator that was passed in."
    expect(results.seeded_callback.raised == BUGS[-1], message, fraction=0.75)


@check(points=1, covers=("failure-probability", "seed", "max-errors"), after=("once_a_second",))
@hint("The table of the exercise names type, default and range of each.")
@hint("declare_parameter(name, default, descriptor)")
def test_declared(workspace: Workspace) -> None:
    """robust_node declares its three parameters with the defaults and ranges of the contract."""
    with Robust(workspace) as harness:
        node = parameters.NodeParameters(harness, "/robust_node")
        missing = parameters.missing_sentence(DEFAULTS, node.names())
        expect(not missing, missing)
        wrong_defaults = parameters.differences(node.values(*DEFAULTS), DEFAULTS)
        descriptors = node.descriptors(*DEFAULTS)
    expect(not wrong_defaults, f"Without any file or argument, {', '.join(wrong_defaults)}.")
    ranges = {name: [*d.floating_point_range, *d.integer_range] for name, d in descriptors.items()}
    for name, limits in LIMITS.items():
        declared_limits = [(span.from_value, span.to_value) for span in ranges[name]]
        expect(
            declared_limits == [limits],
            f"{name} is declared with {declared_limits or 'no range'} instead of {limits}.",
        )
    for name, default in DEFAULTS.items():
        step, max_step = ranges[name][0].step, 1 if isinstance(default, int) else 0
        message = f"The range of {name} has steps of {step:g}. It should allow every value between its ends."
        expect(step <= max_step, message, fraction=0.5)


@check(points=1, covers=("failure-probability", "max-errors"), after=("once_a_second",))
@hint("FloatingPointRange(from_value=0.0, to_value=1.0) in the descriptor.", "IntegerRange for max_errors.")
def test_ranges(workspace: Workspace) -> None:
    """robust_node refuses to start with a probability above 1, or with max_errors below 1."""
    with Robust(workspace, failure_probability=1.0, max_errors=1):
        pass  # the node starts with values at the limits
    for name, invalid_value in (("failure_probability", 1.5), ("max_errors", 0)):
        try:
            with Robust(workspace, **{name: invalid_value}):
                has_started = True
        except StudentError as error:
            if error.diagnosis.kind is not Kind.CRASHED_AT_START:
                raise
            has_started = False
        expect(not has_started, f"It started with {name} {invalid_value}.")
