"""A job is passed to the worker as JSON."""

from __future__ import annotations

from pathlib import Path

from autograder.grade.job import Job, Options
from autograder.run.sandbox import Isolation


def test_a_job_survives_conversion_to_json(tmp_path: Path) -> None:
    options = Options(("starts", "ten_hertz"), exit_first=True, pictures=False)
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    job = Job(tmp_path / "größe 漢", "02_nodes", "Zoë", 7, out, Isolation.PROCESS, options, 450.0, scratch)
    assert Job.from_json(job.to_json()) == job
