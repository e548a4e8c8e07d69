"""What the student's utilities and nodes do with a few readings, at once."""

from __future__ import annotations

from math import inf, isnan, nan

from autograder.checks import check, expect, hint
from autograder.checks.ch07_best_practices.support import contract
from autograder.checks.ch07_best_practices.support.robot import Processor, Robust, expected, scan
from autograder.harness import Workspace
from autograder.probes.calls import call, calls, make, same, value


@check(points=1, holds=("mask", "places", "phantoms"), group="utils", doc=contract.REP_117)
@hint(contract.RULE_PLACE, contract.RULE_MASK)
def test_mask_invalid(workspace: Workspace) -> None:
    """mask_invalid replaces what is no measurement by nan, and keeps every reading's place."""
    readings = [1.0, 0.0, inf, nan, 9.0, -inf]
    (outcome,) = calls(workspace, contract.UTILS, call("mask_invalid", readings, 0.12, 3.5))
    shown = "mask_invalid([1.0, 0.0, inf, nan, 9.0, -inf], 0.12, 3.5)"
    masked = value(outcome, shown)
    expect(same(masked, [1.0, nan, inf, nan, nan, -inf]), f"{shown} returned {masked}.")


@check(points=1, holds="mean", group="utils")
@hint(contract.RULE_MEAN, "Without a finite reading there is no mean: return None, not 0.0.")
def test_mean_distance(workspace: Workspace) -> None:
    """mean_distance takes the mean of the finite readings, and says None when there is none."""
    some, none = calls(
        workspace, contract.UTILS, call("mean_distance", [1.0, nan, 2.0, inf]), call("mean_distance", [nan])
    )
    mean = value(some, "mean_distance([1.0, nan, 2.0, inf])")
    expect(same(mean, 1.5), f"mean_distance([1.0, nan, 2.0, inf]) returned {mean} instead of 1.5.")
    nothing = value(none, "mean_distance([nan])")
    expect(nothing is None, f"mean_distance([nan]) returned {nothing} instead of None.")


@check(
    points=1, holds=("history", "average"), group="utils", depends=("mask_invalid", "mean_distance"), doc=contract.DEQUE
)
@hint("deque(maxlen=history) forgets the oldest by itself.", "average() is the mean of the means remembered.")
def test_data_processor(workspace: Workspace) -> None:
    """DataProcessor remembers the means of the newest scans, and no more than it was told to."""
    steps = [make("DataProcessor", 2), *(call("process", [metres], 0.1, 9.0, on=0) for metres in (1.0, 2.0, 3.0))]
    *_, outcome = calls(workspace, contract.UTILS, *steps, call("average", on=0))
    average = value(outcome, "average()")
    expect(same(average, 2.5), f"After scans of 1, 2 and 3 m, DataProcessor(2).average() is {average} instead of 2.5.")


@check(points=1, holds="scan-filtered", group="processor", depends=("data_processor",), doc=contract.QOS)
@hint("Both ends of scan and scan_filtered use qos_profile_sensor_data.")
@hint("msg.ranges = self.processor.process(msg.ranges, msg.range_min, msg.range_max), then publish msg.")
def test_filters_scans(processor: Processor) -> None:
    """sensor_processor publishes a scan again, masked."""
    filtered, _ = processor.show(scan([1.0, 0.0, 2.0]))
    expect(len(filtered) == 1, f"One scan went in, {len(filtered)} came out on scan_filtered.")
    ranges = list(filtered[0].ranges)
    right = len(ranges) == 3 and isnan(ranges[1]) and ranges[::2] == [1.0, 2.0]
    expect(right, f"[1.0, 0.0, 2.0] went in, {ranges} came out: [1.0, nan, 2.0] was expected.")


@check(points=1, holds=("failed", "once-a-second"), group="robust", doc=contract.ERRORS)
@hint(contract.RULE_STATUS, "One call of read_sensor(self.generator, self.failure_probability) a period.")
def test_counts_failures(workspace: Workspace) -> None:
    """robust_node says each second how its reading went, and counts failures in a row."""
    with Robust(workspace, seed=7, failure_probability=0.5) as harness:
        said = harness.hear(8)
    wanted = expected(7, 0.5, 8)
    expect(said == wanted, f"With seed 7 it said {said}, and should have said {wanted}.")
