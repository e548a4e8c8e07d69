"""The pytest plug-in of a grading. It collects the results of a suite's checks, and the errors of the grader.

If a check raises an unexpected exception after it or one of its fixtures has read the student's data in a block of
`autograder.submission.reading`, the check fails, and the result reports the exception to the instructor. If no such
data was read, the exception is an error of the grader.

The checks of every chapter, visible and hidden, can use the fixtures of this plug-in. A chapter defines its own
fixtures in its conftest.py, or in the only module that uses them. `autograder.harness.Shared` keeps a harness for
several checks.
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
    """Collects a result for each check, in the memory of the trusted process.

    Args:
        workspace: the student's built workspace.
        seed: the number from which every hidden input is drawn.
        artifacts: saves the pictures of each check.
        builds: the outcome of each package's build, for checks of a build that may fail.
        options: how the suite is run.
        is_last_try: whether this is the last try of this grading.

    Attributes:
        results: by check id, in the order in which the checks ran.
        diagnosis: the first problem with the student's program, or OK.
        failures: tracebacks of the grader's own errors; any of these makes the submission "not graded".
        unjudged: by check id, the traceback of an error in the check that the student's data caused.
    """

    def __init__(
        self,
        workspace: Workspace,
        seed: int,
        artifacts: Artifacts,
        builds: Mapping[str, Diagnosis] | None = None,
        options: Options = WHOLE_SUITE,
        is_last_try: bool = False,
    ) -> None:
        self._workspace = workspace
        self._builds = builds or {}
        self._options = options
        self._is_last_try = is_last_try
        self._seed = seed
        self._artifacts = artifacts
        self.results: dict[str, CheckResult] = {}
        self.diagnosis: Diagnosis = OK
        self.failures: list[str] = []
        self.unjudged: dict[str, str] = {}
        self._data_by_fixture: dict[str, tuple[str, ...]] = {}  # names of the data that each fixture read
        self._seconds: dict[str, float] = {}

    @property
    def is_finished(self) -> bool:
        """Whether the run is over because it stops at the first check that does not pass."""
        return self._options.exit_first and any(r.outcome is not Outcome.PASSED for r in self.results.values())

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
        """Random numbers for the running check, always the same for a seed."""
        return random.Random(f"{self._seed}:{request.function.__name__}")

    @pytest.fixture
    def artifacts(self, request: pytest.FixtureRequest) -> Artifacts:
        """Keeps pictures for the feedback, under the running check's name."""
        check = check_of(request.function)
        return self._artifacts.of("" if check is None else check.id)

    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[Any]) -> None:
        check = _check_of_item(item)
        if check is not None:
            self._record(check, call, item)
        if self.is_finished or self.failures:  # a failed grading is repeated, or ends without a result
            item.session.shouldstop = "no other check is needed"

    def pytest_configure(self, config: pytest.Config) -> None:
        config.option.tbstyle = "native"  # the default parses whole files, and its output is never shown

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        if only := self._options.only:
            items[:] = [item for item in items if (check := _check_of_item(item)) and check.id in only]

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        check = _check_of_item(item)
        clear_recorded_data()
        patience.require()
        self._workspace.exchanges.take()  # drop exchanges that belong to an earlier check
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
            check_result = CheckResult.of(check, Outcome.PASSED, seconds=seconds)
        elif isinstance(error, CheckFailed):
            check_result = CheckResult.of(
                check,
                Outcome.FAILED,
                error.message,
                fraction=error.fraction,
                seconds=seconds,
                hints=error.hints,
            )
        elif isinstance(error, StudentError) or (isinstance(error, DoubtfulError) and self._is_final):
            if self.diagnosis is OK:
                self.diagnosis = error.diagnosis
            diagnosis = error.diagnosis  # the hints of the check assume a program that runs
            check_result = CheckResult.of(
                check, Outcome.FAILED, diagnosis.sentence, seconds=seconds, hints=diagnosis.hints
            )
        elif isinstance(error, pytest.skip.Exception):
            check_result = CheckResult.not_checked(check, str(error), seconds=seconds)
        elif self._is_caused_by_data(error) and (data := self._data_name(item)):
            self.unjudged[check.id] = "".join(traceback.format_exception(error))
            sentence = (
                f"{data} could not be judged, because this check does not expect such data "
                f"({type(error).__name__}). Your instructor can see the details."
            )
            check_result = CheckResult.of(check, Outcome.FAILED, sentence, seconds=seconds)
        else:
            self.failures.append("".join(traceback.format_exception(error)))
            check_result = CheckResult.not_checked(check, "the grader failed here", seconds=seconds)
        self.results[check.id] = replace(
            check_result, talk=self._workspace.exchanges.take() if self._options.pictures else ()
        )

    @property
    def _is_final(self) -> bool:
        return self._is_last_try or patience.is_late()

    def _is_caused_by_data(self, error: BaseException) -> bool:
        """Return whether the student's data is blamed for an exception. In the last try, it is for almost any."""
        is_unexpected = self._is_final and isinstance(error, Exception) and not isinstance(error, AutograderError)
        return is_data_error(error) or (is_unexpected and not is_machine_error(error))

    def _data_name(self, item: pytest.Item) -> str:
        """Return the name of the student's data that a check or its fixtures read last, or an empty string."""
        fixtures = (self._data_by_fixture.get(name, ()) for name in getattr(item, "fixturenames", ()))
        return next(reversed([*itertools.chain(*fixtures), *recorded_data()]), "")


def _check_of_item(item: pytest.Item) -> Check | None:
    return check_of(getattr(item, "function", None))


def run(files: tuple[Path, ...], plugin: GradingPlugin) -> int:
    """Run a suite's modules with pytest, without any configuration of the machine or the submission."""
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    for variable in ("PYTEST_ADDOPTS", "PYTEST_PLUGINS"):
        os.environ.pop(variable, None)
    # At the end of a session, unraisableexception collects garbage twice, which takes 0.2 s.
    disabled_plugins = ("cacheprovider", "terminal", "faulthandler", "unraisableexception")
    chapter = files[0].parents[1]  # its conftest.py applies to visible and hidden checks
    arguments = [word for name in disabled_plugins for word in ("-p", f"no:{name}")]
    arguments += ["-c", "/dev/null", "--rootdir", str(chapter), "--confcutdir", str(chapter)]
    arguments += ["--import-mode=importlib", "-W", "default"]
    return int(pytest.main([*arguments, *map(str, files)], plugins=[plugin]))
