"""Checking the files that a worker leaves costs little, whatever they contain."""

from __future__ import annotations

import json
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_notebook, new_output

from autograder.grade import executed_notebook, reply
from autograder.grade.bounded_json import NOTEBOOK_VALUES, read_json
from autograder.grade.executed_notebook import MAX_BYTES, decode, encode
from autograder.grade.job import Job
from autograder.grade.reply import ReplyError, check_reply
from autograder.grade.run_notebook import MAX_VALUES
from autograder.result.model import Artifact, CheckResult, Result
from autograder.run.sandbox.limits import MIB
from autograder.suite import Outcome

JOB = Job(Path("ada"), "02_nodes", "ada", 7, Path("out"))


@pytest.fixture
def result(make_result: Callable[..., Result]) -> Result:
    suite = JOB.suite
    checks = tuple(CheckResult.of(check, Outcome.PASSED) for check in suite.checks)
    versions = {"suite_version": suite.version, "files_digest": suite.files_digest, "max_score": suite.max_score}
    return make_result(JOB.student, checks=checks, seed=JOB.seed, isolation=JOB.isolation.value, **versions)


def files(result: Result, **other_files: bytes) -> dict[str, bytes]:
    return {"result.json": json.dumps(result.to_json()).encode(), **other_files}


def test_an_error_caused_by_a_reply_does_not_end_the_grading_of_a_class(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    for error in (OverflowError, KeyError, AttributeError, MemoryError):
        monkeypatch.setattr(
            reply, "from_json", lambda data, source, error=error: (_ for _ in ()).throw(error("of data"))
        )
        with pytest.raises(ReplyError, match=f"cannot be checked: {error.__name__}: .*of data"):
            check_reply(files(result), JOB)


@pytest.mark.parametrize(
    "flood",
    [b"[" + b"[]," * 2**20 + b"0]", b"[" + b'"",' * 2**20 + b"0]", b'"' * 3 * 2**20, b'["\\\\",' * 2**19, b"{" * 2**22],
    ids=["lists", "strings", "quotation marks", "backslashes", "objects"],
)
def test_json_of_too_many_values_is_refused_before_it_takes_memory(flood: bytes) -> None:
    tracemalloc.start()
    try:
        with pytest.raises(ValueError, match="more than 1,000 values"):
            read_json(flood, 1000)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 6 * len(flood)  # to parse the first takes 20 times as much


def test_a_string_counts_as_one_value() -> None:
    texts = ["[,{" * 5000, '"[,' * 5000, "\\" * 5001 + '"', "\\", ""]
    assert read_json(json.dumps(texts).encode(), 10) == texts


@pytest.mark.parametrize("number", ["1" * 101, "NaN", "-Infinity", "1e999"])
def test_a_result_with_a_number_that_no_page_can_show_is_refused(result: Result, number: str) -> None:
    assert check_reply(files(result), JOB) == result
    text = json.dumps(replace(result, seconds=123.25).to_json()).replace("123.25", number)
    with pytest.raises(ReplyError, match=r"it holds (a|the) number"):
        check_reply({"result.json": text.encode()}, JOB)


@pytest.mark.parametrize("name", ["result.json", "notebook.ipynb", "a.run.json"])
def test_the_values_of_each_file_are_counted_before_it_is_parsed(result: Result, name: str) -> None:
    reply_files = files(replace(result, artifacts=(Artifact("a.png", "track", "0" * 64, "x", run="a.run.json"),)))
    values = b'{"cells": [' + b"[]," * NOTEBOOK_VALUES + b"0]}"
    with pytest.raises(ReplyError, match=r"more than [0-9,]+ values|cannot identify image"):
        check_reply({**reply_files, "a.png": b"", "a.run.json": b"{}", name: values}, JOB)


def test_a_large_result_is_refused(result: Result) -> None:
    with pytest.raises(ReplyError, match="a result of 8,"):
        check_reply({"result.json": b" " * (8 * MIB + 1)}, JOB)


def test_a_result_that_names_a_file_a_thousand_times_is_refused(result: Result) -> None:
    repeated = replace(result, artifacts=(Artifact("a.png", "track", "0" * 64, "x"),) * 1000)
    with pytest.raises(ReplyError, match="shows its 1 files 1000 times"):
        check_reply(files(repeated, **{"a.png": bytes(MIB)}), JOB)


def test_a_notebook_with_the_maximum_of_outputs_and_lines_is_accepted(result: Result) -> None:
    """Stored as a list of lines, such a text would have millions of values and too many bytes."""
    values = [{"output_type": "display_data", "data": {"application/json": [[]] * (MAX_VALUES - 20)}, "metadata": {}}]
    lines = [new_output("stream", text="\n" * 4 * MIB)]
    cells = [new_code_cell("\n" * 2 * MIB, outputs=lines), {**new_code_cell(), "outputs": values}]
    data = encode(NotebookNode({**new_notebook(), "cells": list(map(NotebookNode, cells))}))
    assert len(data) < MAX_BYTES
    check_reply(files(result, **{"notebook.ipynb": data}), JOB)
    assert decode(data)[0].outputs == lines


def test_a_notebook_that_would_be_too_large_is_kept_without_its_outputs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executed_notebook, "MAX_BYTES", 1000)
    outputs = [new_output("stream", text="x" * 1000)]
    (cell,) = decode(encode(new_notebook(cells=[new_code_cell("1", outputs=outputs)])))
    assert (cell.source, cell.outputs) == ("1", [])


def test_jupyter_and_the_grader_read_each_other_s_notebooks() -> None:
    notebook = new_notebook(cells=[new_code_cell("1\n2", outputs=[new_output("stream", text="a\nb")])])
    read = nbformat.reads(encode(notebook).decode(), as_version=4)
    nbformat.validate(read)
    assert read == notebook
    assert decode(nbformat.writes(notebook).encode())[0].source == "1\n2"


@pytest.mark.parametrize(
    "data",
    [
        b"[]",
        b'{"cells": 1}',
        b'{"cells": ["x"]}',
        b'{"cells": [{"cell_type": "code", "source": 1, "outputs": []}]}',
        b'{"cells": [{"cell_type": "code", "source": "", "outputs": [1]}]}',
        b'{"cells": [{"cell_type": "code", "source": "", "outputs": [], "metadata": []}]}',
        b"[" * 100_000,
        b"\xff",
    ],
)
def test_a_file_that_is_not_a_notebook_is_rejected(result: Result, data: bytes) -> None:
    with pytest.raises(ReplyError, match="the notebook in a worker's reply cannot be read"):
        check_reply(files(result, **{"notebook.ipynb": data}), JOB)
