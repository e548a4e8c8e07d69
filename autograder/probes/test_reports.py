"""Records of runs of a student's tests: the package, the run that is wanted, and its report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from autograder.probes.junit import ClaimedOutcome, Claims
from autograder.probes.versions import Version
from autograder.sandbox import Ending


@dataclass(frozen=True)
class TestRun:
    """One run of a student's tests.

    Attributes:
        files: test files, by their paths below the package's folder `test`.
        version: the package under test; None for the student's own, as it was built.
        backwards: whether the tests run in the opposite order.
        first_failure: whether the run ends with the first test that fails.
        sniffed: whether an `RtpsSniffer` listens in the default domain.
        conftest: whether pytest reads the conftest.py that is there.
    """

    files: tuple[str, ...]
    version: Version | None = None
    backwards: bool = False
    first_failure: bool = False
    sniffed: bool = False
    conftest: bool = True
    __test__: ClassVar[bool] = False  # pytest would take it for a class of tests


@dataclass(frozen=True)
class Report:
    """The report of a run; all of it but `ending`, `left` and `joined_domain` is the run's own claim.

    Attributes:
        ending: how its process ended; None when the grader ended it after pytest was done.
        status: pytest's exit status, None when it never came to that.
        claims: what it says of its tests.
        left: UDP sockets that were still open after the last test: each ROS context that is not ended holds some.
        output: what it printed.
        joined_domain: whether a program joined the default domain, where the run was sniffed.
    """

    ending: Ending | None
    status: int | None
    claims: Claims
    left: int
    output: str
    joined_domain: bool = False

    @property
    def passed(self) -> bool:
        """Whether tests ran and each one passed."""
        return self.status == 0 and bool(self.executed) and not self.failed

    @property
    def executed(self) -> tuple[str, ...]:
        """The tests that ran and were not skipped."""
        return tuple(name for name, verdict in self.claims.verdicts.items() if verdict is not ClaimedOutcome.SKIPPED)

    @property
    def failed(self) -> tuple[str, ...]:
        """The tests that failed, in themselves or in a fixture."""
        bad = (ClaimedOutcome.FAILED, ClaimedOutcome.ERROR)
        return tuple(name for name, verdict in self.claims.verdicts.items() if verdict in bad)

    def objects(self, right: Report) -> bool:
        """Whether a test fails here that passed on a right version. A file that cannot be read does not count."""
        return self.status == 1 and bool(set(self.failed) & set(right.executed) - set(right.failed))


@dataclass(frozen=True)
class Source:
    """A student's package as plain files; its tests are those below `test`.

    Attributes:
        package: its name.
        files: by path below its folder.
    """

    package: str
    files: Mapping[str, bytes]

    @property
    def tests(self) -> dict[str, bytes]:
        """The files below `test`, by their paths there."""
        return {name.removeprefix("test/"): data for name, data in self.files.items() if name.startswith("test/")}
