"""Checks a zip's list of files before `zipfile` parses it."""

from __future__ import annotations

import struct
from typing import IO, cast

from autograder.submission.intake.files import Contents, unsafe

MAX_DIRECTORY = 32 * 1024 * 1024  # bytes of the list
MAX_EXTRA = 1024  # bytes of a file's extra fields, which `zipfile` parses in quadratic time; tools write less than 100
_ENTRY, _ENTRY_SIZE, _LENGTHS = b"PK\x01\x02", 46, 28


class CheckedZip:
    """The file of a zip, for `zipfile`. While it is opened, the entries of its list are counted and checked.

    `zipfile` reads the list in one call. It is checked there, because a zip can be made so that another search for
    its list finds something else.
    """

    def __init__(self, file: IO[bytes], contents: Contents) -> None:
        self._file, self._contents = file, contents
        self.seek, self.tell, self.seekable = file.seek, file.tell, file.seekable
        self.list_is_read = False  # whether `zipfile` has read the list

    @property
    def file(self) -> IO[bytes]:
        """This object as the argument of `zipfile.ZipFile`."""
        return cast(IO[bytes], self)

    def read(self, size: int = -1) -> bytes:
        """Read from the file. Raises StudentError if the bytes are a list that is too long."""
        if self.list_is_read:
            return self._file.read(size)
        if size > MAX_DIRECTORY:
            raise unsafe("it holds too many files")
        data = self._file.read(size)
        self._check(data)
        return data

    def _check(self, data: bytes) -> None:
        position = 0
        while data.startswith(_ENTRY, position) and position + _ENTRY_SIZE <= len(data):
            name, extra, comment = struct.unpack_from("<3H", data, position + _LENGTHS)
            self._contents.scan()
            if extra > MAX_EXTRA:
                raise unsafe(f"a file in it has more than {MAX_EXTRA} bytes of extra fields")
            position += _ENTRY_SIZE + name + extra + comment
