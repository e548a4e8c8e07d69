"""The readers of the worker: for each, a function that reads data as the worker does, and data to try it with."""

from __future__ import annotations

import io
import json
import os
import tarfile
import zipfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path, PurePosixPath
from types import SimpleNamespace
from typing import Any

import nbformat
from hypothesis import strategies as st

from autograder.building import build_log
from autograder.building.interfaces import definition_reader, definitions
from autograder.diagnosis import Diagnosis, Kind
from autograder.grade import submitted_notebook
from autograder.grade.run_notebook import _would_overwrite, read_answer
from autograder.harness.launch import LaunchHarness
from autograder.harness.matching import connected
from autograder.harness.stepped import _sum
from autograder.harness.steps import next_instant, tick_of
from autograder.probes import (
    calls,
    given_files,
    imports,
    installed,
    interfaces,
    launch_arguments,
    launch_probe,
    manifest,
    parameters,
    rclpy_races,
    student_test_reports,
)
from autograder.run.lockstep import failures, protocol, tracebacks
from autograder.run.sandbox import ExitReason
from autograder.submission import exercise_stubs, intake, packages
from autograder.submission.intake.notebooks import read_cells
from autograder.submission.intake.writefile import written_file
from tests.unit.reading import chapter_readers, ros_readers
from tests.unit.reading.generated import JSON, altered, altered_json, texts
from tests.unit.reading.reader import Reader
from tests.unit.reading.samples import (
    CALLS,
    DEFINITION,
    EVENTS,
    JUNIT,
    LAUNCH_OUTPUT,
    MANIFEST,
    METADATA,
    NOTEBOOK,
    OUTPUTS,
    PARAMETERS,
    PYTHON,
    SHOWN_ARGUMENTS,
    TRACEBACK,
)

GIVEN_FILES = {"a/a.py": b"a = 1\n", "a/a.yaml": b"a: 1\nb: [2.0, c]\n"}


def _written(name: str, read: Callable[[Path], object]) -> Callable[[bytes, Path], object]:
    """Let a value be the content of a file of this name; `read` gets the folder."""

    def with_file(data: bytes, folder: Path) -> object:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        return read(folder)

    return with_file


def _parse_notebook(data: bytes, folder: Path) -> object:
    source = submitted_notebook.read(json.dumps(NOTEBOOK).encode(), "source")
    return submitted_notebook.restore(submitted_notebook.read(data, "02_nodes.ipynb"), source)


def _answer_of_calls(answer: Any, folder: Path) -> object:
    process: Any = SimpleNamespace(exit_reason=ExitReason.EXITED, returncode=0, output="")
    outcomes = calls.parse_answer(json.dumps(answer).encode(), "wheels.limits", 2, process)
    for outcome in outcomes:
        value = calls.value(outcome, "limit(1.0)")
        return calls.same(value, 1.0), calls.same([value], [[1]]), f"limit(1.0) returned {value}"
    return None


def _use(event: str, record: Any) -> object:
    """Count, compare and pass on the report of a program, as a harness in lockstep does."""
    if isinstance(record, protocol.Description):
        counts = _sum([record.early, record.kept, record.early]) + _sum([record.kept])
        json.dumps({"kept": dict(counts), "reads": sorted(record.reads)})
        grader: Any = SimpleNamespace(readers=[], publisher_channels={}, publishers={}, clients=list)
        return connected([record, record], grader), tick_of(10**8, record.timers)
    if isinstance(record, protocol.Reply):
        counts = _sum([*record.sent, *record.sent])
        return json.dumps(dict(counts)), next_instant(100, 10**9, [record.wake]), f"{record.notes} {counts}"
    return event, record


def _diagnose_crash(text: str, folder: Path) -> object:
    process: Any = SimpleNamespace(exit_reason=ExitReason.EXITED, returncode=1, output=text)
    lines = text.splitlines() or [""]
    crash = protocol.Crash("spin", lines[-1], text, text)
    return failures.diagnose_output(process), failures.diagnose_exit(process), failures.diagnose_crash(crash)


