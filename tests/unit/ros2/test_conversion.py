"""Messages to dictionaries, YAML and CSV, and back (the stand-in for rosidl_runtime_py)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import yaml
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovariance, Twist, TwistStamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterValue
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool

from autograder.ros.standins.rosidl_runtime_py import (
    get_interface_path,
    get_interfaces,
    get_message_interfaces,
    get_service_interfaces,
    message_to_csv,
    message_to_ordereddict,
    message_to_yaml,
    set_message_fields,
)
from autograder.ros.standins.rosidl_runtime_py.utilities import (
    get_interface,
    get_message,
    get_message_namespaced_type,
    get_service,
)


def test_yaml_keeps_the_order_of_the_fields() -> None:
    assert message_to_yaml(Twist()) == (
        "linear:\n  x: 0.0\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n"
    )
    assert message_to_yaml(Time(sec=1), flow_style=True) == "sec: 1\nnanosec: 0\n"


def test_long_values_are_cut_and_marked() -> None:
    scan = LaserScan(ranges=[1.0, 2.0, 3.0])
    assert message_to_ordereddict(scan, truncate_length=2)["ranges"] == [1.0, 2.0, "..."]
    assert message_to_ordereddict(String(data="abcdef"), truncate_length=3)["data"] == "abc..."
    assert message_to_csv(String(data="abcdef"), truncate_length=3) == "abc..."


def test_arrays_and_strings_can_be_summarised() -> None:
    values = message_to_ordereddict(LaserScan(ranges=[1.0]), no_arr=True)
    assert values["ranges"] == "<sequence type: float, length: 1>"
    assert message_to_ordereddict(PoseWithCovariance(), no_arr=True)["covariance"] == "<array type: double[36]>"
    array = message_to_ordereddict(DiagnosticArray(), no_arr=True)
    assert array["status"] == "<sequence type: diagnostic_msgs/msg/DiagnosticStatus, length: 0>"
    assert message_to_csv(String(data="abc"), no_str=True) == "<string length: <3>>"


def test_csv_flattens_nested_messages_and_arrays() -> None:
    stamped = TwistStamped()
    stamped.header.frame_id = "base"
    assert message_to_csv(stamped) == "0,0,base,0.0,0.0,0.0,0.0,0.0,0.0"
    assert message_to_csv(LaserScan(ranges=[1.0, 2.0])).endswith("0.0,1.0,2.0,")


def test_octets_and_numpy_arrays_become_plain_values() -> None:
    value = ParameterValue(byte_array_value=[b"\x01", b"a"])
    assert message_to_ordereddict(value)["byte_array_value"] == ["\x01", "a"]
    assert message_to_ordereddict(PoseWithCovariance())["covariance"] == [0.0] * 36


@settings(deadline=None)
@given(
    x=st.floats(allow_nan=False),
    ranges=st.lists(st.floats(width=32, allow_nan=False)),
    frame=st.text(st.characters(exclude_categories=["Cs", "Cc", "Zl", "Zp"])),
    sec=st.integers(-(2**31), 2**31 - 1),
)
def test_a_message_survives_conversion_to_yaml(x: float, ranges: list[float], frame: str, sec: int) -> None:
    scan = LaserScan(ranges=ranges)
    scan.header.frame_id, scan.header.stamp.sec = frame, sec
    twist = Twist()
    twist.linear.x = x
    for message in (scan, twist):
        converted = type(message)()
        set_message_fields(converted, yaml.safe_load(message_to_yaml(message)))
        assert converted == message


def test_fields_are_converted_to_their_type() -> None:
    twist, number, text = Twist(), Int32(), String()
    set_message_fields(twist, {"linear": {"x": 1}})
    set_message_fields(number, {"data": "7"})
    set_message_fields(text, {"data": 5})
    assert (twist.linear.x, number.data, text.data) == (1.0, 7, "5")
    pose = PoseWithCovariance()
    set_message_fields(pose, {"covariance": [2] * 36})
    assert pose.covariance.dtype == np.float64
    status = DiagnosticArray()
    set_message_fields(status, {"status": [{"name": "motor", "values": [{"key": "a", "value": "b"}]}]})
    assert status.status[0].values[0].key == "a"


@pytest.mark.parametrize(
    ("message", "values", "error", "text"),
    [
        (Twist(), {"linear": 3}, TypeError, "Value '3' is expected to be a dictionary but is a int"),
        (Twist(), "fast", TypeError, "Value 'fast' is expected to be a dictionary but is a str"),
        (Twist(), {"speed": 1.0}, AttributeError, "'Twist' object has no attribute 'speed'"),
        (String(), {"_check_fields": True}, AttributeError, "no field '_check_fields'"),
        (Int32(), {"data": "many"}, ValueError, "invalid literal for int"),
    ],
)
def test_values_that_do_not_fit_a_message_are_an_error(
    message: Any, values: Any, error: type[Exception], text: str
) -> None:
    with pytest.raises(error, match=text):
        set_message_fields(message, values)


def test_auto_and_now_give_setters_for_stamps() -> None:
    message = TwistStamped()
    stamps = set_message_fields(message, {"header": "auto"}, expand_header_auto=True)
    stamps += set_message_fields(message, {"header": {"stamp": "now"}}, expand_time_now=True)
    assert len(stamps) == 2
    for number, stamp in enumerate(stamps, start=1):
        stamp(Time(sec=number))
        assert message.header.stamp.sec == number
    with pytest.raises(TypeError, match="'auto' is expected to be a dictionary"):
        set_message_fields(message, {"header": "auto"})


def test_interfaces_are_found_by_the_index() -> None:
    assert get_interfaces(["std_srvs"]) == {"std_srvs": ["srv/Empty", "srv/SetBool", "srv/Trigger"]}
    assert "msg/String" in get_message_interfaces()["std_msgs"]
    assert set(get_service_interfaces(["std_srvs"])) == {"std_srvs"}
    assert get_message_interfaces(["std_srvs"]) == {}
    with pytest.raises(LookupError, match="Unknown package 'nothing'"):
        get_interfaces(["nothing"])
    with pytest.raises(LookupError, match="Package 'rclpy' has no interfaces"):
        get_interfaces(["rclpy"])


@pytest.mark.parametrize("name", ["std_msgs/msg/String", "std_msgs/String", "std_msgs/msg/String.msg"])
def test_an_interface_has_a_path(name: str) -> None:
    assert get_interface_path(name).endswith("/share/std_msgs/msg/String.msg")


@pytest.mark.parametrize(
    ("name", "error", "text"),
    [
        ("String", ValueError, "Expected three parts"),
        ("std_msgs//String", ValueError, "empty parts"),
        ("std_msgs/../String", ValueError, "Must not contain '..'"),
        ("nothing/msg/String", LookupError, "Unknown package 'nothing'"),
        ("std_msgs/msg/Nothing", LookupError, "Could not find the interface '.*std_msgs/msg/Nothing.idl'"),
    ],
)
def test_a_wrong_name_of_an_interface_is_an_error(name: str, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        get_interface_path(name)


def test_the_name_of_an_interface_gives_its_class() -> None:
    assert get_message("std_msgs/msg/String") is get_message("std_msgs/String") is String
    assert get_service("std_srvs/srv/SetBool") is get_interface("std_srvs/srv/SetBool") is SetBool
    assert get_message_namespaced_type("std_msgs/String").namespaced_name() == ("std_msgs", "msg", "String")
    for wrong, error in (
        ("String", ValueError),
        ("std_msgs/srv/String", ValueError),
        ("std_msgs/msg/No", AttributeError),
    ):
        with pytest.raises(error):
            get_message(wrong)
    with pytest.raises(ModuleNotFoundError):
        get_service("nothing/srv/Nothing")
