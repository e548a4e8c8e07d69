"""Stored results are read, and unreadable ones are named."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder.exceptions import UsageError
from autograder.report.export import load
from autograder.result.model import Result, write_json

MakeResult = Callable[..., Result]


def test_a_folder_of_results_is_read_in_the_order_of_its_paths(make_result: MakeResult, tmp_path: Path) -> None:
    for student in ("bob", "alice"):
        write_json(tmp_path / student / "result.json", make_result(student).to_json())
    stored = load(tmp_path)
    assert list(stored) == [make_result("alice"), make_result("bob")]
    assert [item.folder for item in stored] == [tmp_path / "alice", tmp_path / "bob"]


def test_a_single_result_is_read(make_result: MakeResult, tmp_path: Path) -> None:
    write_json(tmp_path / "result.json", make_result().to_json())
    assert load(tmp_path / "result.json") == load(tmp_path)


def test_each_result_of_a_list_has_its_folder(make_result: MakeResult, tmp_path: Path) -> None:
    write_json(tmp_path / "results.json", [make_result("alice").to_json(), make_result("bob").to_json()])
    (tmp_path / "bob").mkdir()
    assert [item.folder for item in load(tmp_path)] == [tmp_path, tmp_path / "bob"]
    assert load(tmp_path / "results.json") == load(tmp_path)


def test_a_missing_path_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"nowhere: no such file or folder; use the folder that `autograder grade"):
        load(tmp_path / "nowhere")


def test_an_empty_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"contains no result\.json; use the folder"):
        load(tmp_path)


def test_a_file_that_is_not_json_is_named(tmp_path: Path) -> None:
    (tmp_path / "result.json").write_text("{")
    with pytest.raises(UsageError, match=r"result\.json: cannot be read as JSON: Expecting property name"):
        load(tmp_path)


def test_an_entry_that_is_not_a_result_is_named_by_its_position(make_result: MakeResult, tmp_path: Path) -> None:
    (tmp_path / "results.json").write_text(json.dumps([make_result().to_json(), {}]))
    with pytest.raises(UsageError, match=r"results\.json, entry 1: not a grading result: the top level"):
        load(tmp_path)
