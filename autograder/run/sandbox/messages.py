"""Messages between a worker and the process that started it: JSON, and trees of files, each of limited size.

Student code may have taken over a worker. So its messages are only JSON or bytes, the receiver sets their maximum size
in advance, and paths lead only into the folder that the receiver names.
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
from autograder.run.sandbox.trees import Entry, TreeError, list_tree

_NEW_FILE = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC


class MessageError(Exception):
    """A message is too large or malformed."""


def send_message(line: Connection, message: Mapping[str, Any]) -> None:
    """Send a message as JSON."""
    line.send_bytes(json.dumps(message).encode())


def receive_message(line: Connection) -> dict[str, Any]:
    """Receive a message of at most `limits.MESSAGE` bytes.

    Raises:
        MessageError: the message is larger, or not a JSON object.
        EOFError: the sender has closed the connection.
    """
    try:
        message = json.loads(_receive(line, MESSAGE))
    except (ValueError, RecursionError):
        raise MessageError("a message is not JSON") from None
    if not isinstance(message, dict):
        raise MessageError("a message is not a JSON object")
    return message


def send_tree(line: Connection, tree: Mapping[Entry, bytes]) -> None:
    """Send a tree that `trees.read_tree` has read."""
    line.send_bytes(json.dumps([astuple(entry) for entry in tree]).encode())
    for entry, data in tree.items():
        if entry.kind != "folder":
            line.send_bytes(data)


def receive_tree(line: Connection, limits: TreeLimits) -> dict[Entry, bytes]:
    """Receive a tree: the content of each file, and the target of each link.

    Raises:
        MessageError: the tree exceeds the limits, has a path that leads out of it, or differs from its list.
        EOFError: the sender has closed the connection.
    """
    try:
        # JSON needs at most six bytes for a byte of a path.
        listing = json.loads(_receive(line, max(MESSAGE, 6 * limits.paths + 64 * limits.names)))
        entries = [Entry(str(p), str(kind), bool(x), int(size)) for p, kind, x, size in listing]
    except (ValueError, TypeError, OverflowError, RecursionError):
        raise MessageError("a list of files is malformed") from None
    if len(entries) > limits.names or sum(entry.size for entry in entries) > limits.size:
        raise MessageError(f"a tree of {len(entries)} files is too large")
    folders = {""}
    for entry in entries:
        if entry.path in folders or not _is_plain(entry, limits) or entry.path.rpartition("/")[0] not in folders:
            raise MessageError("a tree has paths that lead out of it")
        if entry.kind == "folder":
            folders.add(entry.path)
    if len({entry.path for entry in entries}) < len(entries):
        raise MessageError("a tree has two files of one name")
    return {entry: b"" if entry.kind == "folder" else _receive_file(line, entry.size) for entry in entries}


def write_received(tree: Mapping[Entry, bytes], root: Path) -> None:
    """Write a received tree to a new or empty folder, without overwriting anything or following links."""
    root.mkdir(parents=True, exist_ok=True)
    for entry in (entry for entry in tree if entry.kind != "link"):
        path = root / entry.path
        if entry.kind == "folder":
            path.mkdir()
            continue
        with os.fdopen(os.open(path, _NEW_FILE, 0o600), "wb") as file:
            file.write(tree[entry])
            os.fchmod(file.fileno(), 0o755 if entry.executable else 0o644)
    for entry in (entry for entry in tree if entry.kind == "link"):  # last, so that nothing is written through a link
        (root / entry.path).symlink_to(os.fsdecode(tree[entry]))
    deepest = max((entry.path.count("/") for entry in tree), default=0)
    try:
        list_tree(root, TreeLimits(names=len(tree), size=sum(map(len, tree.values())), depth=deepest + 1))
    except TreeError as error:
        raise MessageError(f"a tree contains {error}") from None


def _is_plain(entry: Entry, limits: TreeLimits) -> bool:
    parts = entry.path.split("/")
    try:
        is_short = len(os.fsencode(entry.path)) <= limits.path and len(parts) <= limits.depth + 1
    except UnicodeEncodeError:  # not a valid file name
        return False
    is_known = entry.kind in ("file", "folder", "link") and entry.size >= 0 and "\0" not in entry.path
    return is_known and is_short and not {"", ".", ".."}.intersection(parts)


def _receive_file(line: Connection, size: int) -> bytes:
    data = _receive(line, size)
    if len(data) != size:
        raise MessageError(f"a file of {size} bytes has {len(data)}")
    return data


def _receive(line: Connection, max_size: int) -> bytes:
    try:
        return line.recv_bytes(max_size)
    except EOFError:
        raise
    except ConnectionError:  # the sender has not read all that was sent to it
        raise EOFError from None
    except OSError:
        raise MessageError(f"a message has more than {max_size} bytes") from None
