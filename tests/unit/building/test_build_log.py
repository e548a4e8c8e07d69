"""The log of a failed build shows the student's files and lines, without the frames of loaders."""

from __future__ import annotations

import pytest

from autograder.building.build_log import MAX_END, first_error, readable_log

COLCON = """--- stderr: pkg
Traceback (most recent call last):
  File "/venv/lib/python3.12/site-packages/colcon_core/executor/__init__.py", line 91, in __call__
    rc = await self.task(*args, **kwargs)
         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
subprocess.CalledProcessError: Command '['python', '-c', 'setup']' returned non-zero exit status 1.
---
Failed   <<< pkg [0.27s, exited with code 1]
Command '['python', '-c', 'setup']' returned non-zero exit status 1.
"""
SETUP = """Starting >>> pkg
[0.683s] WARNING:colcon.colcon_ros.prefix_path.ament:The path '/venv' doesn't contain any 'local_setup.*' files.
Traceback (most recent call last):
  File "<string>", line 1, in <module>
  File "/venv/lib/python3.12/site-packages/setuptools/_distutils/core.py", line 267, in run_setup
    exec(code, g)
"""
SYNTAX = """  File "<string>", line 8
    nam=,
        ^
SyntaxError: invalid syntax
"""
RAISED = """  File "<string>", line 5, in <module>
  File "/venv/lib/python3.12/site-packages/setuptools/__init__.py", line 103, in setup
    return distutils.core.setup(**attrs)
distutils.errors.DistutilsSetupError: 'packages' must be a list
"""
NODE = """Traceback (most recent call last):
  File "/tmp/cell-1/ws/src/pkg/setup.py", line 3, in <module>
    from pkg import version
ImportError: cannot import name 'version'
"""


MESSAGE = """CMake Error at /opt/rosidl_adapt_interfaces.cmake:57 (message):
  returned error code 1:

  Error processing 'strin wrong' of 'pkg/Status':
  ''strin' is an invalid message name.  It should have
  the pattern'

  Traceback (most recent call last):

    File "<frozen runpy>", line 198, in _run_module_as_main
    File "/venv/rosidl_adapter/parser.py", line 206, in __init__
      raise InvalidResourceName(

  rosidl_adapter.parser.InvalidResourceName: 'strin' is an invalid message
  name.

Call Stack (most recent call first):
  CMakeLists.txt:8 (rosidl_generate_interfaces)
"""
SHORT = """CMake Error at /opt/rosidl_adapt_interfaces.cmake:57 (message):
  returned error code 1:

  Error processing 'strin wrong' of 'pkg/Status':
  ''strin' is an invalid message name.  It should have
  the pattern'

  rosidl_adapter.parser.InvalidResourceName: 'strin' is an invalid message
  name.

Call Stack (most recent call first):
  CMakeLists.txt:8 (rosidl_generate_interfaces)"""


@pytest.mark.parametrize(
    ("log", "expected", "error"),
    [
        (
            SETUP + SYNTAX + COLCON,
            'Starting >>> pkg\nTraceback (most recent call last):\n  File "setup.py", line 8\n    nam=,\n        ^\n'
            "SyntaxError: invalid syntax\nFailed   <<< pkg [exited with code 1]",
            "setup.py, line 8: SyntaxError: invalid syntax",
        ),
        (
            SETUP + RAISED + COLCON,
            'Starting >>> pkg\nTraceback (most recent call last):\n  File "setup.py", line 5, in <module>\n'
            "distutils.errors.DistutilsSetupError: 'packages' must be a list\n"
            "Failed   <<< pkg [exited with code 1]",
            "setup.py, line 5: distutils.errors.DistutilsSetupError: 'packages' must be a list",
        ),
        (NODE, NODE.replace("/tmp/cell-1/", "").rstrip(), "ImportError: cannot import name 'version'"),
        (MESSAGE, SHORT, "pkg/Status, 'strin wrong': 'strin' is an invalid message name. It should have the pattern"),
        (
            "  Error processing 'float distance' of\n  'pkg/Drive_Goal': ''float' is an invalid message\n  name.'\n\n",
            "  Error processing 'float distance' of\n  'pkg/Drive_Goal': ''float' is an invalid message\n  name.'",
            "pkg/Drive_Goal, 'float distance': 'float' is an invalid message name.",
        ),
        (COLCON, "Failed   <<< pkg [exited with code 1]", ""),
        (
            "--- stderr: pkg\n\n---\nerror: can't copy 'resource/pkg'",
            "error: can't copy 'resource/pkg'",
            "error: can't copy 'resource/pkg'",
        ),
        ("--- stderr: pkg\nerror: no\n---", "--- stderr: pkg\nerror: no\n---", "error: no"),
        (
            "[0.123s] ERROR:colcon.colcon_core: no\nFinished <<< a [1min 2.5s]\nSummary: 1 package finished [62.9s]",
            "ERROR:colcon.colcon_core: no\nFinished <<< a\nSummary: 1 package finished",
            "",
        ),
        ("Traceback (most recent call last):", "", ""),
    ],
)
def test_only_files_and_lines_of_the_student_are_shown(log: str, expected: str, error: str) -> None:
    assert readable_log(log) == expected
    assert first_error(log) == error


@pytest.mark.parametrize("part", ["a/", "Error processing '", "\n", "--- stderr: x\n\n", f"{SETUP}{SYNTAX}"])
def test_the_start_and_the_end_of_a_long_log_are_read(part: str) -> None:
    """A million characters of each part would take minutes if a pattern backtracked."""
    log = f"{SETUP}{SYNTAX}{part * (1_000_000 // len(part))}\nthe end"
    assert first_error(log) == "setup.py, line 8: SyntaxError: invalid syntax"
    assert readable_log(log).endswith("the end")
    assert len(readable_log(log)) <= 2 * MAX_END + 2


@pytest.mark.parametrize(
    ("log", "error"),
    [
        (
            "CMake Error at CMakeLists.txt:6 (find_package):\n  No package\n  std_msg.\n\n  Add it.\n",
            "CMakeLists.txt:6: No package std_msg.",
        ),
        (
            "CMake Error at CMakeLists.txt:3:\n  Parse error.  Expected a newline, got identifier with text\n"
            '  "find_package".\n\n\n-- Configuring incomplete, errors occurred!\n',
            'CMakeLists.txt:3: Parse error. Expected a newline, got identifier with text "find_package".',
        ),
        (
            "CMake Error at /opt/ros/lint.cmake:45 (message):\n  no linter there\n"
            "Call Stack (most recent call first):\n  /opt/hook.cmake:9 (lint)\n  CMakeLists.txt:21 (ament_package)\n",
            "CMakeLists.txt:21: no linter there",
        ),
    ],
)
def test_cmake_errors_are_reported_with_the_student_s_line(log: str, error: str) -> None:
    assert first_error(log) == error


def test_a_package_that_cmakelists_does_not_name_is_reported_in_a_sentence() -> None:
    folder = "/opt/ros/sourced/lib/python3.12/site-packages/rosidl_generator_type_description"
    log = (
        "--- stderr: my_interfaces\nTraceback (most recent call last):\n"
        f'  File "{folder}/__init__.py", line 160, in generate_type_hash\n    pkg_dir = include_map[pkg]\n'
        "              ~~~~~~~~~~~^^^^^\nKeyError: 'std_msgs'\ngmake[2]: *** [build.make:79: A.json] Error 1\n---\n"
    )
    assert first_error(log) == "CMakeLists.txt: rosidl_generate_interfaces does not name std_msgs after DEPENDENCIES"
