"""Validates a worker's reply, which the client does not trust. It writes nothing until the whole reply is valid."""

from __future__ import annotations

from dataclasses import replace

from autograder.grade.cluster.task import Reply
from autograder.grade.job import Job
from autograder.grade.reply import ReplyError, check_reply
from autograder.grade.store import write_result
from autograder.result.model import Result


def accept(data: object, job: Job, sha256: str) -> Result:
    """Validate a packed `Reply`, store its result and files, and return the result.

    `sha256` is the digest of the submission that was sent. Raises ReplyError, and writes nothing, if the reply does
    not belong to the job or reports that the worker failed.
    """
    reply = Reply.unpack(data)
    if reply.failure:
        raise ReplyError(f"the worker failed: {reply.failure}")
    result = check_reply(reply.files, replace(job, student=""), sha256)  # workers do not know the student's name
    return write_result(job, result, reply.files)
