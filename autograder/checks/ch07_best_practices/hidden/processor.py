"""The sensor processor: its topics, its filtered scans, its means and its warnings."""

from __future__ import annotations

import random
import re
from math import inf, isclose, isnan, nan
from statistics import fmean

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan

from autograder.checking import SCAN_SECONDS, Workspace, expect, group, hint
from autograder.checking.probes import calls, namespaces, node_callbacks, qos
from autograder.checks.ch07_best_practices.support.contract import (
    HISTORY,
    LOGGING,
    MAX_SILENCE,
    PACKAGE,
    PROCESSOR,
    QOS,
    TOLERANCE,
    UTILS,
)
from autograder.checks.ch07_best_practices.support.robot import Processor, logged, scan

check = group("processor")
SECONDS = 20.0
ALTERNATIONS = 15  # pairs of a blind and a good scan
SLOW_SCANS, SLOW_SECONDS = 9, 0.5  # scans of a slow lidar, and the time in s between them


@check(points=1, covers=("scan", "scan-filtered", "mean-topic", "processor-name"))
@hint("setup.py must name sensor_processor = my_robot_package.nodes.sensor_processor:main.")
@hint("create_publisher twice and create_subscription once, in __init__; the names are relative.")
def test_endpoints(processor: Processor) -> None:
    """sensor_processor takes scan and offers scan_filtered and mean_distance."""
    names = processor.nodes()
    expect("/sensor_processor" in names, f"The node is called {', '.join(names)}, it should be /sensor_processor.")
    expect(processor.takes("/scan"), "It does not subscribe to scan as sensor_msgs/msg/LaserScan.")
    for topic, kind in (("/scan_filtered", "sensor_msgs/msg/LaserScan"), ("/mean_distance", "std_msgs/msg/Float32")):
        types = {peer.topic_type for peer in processor.node.get_publishers_info_by_topic(topic)}
        expect(types == {kind}, f"{topic} is published as {', '.join(types) or 'nothing'} instead of {kind}.")


@check(points=1, covers=("scan", "scan-filtered", "mean-topic"), after=("endpoints",), doc=QOS)
@hint("qos_profile_sensor_data instead of 10, on both ends of the scans.", "A lidar publishes best-effort.")
def test_sensor_qos(processor: Processor) -> None:
    """It asks for scans as a lidar offers them, and offers its own likewise: best effort; not so the mean."""
    subscriptions = processor.node.get_subscriptions_info_by_topic("/scan")
    expect(bool(subscriptions), "It does not subscribe to scan.")
    reliable = any(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in subscriptions)
    expect(not reliable, "Its scan subscription asks for reliable delivery, which a lidar does not offer.")
    publishers = processor.node.get_publishers_info_by_topic("/scan_filtered")
    expect(bool(publishers), "It does not publish scan_filtered.")
    reliable = any(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in publishers)
    expect(not reliable, "scan_filtered is offered reliably: a slow listener would hold the node up.", fraction=0.5)
    durable = any(
        peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in (*subscriptions, *publishers)
    )
    expect(not durable, "scan or scan_filtered is transient local, and qos_profile_sensor_data is not.", fraction=0.5)
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
@hint("msg.ranges = self.processor.process(...).", "Hand on the message's own range_min and range_max.")
def test_filtered(workspace: Workspace, processor: Processor, draw: random.Random) -> None:
    """A scan comes out with its phantoms masked, by the lidar's own limits."""
    far = round(draw.uniform(11.0, 15.0), 1)
    sent, low, high = [1.0, 0.0, inf, nan, far, -inf, far + 5.0], 0.05, far + 1.0
    (filtered, _) = processor.send_scans(scan(sent, range_min=low, range_max=high))
    expect(len(filtered) == 1, f"One scan went in, {len(filtered)} came out.")
    actual, expected = list(filtered[0].ranges), [1.0, nan, inf, nan, far, -inf, nan]
    is_right = _all_close(actual, expected) or _all_close(actual, _student_masked(workspace, sent, low, high))
    expect(is_right, f"{sent} ({low} to {high} m) came out as {[round(r, 3) for r in actual]}.")


