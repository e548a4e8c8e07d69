"""A traceback as a student needs it: the frames of the student's own files, under the paths of the workspace."""

from __future__ import annotations

import re

_FRAME = re.compile(r'^  File "(?P<file>[^"]+)", line \d+')
_MODULES = re.compile(r"lib/python[\d.]+/site-packages/")  # where colcon puts a package's modules
_GENERATED = re.compile(r"/(?:msg|srv|action)/_\w+\.py$")  # by rosidl, from the student's definitions


def with_source_paths(text: str) -> str:
    """Return a text in which the quoted paths of built Python files are those of their sources, `ws/src/...`."""
    return "\n".join(map(_with_source_paths, text.split("\n")))


def _with_source_paths(line: str) -> str:
    *quoted, rest = line.split('"')
    return '"'.join([*map(_source_path, quoted), rest])


def _source_path(text: str) -> str:
    """Return the part of a line before a quotation mark with the path of its source, if it ends in a built file's."""
    before, install, path = text.rpartition("/install/")
    package, _, inside = path.partition("/")
    modules, share = (
        _MODULES.match(inside),
        f"share/{package}/",
    )  # setup.py of each chapter puts there what is no module
    if install and package.split() == [package] and path.endswith(".py") and (modules or inside.startswith(share)):
        text = f"{before}/ws/src/{package}/{inside[modules.end() if modules else len(share) :]}"
    before, source, path = text.rpartition("/ws/src/")
    begin = max(map(before.rfind, " \t")) + 1  # of the path, behind a blank
    return f"{before[:begin]}ws/src/{path}" if source and path else text


def own_frames(traceback: str) -> str:
    """Return a traceback without the frames of files that the student did not write; as it is if no other is left."""
    kept: list[str] = []
    frame = own = False  # whether the line before belongs to a frame, and whether that frame is the student's
    found = False
    for line in with_source_paths(traceback).splitlines():
        if match := _FRAME.match(line):
            frame, own = True, _is_own(match["file"])
            found |= own
        elif not line.startswith(("    ", "  [Previous line")):
            frame = False
        if own or not frame:
            kept.append(line)
    return "\n".join(kept) if found else traceback


def _is_own(path: str) -> bool:
    return path.startswith("ws/src/") and not _GENERATED.search(path)
