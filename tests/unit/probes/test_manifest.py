"""package.xml is read as ROS reads it, and refused with a reason if ROS rejects it."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.course_paths import SOLUTIONS
from autograder.probes import manifest
from autograder.submission.exercise_stubs import CODE_STUB
from autograder.submission.packages import MAX_MANIFEST
from autograder.suite import CheckFailed

TEXT = """<package format="3">
  <name>lamp</name>
  <version>0.1.0</version>
  <description>A lamp</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <build_depend>eigen</build_depend>
  <depend>rclpy</depend>
  <exec_depend>launch</exec_depend>
  <test_depend>python3-pytest</test_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_python</build_type></export>
</package>
"""


def test_a_manifest_is_read_with_name_and_dependencies() -> None:
    parsed = manifest.parse(TEXT)
    assert (parsed.name, parsed.version, parsed.description, parsed.format) == ("lamp", "0.1.0", "A lamp", 3)
    assert parsed.licences == ("MIT", "Apache-2.0")
    assert parsed.maintainers == (("A", "a@example.com"),)
    assert parsed.build_type == "ament_python"
    assert parsed.groups == {"rosidl_interface_packages"}


def test_a_plain_depend_is_for_the_build_and_for_the_run() -> None:
    parsed = manifest.parse(TEXT)
    assert parsed.needs("exec") == {"rclpy", "launch"}
    assert parsed.needs("build") == {"rclpy", "eigen"}
    assert parsed.needs("test") == {"python3-pytest"}
    assert parsed.needs("exec", "test") == {"rclpy", "launch", "python3-pytest"}
    assert parsed.needs() == {"rclpy", "launch", "python3-pytest", "eigen", "ament_cmake"}


def test_a_dependency_counts_if_its_condition_holds_in_ros_2() -> None:
    text = TEXT.replace("<exec_depend>launch", '<exec_depend condition="$ROS_VERSION == {}">launch')
    assert manifest.parse(text.format(2)).needs("exec") == {"rclpy", "launch"}
    assert manifest.parse(text.format(1)).needs("exec") == {"rclpy"}


def test_a_build_type_and_a_group_count_if_their_conditions_hold_in_ros_2() -> None:
    own_type = "<build_type>ament_python</build_type>"
    other = '<build_type condition="$ROS_VERSION == 1">catkin</build_type>'
    assert manifest.parse(TEXT.replace(own_type, other + own_type)).build_type == "ament_python"
    member = '<member_of_group condition="$ROS_VERSION == {}">lamps</member_of_group>'
    text = TEXT.replace("<export>", f"{member}<export>")
    assert "lamps" in manifest.parse(text.format(2)).groups
    assert "lamps" not in manifest.parse(text.format(1)).groups


def test_a_manifest_without_a_build_type_has_an_empty_one() -> None:
    assert manifest.parse(TEXT.replace("<build_type>ament_python</build_type>", "")).build_type == ""


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("a@example.com", "a@b", 'Invalid email "a@b"'),
        ("<name>lamp</name>", "", 'exactly one "name" tag'),
        ("<name>lamp</name>", "<name>La mp</name>", "does not follow naming conventions"),
        ("<version>0.1.0</version>", "<version>one</version>", "version conventions"),
        ("<depend>", '<depend condition="$ROS_VERSION =">', "A condition in lamp/package.xml cannot be read"),
        ("</description>", "", "not well-formed|mismatched|invalid XML"),
        (TEXT, "", "invalid XML|no element"),
        ("<name>lamp</name>", CODE_STUB, "^lamp/package.xml is still to be written"),
        ('<package format="3">', '<!DOCTYPE a [<!ENTITY b "c">]><package format="3">', "which no manifest needs"),
    ],
)
def test_a_manifest_that_ros_refuses_is_refused_with_the_reason(before: str, after: str, message: str) -> None:
    with pytest.raises(CheckFailed, match=message):
        manifest.parse(TEXT.replace(before, after), "lamp/package.xml")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (None, "lamp has no package.xml"),
        (b"<package>" + b" " * MAX_MANIFEST, "far larger than a manifest"),
        (b"\xff\xfe<package/>", "not UTF-8"),
    ],
)
def test_a_file_that_is_not_a_manifest_is_named(tmp_path: Path, data: bytes | None, message: str) -> None:
    folder = tmp_path / "lamp"
    folder.mkdir()
    if data is not None:
        (folder / "package.xml").write_bytes(data)
    with pytest.raises(CheckFailed, match=message):
        manifest.read(folder)


def test_a_link_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "package.xml").symlink_to(SOLUTIONS / "square_dance" / "package.xml")
    with pytest.raises(CheckFailed, match=r"has no package\.xml"):
        manifest.read(tmp_path)


REFUSED = """<package format="3">
  <name>dance</name><version>1.0.0</version><description>Two
    lines</description>
  <maintainer email="not an address">Ada</maintainer>
  <license>Apache-2.0</license>
  <depend>rclpy</depend><exec_depend>launch</exec_depend><test_depend>python3-pytest</test_depend>
  <export><build_type>ament_python</build_type></export>
</package>"""


def test_a_manifest_is_read_even_if_ros_rejects_it(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(REFUSED)
    with pytest.raises(CheckFailed, match="ROS refuses"):
        manifest.read(tmp_path)
    parsed = manifest.read_leniently(tmp_path)
    assert (parsed.name, parsed.format, parsed.build_type) == ("dance", 3, "ament_python")
    assert (parsed.description, parsed.licences) == ("Two lines", ("Apache-2.0",))
    assert parsed.needs("exec") == {"rclpy", "launch"}
    assert parsed.needs("test") == {"python3-pytest"}


def test_a_manifest_that_ros_accepts_is_read_alike_leniently_and_strictly(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(REFUSED.replace("not an address", "ada@example.com"))
    assert manifest.read_leniently(tmp_path) == manifest.read(tmp_path)


@pytest.mark.parametrize(
    ("text", "message"),
    [("<package", "not well-formed XML"), (f"<!DOCTYPE p>{REFUSED}", "DOCTYPE"), (CODE_STUB, "still to be written")],
)
def test_a_file_that_is_not_a_manifest_is_also_rejected_leniently(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "package.xml").write_text(text)
    with pytest.raises(CheckFailed, match=message):
        manifest.read_leniently(tmp_path)
