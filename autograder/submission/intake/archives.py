"""Reads archives: zip files, and tar files with any compression that the standard library supports."""

from __future__ import annotations

import bz2
import copy
import gzip
import io
import lzma
import stat
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import IO, Any

from autograder.submission.intake.files import MAX_READ_BYTES, MAX_UNPACKED_BYTES, Contents, unsafe
from autograder.submission.intake.ignored import IgnoredPaths
from autograder.submission.intake.names import reading_rank

# Archives that the standard library cannot open, identified by their first bytes.
UNSUPPORTED = {b"7z\xbc\xaf\x27\x1c": "7z", b"Rar!\x1a\x07": "RAR", b"\x28\xb5\x2f\xfd": "Zstandard"}
MAX_DIRECTORY = 32 * 1024 * 1024  # bytes of a zip's list of files
MAX_NAME = 1024  # characters of a path; a longer or deeper path never belongs to an answer, and is slow to examine
MAX_FOLDERS = 64  # folders in a path
MAX_DICTIONARY = 128 * 1024 * 1024  # bytes of memory to decompress xz
_EXECUTABLE = 0o100
_STREAM_OPENERS: dict[bytes, Callable[[IO[bytes]], Any]] = {
    b"\x1f\x8b": lambda raw: gzip.GzipFile(fileobj=raw),
    b"BZh": lambda raw: bz2.BZ2File(raw),
    b"\xfd7zXZ\x00": lambda raw: _decompressing_stream(raw, lzma.LZMADecompressor(memlimit=MAX_DICTIONARY)),
}
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
    file.seek(0)
    if head.startswith(b"PK"):
        _read_zip(file, prefix, contents)
        return
    opener = next((opener for magic, opener in _STREAM_OPENERS.items() if head.startswith(magic)), None)

    def open_stream() -> IO[bytes]:
        file.seek(0)
        return io.BufferedReader(_LimitedStream(file if opener is None else opener(file), contents), 64 * 1024)

    start = open_stream().read(512)
    if start[257:262] == b"ustar":
        _read_tar(open_stream, prefix, contents)
    elif opener is None:
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
    if path.is_absolute() or ".." in path.parts or (path.parts and path.parts[0].endswith(":")):
        raise unsafe(f"{name} points outside the archive")
    return path


def _read_zip(file: IO[bytes], prefix: PurePosixPath, contents: Contents) -> None:
    _require_short_directory(file)
    with zipfile.ZipFile(file) as archive:
        infos = [(safe_path(info.filename), info) for info in archive.infolist()]
        for _ in infos:
            contents.scan()
        ignored_paths = IgnoredPaths([path for path, _ in infos])

        def member(path: PurePosixPath, info: zipfile.ZipInfo) -> Member:
            mode = info.external_attr >> 16
            problem = "" if stat.S_IFMT(mode) in (0, stat.S_IFREG) else "is not a regular file"
            return Member(path, info.file_size, bool(mode & _EXECUTABLE), lambda: _inflate(archive, info), problem)

        members = (member(path, info) for path, info in infos if not info.is_dir() and path not in ignored_paths)
        _add(sorted(members, key=lambda member: reading_rank(member.path)), prefix, contents)


def _require_short_directory(file: IO[bytes]) -> None:
    """Refuse a zip whose list of files, which `zipfile` reads as a whole, is too long."""
    size = file.seek(0, 2)
    file.seek(max(0, size - 65_557))
    tail = file.read()
    offset = tail.rfind(b"PK\x05\x06")
    directory_size = struct.unpack_from("<I", tail, offset + 12)[0] if 0 <= offset <= len(tail) - 22 else 0
    if directory_size == 0xFFFFFFFF:
        offset = tail.rfind(b"PK\x06\x06")
        directory_size = (
            struct.unpack_from("<Q", tail, offset + 40)[0] if 0 <= offset <= len(tail) - 56 else MAX_DIRECTORY + 1
        )
    if directory_size > MAX_DIRECTORY:
        raise unsafe("it holds too many files")
    file.seek(0)


