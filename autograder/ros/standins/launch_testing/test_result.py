"""The results of one launch's tests, and their report as JUnit's XML."""

from __future__ import annotations

import time
import unittest
from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree

from standin_notice import guard

from .loader import TestRun


class TestResult(unittest.TextTestResult):
    """Prints each test, and keeps how many seconds it took."""

    __test__ = False  # for pytest

    def __init__(self, stream: Any, descriptions: bool, verbosity: int) -> None:
        super().__init__(stream, descriptions, verbosity)
        self.seconds: dict[unittest.TestCase, float] = {}
        self._started = 0.0

    def startTest(self, test: unittest.TestCase) -> None:
        self._started = time.monotonic()
        super().startTest(test)

    def stopTest(self, test: unittest.TestCase) -> None:
        super().stopTest(test)
        self.seconds[test] = time.monotonic() - self._started

    def append(self, other: TestResult) -> None:
        """Add the results of further tests."""
        self.seconds |= other.seconds
        self.testsRun += other.testsRun
        for kept, added in (
            (self.failures, other.failures),
            (self.errors, other.errors),
            (self.skipped, other.skipped),
            (self.expectedFailures, other.expectedFailures),
            (self.unexpectedSuccesses, other.unexpectedSuccesses),
        ):
            kept.extend(added)  # type: ignore[arg-type]


def died(run: TestRun) -> unittest.TestResult:
    """Return the results of a launch that ended before its tests did."""
    result = unittest.TestResult()
    error = Exception("Launch stopped before the active tests finished.")
    for case in run.cases:
        result.addFailure(case, (Exception, error, None))  # type: ignore[arg-type]
        result.testsRun += 1
    return result


def skipped(run: TestRun, reason: str) -> unittest.TestResult:
    """Return the results of a launch that is not made."""
    result = unittest.TestResult()
    for case in run.cases:
        result.addSkip(case, reason)
        result.testsRun += 1
    return result


def junit(results: Mapping[TestRun | str, unittest.TestResult], name: str) -> ElementTree.ElementTree[Any]:
    """Return the report of all launches."""
    suites = ElementTree.Element("testsuites", name=name)
    for run, result in results.items():
        suites.append(_suite(str(run), result))
    for count in ("tests", "failures", "errors"):
        suites.set(count, str(sum(int(suite.get(count, 0)) for suite in suites)))
    suites.set("time", str(round(sum(float(suite.get("time", 0)) for suite in suites), 3)))
    return ElementTree.ElementTree(suites)


def _suite(name: str, result: unittest.TestResult) -> ElementTree.Element:
    seconds: Mapping[Any, float] = getattr(result, "seconds", {})
    told = {kind: dict(getattr(result, found)) for kind, found in _KINDS.items()}
    cases = seconds or {case: 0.0 for kind in told.values() for case in kind}
    suite = ElementTree.Element(
        "testsuite",
        name=name,
        tests=str(result.testsRun),
        failures=str(len(result.failures)),
        errors=str(len(result.errors)),
        skipped=str(len(result.skipped)),
        time=str(round(sum(seconds.values()), 3)),
    )
    for case, took in cases.items():
        method, _, qualifiers = case.id().partition(" ")
        classname, _, method = method.rpartition(".")
        title = f"{method} {qualifiers}".strip()
        element = ElementTree.SubElement(suite, "testcase", classname=classname, name=title, time=str(round(took, 3)))
        for kind, found in told.items():
            if case in found:
                ElementTree.SubElement(element, kind, message=found[case])
    return suite


_KINDS = {"failure": "failures", "error": "errors", "skipped": "skipped"}


__getattr__ = guard(__name__)
