"""The cost of opening an archive: headers, parts and compressed bytes are limited, even if they contain nothing."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import resource
import signal
import struct
import tarfile
import threading
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import pytest

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.submission import intake
from autograder.submission.intake import archives, bounds, compression, files, read_submission, zip_directory
from autograder.submission.intake.files import Contents
from autograder.submission.intake.tar import MAX_HEADER, MAX_KEYWORDS

CHAPTER = "02_nodes"
MIB = 1024 * 1024
NOTEBOOK = b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": []}'
TREE = {
    f"{CHAPTER}.ipynb": NOTEBOOK,
    "ws/src/pkg/package.xml": b"<package/>",
    f"ws/src/pkg/{'a long folder ' * 4}/{'a long näme ' * 6}.py": b"x = 1\n" * 1000,
}


def refusal(path: Path) -> str:
    with pytest.raises(StudentError) as excinfo:
        read_submission(path, CHAPTER)
    return excinfo.value.diagnosis.sentence


def tree_as_tar(format: int = tarfile.PAX_FORMAT, headers: dict[str, str] | None = None) -> bytes:
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=format, pax_headers=headers or {}) as archive:
        for name, data in TREE.items():
            info = tarfile.TarInfo(name)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
    return buffer.getvalue()


def block(name: str, kind: bytes, content: bytes = b"") -> bytes:
    """Return a header of a tar with its content."""
    info = tarfile.TarInfo(name)
    info.type, info.size = kind, len(content)
    return info.tobuf(tarfile.USTAR_FORMAT) + content + bytes(-len(content) % tarfile.BLOCKSIZE)


def keyword(name: str, value: str = "") -> bytes:
    text = f" {name}={value}\n".encode()
    return next(b"%d" % n + text for n in range(len(text), len(text) + 9) if len(b"%d" % n + text) == n)


def contents_of(path: Path) -> set[tuple[PurePosixPath, bytes]]:
    return {(file.path, file.data) for file in read_submission(path, CHAPTER).source}


# Tar.


@pytest.mark.parametrize("kind", [b"x", b"g", b"X", b"L", b"K"])
def test_a_header_of_a_tar_is_refused_if_it_is_larger_than_any_tool_writes(kind: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.tar").write_bytes(block("header", kind, bytes(MAX_HEADER + 1)) + tree_as_tar())
    assert "a header in it is larger than 1 MiB" in refusal(tmp_path / "a.tar")


def test_a_header_with_thousands_of_keywords_is_refused(tmp_path: Path) -> None:
    keywords = b"".join(keyword(f"{number:x}") for number in range(MAX_KEYWORDS + 1))
    (tmp_path / "a.tar").write_bytes(block("header", b"x", keywords) + tree_as_tar())
    assert "a header in it has more than 100 keywords" in refusal(tmp_path / "a.tar")


def test_global_keywords_are_not_copied_to_the_members(tmp_path: Path) -> None:
    """A tar of 0.4 MB with a large global header filled the memory of the grading worker."""
    keywords = b"".join(keyword(f"{number:x}") for number in range(1500))
    members = b"".join(block(f"x/{number}", tarfile.REGTYPE) for number in range(1000))
    (tmp_path / "a.tar").write_bytes(block("header", b"g", keywords) + members + tree_as_tar())
    assert len(keywords) < MAX_HEADER
    tracemalloc.start()
    try:
        read_submission(tmp_path / "a.tar", CHAPTER)
        assert tracemalloc.get_traced_memory()[1] < 5 * MIB
    finally:
        tracemalloc.stop()


def test_a_member_has_few_headers(tmp_path: Path) -> None:
    (tmp_path / "a.tar").write_bytes(block("header", b"g") * 9 + tree_as_tar())
    assert "a file in it has more than 8 extended headers" in refusal(tmp_path / "a.tar")


def test_headers_of_a_member_do_not_count_as_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Tools on macOS write the attributes of each file, which can have 64 KiB."""
    monkeypatch.setattr(files, "MAX_SCANNED", 250)
    attributes = block("header", b"x", keyword("SCHILY.xattr.user.note", "x" * 65_000))
    members = (attributes + block(f"other/{number}.bin", tarfile.REGTYPE) for number in range(200))
    (tmp_path / "a.tar").write_bytes(b"".join(members) + tree_as_tar())
    assert read_submission(tmp_path / "a.tar", CHAPTER).notebook == NOTEBOOK


def test_a_name_with_nul_is_refused(tmp_path: Path) -> None:
    header = block("header", b"x", keyword("path", "ws/src/pkg/a\0b.py"))
    (tmp_path / "a.tar").write_bytes(header + block("?", tarfile.REGTYPE) + tree_as_tar())
    assert r"the name 'ws/src/pkg/a\x00b.py' is invalid" in refusal(tmp_path / "a.tar")


def test_a_large_zip_is_opened_because_it_is_not_read_as_a_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        for name, data in TREE.items():
            archive.writestr(name, data)
        archive.writestr("recording.mcap", bytes(1000))
    monkeypatch.setattr(archives, "MAX_READ_BYTES", 1000)
    assert read_submission(tmp_path / "a.zip", CHAPTER).notebook == NOTEBOOK


