"""Keys in a real terminal drive a robot over ROS."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
import time
from pathlib import Path

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from sim.bridge.teleop import command_after

ROOT = Path(__file__).resolve().parents[3]
PATIENCE = 60.0


def test_keys_change_the_command() -> None:
    command = (0.0, 0.0)
    for key in ("w", "\x1b[A", "W", "s", "a", "a", "\x1b[C", "?", ""):
        command = command_after(*command, key, 0.05, 0.2)
    assert command == (0.1, 0.2)
    assert command_after(*command, " ", 0.05, 0.2) == (0.0, 0.0)


@pytest.mark.slow
def test_a_key_in_a_terminal_becomes_a_command_and_q_stops_the_robot(ros_domain: int) -> None:
    context = Context()
    rclpy.init(context=context, domain_id=ros_domain, signal_handler_options=SignalHandlerOptions.NO)
    node, speeds = Node("robot", namespace="bob", context=context), list[float]()
    node.create_subscription(Twist, "cmd_vel", lambda message: speeds.append(message.linear.x), 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "sim", "teleop", "--robot", "bob"]
    process = subprocess.Popen(command, cwd=ROOT, stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    try:
        deadline = time.monotonic() + PATIENCE
        output = b""
        while b"q: end" not in output:  # earlier input is discarded
            output += os.read(ours, 1000)
        os.write(ours, b"w")
        while 0.05 not in speeds:  # the command is repeated
            assert time.monotonic() < deadline
            executor.spin_once(timeout_sec=0.05)
        os.write(ours, b"q")
        while speeds[-1] != 0.0:
            assert time.monotonic() < deadline
            executor.spin_once(timeout_sec=0.05)
        assert process.wait(PATIENCE) == 0
    finally:
        process.kill()
        process.wait()
        os.close(ours)
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
