"""A traceback shows students only their own files, under the paths that they know."""

from __future__ import annotations

import pytest

from autograder.diagnosis import Kind
from autograder.run.lockstep.failures import diagnose_crash
from autograder.run.lockstep.protocol import Crash
from autograder.run.lockstep.tracebacks import student_frames, with_source_paths

INSTALL = "/tmp/cell-1/ws/install/my_robot"
MODULES = f"{INSTALL}/lib/python3.12/site-packages"
LOADER = f"""Traceback (most recent call last):
  File "/opt/course/autograder/run/lockstep/lockstep_host/__main__.py", line 27, in main
    runpy.run_path(program, run_name="__main__")
  File "<frozen runpy>", line 291, in run_path
  File "{INSTALL}/lib/my_robot/driver", line 33, in <module>
    sys.exit(load_entry_point('my-robot==0.1.0', 'console_scripts', 'driver')())
             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
"""
CRASH = f"""{LOADER}  File "{MODULES}/my_robot/driver.py", line 9, in main
    rclpy.spin(node)
  File "/opt/ros/rclpy/__init__.py", line 226, in spin
    executor.spin_once()
  File "{MODULES}/my_robot/utils/steps.py", line 4, in step
    return 1 / 0
           ~~^~~
ZeroDivisionError: division by zero
"""
OWN = """Traceback (most recent call last):
  File "ws/src/my_robot/my_robot/driver.py", line 9, in main
    rclpy.spin(node)
  File "ws/src/my_robot/my_robot/utils/steps.py", line 4, in step
    return 1 / 0
           ~~^~~
ZeroDivisionError: division by zero"""


def test_only_the_students_frames_are_kept_with_their_lines_and_the_error() -> None:
    assert student_frames(CRASH) == OWN


def test_a_diagnosis_shows_the_students_frames() -> None:
    assert diagnose_crash(Crash("spin", "ZeroDivisionError", "division by zero", CRASH)).detail == OWN


def test_a_traceback_of_a_syntax_error_keeps_the_wrong_line() -> None:
    last_frame = f'  File "{MODULES}/my_robot/driver.py", line 7\n    def f()\n           ^\n'
    traceback = f"{LOADER}{last_frame}SyntaxError: expected ':'\n"
    diagnosis = diagnose_crash(Crash("import", "SyntaxError", "expected ':' (driver.py, line 7)", traceback))
    assert diagnosis.kind is Kind.SYNTAX_ERROR
    assert diagnosis.detail.splitlines()[1:] == [
        '  File "ws/src/my_robot/my_robot/driver.py", line 7',
        "    def f()",
        "           ^",
        "SyntaxError: expected ':'",
    ]


def test_a_traceback_without_a_file_of_the_student_is_unchanged() -> None:
    traceback = f"{LOADER}ImportError: no such entry point\n"
    assert student_frames(traceback) == traceback


def test_files_that_rosidl_generated_are_not_shown_as_the_students() -> None:
    generated = f'  File "{MODULES}/my_robot/msg/_status.py", line 3, in level\n    assert False\n'
    assert student_frames(CRASH.replace("ZeroDivisionError", f"{generated}ZeroDivisionError")) == OWN


def test_each_part_of_a_chain_of_exceptions_keeps_its_error() -> None:
    lines = student_frames(f"{CRASH}\nDuring handling of the above exception, another exception occurred:\n\n{CRASH}")
    assert lines.count("ZeroDivisionError") == 2
    assert "During handling" in lines
    assert "frozen" not in lines


def test_a_message_of_several_lines_is_kept() -> None:
    message = "ValueError: two lines\n    and this"
    assert student_frames(CRASH.replace("ZeroDivisionError: division by zero", message)).endswith(message)


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        (f"{INSTALL}/share/my_robot/launch/robot.launch.py", "ws/src/my_robot/launch/robot.launch.py"),
        ("/home/a/02_nodes/ws/src/my_robot/my_robot/driver.py", "ws/src/my_robot/my_robot/driver.py"),
        ("/usr/lib/python3.12/runpy.py", "/usr/lib/python3.12/runpy.py"),
    ],
)
def test_the_path_of_a_built_file_is_shown_as_that_of_its_source(path: str, expected: str) -> None:
    assert with_source_paths(f'File "{path}", line 1') == f'File "{expected}", line 1'
