"""All runs of one student's tests: first on a right version, then on many, right and faulty, in a drawn order.

Right versions and faulty ones are mixed and run alike, so that neither the time nor the circumstances of a run tell
which it has. A test that does not pass on the first right version meets no other. If others object to another right
version, all runs are made once more without these, on versions that are made anew: what is left has to pass on all
right ones there, and then says something of the faulty ones.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property

from autograder.checking import CheckFailed, CheckRow, Workspace, expect
from autograder.checking.probes import colcon_test, student_test_reports, student_test_runs
from autograder.checks.ch06_testing.hidden.faults import STYLES, Fault, broken, faults, reworded, right
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

RIGHT = {LIMITS: "limits_right", GUARD: "guard_right", LAUNCH: "launch_right"}
FILES = {
    **{check: name for name, check in RIGHT.items()},
    **dict.fromkeys(
        ("limits_pass", "stop", "slow", "clear", "infinity", "unknown", "back", "chosen", "refused"), LIMITS
    ),
    **dict.fromkeys(("guard_pass", "alone", "nothing_left", "name", "first_distance", "newest", "turn"), GUARD),
    **dict.fromkeys(("one_answer", "parameters", "sensor_qos", "stale", "watchdog"), GUARD),
    **dict.fromkeys(("launch_pass", "configuration", "runs"), LAUNCH),
    "no_sleep": GUARD,
}
COLCON, ENDS = frozenset(("colcon", "linters")), "ends"
ALL_FILES = COLCON | {"as_given", ENDS}  # checks that ask for the tests of all three files
RIGHTS = SECOND, REWORDED, BACKWARDS = "second", "reworded", "backwards"
BRIEF = frozenset({"believes_distances_too_long"})  # faults that end within a second: a run that is held up misses them
ORDERED = (LIMITS, GUARD)  # files whose tests have to pass in the opposite order, too


@dataclass(frozen=True, kw_only=True)
class Line(CheckRow):
    """A line of the contract, for the check whether a student's tests object to versions that break it.

    Attributes:
        promise: the line, as the end of the check's sentence.
    """

    promise: str
    doc: str = PYTEST


class Examination:
    """The runs of a submission's tests; each is made when it is first asked for, once.

    Args:
        workspace: the student's.
        seed: styles, obfuscations and the order of the runs are drawn from it.
        checks: those that will ask; what only others would ask for is not run.
    """

    def __init__(self, workspace: Workspace, seed: int, checks: frozenset[str]) -> None:
        self._workspace = workspace
        self._seed = seed
        self._checks = checks
        self._again: dict[str, dict[str, student_test_reports.Report]] = {}

    @cached_property
    def source(self) -> student_test_reports.Source:
        """The student's package, read once: later, `colcon test` lets its code write there."""
        return student_test_runs.take(self._workspace, PACKAGE)

    @cached_property
    def trial(self) -> dict[str, student_test_reports.Report]:
        """What the tests of each file say of a right version; those of the node are overheard."""
        asked = {FILES[check] for check in self._checks if check in FILES}
        wanted = {
            name: student_test_reports.TestRun(
                (name,), right(STYLES[0], self._draw(name)), sniffed=name == GUARD, shown=True
            )
            for name in MIN_TESTS
            if (name in asked or self._checks & ALL_FILES) and name in self.source.tests
        }
        return dict(zip(wanted, self._run(list(wanted.values())), strict=True))

    @cached_property
    def runs(self) -> dict[tuple[str, str], student_test_reports.Report]:
        """The other runs: by file, and what is special about the version or the run."""
        wanted: dict[tuple[str, str], student_test_reports.TestRun] = {}
        # What takes long comes first. Which file it is, a test knows anyway.
        for name in (name for name in reversed(MIN_TESTS) if is_usable(name, self.trial.get(name))):
            mine = self._wanted(name, self.trial[name].failed)
            whats = sorted(mine)
            self._draw(name, "order").shuffle(whats)
            wanted |= {(name, what): mine[what] for what in whats}
        with ThreadPoolExecutor(1) as beside:  # colcon waits most of its time, too
            if self._checks & COLCON:
                beside.submit(lambda: self.colcon)
            return dict(zip(wanted, self._run(list(wanted.values())), strict=True))

    @cached_property
    def colcon(self) -> student_test_reports.Report:
        """What `colcon test` does with the student's own package."""
        return colcon_test.colcon_test(self._workspace, PACKAGE)

    def expect_right(self, name: str, *whats: str) -> None:
        """Fail the check unless a file's tests pass on right versions in other words, and, if asked, backwards."""
        self.expect_usable(name)
        for what in (SECOND, REWORDED, *whats):
            if not self.runs[name, what].passed:
                raise CheckFailed(describe_failure(name, self.runs[name, what], _WHERE[what]))

    def expect_usable(self, name: str) -> None:
        """Fail the check unless one of the student's tests in a file passes on the package as it is."""
        said = f"No test of yours in {name} passes on the package as it is."
        expect(is_usable(name, self.trial.get(name)), said)

    def expect_begun(self) -> None:
        """Fail the check unless one of the student's tests in any file passes on the package as it is."""
        begun = any(is_usable(name, report) for name, report in self.trial.items())
        expect(begun, "No test of yours passes on the package as it is, in any of the three files.")

    def expect_objection(self, check: str, promise: str) -> None:
        """Fail the check unless the tests of its file object to every fault that belongs to it.

        A run that has to be stopped objects, too; that it does not end by itself is another check's matter.
        """
        name = FILES[check]
        self.expect_usable(name)
        mine = [fault for fault in faults() if fault.check == check]
        found = [fault for fault in mine if self._detects(name, fault)]
        expect(
            len(found) == len(mine),
            f"{len(mine) - len(found)} of {len(mine)} faulty versions that break this line of the contract "
            f"pass all tests in {name}: {promise}",
            fraction=len(found) / len(mine) if len(found) < len(mine) else 0.0,
        )

    def endless(self) -> list[str]:
        """Return the files whose tests had to be stopped on a faulty version."""
        ids = {fault.id for fault in faults()}
        return sorted({n for (n, what), r in self.runs.items() if what in ids and r.timed_out})

    def _detects(self, name: str, fault: Fault) -> bool:
        if self._reports(name, self._judging(name)[fault.id]):
            return True
        return fault.id in BRIEF and any(
            self._reports(name, r) for r in self._run([self._wanted(name, self.trial[name].failed)[fault.id]])
        )

    def _judging(self, name: str) -> dict[str, student_test_reports.Report]:
        """Return the runs of a file by which its tests are judged: those of all tests, or of those that are right.

        Raises:
            CheckFailed: they object to right versions, whatever is left of them.
        """
        runs = {what: report for (file, what), report in self.runs.items() if file == name}
        if _objects_to_right(runs):
            runs = self._again[name] = self._again.get(name) or self._run_again(name)
        said = f"Tests in {name} fail on a right {PACKAGE}, too, so that it says nothing if they fail on a faulty one."
        expect(not _objects_to_right(runs), said)
        return runs

    def _run_again(self, name: str) -> dict[str, student_test_reports.Report]:
        """Run a file once more without the tests that object to right versions, on other versions than before."""
        trial = self.trial[name]
        failed = trial.failed
        first = self._wanted(name, failed)
        reports = self._run([replace(first[what], first_failure=False) for what in RIGHTS if what in first])
        bad = tuple(sorted({*failed, *(test for report in reports for test in trial.failed_in(report))}))
        said = (
            f"No test of yours in {name} passes on every right {PACKAGE}, so that none says anything of a faulty one."
        )
        expect(len(set(trial.executed) - set(bad)) > GIVEN_TESTS[name], said)
        wanted = self._wanted(name, bad, "again")
        whats = sorted(wanted)
        self._draw(name, "order", "again").shuffle(whats)
        return dict(zip(whats, self._run([wanted[what] for what in whats]), strict=True))

    def _reports(self, name: str, report: student_test_reports.Report) -> bool:
        return report.timed_out or report.detects_fault(self.trial[name])

    def _wanted(self, name: str, without: tuple[str, ...], *salt: str) -> dict[str, student_test_reports.TestRun]:
        """Return the runs of a file that are asked for, by what is special about each.

        Args:
            name: the file.
            without: tests that do not run.
            salt: another one makes other versions.
        """
        wanted: dict[str, student_test_reports.TestRun] = {}
        asked = [f for f in faults() if FILES[f.check] == name and self._checks & {f.check, ENDS}]
        if asked or RIGHT[name] in self._checks:  # who objects to right versions says nothing of a faulty one
            wanted[SECOND] = student_test_reports.TestRun(
                (name,), right(STYLES[1], self._draw(name, SECOND, *salt)), first_failure=True
            )
            # As much like the first version as faulty ones are: who objects to any other text is found out.
            wanted[REWORDED] = student_test_reports.TestRun(
                (name,), reworded(self._draw(name, REWORDED, *salt)), first_failure=True
            )
            if name in ORDERED:
                version = right(STYLES[0], self._draw(name, BACKWARDS, *salt))
                wanted[BACKWARDS] = student_test_reports.TestRun((name,), version, backwards=True, first_failure=True)
        for fault in asked:
            draw = self._draw(name, fault.id, *salt)
            wanted[fault.id] = student_test_reports.TestRun(
                (name,), broken(fault, draw.choice(STYLES), draw), first_failure=True
            )
        return {what: replace(run, without=without) for what, run in wanted.items()}

    def _draw(self, *what: str) -> random.Random:
        """Return what is drawn from for one purpose: the same, whatever else is run."""
        return random.Random(":".join((str(self._seed), *what)))

    def _run(self, wanted: Sequence[student_test_reports.TestRun]) -> list[student_test_reports.Report]:
        return student_test_runs.run(self._workspace, self.source, wanted)


def _objects_to_right(runs: Mapping[str, student_test_reports.Report]) -> bool:
    return any(not runs[what].passed for what in RIGHTS if what in runs)


_OTHERWISE = "on a right speed_guard that is written differently: test the contract, no attributes and no inner names"
_WHERE = {
    SECOND: _OTHERWISE,
    REWORDED: _OTHERWISE,
    BACKWARDS: "when the tests run in the opposite order: one test lives on what another has left behind",
}
