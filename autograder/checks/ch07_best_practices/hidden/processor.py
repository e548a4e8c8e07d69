"""Checks of the sensor processor: its topics, its filtered scans, its means and its warnings."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence
from dataclasses import replace
from math import inf, isclose, isnan, nan
from operator import attrgetter

from hypothesis import strategies as st
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan

from autograder.checking import LOCKSTEP, SCAN_SECONDS, Workspace, expect, group, hint
from autograder.checking.probes import calls, namespaces, node_callbacks, qos
from autograder.checks.ch07_best_practices.support.contract import (
    HISTORY,
    LOGGING,
    PACKAGE,
    PROCESSOR,
    QOS,
    UTILS,
)
from autograder.checks.ch07_best_practices.support.drawn_readings import (
    BLIND_SCANS,
    GOOD_SCANS,
    PLAIN_PHANTOMS,
    Readings,
    Series,
    averages,
    draw_cases,
    expect_all,
    mean_of,
    other_lidars,
    scans_of,
)
from autograder.checks.ch07_best_practices.support.robot import Processor, messages, scan, scan_of
from autograder.checks.ch07_best_practices.support.warning_record import WarningRecord

check = group("processor")
FAST_SECONDS = 0.04  # s between two scans of a fast lidar
GAPS = (0.05, 0.1, 0.2, 0.3, 0.5)  # s between two scans: of fast lidars and of slow ones
STRETCH_SECONDS = 3.0  # s with scans that have no distance for the same reason


@check(points=1, covers=("scan", "scan-filtered", "mean-topic", "processor-name"))
@hint("setup.py must name sensor_processor = my_robot_package.nodes.sensor_processor:main.")
@hint("create_publisher twice and create_subscription once, in __init__; the names are relative.")
def test_endpoints(processor: Processor) -> None:
    """sensor_processor subscribes to scan, and publishes scan_filtered and mean_distance."""
    names = processor.nodes()
    expect("/sensor_processor" in names, f"The node is called {', '.join(names)} instead of /sensor_processor.")
    expect(processor.takes("/scan"), "It does not subscribe to scan as sensor_msgs/msg/LaserScan.")
    for topic, type_name in (
        ("/scan_filtered", "sensor_msgs/msg/LaserScan"),
        ("/mean_distance", "std_msgs/msg/Float32"),
    ):
        types = {peer.topic_type for peer in processor.node.get_publishers_info_by_topic(topic)}
        message = f"{topic} should have the type {type_name}. Published types: {', '.join(types) or 'none'}."
        expect(types == {type_name}, message)


@check(points=1, covers=("scan", "scan-filtered", "mean-topic"), after=("endpoints",), doc=QOS)
@hint("Use qos_profile_sensor_data instead of 10, for scan and for scan_filtered.", "A lidar publishes best-effort.")
def test_sensor_qos(processor: Processor) -> None:
    """sensor_processor receives and publishes scans best effort, as a lidar does. The mean has the default QoS."""
    subscriptions = processor.node.get_subscriptions_info_by_topic("/scan")
    expect(bool(subscriptions), "It does not subscribe to scan.")
    is_reliable = any(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in subscriptions)
    expect(not is_reliable, "Its subscription to scan requests reliable delivery, which a lidar does not offer.")
    publishers = processor.node.get_publishers_info_by_topic("/scan_filtered")
    expect(bool(publishers), "It does not publish scan_filtered.")
    is_reliable = any(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in publishers)
    expect(not is_reliable, "scan_filtered is reliable, so a slow subscriber would delay the node.", fraction=0.5)
    is_durable = any(
        peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in (*subscriptions, *publishers)
    )
    expect(
        not is_durable, "scan or scan_filtered is transient local. qos_profile_sensor_data is volatile.", fraction=0.5
    )
    difference = qos.non_default_qos(processor.node, "/mean_distance")
    expect(not difference, difference, fraction=0.75)


@check(points=1, covers="relative", after=("endpoints",))
@hint("A name that begins with a slash is the same in every namespace: two robots would share it.")
@hint("'scan' is relative, '/scan' is not.")
def test_relative(workspace: Workspace) -> None:
    """The topic names of sensor_processor are relative: in the namespace /a, scan is /a/scan."""
    message = namespaces.missing_in_namespace(
        workspace, PACKAGE, "sensor_processor", ("scan", "scan_filtered", "mean_distance")
    )
    expect(not message, message)


@check(points=2, covers=("scan-filtered", "other-fields"), after=("endpoints",))
@hint("msg.ranges = self.processor.process(...).", "Pass the message's own range_min and range_max.")
def test_filtered(workspace: Workspace, processor: Processor, draw: random.Random) -> None:
    """sensor_processor publishes each scan with its phantoms masked, by the lidar's own limits."""
    far = round(draw.uniform(11.0, 15.0), 1)
    plain_case = Readings((1.0, 0.0, inf, nan, far, -inf, far + 5.0), 0.05, far + 1.0)
    other_cases = draw_cases(
        (other_lidars(at_limits=False) | other_lidars(at_limits=True)).map(_with_infinities), draw, 20
    )
    _expect_masked(workspace, processor, [plain_case], fraction=0.0)
    _expect_masked(workspace, processor, other_cases, fraction=0.5)


