"""Checks the files from a worker. If students' code takes over a worker, it can harm only its own result."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping

from PIL import Image

from autograder.exceptions import GraderError, UsageError
from autograder.grade.bounded_json import RESULT_VALUES, RUN_VALUES, read_json
from autograder.grade.job import Job
from autograder.grade.store import LOG, NOTEBOOK, RESULT
from autograder.result.model import Result, Status, from_json
from autograder.run.sandbox.limits import MIB

PICTURE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,199}\.png")
RUN = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,199}\.run\.json")
RECORDING = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,199}\.npz")
MAX_PIXELS = 25_000_000
MAX_RESULT = 8 * MIB  # bytes; the results of this course take 0.1 MiB
MAX_PAGE = 64 * MIB  # bytes of all pictures and runs on a page, where a file counts each time that the result names it
_UNREAD = "0" * 64  # the digest in the result of a submission that could not be read


class ReplyError(GraderError):
    """A worker's reply does not match its job."""


def check_reply(files: Mapping[str, bytes], job: Job, sha256: str = "") -> Result:
    """Check the files from a worker, and return the result among them.

    `sha256` is the digest of the submission, if it is known. Raises a ReplyError if the files do not match the job.
    """
    other_files = {name: data for name, data in files.items() if name not in (RESULT, NOTEBOOK, LOG)}
    try:
        result = _result(files.get(RESULT, b""), job, sha256)
        _require_artifacts(other_files, result)
        if NOTEBOOK in files:
            _require_notebook(files[NOTEBOOK])
    except ReplyError:
        raise
    except Exception as error:  # no reply may end the grading of a class
        raise ReplyError(f"a worker's reply cannot be checked: {type(error).__name__}: {str(error)[:1000]}") from None
    return result


def _result(data: bytes, job: Job, sha256: str) -> Result:
    if len(data) > MAX_RESULT:
        raise ReplyError(f"a worker's reply contains a result of {len(data):,} bytes")
    try:
        result = from_json(read_json(data, RESULT_VALUES), source="a worker's reply")
    except (ValueError, UsageError, RecursionError) as error:
        raise ReplyError(f"a worker's reply contains no result: {str(error)[:1000]}") from None
    suite, is_graded = job.suite, result.status is Status.GRADED
    actual_versions = (result.suite_version, result.files_digest)
    expected_versions = (suite.version, suite.files_digest)
    actual = (result.assignment, result.student, *actual_versions, result.seed, result.isolation, result.max_score)
    expected = (suite.assignment, job.student, *expected_versions, job.seed, job.isolation.value, suite.max_score)
    if actual != expected:
        raise ReplyError(f"a worker graded {actual} instead of {expected}")
    if is_graded and sha256 and result.submission_sha256 not in (sha256, _UNREAD):
        raise ReplyError(f"a worker graded {result.submission_sha256} instead of {sha256}")
    suite_checks = [(check.id, check.group, check.points) for check in suite.checks]
    if [(check.id, check.group, check.max_points) for check in result.checks] != suite_checks:
        raise ReplyError("a worker's reply does not contain the checks of the suite")
    if any(not 0 <= check.points <= check.max_points for check in result.checks):
        raise ReplyError("a worker's reply gives more points than a check is worth")
    return result


def _require_artifacts(files: Mapping[str, bytes], result: Result) -> None:
    pictures = {artifact.name for artifact in result.artifacts}
    runs = {artifact.run for artifact in result.artifacts if artifact.run}
    recordings = {name for name in files if RECORDING.fullmatch(name)}  # only a replay requests them
    if set(files) - recordings != pictures | runs:
        raise ReplyError(f"a worker's reply contains {sorted(files)} and its result names {sorted(pictures | runs)}")
    page_files = [name for artifact in result.artifacts for name in (artifact.name, artifact.run) if name]
    if sum(len(files[name]) for name in page_files) > MAX_PAGE:
        raise ReplyError(f"a worker's reply shows its {len(files)} files {len(page_files)} times, which is too much")
    for name, data in files.items():
        if name in recordings:
            continue
        if not (PICTURE if name in pictures else RUN).fullmatch(name):
            raise ReplyError(f"a worker's reply contains a file of the name {name[:100]!r}")
        try:
            _require_picture(data) if name in pictures else _require_run(data)
        except (OSError, SyntaxError, ValueError, RecursionError, Image.DecompressionBombError) as error:
            raise ReplyError(f"the file {name} in a worker's reply cannot be read: {error}") from None


def _require_picture(data: bytes) -> None:
    with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
        width, height = picture.size
        if width * height > MAX_PIXELS:
            raise ValueError(f"it has {width} x {height} pixels")
        picture.verify()


def _require_run(data: bytes) -> None:
    if not isinstance(read_json(data, RUN_VALUES), dict):
        raise ValueError("it is not a run")


def _require_notebook(data: bytes) -> None:
    # nbformat is slow to import, and not needed for a source tree, which has no notebook.
    from autograder.grade.executed_notebook import decode

    try:
        decode(data)
    except (ValueError, RecursionError) as error:
        raise ReplyError(f"the notebook in a worker's reply cannot be read: {error}") from None
