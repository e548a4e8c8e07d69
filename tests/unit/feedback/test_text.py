"""Cleaning text that came out of a student's program."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.feedback.text import number, one_line
from autograder.plain_text import clean


@settings(deadline=None)
@given(st.text(st.integers(0, 0x10FFFF).map(chr)))
def test_cleaned_text_is_fit_for_utf8_and_for_xml(text: str) -> None:
    cleaned = clean(text)
    element = ET.Element("a")
    element.text = cleaned
    assert ET.fromstring(ET.tostring(element, encoding="utf-8")).text == (cleaned or None)


@settings(deadline=None)
@given(st.text(st.sampled_from("abc é\n\t€😀")))
def test_ordinary_text_is_left_as_it_is(text: str) -> None:
    assert clean(text) == text


def test_colours_and_window_titles_of_a_terminal_are_dropped() -> None:
    assert clean("\x1b[1;31mFAILED\x1b[0m \x1b]0;title\x07done\r\n") == "FAILED done\n"


def test_one_line_folds_white_space() -> None:
    assert one_line(" a\n\tb \x07") == "a b \ufffd"


@pytest.mark.parametrize(
    ("value", "text"), [(3.0, "3"), (2.5, "2.5"), (1 / 3, "0.33"), (0.0, "0"), (100.0, "100"), (123456.0, "123456")]
)
def test_points_are_written_as_people_write_them(value: float, text: str) -> None:
    assert number(value) == text
