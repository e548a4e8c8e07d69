"""Hidden text is found in the files that students get, in any encoding."""

from __future__ import annotations

import base64
import codecs
import random
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image, PngImagePlugin

from autograder import course_paths
from autograder.author.verification.leaks import hidden_text_in, texts_of
from autograder.author.verification.verdicts import hidden_lines
from autograder.probes.leak_markers import draw_marker
from autograder.suite import suites

WORD = draw_marker(random.Random(1))
LINE = "def test_the_robot_stops_before_the_wall(robot: Robot) -> None:"
ENCODINGS: dict[str, Callable[[str], str]] = {
    "plain": str,
    "reversed": lambda text: text[::-1],
    "upper case": str.upper,
    "rot13": lambda text: codecs.encode(text, "rot13"),
    "hex": lambda text: text.encode().hex(),
    "hex with an odd beginning": lambda text: "a" + text.encode().hex(" "),
    "base64": lambda text: base64.b64encode(text.encode()).decode(),
    "base64, one on": lambda text: base64.b64encode(b"x" + text.encode()).decode(),
    "base64, two on": lambda text: base64.urlsafe_b64encode(b"xy" + text.encode()).decode(),
    "base64 in a word": lambda text: "abc" + base64.b64encode(text.encode()).decode(),
    "per cent": lambda text: "".join(f"%{ord(char):02x}" for char in text),
    "escapes": lambda text: "".join(f"\\x{ord(char):02x}" for char in text),
    "dots between": lambda text: ".".join(text),
    "lines between": lambda text: "\n".join(text),
    "one test each": lambda text: " ".join(f"test_a[{char}]" for char in text),
    "numbers": lambda text: " ".join(str(ord(char)) for char in text),
}


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_a_planted_word_is_found_in_each_encoding(encoding: str) -> None:
    encoded = ENCODINGS[encoding](f"return best  # {WORD}")
    assert hidden_text_in(f'{{"message": "2 of 3 tests fail: {encoded}"}}') == [WORD]


@pytest.mark.parametrize("encoding", [name for name in ENCODINGS if name not in ("one test each", "numbers")])
def test_a_hidden_line_is_found_in_each_encoding(encoding: str) -> None:
    assert hidden_text_in(f"<p>{ENCODINGS[encoding](LINE)}</p>", [LINE, "def test_of_another_kind(robot)"]) == [LINE]


def test_a_notebook_contains_no_hidden_text() -> None:
    for assignment in suites.graded_assignments():
        text = course_paths.source_notebook(assignment).read_text(encoding="utf-8")
        assert hidden_text_in(text, hidden_lines(assignment)) == []


def test_all_files_of_a_result_and_the_metadata_of_pictures_are_searched(tmp_path: Path) -> None:
    words = [draw_marker(random.Random(seed)) for seed in range(4)]
    (tmp_path / "result.json").write_text(words[0])
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / f"{words[1]}.run.json").write_text("{}")
    info = PngImagePlugin.PngInfo()
    info.add_text("Title", words[2], zip=True)
    Image.new("RGB", (2, 2)).save(tmp_path / "track.png", pnginfo=info)
    (tmp_path / "feedback.html").write_text(f"<p>{words[3]}</p>")
    assert sorted({word for text in texts_of(tmp_path) for word in hidden_text_in(text)}) == sorted(words)
