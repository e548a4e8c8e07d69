"""A template that is scanned once expands as one that is scanned each time."""

from __future__ import annotations

from importlib import import_module
from io import StringIO
from typing import Any

import pytest

from autograder.interfaces.templates import scan_once

em: Any = import_module("em")
TEMPLATES = {
    "text alone": "no markup at all\n",
    "a loop": "@[for x in numbers]@\n@(x * 2), '@(name)'\n@[end for]@\n",
    "a choice": "@[if numbers]@\nsome@\n@[elif name]@\na name@\n@[else]@\nnothing@\n@[end if]\n",
    "a statement": "@{\ntotal = sum(numbers)  # a ']' and a \"}\"\n}@\n@(total)@# a comment\nend\n",
    "an expression at the very end": "last: @(name)",
    "a word at the very end": "last: @name",
    "a loop at the very end": "@[for x in numbers]@(x)@[end for]",
    "nothing": "",
}


@pytest.fixture(autouse=True)
def _own_string(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(em.Interpreter, "string", em.Interpreter.string)  # put back afterwards


def expand(template: str, **values: Any) -> str:
    """Expand a template as rosidl does."""
    output = StringIO()
    config = em.Configuration(defaultStdout=output, deleteOnError=True, rawErrors=True, useProxy=True)
    interpreter = em.Interpreter(config=config, dispatcher=False)
    try:
        interpreter.string(template, locals=values)
    finally:
        interpreter.shutdown()
    return output.getvalue()


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_expands_as_before_for_one_interface_after_the_other(name: str) -> None:
    cases: list[dict[str, Any]] = [{"numbers": [1, 2], "name": "one"}, {"numbers": [], "name": "none"}]
    expected = [expand(TEMPLATES[name], **values) for values in cases]
    scan_once()
    assert [expand(TEMPLATES[name], **values) for values in (*cases, *cases)] == [*expected, *expected]


def test_a_template_that_does_not_end_is_still_an_error() -> None:
    scan_once()
    with pytest.raises(em.ParseError):
        expand("@[for x in numbers]@(x)", numbers=[1])


def test_a_template_is_scanned_once(monkeypatch: pytest.MonkeyPatch) -> None:
    scanned: list[str] = []
    original = em.Scanner

    def scanner(config: Any, context: Any, currents: Any, data: str = "") -> Any:
        scanned.append(data)
        return original(config, context, currents, data)

    scan_once()
    monkeypatch.setattr(em, "Scanner", scanner)
    for number in range(3):
        assert expand("@(number)!", number=number) == f"{number}!"
    assert scanned == ["@(number)!"]
