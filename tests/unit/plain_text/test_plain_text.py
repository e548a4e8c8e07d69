"""Cleaning text that came out of a student's program."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.plain_text import MAX_NAME, MAX_NAMES, clean, comparable, nearest


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


def test_the_nearest_name_is_the_likeliest_misspelling() -> None:
    assert nearest("/cmd_vel", ["/odom", "/cmd_val", "/scan"]) == "/cmd_val"
    assert nearest("/cmd_vel", ["/odom"]) == ""


def test_only_some_of_many_long_names_are_compared() -> None:
    names = ["/cmd_vel" * 100_000, *(f"/cmd_val{number:06}" for number in range(300_000)), "/cmd_vel"]
    assert nearest("/cmd_vel", names) != "/cmd_vel"
    assert len(comparable(names)) == MAX_NAMES
    assert max(map(len, comparable(names))) <= MAX_NAME
