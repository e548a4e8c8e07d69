"""Students' functions are called in a separate process, which returns only plain values."""

from __future__ import annotations

import sys
from math import inf, nan
from pathlib import Path

import pytest

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.probes.calls import StepResult, attribute, call, callback, result_of, run_steps, same, value
from autograder.ros import environment
from autograder.suite import CheckFailed

MODULE = """
import sys

LIMIT = 3.5

class Liar(float):
    def __eq__(self, other):
        return True

class Absent(ValueError):
    pass

class Impostor(Exception):
    pass

Impostor.__name__ = 'ValueError'

class Counter:
    def __init__(self, start=0):
        self.count = start
    def add(self, other):
        self.count += other.count
        return self.count

def double(readings):
    print('doubling')
    return [2 * reading for reading in readings]

def empty(readings):
    readings.clear()

def lie():
    return Liar(1.0)

def gone():
    sys.exit(0)

def fails():
    raise ValueError('no such thing')

def absent():
    raise Absent('none')

def pretends():
    raise Impostor

def strange():
    return object()

def unwritten():
    raise NotImplementedError

class Pause:
    def __await__(self):
        yield

class Node:
    async def breaks(self):
        raise ValueError('a bug')
    async def waits(self):
        await Pause()
"""


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """An install space with one module, as colcon writes it."""
    site = f"lib/python{sys.version_info[0]}.{sys.version_info[1]}/site-packages"
    folder = tmp_path / "ws" / "install" / "demo" / site
    folder.mkdir(parents=True)
    (folder / "demo.py").write_text(MODULE)
    (folder / "torn.py").write_text("def f(:\n")
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    return Workspace(tmp_path / "ws", environment.find(), scratch)


def test_values_are_passed_as_json_with_nan_and_infinities(workspace: Workspace) -> None:
    doubled, limit = run_steps(workspace, "demo", call("double", [1.0, nan, inf]), attribute("LIMIT"))
    assert same(doubled.value, [2.0, nan, inf])
    assert doubled.printed == "doubling\n"
    assert limit.value == 3.5


def test_a_value_made_by_a_step_can_be_used_in_later_steps(workspace: Workspace) -> None:
    steps = (call("Counter", start=2), call("Counter", 3), call("add", result_of(1), on=0), attribute("count", on=0))
    outcomes = run_steps(workspace, "demo", *steps)
    assert [outcome.value for outcome in outcomes] == [None, None, 5, 5]


def test_a_changed_argument_is_returned(workspace: Workspace) -> None:
    (outcome,) = run_steps(workspace, "demo", call("empty", [1, 2]))
    assert outcome.arguments == ([],)


def test_a_subclass_that_equals_everything_returns_as_a_plain_number(workspace: Workspace) -> None:
    (outcome,) = run_steps(workspace, "demo", call("lie"))
    assert type(outcome.value) is float
    assert outcome.value == 1.0
    assert outcome.value != 2.0


def test_an_exception_is_recognized_by_its_class_and_base_classes(workspace: Workspace) -> None:
    subclass_error, pretended_error = run_steps(workspace, "demo", call("absent"), call("pretends"))
    assert subclass_error.raised == "Absent"
    assert subclass_error.kinds == ("Absent", "ValueError", "Exception", "BaseException", "object")
    assert pretended_error.raised == "ValueError"
    assert "ValueError" not in pretended_error.kinds


def test_exceptions_and_values_that_are_not_plain_are_named(workspace: Workspace) -> None:
    failed, not_plain, unwritten = run_steps(workspace, "demo", call("fails"), call("strange"), call("unwritten"))
    with pytest.raises(CheckFailed, match=r"fails\(\) raised ValueError: no such thing"):
        value(failed, "fails()")
    with pytest.raises(CheckFailed, match=r"strange\(\) returned a value of type object, instead of plain Python"):
        value(not_plain, "strange()")
    with pytest.raises(CheckFailed, match=r"unwritten\(\) is still to be written"):
        value(unwritten, "unwritten()")


def test_a_coroutine_is_started_only_as_a_callback(workspace: Workspace) -> None:
    steps = (call("Node"), callback("breaks", on=0), callback("waits", on=0), call("breaks", on=0))
    _, broken, waiting, called = run_steps(workspace, "demo", *steps)
    assert (broken.raised, broken.message, waiting.raised, waiting.type) == ("ValueError", "a bug", "", "")
    assert (called.raised, called.type) == ("", "coroutine")


def test_a_step_can_call_a_function_of_another_module(workspace: Workspace) -> None:
    (outcome,) = run_steps(workspace, "demo", call("hypot", 3.0, 4.0, module="math"))
    assert outcome == StepResult(value=5.0, arguments=(3.0, 4.0))


@pytest.mark.parametrize(
    ("module", "kind", "words"),
    [
        ("torn", Kind.SYNTAX_ERROR, "Python cannot read your file"),
        ("missing", Kind.CRASHED_AT_IMPORT, "installs no module missing"),
    ],
)
def test_a_module_that_cannot_be_imported_is_diagnosed(
    workspace: Workspace, module: str, kind: Kind, words: str
) -> None:
    with pytest.raises(StudentError) as excinfo:
        run_steps(workspace, module, call("f"))
    assert excinfo.value.diagnosis.kind is kind
    assert words in excinfo.value.diagnosis.sentence
    assert "importlib" not in excinfo.value.diagnosis.detail  # the loader's frames do not help a student


def test_code_that_ends_the_process_is_reported_as_ended_early(workspace: Workspace) -> None:
    with pytest.raises(StudentError) as excinfo:
        run_steps(workspace, "demo", call("gone"), call("double", [1]))
    assert excinfo.value.diagnosis.kind is Kind.ENDED_EARLY


@pytest.mark.parametrize(
    ("left", "right", "is_same"),
    [
        (nan, nan, True),
        (1, 1.0, True),
        (True, 1, False),
        (None, 0, False),
        (0.1 + 0.2, 0.3, True),
        ([1, [nan]], [1, [nan]], True),
        ([1], [1, 2], False),
        ("1", 1, False),
        ({"a": 1}, {"a": 1}, True),
    ],
)
def test_json_values_are_compared_by_kind_and_value(left: object, right: object, is_same: bool) -> None:
    assert same(left, right) is is_same
