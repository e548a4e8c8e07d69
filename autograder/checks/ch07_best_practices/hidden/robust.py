"""The robust node: its status and its log while its sensor fails, and after that."""

from __future__ import annotations

import itertools
import random
import re
from typing import Any

from rclpy.qos import DurabilityPolicy
from std_msgs.msg import String

from autograder.checking import LOCKSTEP, Kind, StudentError, Workspace, expect, group, hint
from autograder.checking.probes import calls, late_joiner, namespaces, node_callbacks, parameters
from autograder.checks.ch07_best_practices.hidden.bugs import BUGS, call_with_bugs
from autograder.checks.ch07_best_practices.support.contract import (
    ERRORS,
    LOGGING,
    PACKAGE,
    QOS,
    RANDOM,
    ROBUST,
    RULE_STATUS,
)
from autograder.checks.ch07_best_practices.support.robot import STATUS, Robust, expected_statuses, logged

check = group("robust")
DEFAULTS: dict[str, parameters.Value] = {"failure_probability": 0.1, "seed": 0, "max_errors": 10}
READINGS = 20
ALTERNATING = 10  # readings, every second of which fails
LIMITS = {"failure_probability": (0.0, 1.0), "seed": (0, 2**31 - 1), "max_errors": (1, 1000)}


@check(points=1, covers=("once-a-second", "ok"))
@hint("create_timer(PERIOD, self.timer_callback) in __init__.", "Publish once in each call of timer_callback.")
def test_once_a_second(workspace: Workspace) -> None:
    """robust_node publishes its state on status once a second; with a sensor that never fails, ok."""
    with Robust(workspace, failure_probability=0.0) as harness:
        statuses = harness.advance(10)
        rate = harness.rate(STATUS, 0.0)
    expect(len(statuses) == 10, f"In 10 s it published its state {len(statuses)} times.")
    expect(abs(rate - 1.0) < 0.1, f"It published its state {rate:.1f} times a second, instead of once.")
    expect(set(statuses) == {"ok"}, f"With a sensor that never fails it said {sorted(set(statuses))} instead of ok.")


@check(points=2, covers=("once-a-second", "robust-relative"), after=("once_a_second",), doc=QOS)
@hint("QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) for the publisher.", "STATUS_QOS, not 10.")
@hint("'status' is relative, '/status' is not.")
def test_late_joiners(workspace: Workspace) -> None:
    """A node that joins late can have the last status immediately, in any namespace: it is offered transient local."""
    with Robust(workspace) as harness:
        harness.receive(3)
        publishers = harness.node.get_publishers_info_by_topic(STATUS)
        # In real time, the node continues to publish while a subscriber joins.
        count = late_joiner.count_kept_messages(harness.node, STATUS, String) if harness.time == LOCKSTEP else 1
    durable = [peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in publishers]
    expect(bool(durable) and all(durable), "status is offered volatile: a display that joins late shows nothing.")
    expect(count == 1, f"A display that joins late got {count} messages, not the last one alone.", fraction=0.5)
    message = namespaces.missing_in_namespace(workspace, PACKAGE, "robust_node", ("status",))
    expect(not message, message, fraction=0.5)


