"""Similar submissions are found although names differ, and code that the course gives is ignored."""

from __future__ import annotations

import io
import json
import re
import sys
import zipfile
from dataclasses import replace
from pathlib import Path, PurePosixPath

import nbformat
import pytest

from autograder.cli import main
from autograder.grade.isolated_reader import code
from autograder.lms import similar
from autograder.lms.similar import compare, write_page
from autograder.submission.intake import SubmittedFile, detect_layout
from tests.unit.lms.test_collect import MOODLE

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
    with pytest.raises(SystemExit) as exit_info:
        main(["similar", str(tmp_path), "--assignment", "02_nodes", "--out", str(tmp_path / "out")])
    assert exit_info.value.code == 2
    assert "run `.venv/bin/pip install copydetect`" in capsys.readouterr().err


@pytest.mark.promise("Code from the student release is excluded, and renaming does not hide a copy.")
def test_a_renamed_copy_is_found_and_given_code_is_ignored() -> None:
    codes = {name: GIVEN + text for name, text in {"alice": OWN, "bob": RENAMED, "carol": OTHER}.items()}
    (group,) = compare(codes, GIVEN, 0.5).groups
    assert group.names == ("alice", "bob")
    (pair,) = group.pairs
    assert pair.names == (("alice",), ("bob",))
    assert pair.shares == pytest.approx((1.0, 1.0))
    assert pair.texts is not None
    assert "closest" in pair.texts[1].partition("<mark>")[2]
    (all_of_them,) = compare(codes, "", 0.5).groups
    assert all_of_them.names == ("alice", "bob", "carol")


def test_unchanged_releases_are_not_similar() -> None:
    comparison = compare({"alice": GIVEN, "bob": GIVEN, "carol": ""}, GIVEN, 0.0)
    assert (comparison.groups, comparison.without_own_code) == ((), ("alice", "bob", "carol"))


def test_seven_equal_copies_are_one_group_with_one_pair_of_texts() -> None:
    names = [f"student {number}" for number in range(7)]
    (group,) = compare(dict.fromkeys(names, OWN), "", 0.5).groups
    assert group.names == tuple(names)
    (pair,) = group.pairs
    assert pair.names == ((names[0],), tuple(names[1:]))
    assert pair.shares == (1.0, 1.0)


def test_a_group_is_joined_by_its_most_similar_pairs_and_others_stay_apart() -> None:
    codes = {"ada": OWN, "bob": RENAMED, "carl": OWN + OTHER, "dora": OWN, "eve": f"{OTHER * 2}\n{GIVEN}", "fay": GIVEN}
    first, second = sorted(compare(codes, "", 0.95).groups, key=lambda group: group.names)
    assert (first.names, second.names) == (("ada", "bob", "carl", "dora"), ("eve", "fay"))
    assert [pair.names for pair in first.pairs] == [
        (("ada",), ("dora",)),
        (("ada", "dora"), ("bob",)),
        (("ada", "dora"), ("carl",)),
    ]


@pytest.mark.promise("The page `similar/index.html` shows groups of submissions")
def test_the_page_of_a_pair_shows_both_texts_escaped_and_says_that_it_is_not_a_verdict(tmp_path: Path) -> None:
    text = "# <script>\n" + OWN
    page = write_page(compare({"alice": text, "<bob>": text}, "", 0.5), tmp_path).read_text()
    assert page.count("<mark>") == page.count("</mark>") >= 2
    assert "<script>" not in page
    assert "<bob>" not in page
    assert "not a verdict" in page


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
    with pytest.raises(SystemExit) as exit_info:
        main(["similar", str(tmp_path / "class"), "--assignment", "02_nodes", "--out", str(tmp_path / "out")])
    assert exit_info.value.code == 1  # one could not be read
    captured = capsys.readouterr()
    assert "alice and bob: 100 % and 100 % of their own text in common" in captured.out
    assert "3 compared, 1 group to read" in captured.out
    assert "carol" not in captured.out
    assert "Not compared: dave: dave.zip is not a folder" in captured.err


def in_a_zip(text: str) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("answer/ws/src/p/node.py", text)
    return data.getvalue()


@pytest.mark.promise(
    "autograder similar download.zip --assignment 02_nodes --roster worksheet.csv --out similar",
    "The exit status is 1 if a submission cannot be read or fits no student",
)
def test_a_download_of_moodle_is_compared_by_the_names_of_its_roster(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "worksheet.csv").write_text(MOODLE, encoding="utf-8")
    download = tmp_path / "download.zip"
    with zipfile.ZipFile(download, "w") as archive:
        archive.writestr("Zoë Müller-Żak_101_assignsubmission_file_/a.zip", in_a_zip(OWN))
        archive.writestr("Jane Doe_102_assignsubmission_file_/b.zip", in_a_zip(RENAMED))
        archive.writestr("Bob Roe_103_assignsubmission_file_/c.zip", in_a_zip(OTHER))
    command = ["similar", str(download), "--assignment", "02_nodes", "--out", str(tmp_path / "out")]
    with pytest.raises(SystemExit) as exit_info:
        main(command)
    assert exit_info.value.code == 1
    assert "--roster" in capsys.readouterr().err
    with pytest.raises(SystemExit) as exit_info:
        main([*command, "--roster", str(tmp_path / "worksheet.csv"), "--json", str(tmp_path / "found.json")])
    assert exit_info.value.code == 0
    assert "jane@example.edu and zoe@example.edu: 100 % and 100 %" in capsys.readouterr().out
    (group,) = json.loads((tmp_path / "found.json").read_text())
    assert group["students"] == ["jane@example.edu", "zoe@example.edu"]


