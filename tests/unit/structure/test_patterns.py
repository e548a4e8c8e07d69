"""A regular expression of the grader takes steps in proportion to the text's length, for any text of a student."""

from __future__ import annotations

import ast
import importlib
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest

from autograder.course_paths import ROOT
from tests.unit.structure.regex_steps import Budget, Steps, hard_texts

LENGTH = 32  # repetitions of the part of a text that makes it hard
MOST = 300_000  # steps, of a text of some hundred characters
PLENTY = 4  # steps a character; a text that takes fewer is not hard
STEEP = 2.6  # how the steps grow from a length to twice the length: 2 is linear, 4 quadratic
FUNCTIONS = {"compile", "match", "fullmatch", "search", "split", "sub", "subn", "findall", "finditer"}
# Modules whose patterns the grader never applies to a student's text.
APART = {
    "autograder/bootstrap.py": "lock files",
    "autograder/author/course/": "the course's own notebooks",
    "autograder/notebook/": "runs in the student's own kernel",
    "autograder/author/verification/": "the reference and its mutants",
    "autograder/ros/": "runs in students' own programs",
}


@dataclass(frozen=True)
class Use:
    """A pattern of a module, and whether it is tried at a text's beginning only, and has to reach its end."""

    location: str
    pattern: re.Pattern[Any]
    anchored: bool = False
    full: bool = False


def uses() -> Iterator[Use]:
    for path in sorted((ROOT / "autograder").rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        text = path.read_text(encoding="utf-8")
        if not name.startswith(tuple(APART)) and re.search(r"^(import re|from re import .*)$", text, re.MULTILINE):
            yield from _uses(name, ast.parse(text))


def _uses(path: str, tree: ast.Module) -> Iterator[Use]:
    module = importlib.import_module(path.removesuffix(".py").removesuffix("/__init__").replace("/", "."))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)]
    methods: dict[str, set[str]] = {}
    for call in calls:
        assert isinstance(call.func, ast.Attribute)
        if isinstance(call.func.value, ast.Name) and call.func.attr in FUNCTIONS:
            methods.setdefault(call.func.value.id, set()).add(call.func.attr)
    for name, value in vars(module).items():
        for pattern in _patterns(value):
            methods_used = methods.get(name, {"search"})
            yield Use(f"{path}, {name}", pattern, methods_used <= {"match", "fullmatch"}, methods_used == {"fullmatch"})
    for function in (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)):
        for node in ast.walk(function):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in {f"re.{name}" for name in FUNCTIONS}:
                methods_used = {ast.unparse(node.func).removeprefix("re.")}
                location = f"{path}, line {node.lineno}"
                yield Use(
                    location,
                    re.compile(_text(node.args[0])),
                    methods_used <= {"match", "fullmatch"},
                    methods_used == {"fullmatch"},
                )


def _patterns(value: object) -> Iterator[re.Pattern[Any]]:
    if isinstance(value, re.Pattern):
        yield value
    for part in value.values() if isinstance(value, dict) else value if isinstance(value, tuple | list) else ():
        yield from _patterns(part)


def _text(node: ast.expr) -> Any:
    """Return the pattern in a call, with a word for each value that is formatted into it."""
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "x" for part in node.values)
    assert isinstance(node, ast.Constant), f"{ast.unparse(node)}: write the pattern where it is used, to be tried here"
    return node.value


@pytest.fixture(autouse=True, scope="module")
def recursion_limit() -> Iterator[None]:
    """Raise the recursion limit, because a repeated group recurses for each repetition."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(10_000)
    yield
    sys.setrecursionlimit(before)


def steepest_growth(use: Use) -> tuple[float, str]:
    """Return the growth of the steps on the hardest text, and a short form of this text."""

    def steps(text: str) -> int:
        return Steps(use.pattern, MOST).search(text, anchored=use.anchored, full=use.full)

    steepest, hardest = 0.0, ""
    for make in hard_texts(use.pattern, full=use.full):
        try:
            middle = steps(make(LENGTH))
            if middle < PLENTY * len(make(LENGTH)):
                continue
            growth = (steps(make(2 * LENGTH)) - middle) / max(middle - steps(make(LENGTH // 2)), 1)
        except Budget:
            return float("inf"), make(4)
        steepest, hardest = max((steepest, hardest), (growth, make(4)))
    return steepest, hardest


USES = list(uses())


@pytest.mark.parametrize("use", USES, ids=lambda use: str(use.location))
def test_the_steps_of_a_pattern_grow_in_proportion_to_the_text(use: Use) -> None:
    growth, text = steepest_growth(use)
    assert growth < STEEP, f"{use.location}: {use.pattern.pattern!r} on texts such as {text!r}"


def test_patterns_are_found_in_modules_and_in_calls() -> None:
    locations = {use.location for use in USES}
    assert {"autograder/probes/launch_probe.py, _STARTED", "autograder/plain_text.py, _TERMINAL"} <= locations
    assert any(re.match(r"autograder/probes/colcon_test.py, line \d+", location) for location in locations)
    assert len(USES) > 40


@pytest.mark.parametrize(
    ("pattern", "anchored"),
    [
        (r"""\s*\w+\s*:\s*["']?[^"'#]*?["']?\s*(?:#.*)?""", True),
        (r"\[(?P<name>[^\]]+)-\d+\]: process started", False),
        (r"[^\s]*/(?=ws/src)", False),
        (r"(?:a+)+b", True),
        (r"(?:a|a)+b", True),
        (r"<(?:\w+_)?depend\b[^>]*>\s*([\w.-]+)", False),
        (r"(?m)^\[[^\]]+\] (?P<what>[\w.]*(?:Error|Exception)\b.*)$", False),
        (r"Caught exceptions.*\n - (?P<what>.+)", False),
        (r"(a.*)b\1", False),
    ],
)
def test_a_pattern_that_is_slow_on_some_text_is_found(pattern: str, anchored: bool) -> None:
    growth, _ = steepest_growth(Use("", re.compile(pattern), anchored, anchored))
    assert growth > STEEP


@pytest.mark.parametrize(
    ("pattern", "text"),
    [
        (r"\[(\w+)\] (?:INFO|WARN): .*", "[a] WARN: b\n[cd] INFO: e"),
        (r"(?m)^(a+?)b{2,3}$", "aabb\nab\nabbb\nabbbb"),
        (r"(?<=x)\d+(?!z)\b|(\w)\1", "x12z 33 x45 aa"),
        (r"(?i)[^a-c\s]+|[A-C]{2}", "xyz AbC d"),
        (r"(?:\d+h )?[\d.]+s", "1h 2.5s 3s s"),
    ],
)
def test_the_step_counter_finds_the_same_matches_as_python(pattern: str, text: str) -> None:
    compiled = re.compile(pattern)
    counter = Steps(compiled, MOST)
    counter.search(text, anchored=False, full=False)
    assert counter.matches == [match.span() for match in compiled.finditer(text)]