@check(points=3, covers=("failed", "ok", "generator", "read-sensor"), after=("once_a_second",))
@hint(RULE_STATUS, "A success sets the count back to 0.")
def test_counts(workspace: Workspace, draw: random.Random) -> None:
    """It counts failures in a row, and starts again after a success."""
    # Tenths, so that this check does not depend on the step of the range, which `declared` tests.
    seed, probability = draw.randint(1, 2**31 - 1), draw.choice((0.4, 0.6, 0.7))
    with Robust(workspace, seed=seed, failure_probability=probability) as harness:
        statuses = harness.receive(40)
    correct = expected_statuses(seed, probability, 40)
    wrong = next((i for i, (a, b) in enumerate(zip(statuses, correct, strict=False)) if a != b), min(len(statuses), 40))
    actual = statuses[wrong] if wrong < len(statuses) else "nothing"
    sentence = f"With seed {seed} and failure_probability {probability}, reading {wrong + 1} made it say {actual!r}"
    expect(statuses == correct, f"{sentence} instead of {correct[min(wrong, 39)]!r}.", fraction=0.0)
    never, always = 0.0, 1.0
    steps = (
        calls.call("read_sensor", calls.result_of(0), never),
        calls.call("read_sensor", calls.result_of(0), always),
        calls.call("random", on=0),
    )
    succeeded, failed, third = calls.calls(workspace, ROBUST, calls.call("Random", seed, module="random"), *steps)[1:]
    is_right = succeeded.value == "Success" and "SensorError" in failed.kinds
    results = f"returned {succeeded.value!r} and raised {failed.raised or 'nothing'}"
    message = f"With the probabilities 0 and 1, read_sensor {results}"
    expect(is_right, f"{message}, instead of 'Success' and SensorError.", fraction=0.5)
    returns: dict[str, Any] = {"random.return_value": probability}
    generator = calls.call("Mock", module="unittest.mock", **returns)
    _, equal = calls.calls(workspace, ROBUST, generator, calls.call("read_sensor", calls.result_of(0), probability))
    message = f"When the generator says {probability}, and the probability is that, read_sensor raised {equal.raised}"
    expect(equal.value == "Success", f"{message}: only a number below it is a failure.", fraction=0.5)
    generator_copy = random.Random(seed)
    expected_third = [generator_copy.random() for _ in range(3)][2]
    asked_twice = third.value == expected_third
    message = "In two readings with the probabilities 0 and 1, it did not ask the generator twice."
    expect(asked_twice, message, fraction=0.5)
    _expect_separate_counts(workspace)


def _expect_separate_counts(workspace: Workspace) -> None:
    """Fail the check if one of two nodes in a process counts the failures of the other."""
    always = ["--ros-args", *parameters.override_arguments({"failure_probability": 1.0})]
    node = calls.call("RobustNode", cli_args=always)
    turns = [(number, "timer_callback", None) for number in (0, 0, 1)]
    texts = node_callbacks.published(workspace, ROBUST, [node, node], turns)
    statuses = [re.findall(r"data='([^']+)'", text) for text in texts]
    if not all(len(status) == 1 for status in statuses):
        return  # another check tests what a callback publishes
    status = statuses[2][0]
    count = re.search(r"\d+", status)
    # A node that ignores its arguments does not always fail. `bugs_are_seen` tests the arguments.
    sentence = "Of two robust nodes in one process, one failed twice, then the other one for the first time, and said"
    expect(count is None or int(count[0]) == 1, f"{sentence} {status!r}: each counts its own failures.", fraction=0.5)


