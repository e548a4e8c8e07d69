"""Small real nodes run in lockstep: each kind of spin gives the same run every time."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

from tests.e2e.sandbox_support import in_worker_sandbox

HEAD = """
import sys
import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from std_msgs.msg import String

class Echo(Node):
    '''Publishes on `said` what it received on `heard`, and how often its timer has fired.'''

    def __init__(self, name='echo', qos=10, heard='heard', said='said', period=0.1):
        super().__init__(name)
        self.ticks, self.last = 0, ''
        self.out = self.create_publisher(String, said, qos)
        self.create_subscription(String, heard, self.hear, qos)
        self.create_timer(period, self.tick)

    def hear(self, message):
        self.last = message.data
        self.say('heard')

    def tick(self):
        self.ticks += 1
        self.say('tick')

    def say(self, why):
        now = self.get_clock().now().nanoseconds
        self.out.publish(String(data=f'{self.get_name()} {why} {self.last} {self.ticks} {now}'))

def run(program):
    rclpy.init()
    try:
        program()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
"""

SPIN = "run(lambda: rclpy.spin({node}))\n"
PROGRAMS = {
    "rclpy.spin": SPIN.format(node="Echo()"),
    "best effort": SPIN.format(node="Echo(qos=qos_profile_sensor_data)"),
    "two nodes in one executor": """
def program():
    executor = SingleThreadedExecutor()
    executor.add_node(first := Echo('first'))
    executor.add_node(second := Echo('second', period=0.05))
    executor.spin()
run(program)
""",
    "many threads": """
def program():
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node := Echo())
    executor.spin()
run(program)
""",
    "spin_once": """
def program():
    node = Echo()
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.1)
run(program)
""",
    "spin_once without waiting": """
def program():
    node = Echo()
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
run(program)
""",
    "two nodes in turn": """
def program():
    first, second = Echo('first'), Echo('second')
    while rclpy.ok():
        rclpy.spin_once(first, timeout_sec=0.05)
        rclpy.spin_once(second, timeout_sec=0.05)
run(program)
""",
    "publishes in __init__": """
class Eager(Echo):
    def __init__(self):
        super().__init__()
        for _ in range(20):
            self.say('early')
run(lambda: rclpy.spin(Eager()))
""",
    "two topics in one step": """
class Both(Echo):
    def __init__(self):
        super().__init__()
        self.create_subscription(String, 'also', self.hear, 10)
