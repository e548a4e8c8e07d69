"""Similar submissions are found although names differ, and code that the course gives is ignored."""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from pathlib import Path, PurePosixPath

import nbformat
import pytest

from autograder.cli import main
from autograder.grade.apart import code
from autograder.lms import similar
from autograder.lms.similar import pairs, write_pairs
from autograder.submission.intake import SubmittedFile, detect_layout

GIVEN = "\n".join(f"def given_{n}(a, b):\n    return [a * {n} + b, (a - b) / {n + 1}]" for n in range(9))
OWN = """
def nearest(scan):
    best = None
    for index, distance in enumerate(scan.ranges):
        if scan.range_min <= distance <= scan.range_max and (best is None or distance < best[1]):
            best = (index, distance)
    return best
"""
RENAMED = OWN.replace("best", "closest").replace("distance", "metres").replace("nearest", "find")
OTHER = """
class Finder:
    def __call__(self, scan):
        valid = [r for r in scan.ranges if r > scan.range_min]
        while valid and valid[-1] > scan.range_max:
            valid.pop()
        assert len(valid) < 1000, f"{len(valid)} are too many"
        return min(valid, default=float("inf"))
"""


@pytest.mark.promise(".venv/bin/pip install copydetect")
def test_without_copydetect_the_command_says_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Missing:
        @staticmethod
        def find_spec(name: str, *_: object) -> None:
            if name == "copydetect":
                raise ModuleNotFoundError(name=name)

    for name in [name for name in sys.modules if name.partition(".")[0] == "copydetect"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delitem(sys.modules, "autograder.lms.similar")
    monkeypatch.setattr(sys, "meta_path", [Missing, *sys.meta_path])
    with pytest.raises(SystemExit) as ended:
        main(["similar", str(tmp_path), "--assignment", "02_nodes", "--out", str(tmp_path / "out")])
    assert ended.value.code == 2
    assert "run `.venv/bin/pip install copydetect`" in capsys.readouterr().err


@pytest.mark.promise("Code from the student release is excluded, and renaming does not hide a copy.")
def test_a_renamed_copy_is_found_and_given_code_is_ignored() -> None:
    codes = {name: GIVEN + text for name, text in {"alice": OWN, "bob": RENAMED, "carol": OTHER}.items()}
    (found,) = pairs(codes, GIVEN, 0.5)
    assert found.names == ("alice", "bob")
    assert found.shares == pytest.approx((1.0, 1.0))
    assert "closest" in found.texts[1].partition("<mark>")[2]
    assert len(pairs(codes, "", 0.5)) == 3


def test_unchanged_releases_are_not_similar() -> None:
    assert pairs({"alice": GIVEN, "bob": GIVEN, "carol": ""}, GIVEN, 0.0) == []


@pytest.mark.promise("The page `similar/index.html` shows pairs of submissions side by side")
def test_the_page_of_a_pair_shows_both_texts_escaped_and_says_that_it_is_no_verdict(tmp_path: Path) -> None:
    text = "# <script>\n" + OWN
    page = write_pairs(pairs({"alice": text, "<bob>": text}, "", 0.5), tmp_path).read_text()
    assert page.count("<mark>") == page.count("</mark>") >= 2
    assert "<script>" not in page
    assert "<bob>" not in page
    assert "no verdict" in page


def test_the_code_of_a_submission_is_its_modules_and_its_notebooks_cells() -> None:
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("x = 1"), nbformat.v4.new_markdown_cell("y")])
    files = {
        "02_nodes.ipynb": nbformat.writes(notebook).encode(),
        "ws/src/p/p/node.py": b"z = 2\xff",
        "ws/src/p/a.md": b"w",
    }
    submitted = [SubmittedFile(PurePosixPath(path), data) for path, data in files.items()]
    assert code(detect_layout(submitted, "02_nodes")) == "# p/p/node.py\nz = 2\ufffd\nx = 1"
    assert "z = 2" in code(replace(detect_layout(submitted, "02_nodes"), notebook=b"no notebook"))


@pytest.mark.promise("autograder similar submissions/ --assignment 02_nodes --out similar")
def test_similar_compares_a_class_and_names_unreadable_submissions(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, text in {"alice": OWN, "bob": RENAMED, "carol": OTHER}.items():
        node = tmp_path / "class" / name / "src" / "p" / "node.py"
        node.parent.mkdir(parents=True)
        node.write_text(text)
    (tmp_path / "class" / "dave.zip").write_bytes(b"no zip")
    with pytest.raises(SystemExit) as ended:
        main(["similar", str(tmp_path / "class"), "--assignment", "02_nodes", "--out", str(tmp_path / "out")])
    assert ended.value.code == 0
    told = capsys.readouterr()
    assert "alice and bob: 100 % and 100 % of their own text alike" in told.out
    assert "carol" not in told.out
    assert "Not compared: dave: dave.zip is not a folder" in told.err


HARD = (
    "\n ",
    "\n\n\t",
    " \f\n",
    "\x1e\n",
    "from \\\n",
    "'''\n",
    "r'''\n ",
    'f"{',
    "def \\\n",
    "0_",
    "(",
    "a\n",
    "lambda ",
)


@pytest.mark.promise("the command lists students whose code is longer")
def test_of_a_long_text_so_many_characters_are_compared_and_that_is_said() -> None:
    told: dict[str, str] = {}
    long = "".join(f"{OWN}# {number}" for number in range(2_000))
    (found,) = pairs({"alice": long, "bob": "a\n" * 700_000 + OTHER, "carol": OWN}, "", 0.5, told.__setitem__)
    assert found.names == ("alice", "carol")
    assert set(told) == {"alice", "bob"}
    assert told["alice"] == "the first 100,000 characters of its code, look at the rest yourself"
    assert len(found.texts[0].striptags()) <= similar.MAX_CHARACTERS


@pytest.mark.parametrize("part", HARD)
def test_a_lexer_and_a_pair_take_steps_in_proportion_to_a_text(part: str) -> None:
    """What is counted is what they ask for: the places of a text that the lexer tries, and those that are compared."""

    def steps(length: int) -> tuple[int, int]:
        text = similar._dense(part * (length // len(part)))
        looked = sum(len(match) + 1 for match in re.findall(r"(?m)^(?=(\s*))", text))  # the lexer's first rules
        found = similar._fingerprint(text)
        return looked, sum(map(len, found.hash_idx.values()))

    short, long = steps(1000), steps(4000)
    assert all(more <= 5 * few + 100 for few, more in zip(short, long, strict=True))
    assert max(long) <= 10_000


def test_the_most_alike_of_many_pairs_are_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(similar, "MAX_PAIRS", 3)
    codes = {name: OWN + OTHER for name in "abcdef"} | {"g": OWN}
    assert [pair.names for pair in pairs(codes, "", 0.0)] == [("a", "b"), ("a", "c"), ("a", "d")]