def _inflate(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
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
            data = _decompressing_stream(packed, bz2.BZ2Decompressor()).read(info.file_size)
        else:
            packed.read(2)  # the version of the LZMA SDK
            properties = packed.read(*struct.unpack("<H", packed.read(2)))
            decompressor = lzma.LZMADecompressor(lzma.FORMAT_ALONE, memlimit=MAX_DICTIONARY)
            head = properties + bytes(8 * [0xFF])  # the size is unknown
            data = _decompressing_stream(packed, decompressor, head).read(info.file_size)
    if zlib.crc32(data) != info.CRC:
        raise zipfile.BadZipFile(f"{info.filename} does not match its checksum in the archive")
    return data


def _read_tar(open_stream: Callable[[], IO[bytes]], prefix: PurePosixPath, contents: Contents) -> None:
    """Read a tar in three passes: all names, possible answers, other files.

    All names are needed first, because the mark of an environment may come last.
    """
    with tarfile.open(fileobj=open_stream(), mode="r|") as archive:
        paths, files = [], []
        for info in archive:
            contents.scan()
            paths.append(safe_path(info.name))
            if not info.isdir():
                files.append(len(paths) - 1)
    ignored_paths = IgnoredPaths(paths)
    included_numbers = [number for number in files if paths[number] not in ignored_paths]
    for are_possible_answers in (True, False):
        pending = {number for number in included_numbers if (reading_rank(paths[number]) == 0) is are_possible_answers}
        if not pending:
            continue
        with tarfile.open(fileobj=open_stream(), mode="r|") as archive:
            for number, info in enumerate(archive):
                if number in pending:
                    _add([_tar_member(archive, info, paths[number])], prefix, contents)


def _tar_member(archive: tarfile.TarFile, info: tarfile.TarInfo, path: PurePosixPath) -> Member:
    problem = "is a link" if info.issym() or info.islnk() else "" if info.isfile() else "is not a regular file"
    return Member(path, info.size, bool(info.mode & _EXECUTABLE), lambda: _extract(archive, info), problem)


def _extract(archive: tarfile.TarFile, info: tarfile.TarInfo) -> bytes:
    file = archive.extractfile(info)
    data = file.read(info.size) if file is not None else b""
    if len(data) != info.size:
        raise ValueError(f"{info.name} is not as large as the archive says")
    return data


def _add(members: Iterable[Member], prefix: PurePosixPath, contents: Contents) -> None:
    for member in members:
        if member.problem:
            path = prefix / member.path
            contents.skip(path, f"{path} {member.problem}")
        else:
            contents.add(prefix / member.path, member.size, member.read, member.executable)


class _LimitedStream(io.RawIOBase):
    """A stream that fails after `MAX_READ_BYTES`, or as soon as the submission's archives are too large in all."""

    def __init__(self, raw: IO[bytes], contents: Contents) -> None:
        self._raw, self._contents, self._count = raw, contents, 0

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        data = self._raw.read(len(buffer))
        self._count += len(data)
        self._contents.bytes_unpacked += len(data)
        if self._count > MAX_READ_BYTES:
            raise unsafe(f"it is larger than {MAX_READ_BYTES // 2**20} MiB when it is unpacked")
        if self._contents.bytes_unpacked > MAX_UNPACKED_BYTES:
            raise unsafe("its archives contain too much data in all")
        buffer[: len(data)] = data
        return len(data)


def _decompressing_stream(raw: IO[bytes], decompressor: Any, head: bytes = b"") -> IO[bytes]:
    """Return a stream that decompresses `head` and the rest of the file in steps."""
    return io.BufferedReader(_DecompressedStream(raw, decompressor, head))


class _DecompressedStream(io.RawIOBase):
    def __init__(self, raw: IO[bytes], decompressor: Any, head: bytes) -> None:
        self._raw, self._decompressor, self._head = raw, decompressor, head

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        while not self._decompressor.eof:
            packed = self._head + self._raw.read(64 * 1024) if self._decompressor.needs_input else b""
            self._head = b""
            data = self._decompressor.decompress(packed, len(buffer))
            if data:
                buffer[: len(data)] = data
                return len(data)
            if self._decompressor.needs_input and not packed:
                raise EOFError("the archive ends too early")
        return 0
