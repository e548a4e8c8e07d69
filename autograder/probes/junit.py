"""What a pytest run claims of itself in JUnit XML, read with bounds."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path

from autograder.probes.files import read_plain

MAX_BYTES = 1024 * 1024
MAX_MESSAGE = 300


class ClaimedOutcome(str, Enum):
    """What a run claims of one test."""

    PASSED = "passed"
    FAILED = "failed"
    ERROR = "error"
    SKIPPED = "skipped"


@dataclass(frozen=True)
class Claims:
    """What a run claims of its tests.

    Attributes:
        verdicts: by test, `module::name` or `module::Class::name`, in the order in which they ran.
        messages: the first line of what went wrong, by test.
    """

    verdicts: Mapping[str, ClaimedOutcome] = field(default_factory=dict)
    messages: Mapping[str, str] = field(default_factory=dict)


def read(path: Path) -> Claims | None:
    """Read a report that untrusted code may have written; None when it is no plain, small JUnit file."""
    data = read_plain(path, MAX_BYTES)
    return None if data is None else parse(data)


def parse(data: bytes) -> Claims | None:
    """Parse JUnit XML; None when it is too large, declares entities, or is not JUnit XML."""
    if len(data) > MAX_BYTES or b"<!" in data.replace(b"<![CDATA[", b""):
        return None
    try:
        root = ET.fromstring(data)
    except (ET.ParseError, ValueError, LookupError):
        return None
    verdicts: dict[str, ClaimedOutcome] = {}
    messages: dict[str, str] = {}
    for case in root.iter("testcase"):
        name = "::".join([*_place(case.get("classname", "")), case.get("name", "")])
        verdict, message = _verdict(case)
        # A test whose clean-up fails is there twice: the failure counts.
        if verdicts.get(name, ClaimedOutcome.PASSED) is ClaimedOutcome.PASSED:
            verdicts[name] = verdict
            messages[name] = message
    return Claims(verdicts, messages)


def _place(classname: str) -> list[str]:
    """Return the test module in a dotted name, and the classes after it."""
    parts = classname.split(".")
    modules = [index for index, part in enumerate(parts) if part.startswith("test_")]
    return parts[modules[-1] :] if modules else parts[-1:]


def _verdict(case: ET.Element) -> tuple[ClaimedOutcome, str]:
    for tag, verdict in (
        ("failure", ClaimedOutcome.FAILED),
        ("error", ClaimedOutcome.ERROR),
        ("skipped", ClaimedOutcome.SKIPPED),
    ):
        found = case.find(tag)
        if found is not None:
            lines = (found.get("message") or "").splitlines()
            return verdict, (lines[0] if lines else "")[:MAX_MESSAGE]
    return ClaimedOutcome.PASSED, ""
