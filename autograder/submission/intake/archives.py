"""Reads archives: zip files, and tar files with any compression that the standard library supports."""

from __future__ import annotations

import bz2
import copy
import io
import lzma
import stat
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import PurePosixPath
from typing import IO

from autograder.submission.intake.compression import MAX_DICTIONARY, decompress_part, decompressed, is_compressed
from autograder.submission.intake.files import MAX_READ_BYTES, Contents, unsafe
from autograder.submission.intake.ignored import IgnoredPaths
from autograder.submission.intake.names import reading_rank
from autograder.submission.intake.tar import TarStream
from autograder.submission.intake.zip_directory import CheckedZip

# Archives that the standard library cannot open, identified by their first bytes.
UNSUPPORTED = {b"7z\xbc\xaf\x27\x1c": "7z", b"Rar!\x1a\x07": "RAR", b"\x28\xb5\x2f\xfd": "Zstandard"}
MAX_NAME = 1024  # characters of a path; a longer or deeper path never belongs to an answer, and is slow to examine
MAX_FOLDERS = 64  # folders in a path
_EXECUTABLE = 0o100
# Errors of `zipfile`, `tarfile` and the decompressors for damaged, encrypted or unknown data.
READ_ERRORS = (
    *(zipfile.BadZipFile, zipfile.LargeZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, struct.error),
    *(NotImplementedError, EOFError, OSError, RuntimeError, ValueError, OverflowError),
)


@dataclass(frozen=True)
class Member:
    """A member of an archive. If it is a link or a special file, `problem` is the reason why it is skipped."""

    path: PurePosixPath
    size: int
    executable: bool
    read: Callable[[], bytes]
    problem: str = ""


def unsupported_kind(head: bytes) -> str:
    """Return the format that the first bytes of a file show, if it cannot be opened here, or else an empty string."""
    return next((kind for magic, kind in UNSUPPORTED.items() if head.startswith(magic)), "")


def unsupported_sentence(name: str, kind: str) -> str:
    """Return a sentence with advice for an archive that cannot be opened here."""
    return f"{name} is a {kind} archive, which the grader does not open: unpack it, and hand in the folder as a zip"


def read_archive(file: IO[bytes], name: str, prefix: PurePosixPath, contents: Contents) -> None:
    """Add the files of an archive to `contents`, with paths below `prefix`.

    Raises:
        StudentError: a path leads out of the archive, or the archive has too many files.
        ValueError or another of `READ_ERRORS`: it is not an archive, or it is damaged or encrypted.
    """
    head = file.read(512)
    if head.startswith(b"PK"):
        _read_zip(file, prefix, contents)
        return
    if file.seek(0, io.SEEK_END) > MAX_READ_BYTES:  # a zip is not read as a whole
        raise unsafe(f"{name} is larger than {MAX_READ_BYTES // 2**20} MiB")
    file.seek(0)

    def open_stream() -> IO[bytes]:
        return decompressed(file, contents)

    start = open_stream().read(512)
    if start[257:262] == b"ustar":
        _read_tar(open_stream, prefix, contents)
    elif not is_compressed(head):
        raise ValueError("it is not a zip or tar archive")
    else:  # one compressed file, such as 10_mapping.ipynb.gz
        data = open_stream().read()
        contents.add(prefix / (PurePosixPath(name).stem or "file"), len(data), lambda: data)


def safe_path(name: str) -> PurePosixPath:
    """Return a member's path. Raises StudentError if it leads out of the archive."""
    name = name.replace("\\", "/")
    if len(name) > MAX_NAME or name.count("/") > MAX_FOLDERS:
        raise unsafe(f"the name {name[:60]!r}... has more than {MAX_NAME} characters or {MAX_FOLDERS} folders")
    path = PurePosixPath(name)
    if "\0" in name:
        raise unsafe(f"the name {name!r} is invalid")
    if path.is_absolute() or ".." in path.parts or (path.parts and path.parts[0].endswith(":")):
        raise unsafe(f"{name} points outside the archive")
    return path


