"""All runs of a student's tests: first on a correct version, then on correct and faulty versions in a drawn order.

Correct and faulty versions are mixed and run in the same way, so a test cannot tell them apart by the time or the
circumstances of its run. A test that fails on the first correct version does not run again. If other tests fail on
another correct version, all runs are repeated without these tests, on newly created versions. The failure of the
remaining tests on a faulty version counts only if they pass on all correct versions.

Tests of the node and of the launch file have deadlines, which even a correct test can miss on a busy machine. So their
failure on a correct version counts if they fail on it twice.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property

from autograder.checking import CheckFailed, CheckRow, Workspace, expect
from autograder.checking.probes import colcon_test, student_test_reports, student_test_runs
from autograder.checks.ch06_testing.hidden.faults import (
    STYLES,
    Fault,
    correct_version,
    faults,
    faulty_version,
    minimal_version,
    reworded_version,
)
from autograder.checks.ch06_testing.support.assertions import describe_failure, is_usable
from autograder.checks.ch06_testing.support.contract import (
    GIVEN_TESTS,
    GUARD,
    LAUNCH,
    LIMITS,
    MIN_TESTS,
    PACKAGE,
    PYTEST,
)

RIGHT_CHECKS = {LIMITS: "limits_right", GUARD: "guard_right", LAUNCH: "launch_right"}
FILES = {
    **{check: name for name, check in RIGHT_CHECKS.items()},
    **dict.fromkeys(
        ("limits_pass", "stop", "slow", "clear", "infinity", "unknown", "back", "chosen", "refused"), LIMITS
    ),
    **dict.fromkeys(("guard_pass", "alone", "nothing_left", "name", "first_distance", "newest", "turn"), GUARD),
    **dict.fromkeys(("one_answer", "parameters", "sensor_qos", "stale", "watchdog"), GUARD),
    **dict.fromkeys(("launch_pass", "configuration", "runs"), LAUNCH),
    "no_sleep": GUARD,
}
COLCON, ENDS = frozenset(("colcon", "linters")), "ends"
ALL_FILES = COLCON | {"as_given", ENDS}  # checks that need the tests of all three files
CORRECT_VERSIONS = SECOND, REWORDED, BARE, BACKWARDS = "second", "reworded", "bare", "backwards"
BRIEF_FAULTS = frozenset({"believes_distances_too_long"})  # short-lived faults, which a slow run may miss
WITH_DEADLINES = (GUARD, LAUNCH)  # files whose tests wait for answers
ORDER_INDEPENDENT = (LIMITS, GUARD)  # files whose tests also have to pass in the opposite order


@dataclass(frozen=True, kw_only=True)
class Line(CheckRow):
    """A line of the contract. Its check tests whether a student's tests fail on versions that break the line.

    Attributes:
        promise: the text of the line, which ends the check's message.
    """

    promise: str
    doc: str = PYTEST


class Examination:
    """The runs of a submission's tests. Each takes place once, when a check first needs it.

    Args:
        workspace: the student's workspace.
        seed: determines styles, obfuscations and the order of the runs.
        checks: the ids of the checks that need runs. Runs that only other checks need do not take place.
    """

    def __init__(self, workspace: Workspace, seed: int, checks: frozenset[str]) -> None:
        self._workspace = workspace
        self._seed = seed
        self._checks = checks
        self._second_trials: dict[str, dict[str, student_test_reports.Report]] = {}
        self._reruns: dict[str, dict[str, student_test_reports.Report]] = {}

    @cached_property
    def source(self) -> student_test_reports.Source:
        """The student's package, read before `colcon test` runs its code, which may change the folder."""
        return student_test_runs.read_source(self._workspace, PACKAGE)

    @cached_property
    def trial(self) -> dict[str, student_test_reports.Report]:
        """The reports of each file's tests on a correct version. Network traffic of the node's tests is captured."""
        needed_files = {FILES[check] for check in self._checks if check in FILES}
        runs = {
            name: student_test_reports.TestRun(
                (name,), correct_version(STYLES[0], self._draw(name)), sniffed=name == GUARD, is_public=True
            )
            for name in MIN_TESTS
            if (name in needed_files or self._checks & ALL_FILES) and name in self.source.tests
        }
        reports = dict(zip(runs, self._run(list(runs.values())), strict=True))
        late = [name for name in WITH_DEADLINES if name in reports and reports[name].failed]
        return reports | dict(zip(late, self._run([runs[name] for name in late]), strict=True))

    @cached_property
    def runs(self) -> dict[tuple[str, str], student_test_reports.Report]:
        """The reports of all other runs, by file and purpose."""
        runs: dict[tuple[str, str], student_test_reports.TestRun] = {}
        # The slowest files come first. This order reveals nothing: a test knows its own file.
        for name in (name for name in reversed(MIN_TESTS) if is_usable(name, self.trial.get(name))):
            file_runs = self._plan(name, self.trial[name].failed)
            purposes = sorted(file_runs)
            self._draw(name, "order").shuffle(purposes)
            runs |= {(name, purpose): file_runs[purpose] for purpose in purposes}
        with ThreadPoolExecutor(1) as executor:  # in parallel, because colcon spends most of its time waiting
            if self._checks & COLCON:
                executor.submit(lambda: self.colcon)
            return dict(zip(runs, self._run(list(runs.values())), strict=True))

    @cached_property
    def colcon(self) -> student_test_reports.Report:
        """The report of `colcon test` on the student's own package."""
        return colcon_test.colcon_test(self._workspace, PACKAGE)

    def expect_passed_on_correct_versions(self, name: str, *purposes: str) -> None:
        """Fail the check unless a file's tests pass on other correct versions, and in the runs with these purposes."""
        self.expect_usable(name)
        for purpose in (SECOND, REWORDED, *([BARE] if name == LIMITS else []), *purposes):
            report = self.runs[name, purpose]
            if not report.passed and name in WITH_DEADLINES:
                report = self._second_trial(name)[purpose]
            if not report.passed:
                raise CheckFailed(describe_failure(name, report, _WHERE[purpose]))

    def expect_usable(self, name: str) -> None:
        """Fail the check unless at least one of the student's tests in a file passes on the package as it is."""
        message = f"None of your tests in {name} passes on the package as it is."
        expect(is_usable(name, self.trial.get(name)), message)

    def expect_any_usable(self) -> None:
        """Fail the check unless at least one of the student's tests in all files passes on the package as it is."""
        is_any_usable = any(is_usable(name, report) for name, report in self.trial.items())
        expect(is_any_usable, "None of your tests in the three files passes on the package as it is.")

    def expect_detection(self, check: str, promise: str) -> None:
        """Fail the check unless the tests in the check's file fail on every fault that belongs to the check.

        A run that has to be stopped counts as failed. Another check tests that runs end by themselves.
        """
        name = FILES[check]
        self.expect_usable(name)
        relevant_faults = [fault for fault in faults() if fault.check == check]
        detected_faults = [fault for fault in relevant_faults if self._detects(name, fault)]
        expect(
            len(detected_faults) == len(relevant_faults),
            f"{len(relevant_faults) - len(detected_faults)} of {len(relevant_faults)} faulty versions pass all tests "
            f"in {name}, although they break this line of the contract: {promise}",
            fraction=len(detected_faults) / len(relevant_faults)
            if len(detected_faults) < len(relevant_faults)
            else 0.0,
        )

    def endless_files(self) -> list[str]:
        """Return the files whose tests had to be stopped on a faulty version."""
        ids = {fault.id for fault in faults()}
        return sorted({name for (name, purpose), run in self.runs.items() if purpose in ids and run.timed_out})

    def _detects(self, name: str, fault: Fault) -> bool:
        if self._is_detection(name, self._valid_reports(name)[fault.id]):
            return True
        return fault.id in BRIEF_FAULTS and any(
            self._is_detection(name, report)
            for report in self._run([self._plan(name, self.trial[name].failed)[fault.id]])
        )

    def _valid_reports(self, name: str) -> dict[str, student_test_reports.Report]:
        """Return a file's reports by purpose: of all its tests, or only of those that pass on correct versions.

        Raises:
            CheckFailed: tests fail on correct versions even after others were left out.
        """
        reports = {purpose: report for (file, purpose), report in self.runs.items() if file == name}
        if _fails_on_correct_version(reports):
            reports = self._reruns[name] = self._reruns.get(name) or self._rerun(name)
        message = f"Tests in {name} also fail on a correct {PACKAGE}, so failures on faulty ones prove nothing."
        expect(not _fails_on_correct_version(reports), message)
        return reports

    def _second_trial(self, name: str) -> dict[str, student_test_reports.Report]:
        """Run a file on the same correct versions once more; return the reports by purpose."""
        if name not in self._second_trials:
            first_runs = self._plan(name, self.trial[name].failed)
            runs = {
                purpose: replace(run, exit_first=False)
                for purpose, run in first_runs.items()
                if purpose in CORRECT_VERSIONS
            }
            self._second_trials[name] = dict(zip(runs, self._run(list(runs.values())), strict=True))
        return self._second_trials[name]

    def _rerun(self, name: str) -> dict[str, student_test_reports.Report]:
        """Run a file on new versions, without the tests that fail on correct ones; return the reports by purpose."""
        trial = self.trial[name]
        failed_again = {test for report in self._second_trial(name).values() for test in trial.failed_in(report)}
        deselected = tuple(sorted({*trial.failed, *failed_again}))
        message = (
            f"None of your tests in {name} passes on every correct {PACKAGE}, so failures on faulty ones prove nothing."
        )
        expect(len(set(trial.executed) - set(deselected)) > GIVEN_TESTS[name], message)
        runs = self._plan(name, deselected, "again")
        purposes = sorted(runs)
        self._draw(name, "order", "again").shuffle(purposes)
        return dict(zip(purposes, self._run([runs[purpose] for purpose in purposes]), strict=True))

    def _is_detection(self, name: str, report: student_test_reports.Report) -> bool:
        return report.timed_out or report.detects_fault(self.trial[name])

    def _plan(self, name: str, deselected: tuple[str, ...], *salt: str) -> dict[str, student_test_reports.TestRun]:
        """Return the runs of a file that the checks need, by purpose.

        Args:
            name: the file.
            deselected: tests that do not run.
            salt: a different salt leads to different versions.
        """
        runs: dict[str, student_test_reports.TestRun] = {}
        tested_faults = [
            fault for fault in faults() if FILES[fault.check] == name and self._checks & {fault.check, ENDS}
        ]
        # A failure on a faulty version counts only for tests that pass on correct versions.
        if tested_faults or RIGHT_CHECKS[name] in self._checks:
            runs[SECOND] = student_test_reports.TestRun(
                (name,), correct_version(STYLES[1], self._draw(name, SECOND, *salt)), exit_first=True
            )
            # As similar to the first version as faulty ones are, to expose tests that fail on any change of the text.
            similar_version = reworded_version(self._draw(name, REWORDED, *salt))
            runs[REWORDED] = student_test_reports.TestRun((name,), similar_version, exit_first=True)
            if name == LIMITS:
                # The notebook requires approximate comparison for a function, and only advises it for a node.
                bare = minimal_version(self._draw(name, BARE, *salt))
                runs[BARE] = student_test_reports.TestRun((name,), bare, exit_first=True)
            if name in ORDER_INDEPENDENT:
                first = correct_version(STYLES[0], self._draw(name, BACKWARDS, *salt))
                runs[BACKWARDS] = student_test_reports.TestRun((name,), first, backwards=True, exit_first=True)
        for fault in tested_faults:
            draw = self._draw(name, fault.id, *salt)
            runs[fault.id] = student_test_reports.TestRun(
                (name,), faulty_version(fault, draw.choice(STYLES), draw), exit_first=True
            )
        return {purpose: replace(run, deselected=deselected) for purpose, run in runs.items()}

    def _draw(self, *purpose: str) -> random.Random:
        """Return a random generator for one purpose, which does not depend on the other runs."""
        return random.Random(":".join((str(self._seed), *purpose)))

    def _run(self, runs: Sequence[student_test_reports.TestRun]) -> list[student_test_reports.Report]:
        return student_test_runs.run(self._workspace, self.source, runs)


def _fails_on_correct_version(reports: Mapping[str, student_test_reports.Report]) -> bool:
    return any(not reports[purpose].passed for purpose in CORRECT_VERSIONS if purpose in reports)


_ON_ANOTHER_VERSION = (
    "on a correct speed_guard that is written differently: test only the contract, not attributes or internal names"
)
_WHERE = {
    SECOND: _ON_ANOTHER_VERSION,
    REWORDED: _ON_ANOTHER_VERSION,
    BARE: _ON_ANOTHER_VERSION,
    BACKWARDS: "when the tests run in the opposite order: one test depends on what another leaves behind",
}
