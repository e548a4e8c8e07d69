"""Grading the submissions of the proof, and judging the grader by them."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

from autograder.grading.parallel import map_parallel
from autograder.grading.pipeline import grade_submission
from autograder.proof.cases import Case
from autograder.proof.claims import Claim
from autograder.proof.lanes import Lanes

SUBMISSION = "submission"


def prove(
    proof: Sequence[Case], *, seed: int, out: Path, lanes: Lanes, on_claim: Callable[[Claim], None] = lambda claim: None
) -> tuple[Claim, ...]:
    """Grade the submissions of a proof, all lanes at work until there are no more.

    Args:
        proof: from `cases`, of one assignment or of several.
        seed: every hidden input is drawn from it.
        out: `out`/ASSIGNMENT/NAME gets each submission's result.
        lanes: where they are graded.
        on_claim: called for each claim as it comes, in any order.

    Returns:
        The claims, in the order of `proof`.
    """

    def judged(case: Case) -> Claim:
        with tempfile.TemporaryDirectory(prefix="proof-") as name:
            result = grade_submission(
                _written(case, Path(name) / case.name),
                case.assignment,
                student=case.name,
                seed=seed,
                out=out / case.assignment / case.name,
                isolation=lanes.tier,
                scope=case.scope,
                run_job=lanes,
            ).result
        return Claim(case.assignment, case.kind, case.name, result, case.judge(result), case.reason)

    claims = map_parallel(judged, _mixed(proof), jobs=lanes.count, on_done=on_claim)
    found = {(claim.assignment, claim.name): claim for claim in claims}
    return tuple(found[case.assignment, case.name] for case in proof)


def _mixed(proof: Sequence[Case]) -> list[Case]:
    """Return the order to grade in, all assignments side by side: while some wait, the others have the processor."""
    counts, seen = Counter(case.assignment for case in proof), Counter[str]()
    places = []
    for case in proof:
        seen[case.assignment] += 1
        places.append(seen[case.assignment] / counts[case.assignment])
    return [case for _, case in sorted(zip(places, proof, strict=True), key=lambda pair: pair[0])]


def _written(case: Case, folder: Path) -> Path:
    """Write a case; return where its submission lies."""
    case.write(folder)
    return folder / SUBMISSION if (folder / SUBMISSION).is_dir() else folder
