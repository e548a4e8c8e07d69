"""Checks a worker's answer, which the client does not trust. It writes nothing before every check has passed."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Mapping
from dataclasses import replace

from PIL import Image

from autograder.checks import suites
from autograder.cluster.exceptions import AnswerError
from autograder.cluster.parcel import Answer
from autograder.exceptions import UsageError
from autograder.grading.batch import GradingRequest
from autograder.grading.pipeline import not_graded
from autograder.grading.store import LOG, NOTEBOOK, RESULT, new_result
from autograder.result import Result, Status, from_json, write_json

PICTURE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,199}\.png")
RUN = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,199}\.run\.json")
MAX_PIXELS = 25_000_000


def accept(data: object, request: GradingRequest, sha256: str) -> Result:
    """Check a worker's answer, a packed `Answer`; write its files to the request's folder, and return the result.

    `sha256` is the digest of the submission that was sent. Raises AnswerError if the answer is none to the request, or
    says that the worker failed. Nothing is written then.
    """
    answer = Answer.unpack(data)
    if answer.failure:
        raise AnswerError(f"the worker failed: {answer.failure}")
    files = dict(answer.files)
    result = _result(files.pop(RESULT, b""), request, sha256)
    _require_artifacts({name: content for name, content in files.items() if name not in (NOTEBOOK, LOG)}, result)
    if NOTEBOOK in files:
        _require_notebook(files[NOTEBOOK])
    return write(result, request, files)


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


def _result(data: bytes, request: GradingRequest, sha256: str) -> Result:
    try:
        result = from_json(json.loads(data), source="a worker's answer")
    except (ValueError, UsageError, RecursionError) as error:
        raise AnswerError(f"a worker's answer holds no result: {error}") from None
    suite = suites.hidden(request.assignment)
    graded = result.status is Status.GRADED
    versions, theirs = (suite.version, suite.files_digest), (result.suite_version, result.files_digest)
    graded_as = (result.assignment, *theirs, result.seed, result.isolation, result.max_score)
    asked = (request.assignment, *versions, request.seed, request.isolation.value, suite.max_score)
    if graded_as != asked or (graded and result.submission_sha256 not in (sha256, "0" * 64)):
        raise AnswerError(f"a worker graded {(*graded_as, result.submission_sha256)} instead of {(*asked, sha256)}")
    worth = [(check.id, check.group, check.points) for check in suite.checks]
    if [(check.id, check.group, check.max_points) for check in result.checks] != worth:
        raise AnswerError("a worker's answer does not hold the checks of the suite")
    if any(not 0 <= check.points <= check.max_points for check in result.checks):
        raise AnswerError("a worker's answer gives more points than a check is worth")
    return result


def _require_artifacts(files: Mapping[str, bytes], result: Result) -> None:
    pictures = {artifact.name for artifact in result.artifacts}
    runs = {artifact.run for artifact in result.artifacts if artifact.run}
    if set(files) != pictures | runs:
        raise AnswerError(f"a worker's answer holds {sorted(files)} and its result names {sorted(pictures | runs)}")
    for name, data in files.items():
        if not (PICTURE if name in pictures else RUN).fullmatch(name):
            raise AnswerError(f"a worker's answer holds a file of the name {name[:100]!r}")
        try:
            _require_picture(data) if name in pictures else _require_run(data)
        except (OSError, SyntaxError, ValueError, RecursionError, Image.DecompressionBombError) as error:
            raise AnswerError(f"the file {name} in a worker's answer cannot be read: {error}") from None


def _require_picture(data: bytes) -> None:
    with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
        width, height = picture.size
        if width * height > MAX_PIXELS:
            raise ValueError(f"it has {width} x {height} pixels")
        picture.verify()


def _require_run(data: bytes) -> None:
    if not isinstance(json.loads(data.decode()), dict):
        raise ValueError("it is no run")


def _require_notebook(data: bytes) -> None:
    import nbformat  # slow to import, and a source tree has no notebook

    try:
        nbformat.reads(data.decode(), as_version=4)
    except Exception as error:  # nbformat's own errors have no common base
        raise AnswerError(f"the notebook in a worker's answer cannot be read: {error}") from None
