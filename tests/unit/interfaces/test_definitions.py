"""Interface definitions are read, and each error in them is reported."""

from __future__ import annotations

import contextlib
import re
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.building.interfaces import rosidl
from autograder.building.interfaces.definition_reader import MAX_BYTES, MAX_FILES, read
from autograder.building.interfaces.definitions import DefinitionError, packages_used, require_uses
from autograder.probes import interfaces


def test_comments_of_a_definition_are_removed_and_its_uses_are_listed() -> None:
    (definition,) = read(
        "my_msgs", {"msg/A.msg": "# */ evil\n\nstd_msgs/Header header  # \\\nint32 X=3\r\nint32[] y\n"}
    )
    assert definition.text == "int32 X=3\nstd_msgs/Header header\nint32[] y\n"
    assert definition.uses == (("std_msgs", "Header", "std_msgs/Header header"),)


def test_the_text_is_normalised_without_changing_its_meaning() -> None:
    lines = {
        "int32   X  =  0x10": "int32 X=16",
        "bool ON=1": "bool ON=true",
        "string S='it is'": 'string S="it is"',
        """string Q=say "it's" twice""": """string Q=say "it's" twice""",
        "string TRIGRAPH='??/\"; x //'": """string TRIGRAPH='??/"; x //'""",
        "float64[<=3]   y   [1, 2.50]": "float64[<=3] y [1.0, 2.5]",
        "string<=4[2] words ['a', \"b'\"]": """string<=4[2] words ["a", "b'"]""",
        "int8  z  -0": "int8 z 0",
    }
    (definition,) = read("my_msgs", {"msg/A.msg": "\n".join(lines)})
    assert definition.text.splitlines() == list(lines.values())
    assert read("my_msgs", {"msg/A.msg": definition.text}) == (definition,)


def test_services_and_actions_use_the_packages_of_their_generated_messages() -> None:
    definitions = read("my_msgs", {"action/Go.action": "A x\n---\n---\n", "msg/A.msg": "bool b\n"})
    assert set(packages_used(definitions)) == {
        *("service_msgs", "builtin_interfaces", "action_msgs", "unique_identifier_msgs")
    }


WRONG = {
    "no name": ("msg/A.msg", "int32\n", "int32", "a field is written"),
    "a name in capitals": ("msg/A.msg", "bool ok\nint32 Speed\n", "int32 Speed", "invalid field name"),
    "a constant out of range": ("msg/A.msg", "uint8 MAX=256\n", "uint8 MAX=256", "<= 255"),
    "a duplicate name": ("msg/A.msg", "int32 a\nbool a\n", "bool a", "a occurs twice"),
    "a word of Python": ("msg/A.msg", "int32 lambda\n", "int32 lambda", "reserved word of C or Python"),
    "a word of C": ("msg/A.msg", "int32 default\n", "int32 default", "reserved word of C or Python"),
    "ROS 1's time": ("msg/A.msg", "time stamp\n", "time stamp", "builtin_interfaces/Time"),
    "a missing message": ("msg/A.msg", "B b\n", "B b", "no msg/B.msg in my_msgs"),
    "a message in itself": ("msg/A.msg", "A a\n", "", "contains itself"),
    "a gigantic array": ("msg/A.msg", "int8[2000000000] a\n", "int8[2000000000] a", "unbounded array"),
    "a value that is not a number": ("msg/A.msg", "float64 X=nan\n", "float64 X=nan", "finite"),
    "a backslash": ("msg/A.msg", 'string X="\\n"\n', 'string X="\\n"', "backslash"),
    "letters beyond ASCII": ("msg/A.msg", "string X=“a”\n", "'string X=", "ASCII"),
    "a hidden line": ("msg/A.msg", "int32 a\x0bint32 b\n", "'int32 a", "ASCII"),
    "an indented line": ("msg/A.msg", "  int32 a\n", "  int32 a", "space"),
    "a service without a response": ("srv/A.srv", "int32 a\n", "", "0 separator lines ---, but 1 are needed"),
    "an action with one separator": ("action/A.action", "int32 a\n---\n", "", "goal --- result --- feedback"),
    "a comment at a separator": ("srv/A.srv", "int32 a\n--- # then\n", "--- # then", "must be alone"),
    "a path that leads out": ("msg/../../A.msg", "int32 a\n", "", "msg/Name.msg"),
    "a name in small letters": ("msg/status.msg", "int32 a\n", "", "CamelCase"),
    "a file in the wrong folder": ("msg/A.srv", "---\n", "", "msg/Name.msg"),
    "a huge file": ("msg/A.msg", "#" * (MAX_BYTES + 1), "", "64 KiB"),
}


