"""Valid samples of each kind of data that a student's files and programs contain."""

from __future__ import annotations

from typing import Any

MANIFEST = b"""<?xml version="1.0" encoding="utf-8"?>
<package format="3">
  <name>wheels</name><version>1.0.0</version><description>Wheels.</description>
  <maintainer email="a@example.edu">Ann</maintainer><license>Apache-2.0</license>
  <depend condition="$ROS_VERSION == 2">rclpy</depend><test_depend>python3-pytest</test_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_python</build_type></export>
</package>
"""
PARAMETERS = (
    b"/**:\n  ros__parameters:\n    speed: 0.5\nscout:\n  ros__parameters: {count: 3, name: 'a', at: 2026-01-31}\n",
    b"scout: &s\n  ros__parameters: {speed: 1e3, on: yes, list: [1, 2.5], raw: !!binary aGk=}\nother: *s\n",
)
CALLS: tuple[Any, ...] = (
    {"outcomes": [{"printed": "", "value": 1.0, "arguments": [1.0]}, {"printed": "x", "type": "Liar"}]},
    {"outcomes": [{"raised": "ValueError", "message": "no", "traceback": "T"}, {"value": [1, {"a": None}]}]},
    {"failed": {"raised": "ModuleNotFoundError", "message": "No module named 'wheels.limits'", "traceback": "T"}},
)
EVENTS: tuple[dict[str, Any], ...] = (
    {"event": "ready"},
    {
        "event": "done",
        "sent": [{"/cmd_vel T": 3}],
        "lost": ["/scan T"],
        "changed": True,
        "wake": 5,
        "due": 7,
        "notes": ["thread"],
    },
    {"event": "unsteppable", "reason": "sleep"},
    {"event": "deadlock", "what": "wait()", "name": "/add", "reason": "group"},
    {"event": "crash", "phase": "spin", "type": "E", "message": "m", "traceback": "t"},
    {
        **{
            "event": "description",
            "nodes": ["/n"],
            "timers": [10**8],
            "prefix": "0a1b",
            "early": {"/a": 1},
            "kept": {},
        },
        **{"writers": [["/said T", 1]], "readers": [[["/scan T reliable volatile"], 1], [["/odom T"], None]]},
        **{"servers": ["/add S request"], "clients": [["/ask S request", True]]},
    },
)
JUNIT = b"""<?xml version="1.0" encoding="utf-8"?>
<testsuites><testsuite name="pytest" errors="0" failures="1" tests="2" time="0.1">
<testcase classname="test.test_limits" name="test_a[1.0]" time="0.01" />
<testcase classname="test.test_limits.TestB" name="test_b" time="1e3"><failure message="assert 1 == 2">def</failure>
</testcase></testsuite></testsuites>
"""
SHOWN_ARGUMENTS = """Arguments (pass arguments as '<name>:=<value>'):

    'mode':
        What to do. Valid choices are: ['drive', 'park']
        (default: 'drive')

    'rest':
        no description given
"""
LAUNCH_OUTPUT = """[INFO] [reporter-2]: process started with pid [9]
[INFO] [self_test-1]: process has finished cleanly [pid 8]
[driver-3] Traceback (most recent call last):
[driver-3]   File "/w/ws/src/pkg/driver.py", line 7, in main
[driver-3] rclpy.exceptions.InvalidParameterTypeException: Trying to set 'speed'
[ERROR] [driver-3]: process has died [pid 12, exit code 1, cmd '/w/lib/p/driver --ros-args -r __node:=driver'].
[ERROR] [launch]: Caught exception in launch (see debug for traceback): Caught multiple exceptions when trying to load
 - InvalidFrontend: no
"""
TRACEBACK = """Starting >>> pkg
Traceback (most recent call last):
  File "/w/install/pkg/lib/python3.12/site-packages/pkg/node.py", line 7, in main
    rclpy.spin(node)
  File "/usr/lib/rclpy/executors.py", line 300, in spin
    raise ExternalShutdownException()
  [Previous line repeated 3 more times]
SyntaxError: invalid syntax (node.py, line 7)
"""
PYTHON = b"""# -*- coding: utf-8 -*-
import numpy as np, yaml
from .near import x
from PIL import Image
def f(a, /, *b, c=1_000, **d) -> 'int':
    return f"{a!r:>{10}} \\d" + b"x" if (y := 1) else [z async for z in b]
"""
METADATA = b"""[console_scripts]
driver = wheels.driver:main

[other]
a : b
"""
DEFINITION = {
    "msg": b"""# A status
std_msgs/Header header
uint8 LOW=3
string<=8 name "a b"
float64[<=3] x [1.0, 2.0]
int32[3] y
""",
    "action": b"float64 distance\nstring NAME='x'\n---\nbool done true\n---\nfloat32[] left\n",
}
NOTEBOOK: dict[str, Any] = {
    "nbformat": 4,
    "nbformat_minor": 5,
    "metadata": {"kernelspec": {"name": "python3", "display_name": "Python 3"}},
    "cells": [
        {
            **{"cell_type": "code", "id": "a1", "source": "%%writefile ws/src/a.py\nx = 1", "outputs": []},
            **{"execution_count": 3, "metadata": {"nbgrader": {"grade_id": "a", "solution": True, "locked": False}}},
        },
        {"cell_type": "markdown", "id": "b2", "source": ["# T", "x"], "metadata": {"nbgrader": {"grade_id": "b"}}},
        {
            **{"cell_type": "code", "id": "c3", "source": "1", "metadata": {}, "execution_count": None},
            "outputs": [{"output_type": "stream", "name": "stdout", "text": "1"}],
        },
    ],
}
OUTPUTS: tuple[dict[str, Any], ...] = (
    {"event": "begin"},
    {
        **{"event": "cell", "index": 1, "execution_count": 3},
        "outputs": [
            {"output_type": "stream", "name": "stdout", "text": "1"},
            {"output_type": "error", "ename": "E", "evalue": "v", "traceback": ["line"]},
            {"output_type": "display_data", "data": {"text/plain": "p", "application/json": [1]}, "metadata": {}},
        ],
    },
    {"event": "end", "reason": ""},
)
