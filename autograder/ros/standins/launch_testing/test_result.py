"""The results of the tests of one launch."""

from __future__ import annotations

import unittest

from standin_notice import make_getattr

from .loader import TestRun


class TestResult(unittest.TextTestResult):
    """Prints each test."""

    __test__ = False  # for pytest

    def append(self, other: TestResult) -> None:
        """Add the results of further tests."""
        self.testsRun += other.testsRun
        for results, other_results in (
            (self.failures, other.failures),
            (self.errors, other.errors),
            (self.skipped, other.skipped),
            (self.expectedFailures, other.expectedFailures),
            (self.unexpectedSuccesses, other.unexpectedSuccesses),
        ):
            results.extend(other_results)  # type: ignore[arg-type]


def failed_result(run: TestRun) -> unittest.TestResult:
    """Return the results of a launch that ended before its tests did."""
    result = unittest.TestResult()
    error = Exception("Launch stopped before the active tests finished.")
    for case in run.cases:
        result.addFailure(case, (Exception, error, None))  # type: ignore[arg-type]
        result.testsRun += 1
    return result


def skipped_result(run: TestRun, reason: str) -> unittest.TestResult:
    """Return the results of a launch that is skipped."""
    result = unittest.TestResult()
    for case in run.cases:
        result.addSkip(case, reason)
        result.testsRun += 1
    return result


__getattr__ = make_getattr(__name__)
