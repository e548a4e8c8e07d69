"""Reads the headers of a tar archive, in time and memory proportional to their number.

`tarfile` copies each global keyword to every later member, follows a chain of headers recursively, and reads maps of
sparse files of any length. Some patch releases also search headers with regular expressions in quadratic time
(CVE-2024-6232). So only its parser of a single block, `TarInfo.frombuf`, is used.
"""

from __future__ import annotations

import sys
import tarfile
from collections.abc import Iterator
from dataclasses import dataclass
from typing import IO

from autograder.submission.intake.files import Contents, unsafe

MAX_HEADER = 1024 * 1024  # bytes of an extended header, which can contain the attributes of a file
MAX_KEYWORDS = 100  # in an extended header; tools write one or two for each attribute of a file
MAX_EXTENDED = 8  # extended headers of one member; tools write up to three
_STEP = 1024 * 1024  # bytes that are skipped at a time
_PAX = (tarfile.XHDTYPE, tarfile.SOLARIS_XHDTYPE)
# Headers of no member: keywords for the next member or for all, and a long name or link target for the next member.
_EXTENDED = (*_PAX, tarfile.XGLTYPE, tarfile.GNUTYPE_LONGNAME, tarfile.GNUTYPE_LONGLINK)
_SPARSE_NAME = "GNU.sparse.name"
_SPARSE = ("GNU.sparse.size", "GNU.sparse.major")  # each version of the format has one of them
_USED = frozenset(name.encode() for name in ("path", "size", _SPARSE_NAME, *_SPARSE))  # the keywords that are kept
# Whether another block with the map of a sparse file follows: the flag's place in a header and in a block of the map.
_IS_CONTINUED, _MAP_IS_CONTINUED = 482, 504


@dataclass(frozen=True)
class TarMember:
    """A member of a tar, and the place of its content. `problem` is the reason why it is not read, or empty."""

    name: str
    start: int
    size: int
    executable: bool
    is_folder: bool
    problem: str


class TarStream:
    """A tar, read from its start to its end."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream, self._position = stream, 0

    def members(self, contents: Contents) -> Iterator[TarMember]:
        """Yield all members. Raises StudentError if there are too many headers, or one is too large."""
        keywords: dict[str, str] = {}
        extended_count = 0  # since the last member
        while (block := self._stream.read(tarfile.BLOCKSIZE)) and (info := _parse(block, self._position)) is not None:
            self._position += len(block)
            if info.type in _EXTENDED:
                extended_count += 1
                if extended_count > MAX_EXTENDED:
                    raise unsafe(f"a file in it has more than {MAX_EXTENDED} extended headers")
                keywords.update(self._read_extended(info))
                continue
            contents.scan()
            if info.type == tarfile.GNUTYPE_SPARSE:
                self._skip_map(block)
            member = _member(info, self._position, keywords)
            keywords, extended_count = {}, 0
            yield member
            if info.isreg() or info.type not in tarfile.SUPPORTED_TYPES:
                self._skip(_padded(member.size))

    def read_at(self, start: int, size: int) -> bytes:
        """Return the content of a member that follows those that have been read."""
        self._skip(start - self._position)
        return self._read(size)

    def _read(self, size: int) -> bytes:
        data = self._stream.read(size)
        self._position += len(data)
        if len(data) != size:
            raise EOFError("unexpected end of data")
        return data

    def _skip(self, size: int) -> None:
        while size > 0:
            size -= len(self._read(min(size, _STEP)))

    def _read_extended(self, info: tarfile.TarInfo) -> dict[str, str]:
        """Read the content of an extended header, and return the keywords for the next member."""
        if not 0 <= info.size <= MAX_HEADER:
            raise unsafe(f"a header in it is larger than {MAX_HEADER // 2**20} MiB")
        data = self._read(_padded(info.size))[: info.size]
        if info.type in _PAX:
            return _parse_keywords(data)
        # Global keywords, such as the comment by `git archive`, and targets of links are not used.
        return {"path": _text(data.partition(b"\0")[0])} if info.type == tarfile.GNUTYPE_LONGNAME else {}

    def _skip_map(self, block: bytes) -> None:
        is_continued = bool(block[_IS_CONTINUED])
        while is_continued:
            is_continued = bool(self._read(tarfile.BLOCKSIZE)[_MAP_IS_CONTINUED])


def _parse(block: bytes, position: int) -> tarfile.TarInfo | None:
    """Parse a header. Return None at the end of the archive: at zeros, or at anything that is not a header."""
    try:
        return tarfile.TarInfo.frombuf(block, sys.getfilesystemencoding(), "surrogateescape")
    except tarfile.HeaderError:
        if position == 0:
            raise
        return None


def _member(info: tarfile.TarInfo, start: int, keywords: dict[str, str]) -> TarMember:
    is_sparse = info.type == tarfile.GNUTYPE_SPARSE or any(keyword in keywords for keyword in _SPARSE)
    name = keywords.get(_SPARSE_NAME, keywords.get("path", info.name))
    size = int(keywords.get("size", info.size))
    if size < 0:
        raise ValueError(f"the size of {name} is negative")
    problem = "is a link" if info.issym() or info.islnk() else "" if info.isfile() else "is not a regular file"
    problem = problem or ("is stored as a sparse file: pack it without the option --sparse" if is_sparse else "")
    return TarMember(name, start, size, bool(info.mode & 0o100), info.isdir(), problem)


def _parse_keywords(data: bytes) -> dict[str, str]:
    r"""Parse records of the form `LENGTH KEYWORD=VALUE\n`."""
    keywords: dict[str, str] = {}
    data, start, count = data.rstrip(b"\0"), 0, 0
    while start < len(data):
        digits = data[start : start + 8].partition(b" ")[0]
        end = start + int(digits) if digits.isdigit() else start
        keyword, separator, value = data[start + len(digits) + 1 : end - 1].partition(b"=")
        if not (start + len(digits) + 1 < end <= len(data) and separator):
            raise ValueError("one of its headers is damaged")
        if keyword in _USED:
            keywords[_text(keyword)] = _text(value)
        start, count = end, count + 1
        if count > MAX_KEYWORDS:
            raise unsafe(f"a header in it has more than {MAX_KEYWORDS} keywords")
    return keywords


def _padded(size: int) -> int:
    return -(-size // tarfile.BLOCKSIZE) * tarfile.BLOCKSIZE


def _text(data: bytes) -> str:
    return data.decode("utf-8", "surrogateescape")
