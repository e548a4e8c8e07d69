"""Grades test cases and compares each result with the expected one."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

from autograder import course_paths
from autograder.author.verification.cases import Case
from autograder.author.verification.check_errors import errors_in_checks
from autograder.author.verification.leaks import hidden_text_in, texts_of
from autograder.author.verification.verdicts import CaseKind, Verdict, hidden_lines
from autograder.author.verification.worker_pool import WorkerPool
from autograder.grade.batch import stored_result
from autograder.grade.job import Job
from autograder.grade.own_sandbox import run_in_own_sandbox
from autograder.grade.parallel import map_parallel
from autograder.grade.pipeline import grade_submission
from autograder.grade.store import LOG
from autograder.report import feedback
from autograder.result.model import Result, Status

SUBMISSION = "submission"
PARTIAL = "part"  # the folder for the result if only a part of the suite was run


def verify_cases(
    cases: Sequence[Case],
    *,
    seed: int,
    out: Path,
    workers: WorkerPool,
    on_verdict: Callable[[Verdict], None] = lambda verdict: None,
) -> tuple[Verdict, ...]:
    """Grade test cases with all workers of a pool.

    Args:
        cases: test cases of one or several assignments, from the module `cases`.
        seed: the seed of all hidden inputs.
        out: the folder for the results; each result goes to `out`/ASSIGNMENT/NAME. A stored result is reused if the
            whole suite was run, and the submission, the seed and the grader's files are unchanged.
        workers: the pool that grades the submissions.
        on_verdict: a function that is called with each verdict as soon as it is known, in any order.

    Returns:
        The verdicts, in the order of `cases`.
    """

    def grade(case: Case) -> Verdict:
        with tempfile.TemporaryDirectory(prefix="verification-") as name:
            path, folder = _write_case(case, Path(name) / case.name), out / case.assignment / case.name
            is_whole_suite = not case.options.only
            folder = folder if is_whole_suite else folder / PARTIAL
            job = Job(path, case.assignment, case.name, seed, folder, workers.isolation, case.options)
            result = stored_result(job) if is_whole_suite else None
            if result is None or result.files_digest != job.suite.files_digest:  # the grader has changed
                result = grade_submission(job, run_in_own_sandbox if case.kind is CaseKind.ATTACK else workers)
        mismatch = case.verify(result) if result.status is Status.GRADED else result.diagnosis.sentence
        if case.kind is CaseKind.ATTACK:
            mismatch = "; ".join(filter(None, (mismatch, _describe_leak(result, folder))))
        log = folder / LOG
        if result.unjudged or result.status is Status.NOT_GRADED:
            text = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
            errors = errors_in_checks(text, course_paths.CHECKS)
            if failures := "; ".join(errors) or ", ".join(result.unjudged):
                mismatch = f"checks raised errors: {failures}; {log} has the details"
        return Verdict(case.assignment, case.kind, case.name, result, mismatch, case.options.only)

    verdicts = map_parallel(grade, _interleave(cases), jobs=workers.count, on_done=on_verdict)
    by_name = {(verdict.assignment, verdict.name): verdict for verdict in verdicts}
    return tuple(by_name[case.assignment, case.name] for case in cases)


def _describe_leak(result: Result, folder: Path) -> str:
    """Describe hidden text that the student could read in the result, the feedback page or the files beside them."""
    feedback.write(result, folder)
    lines = hidden_lines(result.assignment)
    leaked_texts = [word for text in texts_of(folder) for word in hidden_text_in(text, lines)]
    return f"shows hidden text: {leaked_texts[0]}" if leaked_texts else ""


def _interleave(cases: Sequence[Case]) -> list[Case]:
    """Interleave the cases of the assignments, because the programs of some mostly wait and those of others compute."""
    totals, counts = Counter(case.assignment for case in cases), Counter[str]()
    positions = []
    for case in cases:
        counts[case.assignment] += 1
        positions.append(counts[case.assignment] / totals[case.assignment])
    return [case for _, case in sorted(zip(positions, cases, strict=True), key=lambda pair: pair[0])]


def _write_case(case: Case, folder: Path) -> Path:
    """Write a case to `folder`, and return the path of its submission."""
    case.write(folder)
    return folder / SUBMISSION if (folder / SUBMISSION).is_dir() else folder
