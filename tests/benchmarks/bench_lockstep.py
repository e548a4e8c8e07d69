"""Measure the steps per second in lockstep, and how often programs run in a grading of the capstone's reference.

The steps are those of one node, and of three that exchange messages. The single node is the reference controller at
10 Hz, which gets a scan of 360 beams in each step. The three nodes pass each step's message on to the next node, and
finally to the grader. The nodes run in sandboxes, and the grader in a worker sandbox, as in a grading.
"""

from __future__ import annotations

import statistics
import time
from pathlib import Path
from typing import Any
from unittest.mock import patch

from tests.e2e.sandbox_support import in_worker_sandbox

STEPS = 2000
CHAIN_STEPS = 500
RUNS = 5
CAPSTONE = "08_capstone"
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
    """Return steps per second, each the median of several runs, and `lockstep.activations_capstone`.

    The latter is how often lockstep runs one of the programs in a grading. It is the same in each grading.
    """
    rates = in_worker_sandbox(measure)
    return {
        **{name: round(statistics.median(runs), 1) for name, runs in rates.items()},
        "lockstep.activations_capstone": in_worker_sandbox(count_activations),
    }


def measure(scratch: Path) -> dict[str, list[float]]:
    """Return the steps per second of each run; this function runs in a worker sandbox."""
    from autograder.harness import Workspace
    from autograder.ros import activate

    ros = activate()
    (scratch / "home").mkdir()
    return {
        "lockstep.steps_per_s": _measure_one_node(Workspace(scratch / "one", ros, scratch / "home")),
        "lockstep.three_programs_steps_per_s": _measure_three_nodes(
            Workspace(scratch / "three", ros, scratch / "home")
        ),
    }


def count_activations(scratch: Path) -> int:
    """Return the activations in a grading of the capstone's reference; this function runs in a worker sandbox."""
    from autograder.author.verification.mutants import write_reference
    from autograder.grade import DEFAULT_SEED
    from autograder.grade.job import Job
    from autograder.grade.worker import Grading
    from autograder.run.lockstep import Stepper

    job = Job(scratch / "reference", CAPSTONE, "reference", DEFAULT_SEED, scratch / "out", scratch=scratch)
    write_reference(job.suite.sources, job.path)
    with patch.object(Stepper, "step", autospec=True, side_effect=Stepper.step) as step:
        result = Grading(job).grade()
    if result.score != result.max_score:
        raise RuntimeError(f"the reference has {result.score:g} of {result.max_score:g} points")
    return step.call_count


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
