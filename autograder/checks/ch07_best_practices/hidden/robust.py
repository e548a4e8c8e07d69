"""The robust node: what it says while its sensor fails, and after."""

from __future__ import annotations

import itertools
import random
import re
from typing import Any

from rclpy.qos import DurabilityPolicy
from std_msgs.msg import String

from autograder.checking import LOCKSTEP, Kind, StudentError, Workspace, expect, group, hint
from autograder.checking.probes import calls, late_joiner, namespaces, node_callbacks, parameters
from autograder.checks.ch07_best_practices.hidden.bugs import BUGS, with_bugs
from autograder.checks.ch07_best_practices.support.contract import (
    ERRORS,
    LOGGING,
    PACKAGE,
    QOS,
    RANDOM,
    ROBUST,
    RULE_STATUS,
)
from autograder.checks.ch07_best_practices.support.robot import STATUS, Robust, expected, logged

check = group("robust")
DEFAULTS: dict[str, parameters.Value] = {"failure_probability": 0.1, "seed": 0, "max_errors": 10}
READINGS = 20
BY_TURNS = 10  # readings, of which each second one fails
LIMITS = {"failure_probability": (0.0, 1.0), "seed": (0, 2**31 - 1), "max_errors": (1, 1000)}


@check(points=1, covers=("once-a-second", "ok"))
@hint("create_timer(PERIOD, self.timer_callback) in __init__.", "Publish once in each call of timer_callback.")
def test_once_a_second(workspace: Workspace) -> None:
    """robust_node publishes its state on status once a second; with a sensor that never fails, ok."""
    with Robust(workspace, failure_probability=0.0) as harness:
        said = harness.live(10)
        rate = harness.rate(STATUS, 0.0)
    expect(len(said) == 10, f"In 10 s it published its state {len(said)} times.")
    expect(abs(rate - 1.0) < 0.1, f"It published its state {rate:.1f} times a second, instead of once.")
    expect(set(said) == {"ok"}, f"With a sensor that never fails it said {sorted(set(said))} instead of ok.")


@check(points=2, covers=("once-a-second", "robust-relative"), after=("once_a_second",), doc=QOS)
@hint("QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) for the publisher.", "STATUS_QOS, not 10.")
@hint("'status' is relative, '/status' is not.")
def test_late_joiners(workspace: Workspace) -> None:
    """A node that joins late can have the last status immediately, in any namespace: it is offered transient local."""
    with Robust(workspace) as harness:
        harness.receive(3)
        offered = harness.node.get_publishers_info_by_topic(STATUS)
        # In real time it publishes while one joins.
        kept = late_joiner.kept_messages(harness.node, STATUS, String) if harness.time == LOCKSTEP else 1
    durable = [peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in offered]
    expect(bool(durable) and all(durable), "status is offered volatile: a display that joins late shows nothing.")
    expect(kept == 1, f"A display that joins late got {kept} messages, not the last one alone.", fraction=0.5)
    left = namespaces.missing_in_namespace(workspace, PACKAGE, "robust_node", ("status",))
    expect(not left, left, fraction=0.5)


@check(points=3, covers=("failed", "ok", "generator", "read-sensor"), after=("once_a_second",))
@hint(RULE_STATUS, "A success sets the count back to 0.")
def test_counts(workspace: Workspace, draw: random.Random) -> None:
    """It counts failures in a row, and starts again after a success."""
    # Tenths, so that a range in steps costs nothing here: `declared` asks for the step.
    seed, probability = draw.randint(1, 2**31 - 1), draw.choice((0.4, 0.6, 0.7))
    with Robust(workspace, seed=seed, failure_probability=probability) as harness:
        said = harness.receive(40)
    wanted = expected(seed, probability, 40)
    wrong = next((i for i, (a, b) in enumerate(zip(said, wanted, strict=False)) if a != b), min(len(said), 40))
    got = said[wrong] if wrong < len(said) else "nothing"
    sentence = f"With seed {seed} and failure_probability {probability}, reading {wrong + 1} made it say {got!r}"
    expect(said == wanted, f"{sentence} instead of {wanted[min(wrong, 39)]!r}.", fraction=0.0)
    never, always = 0.0, 1.0
    steps = (
        calls.call("read_sensor", calls.made(0), never),
        calls.call("read_sensor", calls.made(0), always),
        calls.call("random", on=0),
    )
    succeeded, failed, third = calls.calls(workspace, ROBUST, calls.call("Random", seed, module="random"), *steps)[1:]
    right = succeeded.value == "Success" and "SensorError" in failed.kinds
    ended = f"returned {succeeded.value!r} and raised {failed.raised or 'nothing'}"
    said_of = f"With the probabilities 0 and 1, read_sensor {ended}"
    expect(right, f"{said_of}, instead of 'Success' and SensorError.", fraction=0.5)
    returns: dict[str, Any] = {"random.return_value": probability}
    generator = calls.call("Mock", module="unittest.mock", **returns)
    _, equal = calls.calls(workspace, ROBUST, generator, calls.call("read_sensor", calls.made(0), probability))
    said_of = f"When the generator says {probability}, and the probability is that, read_sensor raised {equal.raised}"
    expect(equal.value == "Success", f"{said_of}: only a number below it is a failure.", fraction=0.5)
    twice_asked = random.Random(seed)
    wanted_third = [twice_asked.random() for _ in range(3)][2]
    asked = third.value == wanted_third
    expect(asked, "In two readings with the probabilities 0 and 1, it did not ask the generator twice.", fraction=0.5)
    _expect_own_count(workspace)