@check(points=1, covers=("all-else", "other-fields"), after=("filtered",))
@hint("Publish the received message, with other ranges.", "A new LaserScan() has no header and no angles.")
def test_rest_untouched(processor: Processor, draw: random.Random) -> None:
    """sensor_processor leaves header, angles, times, limits and intensities unchanged."""
    with_phantoms = scan([0.05, 1.0, nan, 9.0])
    with_phantoms.intensities = [10.0, 20.0, 30.0, 40.0]
    sent_scans = [*draw_cases(messages(), draw, 25), with_phantoms]
    filtered, _ = processor.send_scans(*sent_scans)
    expect(len(filtered) == len(sent_scans), f"{len(sent_scans)} scans were sent, and {len(filtered)} published.")

    def judge(pair: tuple[LaserScan, LaserScan]) -> None:
        before, after = pair
        other_fields = [name for name in before.get_fields_and_field_types() if name not in ("header", "ranges")]
        for field in ("header.frame_id", "header.stamp", *other_fields):
            actual, expected = attrgetter(field)(after), attrgetter(field)(before)
            is_equal = _close(actual, expected) if isinstance(expected, float) else actual == expected
            fraction = 0.5 if field == "intensities" else 0.0
            expect(is_equal, f"{field} was {expected!r}, and was published as {actual!r}.", fraction=fraction)

    expect_all(zip(sent_scans, filtered, strict=True), judge)


@check(points=2, covers=("mean-of-ten", "mean-topic"), after=("filtered",))
@hint("Create DataProcessor(10) once, in __init__. Publish average() after each scan.", "Float32(data=...)")
def test_mean_of_ten(workspace: Workspace, fresh_processor: Processor, draw: random.Random) -> None:
    """mean_distance is the average of the means of the newest ten scans."""
    good_scans = draw_cases(GOOD_SCANS, draw, 14)
    # Blind scans have no mean, and do not count among the ten. Another check tests scans without beams.
    blind_scans = BLIND_SCANS.filter(lambda case: bool(case.readings) and 0.0 not in case.readings)
    scans = [*good_scans[:1], *draw_cases(GOOD_SCANS | blind_scans, draw, 20), *good_scans[1:], Readings((0.0,))]
    scans = [replace(case, low=0.0) for case in scans]
    _, actual = fresh_processor.send_scans(*map(scan_of, scans))
    if not _all_close(actual, _student_averages(workspace, scans)):
        pairs = zip(scans, averages(Series(tuple(scans), HISTORY)), strict=True)
        expected = [average for case, average in pairs if average is not None and mean_of(case.masked) is not None]
        message = "A reading of 0 m led to no mean, although range_min was 0 m. With this range_min, it is a distance."
        expect(not _all_close(actual, expected[:-1]), message, fraction=0.5)
        lengths = f"{len(expected)} scans with a distance were sent, and {len(actual)} means published."
        expect(len(actual) == len(expected), lengths)
        wrong = next((i for i in range(len(actual)) if not _close(actual[i], expected[i])), 0)
        message = (
            f"At scan {wrong + 1} with a distance, the mean was {actual[wrong]:.3f} m, not {expected[wrong]:.3f} m."
        )
        expect(_close(actual[wrong], expected[wrong]), message)
    _expect_separate_histories(workspace)


