"""The readers that belong to single chapters."""

from __future__ import annotations

from autograder.checks.ch01_package_structure.hidden import run
from autograder.checks.ch05_parameters.support import robot
from autograder.checks.ch06_testing.support import sleeping
from autograder.checks.ch09_assessment.support import sheet
from tests.unit.reading.generated import altered, texts
from tests.unit.reading.reader import Reader
from tests.unit.reading.samples import PYTHON

READERS: dict[str, Reader] = {
    "sheet of answers": Reader(
        lambda text, folder: [sheet.expect_letter(sheet.parse(text), question) for question in ("q1", "q2")],
        texts("q1: a\nq2: 'B'  # sure\n"),
    ),
    "configuration of 01": Reader(
        lambda data, folder: run._side(data),
        altered(b"dancer:\n  ros__parameters:\n    side: 1.5\n"),
        tuple(
            b"dancer: {ros__parameters: {side: " + tag + b"}}"
            for tag in (b"!!bool foo", b"!!timestamp foo", b"!!int ''")
        ),
    ),
    "sentence with distances": Reader(
        lambda text, folder: robot.missing_from(text, {"safety_distance": 0.5}),
        texts("safety_distance 0.5 m is above slow_distance 0.4 m"),
        ("9" * 5000, "٣.٣", "1." + "0" * 5000),
    ),
    "calls of sleep": Reader(lambda data, folder: sleeping.sleeps(data, "test_guard.py"), altered(PYTHON)),
}