def _launch_output(text: str, folder: Path) -> object:
    launch_arguments.parse_arguments(text)
    launch_probe.require_written(text)
    for program in launch_probe.started(text):
        launch_probe.node_names(text, program)
    return launch_probe.ended(text), launch_probe.failure(text), launch_probe.unreadable(text)


def _status_of_launch(data: bytes, folder: Path) -> object:
    ours, theirs = os.pipe()
    os.set_blocking(ours, False)
    os.write(theirs, data)
    harness = LaunchHarness.__new__(LaunchHarness)
    harness._status_pipe, harness._status_text = ours, b""
    try:
        return [harness.status for _ in range(2 + len(data))]
    finally:
        os.close(ours)
        os.close(theirs)


def _cell(source: str) -> nbformat.NotebookNode:
    return nbformat.v4.new_code_cell(source)


def _archived(folder: Path, data: bytes) -> None:
    (folder / "alice.zip").write_bytes(data)
    read = intake.read_submission(folder / "alice.zip", "02_nodes")
    intake.write_tree(read.source, folder / "src")


def _archive() -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("02_nodes/02_nodes.ipynb", json.dumps(NOTEBOOK))
        archive.writestr("02_nodes/ws/src/wheels/package.xml", MANIFEST)
    return buffer.getvalue()


def _tar() -> bytes:
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.PAX_FORMAT, pax_headers={"comment": "ä"}) as archive:
        for name, data in ((f"{'long ' * 30}/02_nodes.ipynb", json.dumps(NOTEBOOK).encode()), ("src/a", MANIFEST)):
            info = tarfile.TarInfo(name)
            info.size, info.mtime = len(data), 1.5  # a fraction needs a header of its own
            archive.addfile(info, io.BytesIO(data))
    return buffer.getvalue()


def _definition(package: str, kind: str) -> Callable[[bytes, Path], object]:
    def read(data: bytes, folder: Path) -> object:
        text = data.decode(errors="replace")
        expected = interfaces.parse(package, f"{kind}/Status.{kind}", DEFINITION[kind].decode())
        actual = interfaces.parse(package, f"{kind}/Status.{kind}", text)
        return interfaces.share(expected, interfaces.compare(expected, actual))

    return read


def _bomb(form: str) -> bytes:
    """Return a parameter file whose aliases expand to 9 to the power of 25 values."""
    names = [f"n{i}" for i in range(26)]
    lines = [f"  {name}: &{name} {form.format(', '.join([f'*{old}'] * 9))}" for old, name in pairwise(names)]
    return "\n".join(["scout:", " ros__parameters:", "  n0: &n0 {b: 1}", *lines, ""]).encode()


def _parameters_of(folder: Path) -> object:
    file = parameters.read_file(folder / "config" / "fleet.yaml")
    values = parameters.for_node(file, "scout")
    declared = parameters.as_declared(values, {"speed": 0.5, "count": 3})
    return parameters.differences(declared, {"speed": 1.0}), parameters.missing_sentence({"speed"}, values)


_UNFINISHED = Diagnosis(Kind.BUILD_FAILED, "It does not build.")

