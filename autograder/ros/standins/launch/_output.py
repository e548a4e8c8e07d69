"""The output of a process as text."""

from __future__ import annotations


class OutputText:
    """One output stream of a process: cut into lines for the log, and kept whole if asked to."""

    def __init__(self, *, keep: bool) -> None:
        self._keep = keep
        self._rest = b""
        self.text = ""

    def lines(self, data: bytes) -> list[str]:
        """Return the lines that `data` completes."""
        if self._keep:
            self.text += data.decode(errors="replace").replace("\r\n", "\n")
        *whole, self._rest = (self._rest + data).split(b"\n")
        return [line.decode(errors="replace").removesuffix("\r") for line in whole]

    def last_line(self) -> list[str]:
        """Return what is left without a line end."""
        rest, self._rest = self._rest, b""
        return [rest.decode(errors="replace")] if rest else []