def test_members_of_a_group_with_one_submission_are_not_alike(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "roster.csv").write_text("SID,Name,Email\n1,Ada,a@x.edu\n2,Bob,b@x.edu\n3,Eve,e@x.edu\n")
    folder = tmp_path / "assignment_export"
    for name, text in (("submission_1", OWN), ("submission_2", OTHER)):
        (folder / name / "src").mkdir(parents=True)
        (folder / name / "src" / "node.py").write_text(text)
    (folder / "submission_metadata.yml").write_text(
        "submission_1:\n  :submitters: [{':sid': '1'}, {':sid': '2'}]\nsubmission_2:\n  :submitters: [{':sid': '3'}]\n"
    )
    arguments = ["--assignment", "02_nodes", "--out", str(tmp_path / "out"), "--roster", str(tmp_path / "roster.csv")]
    with pytest.raises(SystemExit) as exit_info:
        main(["similar", str(folder), *arguments])
    assert exit_info.value.code == 0
    assert "2 compared, 0 groups to read" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("texts", "reason"),
    [
        ({"ada": OWN}, "of 1 submissions, 1 contains code of its own"),
        ({"ada": "", "bob": "x = 1"}, "of 2 submissions, 0 contain code of their own"),
    ],
)
def test_without_two_comparable_submissions_the_command_says_so_and_exits_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], texts: dict[str, str], reason: str
) -> None:
    for name, text in texts.items():
        (tmp_path / "class" / name / "src").mkdir(parents=True)
        (tmp_path / "class" / name / "src" / "node.py").write_text(text)
    with pytest.raises(SystemExit) as exit_info:
        main(["similar", str(tmp_path / "class"), "--assignment", "02_nodes", "--out", str(tmp_path / "out")])
    assert exit_info.value.code == 1
    captured = capsys.readouterr()
    assert f"nothing was compared: {reason}" in captured.err
    assert "groups" not in captured.out
    assert not (tmp_path / "out").exists()


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
def test_only_the_start_of_a_long_text_is_compared_which_is_reported() -> None:
    notices: dict[str, str] = {}
    long = "".join(f"{OWN}# {number}" for number in range(2_000))
    (group,) = compare(
        {"alice": long, "bob": "a\n" * 700_000 + OTHER, "carol": OWN}, "", 0.5, notices.__setitem__
    ).groups
    assert group.names == ("alice", "carol")
    assert set(notices) == {"alice", "bob"}
    assert notices["alice"] == "the first 100,000 characters of its code; please check the rest yourself"
    (pair,) = group.pairs
    assert pair.texts is not None
    assert len(pair.texts[0].striptags()) <= similar.MAX_CHARACTERS


@pytest.mark.parametrize("part", HARD)
def test_lexing_and_comparing_take_time_proportional_to_the_text(part: str) -> None:
    """Counts the positions of a text that the lexer tries, and those that are compared."""

    def steps(length: int) -> tuple[int, int]:
        text = similar._dense(part * (length // len(part)))
        positions = sum(len(match) + 1 for match in re.findall(r"(?m)^(?=(\s*))", text))  # the lexer's first rules
        fingerprint = similar._fingerprint(text)
        return positions, sum(map(len, fingerprint.hash_idx.values()))

    short, long = steps(1000), steps(4000)
    assert all(long_count <= 5 * short_count + 100 for short_count, long_count in zip(short, long, strict=True))
    assert max(long) <= 10_000


def test_the_lexer_gets_no_long_and_no_empty_lines() -> None:
    r"""For each `\N{`, it looks for the end of the name up to the end of the line."""
    text = "'\\N{" * 2_000 + " " * 2_000 + "\n\nend"
    lines = similar._dense(text).split("\n")
    assert max(map(len, lines)) == similar.MAX_LINE
    assert all(line.strip() for line in lines)
    assert "".join(lines).replace(" ", "") == "".join(text.split())


def test_a_renamed_copy_in_one_long_line_is_found() -> None:
    calls = {"alice": "speed(front, 1), ", "bob": "rate(ahead, 1), "}
    (group,) = compare({name: f"values = [{call * 200}]" for name, call in calls.items()}, "", 0.5).groups
    assert group.names == ("alice", "bob")


def test_only_the_texts_of_the_most_similar_pairs_are_shown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(similar, "MAX_PAIRS", 3)
    codes = {name: f"{OWN}{OTHER}# {name}" for name in "abcdef"} | {"g": OWN}
    comparison = compare(codes, "", 0.0)
    (group,) = comparison.groups
    assert group.names == tuple("abcdefg")
    assert [pair.texts is not None for pair in group.pairs] == [True] * 3 + [False] * 3
    page = write_page(comparison, tmp_path).read_text()
    assert (page.count("<details"), page.count("the texts are not shown")) == (3, 3)