READERS: dict[str, Reader] = {
    "package.xml by its name": Reader(
        _written("wheels/package.xml", lambda folder: packages.find_packages(folder)),
        altered(MANIFEST),
        (
            MANIFEST.replace(b'encoding="utf-8"', b'encoding="foo"'),
            MANIFEST.replace(b'encoding="utf-8"', b'encoding="idna"'),
            MANIFEST.replace(b"<name>wheels", b"<name>../../wheels"),
        ),
    ),
    "package.xml whole": Reader(
        _written("wheels/package.xml", lambda folder: manifest.read(folder / "wheels")),
        altered(MANIFEST),
        (MANIFEST.replace(b'encoding="utf-8"', b'encoding="foo"'),),
    ),
    "stubs of a package": Reader(
        _written("wheels/package.xml", lambda folder: exercise_stubs.explain(_UNFINISHED, folder, "wheels")),
        altered(MANIFEST),
        (b"<depend>..</depend><depend>.</depend>", b"<depend>" + b"a" * 300 + b"</depend>"),
    ),
    "parameter file": Reader(
        _written("config/fleet.yaml", _parameters_of),
        altered(*PARAMETERS),
        (
            b"scout:\n  ros__parameters: {a: !!bool foo}\n",
            b"scout:\n  ros__parameters: {a: !!int ''}\n",
            b"scout:\n  ros__parameters: {a: !!timestamp foo}\n",
            b"scout:\n  ros__parameters: {a: !!float x}\n",
            b"!!binary \xff: 1\n",
            b"scout:\n  ros__parameters: {speed: " + b"9" * 400 + b"}\n",
            b"scout:\n  ros__parameters: {speed: 0x" + b"9" * 5000 + b"}\n",
            b"0x" + b"9" * 5000 + b": 1\n",
            b"? [1, 2]\n: 1\n",
            _bomb("[{}]"),
            _bomb("{{<<: [{}]}}"),
            b"scout: &s {ros__parameters: {a: *s}}\n",
        ),
    ),
    "answer of a function": Reader(
        _answer_of_calls,
        altered_json(*CALLS) | JSON,
        (
            {"outcomes": [{"value": 10**400}, {}]},
            {"outcomes": [{"value": [10**4000]}, {}]},
            {"outcomes": [{"value": 1.0, "type": 10**400}, {}]},
            {"outcomes": [{"raised": "E", "message": {"a": 10**400}}, {}]},
            {"failed": {"raised": [], "message": 1, "traceback": None}},
            {"outcomes": [[], {"arguments": {"a": 1}}]},
        ),
    ),
    "event of a stepped program": Reader(
        lambda event, folder: _use(*protocol.parse(json.dumps(event).encode() + b"\n")),
        altered_json(*EVENTS) | JSON,
        (
            *({**event, "event": ["done"]} for event in EVENTS),
            {**EVENTS[1], "sent": [{"/cmd_vel T": int("9" * 4300)}]},
            {**EVENTS[1], "wake": int("9" * 4300)},
            {**EVENTS[-1], "early": {"/add S request": int("9" * 4300)}},
            {**EVENTS[-1], "kept": {"/said T": int("9" * 4300)}},
            {**EVENTS[-1], "timers": [int("9" * 4300)]},
            {**EVENTS[-1], "writers": [["/said T", int("9" * 4300)]]},
        ),
        refuses=(protocol.ProtocolError,),
    ),
    "line of a stepped program": Reader(
        lambda line, folder: protocol.parse(line + b"\n"),
        altered(*(json.dumps(event).encode() for event in EVENTS)),
        refuses=(protocol.ProtocolError,),
    ),
    "report of pytest": Reader(
        lambda data, folder: student_test_reports.parse_claims(data),
        altered(JUNIT),
        (JUNIT.replace(b"utf-8", b"foo"), JUNIT.replace(b"utf-8", b"utf-7")),
    ),
    "output of a launch": Reader(_launch_output, texts(LAUNCH_OUTPUT, SHOWN_ARGUMENTS)),
    "exit status of a launch": Reader(
        _status_of_launch,
        altered(b"0\n", b"-15\n"),
        (b"points\n", b"-\n", b"1\n0\n", b"\xd9\xa3\n", b"9" * 4301 + b"\n", b"x" * 70, b"--1\n", b"1_0\n"),
    ),
    "traceback": Reader(_diagnose_crash, texts(TRACEBACK)),
    "traceback of a signal's race": Reader(lambda text, folder: rclpy_races.lost_a_race(text), texts(TRACEBACK)),
    "frames of a traceback": Reader(lambda text, folder: tracebacks.student_frames(text), texts(TRACEBACK)),
    "log of a build": Reader(
        lambda text, folder: (build_log.readable_log(text), build_log.first_error(text)),
        texts(TRACEBACK, LAUNCH_OUTPUT),
    ),
    "imports of a module": Reader(
        _written("wheels/wheels/limits.py", lambda folder: imports.imported(folder / "wheels")),
        altered(PYTHON),
        (b"(" * 5000, b"\0", b"# coding: foo\n", b"x = " + b"9" * 5000),
    ),
    "given file": Reader(
        lambda data, folder: given_files.changed_files({"a/a.py": data, "a/a.yaml": data}, GIVEN_FILES, ("a",)),
        altered(PYTHON, *GIVEN_FILES.values()),
        (b"a: 2026-13-01", b"? [a]\n: !!int x", b"x = a" + b".b" * 5000, b"1: 2\na: 3"),
    ),
    "metadata of an installed package": Reader(
        _written(
            "install/wheels/lib/python3.12/site-packages/wheels-1.0.egg-info/entry_points.txt",
            lambda folder: installed.inspect_package(folder / "install", "wheels"),
        ),
        altered(METADATA),
        (b"[console_scripts]\na\n", b"a=b\n[console_scripts]\nc=d\n", b"[console_scripts]\na=b\n c=d\n[a\n"),
    ),
    "definition of a message": Reader(
        _definition("wheels_msgs", "msg"), altered(DEFINITION["msg"]), refuses=(interfaces.Unreadable,)
    ),
    "definition of an action": Reader(
        _definition("wheels_msgs", "action"), altered(DEFINITION["action"]), refuses=(interfaces.Unreadable,)
    ),
    "definition that is built": Reader(
        lambda data, folder: definition_reader.read("wheels_msgs", {"msg/Status.msg": data.decode(errors="replace")}),
        altered(DEFINITION["msg"]),
        refuses=(definitions.DefinitionError,),
    ),
    "notebook": Reader(
        lambda value, folder: _parse_notebook(json.dumps(value).encode(), folder),
        altered_json(NOTEBOOK),
        ({**NOTEBOOK, "nbformat_minor": 10**400}, {**NOTEBOOK, "metadata": []}, {**NOTEBOOK, "cells": {"a": 1}}),
    ),
    "cells of a notebook": Reader(
        lambda value, folder: [written_file(cell["source"]) for cell in read_cells(json.dumps(value).encode())],
        altered_json(NOTEBOOK),
        refuses=(ValueError,),
    ),
    "bytes of a notebook": Reader(_parse_notebook, altered(json.dumps(NOTEBOOK).encode())),
    "outputs of a notebook": Reader(
        lambda lines, folder: read_answer(b"\n".join(json.dumps(line).encode() for line in lines)),
        st.lists(altered_json(*OUTPUTS), max_size=3),
    ),
    "bytes of outputs of a notebook": Reader(
        lambda data, folder: read_answer(data), altered(b"\n".join(json.dumps(line).encode() for line in OUTPUTS))
    ),
    "file that a cell writes": Reader(
        lambda name, folder: _would_overwrite(_cell(f"%%writefile {name}\n# YOUR CODE HERE"), folder),
        st.text(st.sampled_from("ab/.~\0\ud800 é*\n-"), max_size=40) | st.sampled_from(("a" * 300, "/" * 5000)),
        ("a\0b", "a" * 300, "ws/src/" + "b" * 256 + "/c", "\ud800", "~", "/etc/passwd", ".", "..", "-a", ""),
    ),
    "archive": Reader(lambda data, folder: _archived(folder, data), altered(_archive())),
    "tar": Reader(lambda data, folder: _archived(folder, data), altered(_tar())),
    "names in a submission": Reader(
        lambda names, folder: intake.detect_layout(
            [intake.SubmittedFile(PurePosixPath(name), b"") for name in names], "02_nodes"
        ),
        st.lists(
            st.lists(st.sampled_from(("02_nodes.ipynb", "ws", "src", "a", "..", "\udcff", "é")), max_size=5).map(
                "/".join
            ),
            max_size=6,
        ),
        (["ws/src/a", "ws/src/a/b"], [""], ["src"], ["/"]),
    ),
    **ros_readers.READERS,
    **chapter_readers.READERS,
}