def test_reading_ends_when_its_time_is_used_up_beside_another_thread(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "MAX_SECONDS", 0.0)
    (tmp_path / "a.tar").write_bytes(tree_as_tar())
    assert "reading it takes more than 0 s" in refusal(tmp_path / "a.tar")


@pytest.mark.parametrize("format", [tarfile.USTAR_FORMAT, tarfile.GNU_FORMAT, tarfile.PAX_FORMAT])
@pytest.mark.parametrize("headers", [{}, {"comment": "e5d26323" * 5}], ids=["plain", "git archive"])
def test_a_tar_of_any_format_is_read_completely(format: int, headers: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "a.tar").write_bytes(tree_as_tar(format, headers))
    submission = read_submission(tmp_path / "a.tar", CHAPTER)
    assert submission.notebook == NOTEBOOK
    expected = {(PurePosixPath(name[7:]), data) for name, data in TREE.items() if name.startswith("ws/src/")}
    assert contents_of(tmp_path / "a.tar") == expected


def test_the_keywords_of_a_member_replace_its_name_and_its_size(tmp_path: Path) -> None:
    attributes = keyword("mtime", "1.5") + keyword("LIBARCHIVE.xattr.com.apple.provenance", "AQAC")
    header = block("header", b"x", attributes + keyword("path", "ws/src/pkg/ü") + keyword("size", "3"))
    content = block("?", tarfile.REGTYPE) + b"abc".ljust(512, b"\0")
    (tmp_path / "a.tar").write_bytes(header + content + tree_as_tar())
    assert (PurePosixPath("pkg/ü"), b"abc") in contents_of(tmp_path / "a.tar")


