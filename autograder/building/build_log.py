"""A build's log as a student needs it: of each traceback the frames of the student's own files, and nothing empty.

colcon reads a setup.py before it builds. Where that fails, the log holds tracebacks of colcon's own, and one in which
setup.py is called "<string>".
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from autograder.lockstep.tracebacks import with_source_paths

_BEGIN = "Traceback (most recent call last):"
_FRAME = re.compile(r'  File "(?P<file>[^"]+)", line (?P<line>\d+)')
_RUNS_SETUP = "in run_setup"  # of setuptools: the frames called "<string>" below it are those of setup.py
_EMPTY_BLOCK = re.compile(r"^--- (?:stderr|output): .*\n(?:\s*\n)*---\n", re.MULTILINE)
# colcon's own error, told again, and its word about what this machine's ROS is made of.
_OTHERS = re.compile(r"^(?:Command '\[|\[[\d.]+s\] WARNING:colcon\.colcon_ros\.prefix_path\.).*\n?", re.MULTILINE)


def readable(log: str) -> str:
    """Return a log without the frames of colcon and setuptools; a traceback that has no other is left out."""
    lines = iter(with_source_paths(log).splitlines())
    kept: list[str] = []
    for line in lines:
        while line == _BEGIN:
            block, line = _own(lines)
            kept += block
        kept.append(line)
    return _EMPTY_BLOCK.sub("", _OTHERS.sub("", "\n".join(kept) + "\n")).rstrip("\n")


def place_in_setup(log: str) -> str:
    """Return where colcon could not read a setup.py, such as "setup.py, line 8: "; "" where it could."""
    found = _FRAME.search(text) if 'File "setup.py"' in (text := readable(log)) else None
    return f"{found['file']}, line {found['line']}: " if found and found["file"] == "setup.py" else ""


def _own(lines: Iterator[str]) -> tuple[list[str], str]:
    """Read a traceback behind its first line; return what is kept of it, and the line that follows it."""
    kept = [_BEGIN]
    own = found = in_setup = False
    for line in lines:
        if not line.startswith("  "):
            return ([*kept, line], next(lines, "")) if found else ([], next(lines, ""))
        if match := _FRAME.match(line):
            own = match["file"].startswith("ws/src/") or (in_setup and match["file"] == "<string>")
            found |= own
            in_setup |= _RUNS_SETUP in line
        if own:
            kept.append(line.replace('"<string>"', '"setup.py"'))
    return kept if found else [], ""
