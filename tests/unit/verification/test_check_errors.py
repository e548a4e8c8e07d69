"""An error that a check itself raises is found with its file and line."""

from __future__ import annotations

import traceback
from pathlib import Path

from autograder.author.verification.check_errors import errors_in_checks


def traceback_of(source: str, file: Path) -> str:
    """Return the traceback of a function of this source in this file."""
    names: dict[str, object] = {}
    exec(compile(source, str(file), "exec"), names)
    try:
        names["test_it"]()  # type: ignore[operator]
    except AttributeError as error:
        return "".join(traceback.format_exception(error))
    raise AssertionError


def test_each_error_is_named_once_at_the_last_line_of_the_checks(tmp_path: Path) -> None:
    checks = tmp_path / "checks"
    file = checks / "ch01" / "hidden" / "limits.py"
    in_check = traceback_of("\n\ndef test_it():\n    'reply'.successful\n", file)
    outside = traceback_of("\ndef test_it():\n    'reply'.successful\n", tmp_path / "tool.py")
    message = "AttributeError: 'str' object has no attribute 'successful'"
    assert errors_in_checks(f"{in_check}\n{outside}\n{in_check}", checks) == [f"{file}:4: {message}"]
    assert errors_in_checks("the machine is full", checks) == []
