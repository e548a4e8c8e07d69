"""Grades the generated mutants of a chapter, each until a check fails, and stores the results.

Three shortcuts reduce the time for a mutant to about a second. If colcon would only copy the changed file, the built
reference is patched. Checks that only read the sources run before anything is built. Checks that killed earlier mutants
of the same function run first. Before the first mutant, the reference is graded with a patched build and without a
build. Each of these shortcuts is used only for checks that the reference passes with it.
"""

from __future__ import annotations

import json
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from autograder import course_paths
from autograder.author.verification.generated_mutants import GeneratedMutant
from autograder.author.verification.mutants import write_reference
from autograder.author.verification.worker_pool import WorkerPool
from autograder.building.build import build_workspace
from autograder.diagnosis import Kind
from autograder.exceptions import GraderError
from autograder.grade.job import Job, Options
from autograder.grade.parallel import map_parallel
from autograder.grade.pipeline import grade_submission
from autograder.grade.store import LOG
from autograder.result.model import Result, Status
from autograder.ros import activate
from autograder.run.workspace import Workspace
from autograder.suite import Outcome, suites
from autograder.suite.fingerprint import digest

COPIED = (".py", ".yaml")  # the suffixes of files that colcon only copies
NOT_COPIED = ("setup.py",)
MAX_LIKELY = 3  # how many likely killers run before all other checks
FAILED = "not graded"  # the `killer` of a mutant on which the grader failed


@dataclass(frozen=True)
class MutantResult:
    """The result of a mutant.

    Attributes:
        killer: the check that failed, "" if none did, or FAILED if the grader failed.
        error: the last line of the grader's log if the grader failed.
    """

    id: str
    killer: str
    seconds: float
    version: str
    error: str = ""

    @property
    def killed(self) -> bool:
        """Whether a check failed."""
        return self.killer not in ("", FAILED)


class MutationRun:
    """Grades mutants of one chapter.

    Args:
        assignment: the chapter.
        workers: the pool that grades the mutants.
        seed: the seed of all hidden inputs.
        folder: a temporary folder for the built reference.
    """

    def __init__(self, assignment: str, workers: WorkerPool, seed: int, folder: Path) -> None:
        self._suite, self._workers, self._seed, self._folder = suites.hidden(assignment), workers, seed, folder
        self._killers: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
        self._ids = tuple(check.id for check in self._suite.checks)
        for name in ("patched", "unbuilt"):
            write_reference(self._suite.sources, folder / name)
        (folder / "home").mkdir()
        workspace = Workspace(folder / "patched", activate(), folder / "home")
        build_workspace(workspace, self._suite.packages)
        self.shortcuts = {name: self._passed_checks(folder / name) for name in ("patched", "unbuilt")}

    def _passed_checks(self, built_workspace: Path) -> frozenset[str]:
        """Return the checks that the reference passes if this workspace is used instead of a new build."""
        result = self._grade({}, Options(pictures=False, prebuilt=str(built_workspace)))
        return frozenset(check.id for check in result.checks if check.outcome is Outcome.PASSED)

    def run_mutant(self, mutant: GeneratedMutant, version: str = "") -> MutantResult:
        """Grade a mutant until a check fails."""
        start = time.monotonic()
        try:
            killer, error = next(filter(None, self._stages(mutant)), ""), ""
        except GraderError as failure:
            killer, error = FAILED, str(failure)
        result = MutantResult(mutant.id, killer, round(time.monotonic() - start, 2), version, error)
        if result.killed:
            for location in {(mutant.file, mutant.function), (mutant.file, "")}:
                self._killers[location][killer] += 1
        return result

    def _stages(self, mutant: GeneratedMutant) -> Iterator[str]:
        """Grade the mutant in stages, fast checks and likely killers first. Yield the killer of each stage, or ""."""
        texts = mutant.texts()
        in_tests = all("/test/" in file for file in texts)
        # The reference's own tests would kill many mutants, but a student has other tests.
        eligible_checks = frozenset(self._ids).difference(() if in_tests else self._suite.own_tests)
        is_copied = all(file.endswith(COPIED) and not file.endswith(NOT_COPIED) for file in texts)
        shortcut = "patched" if is_copied else "unbuilt"
        applicable_checks = self.shortcuts[shortcut] & eligible_checks
        likely_killers = self._find_likely_killers(mutant) & applicable_checks if is_copied else applicable_checks
        prebuilt = str(self._folder / shortcut)
        if likely_killers:
            yield self._find_killer(texts, self._suite.with_dependencies(*likely_killers), prebuilt)
        if is_copied and applicable_checks - likely_killers:
            yield self._find_killer(texts, self._suite.with_dependencies(*applicable_checks), prebuilt)
        if eligible_checks - applicable_checks:
            yield self._find_killer(texts, self._suite.with_dependencies(*eligible_checks), "")

    def _find_likely_killers(self, mutant: GeneratedMutant) -> frozenset[str]:
        killers = self._killers[mutant.file, mutant.function] or self._killers[mutant.file, ""]
        return frozenset(name for name, _ in killers.most_common(MAX_LIKELY))

    def _find_killer(self, texts: dict[str, str], only: tuple[str, ...], prebuilt: str) -> str:
        result = self._grade(texts, Options(only=only, exit_first=True, pictures=False, prebuilt=prebuilt))
        if result.unjudged:
            raise GraderError(f"errors in the checks {', '.join(result.unjudged)}")
        failed_ids = [check.id for check in result.checks if check.outcome is Outcome.FAILED]
        return failed_ids[0] if failed_ids else "" if result.diagnosis.kind is Kind.OK else result.diagnosis.kind.value

    def _grade(self, texts: dict[str, str], options: Options) -> Result:
        """Grade the reference with some files replaced.

        Raises:
            GraderError: the grader failed.
        """
        with tempfile.TemporaryDirectory(prefix="mutant-") as name:
            folder = Path(name)
            write_reference(self._suite.sources, folder / "mutant")
            for file, text in texts.items():
                (folder / "mutant" / "src" / file).write_text(text, encoding="utf-8")
            assignment, isolation = self._suite.assignment, self._workers.isolation
            job = Job(folder / "mutant", assignment, "mutant", self._seed, folder / "out", isolation, options)
            result = grade_submission(job, self._workers)
            if result.status is not Status.GRADED:
                raise GraderError((job.out / LOG).read_text(encoding="utf-8").strip().rpartition("\n")[2])
            return result


