"""Short texts on the pages of feedback: one line, and numbers."""

from __future__ import annotations

import pytest

from autograder.report.feedback.text import number, one_line


def test_one_line_replaces_white_space_by_single_spaces() -> None:
    assert one_line(" a\n\tb \x07") == "a b \ufffd"


@pytest.mark.parametrize(
    ("value", "text"), [(3.0, "3"), (2.5, "2.5"), (1 / 3, "0.33"), (0.0, "0"), (100.0, "100"), (123456.0, "123456")]
)
def test_points_are_written_without_trailing_zeros(value: float, text: str) -> None:
    assert number(value) == text
