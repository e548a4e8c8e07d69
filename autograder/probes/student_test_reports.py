"""Records of runs of a student's tests: the package, the requested run, and its report in JUnit XML.

A run that can read a hidden version can put the version's text into any part of the report: ids of parametrized tests,
names of generated ones, exceptions, output. So such a report is closed (`Report.closed`): only names from the student's
source remain.
"""

from __future__ import annotations

import ast
import hmac
import secrets
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import PurePosixPath
from typing import ClassVar

from autograder.probes.files import parse_python
from autograder.probes.versions import Version
from autograder.run.sandbox import ExitReason

MAX_BYTES = 1024 * 1024
MAX_MESSAGE = 300  # characters
MAX_SOURCE = 256 * 1024  # bytes of a test file from which names are read
MAX_SOURCES = 1024 * 1024  # bytes of all test files from which names are read
MAX_NAME = 300  # characters of a test's name, including the classes around it
UNNAMED = "a test"  # the name for a test whose own name does not occur in the student's source
_KEY = secrets.token_bytes(16)  # the key for the digests of parameters' ids


class ClaimedOutcome(str, Enum):
    """The outcome of one test, as the run reports it."""

    PASSED = "passed"
    FAILED = "failed"
    ERROR = "error"
    SKIPPED = "skipped"


@dataclass(frozen=True)
class Claims:
    """The outcomes of all tests, as the run reports them."""

    # The outcomes by test, `module::name` or `module::Class::name`, in the order of execution.
    verdicts: Mapping[str, ClaimedOutcome] = field(default_factory=dict)
    messages: Mapping[str, str] = field(default_factory=dict)  # the first line of each failure, by test


@dataclass(frozen=True)
class TestRun:
    """One run of a student's tests."""

    files: tuple[str, ...]  # paths of test files, below the package's folder `test`
    version: Version | None = None  # the package under test; None for the student's own, as it was built
    backwards: bool = False  # whether the tests run in the opposite order
    exit_first: bool = False  # whether the run ends with the first test that fails
    sniffed: bool = False  # whether an `RtpsSniffer` receives announcements in the default domain
    conftest: bool = True  # whether pytest reads a conftest.py
    deselected: tuple[str, ...] = ()  # tests that do not run, named as in `Claims`
    is_public: bool = False  # whether the student may read the output about `version`, because it is not secret
    __test__: ClassVar[bool] = False  # otherwise pytest takes this for a class of tests


@dataclass(frozen=True)
class Report:
    """The report of a run.

    The run itself claims everything except `exit_reason`, `open_sockets`, `is_logging` and `joined_domain`.
    """

    exit_reason: ExitReason | None  # how the process ended; None if the grader ended it after pytest
    status: int | None  # pytest's exit status, or None if pytest did not reach its end
    claims: Claims  # the reported outcomes of the tests
    open_sockets: int  # UDP sockets open after the last test; each ROS context that still exists has some
    output: str
    is_logging: bool = False  # whether a log file was still open then; rclpy closes its own with the last context
    joined_domain: bool = False  # whether a program joined the default domain, if the run was sniffed
    source_tests: frozenset[str] | None = None  # in a closed report: the tests in the student's source, `module::name`

    @property
    def timed_out(self) -> bool:
        """Whether the run was stopped because it took too long."""
        return self.exit_reason is ExitReason.WALL_TIME

    @property
    def passed(self) -> bool:
        """Whether at least one test ran and all passed."""
        return self.status == 0 and bool(self.executed) and not self.failed

    @property
    def executed(self) -> tuple[str, ...]:
        """The tests that ran and were not skipped."""
        return tuple(name for name, verdict in self.claims.verdicts.items() if verdict is not ClaimedOutcome.SKIPPED)

    @property
    def failed(self) -> tuple[str, ...]:
        """The tests that failed or had an error in a fixture."""
        bad = (ClaimedOutcome.FAILED, ClaimedOutcome.ERROR)
        return tuple(name for name, verdict in self.claims.verdicts.items() if verdict in bad)

    def detects_fault(self, correct_report: Report) -> bool:
        """Return whether any test that passed on a correct version fails in this report.

        A test file that cannot be imported does not count.
        """
        if self.source_tests is not None and correct_report.source_tests is None:
            correct_report = correct_report.closed(self.source_tests)
        return self.status == 1 and bool(set(self.failed) & set(correct_report.executed) - set(correct_report.failed))

    def failed_in(self, other: Report) -> tuple[str, ...]:
        """Return the tests of this report that fail in another one. Only the other one may be closed."""
        bad = set(other.failed)
        if other.source_tests is None:
            return tuple(name for name in self.claims.verdicts if name in bad)
        return tuple(name for name in self.claims.verdicts if _closed_name(name, other.source_tests) in bad)

    def closed(self, source_tests: frozenset[str]) -> Report:
        """Return the report without any text of the run, for a run that can read a hidden version.

        It has no output and no messages. A test is named as in the student's source, or `UNNAMED`. The id of a
        parameter is replaced by a digest, which is used only to compare runs in this process.
        """
        verdicts = {_closed_name(name, source_tests): verdict for name, verdict in self.claims.verdicts.items()}
        return replace(self, claims=Claims(verdicts), output="", source_tests=source_tests)


