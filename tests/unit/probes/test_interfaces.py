"""Definitions are compared with a contract: each difference is reported once, and near misses are recognised."""

from __future__ import annotations

import pytest

from autograder.probes.interfaces import (
    MAX_BYTES,
    Aspect,
    Constant,
    Field,
    Interface,
    Part,
    Unreadable,
    closest,
    compare,
    parse,
    share,
)

PATH = "srv/Fetch.srv"
REQUEST = "float64 MOST = 5.0\nfloat64[<=8] legs\nint32 reserve 20\n"
RESPONSE = "bool possible\nstring<=80 reason\n"
TEXT = f"{REQUEST}---\n{RESPONSE}"
EXPECTED = Interface(
    PATH,
    (
        Part((Field("float64[<=8]", "legs"), Field("int32", "reserve", 20)), (Constant("float64", "MOST", 5.0),)),
        Part((Field("bool", "possible"), Field("string<=80", "reason"))),
    ),
)


def differences_of(text: str) -> list[tuple[Aspect, str]]:
    """Return the differences between a text and the contract."""
    return [(difference.aspect, difference.sentence) for difference in compare(EXPECTED, parse("pkg", PATH, text))]


def test_a_text_is_read_with_types_defaults_bounds_and_constants() -> None:
    assert parse("pkg", PATH, TEXT) == EXPECTED


def test_types_of_the_same_package_and_string_defaults_are_read_verbatim() -> None:
    part = parse("pkg", "msg/M.msg", 'Other other\nstd_msgs/Header header\nstring word "go"\nint8[3] three\n').parts[0]
    assert [field.type for field in part.fields] == ["Other", "std_msgs/Header", "string", "int8[3]"]
    assert part.fields[2].default == "go"


def test_an_action_has_three_parts() -> None:
    action = parse("pkg", "action/A.action", "int8 a\n---\nint8 b\n---\nint8 c\n")
    assert [part.fields[0].name for part in action.parts] == ["a", "b", "c"]


def test_comments_more_constants_and_empty_defaults_do_not_count_as_differences() -> None:
    assert differences_of(f"# hello\nint8 OWN = 1\n{REQUEST}---\nbool possible false\nstring<=80 reason  # why\n") == []


@pytest.mark.parametrize(
    ("old", "new", "aspect", "sentence"),
    [
        ("legs", "leg", Aspect.FIELDS, "request: a field is called leg, but it should be legs."),
        ("float64[<=8] legs\n", "", Aspect.FIELDS, "request: the field legs is missing."),
        ("bool possible", "bool possible\nint8 x", Aspect.FIELDS, "response: the contract has no field x."),
        ("int32 reserve", "int64 reserve", Aspect.TYPES, "request: reserve is int64, but it should be int32."),
        ("float64[<=8]", "float64", Aspect.TYPES, "request: legs is float64, but it should be float64[<=8]."),
        ("float64[<=8]", "float64[8]", Aspect.TYPES, "request: legs is float64[8], but it should be float64[<=8]."),
        ("float64[<=8]", "float64[]", Aspect.BOUNDS, "request: legs is float64[], but it should be float64[<=8]."),
        ("string<=80", "string", Aspect.BOUNDS, "response: reason is string, but it should be string<=80."),
        ("reserve 20", "reserve", Aspect.DEFAULTS, "request: reserve has no default, but it should be 20."),
        ("reserve 20", "reserve 2", Aspect.DEFAULTS, "request: reserve has the default 2, but it should be 20."),
        (
            "possible",
            "possible true",
            Aspect.DEFAULTS,
            "response: possible has the default True, but it should be none.",
        ),
        ("float64 MOST = 5.0\n", "", Aspect.CONSTANTS, "request: the constant MOST is missing."),
        (
            "MOST = 5.0",
            "MOST = 0.5",
            Aspect.CONSTANTS,
            "request: the constant MOST is float64 0.5, but it should be float64 5.0.",
        ),
        ("MOST", "MOSTLY", Aspect.CONSTANTS, "request: a constant is called MOSTLY, but it should be MOST."),
        (
            "float64 MOST = 5.0",
            "float64 most 5.0",
            Aspect.CONSTANTS,
            "request: most is a field; a constant is written float64 MOST = VALUE.",
        ),
    ],
)
def test_each_difference_of_a_definition_is_reported_in_one_sentence(
    old: str, new: str, aspect: Aspect, sentence: str
) -> None:
    assert differences_of(TEXT.replace(old, new)) == [(aspect, f"{PATH}, {sentence}")]


def test_a_different_order_of_fields_is_named_once() -> None:
    text = f"{REQUEST}---\nstring<=80 reason\nbool possible\n"
    order = f"{PATH}, response: the order of the fields is reason, possible, but it should be possible, reason."
    assert differences_of(text) == [(Aspect.FIELDS, order)]


def test_a_field_or_constant_in_the_wrong_part_is_named_once() -> None:
    field = f"{REQUEST}bool possible\n---\nstring<=80 reason\n"
    assert differences_of(field) == [
        (Aspect.FIELDS, f"{PATH}, response: possible is in the request, but it belongs here.")
    ]
    constant = "float64[<=8] legs\nint32 reserve 20\n---\nfloat64 MOST = 5.0\n" + RESPONSE
    sentence = f"{PATH}, request: the constant MOST is in the response, but it belongs here."
    assert differences_of(constant) == [(Aspect.CONSTANTS, sentence)]


def test_the_correct_share_counts_fields_and_constants() -> None:
    assert share(EXPECTED, ()) == 1.0
    wrong = compare(EXPECTED, parse("pkg", PATH, TEXT.replace("legs", "leg")))
    assert share(EXPECTED, wrong) == pytest.approx(0.8)
    assert share(EXPECTED, wrong * 9) == 0.0


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (REQUEST, "one line --- separates the request from the response"),
        (f"float legs\n---\n{RESPONSE}", "'float' is an invalid message name"),
        (f"float64 Legs\n---\n{RESPONSE}", "'Legs' is an invalid field name"),
        (f"legs\n---\n{RESPONSE}", "a field is written `type name`"),
        (f"{REQUEST}int32 reserve\n---\n{RESPONSE}", "duplicate names: reserve"),
        (f"int32 X = 1.5\n---\n{RESPONSE}", "can not be converted to type 'int32'"),
        ("#" * (MAX_BYTES + 1), "far larger than a definition"),
    ],
)
def test_a_definition_that_the_build_would_reject_is_rejected_with_the_reason(text: str, reason: str) -> None:
    with pytest.raises(Unreadable) as excinfo:
        parse("pkg", PATH, text)
    assert PATH in str(excinfo.value)
    assert reason in str(excinfo.value)


def test_an_action_without_its_parts_is_refused() -> None:
    with pytest.raises(Unreadable, match="two lines --- separate goal, result and feedback"):
        parse("pkg", "action/A.action", "int8 a\n---\n")


def test_a_file_with_a_similar_name_is_found_instead_of_a_missing_one() -> None:
    assert closest(PATH, ["srv/fetch.srv", "msg/Other.msg"]) == "srv/fetch.srv"
    assert closest(PATH, ["msg/Other.msg"]) == ""
