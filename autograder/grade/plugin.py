"""The pytest plug-in of a grading: it turns a suite's checks into results, and other errors into failures.

A check that raises any other exception fails if the check, or one of its fixtures, read the student's data in a block
of `autograder.submission.reading`. The instructor is told. Without such data, it is a failure of the grader.

The checks of every chapter, visible and hidden, have its fixtures. A chapter's own fixtures are in its conftest.py, or
in the one module that uses them. `autograder.harness.Shared` keeps a harness for several checks.
"""

from __future__ import annotations

import itertools
import os
import random
import traceback
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from autograder.diagnosis import OK, Diagnosis
from autograder.exceptions import AutograderError, DoubtfulError, StudentError
from autograder.grade.job import WHOLE_SUITE, Options
from autograder.result.artifacts import Artifacts
from autograder.result.model import CheckResult
from autograder.run import patience
from autograder.run.workspace import Workspace
from autograder.submission.reading import clear_recorded_data, is_data_error, is_machine_error, recorded_data
from autograder.suite import Check, CheckFailed, Outcome, check_of


class GradingPlugin:
    """Collects a result for each check, in memory of the trusted process.

    Args:
        workspace: the student's built workspace.
        seed: every hidden input of the run is drawn from it.
        artifacts: saves the pictures; each check gets its own.
        builds: the outcome of each package's build, for checks of a build that may fail.
        options: how the suite is run.
        last: whether no other try of this grading follows.

    Attributes:
        results: by check id, in the order in which they ran.
        diagnosis: the first thing that was wrong with the student's program, or OK.
        failures: tracebacks of the grader's own errors; any of them makes the submission "not graded".
        unjudged: by check id, the traceback of an error that its code raised over data of the student's.
    """

    def __init__(
        self,
        workspace: Workspace,
        seed: int,
        artifacts: Artifacts,
        builds: Mapping[str, Diagnosis] | None = None,
        options: Options = WHOLE_SUITE,
        last: bool = False,
    ) -> None:
        self._workspace = workspace
        self._builds = builds or {}
        self._options = options
        self._last = last
        self._seed = seed
        self._artifacts = artifacts
        self.results: dict[str, CheckResult] = {}
        self.diagnosis: Diagnosis = OK
        self.failures: list[str] = []
        self.unjudged: dict[str, str] = {}
        self._data_by_fixture: dict[str, tuple[str, ...]] = {}  # data read by each fixture
        self._seconds: dict[str, float] = {}

    @property
    def is_finished(self) -> bool:
        """Whether the run ends with the first check that does not pass, and one did not."""
        return self._options.first_loss and any(r.outcome is not Outcome.PASSED for r in self.results.values())

    @pytest.fixture(scope="session")
    def workspace(self) -> Workspace:
        """The student's built workspace."""
        return self._workspace

    @pytest.fixture(scope="session")
    def builds(self) -> Mapping[str, Diagnosis]:
        """The outcome of each required package: OK, or why it was not built."""
        return self._builds

    @pytest.fixture(scope="session")
    def seed(self) -> int:
        """The number from which every hidden input of this run is drawn."""
        return self._seed

    @pytest.fixture
    def draw(self, request: pytest.FixtureRequest) -> random.Random:
        """Random numbers of the running check, the same for the same seed."""
        return random.Random(f"{self._seed}:{request.function.__name__}")

    @pytest.fixture
    def artifacts(self, request: pytest.FixtureRequest) -> Artifacts:
        """Keeps pictures for the feedback, under the running check's name."""
        check = check_of(request.function)
        return self._artifacts.of("" if check is None else check.id)

    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[Any]) -> None:
        check = _declared_by(item)
        if check is not None:
            self._record(check, call, item)
        if self.is_finished or self.failures:  # a failed grading is repeated, or ends without a result
            item.session.shouldstop = "no other check is needed"

    def pytest_configure(self, config: pytest.Config) -> None:
        config.option.tbstyle = "native"  # the default parses whole files, and its output is never shown

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        if only := self._options.only:
            items[:] = [item for item in items if (check := _declared_by(item)) and check.id in only]

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        check = _declared_by(item)
        clear_recorded_data()
        patience.require()
        self._workspace.exchanges.take()  # those before this check are not its own
        for needed in check.needs if check else ():
            if self.results[needed].outcome is not Outcome.PASSED:
                pytest.skip(f'first "{self.results[needed].title}" has to pass')

    @pytest.hookimpl(hookwrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        yield
        self._data_by_fixture[fixturedef.argname] = recorded_data()

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self.failures.append(str(report.longrepr))

    def _record(self, check: Check, call: pytest.CallInfo[Any], item: pytest.Item) -> None:
        error = None if call.excinfo is None else call.excinfo.value
        seconds = self._seconds[check.id] = self._seconds.get(check.id, 0.0) + call.duration
        if error is None:
            if call.when != "call":
                return
            verdict = CheckResult.of(check, Outcome.PASSED, seconds=seconds)
        elif isinstance(error, CheckFailed):
            verdict = CheckResult.of(
                check,
                Outcome.FAILED,
                error.message,
                fraction=error.fraction,
                seconds=seconds,
                hints=error.hints,
            )
        elif isinstance(error, StudentError) or (isinstance(error, DoubtfulError) and self._is_last):
            if self.diagnosis is OK:
                self.diagnosis = error.diagnosis
            diagnosis = error.diagnosis  # the hints of the check are about a program that runs
            verdict = CheckResult.of(check, Outcome.FAILED, diagnosis.sentence, seconds=seconds, hints=diagnosis.hints)
        elif isinstance(error, pytest.skip.Exception):
            verdict = CheckResult.not_checked(check, str(error), seconds=seconds)
        elif self._is_over_data(error) and (data := self._data_of(item)):
            self.unjudged[check.id] = "".join(traceback.format_exception(error))
            sentence = (
                f"{data} could not be judged, because it is nothing that this check expects "
                f"({type(error).__name__}). Your instructor can see where."
            )
            verdict = CheckResult.of(check, Outcome.FAILED, sentence, seconds=seconds)
        else:
            self.failures.append("".join(traceback.format_exception(error)))
            verdict = CheckResult.not_checked(check, "the grader failed here", seconds=seconds)
        self.results[check.id] = replace(
            verdict, talk=self._workspace.exchanges.take() if self._options.pictures else ()
        )

    @property
    def _is_last(self) -> bool:
        return self._last or patience.is_late()

    def _is_over_data(self, error: BaseException) -> bool:
        """Return whether the student's data may have caused an exception. In the last try, any exception counts."""
        any_can = self._is_last and isinstance(error, Exception) and not isinstance(error, AutograderError)
        return is_data_error(error) or (any_can and not is_machine_error(error))

    def _data_of(self, item: pytest.Item) -> str:
        """Return the name of the data that a check or its fixtures read last, or an empty string."""
        fixtures = (self._data_by_fixture.get(name, ()) for name in getattr(item, "fixturenames", ()))
        return next(reversed([*itertools.chain(*fixtures), *recorded_data()]), "")


def _declared_by(item: pytest.Item) -> Check | None:
    return check_of(getattr(item, "function", None))


def run(files: tuple[Path, ...], plugin: GradingPlugin) -> int:
    """Run a suite's modules under pytest with nothing of the machine's or the submission's configuration."""
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    for variable in ("PYTEST_ADDOPTS", "PYTEST_PLUGINS"):
        os.environ.pop(variable, None)
    # The end of pytest's session collects garbage twice, which takes a fifth of a second.
    unwanted = ("cacheprovider", "terminal", "faulthandler", "unraisableexception")
    chapter = files[0].parents[1]  # its conftest.py serves the visible and the hidden checks
    arguments = [word for name in unwanted for word in ("-p", f"no:{name}")]
    arguments += ["-c", "/dev/null", "--rootdir", str(chapter), "--confcutdir", str(chapter)]
    arguments += ["--import-mode=importlib", "-W", "default"]
    return int(pytest.main([*arguments, *map(str, files)], plugins=[plugin]))
