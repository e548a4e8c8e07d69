"""A traceback as a student needs it: the frames of the student's own files, under the paths of the workspace."""

from __future__ import annotations

import re

_FRAME = re.compile(r'^  File "(?P<file>[^"]+)", line \d+')
# Where colcon puts a package's modules, and where setup.py of each chapter puts what is no module.
_INSTALLED = re.compile(
    r'[^"\s]*/install/(?P<package>[^/"\s]+)/'
    r'(?:lib/python[\d.]+/site-packages|share/(?P=package))/(?P<path>[^"\n]+?\.py)(?=")'
)
_IN_SOURCE = re.compile(r'[^"\s]*/(?=ws/src/[^"\n]+")')
_GENERATED = re.compile(r"/(?:msg|srv|action)/_\w+\.py$")  # by rosidl, from the student's definitions


def with_source_paths(text: str) -> str:
    """Return a text in which the quoted paths of built Python files are those of their sources, `ws/src/...`."""
    return _IN_SOURCE.sub("", _INSTALLED.sub(r"ws/src/\g<package>/\g<path>", text))


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
