"""Checks a worker's answer, which the client does not trust. It writes nothing before every check has passed."""

from __future__ import annotations

from dataclasses import replace

from autograder.grade.answer import AnswerError, checked
from autograder.grade.cluster.parcel import Answer
from autograder.grade.job import Job
from autograder.grade.store import write_result
from autograder.result.model import Result


def accept(data: object, job: Job, sha256: str) -> Result:
    """Check a worker's answer, a packed `Answer`; store its result and its files, and return the result.

    `sha256` is the digest of the submission that was sent. Raises AnswerError if the answer is none to the job, or says
    that the worker failed. Nothing is written then.
    """
    answer = Answer.unpack(data)
    if answer.failure:
        raise AnswerError(f"the worker failed: {answer.failure}")
    result = checked(answer.files, replace(job, student=""), sha256)  # workers are not told the student's name
    return write_result(job, result, answer.files)