@check(points=1, covers=("all-else", "other-fields"), after=("filtered",))
@hint("Publish the message that came, with other ranges.", "A new LaserScan() has no header and no angles.")
def test_rest_untouched(workspace: Workspace, processor: Processor, draw: random.Random) -> None:
    """Header, angles, times, limits and intensities come out as they went in."""
    sent = scan([1.0, 0.06, 9.0])  # all within the limits of the scan in test_filtered
    sent.header.frame_id = f"/Laser_{draw.randint(1, 9)} "  # unusual, so that any change of it is detected
    sent.header.stamp.sec = draw.randint(1, 1000)
    sent.angle_min, sent.intensities = -1.5, [5.0, 6.0, 7.0]
    sent.time_increment = draw.uniform(0.01, 0.03)
    filtered, _ = processor.send_scans(sent)
    expect(len(filtered) == 1, f"One scan went in, {len(filtered)} came out.")
    for field in (name for name in sent.get_fields_and_field_types() if name != "ranges"):
        actual, expected = getattr(filtered[0], field), getattr(sent, field)
        is_equal = _close(actual, expected) if isinstance(expected, float) else actual == expected
        fraction = 0.5 if field == "intensities" else 0.0
        expect(is_equal, f"{field} went in as {expected} and came out as {actual}.", fraction=fraction)
    actual = list(filtered[0].ranges)
    message = (
        f"After a scan with other limits, [1.0, 0.06, 9.0] (0.12 to 3.5 m) came out as {[round(r, 3) for r in actual]}."
    )
    is_right = _all_close(actual, [1.0, nan, nan]) or _all_close(
        actual, _student_masked(workspace, [1.0, 0.06, 9.0], 0.12, 3.5)
    )
    expect(is_right, message, fraction=0.5)


@check(points=2, covers=("mean-of-ten", "mean-topic"), after=("filtered",))
@hint("DataProcessor(10), made once in __init__; publish average() after each scan.", "Float32(data=...)")
def test_mean_of_ten(workspace: Workspace, fresh_processor: Processor, draw: random.Random) -> None:
    """mean_distance is the average of the newest ten scans' means."""
    means = [round(draw.uniform(0.5, 3.0), 2) for _ in range(14)]
    blind = set(draw.sample(range(1, len(means)), 4))  # these have no mean, and do not count among the ten
    scans = [ranges for i, mean in enumerate(means) for ranges in ([nan], [mean, nan, mean])[i not in blind :]]
    _, averages = fresh_processor.send_scans(*map(scan, scans))
    if not _all_close(averages, _student_averages(workspace, scans)):
        expect(
            len(averages) == len(means), f"{len(means)} scans with a distance went in, {len(averages)} means came out."
        )
        expected = [fmean(means[max(0, i + 1 - HISTORY) : i + 1]) for i in range(len(means))]
        wrong = next((i for i in range(len(means)) if abs(averages[i] - expected[i]) > TOLERANCE), None)
        i = wrong or 0
        message = f"After {i + 1} scans with a distance it said {averages[i]:.3f} m instead of {expected[i]:.3f} m."
        expect(wrong is None, message)
    _expect_separate_histories(workspace)


@check(points=1, covers="blind", after=("filtered",))
@hint("mean_distance(msg.ranges) is None: warn instead of publishing.", "Float32 cannot hold None.")
def test_blind_scan(processor: Processor) -> None:
    """A scan without a distance comes out masked, and no mean with it."""
    filtered, means = processor.send_scans(scan([nan, 0.0, inf]))
    expect(len(filtered) == 1, f"One blind scan went in, {len(filtered)} came out.")
    expect(not means, f"A scan without any distance made it say {means} m.")


