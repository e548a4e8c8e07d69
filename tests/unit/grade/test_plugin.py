"""The tests of a suite become check results. The plug-in ignores everything else."""

from __future__ import annotations

import itertools
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.grade.job import WHOLE_SUITE, Options
from autograder.grade.plugin import GradingPlugin, run
from autograder.result.artifacts import Artifacts
from autograder.ros import activate
from autograder.run.workspace import Workspace
from autograder.suite import Outcome

HEAD = """
import pytest
from autograder.suite import CheckFailed, check, expect, hint
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
"""
Grade = Callable[..., GradingPlugin]
_NUMBERS = itertools.count()


@pytest.fixture
def grade(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Grade:
    """Run a suite of one module, given as text."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "")
    monkeypatch.setenv("PYTEST_ADDOPTS", "--collect-only")
    monkeypatch.setenv("PYTEST_PLUGINS", "no_such_plugin")

    def grade_text(
        text: str, options: Options = WHOLE_SUITE, is_last_try: bool = False, seed: int = 7
    ) -> GradingPlugin:
        # A unique name: pytest keeps the modules that this process has imported.
        path = tmp_path / "chapter" / "hidden" / f"checks_{next(_NUMBERS)}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEAD + textwrap.dedent(text))
        workspace = Workspace(tmp_path / "ws", activate(), tmp_path)
        plugin = GradingPlugin(workspace, seed, Artifacts(tmp_path / "out"), options=options, is_last_try=is_last_try)
        run((path,), plugin)
        return plugin

    return grade_text


def _outcomes(plugin: GradingPlugin) -> dict[str, tuple[Outcome, float]]:
    return {name: (result.outcome, result.points) for name, result in plugin.results.items()}


def test_with_exit_first_no_check_runs_after_a_failed_one(grade: Grade) -> None:
    text = """
        @check(points=2, group="g")
        def test_right():
            '''It is right.'''

        @check(points=4, group="g")
        def test_wrong():
            '''It is wrong.'''
            expect(False, "wrong")

        @check(points=1, group="g")
        def test_later():
            '''It comes later.'''
    """
    assert list(grade(text).results) == ["right", "wrong", "later"]
    plugin = grade(text, Options(exit_first=True))
    assert (list(plugin.results), plugin.is_finished, plugin.failures) == (["right", "wrong"], True, [])
    plugin = grade(text, Options(only=("right", "later"), exit_first=True))
    assert (list(plugin.results), plugin.is_finished) == (["right", "later"], False)


def test_each_check_passes_or_fails_with_its_fraction_in_the_order_of_the_file(grade: Grade) -> None:
    plugin = grade("""
        @check(points=2, group="g")
        def test_right():
            '''It is right.'''

        @check(points=4, group="g")
        @hint("a hint")
        def test_half():
            '''It is half right.'''
            expect(False, "only half", fraction=0.5)

        @check(points=1, group="g")
        def test_wrong():
            '''It is wrong.'''
            raise CheckFailed("all wrong")
        """)
    assert _outcomes(plugin) == {
        "right": (Outcome.PASSED, 2.0),
        "half": (Outcome.FAILED, 2.0),
        "wrong": (Outcome.FAILED, 0.0),
    }
    assert list(plugin.results) == ["right", "half", "wrong"]
    assert (plugin.results["half"].message, plugin.results["half"].hints) == ("only half", ("a hint",))
    assert plugin.failures == []
    assert plugin.diagnosis is OK


@pytest.mark.promise(
    "`hint` texts are shown one after the other when the check fails",
    "`expect(..., hints=...)` replaces them for a failure that they do not fit",
)
def test_a_failure_has_the_hints_of_the_check_or_its_own(grade: Grade) -> None:
    plugin = grade("""
        @check(points=1, group="g")
        @hint("of the check")
        def test_usual():
            '''The usual.'''
            expect(False, "no")

        @check(points=1, group="g")
        @hint("of the check")
        def test_other():
            '''Another failure.'''
            expect(False, "no", hints=("of the failure",))
        """)
    assert [result.hints for result in plugin.results.values()] == [("of the check",), ("of the failure",)]


@pytest.mark.promise('If one of them did not pass, this one is "not checked".')
def test_checks_that_need_a_failed_check_directly_or_not_are_not_run(grade: Grade) -> None:
    plugin = grade("""
        @check(points=1, group="g")
        def test_first():
            '''The first thing.'''
            raise CheckFailed("no")

        @check(points=1, group="g", needs=("first",))
        def test_second():
            '''The second thing.'''
            raise GraderError("never reached")

        @check(points=1, group="g", needs=("second",))
        def test_third():
            '''The third thing.'''

        @check(points=1, group="g")
        def test_fourth():
            '''The fourth thing.'''
        """)
    outcomes = [result.outcome for result in plugin.results.values()]
    assert outcomes == [Outcome.FAILED, Outcome.NOT_CHECKED, Outcome.NOT_CHECKED, Outcome.PASSED]
    assert plugin.results["second"].message == 'not checked: first "The first thing." has to pass'
    assert plugin.failures == []


@pytest.mark.promise("If both fail, feedback shows this one under the other.")
def test_a_check_after_a_failed_one_is_run_and_has_its_own_result(grade: Grade) -> None:
    plugin = grade("""
        @check(points=1, group="g")
        def test_first():
            '''The first thing.'''
            raise CheckFailed("no")

        @check(points=2, group="g", after=("first",))
        def test_second():
            '''The second thing.'''

        @check(points=3, group="g", needs=("second",), after=("first",))
        def test_third():
            '''The third thing.'''
            raise CheckFailed("not this one either")
        """)
    assert _outcomes(plugin) == {
        "first": (Outcome.FAILED, 0.0),
        "second": (Outcome.PASSED, 2.0),
        "third": (Outcome.FAILED, 0.0),
    }
    assert [result.after for result in plugin.results.values()] == [(), ("first",), ("second", "first")]
    assert plugin.results["third"].message == "not this one either"


def test_a_fault_of_the_student_s_in_a_fixture_fails_the_check_and_is_the_diagnosis(grade: Grade) -> None:
    plugin = grade("""
        @pytest.fixture
        def robot():
            raise StudentError(Diagnosis(Kind.CRASHED_AT_START, "Your node crashed.", "line 3"))

        @check(points=1, group="g")
        @hint("a hint about a program that runs")
        def test_starts(robot):
            '''It starts.'''

        @check(points=1, group="g")
        @hint("a hint about a program that runs")
        def test_other():
            '''It does the other thing.'''
            raise StudentError(Diagnosis(Kind.STUCK, "Your node hangs."))
        """)
    crashed, hangs = (result.hints for result in plugin.results.values())
    assert crashed[0].startswith("Read the traceback from its last line upwards.")
    assert hangs == ()
    assert [result.outcome for result in plugin.results.values()] == [Outcome.FAILED] * 2
    assert plugin.results["starts"].message == "Your node crashed."
    assert plugin.diagnosis.kind is Kind.CRASHED_AT_START
    assert plugin.failures == []


@pytest.mark.parametrize("error", ["GraderError('lost')", "ZeroDivisionError()", "AssertionError()", "SystemExit(0)"])
@pytest.mark.parametrize("phase", ["check", "fixture", "teardown"])
def test_any_other_exception_is_the_grader_s_own_failure(grade: Grade, error: str, phase: str) -> None:
    plugin = grade(f"""
        @pytest.fixture
        def thing():
            if "{phase}" == "fixture": raise {error}
            yield
            if "{phase}" == "teardown": raise {error}

        @check(points=1, group="g")
        def test_it(thing):
            '''It is so.'''
            if "{phase}" == "check": raise {error}
        """)
    assert plugin.results["it"].outcome is Outcome.NOT_CHECKED
    assert plugin.results["it"].points == 0.0
    assert len(plugin.failures) == 1


@pytest.mark.promise("`grader.log` beside the result says where.")
@pytest.mark.parametrize("phase", ["check", "fixture", "module"])
def test_an_error_in_handling_a_student_s_data_fails_only_that_check_and_is_logged_for_the_instructor(
    grade: Grade, phase: str
) -> None:
    plugin = grade(f"""
        from autograder.submission.reading import record_data

        @pytest.fixture(scope="{"module" if phase == "module" else "function"}")
        def answer():
            if "{phase}" != "check": record_data("The answer of /add")

        @check(points=1, group="g")
        def test_reads_first(answer):
            '''It is so.'''

        @check(points=1, group="g")
        def test_reads(answer):
            '''It is so.'''
            if "{phase}" == "check": record_data("The answer of /add")
            secret = 10**400 * 1.0

        @check(points=1, group="g")
        def test_other():
            '''It is so, too.'''
        """)
    assert [result.outcome for result in plugin.results.values()] == [Outcome.PASSED, Outcome.FAILED, Outcome.PASSED]
    message = plugin.results["reads"].message
    assert message.startswith("The answer of /add could not be judged")
    assert "int too large" not in message
    assert plugin.failures == []
    assert "OverflowError" in plugin.unjudged["reads"]


def test_a_fraction_that_a_student_s_data_make_impossible_fails_only_that_check(grade: Grade) -> None:
    plugin = grade("""
        from autograder.submission.reading import record_data

        @check(points=1, group="g")
        def test_reads():
            '''It is so.'''
            record_data("The answer of /add")
            expect(False, "wrong", fraction=float("nan"))
    """)
    assert plugin.results["reads"].outcome is Outcome.FAILED
    assert (plugin.failures, list(plugin.unjudged)) == ([], ["reads"])


def test_an_error_without_a_student_s_data_is_the_grader_s_failure_even_after_a_check_with_such_data(
    grade: Grade,
) -> None:
    plugin = grade("""
        from autograder.submission.reading import record_data

        @check(points=1, group="g")
        def test_reads():
            '''It is so.'''
            record_data("The answer of /add")

        @check(points=1, group="g")
        def test_other():
            '''It is so, too.'''
            1 / 0
        """)
    assert plugin.results["other"].outcome is Outcome.NOT_CHECKED
    assert (len(plugin.failures), plugin.unjudged) == (1, {})


@pytest.mark.parametrize("error", ["GraderError('lost')", "OSError(5, 'EIO')", "RuntimeError()", "SystemExit(0)"])
def test_an_error_that_data_cannot_cause_is_the_grader_s_failure(grade: Grade, error: str) -> None:
    plugin = grade(f"""
        from autograder.submission.reading import record_data

        @check(points=1, group="g")
        def test_reads():
            '''It is so.'''
            record_data("The answer of /add")
            raise {error}
        """)
    assert (len(plugin.failures), plugin.unjudged) == (1, {})


def test_an_error_of_a_program_or_the_machine_counts_as_the_program_s_in_the_last_try(grade: Grade) -> None:
    text = """
        from autograder.exceptions import DoubtfulError
        from autograder.submission.reading import record_data

        @check(points=1, group="g")
        def test_matches():
            '''It is so.'''
            raise DoubtfulError(Diagnosis(Kind.STUCK, "They did not discover each other."))

        @check(points=1, group="g")
        def test_reads():
            '''It is so.'''
            record_data("The answer of /add")
            raise RuntimeError

        @check(points=1, group="g")
        def test_other():
            '''It is so, too.'''
    """
    plugin = grade(text)
    assert (len(plugin.failures), list(plugin.results)) == (1, ["matches"]), "it ends at once, and is made again"
    plugin = grade(text, is_last_try=True)
    assert plugin.failures == []
    assert [result.outcome for result in plugin.results.values()] == [Outcome.FAILED, Outcome.FAILED, Outcome.PASSED]
    assert plugin.results["matches"].message == "They did not discover each other."
    assert list(plugin.unjudged) == ["reads"]


def test_a_module_that_cannot_be_imported_is_the_grader_s_own_failure(grade: Grade) -> None:
    plugin = grade("import no_such_module")
    assert plugin.results == {}
    assert "no_such_module" in plugin.failures[0]


def test_a_test_that_declares_no_check_is_ignored(grade: Grade) -> None:
    plugin = grade("""
        def test_helper():
            assert True
        """)
    assert plugin.results == {}
    assert plugin.failures == []


def test_a_check_gets_the_workspace_the_seed_and_its_own_artifacts(grade: Grade) -> None:
    plugin = grade("""
        @check(points=1, group="g")
        def test_it(workspace, seed, artifacts):
            '''It is so.'''
            expect(seed == 7 and artifacts.check == "it" and workspace.install.name == "install", "wrong fixtures")
        """)
    assert _outcomes(plugin) == {"it": (Outcome.PASSED, 1.0)}


@pytest.mark.promise("`draw` is a random number generator that is seeded for each grading.")
def test_the_draws_of_a_check_follow_from_the_seed(grade: Grade) -> None:
    text = """
        @check(points=1, group="g")
        def test_it(draw):
            '''It is so.'''
            expect(False, str(draw.random()))
    """
    first, repeated, of_other_seed = (grade(text, seed=seed).results["it"].message for seed in (7, 7, 8))
    assert first == repeated != of_other_seed


def test_files_around_the_suite_are_not_collected(grade: Grade, tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text("raise SystemExit('collected')")
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = --collect-only\n")
    plugin = grade("""
        @check(points=1, group="g")
        def test_it():
            '''It is so.'''
        """)
    assert _outcomes(plugin) == {"it": (Outcome.PASSED, 1.0)}


def test_a_pytest_plug_in_installed_on_the_machine_is_not_loaded(
    grade: Grade, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    metadata = tmp_path / "site" / "launch_testing-9.9.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: launch-testing\nVersion: 9.9\n")
    (metadata / "entry_points.txt").write_text("[pytest11]\nlaunch_testing_of_somebody = broken_plug_in\n")
    (tmp_path / "site" / "broken_plug_in.py").write_text("raise SystemExit('loaded')")
    monkeypatch.syspath_prepend(tmp_path / "site")
    plugin = grade("""
        @check(points=1, group="g")
        def test_it():
            '''It is so.'''
        """)
    assert _outcomes(plugin) == {"it": (Outcome.PASSED, 1.0)}


def test_checks_get_the_build_result_of_each_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "")
    path = tmp_path / f"checks_{next(_NUMBERS)}.py"
    path.write_text(
        HEAD
        + textwrap.dedent("""
            @check(points=1, group="g")
            def test_builds(builds):
                '''It builds.'''
                raise StudentError(builds["bad"])

            @check(points=1, group="g")
            def test_reads(builds):
                '''It can be read.'''
                expect(set(builds) == {"good", "bad"}, "?")
        """)
    )
    broken = Diagnosis(Kind.BUILD_FAILED, "It does not build.")
    workspace = Workspace(tmp_path / "ws", activate(), tmp_path)
    plugin = GradingPlugin(workspace, 7, Artifacts(tmp_path / "out"), {"good": OK, "bad": broken})
    run((path,), plugin)
    assert _outcomes(plugin) == {"builds": (Outcome.FAILED, 0.0), "reads": (Outcome.PASSED, 1.0)}
    assert plugin.diagnosis == broken


def test_a_check_gets_only_the_messages_of_its_own_set_up_and_call(grade: Grade) -> None:
    text = """
        @pytest.fixture
        def prepared(workspace):
            workspace.exchanges.add(0.5, "asked", "/prepare", "")
            yield
            workspace.exchanges.add(9.0, "asked", "/tidy_up", "")

        @check(points=1, group="g")
        def test_first(prepared, workspace):
            '''The first.'''
            workspace.exchanges.add(1.0, "answered", "/go", "success: False")
            expect(False, "no")

        @check(points=1, group="g")
        def test_second(workspace):
            '''The second.'''
            workspace.exchanges.add(2.0, "asked", "/stop", "")
    """
    names = {name: [row.name for row in result.talk] for name, result in grade(text).results.items()}
    assert names == {"first": ["/prepare", "/go"], "second": ["/stop"]}
    assert [result.talk for result in grade(text, Options(pictures=False)).results.values()] == [(), ()]