@pytest.mark.parametrize(("path", "text", "line", "problem"), WRONG.values(), ids=WRONG.keys())
def test_a_mistake_is_named_with_its_file_and_line(path: str, text: str, line: str, problem: str) -> None:
    with pytest.raises(DefinitionError) as excinfo:
        read("my_msgs", {path: text})
    assert excinfo.value.file == path
    assert excinfo.value.line.startswith(line)
    assert bool(excinfo.value.line) == bool(line)
    assert problem in str(excinfo.value)


def test_arrays_are_counted_through_nested_messages() -> None:
    with pytest.raises(DefinitionError, match="100000 elements"):
        read("my_msgs", {"msg/A.msg": "int8[1000] a\n", "msg/B.msg": "A[1000] a\n"})


@pytest.mark.parametrize("name", ["", "../x", "My_msgs", "a__b", "a_", "class", "a/b", "a" * 200])
def test_a_package_name_that_ros_would_not_accept_is_refused(name: str) -> None:
    with pytest.raises(DefinitionError, match="not a package name"):
        read(name, {"msg/A.msg": "int32 a\n"})


def test_too_many_definitions_none_and_two_that_differ_in_capitals_are_refused() -> None:
    with pytest.raises(DefinitionError, match="at most"):
        read("my_msgs", {f"msg/A{i}.msg": "int32 a\n" for i in range(MAX_FILES + 1)})
    with pytest.raises(DefinitionError, match=r"no \.msg"):
        read("my_msgs", {})
    with pytest.raises(DefinitionError, match="capital letters"):
        read("my_msgs", {"msg/Ab.msg": "int32 a\n", "msg/AB.msg": "int32 a\n"})


def test_a_message_of_another_package_must_exist() -> None:
    definitions = read("my_msgs", {"msg/A.msg": "std_msgs/Headr header\n"})
    with pytest.raises(DefinitionError, match="std_msgs has no message Headr"):
        require_uses(definitions, lambda package, message: message is None)
    with pytest.raises(DefinitionError, match="no package std_msgs"):
        require_uses(definitions, lambda package, message: False)


WORDS = [
    "int32",
    "string",
    "string<=4",
    "float64[<=3]",
    "bool[2]",
    "A",
    "std_msgs/Header",
    "a",
    "b_c",
    "X",
    "=",
    "=1",
    '"t"',
    "[1, 2]",
]
LINE = st.lists(st.sampled_from([*WORDS, "---", "#", "\\"]) | st.text(max_size=4), max_size=4).map(" ".join)


@pytest.mark.fuzz
@given(st.sampled_from(["msg/A.msg", "srv/A.srv", "action/A.action"]), st.lists(LINE, max_size=6).map("\n".join))
def test_any_text_is_a_definition_or_refused(path: str, text: str) -> None:
    with contextlib.suppress(DefinitionError):
        (definition,) = read("my_msgs", {path: text})
        (reread,) = read("my_msgs", {path: definition.text})
        assert reread.sections == definition.sections


LONG = {
    "a constant's name": f"int32 {'A' * 30_000}!=3",
    "a constant's name with an underscore at its end": f"int32 {'A_' * 30_000}=3",
    "brackets in a comment": f"int32 a #{'[' * 60_000}",
    "quotation marks": f"string[] a [{chr(39) * 60_000}",
    "texts": f"string[] a [{'x,' * 10_000}]",
    "spaces": f"int32{' ' * 60_000}a",
}


@pytest.mark.parametrize("line", LONG.values(), ids=LONG)
def test_a_long_line_is_read_in_a_moment(line: str) -> None:
    started_at = time.process_time()
    for parse in (lambda: read("my_msgs", {"msg/A.msg": line}), lambda: interfaces.parse("my_msgs", "msg/A.msg", line)):
        with contextlib.suppress(DefinitionError, interfaces.Unreadable):
            parse()
    assert time.process_time() - started_at < 5.0


@pytest.mark.parametrize("name", ["A", "AB", "A_B", "A1_2", "A_", "A__B", "aB", "_A", "Ab", "", "A_B_"])
def test_rosidl_accepts_the_same_names_of_constants(name: str) -> None:
    assert bool(rosidl.CONSTANT_NAME.match(name)) == bool(re.match("^[A-Z]([A-Z0-9_]?[A-Z0-9]+)*$", name))
