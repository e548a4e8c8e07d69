"""Measure the steps per second in lockstep, with one node and with three that exchange messages.

The single node is the reference controller at 10 Hz, which gets a scan of 360 beams in each step. The three nodes pass
each step's message on to the next node, and finally to the grader. The nodes run in sandboxes, and the grader in a
worker sandbox, as in a grading.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from pathlib import Path
from typing import Any

from autograder.course_paths import ROOT
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox

STEPS = 2000
CHAIN_STEPS = 500
RUNS = 5
# A worker sandbox's process starts in /, where Python would not find this module.
RUN = f"""
import json, sys
from pathlib import Path
sys.path[0] = {str(ROOT)!r}
from tests.benchmarks.bench_lockstep import measure
print(json.dumps(measure(Path(sys.argv[1]))))
"""
CHAIN = ("first", "second", "third")
RELAY = """#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
class Relay(Node):
    def __init__(self):
        super().__init__('{name}')
        self.out = self.create_publisher(String, '{out}', 10)
        self.create_subscription(String, '{source}', self.out.publish, 10)
        self.create_timer(0.1, lambda: None)
rclpy.init()
try:
    rclpy.spin(Relay())
except KeyboardInterrupt:
    pass
"""


def figures() -> dict[str, float]:
    """Return `lockstep.steps_per_s` and `lockstep.three_programs_steps_per_s`, each the median of several runs."""
    report = run_in_worker_sandbox(lambda scratch: [sys.executable, "-c", RUN, str(scratch)], Isolation.BUBBLEWRAP)
    if report.returncode != 0:
        raise RuntimeError(report.output)
    rates = json.loads(report.output.splitlines()[-1])
    return {name: round(statistics.median(runs), 1) for name, runs in rates.items()}


def measure(scratch: Path) -> dict[str, list[float]]:
    """Return the steps per second of each run; this function runs in a worker sandbox."""
    from autograder.ros import activate

    ros = activate()
    from autograder.harness import Workspace

    (scratch / "home").mkdir()
    return {
        "lockstep.steps_per_s": _measure_one_node(Workspace(scratch / "one", ros, scratch / "home")),
        "lockstep.three_programs_steps_per_s": _measure_three_nodes(
            Workspace(scratch / "three", ros, scratch / "home")
        ),
    }


def _measure_one_node(workspace: Any) -> list[float]:
    from autograder.author.verification.mutants import write_reference
    from autograder.building.build import build
    from autograder.checks.ch02_nodes.support.robot import Robot
    from autograder.checks.ch02_nodes.support.scans import scan

    write_reference(("my_robot_package",), workspace.root)
    build(workspace, ("my_robot_package",))
    message = scan()
    rates = []
    for _ in range(RUNS):
        with Robot(workspace) as robot:
            start = time.perf_counter()
            for _ in range(STEPS):
                robot.show(message)
            rates.append(STEPS / (time.perf_counter() - start))
            if len(robot.messages("/cmd_vel")) != STEPS:
                raise RuntimeError("the node did not answer every step")
    return rates


def _measure_three_nodes(workspace: Any) -> list[float]:
    from std_msgs.msg import String

    from autograder.harness import Program, SteppedHarness

    folder = workspace.install / "chain" / "lib" / "chain"
    folder.mkdir(parents=True)
    topics = ("in", *CHAIN)
    for source, name in zip(topics, CHAIN, strict=False):
        (folder / name).write_text(RELAY.format(name=name, source=source, out=name))
    programs = tuple(Program("chain", name) for name in CHAIN)
    rates = []
    for _ in range(RUNS):
        with SteppedHarness(
            workspace, programs=programs, publishes={"/in": String}, subscribes={"/third": String}
        ) as harness:
            start = time.perf_counter()
            for number in range(CHAIN_STEPS):
                harness.publish("/in", String(data=str(number)))
                harness.step(harness.tick_ns)
            rates.append(CHAIN_STEPS / (time.perf_counter() - start))
            if len(harness.messages("/third")) != CHAIN_STEPS:
                raise RuntimeError("the chain did not pass on every message")
    return rates