@check(points=2, covers=("warns", "other-fields"), after=("blind_scan",), doc=LOGGING)
@hint("self.get_logger().warning(..., throttle_duration_sec=1.0)", "Nobody reads ten lines a second.")
def test_warns_now_and_then(workspace: Workspace, fresh_processor: Processor) -> None:
    """While the lidar sees nothing, it warns once a second; while it sees something, it does not."""
    good, blind = scan([0.05, 1.0, nan, inf, -inf, 9.0]), scan([inf, nan, -inf, 0.05])
    scan_count = round(SECONDS * 10) // 2
    needless_count = _count_warnings(fresh_processor, [good] * 5)
    blind_count = _count_warnings(fresh_processor, [blind] * scan_count)
    empty_count = _count_warnings(fresh_processor, [scan([])] * scan_count)
    expect(blind_count + empty_count > 0, f"Blind for {SECONDS:.0f} s, it said nothing at level WARN.")
    too_many = f"Blind for {SECONDS:.0f} s, it warned {blind_count + empty_count} times."
    expect(blind_count + empty_count <= SECONDS + 2, too_many, fraction=0.5)
    expect(not needless_count, "It warned of a scan that keeps a finite distance.", fraction=0.5)
    expect(blind_count > 0, "Infinities are no finite distance, and it did not warn of a scan of them.", fraction=0.5)
    expect(empty_count > 0, "It did not warn of scans without any beam.", fraction=0.5)
    too_few = f"Blind for {SECONDS:.0f} s, it warned only {blind_count + empty_count} times."
    expect(min(blind_count, empty_count) >= int(SECONDS / 2 / MAX_SILENCE), too_few, fraction=0.5)
    seconds = 2 * ALTERNATIONS * SCAN_SECONDS
    alternating_count = _count_warnings(fresh_processor, [blind, good] * ALTERNATIONS)
    too_often = f"With blind and good scans by turns for {seconds:.0f} s, it warned {alternating_count} times."
    expect(alternating_count <= seconds + 2, too_often, fraction=0.5)
    causes = [scan([]), scan([inf, -inf]), scan([nan]), scan([0.05])]
    seconds, mixed_count = (
        len(causes) * ALTERNATIONS * SCAN_SECONDS,
        _count_warnings(fresh_processor, causes * ALTERNATIONS),
    )
    too_often = (
        "Scans without beams, of infinities, of nan and of phantoms by turns "
        f"for {seconds:.0f} s: {mixed_count} warnings."
    )
    expect(mixed_count <= seconds + 2, too_often, fraction=0.5)
    slow_count = _count_warnings(fresh_processor, [blind] * SLOW_SCANS, apart=SLOW_SECONDS)
    too_seldom = f"Blind for {SLOW_SCANS * SLOW_SECONDS} s, with two scans a second, it warned {slow_count} times."
    expect(slow_count >= 2, too_seldom, fraction=0.75)  # three are due, but real time needs tolerance
    filtered, _ = fresh_processor.send_scans(blind)
    actual = [list(message.ranges) for message in filtered]
    masked_ranges = [inf, nan, -inf, nan]
    is_masked = len(actual) == 1 and (
        _all_close(actual[0], masked_ranges)
        or _all_close(actual[0], _student_masked(workspace, [inf, nan, -inf, 0.05], 0.12, 3.5))
    )
    expect(is_masked, f"A blind scan of [inf, nan, -inf, 0.05] (0.12 to 3.5 m) came out as {actual}.", fraction=0.75)


@check(points=1, covers="any-length", after=("filtered",))
@hint("Loop over what is there.", "Other lidars have other numbers of beams.")
def test_any_lidar(processor: Processor) -> None:
    """It takes scans of any length, an empty one too."""
    for beams in (0, 1, 7, 1080):
        filtered, _ = processor.send_scans(scan([1.0] * beams))
        lengths = [len(message.ranges) for message in filtered]
        expect(lengths == [beams], f"A scan of {beams} beams came out as {lengths or 'nothing'}.")


