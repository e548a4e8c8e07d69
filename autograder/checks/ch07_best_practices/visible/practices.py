"""Checks of the student's utilities and nodes with a few readings."""

from __future__ import annotations

from math import inf, isnan, nan

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from autograder.checking import Workspace, check, expect, hint
from autograder.checking.probes import calls, parameters
from autograder.checks.ch07_best_practices.support import contract
from autograder.checks.ch07_best_practices.support.robot import (
    STATUS,
    Processor,
    Robust,
    count_logged,
    expected_statuses,
    scan,
)

BLIND_SECONDS = 6  # s during which no scan has a distance


@check(points=1, covers=("mask", "places", "phantoms"), group="utils", doc=contract.REP_117)
@hint(contract.RULE_PLACE, contract.RULE_MASK)
def test_mask_invalid(workspace: Workspace) -> None:
    """mask_invalid replaces each reading that is not a measurement with nan, and keeps every reading's place."""
    readings = [1.0, 0.0, inf, nan, 9.0, -inf, 0.12, 3.5]
    (outcome,) = calls.run_steps(workspace, contract.UTILS, calls.call("mask_invalid", readings, 0.12, 3.5))
    call_text = "mask_invalid([1.0, 0.0, inf, nan, 9.0, -inf, 0.12, 3.5], 0.12, 3.5)"
    masked = calls.value(outcome, call_text)
    expect(calls.same(masked, [1.0, nan, inf, nan, nan, -inf, 0.12, 3.5]), f"{call_text} returned {masked}.")
    expect(calls.same(list(outcome.arguments[:1]), [readings]), f"{call_text} changed the list that it was given.")
    expect(not outcome.printed, f"{call_text} printed {outcome.printed[:80]!r}.")


@check(points=1, covers="mean", group="utils")
@hint(contract.RULE_MEAN, "Without a finite reading there is no mean: return None, not 0.0.")
def test_mean_distance(workspace: Workspace) -> None:
    """mean_distance returns the mean of the finite readings, or None if there are none."""
    with_finite, without_finite = calls.run_steps(
        workspace, contract.UTILS, calls.call("mean_distance", [1.0, nan, 2.0, inf]), calls.call("mean_distance", [nan])
    )
    mean = calls.value(with_finite, "mean_distance([1.0, nan, 2.0, inf])")
    expect(calls.same(mean, 1.5), f"mean_distance([1.0, nan, 2.0, inf]) returned {mean} instead of 1.5.")
    no_mean = calls.value(without_finite, "mean_distance([nan])")
    expect(no_mean is None, f"mean_distance([nan]) returned {no_mean} instead of None.")


@check(
    points=1,
    covers=("history", "average", "leave-lists"),
    group="utils",
    after=("mask_invalid", "mean_distance"),
    doc=contract.DEQUE,
)
@hint("deque(maxlen=history) forgets the oldest by itself.", "average() is the mean of the remembered means.")
def test_data_processor(workspace: Workspace) -> None:
    """DataProcessor remembers at most `history` means, those of the newest scans that have a finite distance."""
    steps = [
        calls.call("DataProcessor", 2),
        *(calls.call("process", [distance, 0.0], 0.1, 9.0, on=0) for distance in (1.0, 2.0, 3.0, nan)),
    ]
    _, first, *_, outcome = calls.run_steps(workspace, contract.UTILS, *steps, calls.call("average", on=0))
    average = calls.value(outcome, "average()")
    situation = "After scans of 1, 2, 3 and nan m, DataProcessor(2).average()"
    expect(calls.same(average, 2.5), f"{situation} is {average} instead of 2.5.")
    expect(calls.same(list(first.arguments[:1]), [[1.0, 0.0]]), "process changed the list that it was given.")