@check(points=1, covers=("seed", "generator"), after=("once_a_second",), doc=RANDOM)
@hint("random.Random() without a seed takes one from the operating system.", "seed 0: random.Random().")
def test_no_seed(workspace: Workspace, draw: random.Random) -> None:
    """Without a seed, two runs differ; and the node's generator is its own."""
    runs = []
    for _ in range(2):
        with Robust(workspace, failure_probability=0.5) as harness:
            runs.append(harness.receive(50))
    expect(all(runs), "It said nothing on status.")
    expect(runs[0] != runs[1], "Two runs without a seed failed at the very same readings.")
    seed = draw.randrange(10**6)
    *_, shared_number = calls.calls(
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
    message = "When a RobustNode was made, the generator of the module random changed, which all share"
    expect(is_unchanged, f"{message}: the node's is a random.Random of its own.", fraction=0.5)


@check(points=2, covers=("unstable", "max-errors"), after=("once_a_second",))
@hint(RULE_STATUS, "More than max_errors, not as many as.")
def test_unstable(workspace: Workspace, draw: random.Random) -> None:
    """More than max_errors failures in a row are called unstable, and one fewer is not."""
    max_errors = draw.randint(2, 5)
    with Robust(workspace, failure_probability=1.0, max_errors=max_errors) as harness:
        statuses = harness.receive(max_errors + 3)
    correct = expected_statuses(1, 1.1, max_errors + 3, max_errors)
    message = f"With max_errors {max_errors} and a dead sensor it said {statuses}, instead of {correct}."
    expect(statuses == correct, message)
    seed = _draw_unstable_seed(draw)
    with Robust(workspace, seed=seed, failure_probability=0.5, max_errors=1) as harness:
        statuses = harness.receive(READINGS)
    correct = expected_statuses(seed, 0.5, READINGS, 1)
    wrong = next((i for i, (a, b) in enumerate(zip(statuses, correct, strict=False)) if a != b), None)
    message = f"reading {(wrong or 0) + 1} made it say {statuses[wrong or 0] if statuses else 'nothing'!r}"
    expect(statuses == correct, f"With max_errors 1, {message} instead of {correct[wrong or 0]!r}.", fraction=0.5)


@check(points=1, covers="error-log", after=("once_a_second",), doc=LOGGING)
@hint("error(..., throttle_duration_sec=5.0).", "A dead sensor fails every second; one line in five is enough.")
def test_errors_throttled(workspace: Workspace, draw: random.Random) -> None:
    """It logs failures as errors, at most one line in 5 s."""
    with Robust(workspace, failure_probability=1.0, max_errors=2) as harness:
        harness.receive(4)
        early, early_seconds = logged(harness.output, "ERROR"), harness.seconds
        harness.receive(26)
        errors, seconds = logged(harness.output, "ERROR"), harness.seconds
    situation = f"Its sensor failed for {seconds:.0f} s, unstable from the third failure on"
    expect(errors > 0, f"{situation}, and it said nothing at level ERROR.")
    expect(errors > 1, f"{situation}, and it logged only one error.", fraction=0.5)
    expect(errors <= seconds / 5 + 1, f"{situation}, and it logged {errors} errors.", fraction=0.5)
    situation = f"Its sensor failed four times in {early_seconds:.0f} s, the third time too often"
    expect(1 <= early <= early_seconds / 5 + 1, f"{situation}, and it logged {early} errors.", fraction=0.5)
    failures = ALTERNATING // 2
    seeds = itertools.count(draw.randint(1, 2**30))
    seed = next(
        seed for seed in seeds if expected_statuses(seed, 0.5, ALTERNATING).count("failed: 1 in a row") == failures
    )
    with Robust(workspace, seed=seed, failure_probability=0.5) as harness:
        harness.receive(ALTERNATING)
        errors, seconds = logged(harness.output, "ERROR"), harness.seconds
    message = f"Its sensor failed and recovered by turns for {seconds:.0f} s, and it logged {errors} errors."
    expect(errors <= seconds / 5 + 1, message, fraction=0.5)


@check(points=1, covers="fatal-log", after=("once_a_second", "counts"), doc=LOGGING)
@hint("fatal only where the count is exactly max_errors + 1.", "It became unstable once.")
def test_fatal_once(workspace: Workspace, draw: random.Random) -> None:
    """That it became unstable is logged as fatal, once in each series of failures."""
    with Robust(workspace, failure_probability=1.0, max_errors=3) as harness:
        harness.receive(3)
        early = logged(harness.output, "FATAL")
        harness.receive(10)
        fatal = logged(harness.output, "FATAL")
    expect(early == 0, "It logged as fatal what max_errors still allows.")
    expect(fatal == 1, f"It became unstable once, and logged {fatal} fatal messages.")
    seed = _draw_unstable_seed(draw)
    count = _count_unstable(seed)
    with Robust(workspace, seed=seed, failure_probability=0.5, max_errors=1) as harness:
        harness.receive(READINGS)
        fatal = logged(harness.output, "FATAL")
    expect(fatal == count, f"It became unstable {count} times, and logged {fatal} fatal messages.", fraction=0.5)


@check(points=1, covers="recovery-log", after=("counts",))
@hint("Log before the count is set back to 0.", "Only if there were errors: if self.error_count:")
def test_recovery_logged(workspace: Workspace, draw: random.Random) -> None:
    """Each recovery is logged with the number of errors before it."""
    seed = _draw_unstable_seed(draw)
    with Robust(workspace, seed=seed, failure_probability=0.5, max_errors=1) as harness:
        harness.receive(30)
        output = harness.output
    statuses = ["ok", *expected_statuses(seed, 0.5, 30, 1)]
    counts = [int(a.split()[1]) for a, b in itertools.pairwise(statuses) if b == "ok" and a != "ok"]
    lines = [line for line in output.splitlines() if "Recovered after " in line]
    logged_counts = [line.split("Recovered after ")[1] for line in lines]
    expected_counts = [f"{count} errors" for count in counts]
    # Half of the points if it logs only recoveries from a single failure.
    fraction = 0.5 if logged_counts == ["1 errors"] * counts.count(1) else 0.0
    sentence = f"With max_errors 1, it recovered after {counts} errors, and logged {logged_counts or 'nothing of it'}."
    expect(logged_counts == expected_counts, sentence, fraction=fraction)
    infos = logged("\n".join(lines), "INFO")
    expect(infos == len(lines), f"It logged {infos} of {len(lines)} recoveries at level INFO.", fraction=0.5)


@check(points=2, covers=("catch", "handed-on", "generator"), after=("once_a_second",), doc=ERRORS)
@hint("except SensorError, not except Exception.", "Only what you expect; a bug has to be seen.")
def test_bugs_are_seen(workspace: Workspace) -> None:
    """It catches SensorError and nothing else: a bug ends the node with a traceback."""
    results, seeded = call_with_bugs(workspace)
    for bug, (created, called, namespace) in results.items():
        fraction = 0.75 if bug in ("OSError", "ValueError") else 0.0
        expect(not created.raised, f"RobustNode(generator=...) raised {created.raised}: {created.message}")
        expect(bool(called.raised), f"A bug in timer_callback raised {bug}, and it was swallowed.", fraction=fraction)
        message = f"A bug in timer_callback raised {called.raised} instead of the {bug} itself."
        expect(called.raised == bug, message, fraction=fraction)
        message = f"RobustNode(namespace='hall') is in {namespace.value}: its kwargs are for Node."
        expect(namespace.value == "/hall", message, fraction=0.5)
    message = "With the parameter seed 5, a RobustNode did not ask the generator that was handed in."
    expect(seeded.raised == BUGS[-1], message, fraction=0.75)


@check(points=1, covers=("failure-probability", "seed", "max-errors"), after=("once_a_second",))
@hint("The table of the exercise names type, default and range of each.")
@hint("declare_parameter(name, default, descriptor)")
def test_declared(workspace: Workspace) -> None:
    """Its three parameters are declared with the defaults and ranges of the contract."""
    with Robust(workspace) as harness:
        node = parameters.NodeParameters(harness, "/robust_node")
        missing = parameters.missing_sentence(DEFAULTS, node.names())
        expect(not missing, missing)
        wrong = parameters.differences(node.values(*DEFAULTS), DEFAULTS)
        descriptors = node.descriptors(*DEFAULTS)
    expect(not wrong, f"Without any file or argument, {', '.join(wrong)}.")
    ranges = {name: [*d.floating_point_range, *d.integer_range] for name, d in descriptors.items()}
    for name, limits in LIMITS.items():
        declared = [(span.from_value, span.to_value) for span in ranges[name]]
        expect(declared == [limits], f"{name} is declared with {declared or 'no range'}, and should have {limits}.")
    for name, default in DEFAULTS.items():
        step, max_step = ranges[name][0].step, 1 if isinstance(default, int) else 0
        message = f"The range of {name} has steps of {step:g}, and should take every value from end to end."
        expect(step <= max_step, message, fraction=0.5)


@check(points=1, covers=("failure-probability", "max-errors"), after=("once_a_second",))
@hint("FloatingPointRange(from_value=0.0, to_value=1.0) in the descriptor.", "IntegerRange for max_errors.")
def test_ranges(workspace: Workspace) -> None:
    """It refuses to start with a probability above 1, or with max_errors below 1."""
    with Robust(workspace, failure_probability=1.0, max_errors=1):
        pass  # it starts with values at the limits
    for name, impossible in (("failure_probability", 1.5), ("max_errors", 0)):
        try:
            with Robust(workspace, **{name: impossible}):
                has_started = True
        except StudentError as error:
            if error.diagnosis.kind is not Kind.CRASHED_AT_START:
                raise
            has_started = False
        expect(not has_started, f"It started with {name} {impossible}.")


def _draw_unstable_seed(draw: random.Random) -> int:
    """Return a seed with which a node becomes unstable at least twice, and then has a single failure."""
    seeds = itertools.count(draw.randint(1, 2**30))
    return next(seed for seed in seeds if _count_unstable(seed) >= 2 and _has_single_failure(seed))


def _has_single_failure(seed: int) -> bool:
    statuses = expected_statuses(seed, 0.5, READINGS, 1)
    later = statuses[statuses.index("unstable: 2 in a row") :]
    return ("failed: 1 in a row", "ok") in itertools.pairwise(later)


def _count_unstable(seed: int) -> int:
    """Return how often a node with this seed becomes unstable, with max_errors 1."""
    return expected_statuses(seed, 0.5, READINGS, 1).count("unstable: 2 in a row")
