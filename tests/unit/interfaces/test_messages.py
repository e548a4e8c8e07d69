"""Classes of plain messages: their fields, the values that they refuse, and how untrusted bytes are read."""

from __future__ import annotations

import contextlib
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.building.interfaces import type_support
from autograder.building.interfaces.cdr import MAX_BYTES, MAX_OBJECTS
from autograder.building.interfaces.loading import classes
from autograder.building.interfaces.messages import from_bytes, to_bytes
from autograder.exceptions import GraderError, StudentError
from autograder.harness.message_text import format_message

TEXTS = {
    "msg/Inner.msg": "uint8 OK=0\nstring WHO='me'\nbool flag true\nfloat32[2] pair [1, 2]\nstring<=3 word\n",
    "msg/Outer.msg": "std_msgs/Header header\nInner[] many\nfloat64[<=2] few\nEmpty nothing\n",
    "msg/Empty.msg": "",
    "srv/Ask.srv": "int64 question 42\n---\nbool answer\n",
    "action/Go.action": "float64 distance\n---\nfloat64 driven\n---\nfloat64 left\n",
}


def package(texts: dict[str, str] = TEXTS) -> Any:
    return classes((("plain_msgs", tuple(texts.items())),))


def test_a_message_has_its_defaults_and_constants() -> None:
    inner, outer = package().msg.Inner, package().msg.Outer()
    assert (inner.OK, inner.WHO, inner().flag, list(inner().pair), inner().word) == (0, "me", True, [1.0, 2.0], "")
    assert outer.header.stamp.sec == 0
    assert (outer.many, list(outer.few)) == ([], [])
    assert inner().pair is not inner().pair
    assert package().srv.Ask.Request().question == 42
    assert package().action.Go.Goal(distance=2.0).distance == 2.0


def test_the_types_of_fields_have_the_names_of_rosidl() -> None:
    assert package().msg.Outer.get_fields_and_field_types() == {
        "header": "std_msgs/Header",
        "many": "sequence<plain_msgs/Inner>",
        "few": "sequence<double, 2>",
        "nothing": "plain_msgs/Empty",
    }


def test_the_same_texts_give_the_same_classes_and_others_do_not_interfere() -> None:
    changed = package({**TEXTS, "msg/Inner.msg": "int8 flag\n"})
    assert package().msg.Inner is package().msg.Inner
    assert changed.msg.Inner is not package().msg.Inner
    assert changed.msg.Inner(flag=3) != package().msg.Inner()


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: package().msg.Inner(speed=1.0), "Inner has no field speed"),
        (lambda: package().msg.Inner().speed, "Inner has no field speed"),
        (lambda: package().srv.Ask.Request(question=0.5), "Ask_Request.question is of the type int64, and cannot be"),
        (lambda: package().msg.Inner(word="four"), "Inner.word is of the type string<3>"),
        (lambda: package().msg.Outer(few=[1.0] * 3), "Outer.few is of the type sequence<double, 2>"),
        (lambda: package().msg.Statsu, "plain_msgs/msg has no Statsu"),
    ],
)
def test_a_missing_part_of_a_definition_is_the_students_error(make: Any, sentence: str) -> None:
    with pytest.raises(StudentError) as excinfo:
        make()
    assert sentence in excinfo.value.diagnosis.sentence
    assert not hasattr(package().msg.Inner(), "header")


def test_bytes_that_do_not_fit_the_type_are_refused() -> None:
    kinds = package().msg
    valid = to_bytes(kinds.Outer(many=[kinds.Inner(word="abc")] * 3, few=[0.5]))
    assert from_bytes(kinds.Outer, valid).many[2].word == "abc"
    for invalid in (valid[:-1], b"", struct.pack("<iI", 0, 0) + b"\xff" * 4, bytes(MAX_BYTES + 1)):
        with pytest.raises(ValueError, match=r"too early|KiB"):
            from_bytes(kinds.Outer, invalid)
    unbounded = package({**TEXTS, "msg/Outer.msg": TEXTS["msg/Outer.msg"].replace("<=2", "")}).msg.Outer
    with pytest.raises(ValueError, match="too long"):
        from_bytes(kinds.Outer, to_bytes(unbounded(few=[1.0] * 3)))


def test_a_message_of_many_messages_is_refused_before_they_are_made() -> None:
    kind = package({"msg/Empty.msg": "", "msg/Crowd.msg": "Empty[] all\n"}).msg.Crowd
    assert len(from_bytes(kind, struct.pack("<I", MAX_OBJECTS - 2) + bytes(MAX_OBJECTS)).all) == MAX_OBJECTS - 2
    with pytest.raises(ValueError, match="strings and messages"):
        from_bytes(kind, struct.pack("<I", 200_000) + bytes(200_000))


def test_a_fast_cdr_of_another_layout_is_an_error_of_the_grader(monkeypatch: pytest.MonkeyPatch) -> None:
    type_support.require_known_layout()
    type_support.require_known_layout.cache_clear()
    monkeypatch.setattr(type_support, "POSITIONS_OFFSET", type_support.POSITIONS_OFFSET + 8)
    with pytest.raises(GraderError, match="Fast CDR"):
        type(package().msg.Inner).__import_type_support__()


@given(st.sampled_from(["Inner", "Outer", "Empty"]), st.binary(max_size=200))
def test_any_bytes_are_a_message_or_refused(name: str, data: bytes) -> None:
    kind = getattr(package().msg, name)
    with contextlib.suppress(ValueError):
        message = from_bytes(kind, data)
        assert from_bytes(kind, to_bytes(message)) is not message


def test_a_field_may_have_the_name_of_a_method() -> None:
    kind = package({"msg/Odd.msg": "int8 get_fields_and_field_types 3\nint8 to_bytes\n"}).msg.Odd
    assert from_bytes(kind, to_bytes(kind(to_bytes=2))).to_bytes == 2
    assert format_message(kind()) == "get_fields_and_field_types: 3, to_bytes: 0"
