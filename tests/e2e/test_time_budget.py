"""A submission whose programs keep the grader waiting uses up its time once, and still gets a result."""

from __future__ import annotations

from pathlib import Path

from autograder.author.verification.mutants import write_reference
from autograder.diagnosis import Kind
from autograder.grade import grade_submission, own_sandbox
from autograder.grade.job import Job
from autograder.result.model import Status
from autograder.run.sandbox.worker_sandbox import WorkerReport
from autograder.suite import Outcome

SLOW = "import rclpy.publisher, time\n_publish = rclpy.publisher.Publisher.publish\n" + (
    "rclpy.publisher.Publisher.publish = lambda self, message: (time.sleep(2.5), _publish(self, message))[1]\n"
)


def test_a_node_that_sleeps_in_each_publish_gets_a_result_within_one_budget(tmp_path: Path) -> None:
    write_reference(("my_robot_package",), tmp_path / "alice")
    node = next((tmp_path / "alice").rglob("robot_controller.py"))
    lines = node.read_text().splitlines(keepends=True)
    start = next(number for number, line in enumerate(lines) if line.startswith("class "))
    node.write_text("".join([*lines[:start], SLOW, "\n\n", *lines[start:]]))
    budgets = []

    def run(job: Job) -> WorkerReport:
        budgets.append(job.seconds)
        return own_sandbox.run_in_own_sandbox(job)

    job = Job(tmp_path / "alice", "02_nodes", "alice", 3, tmp_path / "out", seconds=30.0)
    result = grade_submission(job, run)
    assert budgets == [30.0]
    assert result.status is Status.GRADED
    # The kind depends on what the grader waited for last.
    assert result.diagnosis.kind in (Kind.TIMED_OUT, Kind.STUCK, Kind.NEVER_STARTED)
    assert any(check.outcome is not Outcome.PASSED for check in result.checks)
