"""The readers that chapters have of their own."""

from __future__ import annotations

from autograder.checks.ch01_package_structure.hidden import run
from autograder.checks.ch05_parameters.support import robot
from autograder.checks.ch06_testing.support import sleeping
from autograder.checks.ch09_assessment.support import sheet
from tests.unit.reading.door import Door
from tests.unit.reading.made_up import altered, texts
from tests.unit.reading.samples import PYTHON

DOORS: dict[str, Door] = {
    "sheet of answers": Door(
        lambda text, place: [sheet.expect_letter(sheet.parse(text), question) for question in ("q1", "q2")],
        texts("q1: a\nq2: 'B'  # sure\n"),
    ),
    "configuration of 01": Door(
        lambda data, place: run._side(data),
        altered(b"dancer:\n  ros__parameters:\n    side: 1.5\n"),
        tuple(
            b"dancer: {ros__parameters: {side: " + tag + b"}}"
            for tag in (b"!!bool foo", b"!!timestamp foo", b"!!int ''")
        ),
    ),
    "sentence with distances": Door(
        lambda text, place: robot.missing_from(text, {"safety_distance": 0.5}),
        texts("safety_distance 0.5 m is above slow_distance 0.4 m"),
        ("9" * 5000, "٣.٣", "1." + "0" * 5000),
    ),
    "calls of sleep": Door(lambda data, place: sleeping.sleeps(data), altered(PYTHON)),
}
