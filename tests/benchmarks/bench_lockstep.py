"""How many steps a second the grader makes with a 10 Hz node: the reference controller, a scan of 360 beams each step.

The node runs in its sandbox, the grader's side in a cell, as in grading.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from pathlib import Path

from autograder.sandbox import Tier
from autograder.sandbox.cell import run_in_cell

STEPS = 2000
RUNS = 5


def figures() -> dict[str, float]:
    """Return `lockstep.steps_per_s`, the median of several runs."""
    report = run_in_cell(
        lambda scratch: [sys.executable, "-m", "tests.benchmarks.bench_lockstep", str(scratch)], Tier.BUBBLEWRAP
    )
    if report.returncode != 0:
        raise RuntimeError(report.output)
    return {"lockstep.steps_per_s": round(statistics.median(json.loads(report.output.splitlines()[-1])), 1)}


def measure(scratch: Path) -> list[float]:
    """Build the reference in a cell's scratch folder and step its controller; steps a second, one figure a run."""
    from autograder.ros import activate

    ros = activate()
    from autograder.grading.build import build
    from autograder.lab import Workspace
    from autograder.suites.mutants import lay_down_reference
    from autograder.visible.ch02_nodes.robot import Robot
    from autograder.visible.ch02_nodes.scans import scan

    (scratch / "home").mkdir()
    workspace = Workspace(scratch / "ws", ros, scratch / "home")
    lay_down_reference(("my_robot_package",), workspace.root)
    build(workspace, ("my_robot_package",))
    message = scan()
    rates = []
    for _ in range(RUNS):
        with Robot(workspace) as robot:
            began = time.perf_counter()
            for _ in range(STEPS):
                robot.show(message)
            rates.append(STEPS / (time.perf_counter() - began))
            if len(robot.messages("/cmd_vel")) != STEPS:
                raise RuntimeError("the node did not answer every step")
    return rates


if __name__ == "__main__":
    print(json.dumps(measure(Path(sys.argv[1]))))