@check(points=1, covers="blind", after=("filtered",))
@hint("mean_distance(msg.ranges) is None: warn instead of publishing.", "Float32 cannot hold None.")
def test_blind_scan(workspace: Workspace, processor: Processor, draw: random.Random) -> None:
    """sensor_processor publishes a scan without a distance masked, and no mean for it."""
    processor.send_scans(scan([1.0]))  # so that a mean is known
    plain_case = Readings((nan, 0.0, inf))
    # None of these is a distance for any usual lidar. Another check tests whether the limits are the lidar's own.
    cases = [plain_case, *draw_cases(scans_of(st.sampled_from((*PLAIN_PHANTOMS, inf, -inf)), min_size=1), draw, 10)]
    for case in cases:
        _, means = processor.send_scans(scan_of(case))
        expect(
            not means, f"For a scan of {list(case.readings)}, without any distance, it published the means {means} m."
        )
    _expect_masked(workspace, processor, cases, fraction=0.75)


@check(points=2, covers=("warns", "other-fields"), after=("blind_scan",), doc=LOGGING)
@hint("self.get_logger().warning(..., throttle_duration_sec=1.0)", "Nobody reads ten lines a second.")
def test_warns_now_and_then(fresh_processor: Processor, draw: random.Random) -> None:
    """sensor_processor warns once a second while no scan has a distance, and does not warn otherwise."""
    record = WarningRecord(fresh_processor)
    record.send([Readings((0.05, 1.0, nan, inf, -inf, 9.0))], gap=SCAN_SECONDS, seconds=0.5)
    has_needless_warning = bool(record.warnings)
    blind_scans = [Readings(readings) for readings in ((nan, inf, -inf, 0.05), (), (inf, -inf), (nan, nan), (0.05,))]
    stretches = [*([case] for case in blind_scans), blind_scans, [Readings((1.0,)), *blind_scans[:1]]]
    gaps = *draw.sample(GAPS, len(blind_scans)), SCAN_SECONDS, SCAN_SECONDS
    for cases, gap in zip(stretches, gaps, strict=True):
        record.send(cases, gap=gap, seconds=STRETCH_SECONDS)
    blind_end = fresh_processor.seconds
    record.send([Readings((1.0,))], gap=SCAN_SECONDS, seconds=2.5)
    message = (
        f"For {len(blind_scans) * STRETCH_SECONDS:.0f} s no scan had a distance, and it logged nothing at level WARN."
    )
    expect(bool(record.warnings), message)
    expect(not has_needless_warning, "It warned about a scan that keeps a finite distance.", fraction=0.5)
    record.expect_none_after(blind_end)
    record.expect_throttled()
    record.expect_prompt()


@check(points=1, covers="any-length", after=("filtered",))
@hint("Loop over the readings that the scan has.", "Other lidars have other numbers of beams.")
def test_any_lidar(processor: Processor, draw: random.Random) -> None:
    """sensor_processor accepts scans with any number of beams, even none."""
    for beams in (0, 1, 7, 1080, *draw.sample(range(2, 4000), 6), 0):
        filtered, means = processor.send_scans(scan([1.0] * beams))
        lengths = [len(message.ranges) for message in filtered]
        expect(
            lengths == [beams], f"A scan of {beams} beams was sent. Beams of the published scans: {lengths or 'none'}."
        )
        expect(bool(beams) or not means, f"For a scan without beams, it published the means {means} m.", fraction=0.5)


def _expect_separate_histories(workspace: Workspace) -> None:
    """Fail the check if two processors in one process share their history."""
    node, scan_1, scan_3 = calls.call("SensorProcessor"), _scan_call(1.0), _scan_call(3.0)
    turns = [(0, "scan_callback", scan_1), (1, "scan_callback", scan_3), (0, "scan_callback", scan_1)]
    texts = node_callbacks.published(workspace, PROCESSOR, [node, node], turns)
    means_of_calls = [re.findall(r"Float32\(data=(-?\d{1,40}(?:\.\d{1,40})?)\)", text) for text in texts]
    if not all(len(means) == 1 for means in means_of_calls):
        return  # the node does not publish in its callback, which is allowed
    actual = [float(mean) for (mean,) in means_of_calls]
    sentence = "Two sensor processors in one process received scans of 1 m and of 3 m."
    is_correct = _all_close(actual, [1.0, 3.0, 1.0]) or _all_close(actual, _averages_of_two(workspace))
    expect(
        is_correct,
        f"{sentence} The second one published the mean {actual[1]:.3f} m: each needs its own history.",
        fraction=0.5,
    )