@pytest.mark.parametrize("record", [b"x", b"5 abc", b"99 a=b\n", b"3 a=b\n", b"-7 a=b\n", b"0 a=b\n", b"7 abcd\n"])
def test_a_tar_with_a_damaged_header_is_unreadable(record: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.tar").write_bytes(block("header", b"x", record) + tree_as_tar())
    assert "one of its headers is damaged" in refusal(tmp_path / "a.tar")


def gnu_sparse_file(blocks_of_map: int) -> bytes:
    """Return a file in GNU's format for sparse files, with a map of many parts of one byte."""
    header = bytearray(block("beside/sparse", tarfile.GNUTYPE_SPARSE))
    header[257:265], header[482], header[148:156] = b"ustar  \0", 1, b" " * 8
    header[148:156] = b"%06o\0 " % sum(header)
    parts = b"00000000001\0" * 42
    return bytes(header) + (parts + b"\1" + bytes(7)) * blocks_of_map + parts + bytes(8)


def test_a_sparse_file_is_skipped_and_its_map_is_not_kept(tmp_path: Path) -> None:
    pax = block("header", b"x", keyword("GNU.sparse.major", "1") + keyword("GNU.sparse.name", "beside/other"))
    (tmp_path / "a.tar").write_bytes(
        gnu_sparse_file(20_000) + pax + block("GNUSparseFile.0/other", tarfile.REGTYPE) + tree_as_tar()
    )
    tracemalloc.start()
    try:
        submission = read_submission(tmp_path / "a.tar", CHAPTER)
        assert tracemalloc.get_traced_memory()[1] < 5 * MIB
    finally:
        tracemalloc.stop()
    sentence = "is stored as a sparse file: pack it without the option --sparse"
    assert submission.unused == (f"beside/sparse {sentence}", f"beside/other {sentence}")
    assert len(submission.source) == 2


# Compressed files.


@pytest.mark.parametrize("compress", [gzip.compress, bz2.compress, lzma.compress], ids=["gzip", "bzip2", "xz"])
def test_empty_parts_of_a_compressed_file_count_like_files(
    compress: Callable[[bytes], bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "MAX_SCANNED", 500)
    (tmp_path / "a.tar").write_bytes(compress(b"") * 600 + compress(tree_as_tar()))
    assert "it holds more than 500 files and folders" in refusal(tmp_path / "a.tar")


@pytest.mark.parametrize("compress", [gzip.compress, bz2.compress, lzma.compress], ids=["gzip", "bzip2", "xz"])
def test_a_file_that_was_compressed_in_parts_is_read_completely(
    compress: Callable[[bytes], bytes], tmp_path: Path
) -> None:
    data = tree_as_tar()
    (tmp_path / "plain.tar").write_bytes(data)
    parts = [compress(data[:3000]), compress(b""), bytes(40_000), compress(data[3000:9000]), compress(data[9000:])]
    (tmp_path / "parts.tar").write_bytes(b"".join(parts) + b"anything")
    assert contents_of(tmp_path / "parts.tar") == contents_of(tmp_path / "plain.tar")


class CountedFile(io.BytesIO):
    """A file that counts the calls that read it."""

    calls = 0

    def read(self, size: int | None = -1, /) -> bytes:
        self.calls += 1
        return super().read(size)


def test_a_long_file_name_in_a_gzip_header_is_read_in_large_steps() -> None:
    plain = gzip.compress(b"content", mtime=0)
    file = CountedFile(b"\x1f\x8b\x08\x08\0\0\0\0\0\xff" + b"a" * MIB + b"\0" + plain[10:])
    assert compression.decompressed(file, Contents()).read() == b"content"
    assert file.calls < 100


def test_compressed_bytes_count_even_if_they_contain_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "MAX_UNPACKED_BYTES", MIB)
    empty_blocks = b"\0\0\0\xff\xff" * (2 * MIB // 5)
    (tmp_path / "a.tar.gz").write_bytes(b"\x1f\x8b\x08\0\0\0\0\0\0\xff" + empty_blocks)
    assert "its archives contain too much data in all" in refusal(tmp_path / "a.tar.gz")


@pytest.mark.parametrize("name", ["a.zip", "a.tar"])
def test_an_archive_on_disk_that_is_too_large_is_not_opened(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(archives, "MAX_READ_BYTES", MIB)
    (tmp_path / name).touch()
    with (tmp_path / name).open("wb") as stream:
        stream.truncate(MIB + 1)
    for path in (tmp_path / name, tmp_path):
        assert f"{name} is larger than 1 MiB" in refusal(path)


# Zip.


def zip_of(extra: bytes, count: int = 1) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for number in range(count):
            info = zipfile.ZipInfo(f"ws/src/pkg/{number}")
            info.extra = extra
            archive.writestr(info, b"x")
    return buffer.getvalue()


def test_extra_fields_of_a_zip_are_limited(tmp_path: Path) -> None:
    field = struct.pack("<HH", 0x9999, 0)
    for count, is_read in ((zip_directory.MAX_EXTRA // 4, True), (zip_directory.MAX_EXTRA // 4 + 1, False)):
        (tmp_path / "a.zip").write_bytes(zip_of(field * count))
        if is_read:
            read_submission(tmp_path / "a.zip", CHAPTER)
        else:
            assert "a file in it has more than 1024 bytes of extra fields" in refusal(tmp_path / "a.zip")


@pytest.mark.parametrize("is_hidden", [False, True], ids=["usual", "hidden"])
def test_the_list_of_a_zip_is_checked_wherever_zipfile_finds_it(
    is_hidden: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "MAX_SCANNED", 50)
    data = bytearray(zip_of(b"", 60))
    if is_hidden:  # `zipfile` ignores the numbers of disks, so they can look like another end of the list
        data[-18:-14] = b"PK\5\6"
    (tmp_path / "a.zip").write_bytes(data)
    assert "it holds more than 50 files and folders" in refusal(tmp_path / "a.zip")


def test_files_of_a_zip_that_share_their_compressed_bytes_count_separately(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "MAX_UNPACKED_BYTES", 10 * MIB)
    packed = b"\0\0\0\xff\xff" * (MIB // 5) + b"\3\0"  # stored blocks of nothing, and an empty last block
    local = struct.pack("<4s5H3I2H", b"PK\3\4", 20, 0, 8, 0, 0, 0, len(packed), 0, 1, 0) + b"a"
    entry = struct.pack("<4s6H3I5H2I", b"PK\1\2", 20, 20, 0, 8, 0, 0, 0, len(packed), 0, 1, *[0] * 6) + b"a"
    end = struct.pack("<4s4H2IH", b"PK\5\6", 0, 0, 20, 20, 20 * len(entry), len(local) + len(packed), 0)
    (tmp_path / "a.zip").write_bytes(local + packed + entry * 20 + end)
    sentence = refusal(tmp_path / "a.zip")
    # Newer patch releases of Python refuse such a zip themselves.
    assert "its archives contain too much data in all" in sentence or "Overlapped entries" in sentence


# Time and memory.


def test_a_submission_that_takes_too_long_or_too_much_memory_is_unreadable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def work(*_: object) -> None:
        while True:
            pass

    def allocate(*_: object) -> bytearray:
        return bytearray(256 * MIB)

    before = resource.getrlimit(resource.RLIMIT_AS), signal.getsignal(signal.SIGPROF)
    monkeypatch.setattr(threading, "active_count", lambda: 1)
    monkeypatch.setattr(bounds, "MAX_SECONDS", 0.05)
    monkeypatch.setattr(bounds, "MAX_MEMORY", 64 * MIB)
    for read, reason in ((work, "that takes more than 0 s"), (allocate, "that takes more than 0 GiB of memory")):
        monkeypatch.setattr(intake, "read_contents", read)
        with pytest.raises(StudentError, match=f"Your submission cannot be read, because {reason}") as excinfo:
            read_submission(tmp_path, CHAPTER)
        assert excinfo.value.diagnosis.kind is Kind.UNREADABLE
    assert before == (resource.getrlimit(resource.RLIMIT_AS), signal.getsignal(signal.SIGPROF))
    assert signal.getitimer(signal.ITIMER_PROF) == (0.0, 0.0)