@check(points=1, covers="scan-filtered", group="processor", after=("mask_invalid", "data_processor"), doc=contract.QOS)
@hint("msg.ranges = self.processor.process(msg.ranges, msg.range_min, msg.range_max), then publish msg.")
@hint("Both ends of scan and scan_filtered use qos_profile_sensor_data.")
def test_filters_scans(processor: Processor) -> None:
    """sensor_processor publishes each scan masked by its own limits, with everything else unchanged."""
    sent_scan = scan([8.0, 0.0, 2.0], range_min=0.5, range_max=8.0)
    sent_scan.intensities = [4.0, 0.0, 2.0]
    filtered, _ = processor.send_scans(sent_scan)
    expect(len(filtered) == 1, f"One scan was sent, and {len(filtered)} published on scan_filtered.")
    ranges = list(filtered[0].ranges)
    is_correct = len(ranges) == 3 and isnan(ranges[1]) and ranges[::2] == [8.0, 2.0]
    message = f"With the limits 0.5 and 8.0, [8.0, 0.0, 2.0] was published as {ranges} instead of [8.0, nan, 2.0]."
    expect(is_correct, message)
    intensities = list(filtered[0].intensities)
    expect(intensities == [4.0, 0.0, 2.0], f"intensities were [4.0, 0.0, 2.0], and were published as {intensities}.")


@check(points=1, covers=("scan", "scan-filtered"), group="processor", after=("filters_scans",), doc=contract.QOS)
@hint("qos_profile_sensor_data for scan and for scan_filtered, 10 for mean_distance; no name begins with a slash.")
def test_sensor_profile(processor: Processor) -> None:
    """sensor_processor subscribes to scan and publishes scan_filtered best effort, as a lidar does."""
    endpoints = {
        "scan": processor.node.get_subscriptions_info_by_topic("/scan"),
        "scan_filtered": processor.node.get_publishers_info_by_topic("/scan_filtered"),
    }
    for topic, infos in endpoints.items():
        expect(bool(infos), f"The node does not use the topic {topic}.")
        is_reliable = any(endpoint.qos_profile.reliability == ReliabilityPolicy.RELIABLE for endpoint in infos)
        expect(not is_reliable, f"{topic} is reliable instead of best effort.")


@check(points=1, covers=("mean-of-ten", "blind", "warns"), group="processor", after=("data_processor", "filters_scans"))
@hint("Create one DataProcessor(HISTORY) in __init__. After each scan, publish its average().")
@hint("mean_distance(masked) is None: warn, with throttle_duration_sec, and publish no mean.")
def test_means(fresh_processor: Processor) -> None:
    """mean_distance averages over the newest ten scans. A scan without a distance gets a warning and no mean."""
    _, means = fresh_processor.send_scans(*(scan([distance]) for distance in (2.0, *[1.0] * 10)))
    expect(len(means) == 11, f"11 scans were sent, and {len(means)} means published.")
    newest = [round(means[i], 3) for i in (0, 1, -1)]
    expect(newest == [2.0, 1.5, 1.0], f"After 1, 2 and 11 scans, the means were {newest} instead of [2.0, 1.5, 1.0].")
    _, means = fresh_processor.send_scans(*(scan([nan]) for _ in range(BLIND_SECONDS * 10)))
    expect(not means, f"For scans without a distance, it published {len(means)} means.")
    warnings = count_logged(fresh_processor.output, "WARN")
    message = (
        f"For {BLIND_SECONDS} s, no scan had a distance, and it logged {warnings} warnings instead of one a second."
    )
    expect(int(BLIND_SECONDS / contract.MAX_SILENCE) <= warnings <= BLIND_SECONDS + 2, message)


@check(points=1, covers=("failed", "once-a-second"), group="robust", doc=contract.ERRORS)
@hint(contract.RULE_STATUS, "Call read_sensor(self.generator, self.failure_probability) once a period.")
@hint("read_sensor uses the generator that it is given: generator.random(). random.random() uses another one.")
def test_counts_failures(workspace: Workspace) -> None:
    """robust_node publishes a status once a second, and counts failures in a row."""
    with Robust(workspace, seed=7, failure_probability=0.5) as harness:
        statuses = harness.receive(8)
    correct = expected_statuses(7, 0.5, 8)
    expect(statuses == correct, f"With seed 7, it published {statuses} instead of {correct}.")


