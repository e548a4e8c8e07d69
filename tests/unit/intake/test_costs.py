"""What a submission costs to read: a small one takes neither gigabytes nor minutes."""

from __future__ import annotations

import bz2
import io
import struct
import tarfile
import time
import tracemalloc
import zipfile
from pathlib import Path, PurePosixPath

import pytest

from autograder.exceptions import StudentError
from autograder.grade import apart
from autograder.run.sandbox import Tier
from autograder.submission import intake
from autograder.submission.intake import SubmittedFile, detect_layout, read_submission
from autograder.submission.intake import archives as unpacking

CHAPTER = "02_nodes"
MIB = 1024 * 1024


def understated_zip(packed: bytes, method: int) -> bytes:
    """Return a zip with a notebook of 1,000 bytes, as it says; `packed` becomes far more."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(f"{CHAPTER}.ipynb", packed)
    data = bytearray(file.getvalue())
    for head, place, size in ((b"PK\x03\x04", 8, 22), (b"PK\x01\x02", 10, 24)):
        struct.pack_into("<H", data, data.find(head) + place, method)
        struct.pack_into("<I", data, data.find(head) + size, 1000)
    return bytes(data)


def tar_of_zeros(size: int) -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w") as archive:
        info = tarfile.TarInfo("build/zeros")  # which nobody reads, and whose bytes pass by
        info.size = size
        archive.addfile(info, io.BytesIO(bytes(size)))
    return bz2.compress(file.getvalue())


def test_a_zip_of_another_method_is_unpacked_in_steps(tmp_path: Path) -> None:
    path = tmp_path / "ada.zip"
    path.write_bytes(understated_zip(bz2.compress(bytes(100 * MIB)), zipfile.ZIP_BZIP2))
    tracemalloc.start()
    try:
        with pytest.raises(StudentError, match="is not what the archive says"):
            read_submission(path, CHAPTER)
        assert tracemalloc.get_traced_memory()[1] < 10 * MIB
    finally:
        tracemalloc.stop()


def test_all_archives_of_a_submission_have_one_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpacking, "MAX_UNPACKED_BYTES", 20 * MIB)
    for number in range(5):
        (tmp_path / f"{number}.tar.bz2").write_bytes(tar_of_zeros(3 * MIB))
    with pytest.raises(StudentError, match="hold too much in all"):
        read_submission(tmp_path, CHAPTER)


@pytest.mark.parametrize("name", ["a/" * 100 + "x", "x" * 5000])
def test_a_name_that_no_file_can_have_is_refused_before_it_is_looked_at(name: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "ada.zip", "w") as archive:
        archive.writestr(name, b"")
    with pytest.raises(StudentError, match=r"has more than 1024 characters or 64 folders"):
        read_submission(tmp_path / "ada.zip", CHAPTER)


def test_thousands_of_packages_in_each_other_are_found_at_once() -> None:
    paths = [f"{'x/' * depth}q{depth}/package.xml" for depth in range(13)]
    paths += [f"{'x/' * 13}p{number}/package.xml" for number in range(1900)]
    files = [SubmittedFile(PurePosixPath(path), b"<name>a</name>") for path in paths]
    began = time.process_time()
    assert detect_layout(files, CHAPTER).source
    assert time.process_time() - began < 10  # it took 90 s when each file was compared with each package


def test_a_submission_that_ends_its_reader_does_not_end_the_grading_of_a_class(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(intake, "read_contents", fail)
    with pytest.raises(StudentError, match="Your submission cannot be read: MemoryError"):
        read_submission(tmp_path, CHAPTER)
    assert apart.read_digests(tmp_path, CHAPTER, Tier.PROCESS) is None