run(lambda: rclpy.spin(Both()))
""",
}
STEPS = 60
STEP_NS = 100_000_000  # the period of the programs' timers


def record_runs(scratch: Path, program: str, runs: int) -> list[Any]:
    """Run a program several times in lockstep; return its messages in each run."""
    from std_msgs.msg import String

    from autograder.harness import SteppedHarness, Workspace
    from autograder.ros import activate

    install = scratch / "ws" / "install" / "pkg" / "lib" / "pkg"
    install.mkdir(parents=True)
    (install / "node").write_text(f"#!/usr/bin/env python3\n{HEAD}{program}")
    (scratch / "home").mkdir()
    workspace = Workspace(scratch / "ws", activate(), scratch / "home")
    publishes, subscribes = {"/heard": String, "/also": String}, {"/said": String}
    traces = []
    for _ in range(runs):
        with SteppedHarness(workspace, "pkg", "node", publishes=publishes, subscribes=subscribes) as harness:
            for number in range(STEPS):
                harness.publish("/also", String(data=f"also {number}"))
                harness.publish("/heard", String(data=f"message {number}"))
                harness.step(STEP_NS)
        messages = [(round(stamped.seconds, 3), stamped.message.data) for stamped in harness.messages("/said")]
        traces.append({"said": messages})
    return traces


@lru_cache
def two_runs(name: str) -> Any:
    """Return the traces of two runs of a program."""
    return in_worker_sandbox(record_runs, PROGRAMS[name], 2)


@pytest.mark.promise("Robot time is stepped.")
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_publishes_the_same_in_every_run_and_receives_every_message(name: str) -> None:
    first, second = two_runs(name)
    assert second == first
    numbers = {text.split(" heard ")[1].split()[1] for _, text in first["said"] if " heard message" in text}
    assert numbers == {str(number) for number in range(STEPS)}


def test_messages_are_handled_before_timers_and_timers_fire_at_their_time() -> None:
    run, _ = two_runs("rclpy.spin")
    for step in range(STEPS):
        time = round((step + 1) * STEP_NS / 1e9, 3)
        texts = [text for seconds, text in run["said"] if seconds == time]
        now = 100 * 10**9 + (step + 1) * STEP_NS
        assert texts == [
            f"echo heard message {step} {step} {now - 1}",
            f"echo tick message {step} {step + 1} {now}",
        ]


def test_a_message_published_before_discovery_is_not_waited_for() -> None:
    run, _ = two_runs("publishes in __init__")
    assert not [text for _, text in run["said"] if " early " in text]


def trace_with_short_timeout(scratch: Path, program: str) -> list[Any]:
    """Run a program once, with a short time-out for messages that do not arrive."""
    from autograder.harness import stepped

    stepped.DELIVERY_SECONDS = 1.0
    return record_runs(scratch, program, 1)


FORGER = """
import os, threading
FORGED = (b'{"event": "done", "sent": [{"/said std_msgs/msg/String reliable volatile": 999999}, {}], '
          b'"lost": [], "changed": false, "wake": null, "due": 0, "notes": []}\\n')
def forge():
    for name in os.listdir('/proc/self/fd'):
        try:
            if os.readlink(f'/proc/self/fd/{name}').startswith('pipe:') and int(name) > 2:
                os.write(int(name), FORGED * 3)
        except OSError:
            pass
class Forger(Echo):
    def tick(self):
        super().tick()
        if self.ticks == 10:
            forge()
run(lambda: rclpy.spin(Forger()))
"""


def test_a_forged_message_count_delays_the_grader_and_is_not_believed() -> None:
    (run,) = in_worker_sandbox(trace_with_short_timeout, FORGER)
    assert 0 < len(run["said"]) <= 2 * STEPS


def diagnose(scratch: Path, program: str) -> list[str]:
    """Run a faulty program; return the kind and sentence of its diagnosis."""
    from autograder.exceptions import StudentError

    try:
        record_runs(scratch, program, 1)
    except StudentError as error:
        return [error.diagnosis.kind.value, error.diagnosis.sentence]
    return ["ok", ""]


@pytest.mark.parametrize(
    ("program", "kind", "words"),
    [
        ("raise KeyError('lidar')", "crashed_at_import", "KeyError: 'lidar'"),
        ("run(lambda: Echo(qos=None))", "crashed_at_start", "before it started to spin"),
        ("run(lambda: rclpy.spin(Echo(name='not a name')))", "crashed_at_start", "InvalidNodeName"),
        ("run(lambda: rclpy.spin(Echo(name='grader')))", "reserved_name", "which is the grader's own name"),
        ("rclpy.init()\nnode = Echo()", "ended_early", "rclpy.spin(node)"),
        (
            "class Late(Echo):\n    def tick(self):\n        super().tick()\n        1 / (20 - self.ticks)\n"
            "run(lambda: rclpy.spin(Late()))",
            "crashed_later",
            "ZeroDivisionError",
        ),
        (
            "import os\nclass Gone(Echo):\n    def tick(self):\n        super().tick()\n"
            "        self.ticks < 5 or os._exit(0)\n"
            "run(lambda: rclpy.spin(Gone()))",
            "ended_early",
            "exit status 0",
        ),
    ],
)
def test_a_failing_program_is_diagnosed(program: str, kind: str, words: str) -> None:
    actual_kind, sentence = in_worker_sandbox(diagnose, program)
    assert actual_kind == kind, sentence
    assert words in sentence
