"""Decompresses files in steps, and counts the bytes that go in, the bytes that come out, and the parts of a file.

Each of the three has a limit of its own, because a file can take long to decompress and still contain nothing.
"""

from __future__ import annotations

import bz2
import io
import lzma
import zlib
from collections.abc import Callable
from typing import IO, Any

from autograder.submission.intake.files import MAX_READ_BYTES, Contents, unsafe

MAX_DICTIONARY = 128 * 1024 * 1024  # bytes of memory to decompress xz
_STEP = 16 * 1024  # compressed bytes that are read at a time


class _GzipDecompressor:
    """zlib's decompressor for gzip, with the interface of those of `bz2` and `lzma`.

    `gzip` would read the file's name in a header byte by byte, and any number of empty parts in one call.
    """

    def __init__(self) -> None:
        self._zlib = zlib.decompressobj(wbits=16 + zlib.MAX_WBITS)

    @property
    def eof(self) -> bool:
        return self._zlib.eof

    @property
    def needs_input(self) -> bool:
        return not self._zlib.unconsumed_tail

    @property
    def unused_data(self) -> bytes:
        return self._zlib.unused_data

    def decompress(self, data: bytes, max_length: int) -> bytes:
        return self._zlib.decompress(self._zlib.unconsumed_tail + data, max_length)


_DECOMPRESSORS: dict[bytes, Callable[[], Any]] = {
    b"\x1f\x8b": _GzipDecompressor,
    b"BZh": bz2.BZ2Decompressor,
    b"\xfd7zXZ\x00": lambda: lzma.LZMADecompressor(memlimit=MAX_DICTIONARY),
}


def is_compressed(head: bytes) -> bool:
    """Return whether the first bytes of a file show a compression that `decompressed` supports."""
    return _magic(head) is not None


def decompressed(file: IO[bytes], contents: Contents) -> IO[bytes]:
    """Return a stream of a file's bytes, decompressed if the file is compressed. It exceeds none of the limits."""
    file.seek(0)
    magic = _magic(file.read(8))
    file.seek(0)
    raw: IO[bytes] | io.RawIOBase = file if magic is None else _Decompressed(file, magic, contents)
    return io.BufferedReader(_Limited(raw, contents), 64 * 1024)


def decompress_part(packed: IO[bytes], decompressor: Any, size: int, head: bytes = b"") -> bytes:
    """Return the first `size` bytes of what `head` and the rest of a file decompress to."""
    data = bytearray()
    while len(data) < size and not decompressor.eof:
        step = head + packed.read(_STEP) if decompressor.needs_input else b""
        head = b""
        data += (more := decompressor.decompress(step, size - len(data)))
        if not more and not step and decompressor.needs_input:
            raise EOFError("the archive ends too early")
    return bytes(data)


def _magic(head: bytes) -> bytes | None:
    return next((magic for magic in _DECOMPRESSORS if head.startswith(magic)), None)


class _Decompressed(io.RawIOBase):
    """The decompressed bytes of a file. It may consist of several parts, with zeros between and any bytes after them.

    Each part counts like a file, because an empty one takes as long as a short file.
    """

    def __init__(self, file: IO[bytes], magic: bytes, contents: Contents) -> None:
        self._file, self._magic, self._contents = file, magic, contents
        self._decompressor, self._rest = _DECOMPRESSORS[magic](), b""

    def readable(self) -> bool:
        return True

    def read(self, size: int = -1) -> bytes:
        while not self._decompressor.eof or self._begin_part():
            step = b""
            if self._decompressor.needs_input:
                step, self._rest = self._rest or self._read_step(), b""
            data: bytes = self._decompressor.decompress(step, size)
            if data:
                return data
            if not step and not self._decompressor.eof and self._decompressor.needs_input:
                raise EOFError("the archive ends too early")
        return b""

    def _begin_part(self) -> bool:
        """Begin the next part. Return whether there is one."""
        rest = self._decompressor.unused_data.lstrip(b"\0")
        while len(rest) < len(self._magic) and (step := self._read_step()):
            rest = (rest + step).lstrip(b"\0")
        if not rest.startswith(self._magic):
            return False
        self._contents.scan()
        self._decompressor, self._rest = _DECOMPRESSORS[self._magic](), rest
        return True

    def _read_step(self) -> bytes:
        step = self._file.read(_STEP)
        self._contents.count_packed(len(step))
        return step


class _Limited(io.RawIOBase):
    """A stream that fails after `MAX_READ_BYTES`, or as soon as the submission's archives are too large in all."""

    def __init__(self, raw: IO[bytes] | io.RawIOBase, contents: Contents) -> None:
        self._raw, self._contents, self._count = raw, contents, 0

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        data = self._raw.read(len(buffer)) or b""
        self._count += len(data)
        self._contents.count_unpacked(len(data))
        if self._count > MAX_READ_BYTES:
            raise unsafe(f"it is larger than {MAX_READ_BYTES // 2**20} MiB when it is unpacked")
        buffer[: len(data)] = data
        return len(data)