def _read_zip(file: IO[bytes], prefix: PurePosixPath, contents: Contents) -> None:
    checked_file = CheckedZip(file, contents)
    with zipfile.ZipFile(checked_file.file) as archive:
        checked_file.list_is_read = True
        infos = [(safe_path(info.filename), info) for info in archive.infolist()]
        ignored_paths = IgnoredPaths([path for path, _ in infos])

        def member(path: PurePosixPath, info: zipfile.ZipInfo) -> Member:
            mode = info.external_attr >> 16
            problem = "" if stat.S_IFMT(mode) in (0, stat.S_IFREG) else "is not a regular file"
            read = partial(_inflate, archive, info, contents)
            return Member(path, info.file_size, bool(mode & _EXECUTABLE), read, problem)

        # Before Python 3.12, `is_dir` fails on an empty name.
        files = ((path, info) for path, info in infos if not info.filename.endswith("/"))
        members = (member(path, info) for path, info in files if path not in ignored_paths)
        _add(sorted(members, key=lambda member: reading_rank(member.path)), prefix, contents)


def _inflate(archive: zipfile.ZipFile, info: zipfile.ZipInfo, contents: Contents) -> bytes:
    contents.count_packed(info.compress_size)  # many files can share the same compressed bytes
    # The size in the archive's directory may be wrong: read at most one byte more.
    if info.compress_type in (zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA):
        data = _inflate_in_steps(archive, info)
    else:
        with archive.open(info) as stream:
            data = stream.read(info.file_size + 1)
    if len(data) != info.file_size:
        raise zipfile.BadZipFile(f"{info.filename} is not as large as the archive says")
    return data


def _inflate_in_steps(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """Decompress in steps. `zipfile` would decompress everything at once, and 4 KB of bzip2 can become 4 GB."""
    as_stored = copy.copy(info)
    as_stored.compress_type, as_stored.file_size = zipfile.ZIP_STORED, info.compress_size
    del as_stored.CRC  # the checksum of the decompressed content, which is verified below
    with archive.open(as_stored) as packed:
        if info.compress_type == zipfile.ZIP_BZIP2:
            data = decompress_part(packed, bz2.BZ2Decompressor(), info.file_size)
        else:
            packed.read(2)  # the version of the LZMA SDK
            properties = packed.read(*struct.unpack("<H", packed.read(2)))
            decompressor = lzma.LZMADecompressor(lzma.FORMAT_ALONE, memlimit=MAX_DICTIONARY)
            head = properties + bytes(8 * [0xFF])  # the size is unknown
            data = decompress_part(packed, decompressor, info.file_size, head)
    if zlib.crc32(data) != info.CRC:
        raise zipfile.BadZipFile(f"{info.filename} does not match its checksum in the archive")
    return data


def _read_tar(open_stream: Callable[[], IO[bytes]], prefix: PurePosixPath, contents: Contents) -> None:
    """Read a tar in three passes: all headers, possible answers, other files.

    All names are needed first, because the mark of an environment may come last.
    """
    headers = [(safe_path(header.name), header) for header in TarStream(open_stream()).members(contents)]
    ignored_paths = IgnoredPaths([path for path, _ in headers])
    files = [(path, header) for path, header in headers if not header.is_folder and path not in ignored_paths]
    for are_possible_answers in (True, False):
        pending = [item for item in files if (reading_rank(item[0]) == 0) is are_possible_answers]
        if not pending:
            continue
        stream = TarStream(open_stream())
        for path, header in pending:
            read = partial(stream.read_at, header.start, header.size)
            _add([Member(path, header.size, header.executable, read, header.problem)], prefix, contents)


def _add(members: Iterable[Member], prefix: PurePosixPath, contents: Contents) -> None:
    for member in members:
        if member.problem:
            path = prefix / member.path
            contents.skip(path, f"{path} {member.problem}")
        else:
            contents.add(prefix / member.path, member.size, member.read, member.executable)
