"""Statistics of a class: the distribution of marks and the difficulty of each check."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import StatisticsError, correlation, median

from autograder.result.model import CheckResult, Result
from autograder.suite import Outcome

BAND_PERCENT = 10  # the width of a bar in the distribution
MAX_REASONS = 8


@dataclass(frozen=True)
class CheckStatistics:
    """Statistics of a check in a class.

    Attributes:
        passed: the number of submissions that passed it, of `total`.
        difficulty: mean share of its points that was earned, 0 to 1. Test theory calls it the difficulty of an item.
        discrimination: correlation of its points with the points of all other checks, -1 to 1. Near 0 or below, the
            check separates strong answers from weak ones no better than chance. None if all points are equal.
    """

    id: str
    title: str
    passed: int
    total: int
    difficulty: float
    discrimination: float | None


@dataclass(frozen=True)
class ClassStatistics:
    """Statistics of a class in an assignment.

    Attributes:
        bands: number of results in each band of `BAND_PERCENT` per cent, from 0. Full marks are in the last band.
        checks: the checks that some submissions did not pass, most failures first.
        reasons: the most frequent messages of failed checks, each with the number of students who got it.
        seconds: median wall time of a grading.
    """

    bands: tuple[int, ...]
    checks: tuple[CheckStatistics, ...]
    reasons: tuple[tuple[str, int], ...]
    seconds: float


def class_statistics(results: Sequence[Result]) -> ClassStatistics:
    """Return the statistics of graded results. At least one is required."""
    bands = Counter(min(int(result.percent // BAND_PERCENT), 100 // BAND_PERCENT - 1) for result in results)
    by_check: dict[tuple[str, str], list[tuple[Result, CheckResult]]] = {}
    for result in results:
        for check in result.checks:
            by_check.setdefault((result.assignment, check.id), []).append((result, check))
    checks = [_check(pairs) for pairs in by_check.values()]
    missed = sorted((check for check in checks if check.passed < check.total), key=lambda check: check.difficulty)
    messages = Counter(
        message
        for result in results
        for message in {check.message for check in result.checks if check.outcome is Outcome.FAILED and check.message}
    )
    return ClassStatistics(
        tuple(bands[band] for band in range(100 // BAND_PERCENT)),
        tuple(missed),
        tuple((message, count) for message, count in messages.most_common(MAX_REASONS) if count > 1),
        median(result.seconds for result in results),
    )


def _check(pairs: Sequence[tuple[Result, CheckResult]]) -> CheckStatistics:
    points = [check.points for _, check in pairs]
    others = [math.fsum((result.score, -check.points)) for result, check in pairs]
    try:
        discrimination = correlation(points, others)
    except StatisticsError:  # fewer than two results, or equal values
        discrimination = None
    first = pairs[0][1]
    return CheckStatistics(
        first.id,
        first.title,
        sum(check.outcome is Outcome.PASSED for _, check in pairs),
        len(pairs),
        math.fsum(points) / math.fsum(check.max_points for _, check in pairs),
        discrimination,
    )