@check(
    points=1,
    covers=("failure-probability", "seed", "max-errors"),
    group="robust",
    after=("counts_failures",),
    doc=contract.QOS,
)
@hint("create_publisher(String, 'status', STATUS_QOS), not 10.")
@hint("floating_point_range=[limits] in the descriptor; _declare_integer for the two whole numbers.")
def test_declares(workspace: Workspace) -> None:
    """robust_node publishes status transient local, and its three parameters have ranges."""
    with Robust(workspace) as harness:
        publishers = harness.node.get_publishers_info_by_topic(STATUS)
        descriptors = parameters.NodeParameters(harness, "/robust_node").descriptors(
            "failure_probability", "seed", "max_errors"
        )
    are_durable = [publisher.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for publisher in publishers]
    expect(
        bool(are_durable) and all(are_durable),
        "status is not transient local: a node that joins late would receive nothing.",
    )
    expect(len(descriptors) == 3, f"Of its three parameters, it declares {', '.join(descriptors) or 'none'}.")
    without_range = [
        name
        for name, descriptor in descriptors.items()
        if not [*descriptor.floating_point_range, *descriptor.integer_range]
    ]
    expect(not without_range, f"There is no range for {', '.join(without_range)}.")


@check(
    points=1,
    covers=("unstable", "fatal-log", "error-log"),
    group="robust",
    after=("counts_failures",),
    doc=contract.LOGGING,
)
@hint("The status is unstable if the count is above max_errors. Log fatal if it is exactly max_errors + 1.")
@hint("error(..., throttle_duration_sec=5.0)")
def test_dead_sensor(workspace: Workspace) -> None:
    """With max_errors 6, a dead sensor makes robust_node unstable at failure 7: one fatal log, and throttled errors."""
    with Robust(workspace, failure_probability=1.0, max_errors=6) as harness:
        statuses = harness.receive(12)
        fatals, errors = count_logged(harness.output, "FATAL"), count_logged(harness.output, "ERROR")
    correct = [f"{'failed' if n <= 6 else 'unstable'}: {n} in a row" for n in range(1, 13)]
    expect(statuses == correct, f"It published {statuses} instead of {correct}.")
    expect(fatals == 1, f"It logged {fatals} fatal messages instead of one.")
    expect(0 < errors <= 4, f"In 12 s, it logged {errors} errors instead of one in 5 s.")


@check(points=1, covers="recovery-log", group="robust", after=("counts_failures",), doc=contract.LOGGING)
@hint("Log 'Recovered after N errors' before you set the count back to 0.")
def test_recovers(workspace: Workspace) -> None:
    """robust_node logs each recovery, with the number of errors before it."""
    with Robust(workspace, seed=7, failure_probability=0.5) as harness:
        harness.receive(5)
        lines = [line for line in harness.output.splitlines() if "Recovered after " in line]
    expect(len(lines) == 2, f"With seed 7, it logged {len(lines)} recoveries in 5 s instead of 2.")
    expect(
        lines[0].endswith("Recovered after 2 errors"), f"The first recovery, after 2 errors, was logged as: {lines[0]}"
    )


@check(points=1, covers=("catch", "generator"), group="robust", after=("counts_failures",), doc=contract.ERRORS)
@hint("Catch SensorError and nothing wider. Use the generator that is passed in.")
def test_shows_bugs(workspace: Workspace) -> None:
    """robust_node does not catch a bug: with range(3) as its generator, timer_callback raises AttributeError."""
    *_, result = calls.run_steps(
        workspace,
        contract.ROBUST,
        calls.call("init", module="rclpy"),
        calls.call("range", 3, module="builtins"),
        calls.call("RobustNode", generator=calls.result_of(1)),
        calls.call("timer_callback", on=2),
        network=True,
    )
    expect("AttributeError" in result.kinds, f"It raised {result.raised or 'nothing'} instead of AttributeError.")
