"""A rewritten module behaves the same, and its lines are short enough for the ROS linters."""

from __future__ import annotations

import ast
import math
from typing import Any

import pytest

from autograder.author.verification.equivalent_rewrites import MAX_COLUMNS, formatted, rewritten

MODULE = '''"""A robot that measures."""
import math

FULL = 12.6


class Robot:
    """It has a battery."""

    def __init__(self, volts=12.0):
        self.volts = volts
        self.count = 0

    def percent(self):
        left = self.volts - 11.0
        return 100.0 if left > 1.6 else max(0.0, left / 0.016)

    @property
    def empty(self):
        return not self.volts >= 11.0

    def measure(self, readings, limit=None):  # noqa: D102
        self.count += 1
        near = [reading for reading in readings if 0.1 <= reading < 10.0]
        closest = min(near, default=math.inf)
        if limit is not None and (closest < limit or
                                  self.percent() < 10.0):
            self.count += 1
        words = [f'{closest:.1f}' for closest in near]
        self.last = (closest, self.count, words)

    def ask(self, first, second):
        return first() < second()


def swap(a, b):
    def turn(left, right): return right, left
    return turn(a, b)
'''


def robot(text: str) -> dict[str, Any]:
    names: dict[str, Any] = {}
    exec(compile(text, "robot.py", "exec"), names)
    return names


@pytest.mark.parametrize("rewrite", [rewritten, formatted])
def test_a_rewritten_module_behaves_the_same(rewrite: Any) -> None:
    text = rewrite(MODULE)
    assert text != MODULE
    before, after = robot(MODULE), robot(text)
    for volts in (10.0, 11.0, 12.6, 13.0):
        old, new = before["Robot"](volts), after["Robot"](volts)
        assert (new.percent(), new.empty) == (old.percent(), old.empty)
        for readings, limit in (([], None), ([0.05, 3.0, math.nan, 0.1], 1.0), ([10.0, 9.9], 1.0)):
            old.measure(readings, limit)
            new.measure(readings, limit)
            assert new.last == old.last
    assert after["swap"](1, 2) == before["swap"](1, 2)


def test_a_rewritten_module_has_other_names_and_expressions() -> None:
    text = rewritten(MODULE)
    assert "from __future__ import annotations\nimport math" in text
    assert "return max(0.0, lef_ / 0.016) if not (1.6 < lef_) else 100.0" in text
    assert "self.count = self.count + 1" in text
    assert "def measure(self, readings, limit=None) -> None:  # noqa: D102" in text
    (robot_class,) = (node for node in ast.parse(text).body if isinstance(node, ast.ClassDef))
    names = [node.name for node in robot_class.body if isinstance(node, ast.FunctionDef)]
    assert names == ["__init__", "ask", "measure", "empty", "percent"]


def test_constructs_that_cannot_be_rewritten_safely_are_kept() -> None:
    text = rewritten(MODULE)
    assert "return first() < second()" in text  # the order of the calls
    assert "if 0.1 <= readin_ < 10.0" in text  # a chain has no mirror image
    assert "closest = min(nea_, default=math.inf)" in text  # an f-string contains the name
    assert "def turn(left, right)" in text


def test_lines_stay_short_and_continuation_lines_stay_aligned() -> None:
    wide = (
        f"def area(width, height):\n    result = {'width * ' * 6}height if width < height else 0.0\n    return result\n"
    )
    for text in (rewritten(MODULE), rewritten(wide)):
        assert max(map(len, text.splitlines())) <= MAX_COLUMNS
    assert "(limit > closest or\n" in rewritten(MODULE)
    assert " else 0.0\n" in rewritten(wide)  # turned round, the line would be too long
