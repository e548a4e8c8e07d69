"""A release keeps the docstrings and loses the answers."""

from __future__ import annotations

import ast

import pytest

from autograder.author.course.exceptions import CourseError
from autograder.author.course.solution_markers import mark_functions, strip_markers
from autograder.submission.exercise_stubs import CODE_STUB

MODULE = '''"""A module."""

import math


def half(x: float) -> float:
    """Return half of x."""
    # The answer.
    return x / 2


class Robot:
    """A robot."""

    def __init__(
        self,
    ):
        """Start."""
        self.x = math.inf

    def move(self):
        """
        Move.

        Twice.
        """
        for _ in range(2):
            self.x = half(
                self.x
            )

    def look(self):
        """Look."""
        return self.x
'''


def test_only_the_bodies_of_the_named_functions_are_marked() -> None:
    marked = mark_functions(MODULE, ["half", "Robot.move"])
    assert '    """Return half of x."""\n    # BEGIN SOLUTION\n    # The answer.\n    return x / 2\n    #' in marked
    assert (
        '        """\n        # BEGIN SOLUTION\n        for _ in range(2):\n            self.x = half(\n'
        "                self.x\n            )\n        # END SOLUTION\n\n    def look" in marked
    )
    assert marked.count("# BEGIN SOLUTION") == marked.count("# END SOLUTION") == 2


PARTS = '''def drive(node):
    """Drive."""
    command = Twist()
    while node.ok():
        command.linear.x = 1.0

        command.angular.z = 0.0
        node.publish(command)
    return command
'''


@pytest.mark.parametrize(
    ("before", "after", "hidden"),
    [
        ("command = Twist()", "return command", PARTS.splitlines()[3:8]),
        ("while node.ok():", "node.publish(command)", PARTS.splitlines()[4:7]),
        ("", "while node.ok():", PARTS.splitlines()[2:3]),
        ("node.publish(command)", "", PARTS.splitlines()[8:]),
    ],
)
def test_only_the_named_parts_of_a_function_are_marked(before: str, after: str, hidden: list[str]) -> None:
    marked = mark_functions(PARTS, ["drive"], {"drive": (before, after)})
    lines = marked.splitlines()
    begin, end = (next(n for n, line in enumerate(lines) if mark in line) for mark in ("# BEGIN", "# END"))
    assert lines[begin + 1 : end] == hidden
    assert lines[begin].index("#") == len(hidden[0]) - len(hidden[0].lstrip())
    assert strip_markers(marked) == PARTS
    ast.parse(marked.replace("# BEGIN SOLUTION", CODE_STUB.splitlines()[1]))


@pytest.mark.parametrize(
    ("hide", "parts", "message"),
    [
        (["drive"], {"stop": ("", "")}, "`parts` names stop, which `hide` does not name"),
        (["drive"], {"drive": ("def drive(node):", "")}, "the line 'def drive.* occurs 0 times"),
        (["drive"], {"drive": ("return command", "")}, "no text to hide"),
    ],
)
def test_a_part_that_cannot_be_hidden_is_named(
    hide: list[str], parts: dict[str, tuple[str, str]], message: str
) -> None:
    with pytest.raises(CourseError, match=message):
        mark_functions(PARTS, hide, parts)


def test_removing_the_markers_restores_the_source() -> None:
    assert strip_markers(mark_functions(MODULE, ["half", "Robot.__init__", "Robot.move"])) == MODULE


def test_the_marked_source_has_the_same_syntax_tree() -> None:
    assert ast.dump(ast.parse(mark_functions(MODULE, ["half", "Robot.look"]))) == ast.dump(ast.parse(MODULE))


def test_the_stub_raises_an_error_that_tells_the_student_to_write_it() -> None:
    with pytest.raises(NotImplementedError, match="still to be written"):
        exec(CODE_STUB)


@pytest.mark.parametrize(
    ("text", "hide", "message"),
    [
        (MODULE, ["Robot.mvoe"], r"function 'Robot.mvoe' occurs 0 times in the source; its functions: Robot.__init__"),
        ("def f():\n    '''F.'''\n    return 1\n" * 2, ["f"], "occurs 2 times"),
        ("def f():\n    return 1\n", ["f"], "has no docstring"),
        ("def f():\n    '''F.'''\n", ["f"], "no separate lines to hide"),
        ("def f(): '''F.'''; return 1\n", ["f"], "no separate lines to hide"),
        ("def f(:\n", ["f"], "does not parse"),
        ("# BEGIN SOLUTION\n", [], "contains solution markers"),
        (
            "def f():\n    '''F.'''\n    def g():\n        '''G.'''\n        return 1\n    return g\n",
            ["f", "f.g"],
            "nested parts",
        ),
    ],
)
def test_a_function_that_cannot_be_hidden_is_named(text: str, hide: list[str], message: str) -> None:
    with pytest.raises(CourseError, match=message):
        mark_functions(text, hide)