def run_mutants(
    assignment: str,
    mutants: Iterable[GeneratedMutant],
    workers: WorkerPool,
    *,
    seed: int,
    cache: Path,
    on_result: Callable[[MutantResult], None],
) -> tuple[MutantResult, ...]:
    """Grade mutants of a chapter, and return their results.

    `cache` is a file of results. A stored result is reused if the suite and the reference are unchanged, so that an
    interrupted run can continue. Each new result is appended to the file and passed to `on_result`.
    """
    version, all_mutants = _version(assignment), list(mutants)
    lines = cache.read_text(encoding="utf-8").splitlines() if cache.is_file() else []
    stored_results = {
        result.id: result
        for result in (MutantResult(**json.loads(line)) for line in lines)
        if result.version == version
    }
    missing_mutants = [mutant for mutant in all_mutants if mutant.id not in stored_results]
    cache.parent.mkdir(parents=True, exist_ok=True)
    with cache.open("a", encoding="utf-8") as file:

        def append(result: MutantResult) -> None:
            if result.killer != FAILED:
                file.write(json.dumps(asdict(result)) + "\n")
                file.flush()
            on_result(result)

        new_results: tuple[MutantResult, ...] = ()
        if missing_mutants:
            with prepared_run(assignment, workers, seed) as run:
                new_results = map_parallel(
                    lambda mutant: run.run_mutant(mutant, version), missing_mutants, jobs=workers.count, on_done=append
                )
    by_id = stored_results | {result.id: result for result in new_results}
    return tuple(by_id[mutant.id] for mutant in all_mutants)


@contextmanager
def prepared_run(assignment: str, workers: WorkerPool, seed: int) -> Iterator[MutationRun]:
    """Yield a mutation run of a chapter that uses a temporary folder."""
    with tempfile.TemporaryDirectory(prefix="mutation-run-") as name:
        yield MutationRun(assignment, workers, seed, Path(name))


def _version(assignment: str) -> str:
    """Return a digest of the files of the suite and the reference."""
    suite = suites.hidden(assignment)
    return digest(
        assignment, (*suite.reads, *(f"{course_paths.course().solutions}/{source}" for source in suite.sources))
    )