def _scan_call(distance: float) -> calls.Step:
    """Return the call that creates a scan with one beam."""
    return calls.call("LaserScan", module="sensor_msgs.msg", ranges=[distance], range_min=0.125, range_max=3.5)


def _averages_of_two(workspace: Workspace) -> list[float]:
    """Return the averages of two of the student's DataProcessors, for the scans of `_expect_separate_histories`.

    Other checks test whether these averages are correct.
    """
    plan = calls.Plan()
    processors = [plan.add(calls.call("DataProcessor", HISTORY)) for _ in range(2)]
    average_steps = []
    for number, distance in ((0, 1.0), (1, 3.0), (0, 1.0)):
        plan.add(calls.call("process", [distance], 0.125, 3.5, on=processors[number]))
        average_steps.append(plan.add(calls.call("average", on=processors[number])))
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)
    return [average for step in average_steps if isinstance(average := outcomes[step].value, float)]


def _expect_masked(workspace: Workspace, processor: Processor, cases: Sequence[Readings], *, fraction: float) -> None:
    """Fail the check unless all scans are published masked, correctly or as the student's mask_invalid masks them.

    Other checks test whether mask_invalid is correct.
    """
    # A fast lidar shows whether each scan is published, or only the newest one when a timer fires.
    apart = FAST_SECONDS if processor.time == LOCKSTEP else SCAN_SECONDS
    filtered, _ = processor.send_scans(*map(scan_of, cases), apart=apart)
    scans = "One scan was" if len(cases) == 1 else f"{len(cases)} scans were"
    expect(len(filtered) == len(cases), f"{scans} sent, and {len(filtered)} published.")
    steps = [calls.call("mask_invalid", list(case.readings), case.low, case.high) for case in cases]
    outcomes = calls.run_steps(workspace, UTILS, *steps)

    def judge(triple: tuple[Readings, LaserScan, calls.StepResult]) -> None:
        case, message, outcome = triple
        actual = list(message.ranges)
        is_correct = _all_close(actual, case.masked) or _all_close(actual, _floats(outcome.value))
        sentence = f"{list(case.readings)} ({case.low} to {case.high} m) became {[round(r, 4) for r in actual]}"
        expect(is_correct, f"{sentence} in scan_filtered instead of {case.masked}.", fraction=fraction)

    expect_all(zip(cases, filtered, outcomes, strict=True), judge)


def _with_infinities(case: Readings) -> Readings:
    """Return the same readings, followed by infinities, nan and a distance."""
    return replace(case, readings=(*case.readings, inf, nan, -inf, round((case.low + case.high) / 2, 3)))


def _student_averages(workspace: Workspace, cases: Sequence[Readings]) -> list[float]:
    """Return the student's averages after all scans for which the student's mean_distance returns a mean."""
    plan = calls.Plan()
    processor = plan.add(calls.call("DataProcessor", HISTORY))
    steps = []
    for case in cases:
        masked = plan.add(calls.call("process", list(case.readings), case.low, case.high, on=processor))
        mean = plan.add(calls.call("mean_distance", calls.result_of(masked)))
        steps.append((mean, plan.add(calls.call("average", on=processor))))
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)
    return _floats([outcomes[average].value for mean, average in steps if outcomes[mean].value is not None])


def _floats(values: object) -> list[float]:
    return [each for each in values if isinstance(each, float)] if isinstance(values, list) else []


def _all_close(actual: list[float], expected: list[float]) -> bool:
    return len(actual) == len(expected) and all(map(_close, actual, expected))


def _close(actual: float, expected: float) -> bool:
    """Return whether two numbers are equal within the precision of a 32-bit float."""
    return isnan(actual) if isnan(expected) else isclose(actual, expected, rel_tol=1e-6)