def shown_name(test: str) -> str:
    """Return a test's name for a sentence, without its module, and in a closed report without its parameters."""
    return test.partition("[#")[0].partition("::")[2] or UNNAMED


def _closed_name(name: str, source_tests: frozenset[str]) -> str:
    if name in source_tests:
        return name
    base, digest = name.partition("[")[0], hmac.digest(_KEY, name.encode(errors="replace"), "sha256").hex()[:16]
    return f"{base if base in source_tests else UNNAMED}[#{digest}]"


@dataclass(frozen=True)
class Source:
    """A student's package as plain files, by their paths below its folder."""

    package: str
    files: Mapping[str, bytes]

    @property
    def tests(self) -> dict[str, bytes]:
        """The files below `test`, by their paths relative to it."""
        return {name.removeprefix("test/"): data for name, data in self.files.items() if name.startswith("test/")}

    def test_names(self, files: tuple[str, ...]) -> frozenset[str]:
        """Return the tests in test files, named as in a report. The files are parsed, not run.

        Tests with very long names, or in files that exceed the limits, are left out and become `UNNAMED`.
        """
        names: set[str] = set()
        tests, remaining = self.tests, MAX_SOURCES
        for name in files:
            data = tests.get(name, b"")
            if len(data) > min(MAX_SOURCE, remaining):
                continue
            remaining -= len(data)
            tree = parse_python(data)
            for node in tree.body if tree else ():
                names.update(_tests(node, PurePosixPath(name).stem))
        return frozenset(names)


def _tests(node: ast.stmt, prefix: str) -> Iterator[str]:
    if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return
    name = f"{prefix}::{node.name}"
    if len(name) > MAX_NAME:
        return
    if isinstance(node, ast.ClassDef):
        for inner in node.body:
            yield from _tests(inner, name)
    else:
        yield name


def parse_claims(data: bytes) -> Claims | None:
    """Parse JUnit XML; return None if it is too large, declares entities, or is not JUnit XML."""
    if len(data) > MAX_BYTES or b"<!" in data.replace(b"\0", b"").replace(b"<![CDATA[", b""):  # UTF-16 has null bytes
        return None
    try:
        root = ET.fromstring(data)
    except (ET.ParseError, ValueError, LookupError):
        return None
    verdicts: dict[str, ClaimedOutcome] = {}
    messages: dict[str, str] = {}
    for case in root.iter("testcase"):
        name = "::".join([*_module_and_classes(case.get("classname", "")), case.get("name", "")])
        verdict, message = _verdict(case)
        # A test whose clean-up fails is listed a second time, and the failure counts.
        if verdicts.get(name, ClaimedOutcome.PASSED) is ClaimedOutcome.PASSED:
            verdicts[name] = verdict
            messages[name] = message
    return Claims(verdicts, messages)


def _module_and_classes(classname: str) -> list[str]:
    """Return the parts of a dotted name from the test module on: the module and the classes."""
    parts = classname.split(".")
    modules = [index for index, part in enumerate(parts) if part.startswith("test_")]
    return parts[modules[-1] :] if modules else parts[-1:]


def _verdict(case: ET.Element) -> tuple[ClaimedOutcome, str]:
    for tag, verdict in (
        ("failure", ClaimedOutcome.FAILED),
        ("error", ClaimedOutcome.ERROR),
        ("skipped", ClaimedOutcome.SKIPPED),
    ):
        element = case.find(tag)
        if element is not None:
            lines = (element.get("message") or "").splitlines()
            return verdict, (lines[0] if lines else "")[:MAX_MESSAGE]
    return ClaimedOutcome.PASSED, ""