def _expect_separate_histories(workspace: Workspace) -> None:
    """Fail the check if two processors in one process share their history."""
    node, first, second = calls.call("SensorProcessor"), _message(1.0), _message(3.0)
    turns = [(0, "scan_callback", first), (1, "scan_callback", second), (0, "scan_callback", first)]
    texts = node_callbacks.published(workspace, PROCESSOR, [node, node], turns)
    means_of_calls = [re.findall(r"Float32\(data=(-?\d{1,40}(?:\.\d{1,40})?)\)", text) for text in texts]
    if not all(len(means) == 1 for means in means_of_calls):
        return  # it does not publish in its callback, which is allowed
    actual = [float(mean) for (mean,) in means_of_calls]
    sentence = "Of two sensor processors in one process, one was shown scans of 1 m and the other one of 3 m"
    is_right = _all_close(actual, [1.0, 3.0, 1.0]) or _all_close(actual, _averages_of_two(workspace))
    expect(
        is_right,
        f"{sentence}, and the other one said {actual[1]:.3f} m: each needs a history of its own.",
        fraction=0.5,
    )


def _message(distance: float) -> calls.Step:
    """Return the call that creates a scan with one beam."""
    return calls.call("LaserScan", module="sensor_msgs.msg", ranges=[distance], range_min=0.125, range_max=3.5)


def _averages_of_two(workspace: Workspace) -> list[float]:
    """Return the averages of two of the student's DataProcessors, as `_expect_separate_histories` calls them.

    Other checks test whether they are right.
    """
    plan = calls.Plan()
    processors = [plan.add(calls.call("DataProcessor", HISTORY)) for _ in range(2)]
    average_steps = []
    for number, distance in ((0, 1.0), (1, 3.0), (0, 1.0)):
        plan.add(calls.call("process", [distance], 0.125, 3.5, on=processors[number]))
        average_steps.append(plan.add(calls.call("average", on=processors[number])))
    outcomes = calls.calls(workspace, UTILS, *plan.steps)
    return [average for step in average_steps if isinstance(average := outcomes[step].value, float)]


def _count_warnings(processor: Processor, scans: list[LaserScan], apart: float = SCAN_SECONDS) -> int:
    """Return the number of warnings while it receives these scans, which are `apart` seconds apart."""
    before = logged(processor.output, "WARN")
    processor.send_scans(*scans, apart=apart)
    return logged(processor.output, "WARN") - before


def _student_masked(workspace: Workspace, readings: list[float], low: float, high: float) -> list[float]:
    """Return the result of the student's mask_invalid. Other checks test whether it is right."""
    (outcome,) = calls.calls(workspace, UTILS, calls.call("mask_invalid", readings, low, high))
    return (
        [reading for reading in outcome.value if isinstance(reading, float)] if isinstance(outcome.value, list) else []
    )


def _student_averages(workspace: Workspace, scans: list[list[float]]) -> list[float]:
    """Return the averages of the student's DataProcessor, for scans for which their mean_distance returns a mean."""
    plan = calls.Plan()
    processor = plan.add(calls.call("DataProcessor", HISTORY))
    steps = []
    for readings in scans:
        masked = plan.add(calls.call("process", readings, 0.12, 3.5, on=processor))
        steps.append(
            (
                plan.add(calls.call("mean_distance", calls.result_of(masked))),
                plan.add(calls.call("average", on=processor)),
            )
        )
    outcomes = calls.calls(workspace, UTILS, *plan.steps)
    averages = [outcomes[average].value for mean, average in steps if outcomes[mean].value is not None]
    return [average for average in averages if isinstance(average, float)]


def _all_close(actual: list[float], expected: list[float]) -> bool:
    return len(actual) == len(expected) and all(map(_close, actual, expected))


def _close(actual: float, expected: float) -> bool:
    """Return whether two numbers are equal, if one of them was a 32-bit float."""
    return isnan(actual) if isnan(expected) else isclose(actual, expected, rel_tol=1e-6)
