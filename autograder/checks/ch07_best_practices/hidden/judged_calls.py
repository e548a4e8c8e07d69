"""Calls the utilities for many drawn cases in one process, and judges the results."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from autograder.checking import Workspace, expect
from autograder.checking.probes import calls
from autograder.checks.ch07_best_practices.support.contract import UTILS
from autograder.checks.ch07_best_practices.support.drawn_readings import Readings, Series, averages, expect_all


def judge_masked(
    workspace: Workspace, cases: Sequence[Readings], judge: Callable[[Readings, list[float]], None]
) -> None:
    """Mask all readings in one process, and judge the results."""
    steps = [calls.call("mask_invalid", list(case.readings), case.low, case.high) for case in cases]

    def judge_outcome(pair: tuple[Readings, calls.StepResult]) -> None:
        case, outcome = pair
        masked = calls.value(outcome, case.call)
        expect(isinstance(masked, list), f"{case.call} returned {masked!r} instead of a list.")
        judge(case, list(masked))

    expect_all(zip(cases, calls.run_steps(workspace, UTILS, *steps), strict=True), judge_outcome)


def judge_means(
    workspace: Workspace, cases: Sequence[list[float]], judge: Callable[[list[float], object], None]
) -> None:
    """Call mean_distance for all lists in one process, and judge the results."""
    outcomes = calls.run_steps(workspace, UTILS, *(calls.call("mean_distance", case) for case in cases))
    pairs = zip(cases, outcomes, strict=True)
    expect_all(pairs, lambda pair: judge(pair[0], calls.value(pair[1], f"mean_distance({pair[0]})")))


def judge_processed(workspace: Workspace, cases: Sequence[Readings], *, fraction: float) -> None:
    """Fail the check unless a DataProcessor returns the masked ranges of each scan."""
    plan = calls.Plan()
    processor = plan.add(calls.call("DataProcessor", 3))
    steps = [plan.add(calls.call("process", list(case.readings), case.low, case.high, on=processor)) for case in cases]
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)
    for case, step in zip(cases, steps, strict=True):
        returned = calls.value(outcomes[step], f"process({case!r})")
        message = f"process({case!r}) returned {returned} instead of {case.masked}."
        expect(calls.same(returned, case.masked), message, fraction=fraction)


def judge_averages(workspace: Workspace, cases: Sequence[Series], *, fraction: float) -> None:
    """Fail the check unless a DataProcessor for each series, all in one process, has the correct averages."""
    plan = calls.Plan()
    processors = [plan.add(calls.call("DataProcessor", *case.arguments)) for case in cases]
    average_steps: dict[Series, list[int]] = {}
    for case, processor in zip(cases, processors, strict=True):
        average_steps[case] = []
        for scan in case.scans:
            plan.add(calls.call("process", list(scan.readings), scan.low, scan.high, on=processor))
            average_steps[case].append(plan.add(calls.call("average", on=processor)))
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)

    def judge(case: Series) -> None:
        for count, (step, expected) in enumerate(zip(average_steps[case], averages(case), strict=True), start=1):
            average = calls.value(outcomes[step], f"average(), after {case.describe_first(count)},")
            message = (
                f"After {case.describe_first(count)}, {case.constructor}.average() is {average} instead of {expected}."
            )
            if len(cases) > 1:
                message += " The program also has other DataProcessors."
            expect(calls.same(average, expected), message, fraction=fraction)

    expect_all(average_steps, judge)
