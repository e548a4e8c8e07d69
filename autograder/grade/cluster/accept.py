"""Checks a worker's answer, which the client does not trust. It writes nothing before every check has passed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from autograder.grade import answer as local
from autograder.grade.answer import Asked
from autograder.grade.batch import GradingRequest
from autograder.grade.cluster.exceptions import AnswerError
from autograder.grade.cluster.parcel import Answer
from autograder.grade.pipeline import not_graded
from autograder.grade.store import LOG, RESULT, new_result
from autograder.result.model import Result, write_json
from autograder.suite import suites


def accept(data: object, request: GradingRequest, sha256: str) -> Result:
    """Check a worker's answer, a packed `Answer`; write its files to the request's folder, and return the result.

    `sha256` is the digest of the submission that was sent. Raises AnswerError if the answer is none to the request, or
    says that the worker failed. Nothing is written then.
    """
    answer = Answer.unpack(data)
    if answer.failure:
        raise AnswerError(f"the worker failed: {answer.failure}")
    asked = Asked(suites.hidden(request.assignment), "", request.seed, request.isolation.value, sha256)
    try:
        result = local.checked(answer.files, asked)
    except local.AnswerError as error:
        raise AnswerError(str(error)) from None
    return write(result, request, {name: content for name, content in answer.files.items() if name != RESULT})


def give_up(request: GradingRequest, why: str, log: str) -> Result:
    """Write and return the result of a submission that the cluster did not grade.

    `why` is a sentence for the result, `log` what an instructor reads beside it.
    """
    suite, files = suites.hidden(request.assignment), {LOG: log.encode("utf-8", "backslashreplace")}
    return write(not_graded(suite, request.student, request.seed, request.isolation, why), request, files)


def write(result: Result, request: GradingRequest, files: Mapping[str, bytes] = {}) -> Result:
    """Write files and the result with the student's name, which is not sent to workers."""
    named = replace(result, student=request.student)
    with new_result(request.out) as folder:
        for name, content in files.items():
            (folder / name).write_bytes(content)
        write_json(folder / RESULT, named.to_json())
    return named