def _expect_own_count(workspace: Workspace) -> None:
    """Fail the check if of two nodes in one process one counts the other's failures."""
    always = ["--ros-args", *parameters.override_arguments({"failure_probability": 1.0})]
    node, turns = calls.call("RobustNode", cli_args=always), [(number, "timer_callback", None) for number in (0, 0, 1)]
    texts = node_callbacks.published(workspace, ROBUST, [node, node], turns)
    said = [re.findall(r"data='([^']+)'", text) for text in texts]
    if not all(len(status) == 1 for status in said):
        return  # another check asks what a callback publishes
    other = said[2][0]
    count = re.search(r"\d+", other)
    # A node that ignores its arguments does not always fail. `bugs_are_seen` asks for the arguments.
    sentence = "Of two robust nodes in one process, one failed twice, then the other one for the first time, and said"
    expect(count is None or int(count[0]) == 1, f"{sentence} {other!r}: each counts its own failures.", fraction=0.5)


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
    *_, shared = calls.calls(
        workspace,
        ROBUST,
        calls.call("init", module="rclpy"),
        calls.call("seed", seed, module="random"),
        calls.call("RobustNode"),
        calls.call("RobustNode", cli_args=["--ros-args", *parameters.override_arguments({"seed": seed + 1})]),
        calls.call("random", module="random"),
        network=True,
    )
    own = shared.value == random.Random(seed).random()
    said = "When a RobustNode was made, the generator of the module random changed, which all share"
    expect(own, f"{said}: the node's is a random.Random of its own.", fraction=0.5)


@check(points=2, covers=("unstable", "max-errors"), after=("once_a_second",))
@hint(RULE_STATUS, "More than max_errors, not as many as.")
def test_unstable(workspace: Workspace, draw: random.Random) -> None:
    """More than max_errors failures in a row are called unstable, and one fewer is not."""
    most = draw.randint(2, 5)
    with Robust(workspace, failure_probability=1.0, max_errors=most) as harness:
        said = harness.receive(most + 3)
    wanted = expected(1, 1.1, most + 3, most)
    expect(said == wanted, f"With max_errors {most} and a dead sensor it said {said}, instead of {wanted}.")
    seed = _shaky(draw)
    with Robust(workspace, seed=seed, failure_probability=0.5, max_errors=1) as harness:
        said = harness.receive(READINGS)
    wanted = expected(seed, 0.5, READINGS, 1)
    wrong = next((i for i, (a, b) in enumerate(zip(said, wanted, strict=False)) if a != b), None)
    shown = f"reading {(wrong or 0) + 1} made it say {said[wrong or 0] if said else 'nothing'!r}"
    expect(said == wanted, f"With max_errors 1, {shown} instead of {wanted[wrong or 0]!r}.", fraction=0.5)


@check(points=1, covers="error-log", after=("once_a_second",), doc=LOGGING)
@hint("error(..., throttle_duration_sec=5.0).", "A dead sensor fails every second; one line in five is enough.")
def test_errors_throttled(workspace: Workspace, draw: random.Random) -> None:
    """It logs failures as errors, at most one line in 5 s."""
    with Robust(workspace, failure_probability=1.0, max_errors=2) as harness:
        harness.receive(4)
        early, at_first = logged(harness.output, "ERROR"), harness.seconds
        harness.receive(26)
        errors, seconds = logged(harness.output, "ERROR"), harness.seconds
    failed = f"Its sensor failed for {seconds:.0f} s, unstable from the third failure on"
    expect(errors > 0, f"{failed}, and it said nothing at level ERROR.")
    expect(errors > 1, f"{failed}, and it logged only one error.", fraction=0.5)
    expect(errors <= seconds / 5 + 1, f"{failed}, and it logged {errors} errors.", fraction=0.5)
    said = f"Its sensor failed four times in {at_first:.0f} s, the third time too often, and it logged {early} errors."
    expect(1 <= early <= at_first / 5 + 1, said, fraction=0.5)
    rows = BY_TURNS // 2
    seeds = itertools.count(draw.randint(1, 2**30))
    seed = next(seed for seed in seeds if expected(seed, 0.5, BY_TURNS).count("failed: 1 in a row") == rows)
    with Robust(workspace, seed=seed, failure_probability=0.5) as harness:
        harness.receive(BY_TURNS)
        errors, seconds = logged(harness.output, "ERROR"), harness.seconds
    said = f"Its sensor failed and recovered by turns for {seconds:.0f} s, and it logged {errors} errors."
    expect(errors <= seconds / 5 + 1, said, fraction=0.5)


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
    seed = _shaky(draw)
    times = _rows(seed)
    with Robust(workspace, seed=seed, failure_probability=0.5, max_errors=1) as harness:
        harness.receive(READINGS)
        fatal = logged(harness.output, "FATAL")
    expect(fatal == times, f"It became unstable {times} times, and logged {fatal} fatal messages.", fraction=0.5)


