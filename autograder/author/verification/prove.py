"""Grades the submissions of the proof and compares each result with the expected one."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

from autograder.author.verification.cases import Case
from autograder.author.verification.claims import CaseKind, Claim, hidden_lines
from autograder.author.verification.leaks import found_in, texts_of
from autograder.author.verification.worker_pool import WorkerPool
from autograder.grade.batch import stored
from autograder.grade.job import Job
from autograder.grade.own_cell import in_own_cell
from autograder.grade.parallel import map_parallel
from autograder.grade.pipeline import grade_submission
from autograder.grade.store import LOG
from autograder.report import feedback
from autograder.result.model import Result, Status

SUBMISSION = "submission"
PART = "part"  # the folder of a result for which not the whole suite was run


def prove(
    proof: Sequence[Case],
    *,
    seed: int,
    out: Path,
    workers: WorkerPool,
    on_claim: Callable[[Claim], None] = lambda claim: None,
) -> tuple[Claim, ...]:
    """Grade the submissions of a proof with all workers of a pool.

    Args:
        proof: submissions of one or several assignments, from `cases`.
        seed: seed of every hidden input.
        out: folder of the results; each submission's result goes to `out`/ASSIGNMENT/NAME. A result that lies there
            counts if the same submission, files of the grader and seed made it, and the whole suite was run.
        workers: the pool that grades.
        on_claim: function that is called with each claim as soon as it is known, in any order.

    Returns:
        The claims, in the order of `proof`.
    """

    def graded(case: Case) -> Claim:
        with tempfile.TemporaryDirectory(prefix="proof-") as name:
            path, place = _write(case, Path(name) / case.name), out / case.assignment / case.name
            whole = not case.scope.only
            place = place if whole else place / PART
            job = Job(path, case.assignment, case.name, seed, place, workers.tier, case.scope)
            result = stored(job) if whole else None
            if result is None or result.files_digest != job.suite.files_digest:  # the proof is of these very files
                result = grade_submission(job, in_own_cell if case.kind is CaseKind.ATTACK else workers)
        mismatch = case.verify(result) if result.status is Status.GRADED else result.diagnosis.sentence
        if case.kind is CaseKind.ATTACK:
            mismatch = "; ".join(filter(None, (mismatch, _shown(result, place))))
        if result.unjudged:
            mismatch = f"checks raised errors of their own: {', '.join(result.unjudged)}; {place / LOG} says which"
        return Claim(case.assignment, case.kind, case.name, result, mismatch)

    claims = map_parallel(graded, _interleaved(proof), jobs=workers.count, on_done=on_claim)
    found = {(claim.assignment, claim.name): claim for claim in claims}
    return tuple(found[case.assignment, case.name] for case in proof)


def _shown(result: Result, place: Path) -> str:
    """Return what hidden text a student gets: in the result, on the feedback page, and in whatever lies beside them."""
    feedback.write(result, place)
    lines = hidden_lines(result.assignment)
    leaked = [word for text in texts_of(place) for word in found_in(text, lines)]
    return f"shows hidden text: {leaked[0]}" if leaked else ""


def _interleaved(proof: Sequence[Case]) -> list[Case]:
    """Return the cases with the assignments interleaved: while some wait, others use the processor."""
    counts, seen = Counter(case.assignment for case in proof), Counter[str]()
    places = []
    for case in proof:
        seen[case.assignment] += 1
        places.append(seen[case.assignment] / counts[case.assignment])
    return [case for _, case in sorted(zip(places, proof, strict=True), key=lambda pair: pair[0])]


def _write(case: Case, folder: Path) -> Path:
    """Write a case to `folder`, and return the path of its submission."""
    case.write(folder)
    return folder / SUBMISSION if (folder / SUBMISSION).is_dir() else folder
