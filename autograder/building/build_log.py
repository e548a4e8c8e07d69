"""A build's log as a student needs it: of each traceback the frames of the student's own files, and nothing empty.

colcon reads a setup.py before it builds. Where that fails, the log holds tracebacks of colcon's own, and one in which
setup.py is called "<string>".

It holds no times: two gradings of one submission give the same text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from autograder.run.lockstep.tracebacks import with_source_paths

END, LINE = 50_000, 1_000  # characters
_BEGIN = "Traceback (most recent call last):"
_FRAME = re.compile(r'  File "(?P<file>[^"]+)", line \d+')
_IN_SETUP = re.compile(r'  File "setup.py", line (?P<line>\d+)')
# rosidl on a line of a .msg, .srv or .action file, in a message of CMake's that breaks lines between any two words;
# and the traceback that it then prints.
_DEFINITION = re.compile(
    r"Error\s+processing\s+(?P<text>'(?s:.{1,200}?)')\s+of\s+'(?P<file>\S{1,200})':\s+'(?P<why>(?s:.{1,500}?))'\n *\n"
)
# rosidl on a field whose package CMakeLists.txt does not name.
_DEPENDENCY = re.compile(
    r"/rosidl_generator_type_description/__init__\.py\"(?s:.{1,2000}?)\nKeyError: '(?P<package>\w{1,100})'\n"
)
# CMake wraps its messages, too, and names a file of ROS; the student's line is at the end of the call stack.
_CMAKE_ERROR = re.compile(
    r"^CMake Error at (?P<place>\S{1,300}?)(?: \(\w{1,80}\))?:\n(?P<text>(?:  .*\n){1,12})(?P<rest>(?s:.{0,3000}))",
    re.MULTILINE,
)
_CMAKE_LINE = re.compile(r"^  (CMakeLists\.txt:\d+) \(", re.MULTILINE)
_CMAKE_TRACEBACK = re.compile(r"^  Traceback \(most recent call last\):\n(?:[ ]*\n|    .*\n)*", re.MULTILINE)
_RUNS_SETUP = "in run_setup"  # of setuptools: the frames called "<string>" below it are those of setup.py
_EMPTY_BLOCK = re.compile(r"^--- (?:stderr|output): .*\n(?:[ \t]*\n)*---\n", re.MULTILINE)
# colcon's own error, repeated, and its statement about this machine's ROS.
_OTHERS = re.compile(r"^(?:Command '\[|\[[\d.]+s\] WARNING:colcon\.colcon_ros\.prefix_path\.).*\n?", re.MULTILINE)
_TOOK = r"(?:\d+h )?(?:\d+min )?[\d.]+s"
_TIME = re.compile(rf"^\[{_TOOK}\] | \[{_TOOK}\]$|(?<= \[){_TOOK}, (?=[^\[\]\n]+\]$)", re.MULTILINE)


def readable(log: str) -> str:
    """Return a log without the frames of colcon and setuptools; a traceback that has no other is left out."""
    lines = iter(with_source_paths(_bounded(log)).splitlines())
    kept: list[str] = []
    for line in lines:
        while line == _BEGIN:
            block, line = _own(lines)
            kept += block
        kept.append(line)
    text = _CMAKE_TRACEBACK.sub("", _OTHERS.sub("", "\n".join(kept) + "\n"))
    return _TIME.sub("", _EMPTY_BLOCK.sub("", text)).rstrip("\n")


def first_error(log: str) -> str:
    """Return the first error of a failed build in a line, with the student's file where the log names it; or ""."""
    bounded = _bounded(log)
    if match := _DEFINITION.search(bounded):
        return f"{match['file']}, {' '.join(match['text'].split())}: {' '.join(match['why'].split())}"
    if match := _DEPENDENCY.search(bounded):
        return f"CMakeLists.txt: rosidl_generate_interfaces does not name {match['package']} after DEPENDENCIES"
    text = readable(log)
    if match := _CMAKE_ERROR.search(text):
        own = _CMAKE_LINE.search(match["rest"])
        return f"{own[1] if own else match['place']}: {' '.join(match['text'].split())}"[:300]
    errors = [line.strip() for line in text.splitlines() if "Error" in line or "error:" in line]
    place = f"setup.py, line {match['line']}: " if (match := _IN_SETUP.search(text)) else ""
    return f"{place}{errors[0][:300]}" if errors else ""


def _bounded(log: str) -> str:
    """Return the start and the end of the log, with lines of at most `LINE` characters: students' builds write it."""
    ends = log if len(log) <= 2 * END else f"{log[:END]}\n{log[-END:]}"
    return "\n".join(line[:LINE] for line in ends.splitlines()) + "\n"


def _own(lines: Iterator[str]) -> tuple[list[str], str]:
    """Read a traceback after its first line; return the lines to keep, and the line after the traceback."""
    kept = [_BEGIN]
    own = has_own = in_setup = False
    for line in lines:
        if not line.startswith("  "):
            return ([*kept, line], next(lines, "")) if has_own else ([], next(lines, ""))
        if match := _FRAME.match(line):
            own = match["file"].startswith("ws/src/") or (in_setup and match["file"] == "<string>")
            has_own |= own
            in_setup |= _RUNS_SETUP in line
        if own:
            kept.append(line.replace('"<string>"', '"setup.py"'))
    return kept if has_own else [], ""
