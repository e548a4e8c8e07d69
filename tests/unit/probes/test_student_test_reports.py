"""Reports of test runs are read within bounds, even if a student's program wrote them."""

from __future__ import annotations

import pytest

from autograder.probes.student_test_reports import (
    MAX_BYTES,
    MAX_MESSAGE,
    MAX_NAME,
    MAX_SOURCE,
    MAX_SOURCES,
    ClaimedOutcome,
    Claims,
    Source,
    parse_claims,
)

REPORT = """<?xml version="1.0" encoding="utf-8"?><testsuites><testsuite name="pytest">
<testcase classname="test.test_limits" name="test_a[0.5]" />
<testcase classname="test.test_limits" name="test_b"><failure message="assert 1 == 2&#10;more">x</failure></testcase>
<testcase classname="test.test_limits" name="test_c"><error message="failed on setup">trace</error></testcase>
<testcase classname="test_limits" name="test_d"><skipped message="not today" /></testcase>
<testcase classname="test.test_limits" name="test_e" />
<testcase classname="test.test_limits" name="test_e"><error message="failed on teardown">trace</error></testcase>
</testsuite></testsuites>"""


def test_each_test_has_a_verdict_and_the_first_line_of_its_message() -> None:
    claims = parse_claims(REPORT.encode())
    assert claims is not None
    assert claims.verdicts == {
        "test_limits::test_a[0.5]": ClaimedOutcome.PASSED,
        "test_limits::test_b": ClaimedOutcome.FAILED,
        "test_limits::test_c": ClaimedOutcome.ERROR,
        "test_limits::test_d": ClaimedOutcome.SKIPPED,
        "test_limits::test_e": ClaimedOutcome.ERROR,
    }
    assert claims.messages["test_limits::test_b"] == "assert 1 == 2"
    assert claims.messages["test_limits::test_a[0.5]"] == ""


def test_a_test_in_a_class_belongs_to_its_module() -> None:
    claims = parse_claims(b'<testsuite><testcase classname="p.test.test_limits.Speed" name="test_a"/></testsuite>')
    assert claims == Claims({"test_limits::Speed::test_a": ClaimedOutcome.PASSED}, {"test_limits::Speed::test_a": ""})


def test_a_long_message_is_cut() -> None:
    text = f'<testsuite><testcase classname="t" name="a"><failure message="{"x" * 9999}"/></testcase></testsuite>'
    claims = parse_claims(text.encode())
    assert claims is not None
    assert len(claims.messages["t::a"]) == MAX_MESSAGE


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"1 passed",
        b"\xff\xfe<",
        b"<testsuite>" + b" " * MAX_BYTES + b"</testsuite>",
        b'<!DOCTYPE a [<!ENTITY b "c">]><testsuite>&b;</testsuite>',
        '<!DOCTYPE a [<!ENTITY b "c">]><testsuite>&b;</testsuite>'.encode("utf-16"),
        b'<?xml version="1.0" encoding="no-such-code"?><testsuite/>',
    ],
    ids=["empty", "text", "bytes", "large", "entities", "entities in UTF-16", "encoding"],
)
def test_bytes_that_are_not_a_valid_small_report_give_no_claims(data: bytes) -> None:
    assert parse_claims(data) is None


def names_in(**files: str) -> frozenset[str]:
    """Return the names of the tests in test files, by their names without the suffix."""
    source = Source("speed", {f"test/{name}.py": text.encode() for name, text in files.items()})
    return source.test_names(tuple(f"{name}.py" for name in files))


def test_the_names_of_tests_are_read_from_functions_and_classes() -> None:
    text = "def test_a(): pass\nclass TestB:\n class TestC:\n  async def test_d(self): pass\nnumber = 1"
    assert names_in(test_speed=text) == {"test_speed::test_a", "test_speed::TestB::TestC::test_d"}


def test_names_that_are_very_long_with_those_of_their_classes_are_left_out() -> None:
    long = "A" * MAX_NAME
    text = f"def test_{long}(): pass\nclass Test{long}:\n def test_b(self): pass\ndef test_c(): pass"
    assert names_in(test_speed=text) == {"test_speed::test_c"}


def test_only_some_bytes_of_all_test_files_are_read() -> None:
    count = MAX_SOURCES // MAX_SOURCE
    full = "def test_a(): pass\n".ljust(MAX_SOURCE, "#")
    names = names_in(test_huge=full + "#", **{f"test_{number}": full for number in range(count + 2)})
    assert names == {f"test_{number}::test_a" for number in range(count)}
