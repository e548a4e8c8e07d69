"""The report of repeated gradings: an interrupted run is continued, and a difference is found."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from tests.benchmarks.repeat_capstone import Grading, cut_off, stored, summarise

ONE = Grading("v1", 1, 2, 100.0, (), {"corner.json": "0123"}, 7.5)


def test_gradings_of_one_version_are_kept_and_an_incomplete_line_is_not(tmp_path: Path) -> None:
    report = tmp_path / "capstones.jsonl"
    assert stored(report, "v1") == {}
    other = replace(ONE, version="v2", number=2)
    report.write_text(
        "".join(json.dumps(asdict(grading)) + "\n" for grading in (ONE, other)) + '{"version": "v1", "num'
    )
    assert {number: asdict(grading) for number, grading in stored(report, "v1").items()} == {
        1: {**asdict(ONE), "lost": ()},
    }
    assert cut_off(report)


@pytest.mark.parametrize("text", [None, "", "a line\n"])
def test_a_report_that_ends_with_a_complete_line_is_not_cut_off(text: str | None, tmp_path: Path) -> None:
    report = tmp_path / "capstones.jsonl"
    if text is not None:
        report.write_text(text)
    assert not cut_off(report)


@pytest.mark.parametrize(
    ("different", "line"),
    [
        (ONE, ""),
        (replace(ONE, number=2, percent=99.0), "number 2: 99 %, other traces: none\n"),
        (replace(ONE, number=2, traces={"corner.json": "ffff"}), "number 2: 100 %, other traces: corner.json\n"),
        (replace(ONE, number=2, traces={}), "number 2: 100 %, other traces: corner.json\n"),
    ],
)
def test_a_grading_that_differs_is_named(different: Grading, line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert summarise([ONE, different]) == bool(line)
    assert capsys.readouterr().out == f"{line}{2 - bool(line)} of 2 with all points and the same traces: {ONE.traces}\n"
