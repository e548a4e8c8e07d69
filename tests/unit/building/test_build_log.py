"""A failed build's log shows a student's own files and lines, and no loader's."""

from __future__ import annotations

import pytest

from autograder.building.build_log import place_in_setup, readable

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


@pytest.mark.parametrize(
    ("log", "shown", "place"),
    [
        (
            SETUP + SYNTAX + COLCON,
            'Starting >>> pkg\nTraceback (most recent call last):\n  File "setup.py", line 8\n    nam=,\n        ^\n'
            "SyntaxError: invalid syntax\nFailed   <<< pkg [0.27s, exited with code 1]",
            "setup.py, line 8: ",
        ),
        (
            SETUP + RAISED + COLCON,
            'Starting >>> pkg\nTraceback (most recent call last):\n  File "setup.py", line 5, in <module>\n'
            "distutils.errors.DistutilsSetupError: 'packages' must be a list\n"
            "Failed   <<< pkg [0.27s, exited with code 1]",
            "setup.py, line 5: ",
        ),
        (NODE, NODE.replace("/tmp/cell-1/", "").rstrip(), ""),
        (COLCON, "Failed   <<< pkg [0.27s, exited with code 1]", ""),
        ("--- stderr: pkg\n\n---\nerror: can't copy 'resource/pkg'", "error: can't copy 'resource/pkg'", ""),
        ("--- stderr: pkg\nerror: no\n---", "--- stderr: pkg\nerror: no\n---", ""),
        ("Traceback (most recent call last):", "", ""),
    ],
)
def test_only_what_the_student_wrote_is_shown(log: str, shown: str, place: str) -> None:
    assert readable(log) == shown
    assert place_in_setup(log) == place
