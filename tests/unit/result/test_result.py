"""A result as data, and its published JSON form."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autograder.diagnosis import MAX_DETAIL, MAX_SENTENCE, OK, Diagnosis, Kind
from autograder.exceptions import AutograderError, GraderError, IsolationError, StudentError, UsageError
from autograder.result.model import Artifact, Build, CheckResult, Result, Status, from_json, schema, write_json
from autograder.suite import Check, Outcome, Visibility

MakeResult = Callable[..., Result]
# The fields of the first results. Later ones are not required, because older stored results lack them.
FIRST = {
    *("artifacts", "assignment", "build", "checks", "diagnosis", "isolation", "max_score"),
    *("phases", "schema", "score", "seconds", "seed", "started", "status"),
    *("student", "submission_sha256", "suite_version"),
}


@pytest.fixture
def turns(make_check: Callable[..., Check]) -> Check:
    return make_check("turns", "It turns.", 3, "reaction", hints=("look",))


@pytest.mark.parametrize(
    ("outcome", "points", "hints"),
    [(Outcome.PASSED, 3.0, ()), (Outcome.FAILED, 1.0, ("look",)), (Outcome.NOT_CHECKED, 0.0, ("look",))],
)
def test_points_follow_the_outcome(turns: Check, outcome: Outcome, points: float, hints: tuple[str, ...]) -> None:
    record = CheckResult.of(turns, outcome, fraction=1 / 3)
    assert (record.points, record.max_points, record.hints) == (points, 3.0, hints)


def test_long_texts_of_a_program_are_shortened_with_a_remark(turns: Check) -> None:
    text = "x" * 950_000
    result = CheckResult.of(turns, Outcome.FAILED, text, hints=(text,))
    diagnosis = Diagnosis(Kind.CRASHED_LATER, text, text)
    for shortened in (result.message, *result.hints, diagnosis.sentence):
        assert len(shortened) == MAX_SENTENCE
        assert shortened.endswith("… (950,000 characters in all)")
    assert len(diagnosis.detail) == len(Build(False, 0.0, log=text).log) == MAX_DETAIL
    assert CheckResult.of(turns, Outcome.FAILED, "y" * MAX_SENTENCE).message == "y" * MAX_SENTENCE


def test_the_score_of_a_result_is_the_sum_of_its_checks(make_result: MakeResult) -> None:
    result = make_result()
    assert (result.score, result.max_score, result.percent) == (4.0, 10.0, 40.0)


def test_the_maximum_comes_from_the_suite_even_when_no_check_was_recorded(make_result: MakeResult) -> None:
    result = make_result(checks=())
    assert (result.score, result.max_score, result.percent) == (0.0, 10.0, 0.0)


def test_a_group_contains_the_checks_of_one_grade_cell(make_result: MakeResult) -> None:
    assert [check.id for check in make_result().group("graph")] == ["starts", "listens"]
    assert make_result().group("nothing") == ()


@pytest.mark.parametrize(
    ("time", "held_up", "outcome", "in_doubt"),
    [
        ("real", 0.4, Outcome.FAILED, True),
        ("real", 0.4, Outcome.PASSED, False),
        ("real", 0.4, Outcome.NOT_CHECKED, False),
        ("real", 0.1, Outcome.FAILED, False),
        ("lockstep", 0.4, Outcome.FAILED, False),
    ],
)
def test_a_point_lost_in_real_time_on_a_busy_machine_is_in_doubt(
    make_result: MakeResult, turns: Check, time: str, held_up: float, outcome: Outcome, in_doubt: bool
) -> None:
    result = make_result(checks=(CheckResult.of(turns, outcome),), time=time, held_up=held_up)
    assert result.in_doubt is in_doubt


def test_a_result_survives_conversion_to_json(make_result: MakeResult, broken_result: Result) -> None:
    artifact = Artifact("tracks/a.png", "track", "ab", "turns", "It hits a wall.")
    for result in (
        make_result(
            artifacts=(artifact,), phases={"build": 1.5}, time="real", time_note="It has its own threads.", held_up=0.25
        ),
        broken_result,
        make_result(checks=(), build=None, status=Status.NOT_GRADED),
    ):
        plain = json.loads(json.dumps(result.to_json()))
        jsonschema.validate(plain, schema())
        assert from_json(plain) == result


def test_the_schema_is_a_valid_json_schema() -> None:
    jsonschema.Draft202012Validator.check_schema(schema())


def test_the_schema_names_every_outcome_and_visibility() -> None:
    check = schema()["properties"]["checks"]["items"]["properties"]
    assert set(check["outcome"]["enum"]) == {outcome.value for outcome in Outcome}
    assert set(check["visibility"]["enum"]) == {visibility.value for visibility in Visibility}
    assert set(schema()["properties"]["status"]["enum"]) == {status.value for status in Status}


def test_every_field_of_a_result_is_published(make_result: MakeResult, broken_result: Result) -> None:
    plain, properties = broken_result.to_json(), schema()["properties"]
    assert set(plain) == set(properties)
    assert set(schema()["required"]) == FIRST
    assert set(plain["checks"][0]) == set(properties["checks"]["items"]["properties"])
    assert set(plain["build"]) == set(properties["build"]["properties"])
    assert set(plain["diagnosis"]) == set(properties["diagnosis"]["properties"])


def test_fields_that_a_later_version_added_are_ignored(make_result: MakeResult) -> None:
    result = make_result(artifacts=(Artifact("a.png", "track", "ab", "turns"),))
    plain = result.to_json()
    for part in (plain, plain["build"], plain["diagnosis"], plain["checks"][0], plain["artifacts"][0]):
        part["added_later"] = 1
    assert from_json(plain) == result


def test_a_diagnosis_that_this_version_does_not_know_is_refused(make_result: MakeResult) -> None:
    plain = make_result().to_json()
    plain["diagnosis"]["kind"] = "struck_by_lightning"
    with pytest.raises(UsageError, match=r"of this version: 'struck_by_lightning' is not a valid Kind"):
        from_json(plain)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"max_score": 1.0}, "r.json: not a grading result: 4 points of 1"),
        ({"score": "4"}, "r.json: not a grading result: score: '4' is not of type 'number'"),
        ({"schema": "other/1"}, "schema: 'autograder-result/1' was expected"),
        ({"checks": [{}]}, "checks.0: 'id' is a required property"),
        ({"max_score": 0}, "max_score: 0 is less than or equal to the minimum of 0"),
    ],
)
def test_an_invalid_result_is_refused_with_file_and_field(
    make_result: MakeResult, change: dict[str, object], message: str
) -> None:
    with pytest.raises(UsageError) as excinfo:
        from_json({**make_result().to_json(), **change}, source="r.json")
    assert message in str(excinfo.value)


def test_json_that_is_not_an_object_is_rejected() -> None:
    with pytest.raises(UsageError, match="result: not a grading result: the top level: 7 is not of type 'object'"):
        from_json(7)


def test_only_enums_and_plain_data_have_a_json_form(make_result: MakeResult) -> None:
    with pytest.raises(TypeError, match="Path has no JSON form"):
        make_result(phases={"build": Path("x")}).to_json()


def test_json_is_written_whole_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    target = tmp_path / "new" / "result.json"
    write_json(target, {"outcome": Outcome.PASSED, "name": "é"})
    assert json.loads(target.read_text(encoding="utf-8")) == {"outcome": "passed", "name": "é"}
    assert "é" in target.read_text(encoding="utf-8")
    with pytest.raises(TypeError, match="object has no JSON form"):
        write_json(target, object())
    assert list(target.parent.iterdir()) == [target]
    assert json.loads(target.read_text(encoding="utf-8"))["name"] == "é"


def test_a_file_name_that_is_not_utf8_can_be_written_and_read_back(make_result: MakeResult, tmp_path: Path) -> None:
    result = make_result(diagnosis=Diagnosis(Kind.UNREADABLE, "cannot read b\udcffd"))
    write_json(tmp_path / "result.json", result.to_json())
    assert from_json(json.loads((tmp_path / "result.json").read_bytes())) == result


def test_a_student_error_has_its_diagnosis() -> None:
    diagnosis = Diagnosis(Kind.SYNTAX_ERROR, "setup.py, line 3: a bracket is not closed")
    error = StudentError(diagnosis)
    assert error.diagnosis is diagnosis
    assert str(error) == "setup.py, line 3: a bracket is not closed"


def test_a_grader_error_is_not_a_student_error() -> None:
    assert issubclass(IsolationError, GraderError)
    assert not issubclass(GraderError, StudentError)
    assert not issubclass(StudentError, GraderError)
    assert all(issubclass(kind, AutograderError) for kind in (UsageError, StudentError, GraderError))


def test_a_healthy_submission_has_the_diagnosis_ok() -> None:
    assert OK.kind is Kind.OK
    assert OK.sentence


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)


@pytest.mark.fuzz
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_result_with_any_value_in_any_place_is_read_or_refused(make_result: MakeResult, data: st.DataObject) -> None:
    """Replace one value, at any depth of a valid result, by any JSON value."""
    form = make_result().to_json()
    container: Any = form
    while True:
        key = data.draw(st.sampled_from(sorted(container) if isinstance(container, dict) else range(len(container))))
        if not (isinstance(container[key], (dict, list)) and container[key] and data.draw(st.booleans())):
            break
        container = container[key]
    container[key] = data.draw(JSON)
    with contextlib.suppress(UsageError):
        read = from_json(form, source="result.json")
        assert 0.0 <= read.score <= read.max_score


STAGGERED = """
import threading, time
from autograder.exceptions import UsageError
from autograder.result.model import from_json

failures = []

def read(delay):
    time.sleep(delay)
    try:
        from_json({})
    except UsageError:
        pass
    except ImportError as error:
        failures.append(error)

threads = [threading.Thread(target=read, args=(number / 20,)) for number in range(8)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(failures)
"""


def test_several_threads_may_read_their_first_result_at_the_same_time() -> None:
    completed = subprocess.run([sys.executable, "-c", STAGGERED], capture_output=True, text=True, check=True)
    assert completed.stdout == "[]\n"
