"""JUnit XML: a test suite for each submission, with a test case for each check."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path

from autograder.plain_text import clean
from autograder.report.feedback.text import no_mark, number, one_line
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome

FOLDER = False


def write(results: Sequence[Result], out: Path) -> Path:
    """Write the report. `failed` is a failure, `not_checked` is skipped, and a missing mark is an error."""
    suites = [_suite(result) for result in results]
    root = ET.Element("testsuites", _totals(suites))
    root.extend(suites)
    ET.indent(root)
    ET.ElementTree(root).write(out, encoding="utf-8", xml_declaration=True)
    return out


def _suite(result: Result) -> ET.Element:
    cases = [_case(check, result) for check in result.checks]
    if result.status is not Status.GRADED:
        case = ET.Element("testcase", {"classname": one_line(result.assignment), "name": "graded", "time": "0"})
        ET.SubElement(case, "error", {"message": f"Not graded. {one_line(no_mark(result))}"})
        cases = [case]
    suite = ET.Element("testsuite", {"name": one_line(f"{result.assignment}: {result.student}")})
    suite.attrib |= {
        "tests": str(len(cases)),
        "failures": str(sum(case.find("failure") is not None for case in cases)),
        "errors": str(sum(case.find("error") is not None for case in cases)),
        "skipped": str(sum(case.find("skipped") is not None for case in cases)),
        "time": f"{result.seconds:.3f}",
        "timestamp": one_line(result.started),
    }
    properties = ET.SubElement(suite, "properties")
    for name, value in (("seed", result.seed), ("suite_version", result.suite_version), ("score", result.score)):
        ET.SubElement(properties, "property", {"name": name, "value": one_line(str(value))})
    suite.extend(cases)
    return suite


def _case(check: CheckResult, result: Result) -> ET.Element:
    name = f"{result.assignment}.{check.group}"
    case = ET.Element("testcase", {"classname": one_line(name), "name": check.id, "time": f"{check.seconds:.3f}"})
    if check.outcome is Outcome.FAILED:
        points = f"{number(check.points)} of {number(check.max_points)} points"
        failure = ET.SubElement(case, "failure", {"message": one_line(check.message) or "failed"})
        failure.text = clean("\n".join((check.title, check.message, points)))
    elif check.outcome is Outcome.NOT_CHECKED:
        ET.SubElement(case, "skipped", {"message": one_line(check.message) or "not checked"})
    return case


def _totals(suites: Sequence[ET.Element]) -> dict[str, str]:
    names = ("tests", "failures", "errors", "skipped")
    return {name: str(sum(int(suite.get(name, "0")) for suite in suites)) for name in names}
