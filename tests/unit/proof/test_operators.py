"""Operators make one small change at one place, and leave what only people read."""

from __future__ import annotations

import ast

import pytest

from autograder.proof.operators import changes

SOURCE = '''
"""A module: 1 < 2."""
LIMIT = 3


class Robot:
    """A robot with 2 wheels."""

    def __init__(self):
        """Make it: 4 < 5."""
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.look, qos_profile_sensor_data)
        self.log().info(f'{1 + 1} wheels — écoute')

    def look(self, scan):
        if scan is None:
            return
        near = min(scan.ranges) - 0.5
        if 0.1 <= near < 1.0 and not self.blind:
            self.turn(-math.radians(30.0))


def main():
    return 1 + 1
'''


def made(functions: frozenset[str] | None = None) -> list[tuple[str, str, str]]:
    """Return (operator, function, changed line) of each change."""
    lines = SOURCE.splitlines()
    found = []
    for change in changes(SOURCE, functions):
        after = change.apply(SOURCE)
        ast.parse(after)
        (line,) = [new for old, new in zip(lines, after.splitlines(), strict=True) if old != new]
        found.append((change.operator, change.function, line.strip()))
    return found


@pytest.mark.parametrize(
    ("operator", "line"),
    [
        ("topic", "self.pub = self.create_publisher(Twist, 'cmd_vels', 10)"),
        ("constant", "self.pub = self.create_publisher(Twist, 'cmd_vel', 20)"),
        ("qos", "self.create_subscription(LaserScan, 'scan', self.look, 10)"),
        ("guard", "if False:"),
        ("compare", "if scan is not None:"),
        ("order", "near = max(scan.ranges) - 0.5"),
        ("sign", "near = (min(scan.ranges) + 0.5)"),
        ("compare", "if 0.1 < near < 1.0 and not self.blind:"),
        ("compare", "if 0.1 <= near >= 1.0 and not self.blind:"),
        ("boolean", "if 0.1 <= near < 1.0 or not self.blind:"),
        ("sign", "if 0.1 <= near < 1.0 and self.blind:"),
        ("units", "self.turn(-30.0)"),
        ("sign", "self.turn(math.radians(30.0))"),
    ],
)
def test_each_operator_makes_its_slip(operator: str, line: str) -> None:
    assert (operator, line) in [(name, changed) for name, _, changed in made()]


def test_words_for_people_main_and_the_module_are_left_alone() -> None:
    assert {function for _, function, _ in made()} == {"Robot.__init__", "Robot.look"}
    assert not any("wheels" in line or "Make it" in line for _, _, line in made())


def test_only_the_named_functions_are_changed() -> None:
    assert {function for _, function, _ in made(frozenset({"Robot.look"}))} == {"Robot.look"}
    assert made(frozenset({"main"}))[0][1] == "main"
