"""The cost of reading a submission: a small one takes neither gigabytes nor minutes."""

from __future__ import annotations

import bz2
import io
import json
import struct
import sys
import tarfile
import time
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from types import FrameType
from typing import TYPE_CHECKING

import nbformat
import pytest

from autograder.exceptions import StudentError
from autograder.grade import isolated_reader
from autograder.run.sandbox import Isolation
from autograder.submission import intake
from autograder.submission.intake import SubmittedFile, detect_layout, notebooks, read_submission
from autograder.submission.intake import files as unpacking
from autograder.submission.intake.ignored import MAX_ENVIRONMENTS, IgnoredPaths
from autograder.submission.intake.notebooks import MAX_CELLS, MAX_VALUES, read_cells

if TYPE_CHECKING:
    from _typeshed import TraceFunction

CHAPTER = "02_nodes"
MIB = 1024 * 1024


def understated_zip(packed: bytes, method: int) -> bytes:
    """Return a zip that states 1,000 bytes for its notebook, although `packed` unpacks to far more."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(f"{CHAPTER}.ipynb", packed)
    data = bytearray(file.getvalue())
    for head, method_offset, size_offset in ((b"PK\x03\x04", 8, 22), (b"PK\x01\x02", 10, 24)):
        struct.pack_into("<H", data, data.find(head) + method_offset, method)
        struct.pack_into("<I", data, data.find(head) + size_offset, 1000)
    return bytes(data)


def tar_of_zeros(size: int) -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w") as archive:
        info = tarfile.TarInfo("build/zeros")  # never parsed: its bytes are skipped
        info.size = size
        archive.addfile(info, io.BytesIO(bytes(size)))
    return bz2.compress(file.getvalue())


def test_a_zip_of_another_method_is_unpacked_in_steps(tmp_path: Path) -> None:
    path = tmp_path / "ada.zip"
    path.write_bytes(understated_zip(bz2.compress(bytes(100 * MIB)), zipfile.ZIP_BZIP2))
    tracemalloc.start()
    try:
        with pytest.raises(StudentError, match="does not match its checksum in the archive"):
            read_submission(path, CHAPTER)
        assert tracemalloc.get_traced_memory()[1] < 10 * MIB
    finally:
        tracemalloc.stop()


def test_all_archives_of_a_submission_share_one_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpacking, "MAX_UNPACKED_BYTES", 20 * MIB)
    for number in range(8):
        (tmp_path / f"{number}.tar.bz2").write_bytes(tar_of_zeros(3 * MIB))
    with pytest.raises(StudentError, match="contain too much data in all"):
        read_submission(tmp_path, CHAPTER)


@pytest.mark.parametrize("name", ["a/" * 100 + "x", "x" * 5000])
def test_an_impossible_file_name_is_rejected_before_it_is_looked_up(name: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "ada.zip", "w") as archive:
        archive.writestr(name, b"")
    with pytest.raises(StudentError, match=r"has more than 1024 characters or 64 folders"):
        read_submission(tmp_path / "ada.zip", CHAPTER)


def test_thousands_of_nested_packages_are_found_quickly() -> None:
    paths = [f"{'x/' * depth}q{depth}/package.xml" for depth in range(13)]
    paths += [f"{'x/' * 13}p{number}/package.xml" for number in range(1900)]
    files = [SubmittedFile(PurePosixPath(path), b"<name>a</name>") for path in paths]
    started_at = time.process_time()
    assert detect_layout(files, CHAPTER).source
    assert time.process_time() - started_at < 10  # it took 90 s when each file was compared with each package


def test_a_submission_that_crashes_its_reader_does_not_end_the_grading_of_a_class(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(intake, "read_contents", fail)
    with pytest.raises(StudentError, match="Your submission cannot be read"):
        read_submission(tmp_path, CHAPTER)
    assert isolated_reader.read_digests(tmp_path, CHAPTER, Isolation.PROCESS) is None


def steps_of(work: Callable[[], object]) -> int:
    """Count the lines of Python that `work` executes."""
    count = 0

    def count_line(frame: FrameType, event: str, argument: object) -> TraceFunction:
        nonlocal count
        count += event == "line"
        return count_line

    previous = sys.gettrace()
    sys.settrace(count_line)
    try:
        work()
    finally:
        sys.settrace(previous)
    return count


def test_nested_environments_are_found_in_time_proportional_to_the_names() -> None:
    def steps(names: int, depth: int) -> int:
        deep = "/".join(["conda-meta"] * depth)
        paths = [PurePosixPath(f"{deep}/{number}") for number in range(names)]

        def search() -> None:
            ignored = IgnoredPaths(paths)
            assert all(path in ignored for path in paths)

        search()  # pathlib caches the parts of each path
        return steps_of(search)

    assert steps(400, 60) < 2.2 * steps(200, 60)
    assert steps(200, 60) < 1.2 * steps(200, 20)


def test_an_archive_that_contains_only_environments_is_rejected() -> None:
    paths = [PurePosixPath(f"{number}/pyvenv.cfg") for number in range(MAX_ENVIRONMENTS + 1)]
    with pytest.raises(StudentError, match="more than 1000 environments of Python"):
        IgnoredPaths(paths)


def test_metadata_of_cells_do_not_stay_in_memory() -> None:
    values = b"[" + b",".join([b"[]"] * (MAX_VALUES // 3)) + b"]"
    body = b'{"nbformat":4,"nbformat_minor":5,"metadata":{},"cells":[{"cell_type":"raw","source":"","metadata":%b}]}'
    for metadata in (b'{"a":%b}' % values, b'{"nbgrader":%b}' % values):
        tracemalloc.start()
        try:
            assert [cell["metadata"] for cell in read_cells(body % metadata)] == [{}]
            assert tracemalloc.get_traced_memory()[0] < MIB
        finally:
            tracemalloc.stop()


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        (b'{"cell_type":"raw","metadata":{"a":[' + b"[]," * MAX_VALUES + b"1]}}", "more than 2,000,000 values"),
        (b",".join([b'{"cell_type":"raw"}'] * (MAX_CELLS + 1)), "more than 20,000 cells"),
    ],
    ids=["values", "cells"],
)
def test_a_notebook_that_exceeds_every_realistic_size_is_not_read(cells: bytes, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read_cells(b'{"nbformat":4,"cells":[%b]}' % cells)


def of_format_3(*worksheets: object) -> bytes:
    return json.dumps(
        {"nbformat": 3, "nbformat_minor": 0, "metadata": {"name": "x"}, "worksheets": worksheets}
    ).encode()


def test_cells_of_an_old_notebook_are_counted_before_they_are_converted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The validation of half a million cells by nbformat took 90 s."""
    monkeypatch.setattr(notebooks, "_upgraded", lambda cell: pytest.fail("a cell was converted"))
    half = {"cells": [{"cell_type": "raw", "source": ""}] * (MAX_CELLS // 2 + 1)}
    with pytest.raises(ValueError, match="more than 20,000 cells"):
        read_cells(of_format_3(half, half))


def test_an_old_notebook_is_converted_like_nbformat_does() -> None:
    cells = [
        {"cell_type": "code", "input": ["a = 1\n", "b"], "language": "python", "outputs": [], "metadata": {}},
        {"cell_type": "heading", "level": 3, "source": "Nodes\nand topics", "metadata": {}},
        {"cell_type": "heading", "source": "Title", "metadata": {}},
        {"cell_type": "html", "source": "<b>x</b>", "metadata": {}},
        {"cell_type": "markdown", "source": "text", "metadata": {}},
        {"cell_type": "raw", "source": "raw", "metadata": {}},
    ]
    expected = nbformat.v4.convert.upgrade(
        nbformat.from_dict(json.loads(of_format_3({"cells": cells[:3]}, {"cells": cells[3:]})))
    )
    converted = read_cells(of_format_3({"cells": cells[:3]}, {"cells": cells[3:]}))
    assert [(cell["cell_type"], cell["source"]) for cell in converted] == [
        (cell.cell_type, "".join(cell.source)) for cell in expected.cells
    ]


@pytest.mark.parametrize(
    "worksheets", [[{}], [7], [{"cells": 7}], [{"cells": [7]}], [{"cells": [{"cell_type": "heading", "source": 7}]}]]
)
def test_an_old_notebook_with_another_structure_is_unreadable(worksheets: list[object]) -> None:
    with pytest.raises(ValueError, match=r"it has no list of cells|is not a code, Markdown|is not text"):
        read_cells(of_format_3(*worksheets))


def test_cells_without_ids_get_free_ones_in_time_proportional_to_the_cells() -> None:
    def steps(count: int) -> int:
        taken = [{"cell_type": "raw", "id": f"cell-{number}"} for number in range(count, 2 * count)]
        data = json.dumps({"nbformat": 4, "cells": [*taken, *[{"cell_type": "raw"}] * count]}).encode()
        read_cells(data)
        return steps_of(lambda: read_cells(data))

    assert steps(400) < 2.2 * steps(200)
    assert len({cell["id"] for cell in read_cells(of_format_3({"cells": [{"cell_type": "raw"}] * 3}))}) == 3
