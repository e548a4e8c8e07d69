"""The output of a process as text."""

from __future__ import annotations


class OutputText:
    """One output stream of a process: split into lines for the log, and with `keep` also kept as a whole."""

    def __init__(self, *, keep: bool) -> None:
        self._keep = keep
        self._partial_line = b""
        self.text = ""

    def lines(self, data: bytes) -> list[str]:
        """Return the lines that `data` completes."""
        if self._keep:
            self.text += data.decode(errors="replace").replace("\r\n", "\n")
        *complete_lines, self._partial_line = (self._partial_line + data).split(b"\n")
        return [line.decode(errors="replace").removesuffix("\r") for line in complete_lines]

    def last_line(self) -> list[str]:
        """Return the text after the last line end, if there is any."""
        partial_line, self._partial_line = self._partial_line, b""
        return [partial_line.decode(errors="replace")] if partial_line else []
