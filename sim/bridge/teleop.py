"""Drives a robot with the keys of a terminal: a simulated robot, or a real one that subscribes to cmd_vel."""

from __future__ import annotations

import os
import select
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.duration import Duration

from sim.exceptions import SpecError

PERIOD = 0.1
"""Seconds between two commands. A command is repeated until the next key, because robots stop without commands."""

HELP = "w or up: faster   s or down: slower   a or left, d or right: turn   space: stop   q: end"

ARROWS = {"\x1b[A": "w", "\x1b[B": "s", "\x1b[D": "a", "\x1b[C": "d"}


def command_after(linear: float, angular: float, key: str, step: float, turn: float) -> tuple[float, float]:
    """Return the command after a key, in m/s and rad/s. An unknown key does not change it.

    Args:
        linear: the speed before the key, in m/s.
        angular: the turning rate before the key, in rad/s.
        key: a letter, or the sequence that a terminal sends for an arrow key.
        step: the change of the speed by a key, in m/s.
        turn: the change of the turning rate by a key, in rad/s.
    """
    match ARROWS.get(key, key).lower():
        case "w":
            linear += step
        case "s":
            linear -= step
        case "a":
            angular += turn
        case "d":
            angular -= turn
        case " ":
            linear = angular = 0.0
    return round(linear, 6), round(angular, 6)


def drive(namespace: str = "", *, stamped: bool = False, step: float = 0.05, turn: float = 0.2) -> None:
    """Publish commands on cmd_vel until q or Ctrl-C, and then one that stops the robot.

    Raises:
        SpecError: the input is not a terminal.
    """
    if not sys.stdin.isatty():
        raise SpecError("teleop reads single keys: run it in a terminal")
    rclpy.init()
    node = rclpy.create_node("teleop", namespace=namespace)
    publisher = node.create_publisher(TwistStamped if stamped else Twist, "cmd_vel", 10)

    def publish(linear: float, angular: float) -> None:
        message = TwistStamped() if stamped else Twist()
        if stamped:
            message.header.stamp = node.get_clock().now().to_msg()
        twist = message.twist if stamped else message
        twist.linear.x, twist.angular.z = linear, angular
        publisher.publish(message)

    linear = angular = 0.0
    try:
        with _single_keys(sys.stdin.fileno()) as descriptor:
            print(HELP, flush=True)
            for key in _keys(descriptor):
                linear, angular = command_after(linear, angular, key, step, turn)
                publish(linear, angular)
                if key:
                    print(f"\r{linear:+.2f} m/s  {angular:+.2f} rad/s ", end="", flush=True)
    except KeyboardInterrupt:
        pass
    finally:
        if rclpy.ok():
            publish(0.0, 0.0)
            publisher.wait_for_all_acked(Duration(seconds=1.0))  # otherwise, this process could end first
        print()
        node.destroy_node()
        rclpy.try_shutdown()


def _keys(descriptor: int) -> Iterator[str]:
    """Yield each key, or "" if none was pressed within `PERIOD`, until q or the end of the input."""
    while True:
        ready, _, _ = select.select([descriptor], [], [], PERIOD)
        data = os.read(descriptor, 64).decode(errors="replace") if ready else ""
        if ready and not data:
            return
        for key in [data] if data in ARROWS or not data else list(data):
            if key in ("q", "Q"):
                return
            yield key


@contextmanager
def _single_keys(descriptor: int) -> Iterator[int]:
    """Make a terminal return each key at once without printing it, and restore it afterwards."""
    attributes = termios.tcgetattr(descriptor)
    tty.setcbreak(descriptor)
    try:
        yield descriptor
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, attributes)
