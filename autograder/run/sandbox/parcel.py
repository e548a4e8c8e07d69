"""What a worker sends to who started it: plain messages, and trees of files, each within bounds.

A worker may have been taken over. Its messages are JSON or bytes, the receiver says beforehand how large they may be,
and paths lead nowhere but into the folder that the receiver names.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import astuple
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from autograder.run.sandbox.limits import MESSAGE, TreeLimits
from autograder.run.sandbox.trees import Entry, TreeError, survey


class ParcelError(Exception):
    """A message is larger than it may be, or is none of those that are understood."""


def send_message(line: Connection, message: Mapping[str, Any]) -> None:
    """Send a message as JSON."""
    line.send_bytes(json.dumps(message).encode())


def receive_message(line: Connection) -> dict[str, Any]:
    """Receive a message of at most `limits.MESSAGE` bytes.

    Raises:
        ParcelError: it is larger, or no JSON object.
        EOFError: the sender is gone.
    """
    try:
        message = json.loads(_receive(line, MESSAGE))
    except (ValueError, RecursionError):
        raise ParcelError("a message is no JSON") from None
    if not isinstance(message, dict):
        raise ParcelError("a message is no JSON object")
    return message


def send_tree(line: Connection, tree: Mapping[Entry, bytes]) -> None:
    """Send a tree that `trees.read_tree` has read."""
    line.send_bytes(json.dumps([astuple(entry) for entry in tree]).encode())
    for entry, data in tree.items():
        if entry.kind != "folder":
            line.send_bytes(data)


def receive_tree(line: Connection, limits: TreeLimits) -> dict[Entry, bytes]:
    """Receive a tree: what is in each file, and where each link leads.

    Raises:
        ParcelError: it breaks the limits, or has a path that leads out of it.
        EOFError: the sender is gone.
    """
    try:
        listed = json.loads(_receive(line, MESSAGE))
        entries = [Entry(str(p), str(kind), bool(x), int(size)) for p, kind, x, size in listed]
    except (ValueError, TypeError, RecursionError):
        raise ParcelError("a list of files is not as it has to be") from None
    if len(entries) > limits.names or sum(entry.size for entry in entries) > limits.size:
        raise ParcelError(f"a tree of {len(entries)} files is too large")
    if len({entry.path for entry in entries}) < len(entries) or not all(map(_is_plain, entries)):
        raise ParcelError("a tree has paths that lead out of it")
    return {entry: b"" if entry.kind == "folder" else _receive(line, max(entry.size, 4096)) for entry in entries}


def write_received(tree: Mapping[Entry, bytes], root: Path) -> None:
    """Write a tree that was received below a new folder. Links come last, so that nothing is written through one."""
    root.mkdir(parents=True, exist_ok=True)
    for entry in (entry for entry in tree if entry.kind != "link"):
        path = root / entry.path
        if entry.kind == "folder":
            path.mkdir(exist_ok=True)
        else:
            path.write_bytes(tree[entry])
            path.chmod(0o755 if entry.executable else 0o644)
    for entry in (entry for entry in tree if entry.kind == "link"):
        (root / entry.path).symlink_to(os.fsdecode(tree[entry]))
    try:
        survey(root, TreeLimits(names=len(tree) + 1, size=sum(map(len, tree.values())) + 1))
    except TreeError as error:
        raise ParcelError(f"a tree holds {error}") from None


def _is_plain(entry: Entry) -> bool:
    parts = entry.path.split("/")
    known = entry.kind in ("file", "folder", "link") and entry.size >= 0
    return known and "\0" not in entry.path and not {"", ".", ".."}.intersection(parts)


def _receive(line: Connection, most: int) -> bytes:
    try:
        return line.recv_bytes(most)
    except EOFError:
        raise
    except OSError:
        raise ParcelError(f"a message has more than {most} bytes") from None
