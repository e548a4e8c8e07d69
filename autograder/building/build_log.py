"""Reduces a build's log to what a student needs: only frames of the student's files, and no empty blocks.

colcon runs setup.py before it builds. If that fails, the log contains tracebacks of colcon, and one in which setup.py
is called "<string>".

Times are removed, so that two gradings of the same submission give the same text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from autograder.run.lockstep.tracebacks import with_source_paths

MAX_END, MAX_LINE = 50_000, 1_000  # characters of each end of a log, and of each line, that are kept
_BEGIN = "Traceback (most recent call last):"
_FRAME = re.compile(r'  File "(?P<file>[^"]+)", line \d+')
_IN_SETUP = re.compile(r'  File "setup.py", line (?P<line>\d+)')
# rosidl's error about a line of a .msg, .srv or .action file. CMake prints it with a line break between any two words.
_DEFINITION = re.compile(
    r"Error\s+processing\s+(?P<text>'(?s:.{1,200}?)')\s+of\s+'(?P<file>\S{1,200})':\s+"
    r"'(?P<reason>(?s:.{1,500}?))'\n *\n"
)
# rosidl's error about a field whose package CMakeLists.txt does not name.
_DEPENDENCY = re.compile(
    r"/rosidl_generator_type_description/__init__\.py\"(?s:.{1,2000}?)\nKeyError: '(?P<package>\w{1,100})'\n"
)
# CMake also wraps its own messages. They name a file of ROS, and the student's line is at the end of the call stack.
_CMAKE_ERROR = re.compile(
    r"^CMake Error at (?P<place>\S{1,300}?)(?: \(\w{1,80}\))?:\n(?P<text>(?:  .*\n){1,12})(?P<stack>(?s:.{0,3000}))",
    re.MULTILINE,
)
_CMAKE_LINE = re.compile(r"^  (CMakeLists\.txt:\d+) \(", re.MULTILINE)
_CMAKE_TRACEBACK = re.compile(r"^  Traceback \(most recent call last\):\n(?:[ ]*\n|    .*\n)*", re.MULTILINE)
_RUNS_SETUP = "in run_setup"  # in setuptools; the frames below it that are called "<string>" are those of setup.py
_EMPTY_BLOCK = re.compile(r"^--- (?:stderr|output): .*\n(?:[ \t]*\n)*---\n", re.MULTILINE)
# colcon's repetition of an error, and a warning about this machine's ROS.
_COLCON_LINES = re.compile(r"^(?:Command '\[|\[[\d.]+s\] WARNING:colcon\.colcon_ros\.prefix_path\.).*\n?", re.MULTILINE)
_DURATION = r"(?:\d+h )?(?:\d+min )?[\d.]+s"
_TIME = re.compile(rf"^\[{_DURATION}\] | \[{_DURATION}\]$|(?<= \[){_DURATION}, (?=[^\[\]\n]+\]$)", re.MULTILINE)


def readable_log(log: str) -> str:
    """Return a log without the frames of colcon and setuptools, and without tracebacks that have no other frames."""
    lines = iter(with_source_paths(_bounded(log)).splitlines())
    result: list[str] = []
    for line in lines:
        while line == _BEGIN:
            block, line = _read_traceback(lines)
            result += block
        result.append(line)
    text = _CMAKE_TRACEBACK.sub("", _COLCON_LINES.sub("", "\n".join(result) + "\n"))
    return _TIME.sub("", _EMPTY_BLOCK.sub("", text)).rstrip("\n")


def first_error(log: str) -> str:
    """Return the first error of a failed build as one line, with the student's file if the log names it; or ""."""
    bounded = _bounded(log)
    if match := _DEFINITION.search(bounded):
        return f"{match['file']}, {' '.join(match['text'].split())}: {' '.join(match['reason'].split())}"
    if match := _DEPENDENCY.search(bounded):
        return f"CMakeLists.txt: rosidl_generate_interfaces does not name {match['package']} after DEPENDENCIES"
    text = readable_log(log)
    if match := _CMAKE_ERROR.search(text):
        student_line = _CMAKE_LINE.search(match["stack"])
        return f"{student_line[1] if student_line else match['place']}: {' '.join(match['text'].split())}"[:300]
    errors = [line.strip() for line in text.splitlines() if "Error" in line or "error:" in line]
    place = f"setup.py, line {match['line']}: " if (match := _IN_SETUP.search(text)) else ""
    return f"{place}{errors[0][:300]}" if errors else ""


def _bounded(log: str) -> str:
    """Return the start and the end of the log, with shortened lines, because students' builds can write any text."""
    text = log if len(log) <= 2 * MAX_END else f"{log[:MAX_END]}\n{log[-MAX_END:]}"
    return "\n".join(line[:MAX_LINE] for line in text.splitlines()) + "\n"


def _read_traceback(lines: Iterator[str]) -> tuple[list[str], str]:
    """Read a traceback after its first line; return the lines to keep, and the line after the traceback."""
    lines_to_keep = [_BEGIN]
    is_student_frame = has_student_frame = in_setup = False
    for line in lines:
        if not line.startswith("  "):
            return ([*lines_to_keep, line], next(lines, "")) if has_student_frame else ([], next(lines, ""))
        if match := _FRAME.match(line):
            is_student_frame = match["file"].startswith("ws/src/") or (in_setup and match["file"] == "<string>")
            has_student_frame |= is_student_frame
            in_setup |= _RUNS_SETUP in line
        if is_student_frame:
            lines_to_keep.append(line.replace('"<string>"', '"setup.py"'))
    return lines_to_keep if has_student_frame else [], ""
