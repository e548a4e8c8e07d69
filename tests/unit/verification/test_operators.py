"""Each operator makes one mutation in one place, and does not change text for people."""

from __future__ import annotations

import ast

import pytest

from autograder.author.verification.generated_mutants import mutations

SOURCE = '''
"""A module: 1 < 2."""
LIMIT = 3


class Robot:
    """A robot with 2 wheels."""

    def __init__(self):
        """Make it: 4 < 5."""
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.look, qos_profile_sensor_data)
        self.create_timer(0.1, self.drive)
        self.log().info(f'{1 + 1} wheels — écoute')

    @guarded
    def look(self, scan):
        if scan is None:
            return
        self.time = self.get_clock().now()
        near = min(scan.ranges) - 0.5
        if 0.1 <= near < 1.0 and not self.blind:
            self.turn(-math.radians(30.0))
        elif scan.header.stamp:
            self.speed = self.get_parameter('speed').value
            self.command.linear.x = 0.0
            self.reason = 'the way is clear'
            self.pub.publish(self.command)
        try:
            self.scan(scan, twice=True)
        except ValueError:
            raise RuntimeError('words') from None


def main():
    return 1 + 1
'''


def changes_made(functions: frozenset[str] | None = None) -> list[tuple[str, str, str]]:
    """Return (operator, function, changed lines) of each change."""
    lines, mutated = SOURCE.splitlines(), []
    for function, (operator, changes) in mutations("robot.py", SOURCE, functions):
        data = SOURCE.encode()
        for start, end, new in sorted(changes, reverse=True):
            data = data[:start] + new.encode() + data[end:]
        ast.parse(data)
        changed = [line.strip() for line in data.decode().splitlines() if line not in lines]
        mutated.append((operator, function, " / ".join(changed)))
    return mutated


@pytest.mark.parametrize(
    ("operator", "line"),
    [
        ("off by one", "LIMIT = 4"),
        ("25 %", "near = min(scan.ranges) - 0.375"),
        ("10 %", "near = min(scan.ranges) - 0.55"),
        ("sign", "near = min(scan.ranges) - (-0.5)"),
        ("name", "self.pub = self.create_publisher(Twist, 'cmd_vels', 10)"),
        ("qos", "self.pub = self.create_publisher(Twist, 'cmd_vel', 1)"),
        ("qos", "self.create_subscription(LaserScan, 'scan', self.look, 10)"),
        ("condition", "if False:"),
        ("negated", "if (scan is not None):"),
        ("swapped", "near = max(scan.ranges) - 0.5"),
        ("arithmetic", "near = ((min(scan.ranges)) + (0.5))"),
        ("boundary", "if (0.1 < near < 1.0) and not self.blind:"),
        ("negated", "if (0.1 <= near >= 1.0) and not self.blind:"),
        ("boolean", "if ((0.1 <= near < 1.0) or (not self.blind)):"),
        ("negated", "if 0.1 <= near < 1.0 and (self.blind):"),
        ("units", "self.turn(-(30.0))"),
        ("sign", "self.turn((math.radians(30.0)))"),
        ("no publish", "pass"),
        ("no field", "pass"),
        ("swapped", "self.command.angular.x = 0.0"),
        ("arguments", "self.create_timer(self.drive, 0.1)"),
        ("keyword", "self.scan(scan)"),
        ("exception", "except Exception:"),
        ("let through", "raise"),
        ("swallowed", "pass"),
        ("log level", "self.log().debug(f'{1 + 1} wheels — écoute')"),
        ("no decorator", ""),
        ("stamp", "self.time = __import__('rclpy.time').time.Time.from_msg(scan.header.stamp)"),
        ("stamp", "elif self.get_clock().now().to_msg():"),
        ("read once", "self.speed = self.__dict__.setdefault(('once', 'speed'), self.get_parameter('speed').value)"),
        ("wall time", "self.time = __import__('rclpy.clock').clock.Clock().now()"),
    ],
)
def test_each_operator_makes_its_mutation(operator: str, line: str) -> None:
    assert (operator, line) in [(name, changed) for name, _, changed in changes_made()]


def test_docstrings_and_messages_are_not_mutated() -> None:
    lines = [line for _, _, line in changes_made()]
    assert not any("Make it" in line or "words'" in line or "wheelss" in line or "clears" in line for line in lines)


def test_only_the_named_functions_and_the_module_are_changed() -> None:
    assert {function for _, function, _ in changes_made(frozenset({"Robot.look"}))} == {"", "Robot", "Robot.look"} - {
        "Robot"
    }
    assert any(name == "main" for _, name, _ in changes_made(frozenset({"main"})))


@pytest.mark.parametrize(
    ("file", "text", "operator", "changed"),
    [
        ("a.msg", "int32 battery -1  # percent\n", "type", "int64 battery -1  # percent\n"),
        ("a.msg", "int32 battery -1\n", "name", "int32 batterys -1\n"),
        ("a.msg", "int32 battery -1\n", "off by one", "int32 battery -2\n"),
        ("a.msg", "bool a\nbool b\n", "line order", "bool b\nbool a\n"),
        ("a.srv", "float64[<=8] legs\n", "bound", "float64[<=9] legs\n"),
        ("a.srv", "string<=80 reason\n", "bound", "string reason\n"),
        ("package.xml", "<depend>rclpy</depend>\n", "tag", "<build_depend>rclpy</build_depend>\n"),
        ("package.xml", "<depend>rclpy</depend>\n", "name", "<depend>rclpys</depend>\n"),
        ("CMakeLists.txt", "find_package(std_msgs REQUIRED)\n", "name", "find_package(std_msgss REQUIRED)\n"),
        ("setup.cfg", "[develop]\n", "no line", ""),
        ("a.yaml", "speed: 0.4  # m/s\n", "10 %", "speed: 0.44  # m/s\n"),
        ("a.yaml", "name: 'x'\n", "value", "name: 'xs'\n"),
    ],
)
def test_other_file_types_have_their_own_operators(file: str, text: str, operator: str, changed: str) -> None:
    mutated = []
    for _, (name, ((start, end, new),)) in mutations(file, text, None):
        data = text.encode()
        mutated.append((name, (data[:start] + new.encode() + data[end:]).decode()))
    assert (operator, changed) in mutated