@check(points=1, covers="recovery-log", after=("counts",))
@hint("Log before the count is set back to 0.", "Only if there were errors: if self.error_count:")
def test_recovery_logged(workspace: Workspace, draw: random.Random) -> None:
    """Each recovery is logged with the number of errors before it."""
    seed = _shaky(draw)
    with Robust(workspace, seed=seed, failure_probability=0.5, max_errors=1) as harness:
        harness.receive(30)
        output = harness.output
    said = ["ok", *expected(seed, 0.5, 30, 1)]
    counts = [int(a.split()[1]) for a, b in itertools.pairwise(said) if b == "ok" and a != "ok"]
    lines = [line for line in output.splitlines() if "Recovered after " in line]
    found = [line.split("Recovered after ")[1] for line in lines]
    wanted = [f"{count} errors" for count in counts]
    fraction = 0.5 if found == ["1 errors"] * counts.count(1) else 0.0  # silent only where it was unstable
    sentence = f"With max_errors 1, it recovered after {counts} errors, and logged {found or 'nothing of it'}."
    expect(found == wanted, sentence, fraction=fraction)
    infos = logged("\n".join(lines), "INFO")
    expect(infos == len(lines), f"It logged {infos} of {len(lines)} recoveries at level INFO.", fraction=0.5)


@check(points=2, covers=("catch", "handed-on", "generator"), after=("once_a_second",), doc=ERRORS)
@hint("except SensorError, not except Exception.", "Only what you expect; a bug has to be seen.")
def test_bugs_are_seen(workspace: Workspace) -> None:
    """It catches SensorError and nothing else: a bug ends the node with a traceback."""
    results, seeded = with_bugs(workspace)
    for bug, (built, called, namespace) in results.items():
        fraction = 0.75 if bug in ("OSError", "ValueError") else 0.0
        expect(not built.raised, f"RobustNode(generator=...) raised {built.raised}: {built.message}")
        expect(bool(called.raised), f"A bug in timer_callback raised {bug}, and it was swallowed.", fraction=fraction)
        said = f"A bug in timer_callback raised {called.raised} instead of the {bug} itself."
        expect(called.raised == bug, said, fraction=fraction)
        said = f"RobustNode(namespace='hall') is in {namespace.value}: its kwargs are for Node."
        expect(namespace.value == "/hall", said, fraction=0.5)
    said = "With the parameter seed 5, a RobustNode did not ask the generator that was handed in."
    expect(seeded.raised == BUGS[-1], said, fraction=0.75)


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
        described = node.descriptors(*DEFAULTS)
    expect(not wrong, f"Without any file or argument, {', '.join(wrong)}.")
    ranges = {name: [*each.floating_point_range, *each.integer_range] for name, each in described.items()}
    for name, limits in LIMITS.items():
        found = [(each.from_value, each.to_value) for each in ranges[name]]
        expect(found == [limits], f"{name} is declared with {found or 'no range'}, and should have {limits}.")
    for name, default in DEFAULTS.items():
        step, finest = ranges[name][0].step, 1 if isinstance(default, int) else 0
        said = f"The range of {name} has steps of {step:g}, and should take every value from end to end."
        expect(step <= finest, said, fraction=0.5)


@check(points=1, covers=("failure-probability", "max-errors"), after=("once_a_second",))
@hint("FloatingPointRange(from_value=0.0, to_value=1.0) in the descriptor.", "IntegerRange for max_errors.")
def test_ranges(workspace: Workspace) -> None:
    """It refuses to start with a probability above 1, or with max_errors below 1."""
    with Robust(workspace, failure_probability=1.0, max_errors=1):
        pass  # with the limits themselves it starts
    for name, impossible in (("failure_probability", 1.5), ("max_errors", 0)):
        try:
            with Robust(workspace, **{name: impossible}):
                started = True
        except StudentError as error:
            if error.diagnosis.kind is not Kind.CRASHED_AT_START:
                raise
            started = False
        expect(not started, f"It started with {name} {impossible}.")


def _shaky(draw: random.Random) -> int:
    """Return a seed with which a node becomes unstable more than once, and fails once for itself after that."""
    return next(seed for seed in itertools.count(draw.randint(1, 2**30)) if _rows(seed) >= 2 and _fails_alone(seed))


def _fails_alone(seed: int) -> bool:
    words = expected(seed, 0.5, READINGS, 1)
    return ["failed: 1 in a row", "ok"] in map(list, itertools.pairwise(words[words.index("unstable: 2 in a row") :]))


def _rows(seed: int) -> int:
    """Return how often a node with this seed becomes unstable by its second error in a row."""
    return expected(seed, 0.5, READINGS, 1).count("unstable: 2 in a row")
