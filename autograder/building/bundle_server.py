"""Serves workers' requests for built interface packages from a cache, in the process that started the workers.

A worker cannot write to the cache. It sends sources, and the process that started it looks them up by their content. If
they are new, another worker builds them in its own sandbox, which contains these sources and no other file of any
submission. So each entry was built by an unmodified worker, from the content that is its key. A worker that students'
code has taken over can request builds of its own sources, but cannot change the packages of other submissions.
"""

from __future__ import annotations

import hashlib
import json
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import asdict, astuple, replace
from functools import partial
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from autograder.building.colcon import StoppedBuildError
from autograder.building.interfaces import Cache
from autograder.building.interfaces.prefix import identity
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.ros import find
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import BUILD, CACHED, GRADING_WORKER, RESULT_FILES, SOURCES
from autograder.run.sandbox.messages import (
    MessageError,
    receive_message,
    receive_tree,
    send_message,
    send_tree,
    write_received,
)
from autograder.run.sandbox.trees import Entry, read_tree
from autograder.run.sandbox.worker_sandbox import in_worker_sandbox, wait_and_report

CACHE = "bundles"
VERSION = 3  # of an entry's format and of the build steps; part of each key
_POLL_SECONDS = 0.25  # between two checks of whether a silent worker is still running
_MARGIN = 60.0  # s that a worker gets for its start and its end, in addition to the build


def serve_worker(
    line: Connection, isolation: Isolation, is_over: Callable[[], bool]
) -> tuple[dict[str, bytes], dict[str, Any]]:
    """Serve a worker until it is done; return the files of its result, and its last message.

    The worker requests builds of interface packages, sends its result, and may report that it is done. If it ends
    without such a report, the last message is empty.

    Raises:
        MessageError: a message does not come from an unmodified worker.
    """
    files: dict[str, bytes] = {}
    while True:
        if not line.poll(_POLL_SECONDS):
            if is_over():
                return files, {}
            continue
        try:
            message = receive_message(line)
            if message.get("do") == "result":
                files = {entry.path: data for entry, data in receive_tree(line, RESULT_FILES).items()}
            elif message.get("do") == "build":
                _serve_build(line, receive_tree(line, SOURCES), isolation)
            elif message.get("do") == "done":
                return files, message
            else:
                raise MessageError("a worker sent an unknown request")
        except (EOFError, ConnectionError):
            return files, {}


def request_build(line: Connection, sources: Mapping[Entry, bytes], target: Path) -> None:
    """Request a build of interface packages from the process that started this worker; write the files to `target`.

    Raises:
        StudentError: the packages do not build.
        GraderError: the packages could not be built for another reason.
    """
    send_message(line, {"do": "build"})
    send_tree(line, sources)
    reply = receive_message(line)
    if "diagnosis" in reply:
        raise _build_error(reply)
    if "failed" in reply:
        raise GraderError(reply["failed"])
    write_received(receive_tree(line, CACHED), target)


def failure_message(error: StudentError) -> dict[str, Any]:
    """Return the message about a failed build. It tells whether a limit stopped the build."""
    return {"diagnosis": asdict(error.diagnosis), "stopped": isinstance(error, StoppedBuildError)}


def _build_error(reply: Mapping[str, Any]) -> StudentError:
    diagnosis = Diagnosis(**{**reply["diagnosis"], "kind": Kind(reply["diagnosis"]["kind"])})
    return StoppedBuildError(diagnosis) if reply.get("stopped") else StudentError(diagnosis)


def key(sources: Mapping[Entry, bytes]) -> str:
    """Return the key of built packages: a digest of their sources and of the tools that build them."""
    digest = hashlib.sha256(json.dumps([VERSION, identity(find())], sort_keys=True).encode())
    for entry in sorted(sources, key=lambda entry: entry.path):
        head = json.dumps(astuple(entry)).encode()
        digest.update(b"%d %d " % (len(head), len(sources[entry])) + head + sources[entry])
    return digest.hexdigest()[:40]


def _serve_build(line: Connection, sources: Mapping[Entry, bytes], isolation: Isolation) -> None:
    try:
        with Cache.default(CACHE).use(key(sources), partial(_make_once, time.time(), sources, isolation)) as entry:
            built = read_tree(entry, CACHED)
    except StudentError as error:
        send_message(line, failure_message(error))
    except GraderError as error:
        send_message(line, {"failed": str(error)})
    else:
        send_message(line, {})
        send_tree(line, built)


def _make_once(request_time: float, sources: Mapping[Entry, bytes], isolation: Isolation, entry: Path) -> None:
    """Fill a new entry, unless a limit has stopped a build of the same sources after `request_time`.

    A request that has waited for such a build has no time left for a second one.
    """
    record = entry.parent / f"{key(sources)}.stopped"
    with suppress(FileNotFoundError):
        failure = json.loads(record.read_text())
        if failure["ended"] >= request_time:
            raise _build_error(failure)
        record.unlink()
    try:
        _make(sources, isolation, entry)
    except StoppedBuildError as error:
        record.write_text(json.dumps({**failure_message(error), "ended": time.time()}))
        raise


def _make(sources: Mapping[Entry, bytes], isolation: Isolation, entry: Path) -> None:
    """Fill a new entry with the packages that a worker builds from the sources in a separate sandbox."""
    own_end, worker_end = Pipe()

    def command(scratch: Path) -> list[str]:
        return [sys.executable, "-m", "autograder.building.bundle_worker", str(scratch), str(worker_end.fileno())]

    limits = replace(GRADING_WORKER, wall_seconds=BUILD.wall_seconds + _MARGIN)
    with own_end, ExitStack() as stack:
        with worker_end:
            process, _ = stack.enter_context(
                in_worker_sandbox(command, isolation, limits, pass_fds=(worker_end.fileno(),))
            )
        try:
            send_tree(own_end, sources)
            reply = receive_message(own_end)
            if "diagnosis" in reply:
                raise _build_error(reply)
            write_received(receive_tree(own_end, CACHED), entry)
        except (EOFError, OSError, MessageError, KeyError, ValueError, TypeError) as error:
            process.kill()
            raise GraderError(
                f"interface packages could not be built: {error!r}\n{wait_and_report(process).output}"
            ) from None
